//! Residuals of sets of inputs, one experiment after the other: a set is given up once its entries prove that it cannot matter.
//!
//! R² = (1/n) Σ e², and no square is negative: the entries that are known give a bound from below. A search names with each
//! set the level above which its residual changes nothing (`search`); a set whose bound exceeds it is not run any further. If
//! a later step needs it after all, only what is missing is run. Experiments with few simulations for each entry come first.

use std::collections::{BTreeMap, BTreeSet};

use super::journal::{EntryError, Journal, Weighed};
use super::search::Residue;
use super::set::Set;
use super::trials::{Asked, SharedTables, Trial, TrialRunner};
use crate::dynamics::SOLVER_VERSION;
use crate::experiment::{Experiment, Residual, curves};
use crate::reference::{Entry, Found, TableState, Tables};
use crate::study::{Evaluate, Event, EventHandler, RunError, fingerprint, runs_of_a_row};
use crate::table::BASELINE;
use crate::text::json;

/// What rounding may leave of a bound.
const ROUNDING: f64 = 1e-9;

/// The fitted entries, and what is known of their errors.
pub(super) struct Residuals<'a, E> {
    kind: Residual,
    fit: &'a [Asked<'a>],
    trials: TrialRunner<'a, E>,
    /// The experiments that each entry reads, by their index among those of `trials`.
    read_by: Vec<BTreeSet<usize>>,
    /// The experiments in the order in which they are run.
    order: Vec<usize>,
    /// Of each entry a hash of itself and of the rows that it reads.
    meanings: Vec<String>,
    journal: Journal,
    handler: &'a dyn EventHandler,
    /// Of each set whether it was given up.
    given_up: BTreeMap<Vec<String>, bool>,
    best: Option<f64>,
}

/// A set while its residual is found.
struct Open {
    trial: Trial,
    level: f64,
    /// Of each entry.
    errors: Vec<Option<EntryError>>,
}

impl<'a, E: Evaluate> Residuals<'a, E> {
    pub(super) fn new(
        kind: Residual,
        fit: &'a [Asked<'a>],
        trials: TrialRunner<'a, E>,
        journal: Journal,
        handler: &'a dyn EventHandler,
    ) -> Self {
        let place = |id: &str| trials.experiments().iter().position(|one| one.id.0 == id);
        let read_by: Vec<BTreeSet<usize>> = fit
            .iter()
            .map(|(home, entry)| entry.readings(home).iter().filter_map(|reading| place(&reading.experiment)).collect())
            .collect();
        let price = |index: &usize| {
            let entries = read_by.iter().filter(|read| read.contains(index)).count();
            simulations(&trials.experiments()[*index]) / entries.max(1) as f64
        };
        let mut order: Vec<usize> = (0..trials.experiments().len()).collect();
        order.sort_by(|a, b| price(a).total_cmp(&price(b)).then(a.cmp(b)));
        let meanings = fit
            .iter()
            .zip(&read_by)
            .map(|((_, entry), read)| {
                let rows = read.iter().map(|&index| trials.experiments()[index].simulation_json());
                fingerprint(&serde_json::json!([
                    SOLVER_VERSION,
                    format!("{kind:?}"),
                    json::value(&entry.check),
                    json::value(&entry.rows),
                    rows.collect::<Vec<_>>(),
                ]))
            })
            .collect();
        Self { kind, fit, trials, read_by, order, meanings, journal, handler, given_up: BTreeMap::new(), best: None }
    }

    /// What becomes of each set, as far as its level asks.
    pub(super) fn of(&mut self, asked: &[(Set, f64)]) -> Result<Vec<Residue>, RunError> {
        let mut sets: Vec<Open> = asked.iter().map(|(set, level)| self.open(set, *level)).collect();
        self.run(&mut sets, |set| residue(set).is_none())?;
        let residues: Vec<Residue> = sets.iter().map(|set| residue(set).unwrap_or(Residue::Exact(None))).collect();
        self.tell(sets, &residues);
        Ok(residues)
    }

    /// Of each set the errors of all entries.
    pub(super) fn errors(&mut self, asked: &[Set]) -> Result<Vec<Vec<EntryError>>, RunError> {
        let mut sets: Vec<Open> = asked.iter().map(|set| self.open(set, f64::INFINITY)).collect();
        self.run(&mut sets, |_| true)?;
        let all = |set: Open| set.errors.into_iter().map(Option::flatten).collect();
        Ok(sets.into_iter().map(all).collect())
    }

    /// Runs, one experiment after the other, what is missing of the sets that are still `wanted`.
    fn run(&mut self, sets: &mut [Open], wanted: impl Fn(&Open) -> bool) -> Result<(), RunError> {
        for index in self.order.clone() {
            let missing = |one: &Open| {
                let read = self.read_by.iter().zip(&one.errors);
                read.into_iter().any(|(read, error)| error.is_none() && read.contains(&index))
            };
            let trials: Vec<&Trial> =
                sets.iter().filter(|one| wanted(one) && missing(one)).map(|one| &one.trial).collect();
            self.trials.run(index, &trials)?;
            let mut new = Vec::new();
            for set in &mut *sets {
                self.read(set, &mut new);
            }
            self.journal.add(new);
        }
        Ok(())
    }

    fn open(&self, set: &Set, level: f64) -> Open {
        let trial = self.trials.trial(set);
        let known = |entry: usize| self.journal.get(&self.key(entry, &trial));
        let errors = (0..self.fit.len()).map(known).collect();
        Open { trial, level, errors }
    }

    /// Reads the entries whose experiments have all been run.
    fn read(&self, set: &mut Open, new: &mut Vec<(String, EntryError)>) {
        for (entry, asked) in self.fit.iter().enumerate() {
            let read = &self.read_by[entry];
            if set.errors[entry].is_some() || !self.trials.has(&set.trial, read) {
                continue;
            }
            let error = error(self.kind, asked, found(asked, &self.trials.known_tables(&set.trial)));
            set.errors[entry] = Some(error);
            new.push((self.key(entry, &set.trial), error));
        }
    }

    /// All that the error of an entry depends on.
    fn key(&self, entry: usize, trial: &Trial) -> String {
        let inputs: Vec<&str> = self.read_by[entry].iter().map(|&index| trial.inputs(index)).collect();
        fingerprint(&serde_json::json!([self.meanings[entry], inputs]))
    }

    /// Says how far the search is.
    fn tell(&mut self, sets: Vec<Open>, residues: &[Residue]) {
        for (set, residue) in sets.into_iter().zip(residues) {
            self.given_up.insert(set.trial.into_inputs(), matches!(residue, Residue::AtLeast(_)));
            if let Residue::Exact(Some(value)) = residue {
                self.best = Some(self.best.map_or(*value, |best| best.min(*value)));
            }
        }
        let given_up = self.given_up.values().filter(|given_up| **given_up).count();
        self.handler.on_event(&Event::Tried { sets: self.given_up.len(), given_up, best: self.best });
    }
}

/// Simulations of an experiment at most, roughly: only the order counts.
fn simulations(experiment: &Experiment) -> f64 {
    let curves = curves(&experiment.cases, &experiment.refined);
    let added = curves.iter().map(|curve| f64::from(curve.rule.most) - curve.cases.len() as f64);
    let rows = experiment.cases.len() as f64 + added.map(|points| points.max(0.0)).sum::<f64>();
    let candidates = experiment.optimise.as_ref().map_or(1, |optimise| optimise.candidates.len());
    rows * candidates as f64 * runs_of_a_row(experiment) as f64
}

/// What the entries that are known prove of a set; nothing while it may matter and one is missing.
fn residue(set: &Open) -> Option<Residue> {
    if set.errors.contains(&Some(None)) {
        return Some(Residue::Exact(None));
    }
    let known = set.errors.iter().flatten().flatten();
    let root = (known.map(|error| error.square).sum::<f64>() / set.errors.len() as f64).sqrt();
    if set.errors.iter().all(Option::is_some) {
        return Some(Residue::Exact(Some(root).filter(|root| root.is_finite() && !set.errors.is_empty())));
    }
    let bound = root * (1.0 - ROUNDING);
    (bound > set.level).then_some(Residue::AtLeast(bound))
}

/// The error of an entry; a claim that fails counts as an error of one.
///
/// What an ensemble leaves open counts less. With W, the widest error of an agreement that says something, and a standard deviation σ of the
/// ensemble, the error is taken for normal with the variance W² + σ², and adds what it adds to −2 W² ln of its likelihood: e² W²/(W² + σ²) +
/// W² ln(1 + σ²/W²), which is e² where nothing is chaotic. Without the logarithm the search would go where motion is most chaotic.
fn error(kind: Residual, asked: &Asked<'_>, found: Found) -> EntryError {
    let (error, spread) = match found {
        Found::Number { simulated, published, spread } => {
            let error = match kind {
                Residual::Relative => (simulated - published) / published,
                Residual::Logarithmic => libm::log(simulated / published),
            };
            (error, spread / published)
        }
        Found::Claim { holds } => (f64::from(u8::from(!holds)), 0.0),
        Found::Nothing(_) => return None,
    };
    let square = match asked.1.telling() {
        Some(telling) if spread != 0.0 => {
            let (telling, spread) = (telling * telling, spread * spread);
            error * error * telling / (telling + spread) + telling * libm::log1p(spread / telling)
        }
        _ => error * error,
    };
    (error.is_finite() && square.is_finite()).then_some(Weighed { error, square })
}

/// Root mean square of what entries read.
pub(super) fn residual_of<'a>(kind: Residual, found: impl Iterator<Item = (&'a Asked<'a>, Found)>) -> Option<f64> {
    root_mean_square(found.map(|(asked, found)| error(kind, asked, found)))
}

/// Root mean square of errors; none may lack its number.
pub(super) fn root_mean_square(errors: impl Iterator<Item = EntryError>) -> Option<f64> {
    let squares: Vec<f64> = errors.map(|error| error.map(|one| one.square)).collect::<Option<_>>()?;
    let sum: f64 = squares.iter().sum();
    (!squares.is_empty()).then(|| (sum / squares.len() as f64).sqrt()).filter(|residual| residual.is_finite())
}

pub(super) fn states(tables: &SharedTables) -> Tables<'_> {
    tables.iter().map(|(id, table)| (id.clone(), TableState::Present(table.as_ref()))).collect()
}

pub(super) fn found((home, entry): &(&str, &Entry), tables: &SharedTables) -> Found {
    entry.found(home, &states(tables), BASELINE)
}
