//! The words for what became of an entry.

use serde::{Deserialize, Serialize};

/// What became of an entry.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Verdict {
    /// Within the tolerance, derived or justified in the entry.
    Reproduced,
    /// Agrees, but the entry was used to choose an unstated input: it proves nothing.
    Fitted,
    /// Outside, beyond its uncertainty.
    Differs,
    /// The published figure lies inside the chaotic spread: no run can confirm or refute it.
    Undecidable,
    /// Needs an input that the study does not give.
    Blocked,
    /// Absent, NaN, failed, stale or not run: never a pass, never an expected verdict.
    Missing,
}

impl Verdict {
    /// As YAML and every report call it.
    #[must_use]
    pub fn word(self) -> &'static str {
        match self {
            Self::Reproduced => "reproduced",
            Self::Fitted => "fitted",
            Self::Differs => "differs",
            Self::Undecidable => "undecidable",
            Self::Blocked => "blocked",
            Self::Missing => "missing",
        }
    }

    /// How bad it is among several.
    pub(crate) fn severity(self) -> u8 {
        match self {
            Self::Reproduced => 0,
            Self::Fitted => 1,
            Self::Undecidable => 2,
            Self::Blocked => 3,
            Self::Differs => 4,
            Self::Missing => 5,
        }
    }
}
