//! Random starts of each case, each run until it has settled, and the motions that they end in: a row for each motion of a case.
//!
//! Starts are runs and no more; of each motion the one that settles first is evaluated as a result, with all that is measured and what proves it.
//! Cases are independent: one that an earlier table has is taken over with all its rows.

use rayon::prelude::*;

use super::asked::asked;
use super::evaluate::{Evaluate, Simulation, evaluate_guarded, guarded};
use super::event::{Event, EventHandler};
use super::finished::Finished;
use super::job::{Job, jobs};
use super::known_rows::KnownRows;
use super::row_failure::RowFailure;
use super::row_fingerprint::RowFingerprints;
use super::spent::Meter;
use super::tabulate::Row;
use super::tabulate_basins::{Basin, BasinRow, failures, read, table};
use super::task::Task;
use super::variant::Variant;
use crate::dynamics::{Allowance, MotionKind, is_interrupted};
use crate::experiment::{Experiment, Rank, RowSource, Starts};
use crate::measure::{Ending, Evaluated, FromStarts, Rigour, SolverChoice, TraceColumn};
use crate::scene::Start;

/// RMS velocities that differ by less are those of two mirror images.
const ALIKE: f64 = 1e-9;

/// Runs of all starts.
pub(super) fn simulations(experiment: &Experiment, starts: &Starts, variants: &[Variant]) -> u64 {
    let own = jobs(experiment, variants).iter().filter(|job| job.same_as.is_none()).count();
    own as u64 * u64::from(starts.count)
}

/// Runs it.
pub(super) fn run_basins(
    task: Task<'_>,
    evaluate: &impl Evaluate,
    meter: &Meter,
    handler: &dyn EventHandler,
) -> Finished {
    let Task { experiment, variants, metadata, .. } = task;
    let RowSource::Basins(starts) = experiment.row_source() else { return Finished::default() };
    let jobs = jobs(experiment, variants);
    let fingerprints = RowFingerprints::new(experiment).all(variants, &jobs);
    let known =
        |place: usize| task.known.and_then(|known: &KnownRows| read(experiment, known.group(fingerprints[place])?));
    let running = Running { task, starts, evaluate, meter, handler };
    let of_case = |place: usize| -> Vec<BasinRow> {
        if jobs[place].same_as.is_some() {
            return Vec::new();
        }
        if let Some(rows) = known(place) {
            running.count(starts.count.into());
            return rows;
        }
        running.case(&jobs[place])
    };
    let cases: Vec<Vec<BasinRow>> = (0..jobs.len()).into_par_iter().map(of_case).collect();
    let source = |place: usize| jobs[place].same_as.unwrap_or(place);
    let lines: Vec<(Job, &BasinRow)> = (0..jobs.len())
        .flat_map(|place| cases[source(place)].iter().map(move |row| (place, row)))
        .map(|(place, row)| (jobs[place], row))
        .collect();
    let of_lines = (0..jobs.len()).flat_map(|place| vec![fingerprints[place]; cases[source(place)].len()]).collect();
    let table = table(experiment, starts, variants, &lines, of_lines, metadata.clone());
    Finished { table, failures: failures(&lines), interrupted: is_interrupted(), ..Finished::default() }
}

/// An experiment while it runs.
struct Running<'a, E> {
    task: Task<'a>,
    starts: &'a Starts,
    evaluate: &'a E,
    meter: &'a Meter,
    handler: &'a dyn EventHandler,
}

impl<E: Evaluate> Running<'_, E> {
    fn count(&self, count: u64) {
        self.handler.on_event(&Event::Simulated { experiment: &self.task.experiment.id, count });
    }

    /// A row for each motion of a case, that of the most starts first; one that says why if there are none.
    fn case(&self, job: &Job) -> Vec<BasinRow> {
        let rows = self.endings(job).and_then(|(starts, endings)| self.rows(job, &starts, &endings));
        rows.unwrap_or_else(|reason| {
            let reason = if is_interrupted() { RowFailure::Interrupted } else { reason };
            vec![BasinRow { basin: None, outcome: Err(reason) }]
        })
    }

    /// What becomes of each start.
    fn endings(&self, job: &Job) -> Result<(Vec<Start>, Vec<Ending>), RowFailure> {
        let Task { experiment, variants, limit, .. } = self.task;
        let recipe = experiment.recipe_of(&experiment.cases[job.case])?;
        let scene = recipe.resolve(&variants[job.variant].assumptions)?;
        let from_starts = guarded(|| Ok(FromStarts::new(scene, &experiment.settings)?))?;
        let starts: Vec<Start> =
            (0..self.starts.count).map(|number| self.starts.start(number, from_starts.scene())).collect();
        let run = |start: &Start| {
            let run = || Allowance::new(limit).simulate(|| guarded(|| Ok(from_starts.run(start.clone())?)));
            let ending = if is_interrupted() {
                Err(RowFailure::Interrupted)
            } else {
                self.meter.time(SolverChoice::EventDriven, Rigour::Step, run)
            };
            self.count(1);
            ending
        };
        let endings: Vec<_> = starts.par_iter().map(run).collect();
        let numbered = endings.into_iter().enumerate().map(|(number, ending)| {
            ending.map_err(|reason| RowFailure::Start { number: number + 1, reason: Box::new(reason) })
        });
        let endings = numbered.collect::<Result<Vec<_>, _>>()?;
        Ok((starts, endings))
    }

    fn rows(&self, job: &Job, starts: &[Start], endings: &[Ending]) -> Result<Vec<BasinRow>, RowFailure> {
        let mut found = Ending::basins(endings);
        let names = names(&found, endings);
        let best = best(&found, endings);
        let mut named: Vec<(Vec<usize>, String, Rank)> = Vec::new();
        for (place, (numbers, name)) in found.drain(..).zip(names).enumerate() {
            named.push((numbers, name, if best[place] { Rank::Best } else { Rank::Other }));
        }
        named.sort_by_key(|(numbers, ..)| (std::cmp::Reverse(numbers.len()), numbers[0]));
        let row = |(numbers, name, rank): (Vec<usize>, String, Rank)| {
            let basin = Basin { name, rank, starts: numbers.len(), rms_difference: difference(&numbers, endings) };
            let of_basin: Vec<Start> = numbers.iter().map(|&number| starts[number].clone()).collect();
            let first = numbers.iter().min_by_key(|&&number| endings[number].settled_after()).unwrap_or(&numbers[0]);
            let outcome = self.result(job, &starts[*first]).map(|mut evaluated| {
                let lists = self.starts.columns(&of_basin).into_iter();
                evaluated.trace = lists.map(|(name, unit, values)| TraceColumn::new(name, unit, values)).collect();
                Row { evaluated, place: None }
            });
            BasinRow { basin: Some(basin), outcome }
        };
        Ok(named.into_par_iter().map(row).collect())
    }

    /// The run from one of its starts, as a result.
    fn result(&self, job: &Job, start: &Start) -> Result<Evaluated, RowFailure> {
        let Task { experiment, variants, .. } = self.task;
        let mut recipe = experiment.recipe_of(&experiment.cases[job.case])?;
        recipe.start = Some(start.clone());
        let simulation: Simulation<'_> = asked(experiment, &recipe, &variants[job.variant], job);
        evaluate_guarded(self.evaluate, &simulation)
    }
}

/// The RMS velocities of a basin's starts: of those that have settled, if any has.
fn speeds<'a>(numbers: &'a [usize], endings: &'a [Ending]) -> impl Iterator<Item = f64> + 'a {
    let some = numbers.iter().any(|&number| endings[number].settled.is_some());
    let of_period = move |number: &&usize| !some || endings[**number].settled.is_some();
    numbers.iter().filter(of_period).map(|&number| endings[number].rms_velocity)
}

/// Their mean.
fn speed(numbers: &[usize], endings: &[Ending]) -> f64 {
    speeds(numbers, endings).sum::<f64>() / speeds(numbers, endings).count() as f64
}

/// How far they lie apart, relative to the largest.
fn difference(numbers: &[usize], endings: &[Ending]) -> f64 {
    let most = speeds(numbers, endings).fold(0.0, f64::max);
    let least = speeds(numbers, endings).fold(f64::INFINITY, f64::min);
    if most > 0.0 { (most - least) / most } else { 0.0 }
}

/// The names of motions; of several of one name the second by RMS velocity is `periodic 1:1 (2)`.
fn names(basins: &[Vec<usize>], endings: &[Ending]) -> Vec<String> {
    let kind = |place: usize| endings[basins[place][0]].motion.kind;
    let of_name = |place: usize| {
        let name = kind(place).to_string();
        let own = speed(&basins[place], endings);
        let before = (0..basins.len()).filter(|&other| {
            let its = speed(&basins[other], endings);
            other != place && kind(other) == kind(place) && (its < own || (its == own && other < place))
        });
        match before.count() {
            0 => name,
            more => format!("{name} ({})", more + 1),
        }
    };
    (0..basins.len()).map(of_name).collect()
}

/// Of each motion whether no other one has a smaller RMS velocity, two mirror images alike, by no more than those of one motion lie
/// apart; what has not settled is none.
fn best(basins: &[Vec<usize>], endings: &[Ending]) -> Vec<bool> {
    let settled = |numbers: &[usize]| endings[numbers[0]].motion.kind != MotionKind::NotSettled;
    let all = || {
        basins
            .iter()
            .filter(|numbers| settled(numbers))
            .map(|numbers| [speed(numbers, endings), difference(numbers, endings)])
    };
    let [least, apart] = all().min_by(|one, other| one[0].total_cmp(&other[0])).unwrap_or([f64::NAN; 2]);
    let is_best = |numbers: &Vec<usize>| {
        let known = ALIKE.max(apart).max(difference(numbers, endings));
        settled(numbers) && speed(numbers, endings) <= least * (1.0 + known)
    };
    basins.iter().map(is_best).collect()
}
