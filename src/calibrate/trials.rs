//! Runs experiments under sets of inputs, each combination once.

use std::collections::{BTreeMap, BTreeSet};
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};

use super::rows::Wanted;
use super::set::Set;
use crate::experiment::{Experiment, GapWord};
use crate::measure::{Evaluated, Measure, Request, Rigour, SolverChoice};
use crate::optimise::Slope;
use crate::reference::Entry;
use crate::study::{
    Array, Evaluate, Event, EventHandler, Finished, RowFailure, RunError, Simulation, Task, Variant, run,
};
use crate::table::{BASELINE, Table};

/// An entry with the id of its experiment.
pub type Asked<'a> = (&'a str, &'a Entry);
/// Tables by experiment.
pub(super) type SharedTables = BTreeMap<String, Arc<Table>>;

/// What a number has to be worth.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Worth {
    /// One step of a search: the mean of `ensemble` runs where the motion is chaotic; 0: a single run, as published numbers mostly are.
    Step { ensemble: u32 },
    /// A result, of an ensemble where the motion is chaotic.
    Result,
}

/// The threads, the engine, and the handler of events.
pub(super) struct Workers<'a, E> {
    pub threads: usize,
    pub evaluate: &'a E,
    pub handler: &'a dyn EventHandler,
}

/// The experiments that entries read, ready to be run under any inputs.
pub(super) struct TrialRunner<'a, E> {
    workers: &'a Workers<'a, E>,
    worth: Worth,
    experiments: Vec<Experiment>,
    /// By experiment and all that its numbers depend on.
    known: BTreeMap<(usize, String), Arc<Table>>,
}

/// What is to be run, by experiment and all that its numbers depend on.
type New = BTreeMap<(usize, String), [Variant; 1]>;

/// A set of inputs, and what of it each experiment depends on.
pub(super) struct Trial {
    set: Set,
    inputs: Vec<String>,
}

impl Trial {
    /// All that the numbers of an experiment depend on.
    pub(super) fn inputs(&self, experiment: usize) -> &str {
        &self.inputs[experiment]
    }

    /// Of all experiments.
    pub(super) fn into_inputs(self) -> Vec<String> {
        self.inputs
    }
}

impl<'a, E: Evaluate> TrialRunner<'a, E> {
    pub(super) fn new(
        workers: &'a Workers<'a, E>,
        worth: Worth,
        experiments: &[&Experiment],
        asked: &[Asked<'_>],
    ) -> Self {
        let mut wanted: BTreeMap<String, Wanted> = BTreeMap::new();
        for (home, entry) in asked {
            let read: BTreeSet<String> = entry.readings(home).into_iter().map(|reading| reading.experiment).collect();
            for id in read {
                wanted.entry(id.clone()).or_default().add(entry, home, &id);
            }
        }
        let part = |experiment: &&Experiment| {
            let mut part = wanted.get(&experiment.id.0)?.of(experiment);
            if let Worth::Step { ensemble } = worth {
                part.settings.ensemble = ensemble;
            }
            Some(part)
        };
        Self { workers, worth, experiments: experiments.iter().filter_map(part).collect(), known: BTreeMap::new() }
    }

    /// The experiments, each with the rows that are read.
    pub(super) fn experiments(&self) -> &[Experiment] {
        &self.experiments
    }

    /// A set, ready to be run.
    pub(super) fn trial(&self, set: &Set) -> Trial {
        Trial { inputs: self.experiments.iter().map(|one| dependencies(one, set)).collect(), set: set.clone() }
    }

    /// The tables under each of the sets.
    pub(super) fn tables(&mut self, sets: &[Set]) -> Result<Vec<SharedTables>, RunError> {
        let trials: Vec<Trial> = sets.iter().map(|set| self.trial(set)).collect();
        let all = 0..self.experiments.len();
        self.run_all(all.flat_map(|index| trials.iter().map(move |trial| (index, trial))))?;
        Ok(trials.iter().map(|trial| self.known_tables(trial)).collect())
    }

    /// Runs one of the experiments where that is new.
    pub(super) fn run(&mut self, experiment: usize, trials: &[&Trial]) -> Result<(), RunError> {
        self.run_all(trials.iter().map(|trial| (experiment, *trial)))
    }

    /// All of these experiments have been run.
    pub(super) fn has(&self, trial: &Trial, experiments: &BTreeSet<usize>) -> bool {
        experiments.iter().all(|&index| self.known.contains_key(&(index, trial.inputs[index].clone())))
    }

    /// The tables of the experiments that have been run.
    pub(super) fn known_tables(&self, trial: &Trial) -> SharedTables {
        let known = |index: usize| self.known.get(&(index, trial.inputs[index].clone())).cloned();
        let each = (0..self.experiments.len()).filter_map(|index| Some((index, known(index)?)));
        each.map(|(index, table)| (self.experiments[index].id.to_string(), table)).collect()
    }

    fn run_all<'t>(&mut self, wanted: impl Iterator<Item = (usize, &'t Trial)>) -> Result<(), RunError> {
        let mut solvers: Vec<(SolverChoice, New)> = Vec::new();
        for (index, trial) in wanted {
            let key = (index, trial.inputs[index].clone());
            if self.known.contains_key(&key) {
                continue;
            }
            let Set { assumptions, solver } = &trial.set;
            let place = solvers.iter().position(|(known, _)| known == solver).unwrap_or_else(|| {
                solvers.push((*solver, New::new()));
                solvers.len() - 1
            });
            let variant = || [Variant { label: BASELINE.into(), moved: None, assumptions: assumptions.clone() }];
            solvers[place].1.entry(key).or_insert_with(variant);
        }
        for (solver, new) in solvers {
            let metadata = BTreeMap::new();
            let tasks: Vec<Task<'_>> = new
                .iter()
                .map(|((index, _), variants)| Task::new(&self.experiments[*index], variants, &metadata))
                .collect();
            let evaluate = Substituted { evaluate: self.workers.evaluate, solver, worth: self.worth };
            let take = |_, finished: Finished| Arc::new(finished.table);
            let tables = run(&tasks, self.workers.threads, &evaluate, self.workers.handler, take)?;
            self.known.extend(new.into_keys().zip(tables));
        }
        Ok(())
    }
}

/// All that the numbers of an experiment depend on under this set.
fn dependencies(experiment: &Experiment, set: &Set) -> String {
    let used = experiment.assumptions_under(&set.assumptions);
    let values: Vec<_> = set.assumptions.values.iter().filter(|(name, _)| used.contains(name)).collect();
    format!("{:?} {values:?}", set.solver)
}

/// Substitutes another solver for the exact one, and single runs for steps.
struct Substituted<'a, E> {
    evaluate: &'a E,
    solver: SolverChoice,
    worth: Worth,
}

impl<E> Substituted<'_, E> {
    fn simulation<'s>(&self, it: &Simulation<'s>) -> Simulation<'s> {
        let solver = if it.solver == SolverChoice::EventDriven { self.solver } else { it.solver };
        // The steps of a maximum ask for ensembles themselves.
        let asked = it.request.rigour;
        let rigour = if asked == Rigour::Step { asked } else { self.worth.rigour(asked) };
        Simulation { solver, request: Request { rigour, ..it.request }, ..*it }
    }
}

impl<E: Evaluate> Evaluate for Substituted<'_, E> {
    fn evaluate(&self, it: &Simulation<'_>) -> Result<Evaluated, RowFailure> {
        self.evaluate.evaluate(&self.simulation(it))
    }

    fn array<'a>(&'a self, it: Simulation<'a>, word: GapWord) -> Result<Box<dyn Array + 'a>, RowFailure> {
        let array = self.evaluate.array(self.simulation(&it), word)?;
        Ok(Box::new(SubstitutedArray { array, worth: self.worth }))
    }
}

struct SubstitutedArray<'a> {
    array: Box<dyn Array + 'a>,
    worth: Worth,
}

impl Array for SubstitutedArray<'_> {
    fn evaluate(&self, gaps: &[f64], rigour: Rigour) -> Result<Evaluated, RowFailure> {
        self.array.evaluate(gaps, self.worth.rigour(rigour))
    }

    fn slope(&self, gaps: &[f64], measure: Measure) -> Result<Option<Slope>, RowFailure> {
        self.array.slope(gaps, measure)
    }
}

impl Worth {
    fn rigour(self, asked: Rigour) -> Rigour {
        match self {
            Self::Step { ensemble: 0 } => Rigour::Step,
            Self::Step { .. } => Rigour::Look,
            Self::Result => asked,
        }
    }
}

/// Passes on the events of many runs as those of one, whose size is known only at the end.
pub(super) struct CumulativeEvents<'a> {
    handler: &'a dyn EventHandler,
    simulations: AtomicU64,
}

impl<'a> CumulativeEvents<'a> {
    pub(super) fn new(handler: &'a dyn EventHandler) -> Self {
        Self { handler, simulations: AtomicU64::new(0) }
    }
}

impl EventHandler for CumulativeEvents<'_> {
    fn on_event(&self, event: &Event<'_>) {
        match event {
            Event::Begun { experiments, simulations } => {
                let simulations = self.simulations.fetch_add(*simulations, Ordering::Relaxed) + simulations;
                self.handler.on_event(&Event::Begun { experiments: *experiments, simulations });
            }
            // The end of one run is not the end of all.
            Event::Ended | Event::Finished { .. } | Event::Interrupted { .. } => {}
            other => self.handler.on_event(other),
        }
    }
}
