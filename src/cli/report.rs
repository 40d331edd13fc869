//! `shotdamp report --html FILE`.

use super::args::ReportArgs;
use super::destination::Destination;
use super::error::CliError;
use super::exit::Exit;
use super::output::{print, print_error, print_progress, print_unread};
use super::select::open;
use crate::report::{Html, html, judge_all};
use crate::study::Layout;
use crate::text::number::compact;
use crate::text::words::counted;

/// Writes the study as one HTML file.
pub(super) fn report(layout: &Layout, args: &ReportArgs) -> Result<Exit, CliError> {
    args.html.check(layout)?;
    let study = open(layout)?;
    if study.items.is_empty() && study.unread.is_empty() {
        return Err(CliError::NoExperiments);
    }
    print_unread(&study.unread);
    let judgement = judge_all(&study);
    let missing =
        study.items.iter().filter(|item| !judgement.tables.contains_key(&item.source.experiment.id.0)).count();
    if missing > 0 {
        let all = counted(study.items.len(), "experiment", "experiments");
        let [verb, whose, what] = if missing == 1 { ["has", "its", "it"] } else { ["have", "their", "them"] };
        print_progress(&format!(
            "warning: {missing} of {all} {verb} no table that is up to date: {whose} numbers and figures are not in the file; `shotdamp run` makes {what}\n"
        ));
    }
    let Html { text, problems } = html(&study, &judgement);
    for problem in &problems {
        print_error(&format!("error: {problem}\n"));
    }
    args.html.write(&text)?;
    if let Destination::File(path) = &args.html {
        let pages = counted(study.items.len(), "experiment", "experiments");
        let megabytes = compact(text.len() as f64 / 1e6, 3);
        print(&format!("{}: {pages}, {megabytes} MB\n", path.display()))?;
    }
    Ok(if problems.is_empty() && study.unread.is_empty() { Exit::AsExpected } else { Exit::CouldNot })
}
