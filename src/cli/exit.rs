//! Exit codes.

use std::process::ExitCode;

use crate::reference::{Judged, Verdict};

/// How a command ended; the worst counts.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum Exit {
    /// Every verdict is the expected one.
    AsExpected,
    /// Some verdict is not.
    Unexpected,
    /// Something could not run, is missing, or was asked for wrongly.
    CouldNot,
}

impl Exit {
    pub fn code(self) -> u8 {
        match self {
            Self::AsExpected => 0,
            Self::Unexpected => 1,
            Self::CouldNot => 2,
        }
    }

    /// What these verdicts come to.
    pub fn of_verdicts<'a>(verdicts: impl Iterator<Item = &'a Judged>) -> Self {
        let of = |judged: &Judged| match judged {
            judged if judged.verdict == Verdict::Missing => Self::CouldNot,
            judged if judged.as_expected() => Self::AsExpected,
            _ => Self::Unexpected,
        };
        verdicts.map(of).max().unwrap_or(Self::AsExpected)
    }
}

impl From<Exit> for ExitCode {
    fn from(exit: Exit) -> Self {
        Self::from(exit.code())
    }
}
