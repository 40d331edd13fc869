//! Ids of experiments.

use serde::{Deserialize, Serialize};

/// Id of an experiment: its file name without ending, `ch3-limit-stop`; lower-case letters, digits and hyphens.
#[derive(Debug, Clone, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
pub struct ExperimentId(pub String);

/// No id is longer.
const LONGEST_ID: usize = 64;

/// A text that is no id; nothing else ever becomes part of a path.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum IdError {
    /// Of other characters, or of none.
    #[error("`{0}` is not an id: lower-case letters, digits and hyphens, such as `ch3-limit-stop`")]
    Characters(String),
    /// Of too many.
    #[error("`{0}` is not an id: it has {length} characters, {LONGEST_ID} are the most", length = .0.len())]
    Long(String),
}

impl std::str::FromStr for ExperimentId {
    type Err = IdError;

    fn from_str(text: &str) -> Result<Self, IdError> {
        let is_made_of_them =
            text.bytes().all(|byte| byte.is_ascii_lowercase() || byte.is_ascii_digit() || byte == b'-');
        if text.is_empty() || text.starts_with('-') || !is_made_of_them {
            Err(IdError::Characters(text.into()))
        } else if text.len() > LONGEST_ID {
            Err(IdError::Long(text.into()))
        } else {
            Ok(Self(text.into()))
        }
    }
}

impl std::fmt::Display for ExperimentId {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(&self.0)
    }
}
