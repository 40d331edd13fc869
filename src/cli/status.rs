//! `shotdamp status`.

use super::args::StatusArgs;
use super::dry_run::rows;
use super::error::CliError;
use super::exit::Exit;
use super::output::{print, print_unread};
use super::select::choose;
use crate::experiment::line_of;
use crate::report::publication_reasons;
use crate::study::{KnownRows, Layout, Snapshot, State, Study, Texts};

/// Where in a file of the study a part of its meaning is written.
fn line_in(texts: &Texts, file: &str, path: &[String]) -> Option<usize> {
    line_of(std::str::from_utf8(texts.files.get(file)?).ok()?, path)
}

/// What is told of an experiment for which there is nothing to do.
const UP_TO_DATE: &str = "up to date";

/// The line of an experiment; ids take up as much room as the longest.
fn line(id: &str, width: usize, state: &str) -> String {
    format!("{id:width$}  {state}\n")
}

/// Room for the longest of these ids.
fn width<'a>(ids: impl Iterator<Item = &'a str>) -> usize {
    ids.map(str::len).max().unwrap_or(0)
}

/// The last line.
fn total(all: usize, simulations: usize, reports: usize) -> String {
    match (simulations, reports) {
        (0, 0) => format!("{all} experiments, all up to date\n"),
        _ => format!("{all} experiments: {simulations} to simulate, {reports} reports to renew\n"),
    }
}

/// One line an experiment, and below it why.
pub(super) fn status(layout: &Layout, args: &StatusArgs) -> Result<Exit, CliError> {
    let texts = Texts::read(layout)?;
    // The short way: as after the last complete run, which left everything up to date.
    if args.choice.is_all() && Snapshot::current(layout, &texts).is_some() {
        let ids = texts.ids();
        let width = width(ids.iter().copied());
        let lines: String = ids.iter().map(|id| line(id, width, UP_TO_DATE)).collect();
        print(&format!("{lines}{}", total(ids.len(), 0, 0)))?;
        return Ok(Exit::AsExpected);
    }
    let study = Study::new(layout.clone(), texts);
    let chosen = choose(&study, &args.choice)?;
    print_unread(chosen.unread.iter().copied());
    let width = width(chosen.items.iter().map(|item| item.source.experiment.id.0.as_str()));
    let mut text = String::new();
    let (mut simulations, mut reports) = (0, 0);
    for item in &chosen.items {
        let mut reasons = item.reasons();
        let state = match &item.state {
            State::Stale(_) => "stale",
            State::Failed(_) => "failed",
            State::Current(_) => {
                reasons = publication_reasons(&study, item);
                if reasons.is_empty() { UP_TO_DATE } else { "report stale" }
            }
        };
        match state {
            UP_TO_DATE => {}
            "report stale" => reports += 1,
            _ => simulations += 1,
        }
        text += &line(&item.source.experiment.id.0, width, state);
        if args.why {
            for reason in &reasons {
                text += &format!("    {}\n", reason.describe(|file, path| line_in(&study.texts, file, path)));
            }
            if let State::Stale(_) = &item.state {
                let extent = item.extent(layout, &KnownRows::of(layout, item));
                text += &format!("    {}\n", rows(&extent));
            }
        }
    }
    text += &total(chosen.items.len(), simulations, reports);
    print(&text)?;
    Ok(if !chosen.unread.is_empty() {
        Exit::CouldNot
    } else if args.exit_code && simulations + reports > 0 {
        Exit::Unexpected
    } else {
        Exit::AsExpected
    })
}
