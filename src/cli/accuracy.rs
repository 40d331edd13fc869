//! `shotdamp accuracy`: error against time.

use std::time::Duration;

use rayon::prelude::*;

use super::args::{AccuracyArgs, Choice};
use super::error::CliError;
use super::exit::Exit;
use super::output::{print, print_error, print_unread};
use super::select::{choose, open};
use crate::accuracy::{Errors, errors, publish_accuracy, publish_accuracy_summary};
use crate::dynamics::is_interrupted;
use crate::report::judge_all;
use crate::study::{Layout, RunError, Snapshot};

/// Error against time of the chosen experiments; of all of them, and of what was measured before, the summary.
pub(super) fn measure(layout: &Layout, args: &AccuracyArgs) -> Result<Exit, CliError> {
    if !args.all && args.patterns.is_empty() {
        return Err(CliError::NothingChosen("accuracy"));
    }
    let mut study = open(layout)?;
    args.limit.apply(&mut study);
    let patterns = if args.all { Vec::new() } else { args.patterns.clone() };
    let chosen = choose(&study, &Choice { patterns, folder: None })?;
    print_unread(chosen.unread.iter().copied());
    let assumptions = study.sheet.assumptions();
    let longest = Duration::try_from_secs_f64(args.longest).unwrap_or(Duration::MAX / 32);
    let mut exit = if chosen.unread.is_empty() { Exit::AsExpected } else { Exit::CouldNot };
    let judgement = judge_all(&study);
    // Errors side by side, times one after the other with nothing beside them.
    let prepared: Vec<_> =
        chosen.items.par_iter().map(|item| errors(&item.source.experiment, &assumptions, longest)).collect();
    for (item, errors) in chosen.items.iter().zip(prepared) {
        let experiment = &item.source.experiment;
        let timed = errors.map(Errors::timed);
        // Times of runs that were cut short are none.
        if is_interrupted() {
            return Err(RunError::Interrupted.into());
        }
        match timed {
            Ok(accuracy) => {
                let judged = judgement.verdicts.get(&experiment.id.0).map_or(&[][..], Vec::as_slice);
                let page = publish_accuracy(layout, experiment, accuracy, judged)?;
                print(&if args.all { format!("{}\n", experiment.id) } else { page })?;
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
    let summary = publish_accuracy_summary(layout)?;
    // The next run links the pages.
    Snapshot::forget(layout)?;
    if args.all {
        print(&summary)?;
    }
    Ok(exit)
}
