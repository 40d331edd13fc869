//! An engine that keeps to the limit of a row.

use std::sync::Arc;

use super::evaluate::{Array, Evaluate, Simulation};
use super::row_failure::RowFailure;
use crate::dynamics::{Allowance, Limit};
use crate::experiment::GapWord;
use crate::measure::{Evaluated, Measure, Rigour};
use crate::optimise::Slope;

/// What the simulations of an engine share.
pub(super) enum Share {
    /// All belong to one row.
    Row(Arc<Allowance>),
    /// Each is a row of its own: the candidates of an optimisation.
    Each(Limit),
}

/// An engine whose simulations end with their allowance.
pub(super) struct Limited<'a, E> {
    evaluate: &'a E,
    share: Share,
}

impl<'a, E> Limited<'a, E> {
    /// For the simulations of one row.
    pub(super) fn row(evaluate: &'a E, limit: Limit) -> Self {
        Self { evaluate, share: Share::Row(Allowance::new(limit)) }
    }

    /// For simulations of which each is a row.
    pub(super) fn each(evaluate: &'a E, limit: Limit) -> Self {
        Self { evaluate, share: Share::Each(limit) }
    }
}

impl Share {
    fn simulate<T>(&self, simulation: impl FnOnce() -> T) -> T {
        match self {
            Self::Row(allowance) => allowance.simulate(simulation),
            Self::Each(limit) => Allowance::new(*limit).simulate(simulation),
        }
    }
}

impl<E: Evaluate> Evaluate for Limited<'_, E> {
    fn evaluate(&self, simulation: &Simulation<'_>) -> Result<Evaluated, RowFailure> {
        self.share.simulate(|| self.evaluate.evaluate(simulation))
    }

    fn array<'a>(&'a self, simulation: Simulation<'a>, word: GapWord) -> Result<Box<dyn Array + 'a>, RowFailure> {
        let array = self.share.simulate(|| self.evaluate.array(simulation, word))?;
        Ok(Box::new(LimitedArray { array, share: &self.share }))
    }
}

struct LimitedArray<'a> {
    array: Box<dyn Array + 'a>,
    share: &'a Share,
}

impl Array for LimitedArray<'_> {
    fn evaluate(&self, gaps: &[f64], rigour: Rigour) -> Result<Evaluated, RowFailure> {
        self.share.simulate(|| self.array.evaluate(gaps, rigour))
    }

    fn slope(&self, gaps: &[f64], measure: Measure) -> Result<Option<Slope>, RowFailure> {
        self.share.simulate(|| self.array.slope(gaps, measure))
    }
}
