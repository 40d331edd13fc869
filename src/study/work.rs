//! An experiment while it runs: its rows, their outcomes, and the table at the end.

use std::sync::OnceLock;
use std::sync::atomic::{AtomicUsize, Ordering};

use super::chain;
use super::evaluate::{Evaluate, Simulation, evaluate_guarded};
use super::event::{Event, EventHandler};
use super::job::{Job, evaluations, jobs, measures_need_trace};
use super::limited::Limited;
use super::maximise::{Along, Sought};
use super::mean::Averaging;
use super::row_failure::RowFailure;
use super::row_fingerprint::RowFingerprints;
use super::run::{Finished, Task};
use super::shard::{Shard, part};
use super::spent::Spent;
use super::tabulate::{self, Outcome, Row};
use super::variant::Variant;
use crate::dynamics::is_interrupted;
use crate::experiment::{Case, Experiment, Recipe, SearchPoint};
use crate::measure::{Link, Request, Rigour};
use crate::table::RowFingerprint;
use crate::text::words;

/// An experiment while it runs.
pub(super) struct Work<'a> {
    pub(super) task: Task<'a>,
    pub(super) jobs: Vec<Job>,
    /// The shard, and the place of each of its rows in the whole table; `None` if this is the whole.
    part: Option<(Shard, Vec<usize>)>,
    outcomes: Vec<OnceLock<Outcome>>,
    open: AtomicUsize,
}

impl<'a> Work<'a> {
    pub(super) fn new(task: Task<'a>) -> Self {
        let mut jobs = jobs(task.experiment, task.variants);
        let part = task.shard.map(|shard| {
            let (places, own) = part(shard, task.experiment, task.variants, &jobs);
            jobs = own;
            (shard, places)
        });
        let open = AtomicUsize::new(jobs.iter().filter(|job| job.same_as.is_none()).count());
        let outcomes = jobs.iter().map(|_| OnceLock::new()).collect();
        Self { task, jobs, part, outcomes, open }
    }

    /// Simulations that it takes at most.
    pub(super) fn simulations(&self) -> u64 {
        self.jobs.iter().map(|job| evaluations(self.task.experiment, job)).sum()
    }

    /// The row has not been computed yet.
    pub(super) fn is_open(&self, row: usize) -> bool {
        self.outcomes[row].get().is_none()
    }

    /// Puts a row into its place; true for the last one.
    pub(super) fn put(&self, row: usize, outcome: Outcome) -> bool {
        let _ = self.outcomes[row].set(outcome);
        self.open.fetch_sub(1, Ordering::AcqRel) == 1
    }

    pub(super) fn finish(&self) -> Finished {
        let lost: Outcome = Err(if is_interrupted() { RowFailure::Interrupted } else { RowFailure::NotComputed });
        let outcomes: Vec<&Outcome> = self
            .jobs
            .iter()
            .enumerate()
            .map(|(row, job)| self.outcomes[job.same_as.unwrap_or(row)].get().unwrap_or(&lost))
            .collect();
        let Task { experiment, variants, metadata, .. } = self.task;
        let fingerprints = self.fingerprints();
        let mut table = tabulate::table(experiment, variants, &self.jobs, &outcomes, fingerprints, metadata.clone());
        if let Some((shard, places)) = &self.part {
            shard.mark(&mut table, places);
        }
        let interrupted = outcomes.iter().any(|outcome| matches!(outcome, Err(RowFailure::Interrupted)));
        Finished { table, failures: tabulate::failures(&outcomes), spent: Spent::default(), interrupted }
    }

    /// Some row has been computed.
    pub(super) fn has_rows(&self) -> bool {
        self.outcomes.iter().any(|outcome| matches!(outcome.get(), Some(Ok(_))))
    }

    /// What each row was computed from; of one that shares another's numbers, what that was.
    fn fingerprints(&self) -> Vec<RowFingerprint> {
        let Task { experiment, variants, .. } = self.task;
        RowFingerprints::new(experiment).all(variants, &self.jobs)
    }

    /// Computes a row.
    pub(super) fn row(&self, row: usize, evaluate: &impl Evaluate, handler: &dyn EventHandler) -> Outcome {
        let job = &self.jobs[row];
        outcome(self.task, &self.task.experiment.cases[job.case], job, evaluate, handler)
    }

    /// Computes rows that follow each other, or a single one, and hands each over.
    pub(super) fn unit(
        &self,
        rows: &[usize],
        evaluate: &impl Evaluate,
        handler: &dyn EventHandler,
        put: impl Fn(usize, Outcome),
    ) {
        match rows {
            [only] => put(*only, self.row(*only, evaluate, handler)),
            chain => chain::run(self.task, &self.jobs, chain, evaluate, handler, put),
        }
    }
}

/// One row, of a case that need not be among the experiment's; taken over if it is known.
pub(super) fn outcome(
    task: Task<'_>,
    case: &Case,
    job: &Job,
    evaluate: &impl Evaluate,
    handler: &dyn EventHandler,
) -> Outcome {
    let experiment = task.experiment;
    if let Some(known) = task.known.filter(|known| !known.is_empty()) {
        let fingerprint = RowFingerprints::new(experiment).of(&task.variants[job.variant], case, job);
        if let Some(row) = known.row(experiment, fingerprint) {
            handler.on_event(&Event::Simulated { experiment: &experiment.id, count: evaluations(experiment, job) });
            return Ok(row);
        }
    }
    computed(task, case, job, Link::None, evaluate, handler)
}

/// One row, of a case that need not be among the experiment's, at its place in a chain.
pub(super) fn computed(
    task: Task<'_>,
    case: &Case,
    job: &Job,
    link: Link<'_>,
    evaluate: &impl Evaluate,
    handler: &dyn EventHandler,
) -> Outcome {
    let experiment = task.experiment;
    if is_interrupted() {
        return Err(RowFailure::Interrupted);
    }
    let simulated = AtomicUsize::new(0);
    let done = || {
        simulated.fetch_add(1, Ordering::Relaxed);
        handler.on_event(&Event::Simulated { experiment: &experiment.id, count: 1 });
    };
    let limited = Limited::row(evaluate, task.limit);
    let outcome = simulate(experiment, case, &task.variants[job.variant], job, link, &limited, &done);
    let rest = evaluations(experiment, job).saturating_sub(simulated.into_inner() as u64);
    handler.on_event(&Event::Simulated { experiment: &experiment.id, count: rest });
    // Whatever it says it failed by.
    if outcome.is_err() && is_interrupted() { Err(RowFailure::Interrupted) } else { outcome }
}

/// What the engine is asked for a row.
pub(super) fn asked<'a>(
    experiment: &'a Experiment,
    recipe: &'a Recipe,
    variant: &'a Variant,
    job: &Job,
) -> Simulation<'a> {
    Simulation {
        recipe,
        assumptions: &variant.assumptions,
        solver: job.solver,
        settings: experiment.settings_under(&variant.assumptions),
        request: Request {
            measures: &experiment.measures,
            // An instant that an entry reads off a time history has to be moved with the inputs.
            trace: experiment.trace.as_ref(),
            // Other lists are the baseline's alone; a measure of a shape needs it everywhere.
            energies: experiment.energies.as_ref().filter(|_| job.variant == 0),
            shape: experiment.shape.as_ref().filter(|_| job.variant == 0 || needs_shape(experiment)),
            each_cycle: experiment.each_cycle.as_ref().filter(|_| job.variant == 0),
            tolerances: &experiment.tolerances,
            link: Link::None,
            rigour: if job.variant == 0 { Rigour::Result } else { rigours_of_others(experiment)[0] },
        },
    }
}

/// What is asked of simulations that are no results; the first of each, the others of some. A point is looked for under whatever values.
pub(super) fn rigours_of_others(experiment: &Experiment) -> &'static [Rigour] {
    match experiment.maximise.as_ref().map(|maximise| maximise.wanted) {
        None => &[Rigour::Variant],
        Some(SearchPoint::Onset) => &[Rigour::Look],
        Some(SearchPoint::Maximum) => &[Rigour::Step, Rigour::Look],
    }
}

fn needs_shape(experiment: &Experiment) -> bool {
    experiment.measures.iter().any(|measure| measure.needs_shape())
}

fn simulate(
    experiment: &Experiment,
    case: &Case,
    variant: &Variant,
    job: &Job,
    link: Link<'_>,
    evaluate: &impl Evaluate,
    done: &(impl Fn() + Sync),
) -> Outcome {
    let evaluate = &Averaging { experiment, evaluate };
    let recipe = experiment.recipe_of(case)?;
    let mut simulation = asked(experiment, &recipe, variant, job);
    simulation.request.link = link;
    let Some(maximise) = &experiment.maximise else {
        let evaluated = evaluate_guarded(evaluate, &simulation);
        done();
        return Ok(Row { evaluated: evaluated?, place: None });
    };
    let measure = tabulate::maximised_index(experiment, maximise.measure)
        .ok_or_else(|| RowFailure::NotMeasured(words::of_key(&maximise.measure)))?;
    // Histories of the points that are not the maximum are not wanted.
    let asked = simulation.request;
    let trace = asked.trace.filter(|_| measures_need_trace(&experiment.measures));
    let shape = asked.shape.filter(|_| needs_shape(experiment));
    let point =
        Simulation { request: Request { trace, energies: None, shape, each_cycle: None, ..asked }, ..simulation };
    let Sought { mut evaluated, place, rise } =
        Along { evaluate, simulation: point, maximise, measure, done }.found()?;
    if job.variant == 0 {
        // The row itself is a result: the point once more, with all that proves it.
        let mut there = recipe.clone();
        there.set(maximise.over, crate::experiment::ParameterValue::Number(place.at))?;
        evaluated = evaluate_guarded(evaluate, &Simulation { recipe: &there, ..simulation })?;
        done();
    }
    if let Some(measured) = evaluated.measured.get_mut(measure) {
        measured.numerical = libm::hypot(measured.numerical, rise);
    }
    Ok(Row { evaluated, place: Some(place) })
}
