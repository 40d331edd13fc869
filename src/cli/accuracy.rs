//! `shotdamp accuracy`: error against time.

use std::collections::{BTreeMap, BTreeSet};

use rayon::prelude::*;

use super::args::{AccuracyArgs, Choice};
use super::error::CliError;
use super::exit::Exit;
use super::output::{print, print_error, print_unread};
use super::select::{choose, open};
use crate::accuracy::{
    Errors, Measured, accuracy_view, check_publishable, errors, keep_measured, publish_accuracy,
    publish_accuracy_summary, read_measured,
};
use crate::dynamics::is_interrupted;
use crate::report::{Judgement, judge_all};
use crate::study::{Layout, RunError, Snapshot, Study};

/// Error against time of the chosen experiments; of all of them, and of what was measured before, the summary.
pub(super) fn measure(layout: &Layout, args: &AccuracyArgs) -> Result<Exit, CliError> {
    if args.pages {
        let study = open(layout)?;
        publish(&study, &judge_all(&study), read_measured(layout), |_| true)?;
        return Ok(Exit::AsExpected);
    }
    if !args.all && args.patterns.is_empty() {
        return Err(CliError::NothingChosen("accuracy"));
    }
    let mut study = open(layout)?;
    args.limit.apply(&mut study);
    let patterns = if args.all { Vec::new() } else { args.patterns.clone() };
    let chosen = choose(&study, &Choice { patterns, folder: None })?;
    print_unread(chosen.unread.iter().copied());
    // Before minutes of work, not after them.
    check_publishable(layout)?;
    let assumptions = study.sheet.assumptions();
    let mut exit = if chosen.unread.is_empty() { Exit::AsExpected } else { Exit::CouldNot };
    let judgement = judge_all(&study);
    let mut measured = read_measured(layout);
    // Errors side by side, times one after the other with nothing beside them.
    let prepared: Vec<_> =
        chosen.items.par_iter().map(|item| errors(&item.source.experiment, &assumptions, args.longest)).collect();
    for (item, errors) in chosen.items.iter().zip(prepared) {
        let experiment = &item.source.experiment;
        let timed = errors.map(Errors::timed);
        // Times of runs that were cut short are none.
        if is_interrupted() {
            return Err(RunError::Interrupted.into());
        }
        match timed {
            Ok(accuracy) => {
                keep_measured(layout, &mut measured, experiment, accuracy)?;
                if args.all {
                    print(&format!("{}\n", experiment.id))?;
                }
            }
            // An experiment without a run has no price.
            Err(error) => {
                print_error(&format!("{}: {error}\n", experiment.id));
                if !args.all {
                    exit = Exit::CouldNot;
                }
            }
        }
    }
    let ids: BTreeSet<&str> = chosen.items.iter().map(|item| item.source.experiment.id.0.as_str()).collect();
    let Published { pages, summary } = publish(&study, &judgement, measured, |id| ids.contains(id))?;
    if args.all {
        print(&summary)?;
    } else {
        pages.iter().try_for_each(|page| print(page))?;
    }
    Ok(exit)
}

struct Published {
    pages: Vec<String>,
    summary: String,
}

/// Writes from what was measured the pages of the experiments that `chosen` admits, and the summary of all.
fn publish(
    study: &Study,
    judgement: &Judgement,
    mut measured: BTreeMap<String, Measured>,
    chosen: impl Fn(&str) -> bool,
) -> Result<Published, CliError> {
    let layout = &study.layout;
    let (mut views, mut pages) = (Vec::new(), Vec::new());
    for item in &study.items {
        let experiment = &item.source.experiment;
        let id = experiment.id.0.as_str();
        let Some(measured) = measured.remove(id) else { continue };
        let judged = judgement.verdicts.get(id).map_or(&[][..], Vec::as_slice);
        let view = accuracy_view(experiment, measured, judged);
        if chosen(id) {
            pages.push(publish_accuracy(layout, experiment, &view)?);
        }
        views.push(view);
    }
    let summary = publish_accuracy_summary(layout, &views)?;
    // The next run links the pages.
    Snapshot::forget(layout)?;
    Ok(Published { pages, summary })
}
