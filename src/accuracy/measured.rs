//! What accuracy costs: error against wall time of both solvers, on scenes of an experiment's own.
//!
//! The reference is the solver of many digits, [`precise`], which shares neither arithmetic nor method with the contenders.
//! Where a scene has an effect that it does not know, the event-driven run in other windows takes its place, and says so.

use std::time::{Duration, Instant};

use rayon::prelude::*;
use serde::{Deserialize, Serialize};

use super::no_accuracy::NoAccuracy;
use super::representative::{floor, representative, trial, worst};
use super::timing::Times;
use crate::accuracy::precise::precise;
use crate::dynamics::{
    Allowance, EngineError, Event, HybridSystem, Method, Options, Response, event_driven, fixed_step,
};
use crate::experiment::{Assumptions, Experiment};
use crate::measure::{Measure, Trial};
use crate::text::number::quantity;

/// Search windows that the event-driven solver is tried with.
const WINDOWS: [f64; 3] = [1.0, 0.5, 0.25];
/// Windows of the run that stands in for a reference.
const STAND_IN: f64 = 0.37;
/// Steps that the fixed-step solver is tried with, s.
const STEPS: [f64; 9] = [1e-2, 3e-3, 1e-3, 3e-4, 1e-4, 3e-5, 1e-5, 3e-6, 1e-6];
/// Events whose times are compared.
const EVENTS: usize = 4000;
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
    /// Steps of one length.
    FixedStep {
        /// s.
        time_step: f64,
    },
}

impl Contender {
    /// The event-driven solver as it is used.
    pub(super) const EXACT: Self = Self::EventDriven { window_factor: 1.0 };
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
    pub description: String,
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

impl Accuracy {
    /// The cases that are not chaotic: in the others no error below the spread has a meaning.
    pub(super) fn regular(&self) -> Vec<&CaseAccuracy> {
        self.cases.iter().filter(|case| case.floor.is_none()).collect()
    }
}

/// Runs the contenders on representative cases: errors first, then times, alone on the machine. No run takes much longer than
/// `longest`: steps that would are left out, and a reference that needs twenty times that, and more than forty seconds, is
/// given up; all runs of a case together keep to the limit of a row.
///
/// # Errors
/// [`NoAccuracy`] with the reason.
pub fn accuracy(experiment: &Experiment, assumptions: &Assumptions, longest: Duration) -> Result<Accuracy, NoAccuracy> {
    Ok(errors(experiment, assumptions, longest)?.timed())
}

/// Errors of an experiment, whose times are still to be taken.
#[derive(Debug)]
pub struct Errors {
    cases: Vec<CaseErrors>,
}

#[derive(Debug)]
struct CaseErrors {
    /// Without times.
    case: CaseAccuracy,
    system: HybridSystem,
    options: Options,
}

/// The first half of [`accuracy`]: references and errors, several cases side by side.
///
/// # Errors
/// [`NoAccuracy`] with the reason.
pub fn errors(experiment: &Experiment, assumptions: &Assumptions, longest: Duration) -> Result<Errors, NoAccuracy> {
    if experiment.optimise.is_some() {
        return Err(NoAccuracy::Optimisation);
    }
    let within = || Allowance::new(experiment.limit);
    let chosen = within().simulate(|| representative(experiment, assumptions))?;
    let cases = chosen.into_par_iter().map(|(description, recipe)| {
        within().simulate(|| {
            let trial = trial(&recipe, experiment, assumptions)?;
            let case = case(description, &trial, longest)?;
            Ok(CaseErrors { case, system: trial.system, options: trial.options })
        })
    });
    let cases = cases.collect::<Result<Vec<_>, NoAccuracy>>()?;
    if cases.is_empty() { Err(NoAccuracy::Nothing) } else { Ok(Errors { cases }) }
}

impl Errors {
    /// The second half: one run at a time. Nothing else should run meanwhile.
    #[must_use]
    pub fn timed(self) -> Accuracy {
        let timed = |CaseErrors { mut case, system, options }| {
            for point in &mut case.points {
                let run = || drop(std::hint::black_box(point.contender.run(&system, &options)));
                point.times = Times::of(run, PATIENCE);
            }
            case
        };
        Accuracy { cases: self.cases.into_iter().map(timed).collect() }
    }
}

fn case(description: String, trial: &Trial<'_>, longest: Duration) -> Result<CaseAccuracy, NoAccuracy> {
    let recorded = Options { record_events: EVENTS, ..trial.options.clone() };
    let (reference, bare, origin) = reference(trial, &recorded, longest)?;
    let truth = trial.read(&reference, &bare)?;
    let own = event_driven(&trial.system, &trial.options)?;
    let floor = floor(trial, &own, &event_driven(&trial.undamped, &trial.undamped_options)?)?;
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
            skipped
                .push(Skipped { contender, reason: format!("a run would take about {}", quantity(foreseen, "s", 2)) });
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
    Ok(CaseAccuracy { description, origin, closed_form, floor, points, skipped })
}

/// What contenders are held against.
struct Compared<'a> {
    trial: &'a Trial<'a>,
    recorded: &'a Options,
    truth: &'a [f64],
    events: &'a [Event],
}

impl Compared<'_> {
    /// With the time of this one run, which others may have shared the machine with.
    fn point(&self, contender: Contender) -> Result<Point, NoAccuracy> {
        let Self { trial, recorded, truth, events } = *self;
        let begin = Instant::now();
        let response = contender.run(&trial.system, recorded)?;
        let times = Times::once(begin.elapsed());
        let values = trial.read(&response, &contender.run(&trial.undamped, &trial.undamped_options)?)?;
        let (worst, error) = worst(&trial.measures, &values, truth);
        let events = compare(&response.events, events, trial.system.drive.period);
        Ok(Point { contender, error, worst, events, times })
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
    let patience = MOST_PATIENCE.max(longest.saturating_mul(20));
    let both = precise(&trial.system, recorded, patience).and_then(|with| {
        let left = patience.saturating_sub(begun.elapsed());
        Ok((with, precise(&trial.undamped, &trial.undamped_options, left)?))
    });
    match both {
        Ok((with, without)) => Ok((with, without, Origin::ManyDigits)),
        Err(error) => {
            let other = |system, options: &Options| {
                event_driven(system, &Options { window_factor: STAND_IN, ..options.clone() })
            };
            let (with, without) = (other(&trial.system, recorded)?, other(&trial.undamped, &trial.undamped_options)?);
            Ok((with, without, Origin::StandIn(error.to_string())))
        }
    }
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
