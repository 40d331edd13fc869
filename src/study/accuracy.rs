//! What accuracy costs: error against wall time of both solvers, on scenes of an experiment's own.
//!
//! The reference is the solver of many digits, [`precise`], which shares neither arithmetic nor method with the contenders.
//! Where a scene has an effect that it does not know, the event-driven run in other windows takes its place, and says so.

use std::time::{Duration, Instant};

use serde::{Deserialize, Serialize};

use super::timing::Times;
use crate::dynamics::{EngineError, Event, HybridSystem, Method, Options, Response, event_driven, fixed_step};
use crate::measure::{EvaluateError, Measure, Trial};
use crate::precise::{PreciseError, precise};
use crate::scene::{Assumptions, ParameterValue, Recipe};
use crate::spec::{Case, Experiment, SolverChoice};
use crate::text::words;

/// Search windows that the event-driven solver is tried with.
const WINDOWS: [f64; 3] = [1.0, 0.5, 0.25];
/// Windows of the run that stands in for a reference.
const STAND_IN: f64 = 0.37;
/// Steps that the fixed-step solver is tried with, s.
const STEPS: [f64; 9] = [1e-2, 3e-3, 1e-3, 3e-4, 1e-4, 3e-5, 1e-5, 3e-6, 1e-6];
/// Cases of an experiment.
const CASES: usize = 3;
/// Events whose times are compared.
const EVENTS: usize = 4000;
/// Kick that tells chaos from order, and how far it may have grown.
const TWIN: [f64; 2] = [1e-9, 1e-6];
/// Perturbed starts, and the largest kick, that the floor of a chaotic case is taken from.
const MEMBERS: u32 = 8;
const KICK: f64 = 1e-6;
/// How long the reference may take at least.
const MOST_PATIENCE: Duration = Duration::from_secs(40);
/// How long the median of a run may take to settle.
const PATIENCE: Duration = Duration::from_millis(600);

/// A solver in one of its settings.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Contender {
    /// From certified event to certified event, in search windows of this factor.
    EventDriven {
        /// See [`Options::window_factor`].
        window_factor: f64,
    },
    /// The study's scheme.
    FixedStep {
        /// s.
        time_step: f64,
    },
}

/// Error and price of one contender.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Point {
    /// Who.
    pub contender: Contender,
    /// Largest relative error of the measures.
    pub error: f64,
    /// Of which measure.
    pub worst: Measure,
    /// At the events.
    pub events: EventTimes,
    /// Of one run with the dampers.
    pub times: Times,
}

/// How the events agree with those of the reference.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct EventTimes {
    /// Events of the reference that are compared.
    pub of: usize,
    /// Of these in the right order, from the first on.
    pub right: usize,
    /// The largest error of their times, in forcing periods; `None` without any.
    pub error: Option<f64>,
}

/// A contender that was left out.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Skipped {
    /// Which.
    pub contender: Contender,
    /// Why.
    pub reason: String,
}

/// What the error is measured against.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Origin {
    /// The solver of many digits.
    ManyDigits,
    /// The event-driven solver in other windows, for this reason.
    StandIn(String),
}

/// One case.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct CaseAccuracy {
    /// The case in words.
    pub told: String,
    /// What the errors are measured against.
    pub origin: Origin,
    /// The motion cannot meet a surface: the event-driven solver answers in closed form.
    pub closed_form: bool,
    /// Where neighbouring starts part: the relative spread of the measures, below which an error has no meaning.
    pub floor: Option<f64>,
    /// The contenders.
    pub points: Vec<Point>,
    /// Those left out.
    pub skipped: Vec<Skipped>,
}

/// One experiment.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Accuracy {
    /// Its cases.
    pub cases: Vec<CaseAccuracy>,
}

/// Why there is no diagram.
#[derive(Debug, thiserror::Error)]
pub enum NoAccuracy {
    /// Nothing is simulated.
    #[error("no case has a damper whose motion takes time to simulate")]
    Nothing,
    /// A case does not run.
    #[error(transparent)]
    Case(#[from] EvaluateError),
    /// A contender fails.
    #[error(transparent)]
    Engine(#[from] EngineError),
    /// The reference fails.
    #[error(transparent)]
    Reference(#[from] PreciseError),
}

/// A few cases of an experiment that stand for all of it, with dampers: of each third of its sweep the first one that has
/// events and is not chaotic, tried from the middle outwards, or else the one in the middle.
///
/// # Errors
/// [`NoAccuracy`] if a case that is tried does not run.
pub fn representative(experiment: &Experiment, assumptions: &Assumptions) -> Result<Vec<(String, Recipe)>, NoAccuracy> {
    let simulated = |case: &&Case| case.solvers.contains(&SolverChoice::EventDriven);
    let mut cases: Vec<&Case> = experiment.cases.iter().filter(simulated).collect();
    if cases.is_empty() {
        cases = experiment.cases.iter().collect();
    }
    let damped: Vec<(String, Recipe)> =
        cases.into_iter().filter_map(|case| ready(experiment, case, assumptions)).collect();
    let mut chosen: Vec<(String, Recipe)> = Vec::new();
    for third in 0..CASES {
        let ends = [third, third + 1].map(|end| end * damped.len() / CASES);
        let part = &damped[ends[0]..ends[1]];
        let mut wanted = part.get(part.len() / 2);
        for eighth in [4, 2, 6, 3, 5, 1, 7] {
            // One further in each third, so that what changes from row to row does not always stand the same way.
            let Some(candidate) = part.get(eighth * part.len() / 8 + third) else { continue };
            let trial = Trial::new(&candidate.1, assumptions, &experiment.settings, &experiment.measures)?;
            let own = event_driven(&trial.system, &trial.options)?;
            if own.proof.events > 0 && !is_chaotic(&trial, &own)? {
                wanted = Some(candidate);
                break;
            }
        }
        chosen.extend(wanted.cloned());
    }
    Ok(chosen)
}

/// A case with its scene, if that has dampers.
fn ready(experiment: &Experiment, case: &Case, assumptions: &Assumptions) -> Option<(String, Recipe)> {
    let mut recipe = experiment.recipes_of(case).ok()?.into_iter().next()?;
    let mut told = case.told();
    if let Some(maximise) = &experiment.maximise {
        let value = *maximise.grid.get(maximise.grid.len() / 2)?;
        recipe.set(maximise.over, ParameterValue::Number(value)).ok()?;
        let over = format!("{} = {value}", words::of_key(&maximise.over));
        told = if told.is_empty() { over } else { format!("{told}, {over}") };
    }
    let damped = recipe.resolve(assumptions).is_ok_and(|scene| !scene.dampers.is_empty());
    damped.then_some((told, recipe))
}

/// Runs the contenders on representative cases. No run takes much longer than `longest`: steps that would are left out, and a
/// reference that needs twenty times that, and more than forty seconds, is given up.
///
/// # Errors
/// [`NoAccuracy`] with the reason.
pub fn accuracy(experiment: &Experiment, assumptions: &Assumptions, longest: Duration) -> Result<Accuracy, NoAccuracy> {
    if experiment.optimise.is_some() {
        return Err(NoAccuracy::Nothing);
    }
    let mut cases = Vec::new();
    for (told, recipe) in representative(experiment, assumptions)? {
        let trial = Trial::new(&recipe, assumptions, &experiment.settings, &experiment.measures)?;
        cases.push(case(told, &trial, longest)?);
    }
    if cases.is_empty() { Err(NoAccuracy::Nothing) } else { Ok(Accuracy { cases }) }
}

fn case(told: String, trial: &Trial<'_>, longest: Duration) -> Result<CaseAccuracy, NoAccuracy> {
    let recorded = Options { record_events: EVENTS, ..trial.options.clone() };
    let (reference, bare, origin) = reference(trial, &recorded, longest)?;
    let truth = trial.read(&reference, &bare)?;
    let own = event_driven(&trial.system, &trial.options)?;
    let floor = floor(trial, &own)?;
    let mut points = Vec::new();
    let mut skipped = Vec::new();
    let compared = Compared { trial, recorded: &recorded, truth: &truth, events: &reference.events };
    for window_factor in WINDOWS {
        points.push(compared.point(Contender::EventDriven { window_factor })?);
    }
    // What the last step took tells what the next, smaller one will take.
    let mut last: Option<(f64, f64)> = None;
    for time_step in STEPS {
        let contender = Contender::FixedStep { time_step };
        let foreseen = last.map_or(0.0, |(step, seconds)| seconds * step / time_step);
        if foreseen > longest.as_secs_f64() {
            skipped.push(Skipped { contender, reason: format!("a run would take about {foreseen:.1e} s") });
            continue;
        }
        match compared.point(contender) {
            Ok(point) => {
                last = Some((time_step, point.times.least));
                points.push(point);
            }
            Err(NoAccuracy::Engine(error)) => skipped.push(Skipped { contender, reason: error.to_string() }),
            Err(error) => return Err(error),
        }
    }
    points.retain(|point| point.error.is_finite());
    let closed_form = own.method == Method::ClosedForm;
    Ok(CaseAccuracy { told, origin, closed_form, floor, points, skipped })
}

/// What contenders are held against.
struct Compared<'a> {
    trial: &'a Trial<'a>,
    recorded: &'a Options,
    truth: &'a [f64],
    events: &'a [Event],
}

impl Compared<'_> {
    fn point(&self, contender: Contender) -> Result<Point, NoAccuracy> {
        let Self { trial, recorded, truth, events } = *self;
        let response = contender.run(&trial.system, recorded)?;
        let values = trial.read(&response, &contender.run(&trial.undamped, &trial.options)?)?;
        let times = Times::of(|| drop(std::hint::black_box(contender.run(&trial.system, &trial.options))), PATIENCE);
        let (worst, error) = worst(&trial.measures, &values, truth);
        Ok(Point {
            contender,
            error,
            worst,
            events: compare(&response.events, events, trial.system.drive.period),
            times,
        })
    }
}

impl Contender {
    fn run(self, system: &HybridSystem, options: &Options) -> Result<Response, EngineError> {
        match self {
            Self::EventDriven { window_factor } => event_driven(system, &Options { window_factor, ..options.clone() }),
            Self::FixedStep { time_step } => fixed_step(system, options, time_step),
        }
    }
}

/// The reference with and without dampers, and where it comes from.
fn reference(
    trial: &Trial<'_>,
    recorded: &Options,
    longest: Duration,
) -> Result<(Response, Response, Origin), NoAccuracy> {
    let begun = Instant::now();
    let patience = MOST_PATIENCE.max(20 * longest);
    let both = precise(&trial.system, recorded, patience).and_then(|with| {
        let left = patience.saturating_sub(begun.elapsed());
        Ok((with, precise(&trial.undamped, &trial.options, left)?))
    });
    match both {
        Ok((with, without)) => Ok((with, without, Origin::ManyDigits)),
        Err(error) => {
            let other = |system, options: &Options| {
                event_driven(system, &Options { window_factor: STAND_IN, ..options.clone() })
            };
            let (with, without) = (other(&trial.system, recorded)?, other(&trial.undamped, &trial.options)?);
            Ok((with, without, Origin::StandIn(error.to_string())))
        }
    }
}

/// The largest relative error and its measure.
pub(super) fn worst(measures: &[Measure], values: &[f64], truth: &[f64]) -> (Measure, f64) {
    let errors = measures.iter().zip(values).zip(truth).map(|((measure, value), truth)| {
        let scale = if *truth == 0.0 { 1.0 } else { truth.abs() };
        let error = (value - truth).abs() / scale;
        (*measure, error)
    });
    errors.fold((Measure::RmsVelocity, 0.0), |worst, one| if one.1 >= worst.1 || one.1.is_nan() { one } else { worst })
}

/// A twin that was kicked a little ends elsewhere.
pub(super) fn is_chaotic(trial: &Trial<'_>, own: &Response) -> Result<bool, NoAccuracy> {
    if own.method == Method::ClosedForm {
        return Ok(false);
    }
    let bare = event_driven(&trial.undamped, &trial.options)?;
    let twin = event_driven(&trial.system, &Options { kick: TWIN[0], ..trial.options.clone() })?;
    let (_, moved) = worst(&trial.measures, &trial.read(&twin, &bare)?, &trial.read(own, &bare)?);
    Ok(moved.is_nan() || moved >= TWIN[1])
}

/// Spread over perturbed starts, where the motion is chaotic.
fn floor(trial: &Trial<'_>, own: &Response) -> Result<Option<f64>, NoAccuracy> {
    if !is_chaotic(trial, own)? {
        return Ok(None);
    }
    let bare = event_driven(&trial.undamped, &trial.options)?;
    let kicked = |kick: f64| -> Result<Vec<f64>, NoAccuracy> {
        let response = event_driven(&trial.system, &Options { kick, ..trial.options.clone() })?;
        Ok(trial.read(&response, &bare)?)
    };
    let still = trial.read(own, &bare)?;
    let mut rows = vec![still.clone()];
    for member in 0..MEMBERS {
        rows.push(kicked(KICK * ((f64::from(member) + 0.5) / f64::from(MEMBERS) * 2.0 - 1.0))?);
    }
    let spread = |i: usize| {
        let count = rows.len() as f64;
        let mean = rows.iter().map(|row| row[i]).sum::<f64>() / count;
        let square = rows.iter().map(|row| (row[i] - mean) * (row[i] - mean)).sum::<f64>() / (count - 1.0);
        square.sqrt() / mean.abs()
    };
    Ok(Some((0..still.len()).map(spread).fold(0.0, f64::max)))
}

fn compare(got: &[Event], want: &[Event], period: f64) -> EventTimes {
    let alike = |(a, b): &(&Event, &Event)| a.kind == b.kind && a.particle == b.particle;
    let right: Vec<(&Event, &Event)> = got.iter().zip(want).take_while(alike).collect();
    let off = |(a, b): &(&Event, &Event)| {
        let cycles = a.cycle as f64 - b.cycle as f64;
        (cycles + (a.time - b.time) / period).abs()
    };
    let error = right.iter().map(off).reduce(f64::max);
    EventTimes { of: want.len(), right: right.len(), error }
}
