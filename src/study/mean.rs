//! Means over settings that have no column of their own, such as several force points.
//!
//! Every measure is the mean of its values; the velocity ratio alone may also be the ratio of the mean RMS velocities ([`MeanRatio`]).

use rayon::prelude::*;

use super::evaluate::{Evaluate, Simulation};
use super::row_failure::RowFailure;
use crate::dynamics::Proof;
use crate::experiment::{Experiment, MeanRatio};
use crate::measure::{Evaluated, Measure, Measured, Request};

/// The measures to ask of each setting, so that means can be taken.
pub(super) fn measures_of_each(measures: &[Measure]) -> Vec<Measure> {
    let mut all = measures.to_vec();
    if measures.contains(&Measure::VelocityRatio) {
        for needed in [Measure::RmsVelocity, Measure::UndampedRmsVelocity] {
            if !all.contains(&needed) {
                all.push(needed);
            }
        }
    }
    all
}

/// Evaluates all that an experiment takes the mean over in the place of one scene.
pub(super) struct Averaging<'a, E> {
    pub experiment: &'a Experiment,
    pub evaluate: &'a E,
}

impl<E: Evaluate> Evaluate for Averaging<'_, E> {
    fn evaluate(&self, simulation: &Simulation<'_>) -> Result<Evaluated, RowFailure> {
        if self.experiment.mean_over.is_empty() {
            return self.evaluate.evaluate(simulation);
        }
        let recipes = self.experiment.recipes_in(simulation.recipe)?;
        let measures = measures_of_each(simulation.request.measures);
        let request = Request { measures: &measures, ..simulation.request };
        let one = |recipe| self.evaluate.evaluate(&Simulation { recipe, request, ..*simulation });
        // Through a list, so that of several failures the first in order is reported.
        let each: Vec<Result<Evaluated, RowFailure>> = recipes.par_iter().map(one).collect();
        let each = each.into_iter().collect::<Result<Vec<_>, _>>()?;
        let ratio = simulation.recipe.mean_ratio_under(simulation.assumptions)?;
        Ok(mean(simulation.request.measures, &measures, ratio, &each))
    }
}

/// The mean of evaluations of `measures`, of which the first ones are `wanted`.
pub(super) fn mean(wanted: &[Measure], measures: &[Measure], ratio: MeanRatio, each: &[Evaluated]) -> Evaluated {
    let count = each.len() as f64;
    let of = |index: usize| {
        let sum = |part: fn(&Measured) -> f64| each.iter().map(|one| part(&one.measured[index])).sum::<f64>();
        Measured {
            value: sum(|m| m.value) / count,
            // Independent of each other: their errors add up as squares.
            numerical: sum(|m| m.numerical * m.numerical).sqrt() / count,
            spread: sum(|m| m.spread * m.spread).sqrt() / count,
        }
    };
    let named = |measure| measures.iter().position(|other| *other == measure).map(of);
    let measured = wanted.iter().enumerate().map(|(index, measure)| match measure {
        Measure::VelocityRatio if ratio == MeanRatio::OfMeans => {
            match (named(Measure::UndampedRmsVelocity), named(Measure::RmsVelocity)) {
                (Some(clean), Some(damped)) => {
                    let value = clean.value / damped.value;
                    let relative = |part: f64| part / damped.value * value;
                    Measured { value, numerical: relative(damped.numerical), spread: relative(damped.spread) }
                }
                _ => of(index),
            }
        }
        _ => of(index),
    });
    let proofs: Vec<Proof> = each.iter().map(|one| one.proof).collect();
    Evaluated {
        measured: measured.collect(),
        proof: Proof::of_several(&proofs),
        chaotic: each.iter().any(|one| one.chaotic),
        unknown: each.iter().find_map(|one| one.unknown.clone()),
        members: each.iter().map(|one| one.members).max().unwrap_or(1),
        motion: None,
        trace: Vec::new(),
        end: None,
    }
}
