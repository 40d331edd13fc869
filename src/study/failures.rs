//! The rows of a table that could not be computed.

use std::fmt;

use serde::{Deserialize, Serialize};

/// The rows of a table that could not be computed.
#[derive(Debug, Clone, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Failures {
    /// How many.
    pub rows: usize,
    /// The reason of the first.
    pub first: String,
}

impl fmt::Display for Failures {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self { rows: 1, first } => write!(f, "1 row failed: {first}"),
            Self { rows, first } => write!(f, "{rows} rows failed; the first: {first}"),
        }
    }
}

impl Failures {
    /// Of the reasons, a row each.
    pub(super) fn of<R: ToString>(reasons: impl IntoIterator<Item = R>) -> Self {
        let mut reasons = reasons.into_iter();
        let Some(first) = reasons.next() else { return Self::default() };
        Self { rows: 1 + reasons.count(), first: first.to_string() }
    }
}
