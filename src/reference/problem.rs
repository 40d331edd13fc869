//! What is wrong with a reference file, and where.

use super::entry_mistake::EntryMistake;
use super::prose::ProseError;
use crate::experiment::{AssumptionName, Located, Problems};
use crate::text::utf8::NotUtf8;

/// One mistake with its place.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct ReferenceProblem {
    /// Line and column, counted from 1; `None` for the file as a whole.
    pub at: Option<(u64, u64)>,
    /// What is wrong.
    pub mistake: ReferenceMistake,
}

/// One mistake.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum ReferenceMistake {
    /// The text is no YAML, or no reference file.
    #[error("{0}")]
    Text(String),
    /// An entry is unsound.
    #[error("entry `{entry}` {mistake}")]
    Entry {
        /// Its id, as written.
        entry: String,
        /// What is wrong with it.
        mistake: EntryMistake,
    },
    /// There is no entry.
    #[error("there is no entry")]
    NoEntry,
    /// A statement without its place, words or reason.
    #[error("a statement that is not judged needs its `place`, what it `says` and a `reason`")]
    NotJudged,
    /// Another ending would be overlooked.
    #[error("rename it to end in .yaml")]
    Ending,
    /// It is no text.
    #[error("this is {0}")]
    Encoding(NotUtf8),
    /// A placeholder of no entry.
    #[error("a placeholder names `{0}`, which is no entry of the reference")]
    Placeholder(String),
    /// A list with an entry that there is not.
    #[error("`{0}` is no entry of the reference: write `experiment/entry`")]
    NoSuchEntry(String),
    /// A placeholder of no variant.
    #[error(
        "a placeholder moves `{0}`, which no run of that entry does: the page of its experiment lists the assumptions that are moved, as they are written here"
    )]
    Variant(String),
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
    /// At the start of a line.
    #[must_use]
    pub fn on_line(line: u64, mistake: ReferenceMistake) -> Self {
        Self { at: Some((line, 1)), mistake }
    }

    /// The line that it is about, counted from 1; `None` for the file as a whole.
    #[must_use]
    pub fn line(&self) -> Option<u64> {
        self.at.map(|(line, _)| line)
    }

    /// The same as mistakes in experiments are shown: with the line of the text, marked.
    #[must_use]
    pub fn shown(&self, file: &str, text: &str) -> Problems {
        Problems::at(file, text, self.at, self.mistake.to_string())
    }
}

impl From<ReferenceMistake> for ReferenceProblem {
    /// Of the file as a whole.
    fn from(mistake: ReferenceMistake) -> Self {
        Self { at: None, mistake }
    }
}

impl From<Located> for ReferenceProblem {
    fn from(Located { line, column, message }: Located) -> Self {
        Self { at: (line > 0).then_some((line, column)), mistake: ReferenceMistake::Text(message) }
    }
}

impl From<NotUtf8> for ReferenceProblem {
    fn from(error: NotUtf8) -> Self {
        Self::on_line(error.line as u64, ReferenceMistake::Encoding(error))
    }
}

impl std::fmt::Display for ReferenceProblem {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        if let Some((line, column)) = self.at {
            write!(f, "line {line}, column {column}: ")?;
        }
        self.mistake.fmt(f)
    }
}

impl std::error::Error for ReferenceProblem {}
