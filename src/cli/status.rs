//! `shotdamp status`: what is stale, and why.

use super::args::StatusArgs;
use super::dry_run::rows;
use super::error::CliError;
use super::exit::Exit;
use super::output::{print, print_unread, print_warnings};
use super::select::{Chosen, Found, choose, matched};
use crate::experiment::line_of;
use crate::report::publication_reasons;
use crate::study::{Item, KnownRows, Layout, Reason, State, Study, Texts};
use crate::text::words::counted;

/// What a run would have to do for an experiment.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Standing {
    UpToDate,
    Stale,
    Failed,
    ReportStale,
}

impl Standing {
    fn label(self) -> &'static str {
        match self {
            Self::UpToDate => "up to date",
            Self::Stale => "stale",
            Self::Failed => "failed",
            Self::ReportStale => "report stale",
        }
    }
}

/// One line for each experiment that is not up to date, below it why, and the number of the others.
pub(super) fn status(layout: &Layout, args: &StatusArgs) -> Result<Exit, CliError> {
    let found = Found::look(layout)?;
    if let Some(ids) = matched(&found, &args.choice) {
        print_warnings(found.snapshot.warnings(&found.texts).as_ref());
        print(&total(ids.len(), 0, 0))?;
        return Ok(Exit::AsExpected);
    }
    let study = found.open(layout, &args.choice, false);
    let chosen = choose(&study, &args.choice)?;
    print_unread(chosen.unread.iter().copied());
    print_warnings(study.warnings().as_ref());
    let stale = stale(&study, &chosen);
    let width = stale.iter().map(|(item, ..)| item.source.experiment.id.0.len()).max().unwrap_or(0);
    let mut text = String::new();
    for (item, standing, reasons) in &stale {
        text += &format!("{:width$}  {}\n", item.source.experiment.id.0, standing.label());
        if args.why {
            for reason in reasons {
                text += &format!("    {}\n", reason.describe(|file, path| line_in(&study.texts, file, path)));
            }
            if *standing == Standing::Stale {
                text += &format!("    {}\n", rows(&item.extent(layout, &KnownRows::of(layout, item))));
            }
        }
    }
    let reports = stale.iter().filter(|(_, standing, _)| *standing == Standing::ReportStale).count();
    if chosen.count() > 0 {
        text += &total(chosen.count(), stale.len() - reports, reports);
    }
    print(&text)?;
    Ok(if !chosen.unread.is_empty() {
        Exit::CouldNot
    } else if args.exit_code && !stale.is_empty() {
        Exit::Unexpected
    } else {
        Exit::AsExpected
    })
}

/// The experiments that are not up to date, and why.
fn stale<'a>(study: &Study, chosen: &Chosen<'a>) -> Vec<(&'a Item, Standing, Vec<Reason>)> {
    let standing = |item: &'a Item| match &item.state {
        State::Stale(reasons) => (item, Standing::Stale, reasons.clone()),
        State::Failed(_) => (item, Standing::Failed, item.reasons()),
        State::Current(_) => match publication_reasons(study, item) {
            reasons if reasons.is_empty() => (item, Standing::UpToDate, reasons),
            reasons => (item, Standing::ReportStale, reasons),
        },
    };
    chosen.items.iter().map(|item| standing(item)).filter(|(_, standing, _)| *standing != Standing::UpToDate).collect()
}

/// The last line.
fn total(all: usize, simulations: usize, reports: usize) -> String {
    let experiments = counted(all, "experiment", "experiments");
    match all - simulations - reports {
        current if current == all => format!("{experiments}, all up to date\n"),
        current => {
            let reports = counted(reports, "report", "reports");
            format!("{experiments}: {simulations} to simulate, {reports} to renew, {current} up to date\n")
        }
    }
}

/// The line of a file of the study on which a changed value stands.
fn line_in(texts: &Texts, file: &str, path: &[String]) -> Option<usize> {
    line_of(std::str::from_utf8(texts.bytes(file)?).ok()?, path)
}
