//! What simulations have cost, so that the next run can say how long it will take: processor time, metered where the engine
//! is asked, by experiment and by kind of simulation. It stands beside the results and in nothing that is handed on.

use std::collections::BTreeMap;
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
        for (kind, new) in &self.0 {
            let old = all.0.entry(kind.clone()).or_default();
            if 2 * new.simulations >= old.simulations {
                *old = *new;
            }
        }
        if let Ok(text) = serde_json::to_vec(&all)
            && !self.is_nothing()
        {
            let _ = atomic::write(&layout.path(&name(id)), &text);
        }
    }

    /// Forgets what is known of an experiment: a run from scratch measures all of it again.
    pub fn forget(layout: &Layout, id: &ExperimentId) {
        let _ = fs::remove_file(layout.path(&name(id)));
    }

    /// Estimated time of `simulations` of a kind, s; by others of the same solver if there was none so far, and `None` without any.
    pub(super) fn ahead(&self, solver: SolverChoice, rigour: Rigour, simulations: u64) -> Option<f64> {
        if simulations == 0 {
            return Some(0.0);
        }
        let of_solver = || self.0.iter().find(|(kind, _)| kind.starts_with(&format!("{} ", solver.label())));
        let known = self.0.get(&kind(solver, rigour)).or_else(|| of_solver().map(|(_, cost)| cost));
        let Cost { simulations: before, seconds } = *known?;
        (before > 0).then(|| seconds / before as f64 * simulations as f64)
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
        self.meter.time(simulation.solver, simulation.rigour, || self.evaluate.evaluate(simulation))
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
