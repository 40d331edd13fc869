//! What simulations have cost, so that the next run can say how long it will take: processor time, metered where the engine
//! is asked, by experiment and by kind of simulation. It stands beside the results and in nothing that is handed on.

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::sync::Mutex;

use cpu_time::ThreadTime;
use serde::{Deserialize, Serialize};

use super::evaluate::{Array, Evaluate, Simulation};
use super::layout::Layout;
use super::row_failure::RowFailure;
use crate::atomic;
use crate::experiment::{ExperimentId, GapWord};
use crate::measure::{Evaluated, Measure, Rigour, SolverChoice};
use crate::optimise::Slope;
use crate::text::json;

/// The folder of what was spent, within the study.
pub(super) const FOLDER: &str = "results/times";

/// The file of an experiment, within the study.
pub(super) fn name(id: &ExperimentId) -> String {
    format!("{FOLDER}/{id}.json")
}

/// Simulations of one kind, and what they took together.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
pub struct Cost {
    /// How many.
    pub simulations: u64,
    /// Processor time, s.
    pub seconds: f64,
}

/// What an experiment has cost, by solver and rigour: a result takes several runs and a whole ensemble, a step one.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct Spent(BTreeMap<String, Cost>);

impl Spent {
    /// What is known of an experiment; nothing if that cannot be read.
    #[must_use]
    pub fn read(layout: &Layout, id: &ExperimentId) -> Self {
        let bytes = fs::read(layout.path(&name(id))).unwrap_or_default();
        serde_json::from_slice(&bytes).unwrap_or_default()
    }

    /// True if nothing was simulated.
    #[must_use]
    pub fn is_nothing(&self) -> bool {
        self.0.is_empty()
    }

    /// Keeps it, beside what an earlier run has spent on much more of the same. Without it nothing is lost but a guess.
    pub(super) fn keep(&self, layout: &Layout, id: &ExperimentId) {
        let mut all = Self::read(layout, id);
        let is_more = |solver: &str| {
            let most = |spent: &Self| spent.of_solver(solver).map(|(_, cost)| cost.simulations).max().unwrap_or(0);
            2 * most(self) >= most(&all)
        };
        let solvers: BTreeSet<&str> =
            self.0.keys().map(|kind| solver_of(kind)).filter(|solver| is_more(solver)).collect();
        // Looks belong to the steps that they follow: kinds of one solver stand together.
        all.0.retain(|kind, _| !solvers.contains(solver_of(kind)));
        let kept = self.0.iter().filter(|(kind, _)| solvers.contains(solver_of(kind)));
        all.0.extend(kept.map(|(kind, cost)| (kind.clone(), *cost)));
        if !self.is_nothing() {
            let _ = atomic::write(&layout.path(&name(id)), json::line(&all).as_bytes());
        }
    }

    /// Forgets what is known of an experiment: a run from scratch measures all of it again.
    pub fn forget(layout: &Layout, id: &ExperimentId) {
        let _ = fs::remove_file(layout.path(&name(id)));
    }

    /// Estimated time of `simulations` of the first of these kinds with what they bring with them of the others, s; by others of the same
    /// solver if there was none so far, and `None` without any.
    pub(super) fn ahead(&self, solver: SolverChoice, rigours: &[Rigour], simulations: u64) -> Option<f64> {
        if simulations == 0 {
            return Some(0.0);
        }
        let mut known: Vec<&Cost> = rigours.iter().filter_map(|rigour| self.0.get(&kind(solver, *rigour))).collect();
        if known.is_empty() {
            known.extend(self.of_solver(&solver.label()).next().map(|(_, cost)| cost));
        }
        let before = known.first()?.simulations;
        let seconds: f64 = known.iter().map(|cost| cost.seconds).sum();
        (before > 0).then(|| seconds / before as f64 * simulations as f64)
    }

    /// The kinds of one solver.
    fn of_solver(&self, solver: &str) -> impl Iterator<Item = (&String, &Cost)> {
        self.0.iter().filter(move |(kind, _)| solver_of(kind) == solver)
    }

    /// What a simulation took on average, s; `None` if there was none.
    pub(super) fn each(&self) -> Option<f64> {
        let simulations: u64 = self.0.values().map(|cost| cost.simulations).sum();
        (simulations > 0).then_some(self.total()? / simulations as f64)
    }

    /// All of it, s; `None` if there is nothing.
    pub(super) fn total(&self) -> Option<f64> {
        (!self.is_nothing()).then(|| self.0.values().map(|cost| cost.seconds).sum())
    }
}

/// The first word of a kind.
fn solver_of(kind: &str) -> &str {
    kind.split(' ').next().unwrap_or(kind)
}

fn kind(solver: SolverChoice, rigour: Rigour) -> String {
    let rigour = match rigour {
        Rigour::Result => "result",
        Rigour::Variant => "variant",
        Rigour::Look => "look",
        Rigour::Step => "step",
    };
    format!("{} {rigour}", solver.label())
}

/// Adds up what is spent; asked from many threads.
#[derive(Debug, Default)]
pub(super) struct Meter(Mutex<Spent>);

impl Meter {
    pub(super) fn time<T>(&self, solver: SolverChoice, rigour: Rigour, simulate: impl FnOnce() -> T) -> T {
        // A simulation stays on its thread.
        let begun = ThreadTime::now();
        let done = simulate();
        let seconds = begun.elapsed().as_secs_f64();
        if let Ok(mut spent) = self.0.lock() {
            let cost = spent.0.entry(kind(solver, rigour)).or_default();
            cost.simulations += 1;
            cost.seconds += seconds;
        }
        done
    }

    pub(super) fn spent(&self) -> Spent {
        self.0.lock().map(|spent| spent.clone()).unwrap_or_default()
    }
}

/// An engine with a meter.
pub(super) struct Metered<'a, E> {
    pub evaluate: &'a E,
    pub meter: &'a Meter,
}

impl<E: Evaluate> Evaluate for Metered<'_, E> {
    fn evaluate(&self, simulation: &Simulation<'_>) -> Result<Evaluated, RowFailure> {
        self.meter.time(simulation.solver, simulation.request.rigour, || self.evaluate.evaluate(simulation))
    }

    fn array<'a>(&'a self, simulation: Simulation<'a>, word: GapWord) -> Result<Box<dyn Array + 'a>, RowFailure> {
        let array = self.evaluate.array(simulation, word)?;
        Ok(Box::new(MeteredArray { array, meter: self.meter, solver: simulation.solver }))
    }
}

struct MeteredArray<'a> {
    array: Box<dyn Array + 'a>,
    meter: &'a Meter,
    solver: SolverChoice,
}

impl Array for MeteredArray<'_> {
    fn evaluate(&self, gaps: &[f64], rigour: Rigour) -> Result<Evaluated, RowFailure> {
        self.meter.time(self.solver, rigour, || self.array.evaluate(gaps, rigour))
    }

    fn slope(&self, gaps: &[f64], measure: Measure) -> Result<Option<Slope>, RowFailure> {
        self.meter.time(self.solver, Rigour::Step, || self.array.slope(gaps, measure))
    }
}
