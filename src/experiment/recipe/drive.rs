//! The excitation of a recipe in SI units.

use std::f64::consts::TAU;

use super::error::RecipeError;
use super::given::Given;
use super::parts::{
    Carried, ExcitationKind, ExcitationRecipe, ForcingOrNatural, ImpulseTime, ImpulseTimeRecipe, StrengthRecipe,
    TimingRecipe,
};
use super::place::PlaceRecipe;
use super::resolve::{Base, above};
use crate::scene::{Excitation, Structure};

/// Words that state how often a force acts.
const TIMING: [&str; 4] = ["frequency_ratio", "period", "angular_frequency", "forced_mode"];

impl ExcitationRecipe {
    /// Nothing drives the scene.
    #[must_use]
    pub fn silent(frequency_reference: Given<Carried>) -> Self {
        Self {
            kind: ExcitationKind::None,
            at: PlaceRecipe::default(),
            strength: StrengthRecipe::Impulse(Given::Stated(0.0)),
            timing: TimingRecipe::FrequencyRatio(Given::Stated(1.0)),
            frequency_reference,
            impulse_time: ImpulseTimeRecipe::By(Given::Stated(ImpulseTime::Radian)),
        }
    }

    pub(super) fn is_silent(&self) -> bool {
        self.kind == ExcitationKind::None
    }

    /// `carried`: mass of all dampers, kg.
    pub(super) fn resolve(&self, base: &Base<'_>, carried: f64) -> Result<Excitation, RecipeError> {
        let inputs = base.inputs;
        let of_timing = |error: RecipeError| error.at_keys(&TIMING);
        let angular_frequency = self.angular_frequency(base, carried).map_err(of_timing)?;
        above("the forcing frequency", angular_frequency, 0.0).map_err(of_timing)?;
        // A stated period is kept to the bit.
        let period = match &self.timing {
            TimingRecipe::Period(period) => inputs.get(period)?,
            _ => TAU / angular_frequency,
        };
        if self.kind == ExcitationKind::Harmonic {
            let force = match &self.strength {
                StrengthRecipe::ForceRatio(ratio) => inputs.get(ratio)? * base.mass * base.gravity,
                StrengthRecipe::BaseAmplitudeRatio(ratio) => -inputs.get(ratio)? * base.mass * base.gravity,
                StrengthRecipe::Force(force) => inputs.get(force)?,
                StrengthRecipe::Impulse(_) => {
                    return Err(RecipeError::out_of_range("a harmonic force takes a force, not an impulse"));
                }
            };
            return Ok(Excitation::Harmonic { force, angular_frequency });
        }
        let impulse = self.impulse(base, angular_frequency)?;
        Ok(match &self.kind {
            ExcitationKind::None => Excitation::SingleImpulse { impulse: 0.0, cycle: period },
            ExcitationKind::SingleImpulse => Excitation::SingleImpulse { impulse, cycle: period },
            ExcitationKind::ImpulseTrain => Excitation::ImpulseTrain { impulse, period },
            ExcitationKind::PulseTrain { duration, shape } => {
                let duration = inputs.get(duration)?;
                if !(duration > 0.0 && duration <= period) {
                    let message = format!("a pulse of {duration} s does not fit into a forcing period of {period} s");
                    return Err(RecipeError::out_of_range(message).at_keys(&["pulse_duration", "duration"]));
                }
                Excitation::PulseTrain { impulse, period, duration, shape: *shape }
            }
            ExcitationKind::Harmonic => unreachable!("handled above"),
        })
    }

    fn angular_frequency(&self, base: &Base<'_>, carried: f64) -> Result<f64, RecipeError> {
        let inputs = base.inputs;
        if matches!(self.timing, TimingRecipe::FrequencyRatio(_)) && base.natural() == 0.0 {
            let instead = if self.is_silent() {
                "state how long the cycle is that time is counted in: `excitation: {none: {period: 1 s}}`"
            } else {
                "write `angular_frequency` or `period` instead of `frequency_ratio`"
            };
            return Err(base.without_frequency(instead));
        }
        Ok(match (&self.timing, base.structure) {
            (TimingRecipe::FrequencyRatio(ratio), Structure::SingleMass(mass)) => {
                let carried = match inputs.get(&self.frequency_reference)? {
                    Carried::Loaded => carried,
                    Carried::Base => 0.0,
                };
                inputs.get(ratio)? * (mass.stiffness / (mass.mass + carried)).sqrt()
            }
            (TimingRecipe::FrequencyRatio(ratio), _) => inputs.get(ratio)? * base.natural(),
            (TimingRecipe::ForcedMode(mode), _) => {
                let frequency = base.frequencies.get((*mode as usize).wrapping_sub(1)).copied();
                frequency.ok_or_else(|| {
                    RecipeError::out_of_range(format!(
                        "forced_mode {mode} of a model of {} modes",
                        base.frequencies.len()
                    ))
                })?
            }
            (TimingRecipe::Period(period), _) => TAU / inputs.get(period)?,
            (TimingRecipe::AngularFrequency(omega), _) => inputs.get(omega)?,
        })
    }

    fn impulse(&self, base: &Base<'_>, angular_frequency: f64) -> Result<f64, RecipeError> {
        let inputs = base.inputs;
        let ratio = match &self.strength {
            StrengthRecipe::Impulse(impulse) => return inputs.get(impulse),
            StrengthRecipe::ForceRatio(ratio) => inputs.get(ratio)?,
            StrengthRecipe::BaseAmplitudeRatio(_) | StrengthRecipe::Force(_) => {
                return Err(RecipeError::out_of_range("an impulse takes force_ratio or an impulse in N s"));
            }
        };
        let time = match &self.impulse_time {
            ImpulseTimeRecipe::Factor { factor, frequency } => {
                let omega = match inputs.get(frequency)? {
                    ForcingOrNatural::Forcing => angular_frequency,
                    ForcingOrNatural::Natural => base.natural(),
                };
                return Ok(inputs.get(factor)? * ratio * base.mass * base.gravity / omega);
            }
            ImpulseTimeRecipe::By(time) => inputs.get(time)?,
        };
        let seconds = match time {
            ImpulseTime::Seconds(seconds) => seconds,
            ImpulseTime::HalfSine => 2.0 / angular_frequency,
            ImpulseTime::Period => TAU / angular_frequency,
            ImpulseTime::Radian => 1.0 / angular_frequency,
        };
        Ok(ratio * base.mass * base.gravity * seconds)
    }
}
