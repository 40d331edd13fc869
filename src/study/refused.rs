//! A file of the study that is not what it should be, and what a person can do about it.

use super::texts::Unreadable;
use crate::experiment::IdError;
use crate::text::utf8::NotUtf8;
use crate::yaml::Problems;

/// A file that is not what it should be.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum Refused {
    /// Its text has mistakes.
    #[error("{0}")]
    Text(#[from] Problems),
    /// Its name does not make an id.
    #[error("{file}: {error}")]
    Name {
        /// Which file.
        file: String,
        /// What is wrong with it.
        error: IdError,
    },
    /// It cannot be read at all.
    #[error("{file} cannot be read: {error}")]
    Unreadable {
        /// Which file.
        file: String,
        /// Why.
        error: Unreadable,
    },
    /// It is not a text.
    #[error("{file}: this is {error}")]
    Encoding {
        /// Which file.
        file: String,
        /// The first bad byte.
        error: NotUtf8,
    },
    /// Another ending than the one that is looked for would be overlooked.
    #[error("{0}: rename it to end in .yaml")]
    Ending(String),
    /// Two files of a kind and one id; nobody knows which of them is meant.
    #[error("{file}: {other} has the same id; rename one of them")]
    Twice {
        /// Which file.
        file: String,
        /// Another one.
        other: String,
    },
}

impl Refused {
    /// The mistakes with their lines, where there are lines.
    #[must_use]
    pub fn problems(&self) -> Option<&Problems> {
        match self {
            Self::Text(problems) => Some(problems),
            _ => None,
        }
    }

    /// Each mistake in words, with its line, counted from 1, if it has one.
    #[must_use]
    pub fn mistakes(&self) -> Vec<(Option<u64>, String)> {
        match self {
            Self::Text(problems) => problems.one_by_one(),
            Self::Encoding { error, .. } => vec![(u64::try_from(error.line).ok(), self.to_string())],
            Self::Unreadable { .. } | Self::Name { .. } | Self::Ending(_) | Self::Twice { .. } => {
                vec![(None, self.to_string())]
            }
        }
    }

    /// The name of the file.
    #[must_use]
    pub fn file(&self) -> &str {
        match self {
            Self::Text(problems) => &problems.file,
            Self::Unreadable { file, .. }
            | Self::Name { file, .. }
            | Self::Encoding { file, .. }
            | Self::Ending(file)
            | Self::Twice { file, .. } => file,
        }
    }
}
