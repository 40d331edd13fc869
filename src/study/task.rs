//! What the runner is given, and what it gives back.

use std::collections::BTreeMap;
use std::path::Path;

use super::event::Left;
use super::finished::Finished;
use super::known_rows::KnownRows;
use super::plan::Item;
use super::shard::Shard;
use super::variant::Variant;
use crate::dynamics::Limit;
use crate::experiment::{Experiment, RowSource};
use crate::table::Table;

/// An experiment to be run.
#[derive(Debug, Clone, Copy)]
pub struct Task<'a> {
    /// What to run.
    pub experiment: &'a Experiment,
    /// Under which assumptions; the baseline comes first.
    pub variants: &'a [Variant],
    /// Provenance for the table's metadata.
    pub metadata: &'a BTreeMap<String, String>,
    /// Where an optimisation keeps what it has evaluated, so that it can go on after an interruption; `None`: nowhere.
    pub journal: Option<&'a Path>,
    /// The shard to which to keep; `None`: all of it. Of an experiment that is not divided the shard does all.
    pub shard: Option<Shard>,
    /// The most that a row may take.
    pub limit: Limit,
    /// Rows that need not be simulated; `None`: all are.
    pub known: Option<&'a KnownRows>,
}

impl<'a> Task<'a> {
    /// All of it, with nothing known and nothing kept on the way.
    #[must_use]
    pub fn new(experiment: &'a Experiment, variants: &'a [Variant], metadata: &'a BTreeMap<String, String>) -> Self {
        let limit = experiment.limit;
        Self { experiment, variants, metadata, journal: None, shard: None, limit, known: None }
    }

    /// What an earlier run has left of it, if that is this experiment as a whole; its title may have changed since.
    pub(super) fn known_whole(&self) -> Option<Finished> {
        let whole = self.known.and_then(KnownRows::whole)?;
        Some(Finished { table: Table { metadata: self.metadata.clone(), ..whole.clone() }, ..Finished::default() })
    }
}

impl Item {
    /// What the runner is to do for it.
    #[must_use]
    pub fn task<'a>(&'a self, metadata: &'a BTreeMap<String, String>, journal: &'a Path) -> Task<'a> {
        let Self { source, variants, .. } = self;
        Task { journal: Some(journal), ..Task::new(&source.experiment, variants, metadata) }
    }
}

impl Finished {
    /// What an interrupt has left for the next run.
    pub(super) fn left(&self, task: Task<'_>) -> Left {
        if self.has_rows_to_keep() {
            let rows = self.table.rows();
            return Left::Rows { done: rows - self.failures.rows, rows };
        }
        match task.experiment.row_source() {
            _ if self.spent.is_nothing() => Left::NotBegun,
            RowSource::Search(_) if task.journal.is_some() => Left::Journal,
            _ => Left::Nothing,
        }
    }
}
