//! What comes of an experiment that was run.

use super::failures::Failures;
use super::spent::Spent;
use crate::table::Table;

/// An experiment that has been run.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Finished {
    /// Its table.
    pub table: Table,
    /// The rows of it that have no numbers.
    pub failures: Failures,
    /// What it took.
    pub spent: Spent,
    /// An interrupt came before some of its rows.
    pub interrupted: bool,
}

impl Finished {
    /// True if its rows can be kept for the next run. What the journal holds of an optimisation says more than its table, and half a
    /// branch is followed again: neither says what a row was computed from.
    #[must_use]
    pub fn has_rows_to_keep(&self) -> bool {
        !self.table.fingerprints.is_empty() && self.failures.rows < self.table.rows()
    }
}
