//! Why the error of a scene against time is not measured.

use crate::accuracy::precise::PreciseError;
use crate::dynamics::EngineError;
use crate::experiment::RecipeError;
use crate::measure::EvaluateError;

/// Why there is no diagram.
#[derive(Debug, thiserror::Error)]
pub enum NoAccuracy {
    /// Nothing is simulated.
    #[error("no case has a damper whose motion takes time to simulate")]
    Nothing,
    /// Its runs are trials of a search.
    #[error("it is an optimisation, whose runs are trials of a search; name an experiment that runs one of its arrays")]
    Optimisation,
    /// A case has no scene.
    #[error(transparent)]
    Recipe(#[from] RecipeError),
    /// A case does not run.
    #[error(transparent)]
    Case(#[from] EvaluateError),
    /// A contender fails.
    #[error(transparent)]
    Engine(#[from] EngineError),
    /// The reference fails.
    #[error(transparent)]
    Reference(#[from] PreciseError),
}
