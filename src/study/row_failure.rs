//! Why a row has no numbers. Its words stand in the table's column `failure`.

use crate::dynamics::OrbitError;
use crate::experiment::RecipeError;
use crate::measure::EvaluateError;
use crate::optimise::BoundsError;

/// One reason.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum RowFailure {
    /// Its case makes no scene.
    #[error(transparent)]
    Recipe(#[from] RecipeError),
    /// The engine gave up.
    #[error(transparent)]
    Engine(#[from] EvaluateError),
    /// There is no orbit.
    #[error(transparent)]
    Orbit(#[from] OrbitError),
    /// One point of a maximisation has no number, and a maximum over part of a range is none; or a branch cannot begin there.
    #[error("at {parameter} = {at}: {reason}")]
    At {
        /// The parameter that is varied.
        parameter: String,
        /// Its value.
        at: f64,
        /// What is wrong there.
        reason: Box<Self>,
    },
    /// One of several starts has no end, and shares of the others would be those of none.
    #[error("start {number}: {reason}")]
    Start {
        /// Its number, from 1.
        number: usize,
        /// What is wrong with it.
        reason: Box<Self>,
    },
    /// A measure is NaN.
    #[error("{0} has no value")]
    NoValue(String),
    /// A measure is maximised and not among those of the experiment.
    #[error("{0} is to be maximised and not measured")]
    NotMeasured(String),
    /// No onset lies within the range: `before`, where the first point has events already, or else beyond the last.
    #[error("{measure}: {}", if *before { "above zero at the first point already; let the range begin below" } else { "zero at every point; widen the range" })]
    NoOnset {
        /// What was to be above zero.
        measure: String,
        /// Whether all points have events.
        before: bool,
    },
    /// A maximum over no points.
    #[error("there is no grid to look for a maximum on")]
    NoGrid,
    /// A row that was to start where another ended, which did not.
    #[error("not run: it starts where the row before ended, and the rows break off at {before}")]
    ChainEnded {
        /// The last row.
        before: String,
    },
    /// The optimisation could not be run.
    #[error(transparent)]
    Search(#[from] SearchError),
    /// A mistake of this program, which ends this evaluation and no other.
    #[error("the program made a mistake here (panic: {0})")]
    Panic(String),
    /// The process was asked to end first.
    #[error("interrupted")]
    Interrupted,
    /// The row was not evaluated, or not yet.
    #[error("the row was never computed")]
    NotComputed,
}

/// Why an optimisation has no result.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum SearchError {
    /// The experiment has no `optimise`.
    #[error("there is nothing to optimise")]
    NothingToOptimise,
    /// There is no baseline.
    #[error("there are no assumptions")]
    NoAssumptions,
    /// The fitness is not among the measures.
    #[error("what is to be optimised is not measured")]
    FitnessNotMeasured,
    /// The box of the search.
    #[error(transparent)]
    Bounds(#[from] BoundsError),
    /// A search of another kind.
    #[error("not a genetic algorithm")]
    NotGenetic,
    /// A dense search without points.
    #[error("a grid without points")]
    EmptyGrid,
    /// A name that is not among the candidates.
    #[error("{0} is no candidate")]
    NoCandidate(String),
    /// There is nothing to draw a landscape around.
    #[error("there is no candidate")]
    NoCandidates,
    /// A search that stopped before its first batch.
    #[error("{0} has evaluated nothing")]
    NothingEvaluated(String),
    /// A point whose score the journal does not hold.
    #[error("a point has no number that could be kept")]
    NotKept,
}
