//! Exit codes.

use std::process::ExitCode;

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

    pub fn from_code(code: u8) -> Self {
        match code {
            0 => Self::AsExpected,
            1 => Self::Unexpected,
            _ => Self::CouldNot,
        }
    }
}

impl From<Exit> for ExitCode {
    fn from(exit: Exit) -> Self {
        Self::from(exit.code())
    }
}
