//! `shotdamp status`.

use std::collections::BTreeSet;

use super::args::StatusArgs;
use super::dry_run::rows;
use super::error::CliError;
use super::exit::Exit;
use super::output::{complain_of, print};
use super::select::{choose, open};
use crate::publish::publication_reasons;
use crate::spec::line_of;
use crate::study::{KnownRows, Layout, Snapshot, State, Texts};

/// Where in a file of the study a part of its meaning is written.
fn line_in(texts: &Texts, file: &str, path: &[String]) -> Option<usize> {
    line_of(std::str::from_utf8(texts.files.get(file)?).ok()?, path)
}

/// What is told where there is nothing to do.
fn up_to_date(ids: &BTreeSet<&str>) -> String {
    let width = ids.iter().map(|id| id.len()).max().unwrap_or(0);
    let lines: String = ids.iter().map(|id| format!("{id:width$}  up to date\n")).collect();
    format!("{lines}{} experiments, all up to date\n", ids.len())
}

/// One line an experiment, and below it why.
pub(super) fn status(layout: &Layout, args: &StatusArgs) -> Result<Exit, CliError> {
    if args.choice.is_all() {
        // The short way: as after the last complete run, which left everything up to date.
        let texts = Texts::read(layout)?;
        if Snapshot::current(layout, &texts).is_some() {
            print(&up_to_date(&texts.ids()))?;
            return Ok(Exit::AsExpected);
        }
    }
    let opened = open(layout)?;
    let chosen = choose(&opened, &args.choice)?;
    complain_of(chosen.unread.iter().copied());
    let width = chosen.items.iter().map(|item| item.source.experiment.id.0.len()).max().unwrap_or(0);
    let mut text = String::new();
    let (mut simulations, mut reports) = (0, 0);
    for item in &chosen.items {
        let mut reasons = item.reasons();
        let state = match &item.state {
            State::Stale(_) => "stale",
            State::Failed(_) => "failed",
            State::Current(_) => {
                reasons = publication_reasons(&opened, item);
                if reasons.is_empty() { "up to date" } else { "report stale" }
            }
        };
        match state {
            "up to date" => {}
            "report stale" => reports += 1,
            _ => simulations += 1,
        }
        text += &format!("{:width$}  {state}\n", item.source.experiment.id.0);
        if args.why {
            for reason in &reasons {
                text += &format!("    {}\n", reason.told(|file, path| line_in(&opened.texts, file, path)));
            }
            if let State::Stale(_) = &item.state {
                let extent = item.extent(layout, &KnownRows::of(layout, item));
                text += &format!("    {}\n", rows(&extent));
            }
        }
    }
    let all = chosen.items.len();
    text += &match (simulations, reports) {
        (0, 0) => format!("{all} experiments, all up to date\n"),
        _ => format!("{all} experiments: {simulations} to simulate, {reports} reports to renew\n"),
    };
    print(&text)?;
    Ok(if !chosen.unread.is_empty() {
        Exit::CouldNot
    } else if args.exit_code && simulations + reports > 0 {
        Exit::Unexpected
    } else {
        Exit::AsExpected
    })
}
