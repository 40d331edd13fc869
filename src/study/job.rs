//! Jobs: one row of a table each, a case under one solver in one variant of the assumptions.

use super::variant::Variant;
use std::collections::{BTreeMap, BTreeSet};

use crate::experiment::{AssumptionName, Case, Experiment, Maximise};
use crate::measure::{Measure, SolverChoice};

/// A row.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Job {
    /// Index of the case.
    pub case: usize,
    pub solver: SolverChoice,
    /// Index of the variant.
    pub variant: usize,
    /// The row whose numbers this one shares, because its case does not depend on the assumption that the variant moves.
    pub same_as: Option<usize>,
}

impl Job {
    /// Whether its run is a result; what is moved for sensitivity is not audited.
    pub(super) fn is_audited(&self) -> bool {
        self.variant == 0 || self.same_as.is_some()
    }
}

/// The rows of an experiment in the order of its table: baseline first, then each variant; in each the cases in the order
/// of the sweep, each under its solvers. Variants are for sensitivity, and run event-driven only.
pub(super) fn jobs(experiment: &Experiment, variants: &[Variant]) -> Vec<Job> {
    let mut jobs: Vec<Job> = Vec::new();
    for (case, sweep_point) in experiment.cases.iter().enumerate() {
        jobs.extend(sweep_point.solvers.iter().map(|&solver| Job { case, solver, variant: 0, same_as: None }));
    }
    let event_driven: Vec<(usize, Job)> =
        jobs.iter().copied().enumerate().filter(|(_, job)| job.solver == SolverChoice::EventDriven).collect();
    if variants.len() < 2 {
        return jobs;
    }
    // Until the moved assumption is read, all values are those of the baseline: who reads it then reads it in the baseline.
    let read = |(_, job): &(usize, Job)| {
        let recipe = experiment.recipe_of(&experiment.cases[job.case]).ok()?;
        Some(experiment.assumptions_of([recipe], &variants[0].assumptions))
    };
    let mut read: Vec<Option<BTreeSet<AssumptionName>>> = event_driven.iter().map(read).collect();
    // What a row of a chain reads, all rows after it depend on; they are computed together or not at all.
    let row_of: BTreeMap<usize, usize> = event_driven.iter().enumerate().map(|(at, (_, job))| (job.case, at)).collect();
    for chain in experiment.chains() {
        let rows: Vec<usize> = chain.iter().filter_map(|case| row_of.get(case).copied()).collect();
        let each: Option<Vec<BTreeSet<_>>> = rows.iter().map(|&row| read[row].clone()).collect();
        let all: Option<BTreeSet<_>> = each.map(|each| each.into_iter().flatten().collect());
        rows.into_iter().for_each(|row| read[row].clone_from(&all));
    }
    for (variant, Variant { moved, .. }) in variants.iter().enumerate().skip(1) {
        for ((row, job), read) in event_driven.iter().zip(&read) {
            let depends = match (moved, read) {
                (Some(moved), Some(read)) => read.contains(moved),
                _ => true,
            };
            jobs.push(Job { variant, same_as: (!depends).then_some(*row), ..*job });
        }
    }
    jobs
}

/// The rows of these jobs that are computed together, in their order: a chain, or one row. Rows that share another's numbers are
/// left out.
pub(super) fn units(experiment: &Experiment, jobs: &[Job]) -> Vec<Vec<usize>> {
    let mut places = BTreeMap::new();
    for (chain, cases) in experiment.chains().into_iter().enumerate() {
        places.extend(cases.into_iter().enumerate().map(|(place, case)| (case, (chain, place))));
    }
    let mut units: Vec<Vec<usize>> = Vec::new();
    let mut begun = BTreeMap::new();
    for (row, job) in jobs.iter().enumerate().filter(|(_, job)| job.same_as.is_none()) {
        match places.get(&job.case) {
            None => units.push(vec![row]),
            Some((chain, _)) => {
                let unit = *begun.entry((job.variant, *chain)).or_insert(units.len());
                match units.get_mut(unit) {
                    Some(rows) => rows.push(row),
                    None => units.push(vec![row]),
                }
            }
        }
    }
    for rows in &mut units {
        rows.sort_by_key(|row| places.get(&jobs[*row].case).map(|(_, place)| *place));
    }
    units
}

/// The row of a case by which its curve is refined: its first solver at the baseline.
pub(super) fn first_of(case: &Case) -> Job {
    let solver = case.solvers.first().copied().unwrap_or(SolverChoice::EventDriven);
    Job { case: 0, solver, variant: 0, same_as: None }
}

/// Simulations that a row takes at most.
pub(super) fn evaluations(experiment: &Experiment, job: &Job) -> u64 {
    match (&experiment.maximise, job.same_as) {
        (_, Some(_)) => 0,
        (None, None) => 1,
        (Some(maximise), None) => {
            // The point of the baseline is simulated once more, as a result.
            maximise.points() + u64::from(job.variant == 0)
        }
    }
}

/// Runs behind a row of the table, the members of an ensemble and the points of a search for gaps not counted.
#[must_use]
pub fn runs_of_a_row(experiment: &Experiment) -> u64 {
    experiment.maximise.as_ref().map_or(1, Maximise::points) * (experiment.mean_over.len() as u64).max(1)
}

/// True if the row's measures cannot be computed without a time history.
pub(super) fn measures_need_trace(measures: &[Measure]) -> bool {
    measures.iter().any(|measure| measure.needs_trace())
}

/// About how long a row takes, in arbitrary units: only the order counts, so that the last thread to finish does not
/// start on a long row.
pub(super) fn cost(experiment: &Experiment, variants: &[Variant], job: &Job) -> f64 {
    let settings = &experiment.settings;
    let cycles = settings.averaged().end() as f64;
    let steps_a_cycle = match job.solver {
        // An exact step between two events costs as much as some ten fixed steps, and there are a few in a cycle.
        SolverChoice::EventDriven => 50.0,
        SolverChoice::FixedStep { time_step } => {
            let period = experiment
                .recipe_of(&experiment.cases[job.case])
                .ok()
                .and_then(|recipe| recipe.resolve(&variants[job.variant].assumptions).ok())
                .map_or(1.0, |scene| scene.excitation.period());
            period / time_step
        }
    };
    let evaluations = u32::try_from(evaluations(experiment, job)).unwrap_or(u32::MAX);
    cycles * steps_a_cycle * f64::from(evaluations)
}
