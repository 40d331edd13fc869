//! `shotdamp report --html FILE`.

use super::args::ReportArgs;
use super::error::CliError;
use super::exit::Exit;
use super::output::{print, print_error, print_unread};
use super::select::open;
use crate::atomic;
use crate::report::{Html, html, judge_all};
use crate::study::Layout;
use crate::text::number::compact;
use crate::text::words::counted;

/// Writes the study as one HTML file.
pub(super) fn report(layout: &Layout, args: &ReportArgs) -> Result<Exit, CliError> {
    let study = open(layout)?;
    if study.items.is_empty() && study.unread.is_empty() {
        return Err(CliError::NoExperiments);
    }
    print_unread(&study.unread);
    let Html { text, problems } = html(&study, &judge_all(&study));
    for problem in &problems {
        print_error(&format!("error: {problem}\n"));
    }
    atomic::write(&args.html, text.as_bytes())?;
    let pages = study.items.len();
    let megabytes = compact(text.len() as f64 / 1e6, 3);
    print(&format!("{}: {}, {megabytes} MB\n", args.html.display(), counted(pages, "experiment", "experiments")))?;
    Ok(if problems.is_empty() && study.unread.is_empty() { Exit::AsExpected } else { Exit::CouldNot })
}
