//! Why a recipe has no scene, and of what in the file that is said.

use super::assumption::AssumptionName;
use super::assumption_sheet::ASSUMPTIONS;
use super::parameter::Parameter;
use super::part::Part;
use crate::scene::{StartError, StructureError};

/// Why a recipe has no scene.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum RecipeError {
    /// The scene lacks what the sweep varies.
    #[error("the sweep varies {parameter:?}, but the scene has {what}")]
    NothingToVary {
        /// Which parameter.
        parameter: Parameter,
        /// What the scene has instead.
        what: &'static str,
    },
    /// An assumption is needed and absent from the file, or of another kind.
    #[error("the assumption `{0}` is not declared in {ASSUMPTIONS}, or is of another kind")]
    Assumption(AssumptionName),
    /// A value that physics refuses.
    #[error("{message}")]
    OutOfRange {
        /// What is wrong with it.
        message: String,
        /// The part of the scene that it belongs to, where that is known.
        part: Option<Part>,
        /// The key in that part under which it is written, if it is not the part's own.
        under: Option<&'static str>,
        /// Words by which it is written there, or swept; the first that is there is meant.
        keys: Vec<&'static str>,
    },
    /// A force acts, or motion is observed, where the structure does not move.
    #[error(
        "{what} stands where {structure} does not move, since every mode shape is zero there: move it off the support"
    )]
    Still {
        /// Which part.
        part: Part,
        /// The force, or what is observed.
        what: &'static str,
        /// The structure.
        structure: &'static str,
    },
}

impl RecipeError {
    /// A value that physics refuses, of a place to be named.
    pub(super) fn out_of_range(message: impl Into<String>) -> Self {
        Self::OutOfRange { message: message.into(), part: None, under: None, keys: Vec::new() }
    }

    /// Names the part of the scene, unless that is done.
    pub(super) fn within(mut self, within: Part) -> Self {
        if let Self::OutOfRange { part, .. } = &mut self {
            part.get_or_insert(within);
        }
        self
    }

    /// Names the key in the part under which the value is written, as `floor`.
    pub(super) fn under(mut self, key: &'static str) -> Self {
        if let Self::OutOfRange { under, .. } = &mut self {
            under.get_or_insert(key);
        }
        self
    }

    /// Names the words by which the value is written or swept, unless that is done.
    pub(super) fn at_keys(mut self, words: &[&'static str]) -> Self {
        if let Self::OutOfRange { keys, .. } = &mut self
            && keys.is_empty()
        {
            keys.extend(words);
        }
        self
    }
}

impl From<StructureError> for RecipeError {
    fn from(error: StructureError) -> Self {
        Self::out_of_range(error.message).within(Part::Structure).at_keys(error.key.as_slice())
    }
}

impl From<StartError> for RecipeError {
    fn from(error: StartError) -> Self {
        Self::out_of_range(error.0).within(Part::Start)
    }
}
