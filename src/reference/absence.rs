//! Why there is no number where an entry asks for one. What cannot be read is never taken for one.

use serde::{Deserialize, Serialize};

/// Why there is no number.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) enum Absence {
    /// No row is meant by the conditions.
    NoRow(String),
    /// There is no table, or none that counts.
    NoTable { table: NoTable, reason: String },
    /// The rows are there, what they should hold is not: no column, NaN, failed.
    Broken(String),
    /// All is there, but what the entry speaks of does not happen: no crossing, no parting.
    Nowhere(String),
}

impl Absence {
    pub(crate) fn reason(&self) -> &str {
        match self {
            Self::NoTable { reason, .. } | Self::NoRow(reason) | Self::Broken(reason) | Self::Nowhere(reason) => reason,
        }
    }

    /// The table that is not there.
    pub(crate) fn no_table(&self) -> Option<&NoTable> {
        match self {
            Self::NoTable { table, .. } => Some(table),
            Self::NoRow(_) | Self::Broken(_) | Self::Nowhere(_) => None,
        }
    }
}

/// A table that an entry reads and that is not there.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct NoTable {
    /// The experiment whose table it would be.
    pub experiment: String,
    /// Why it is not there.
    pub why: WhyNoTable,
}

/// Why there is no table of an experiment, or none that counts.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum WhyNoTable {
    /// The experiment has not been run.
    NotRun,
    /// It was run with other inputs.
    Stale,
    /// It failed as a whole.
    Failed,
    /// There is no such experiment.
    NoExperiment,
}
