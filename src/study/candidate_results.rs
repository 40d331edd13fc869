//! Candidates of an optimisation as results, and under other values of the inputs.

use rayon::prelude::*;

use super::evaluate::Evaluate;
use super::fitness::Fitness;
use super::mean::measures_of_each;
use super::row_failure::RowFailure;
use super::tabulate_candidates::Candidate;
use super::task::Task;
use crate::measure::{Evaluated, Rigour};

/// What came of gaps as a result, under the assumptions in force.
pub(super) type Results = Vec<(Vec<f64>, Result<Evaluated, RowFailure>)>;

/// Every candidate as a result, unless that is `known`, and as a variant under other values.
pub(super) fn evaluate_all(
    task: Task<'_>,
    evaluate: &impl Evaluate,
    candidates: Vec<Candidate>,
    known: &Results,
) -> Vec<Candidate> {
    let experiment = task.experiment;
    let Some(optimise) = &experiment.optimise else { return candidates };
    let mut all: Vec<Candidate> = Vec::new();
    for variant in 0..task.variants.len() {
        let kept = candidates.iter().filter(|candidate| variant == 0 || candidate.varied.is_none());
        all.extend(kept.map(|candidate| Candidate { variant, ..candidate.clone() }));
    }
    let recipes = experiment.recipes_in(&experiment.recipe);
    let measures = measures_of_each(&experiment.measures);
    // A variant's scenes are compiled once for all its candidates.
    let ready: Vec<_> = match &recipes {
        Ok(recipes) => task
            .variants
            .par_iter()
            .map(|variant| Fitness::new(evaluate, experiment, optimise, variant, recipes, &measures))
            .collect(),
        Err(reason) => task.variants.iter().map(|_| Err(reason.clone().into())).collect(),
    };
    // Several searches may have found the same gaps.
    let open =
        |candidate: &Candidate| candidate.varied.is_none() && matches!(candidate.outcome, Err(RowFailure::NotComputed));
    let mut places: Vec<(usize, Vec<f64>)> = Vec::new();
    for candidate in all.iter().filter(|candidate| open(candidate)) {
        let place = (candidate.variant, candidate.gaps.clone());
        if !places.contains(&place) {
            places.push(place);
        }
    }
    let evaluated = |(variant, gaps): &(usize, Vec<f64>)| {
        if let Some((_, outcome)) = known.iter().find(|(known, _)| *variant == 0 && known == gaps) {
            return outcome.clone();
        }
        let rigour = if *variant == 0 { Rigour::Result } else { Rigour::Variant };
        ready[*variant].as_ref().map_err(RowFailure::clone)?.evaluate(gaps, rigour)
    };
    let outcomes: Vec<Result<Evaluated, RowFailure>> = places.par_iter().map(evaluated).collect();
    for candidate in all.iter_mut().filter(|candidate| open(candidate)) {
        let at = places.iter().position(|(variant, gaps)| *variant == candidate.variant && *gaps == candidate.gaps);
        if let Some(at) = at {
            candidate.outcome.clone_from(&outcomes[at]);
        }
    }
    all
}
