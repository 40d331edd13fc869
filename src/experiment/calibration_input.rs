//! What a calibration tries: its free inputs and their values.

use super::recipe::{AssumptionName, AssumptionValue};
use crate::measure::SolverChoice;

/// A free input.
#[derive(Debug, Clone, PartialEq)]
pub struct CalibrationInput {
    /// As the file names it.
    pub name: String,
    /// What is tried.
    pub tried: Tried,
}

/// The values of a free input.
#[derive(Debug, Clone, PartialEq)]
pub enum Tried {
    /// Values of an assumption, or of several that are moved together.
    Values {
        /// The assumptions.
        moves: Vec<AssumptionName>,
        /// Unit symbols of their numbers.
        units: Vec<&'static str>,
        /// The values, each one for every assumption.
        values: Vec<Vec<AssumptionValue>>,
    },
    /// Factors of an assumption that is a number or a curve.
    Factors {
        /// The assumption, as in force or as another input has set it.
        of: AssumptionName,
        /// The factors.
        by: Vec<f64>,
    },
    /// Solvers, in the place of the exact one.
    Solvers(Vec<SolverChoice>),
}

impl Tried {
    /// How many values there are.
    #[must_use]
    pub fn count(&self) -> usize {
        match self {
            Self::Values { values, .. } => values.len(),
            Self::Factors { by, .. } => by.len(),
            Self::Solvers(solvers) => solvers.len(),
        }
    }

    /// True if it changes this assumption.
    #[must_use]
    pub fn moves(&self, name: &AssumptionName) -> bool {
        match self {
            Self::Values { moves, .. } => moves.contains(name),
            Self::Factors { of, .. } => of == name,
            Self::Solvers(_) => false,
        }
    }
}
