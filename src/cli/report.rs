//! `shotdamp report --html FILE`.

use super::args::ReportArgs;
use super::destination::Destination;
use super::error::CliError;
use super::exit::Exit;
use super::output::{print, print_error, print_unread};
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
    let Html { text, problems } = html(&study, &judge_all(&study));
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
