//! An experiment while it runs: its rows, their outcomes, and the table at the end.

use std::sync::OnceLock;
use std::sync::atomic::{AtomicUsize, Ordering};

use super::chain;
use super::evaluate::Evaluate;
use super::event::EventHandler;
use super::finished::Finished;
use super::job::{Job, evaluations, jobs};
use super::row::outcome;
use super::row_failure::RowFailure;
use super::row_fingerprint::RowFingerprints;
use super::shard::{Shard, part};
use super::spent::Spent;
use super::tabulate::{self, Outcome};
use super::task::Task;
use crate::dynamics::is_interrupted;
use crate::table::RowFingerprint;

/// An experiment while it runs.
pub(super) struct Work<'a> {
    pub(super) task: Task<'a>,
    pub(super) jobs: Vec<Job>,
    /// The shard, and the place of each of its rows in the whole table; `None` if this is the whole.
    part: Option<(Shard, Vec<usize>)>,
    outcomes: Vec<OnceLock<Outcome>>,
    open: AtomicUsize,
}

impl<'a> Work<'a> {
    pub(super) fn new(task: Task<'a>) -> Self {
        let mut jobs = jobs(task.experiment, task.variants);
        let part = task.shard.map(|shard| {
            let (places, own) = part(shard, task.experiment, task.variants, &jobs);
            jobs = own;
            (shard, places)
        });
        let open = AtomicUsize::new(jobs.iter().filter(|job| job.same_as.is_none()).count());
        let outcomes = jobs.iter().map(|_| OnceLock::new()).collect();
        Self { task, jobs, part, outcomes, open }
    }

    /// Simulations that it takes at most.
    pub(super) fn simulations(&self) -> u64 {
        self.jobs.iter().map(|job| evaluations(self.task.experiment, job)).sum()
    }

    /// The row has not been computed yet.
    pub(super) fn is_open(&self, row: usize) -> bool {
        self.outcomes[row].get().is_none()
    }

    /// Puts a row into its place; true for the last one.
    pub(super) fn put(&self, row: usize, outcome: Outcome) -> bool {
        let _ = self.outcomes[row].set(outcome);
        self.open.fetch_sub(1, Ordering::AcqRel) == 1
    }

    pub(super) fn finish(&self) -> Finished {
        let lost: Outcome = Err(if is_interrupted() { RowFailure::Interrupted } else { RowFailure::NotComputed });
        let outcomes: Vec<&Outcome> = self
            .jobs
            .iter()
            .enumerate()
            .map(|(row, job)| self.outcomes[job.same_as.unwrap_or(row)].get().unwrap_or(&lost))
            .collect();
        let Task { experiment, variants, metadata, .. } = self.task;
        let fingerprints = self.fingerprints();
        let mut table = tabulate::table(experiment, variants, &self.jobs, &outcomes, fingerprints, metadata.clone());
        if let Some((shard, places)) = &self.part {
            shard.mark(&mut table, places);
        }
        let interrupted = outcomes.iter().any(|outcome| matches!(outcome, Err(RowFailure::Interrupted)));
        Finished { table, failures: tabulate::failures(&outcomes), spent: Spent::default(), interrupted }
    }

    /// Some row has been computed.
    pub(super) fn has_rows(&self) -> bool {
        self.outcomes.iter().any(|outcome| matches!(outcome.get(), Some(Ok(_))))
    }

    /// What each row was computed from; of one that shares another's numbers, what that was.
    fn fingerprints(&self) -> Vec<RowFingerprint> {
        let Task { experiment, variants, .. } = self.task;
        RowFingerprints::new(experiment).all(variants, &self.jobs)
    }

    /// Computes a row.
    pub(super) fn row(&self, row: usize, evaluate: &impl Evaluate, handler: &dyn EventHandler) -> Outcome {
        let job = &self.jobs[row];
        outcome(self.task, &self.task.experiment.cases[job.case], job, evaluate, handler)
    }

    /// Computes rows that follow each other, or a single one, and hands each over.
    pub(super) fn unit(
        &self,
        rows: &[usize],
        evaluate: &impl Evaluate,
        handler: &dyn EventHandler,
        put: impl Fn(usize, Outcome),
    ) {
        match rows {
            [only] => put(*only, self.row(*only, evaluate, handler)),
            chain => chain::run(self.task, &self.jobs, chain, evaluate, handler, put),
        }
    }
}
