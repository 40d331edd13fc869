//! Jobs: one row of a table each, a case under one solver in one variant of the assumptions.

use super::variant::Variant;
use crate::measure::Measure;
use crate::scene::Recipe;
use crate::spec::{Experiment, SolverChoice};

/// Indices of a row's case, solver and variant in its experiment.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Job {
    pub case: usize,
    pub solver: usize,
    pub variant: usize,
    /// The row whose numbers this one shares, because its case does not lean on the assumption that the variant moves.
    pub same_as: Option<usize>,
}

/// The rows of an experiment in the order of its table: baseline first, then each variant; in each the cases in the order
/// of the sweep, each under every solver. Variants are for sensitivity, and run event-driven only.
pub(super) fn jobs(experiment: &Experiment, variants: &[Variant]) -> Vec<Job> {
    let mut jobs: Vec<Job> = Vec::new();
    let solvers = experiment.solvers.len();
    for (variant, Variant { moved, .. }) in variants.iter().enumerate() {
        for (case, _) in experiment.cases.iter().enumerate() {
            for (solver, choice) in experiment.solvers.iter().enumerate() {
                let same_as = match moved {
                    None => None,
                    Some(_) if *choice != SolverChoice::EventDriven => continue,
                    Some(assumption) => match recipe(experiment, case) {
                        Ok(recipe) if !recipe.assumptions().contains(assumption) => Some(case * solvers + solver),
                        _ => None,
                    },
                };
                jobs.push(Job { case, solver, variant, same_as });
            }
        }
    }
    jobs
}

/// The recipe of a case: the experiment's, with the sweep point's values.
pub(super) fn recipe(experiment: &Experiment, case: usize) -> Result<Recipe, String> {
    let mut recipe = experiment.recipe.clone();
    for (parameter, value) in &experiment.cases[case].values {
        recipe.set(*parameter, *value).map_err(|error| error.to_string())?;
    }
    Ok(recipe)
}

/// Simulations that a row takes at most.
pub(super) fn evaluations(experiment: &Experiment, job: &Job) -> u64 {
    match (&experiment.maximise, job.same_as) {
        (_, Some(_)) => 0,
        (None, None) => 1,
        (Some(maximise), None) => {
            let sharpening = 2 * u64::from(maximise.refine);
            maximise.grid.len() as u64 + sharpening + u64::from(keeps_trace(experiment, job))
        }
    }
}

/// True if the row keeps its time history; variants are compared by their measures alone.
pub(super) fn keeps_trace(experiment: &Experiment, job: &Job) -> bool {
    experiment.trace.is_some() && job.variant == 0
}

/// True if the row's measures cannot be computed without a time history.
pub(super) fn measures_need_trace(measures: &[Measure]) -> bool {
    measures.iter().any(|measure| {
        matches!(
            measure,
            Measure::LastPeak
                | Measure::PeakVariation
                | Measure::PeakDecayError
                | Measure::FloorImpactLag
                | Measure::CeilingImpactLag
        )
    })
}

/// About how long a row takes, in arbitrary units: only the order counts, so that the last thread to finish does not
/// start on a long row.
pub(super) fn cost(experiment: &Experiment, variants: &[Variant], job: &Job) -> f64 {
    let settings = &experiment.settings;
    let cycles = f64::from(settings.skip) + f64::from(settings.average);
    let steps_a_cycle = match experiment.solvers[job.solver] {
        // An exact step between two events costs as much as some ten fixed steps, and there are a few in a cycle.
        SolverChoice::EventDriven => 50.0,
        SolverChoice::FixedStep { time_step } => {
            let period = recipe(experiment, job.case)
                .ok()
                .and_then(|recipe| recipe.resolve(&variants[job.variant].assumptions).ok())
                .map_or(1.0, |scene| scene.excitation.period());
            period / time_step
        }
    };
    let evaluations = u32::try_from(evaluations(experiment, job)).unwrap_or(u32::MAX);
    cycles * steps_a_cycle * f64::from(evaluations)
}
