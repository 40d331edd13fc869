//! What is wrong with a reference file, and where.

use super::prose::ProseError;
use crate::experiment::AssumptionName;
use crate::experiment::Located;
use crate::text::utf8::NotUtf8;

/// One mistake.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum ReferenceProblem {
    /// The text is no YAML, or no reference file.
    #[error(transparent)]
    Text(#[from] Located),
    /// An entry is unsound.
    #[error("line {line}, column {column}: entry `{entry}` {mistake}")]
    Entry {
        /// The line on which the entry starts, counted from 1.
        line: u64,
        /// The column, counted from 1.
        column: u64,
        /// Its id, as written.
        entry: String,
        /// What is wrong with it, as the rest of a sentence.
        mistake: String,
    },
    /// There is no entry.
    #[error("line 1, column 1: there is no entry")]
    NoEntry,
    /// Another ending would be overlooked.
    #[error("rename it to end in .yaml")]
    Ending,
    /// It is no text.
    #[error("line {line}: this is {error}", line = error.line)]
    Encoding {
        /// The first bad byte.
        error: NotUtf8,
    },
    /// A placeholder of no entry.
    #[error("line {line}, column 1: a placeholder names `{name}`, which is no entry of the reference")]
    Placeholder {
        /// The line, counted from 1.
        line: u64,
        /// The entry that it names.
        name: String,
    },
    /// The reason of an assumption cannot be read.
    #[error("the reason of `{name}` has {error}")]
    Reason {
        /// Of which assumption.
        name: AssumptionName,
        /// What is wrong with it.
        error: ProseError,
    },
    /// Two files of one experiment.
    #[error("another file holds the reference of this experiment")]
    Twice,
    /// The system's reason.
    #[error("cannot be read: {0}")]
    Unreadable(String),
}

impl ReferenceProblem {
    /// The line that it is about, counted from 1; `None` for the file as a whole.
    #[must_use]
    pub fn line(&self) -> Option<u64> {
        match self {
            Self::Text(located) => Some(located.line).filter(|line| *line > 0),
            Self::Entry { line, .. } => Some(*line),
            Self::NoEntry => Some(1),
            Self::Encoding { error } => u64::try_from(error.line).ok(),
            Self::Placeholder { line, .. } => Some(*line),
            Self::Ending | Self::Reason { .. } | Self::Twice | Self::Unreadable(_) => None,
        }
    }
}
