//! The runner: rows of many experiments side by side, each experiment's table in its own order.
//!
//! Every row is computed by one thread from its own input alone and put into its own place, so the bytes of a table do not
//! depend on the number of threads. Long rows start first. An experiment is handed over as soon as its last row is done:
//! who stops the program loses the experiments under way and no others.

use std::collections::BTreeMap;
use std::sync::OnceLock;
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::mpsc::{self, RecvTimeoutError};
use std::time::Duration;

use rayon::prelude::*;

use super::asked::rigours_of_others;
use super::basins::run_basins;
use super::evaluate::Evaluate;
use super::event::{Event, EventHandler};
use super::finished::Finished;
use super::job::{self, Job, cost, units};
use super::keeping::Keeping;
use super::limited::Limited;
use super::optimise::run_optimisation;
use super::orbit::run_branches;
use super::refine;
use super::row::outcome;
use super::size;
use super::spent::{Meter, Metered};
use super::tabulate::Outcome;
use super::task::Task;
use super::work::Work;
use crate::dynamics::{is_interrupted, keeping_runs};
use crate::experiment::{Case, Experiment, RowSource};
use crate::scene::Scene;

/// Why a run is not complete.
#[derive(Debug, thiserror::Error)]
pub enum RunError {
    /// It could not even start.
    #[error("cannot start the threads: {0}")]
    Threads(#[from] rayon::ThreadPoolBuildError),
    /// The process was asked to end; what was finished by then has been handed over.
    #[error("interrupted")]
    Interrupted,
}

/// How often the watch looks for an interrupt.
const LOOK: Duration = Duration::from_millis(20);
/// How long threads may take to notice it.
const GRACE: Duration = Duration::from_millis(200);
/// Where recursion into other rows' work may end up needs room.
const STACK: usize = 16 << 20;

/// Runs the tasks on `threads` threads (0: one a processor) and hands each finished experiment, by its index, to
/// `take`, on the thread that finished it. Returns what `take` returned, in the order of the tasks.
///
/// # Errors
/// If the threads cannot be started, or the process is interrupted: experiments under way are then handed over with the
/// rows that they have.
pub fn run<T: Send + Sync>(
    tasks: &[Task<'_>],
    threads: usize,
    evaluate: &impl Evaluate,
    handler: &dyn EventHandler,
    take: impl Fn(usize, Finished) -> T + Sync,
) -> Result<Vec<T>, RunError> {
    let (whole, swept): (Vec<usize>, Vec<usize>) = (0..tasks.len()).partition(|&i| tasks[i].experiment.is_whole());
    let (refined, plain): (Vec<usize>, Vec<usize>) =
        swept.into_iter().partition(|&i| !tasks[i].experiment.refined.is_empty());
    let work: Vec<(usize, Work<'_>)> = plain.into_iter().map(|index| (index, Work::new(tasks[index]))).collect();
    let of_divided: u64 = work.iter().map(|(_, one)| one.simulations()).sum();
    let of_others = whole.iter().chain(&refined).map(|&i| size::simulations(tasks[i].experiment, tasks[i].variants));
    handler.on_event(&Event::Begun { experiments: tasks.len(), simulations: of_divided + of_others.sum::<u64>() });
    let taken: Vec<OnceLock<T>> = tasks.iter().map(|_| OnceLock::new()).collect();
    let meters: Vec<Meter> = tasks.iter().map(|_| Meter::default()).collect();
    let engine = |index: usize| Metered { evaluate, meter: &meters[index] };
    // What is under way is counted from before its rows are made into a table.
    let hand_over = |index: usize, _keeping: Keeping, mut finished: Finished| {
        finished.spent = meters[index].spent();
        let (rows, failures, seconds) = (finished.table.rows(), finished.failures.clone(), finished.spent.total());
        let left = finished.interrupted.then(|| finished.left(tasks[index]));
        // Only the thread that put the last row comes here, once; after an interrupt the watch may have come before.
        if taken[index].set(take(index, finished)).is_ok() {
            let experiment = &tasks[index].experiment.id;
            handler.on_event(&match left {
                Some(left) => Event::Interrupted { experiment, left },
                None => Event::Finished { experiment, rows, failures: &failures, seconds },
            });
        }
    };
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).stack_size(STACK).build()?;
    let rescue = || {
        for (index, one) in work.iter().filter(|(index, one)| taken[*index].get().is_none() && one.has_rows()) {
            hand_over(*index, Keeping::begin(), one.finish());
        }
    };
    beside(&rescue, || {
        pool.install(|| {
            let (work, engine, meters, hand_over) = (&work, &engine, &meters, &hand_over);
            rayon::scope_fifo(|scope| {
                // Their rounds wait for one another: they begin first.
                for index in whole {
                    scope.spawn_fifo(move |_| {
                        let task = tasks[index];
                        let (meter, engine) = (&meters[index], engine(index));
                        let limited = Limited::each(&engine, task.limit);
                        let finished = match task.experiment.row_source() {
                            RowSource::Branches(_) => run_branches(task, meter, handler),
                            RowSource::Basins(_) => run_basins(task, &limited, meter, handler),
                            RowSource::Cases | RowSource::Search(_) => run_optimisation(task, &limited, handler),
                        };
                        hand_over(index, Keeping::begin(), undivided(task, finished));
                    });
                }
                for index in refined {
                    scope.spawn_fifo(move |_| {
                        let take = |work: &Work<'_>| {
                            hand_over(index, Keeping::begin(), undivided(tasks[index], work.finish()))
                        };
                        run_refined(tasks[index], &engine(index), handler, take);
                    });
                }
                for (one, units) in order(work) {
                    scope.spawn_fifo(move |_| {
                        let (index, one) = &work[one];
                        let put = |row, outcome| {
                            if one.put(row, outcome) {
                                hand_over(*index, Keeping::begin(), one.finish());
                            }
                        };
                        one_by_one(one, &units, &engine(*index), handler, put);
                    });
                }
            });
        })
    });
    handler.on_event(&Event::Ended);
    if is_interrupted() {
        return Err(RunError::Interrupted);
    }
    Ok(taken
        .into_iter()
        .enumerate()
        .map(|(index, taken)| match taken.into_inner() {
            Some(taken) => taken,
            // An experiment without rows never has a last one.
            None => take(index, Finished::default()),
        })
        .collect())
}

/// Does the work, with a watch beside it: where an interrupt finds a thread in a computation that asks for none, such as
/// the decomposition of a large matrix, the watch calls `rescue` while the process still lives.
fn beside(rescue: &(impl Fn() + Sync), work: impl FnOnce()) {
    std::thread::scope(|scope| {
        let (over, wait) = mpsc::channel::<()>();
        scope.spawn(move || {
            let goes_on = |time| wait.recv_timeout(time) == Err(RecvTimeoutError::Timeout);
            while goes_on(LOOK) {
                if is_interrupted() {
                    if goes_on(GRACE) {
                        rescue();
                    }
                    return;
                }
            }
        });
        work();
        drop(over);
    });
}

/// A shard's table of an experiment that it has as a whole.
fn undivided(task: Task<'_>, mut finished: Finished) -> Finished {
    if let Some(shard) = task.shard {
        let places: Vec<usize> = (0..finished.table.rows()).collect();
        shard.mark(&mut finished.table, &places);
    }
    finished
}

/// Runs an experiment whose curves get more points where they bend: first the curves, then all else at their points.
fn run_refined(task: Task<'_>, evaluate: &impl Evaluate, handler: &dyn EventHandler, hand_over: impl Fn(&Work<'_>)) {
    let counting = Counting { handler, simulations: AtomicU64::new(0) };
    let look = |case: &Case| outcome(task, case, &job::first_of(case), evaluate, &counting);
    let points = refine::points(task.experiment, &task.variants[0].assumptions, &look);
    let cases = points.iter().map(|point| point.case.clone()).collect();
    let experiment = Experiment { cases, ..task.experiment.clone() };
    let work = Work::new(Task { experiment: &experiment, shard: None, ..task });
    let mut first_rows = vec![None; experiment.cases.len()];
    for (row, job) in work.jobs.iter().enumerate().filter(|(_, job)| job.variant == 0) {
        first_rows[job.case].get_or_insert(row);
    }
    for (point, row) in points.into_iter().zip(first_rows) {
        if let (Some(known), Some(row)) = (point.known, row) {
            work.put(row, known);
        }
    }
    let put = |row, outcome| {
        work.put(row, outcome);
    };
    together(&work).into_par_iter().for_each(|units| one_by_one(&work, &units, evaluate, &counting, put));
    let left = size::simulations(task.experiment, task.variants).saturating_sub(counting.simulations.into_inner());
    handler.on_event(&Event::Simulated { experiment: &experiment.id, count: left });
    hand_over(&work);
}

/// Passes the events on, and counts the simulations.
struct Counting<'a> {
    handler: &'a dyn EventHandler,
    simulations: AtomicU64,
}

impl EventHandler for Counting<'_> {
    fn on_event(&self, event: &Event<'_>) {
        if let Event::Simulated { count, .. } = event {
            self.simulations.fetch_add(*count, Ordering::Relaxed);
        }
        self.handler.on_event(event);
    }
}

/// What is done one after the other: chains of rows, and lists of them.
type Units = Vec<Vec<usize>>;

/// Rows in the order in which to start them, chains of rows as one: the experiment with the longest first, in it the longest first.
fn order(work: &[(usize, Work<'_>)]) -> Vec<(usize, Units)> {
    let mut order: Vec<(f64, f64, usize, Units)> = Vec::new();
    for (index, (_, one)) in work.iter().enumerate() {
        let cost = |row: &usize| cost(one.task.experiment, one.task.variants, &one.jobs[*row]);
        let units: Vec<(f64, Units)> =
            together(one).into_iter().map(|units| (units.iter().flatten().map(cost).sum(), units)).collect();
        let longest = units.iter().map(|(cost, _)| *cost).fold(0.0, f64::max);
        order.extend(units.into_iter().map(|(cost, units)| (longest, cost, index, units)));
    }
    order.sort_by(|a, b| b.0.total_cmp(&a.0).then(a.2.cmp(&b.2)).then(b.1.total_cmp(&a.1)).then(a.3.cmp(&b.3)));
    order.into_iter().map(|(_, _, index, units)| (index, units)).collect()
}

/// Does units that may make the same runs. A row whose maximum is looked for makes some of them again itself: looks follow steps.
fn one_by_one(
    work: &Work<'_>,
    units: &Units,
    evaluate: &impl Evaluate,
    handler: &dyn EventHandler,
    put: impl Fn(usize, Outcome) + Copy,
) {
    let all = || units.iter().for_each(|rows| work.unit(rows, evaluate, handler, put));
    let looks_follow_steps = rigours_of_others(work.task.experiment).len() > 1;
    if units.len() > 1 || looks_follow_steps { keeping_runs(all) } else { all() }
}

/// Rows to be done of a case whose scene is the same, one after the other: an assumption that enters the reference, or the kind of mean,
/// alone leaves their runs as they are. Threads without a case of their own share the points and settings of a row.
fn together(work: &Work<'_>) -> Vec<Units> {
    let Task { experiment, variants, .. } = work.task;
    let scene = |row: usize| {
        let Job { case, variant, .. } = work.jobs[row];
        experiment.first_scene(&experiment.cases[case], &variants[variant].assumptions)
    };
    let mut all: Vec<Units> = Vec::new();
    let mut of_case: BTreeMap<usize, Vec<(Option<Scene>, usize)>> = BTreeMap::new();
    for mut rows in units(experiment, &work.jobs) {
        rows.retain(|row| work.is_open(*row));
        if rows.is_empty() {
            continue;
        }
        if let [row] = rows[..]
            && variants.len() > 1
        {
            let (known, scene) = (of_case.entry(work.jobs[row].case).or_default(), scene(row));
            if let Some((_, place)) = known.iter().find(|(other, _)| *other == scene) {
                all[*place].push(rows);
                continue;
            }
            known.push((scene, all.len()));
        }
        all.push(vec![rows]);
    }
    all
}
