//! The calibration itself: the search over sets, and the verdicts under the best one.

use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;

use super::journal::Journal;
use super::left_out::{LeftOut, left_out, left_out_error};
use super::residuals::{Residuals, found, residual_of, states};
use super::search::{Places, Residue, Trail, coordinate, global, grid};
use super::set::{Set, place_in_force};
use super::trials::{Asked, CumulativeEvents, SharedTables, TrialRunner, Workers, Worth};
use crate::experiment::{Assumptions, Calibration, CalibrationSearch, Experiment};
use crate::reference::{Entry, Found, ReferenceFile, Verdict, judge};
use crate::study::{Evaluate, Event, EventHandler, RunError};

/// Why there is no calibration.
#[derive(Debug, thiserror::Error)]
pub enum CalibrationError {
    /// An entry that the reference lacks.
    #[error("`{0}` is no entry of an experiment of this study")]
    NoEntry(String),
    /// An entry with two parts at once.
    #[error("`{0}` is both in `fit` and in `hold_out`: what was fitted tests nothing")]
    FittedAndHeldOut(String),
    /// A value that leaves an experiment no cycle to average.
    #[error(
        "`{input}` has a value with which `{experiment}` averages no whole number of cycles up to cycle {to}: give it whole numbers below {to}"
    )]
    NoCycle {
        /// The input as the calibration names it.
        input: String,
        /// The experiment.
        experiment: String,
        /// Its last cycle.
        to: u32,
    },
    /// A run was not complete.
    #[error(transparent)]
    Run(#[from] RunError),
}

/// What a calibration found.
#[derive(Debug, Clone, PartialEq)]
pub struct Calibrated {
    /// Root mean square of the fitted entries' errors under the inputs in force, as the search sees them; none if one
    /// has no number.
    pub in_force: Option<f64>,
    /// The same of the best set; none if no set gives all of them a number.
    pub best: Option<f64>,
    /// The same two of results, with ensembles where the motion is chaotic.
    pub as_results: [Option<f64>; 2],
    /// Of each input the index of its best value; of equal sets that which is nearest to the inputs in force.
    pub places: Vec<usize>,
    /// How well each input is determined.
    pub profiles: Vec<Profile>,
    /// Sets that were tried.
    pub tried: usize,
    /// The residual at which each start of a coordinate search ended; empty for a grid.
    pub ends: Vec<Option<f64>>,
    /// The budget ended the search.
    pub cut_short: bool,
    /// Inputs, by their index, that hardly change the residual when they are moved alone, and that a global search held at first.
    pub screened: Vec<usize>,
    /// The entries that were fitted.
    pub fitted: Vec<Compared>,
    /// Of each fitted entry what the fit of the others says; empty where that was not asked for.
    pub left_out: Vec<LeftOut>,
    /// The entries that were held out.
    pub held_out: Vec<Compared>,
}

/// Of each value of an input the least residual that was found with it; none where no set with it was tried that gives every
/// fitted entry a number.
#[derive(Debug, Clone, PartialEq)]
pub struct Profile {
    /// In the order of the input's values.
    pub residuals: Vec<Option<f64>>,
    /// Of each value the root mean square of the errors that entries have where the others alone choose the rest; empty where none
    /// was left out.
    pub left_out: Vec<Option<f64>>,
    /// No fitted entry depends on the input: sets that differ in it alone have the same residual.
    pub is_unread: bool,
}

/// An entry under the inputs in force and under the best ones.
#[derive(Debug, Clone, PartialEq)]
pub struct Compared {
    /// `ch6-beam-b1-light/uniform`.
    pub id: String,
    /// In force.
    pub in_force: Read,
    /// Substituted the best set.
    pub best: Read,
}

/// What an entry reads, and the verdict on it by the entry's own tolerance. Nothing is added for unstated inputs, which are
/// what is chosen.
#[derive(Debug, Clone, PartialEq)]
pub struct Read {
    /// What came out.
    pub found: Found,
    /// The verdict, as if no entry were fitted or blocked.
    pub verdict: Verdict,
}

/// How a calibration is run; no number depends on it.
#[derive(Debug, Clone, Copy, Default)]
pub struct Running<'a> {
    /// Threads; 0: one a processor.
    pub threads: usize,
    /// Where it keeps what it has evaluated, so that it can go on after an interruption; `None`: nowhere.
    pub journal: Option<&'a Path>,
}

/// Searches the best inputs and judges all entries under them.
///
/// # Errors
/// [`CalibrationError`] with the reason.
pub fn calibrate(
    calibration: &Calibration,
    experiments: &[&Experiment],
    references: &BTreeMap<String, ReferenceFile>,
    in_force: &Assumptions,
    running: Running<'_>,
    evaluate: &impl Evaluate,
    handler: &dyn EventHandler,
) -> Result<Calibrated, CalibrationError> {
    let fit = chosen(&calibration.fit, references, &BTreeSet::new())?;
    let taken: BTreeSet<&str> = fit.iter().map(|(_, entry)| entry.id.as_str()).collect();
    let held = chosen(&calibration.hold_out, references, &taken)?;
    for (home, entry) in fit.iter().chain(&held) {
        for reading in entry.readings(home) {
            if experiments.iter().all(|known| known.id.0 != reading.experiment) {
                return Err(CalibrationError::NoEntry(entry.id.clone()));
            }
        }
    }
    let cumulative = CumulativeEvents::new(handler);
    let workers = Workers { threads: running.threads, evaluate, handler: &cumulative };
    let now = Set::in_force(in_force);
    let set = |places: &Places| Set::of(calibration, places, in_force);

    cycles_are_left(calibration, experiments, set)?;
    let trials = TrialRunner::new(&workers, Worth::Step { ensemble: calibration.ensemble }, experiments, &fit);
    let journal = Journal::open(running.journal);
    let mut residuals = Residuals::new(calibration.residual, &fit, trials, journal, handler);
    let residual_in_force = match residuals.of(&[(now.clone(), f64::INFINITY)])?[..] {
        [Residue::Exact(residual)] => residual,
        _ => None,
    };
    let first: Places = calibration.inputs.iter().map(|input| place_in_force(input, in_force)).collect();
    let trail = search(calibration, &first, |wanted| {
        residuals.of(&wanted.iter().map(|(places, level)| (set(places), *level)).collect::<Vec<_>>())
    })?;
    let best = trail.best_near(&first);
    let mut profiles = profiles(calibration, &trail);
    let mut predicted = Vec::new();
    if calibration.leave_one_out {
        let sets: Vec<&Places> = trail.residuals.keys().collect();
        let errors = residuals.errors(&sets.iter().map(|places| set(places)).collect::<Vec<_>>())?;
        predicted = left_out(calibration.residual, &fit, &sets, &errors);
        for (input, profile) in profiles.iter_mut().enumerate() {
            let of = |value: usize| left_out_error(&fit, &sets, &errors, [input, value]);
            profile.left_out = (0..profile.residuals.len()).map(of).collect();
        }
    }

    let all: Vec<Asked<'_>> = fit.iter().chain(&held).copied().collect();
    let best_set = best.map_or_else(|| now.clone(), |(places, _)| set(places));
    let workers = Workers { handler, ..workers };
    let as_results = TrialRunner::new(&workers, Worth::Result, experiments, &all).tables(&[now, best_set])?;
    handler.on_event(&Event::Ended);
    let compared = |one: &Asked<'_>| Compared {
        id: one.1.id.clone(),
        in_force: read(one, &as_results[0]),
        best: read(one, &as_results[1]),
    };
    let fitted: Vec<Compared> = fit.iter().map(compared).collect();
    Ok(Calibrated {
        in_force: residual_in_force,
        best: best.map(|(_, residual)| residual),
        as_results: [
            residual_of(calibration.residual, fit.iter().zip(fitted.iter().map(|one| one.in_force.found.clone()))),
            residual_of(calibration.residual, fit.iter().zip(fitted.iter().map(|one| one.best.found.clone()))),
        ],
        places: best.map(|(places, _)| places.clone()).unwrap_or_default(),
        profiles,
        tried: trail.residuals.len(),
        ends: trail.ends.iter().map(|(_, residual)| *residual).collect(),
        cut_short: trail.cut_short,
        screened: trail.held,
        fitted,
        left_out: predicted,
        held_out: held.iter().map(compared).collect(),
    })
}

/// Every value of an input that says how many cycles are left out leaves some to average.
fn cycles_are_left(
    calibration: &Calibration,
    experiments: &[&Experiment],
    set: impl Fn(&Places) -> Set,
) -> Result<(), CalibrationError> {
    for (experiment, transient) in experiments.iter().filter_map(|one| Some((one, one.transient.as_ref()?))) {
        for (which, input) in
            calibration.inputs.iter().enumerate().filter(|(_, it)| it.tried.moves(&transient.left_out))
        {
            for value in 0..input.tried.count() {
                let mut places = vec![0; calibration.inputs.len()];
                places[which] = value;
                if transient.left_out_under(&set(&places).assumptions).is_none() {
                    let (input, experiment) = (input.name.clone(), experiment.id.0.clone());
                    return Err(CalibrationError::NoCycle { input, experiment, to: transient.to });
                }
            }
        }
    }
    Ok(())
}

fn search(
    calibration: &Calibration,
    first: &Places,
    residuals: impl FnMut(&[(Places, f64)]) -> Result<Vec<Residue>, RunError>,
) -> Result<Trail, RunError> {
    let counts: Vec<usize> = calibration.inputs.iter().map(|input| input.tried.count()).collect();
    match calibration.search {
        CalibrationSearch::Grid => grid(&counts, residuals),
        CalibrationSearch::Coordinate { starts, budget } => {
            coordinate(&counts, first.clone(), starts, budget, residuals)
        }
        CalibrationSearch::Global { budget } => global(&counts, first, budget, residuals),
    }
}

fn profiles(calibration: &Calibration, trail: &Trail) -> Vec<Profile> {
    let of = |which: usize, count: usize| Profile {
        residuals: (0..count)
            .map(|place| trail.best(|places| places[which] == place).map(|(_, residual)| residual))
            .collect(),
        left_out: Vec::new(),
        is_unread: count > 1 && trail.does_not_depend_on(which),
    };
    calibration.inputs.iter().enumerate().map(|(which, input)| of(which, input.tried.count())).collect()
}

/// Entries by their ids, each once; `EXPERIMENT/*` stands for all of an experiment that are not `taken`, and nothing else may be.
fn chosen<'a>(
    ids: &[String],
    references: &'a BTreeMap<String, ReferenceFile>,
    taken: &BTreeSet<&str>,
) -> Result<Vec<Asked<'a>>, CalibrationError> {
    let mut chosen: Vec<Asked<'a>> = Vec::new();
    for id in ids {
        if taken.contains(id.as_str()) {
            return Err(CalibrationError::FittedAndHeldOut(id.clone()));
        }
        let none = || CalibrationError::NoEntry(id.clone());
        let (experiment, name) = id.split_once('/').ok_or_else(none)?;
        let file = references.get(experiment).ok_or_else(none)?;
        let wanted = |entry: &&Entry| if name == "*" { !taken.contains(entry.id.as_str()) } else { entry.id == *id };
        let mut found = file.entries.iter().filter(wanted).peekable();
        found.peek().ok_or_else(none)?;
        for entry in found {
            if chosen.iter().all(|(_, known)| known.id != entry.id) {
                chosen.push((file.experiment.as_str(), entry));
            }
        }
    }
    Ok(chosen)
}

pub(super) fn read(asked: &Asked<'_>, tables: &SharedTables) -> Read {
    let (home, entry) = *asked;
    let alone = Entry { blocked_by: Vec::new(), ..entry.clone() };
    let file = ReferenceFile { experiment: home.to_owned(), entries: vec![alone], not_judged: Vec::new() };
    let judged = judge(&file, &states(tables), &BTreeSet::new());
    let verdict = judged.first().map_or(Verdict::Missing, |judged| judged.verdict);
    Read { found: found(asked, tables), verdict }
}
