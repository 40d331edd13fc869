//! Chains: rows that start where the row before them ended, computed one after the other as one task.
//!
//! A chain ends with its first row that has no numbers: what came after would hang together with nothing. The state at the end of a
//! row is in no table, so that a chain is taken over from an earlier table as a whole or computed from its first row on.

use super::evaluate::Evaluate;
use super::event::{Event, EventHandler};
use super::job::{Job, evaluations};
use super::known_rows::KnownRows;
use super::row::computed;
use super::row_failure::RowFailure;
use super::row_fingerprint::RowFingerprints;
use super::tabulate::{Outcome, Row};
use super::task::Task;
use crate::dynamics::{StartState, is_interrupted};
use crate::measure::Link;

/// Computes the rows of a chain, or takes all of them over, and hands each over as soon as it is there.
pub(super) fn run(
    task: Task<'_>,
    jobs: &[Job],
    rows: &[usize],
    evaluate: &impl Evaluate,
    handler: &dyn EventHandler,
    put: impl Fn(usize, Outcome),
) {
    let experiment = task.experiment;
    let count = |row: usize| {
        let count = evaluations(experiment, &jobs[row]);
        handler.on_event(&Event::Simulated { experiment: &experiment.id, count });
    };
    if let Some(known) = known(task, jobs, rows) {
        for (&row, known) in rows.iter().zip(known) {
            count(row);
            put(row, Ok(known));
        }
        return;
    }
    let mut last: Option<StartState> = None;
    let mut broken: Option<RowFailure> = None;
    for (place, &row) in rows.iter().enumerate() {
        if let Some(reason) = &broken {
            count(row);
            put(row, Err(if is_interrupted() { RowFailure::Interrupted } else { reason.clone() }));
            continue;
        }
        let case = &experiment.cases[jobs[row].case];
        let link = last.as_ref().map_or(Link::First, Link::After);
        let mut outcome = computed(task, case, &jobs[row], link, evaluate, handler);
        last = outcome.as_mut().ok().and_then(|row| row.evaluated.end.take());
        if last.is_none() && place + 1 < rows.len() {
            broken = Some(RowFailure::ChainEnded { before: case.describe() });
        }
        put(row, outcome);
    }
}

/// All rows of a chain from an earlier table, if it has all of them.
fn known(task: Task<'_>, jobs: &[Job], rows: &[usize]) -> Option<Vec<Row>> {
    let known: &KnownRows = task.known.filter(|known| !known.is_empty())?;
    let fingerprints = RowFingerprints::new(task.experiment).chain(task.variants, jobs, rows);
    fingerprints.into_iter().map(|fingerprint| known.row(task.experiment, fingerprint)).collect()
}
