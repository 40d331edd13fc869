//! Fitness: the mean of a measure over the settings that an optimisation takes in.

use rayon::prelude::*;

use super::evaluate::{Array, Evaluate, Simulation, guarded};
use super::mean::mean;
use super::row_failure::RowFailure;
use super::variant::Variant;
use crate::experiment::{Experiment, MeanRatio, Optimise, Recipe};
use crate::measure::{Evaluated, Measure, Rigour};
use crate::optimise::Slope;

/// The array under each setting that fitness is a mean over, ready for other gaps.
pub(super) struct Fitness<'a> {
    arrays: Vec<Box<dyn Array + 'a>>,
    wanted: &'a [Measure],
    measures: &'a [Measure],
    ratio: MeanRatio,
}

impl<'a> Fitness<'a> {
    pub(super) fn new(
        evaluate: &'a impl Evaluate,
        experiment: &'a Experiment,
        optimise: &Optimise,
        variant: &'a Variant,
        recipes: &'a [Recipe],
        measures: &'a [Measure],
    ) -> Result<Self, RowFailure> {
        let ready = |recipe: &'a Recipe| {
            let simulation = Simulation::step(experiment, recipe, &variant.assumptions, measures);
            guarded(|| evaluate.array(simulation, optimise.gaps))
        };
        let arrays = recipes.iter().map(ready).collect::<Result<_, _>>()?;
        let ratio = experiment.recipe.mean_ratio_under(&variant.assumptions)?;
        Ok(Self { arrays, wanted: &experiment.measures, measures, ratio })
    }

    pub(super) fn evaluate(&self, gaps: &[f64], rigour: Rigour) -> Result<Evaluated, RowFailure> {
        let each = self.arrays.iter().map(|array| guarded(|| array.evaluate(gaps, rigour)));
        Ok(mean(self.wanted, self.measures, self.ratio, &each.collect::<Result<Vec<_>, _>>()?))
    }

    /// One step of a search: the mean of the measure at `index`, which is never negative, or part of it once that alone exceeds `limit`.
    /// Sums of such numbers never fall, rounding included.
    pub(super) fn step(&self, gaps: &[f64], index: usize, limit: f64) -> Result<Step, RowFailure> {
        let mut each = Vec::with_capacity(self.arrays.len());
        for array in &self.arrays {
            each.push(guarded(|| array.evaluate(gaps, Rigour::Step))?);
            let sum: f64 = each.iter().map(|one| one.measured[index].value).sum();
            let part = sum / self.arrays.len() as f64;
            if each.len() < self.arrays.len() && part > limit {
                return Ok(Step::Above(part));
            }
        }
        Ok(Step::At(mean(self.wanted, self.measures, self.ratio, &each).measured[index].value))
    }

    /// The mean over the settings and its derivatives; `None` if that of one setting has none.
    pub(super) fn slope(&self, gaps: &[f64], measure: Measure) -> Result<Option<Slope>, RowFailure> {
        let one = |array: &(dyn Array + 'a)| guarded(|| array.slope(gaps, measure));
        let each = self.arrays.par_iter().map(|array| one(array.as_ref())).collect::<Result<Vec<_>, _>>()?;
        let Some(each) = each.into_iter().collect::<Option<Vec<Slope>>>() else { return Ok(None) };
        let count = each.len() as f64;
        let value = each.iter().map(|slope| slope.value).sum::<f64>() / count;
        let by = |i: usize| each.iter().map(|slope| slope.gradient[i]).sum::<f64>() / count;
        Ok(Some(Slope { value, gradient: (0..gaps.len()).map(by).collect() }))
    }
}

/// What a step of a search came to.
#[derive(Debug, Clone, Copy)]
pub(super) enum Step {
    /// The fitness.
    At(f64),
    /// A bound below it that was enough.
    Above(f64),
}
