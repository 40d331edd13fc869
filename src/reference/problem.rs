//! What is wrong with a reference file, and where.

use crate::experiment::Located;

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
    #[error("this is not UTF-8 text")]
    Encoding,
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
            Self::Ending | Self::Encoding | Self::Twice | Self::Unreadable(_) => None,
        }
    }
}
