//! The runner: rows of many experiments side by side, each experiment's table in its own order.
//!
//! Every row is computed by one thread from its own input alone and put into its own place, so the bytes of a table do not
//! depend on the number of threads. Long rows start first. An experiment is handed over as soon as its last row is done:
//! who stops the program loses the experiments under way and no others.

use std::collections::BTreeMap;
use std::sync::OnceLock;
use std::sync::atomic::{AtomicUsize, Ordering};

use super::evaluate::{Evaluate, Simulation, evaluate_guarded};
use super::event::{Event, Listen};
use super::job::{Job, cost, evaluations, jobs, keeps_trace, measures_need_trace};
use super::maximise::maximum;
use super::record::Failures;
use super::tabulate::{self, Outcome, Row};
use super::variant::Variant;
use crate::measure::Rigour;
use crate::spec::Experiment;
use crate::table::Table;
use crate::text::words;

/// An experiment to be run.
#[derive(Debug, Clone, Copy)]
pub struct Task<'a> {
    /// What to run.
    pub experiment: &'a Experiment,
    /// Under which assumptions; the baseline comes first.
    pub variants: &'a [Variant],
    /// Provenance for the table's metadata.
    pub metadata: &'a BTreeMap<String, String>,
}

/// An experiment that has been run.
#[derive(Debug, Clone, PartialEq)]
pub struct Finished {
    /// Its table.
    pub table: Table,
    /// The rows of it that have no numbers.
    pub failures: Failures,
}

/// How a run ended that could not even start.
#[derive(Debug, thiserror::Error)]
#[error("cannot start the threads: {0}")]
pub struct ThreadError(#[from] rayon::ThreadPoolBuildError);

/// Where recursion into other rows' work may end up needs room.
const STACK: usize = 16 << 20;

/// Runs the tasks on `threads` threads (0: one a processor) and hands each finished experiment, by its index, to
/// `take`, on the thread that finished it. Returns what `take` returned, in the order of the tasks.
///
/// # Errors
/// If the threads cannot be started.
pub fn run<T: Send + Sync>(
    tasks: &[Task<'_>],
    threads: usize,
    evaluate: &impl Evaluate,
    listener: &dyn Listen,
    take: impl Fn(usize, Finished) -> T + Sync,
) -> Result<Vec<T>, ThreadError> {
    let work: Vec<Work<'_, T>> = tasks.iter().map(|task| Work::new(*task)).collect();
    let simulations = work.iter().map(Work::simulations).sum();
    listener.hear(&Event::Begun { experiments: tasks.len(), simulations });
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).stack_size(STACK).build()?;
    pool.install(|| {
        let (work, take) = (&work, &take);
        rayon::scope_fifo(|scope| {
            for (task, row) in order(work) {
                scope.spawn_fifo(move |_| {
                    let one = &work[task];
                    let outcome = one.row(row, evaluate, listener);
                    if one.put(row, outcome) {
                        let finished = one.finish();
                        let (rows, failures) = (one.jobs.len(), finished.failures.clone());
                        // Only the thread that put the last row comes here, once.
                        let _ = one.taken.set(take(task, finished));
                        let experiment = &one.task.experiment.id;
                        listener.hear(&Event::Finished { experiment, rows, failures: &failures });
                    }
                });
            }
        });
    });
    listener.hear(&Event::Ended);
    Ok(work
        .into_iter()
        .enumerate()
        .map(|(index, one)| match one.taken.into_inner() {
            Some(taken) => taken,
            // An experiment without rows never has a last one.
            None => take(index, Finished { table: Table::default(), failures: Failures::default() }),
        })
        .collect())
}

/// Rows in the order in which to start them: the experiment with the longest row first, in it the longest row first.
fn order<T>(work: &[Work<'_, T>]) -> Vec<(usize, usize)> {
    let mut order: Vec<(f64, f64, usize, usize)> = Vec::new();
    for (index, one) in work.iter().enumerate() {
        let costs: Vec<f64> = one.jobs.iter().map(|job| cost(one.task.experiment, one.task.variants, job)).collect();
        let longest = costs.iter().copied().fold(0.0, f64::max);
        let real = (0..costs.len()).filter(|&row| one.jobs[row].same_as.is_none());
        order.extend(real.map(|row| (longest, costs[row], index, row)));
    }
    order.sort_by(|a, b| b.0.total_cmp(&a.0).then(a.2.cmp(&b.2)).then(b.1.total_cmp(&a.1)).then(a.3.cmp(&b.3)));
    order.into_iter().map(|(_, _, index, row)| (index, row)).collect()
}

/// An experiment while it runs.
struct Work<'a, T> {
    task: Task<'a>,
    jobs: Vec<Job>,
    outcomes: Vec<OnceLock<Outcome>>,
    open: AtomicUsize,
    taken: OnceLock<T>,
}

impl<'a, T> Work<'a, T> {
    fn new(task: Task<'a>) -> Self {
        let jobs = jobs(task.experiment, task.variants);
        let open = AtomicUsize::new(jobs.iter().filter(|job| job.same_as.is_none()).count());
        let outcomes = jobs.iter().map(|_| OnceLock::new()).collect();
        Self { task, jobs, outcomes, open, taken: OnceLock::new() }
    }

    fn simulations(&self) -> u64 {
        self.jobs.iter().map(|job| evaluations(self.task.experiment, job)).sum()
    }

    /// Puts a row into its place; true for the last one.
    fn put(&self, row: usize, outcome: Outcome) -> bool {
        let _ = self.outcomes[row].set(outcome);
        self.open.fetch_sub(1, Ordering::AcqRel) == 1
    }

    fn finish(&self) -> Finished {
        let lost: Outcome = Err("the row was never computed".into());
        let outcomes: Vec<&Outcome> = self
            .jobs
            .iter()
            .enumerate()
            .map(|(row, job)| self.outcomes[job.same_as.unwrap_or(row)].get().unwrap_or(&lost))
            .collect();
        let Task { experiment, variants, metadata } = self.task;
        let table = tabulate::table(experiment, variants, &self.jobs, &outcomes, metadata.clone());
        Finished { table, failures: tabulate::failures(&outcomes) }
    }

    fn row(&self, row: usize, evaluate: &impl Evaluate, listener: &dyn Listen) -> Outcome {
        let (experiment, job) = (self.task.experiment, &self.jobs[row]);
        let told = AtomicUsize::new(0);
        let done = || {
            told.fetch_add(1, Ordering::Relaxed);
            listener.hear(&Event::Simulated { experiment: &experiment.id, count: 1 });
        };
        let outcome = simulate(experiment, &self.task.variants[job.variant], job, evaluate, &done);
        let rest = evaluations(experiment, job).saturating_sub(told.into_inner() as u64);
        listener.hear(&Event::Simulated { experiment: &experiment.id, count: rest });
        outcome
    }
}

/// One row.
fn simulate(
    experiment: &Experiment,
    variant: &Variant,
    job: &Job,
    evaluate: &impl Evaluate,
    done: &(impl Fn() + Sync),
) -> Outcome {
    let recipe = experiment.recipe_of(&experiment.cases[job.case]).map_err(|error| error.to_string())?;
    let wanted = keeps_trace(experiment, job) || measures_need_trace(&experiment.measures);
    let needs_shape = experiment.measures.iter().any(|measure| measure.needs_shape());
    let simulation = Simulation {
        recipe: &recipe,
        assumptions: &variant.assumptions,
        solver: job.solver,
        settings: &experiment.settings,
        measures: &experiment.measures,
        trace: experiment.trace.as_ref().filter(|_| wanted),
        // Only the baseline keeps its lists; a measure of a shape needs it everywhere.
        energies: experiment.energies.as_ref().filter(|_| job.variant == 0),
        shape: experiment.shape.as_ref().filter(|_| job.variant == 0 || needs_shape),
        rigour: if job.variant == 0 { Rigour::Result } else { Rigour::Look },
    };
    let Some(maximise) = &experiment.maximise else {
        let evaluated = evaluate_guarded(evaluate, &simulation);
        done();
        return Ok(Row { evaluated: evaluated?, place: None });
    };
    let measure = tabulate::maximised_index(experiment, maximise.measure)
        .ok_or_else(|| format!("{} is to be maximised and not measured", words::of_key(&maximise.measure)))?;
    // Histories of the points that are not the maximum are not wanted.
    let trace = simulation.trace.filter(|_| measures_need_trace(&experiment.measures));
    let shape = simulation.shape.filter(|_| needs_shape);
    let look = Simulation { trace, energies: None, shape, rigour: Rigour::Look, ..simulation };
    let (found, place) = maximum(evaluate, &look, maximise, measure, done)?;
    if job.variant != 0 {
        return Ok(Row { evaluated: found, place: Some(place) });
    }
    // The row itself is a result: the maximum once more, with all that proves it.
    let mut at_maximum = recipe.clone();
    at_maximum.set(maximise.over, crate::scene::ParameterValue::Number(place.at)).map_err(|error| error.to_string())?;
    let wanted = simulation.trace.filter(|_| keeps_trace(experiment, job) || trace.is_some());
    let evaluated = evaluate_guarded(evaluate, &Simulation { recipe: &at_maximum, trace: wanted, ..simulation })?;
    done();
    Ok(Row { evaluated, place: Some(place) })
}
