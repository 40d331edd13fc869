//! One case, simulated and measured.
//!
//! Every event-driven case is run three times: as it is, with search windows half as long (the difference is its numerical
//! uncertainty), and with a kicked start. If the kick of a billionth has grown beyond a millionth, the motion is chaotic and
//! no single run is a result: an ensemble of kicked starts gives mean and spread. The fixed step is run once, as the study
//! ran it: what its step does to the numbers is the result that it is there for.

use std::f64::consts::TAU;

use super::history::{History, columns};
use super::{EvaluateError, Evaluated, Measure, Measured, Rigour};
use crate::dynamics::{EngineError, HybridSystem, Method, Options, Response, TraceRequest, event_driven};
use crate::scene::{Assumptions, Excitation, Recipe, Scene, Structure, compile};
use crate::spec::{Settings, SolverChoice, TraceSpec};

/// Kick that tells chaos from order, relative to the drive.
const TWIN_KICK: f64 = 1e-9;
/// How far the twin may end, relative to the RMS velocity, before the motion counts as chaotic.
const CHAOS: f64 = 1e-6;
/// What rounding leaves of a number in closed form, relative to it.
const CLOSED_FORM: f64 = 1e-12;
/// Ensemble of a look.
const MEMBERS_OF_A_LOOK: u32 = 8;
/// Largest kick of an ensemble member.
const ENSEMBLE_KICK: f64 = 1e-6;

/// Simulates one case and measures it. Sequential and deterministic: the same input gives the same bits on any machine.
///
/// # Errors
/// [`EvaluateError`] with the reason.
pub fn evaluate(
    recipe: &Recipe,
    assumptions: &Assumptions,
    solver: SolverChoice,
    settings: &Settings,
    measures: &[Measure],
    trace: Option<&TraceSpec>,
    rigour: Rigour,
) -> Result<Evaluated, EvaluateError> {
    let scene = rounded(recipe.resolve(assumptions)?, settings);
    let bare = rounded(recipe.resolve_undamped(assumptions)?, settings);
    let system = compile(&scene)?;
    let undamped = compile(&bare)?;
    let plain = Options {
        skip: settings.skip,
        average: settings.average,
        displacement: measures.iter().any(|measure| measure.needs_displacement()),
        ..Options::default()
    };
    let main = Options {
        audit: rigour == Rigour::Result,
        trace: trace.map(|trace| TraceRequest {
            from_cycle: u64::from(trace.from_cycle),
            to_cycle: u64::from(trace.to_cycle),
            samples: u64::from(trace.samples),
        }),
        ..plain.clone()
    };
    let reference = solve(&undamped, &plain, solver)?;
    let response = solve(&system, &main, solver)?;
    let history = trace.map(|_| History { response: &response, scene: &scene });
    let read = |response: &Response, history: Option<&History<'_>>| -> Result<Vec<f64>, EvaluateError> {
        measures.iter().map(|measure| measure.read(response, &reference, history)).collect()
    };
    let values = read(&response, history.as_ref())?;
    let trace = history.as_ref().map(|history| columns(history)).unwrap_or_default();
    let certain = |numerical: Vec<f64>, chaotic: bool| Evaluated {
        measured: values
            .iter()
            .zip(numerical)
            .map(|(value, numerical)| Measured { value: *value, numerical, spread: 0.0 })
            .collect(),
        proof: response.proof,
        chaotic,
        members: 1,
        trace: trace.clone(),
    };
    if matches!(solver, SolverChoice::FixedStep { .. }) || system.particles.is_empty() {
        return Ok(certain(vec![0.0; values.len()], false));
    }

    if response.method == Method::ClosedForm {
        // Linear: neighbouring starts stay neighbours, and there is no window to be halved.
        return Ok(certain(values.iter().map(|value| CLOSED_FORM * value.abs()).collect(), false));
    }
    let rms = response.window().rms_velocity();
    let twin = event_driven(&system, &Options { kick: TWIN_KICK, ..plain.clone() })?;
    let chaotic = (twin.window().rms_velocity() - rms).abs() > CHAOS * rms;
    let members = match rigour {
        Rigour::Result => settings.ensemble,
        Rigour::Look => settings.ensemble.min(MEMBERS_OF_A_LOOK),
    };
    if !chaotic && rigour == Rigour::Look {
        return Ok(certain(values.iter().map(|value| 4.0 * f64::EPSILON * value.abs()).collect(), false));
    }
    if !chaotic || members < 2 {
        // The same events decided in other windows; measures of the history are as exact as its samples.
        let second = event_driven(&system, &Options { window_factor: 0.5, audit: false, ..main.clone() })?;
        let again = read(&second, history.as_ref().map(|_| History { response: &second, scene: &scene }).as_ref())?;
        let numerical = values.iter().zip(again).map(|(a, b)| (a - b).abs().max(4.0 * f64::EPSILON * a.abs()));
        return Ok(certain(numerical.collect(), chaotic));
    }

    let mut sums = vec![Welford::default(); measures.len()];
    for member in 0..members {
        let place = (f64::from(member) + 0.5) / f64::from(members) * 2.0 - 1.0;
        // Time histories and their measures stay those of the unkicked run.
        let kicked = event_driven(&system, &Options { kick: ENSEMBLE_KICK * place, ..plain.clone() })?;
        for ((sum, measure), own) in sums.iter_mut().zip(measures).zip(&values) {
            let value = if measure.needs_trace() { *own } else { measure.read(&kicked, &reference, None)? };
            sum.add(value);
        }
    }
    let measured = sums
        .iter()
        .map(|sum| Measured {
            value: sum.mean,
            numerical: sum.deviation() / f64::from(members).sqrt(),
            spread: sum.deviation(),
        })
        .collect();
    Ok(Evaluated { measured, proof: response.proof, chaotic, members, trace })
}

fn solve(system: &HybridSystem, options: &Options, solver: SolverChoice) -> Result<Response, EngineError> {
    match solver {
        SolverChoice::EventDriven => event_driven(system, options),
        SolverChoice::FixedStep { time_step } => crate::dynamics::fixed_step(system, options, time_step),
    }
}

/// The forcing period rounded to whole steps, if the experiment asks for it: the study's 199 steps of 1 ms.
fn rounded(mut scene: Scene, settings: &Settings) -> Scene {
    let Some(step) = settings.round_period_to else { return scene };
    let round = |period: f64| (period / step).round().max(1.0) * step;
    match &mut scene.excitation {
        Excitation::SingleImpulse { cycle: period, .. }
        | Excitation::ImpulseTrain { period, .. }
        | Excitation::PulseTrain { period, .. } => *period = round(*period),
        Excitation::Harmonic { angular_frequency, .. } => *angular_frequency = TAU / round(TAU / *angular_frequency),
    }
    scene
}

impl Measure {
    /// Read off a time history.
    pub(crate) fn needs_trace(self) -> bool {
        matches!(
            self,
            Self::LastPeak
                | Self::PeakVariation
                | Self::PeakDecayError
                | Self::FloorImpactLag
                | Self::CeilingImpactLag
                | Self::FloorCompression
                | Self::CeilingCompression
        )
    }

    fn needs_displacement(self) -> bool {
        matches!(self, Self::DisplacementRatio | Self::StdDisplacement | Self::MeanDisplacement)
    }

    fn read(
        self,
        response: &Response,
        undamped: &Response,
        history: Option<&History<'_>>,
    ) -> Result<f64, EvaluateError> {
        let window = response.window();
        let trace = || history.ok_or(EvaluateError::NeedsTrace(self));
        Ok(match self {
            Self::VelocityRatio => undamped.window().rms_velocity() / window.rms_velocity(),
            Self::DisplacementRatio => undamped.window().std_displacement() / window.std_displacement(),
            Self::RmsVelocity => window.rms_velocity(),
            Self::StdDisplacement => window.std_displacement(),
            Self::MeanDisplacement => window.mean_displacement(),
            Self::UndampedRmsVelocity => undamped.window().rms_velocity(),
            Self::FloorImpacts => response.counts.floor_contacts as f64,
            Self::CeilingImpacts => response.counts.ceiling_contacts as f64,
            Self::StopImpacts => response.counts.stops as f64,
            Self::Separations => response.counts.floor_releases as f64,
            Self::Drift => {
                let [first, second] = response.observed[0].halves;
                (first.rms_velocity() / second.rms_velocity() - 1.0).abs()
            }
            Self::HighestFrequency => response.highest_frequency / TAU,
            Self::ShortestPeriod => TAU / response.highest_frequency,
            Self::FloorCompression => trace()?.floor_compression(),
            Self::CeilingCompression => trace()?.ceiling_compression(),
            Self::LastPeak => trace()?.last_peak(),
            Self::PeakVariation => trace()?.peak_variation(),
            Self::PeakDecayError => trace()?.peak_decay_error(),
            Self::FloorImpactLag => trace()?.lag(crate::dynamics::EventKind::FloorContact),
            Self::CeilingImpactLag => trace()?.lag(crate::dynamics::EventKind::CeilingContact),
        })
    }
}

/// Structure's damping: the exponent of its free decay, c/(2m), 1/s.
pub(super) fn decay(scene: &Scene) -> f64 {
    let Structure::SingleMass { mass, damping, .. } = scene.structure;
    damping / (2.0 * mass)
}

/// Running mean and deviation (Welford).
#[derive(Debug, Clone, Copy, Default)]
struct Welford {
    count: f64,
    mean: f64,
    square: f64,
}

impl Welford {
    fn add(&mut self, value: f64) {
        self.count += 1.0;
        let before = value - self.mean;
        self.mean += before / self.count;
        self.square += before * (value - self.mean);
    }

    /// Standard deviation of the population that the members are a sample of.
    fn deviation(&self) -> f64 {
        (self.square / (self.count - 1.0)).sqrt()
    }
}
