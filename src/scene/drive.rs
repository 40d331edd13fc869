//! The excitation of a recipe in SI units.

use std::f64::consts::TAU;

use super::recipe::{ExcitationKind, ExcitationRecipe, Given, ImpulseTime, RecipeError, StrengthRecipe, TimingRecipe};
use super::resolve::{Base, above};
use super::structure::{Family, Structure};
use super::{Assumption, AssumptionValue, Excitation};

impl ExcitationRecipe {
    /// Nothing drives the scene.
    #[must_use]
    pub fn silent() -> Self {
        Self {
            kind: ExcitationKind::None,
            at: super::PlaceRecipe::default(),
            strength: StrengthRecipe::Impulse(Given::Stated(0.0)),
            timing: TimingRecipe::FrequencyRatio(1.0),
            impulse_time: ImpulseTime::Assumed,
        }
    }

    pub(super) fn is_silent(&self) -> bool {
        self.kind == ExcitationKind::None
    }

    /// `carried`: mass of all dampers, kg.
    pub(super) fn resolve(&self, base: &Base<'_>, carried: f64) -> Result<Excitation, RecipeError> {
        let angular_frequency = self.angular_frequency(base, carried)?;
        above("the forcing frequency", angular_frequency, 0.0)?;
        // A stated period is kept to the bit.
        let period = if let TimingRecipe::Period(period) = self.timing { period } else { TAU / angular_frequency };
        if self.kind == ExcitationKind::Harmonic {
            let force = match self.strength {
                StrengthRecipe::ForceRatio(ratio) => ratio * base.mass * base.gravity,
                StrengthRecipe::BaseAmplitudeRatio(ratio) => -ratio * base.mass * base.gravity,
                StrengthRecipe::Force(force) => base.assumptions.given(force)?,
                StrengthRecipe::Impulse(_) => {
                    return Err(RecipeError::OutOfRange("a harmonic force takes a force, not an impulse".into()));
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
                if !(*duration > 0.0 && *duration <= period) {
                    return Err(RecipeError::OutOfRange(format!(
                        "a pulse of {duration} s does not fit into a forcing period of {period} s"
                    )));
                }
                Excitation::PulseTrain { impulse, period, duration: *duration, shape: *shape }
            }
            ExcitationKind::Harmonic => unreachable!("handled above"),
        })
    }

    fn angular_frequency(&self, base: &Base<'_>, carried: f64) -> Result<f64, RecipeError> {
        if let (TimingRecipe::FrequencyRatio(_), true) = (self.timing, base.natural() == 0.0) {
            let instead = if self.is_silent() {
                "state how long the cycle is that time is counted in: `excitation: {none: {period: 1 s}}`"
            } else {
                "write `angular_frequency` or `period` instead of `frequency_ratio`"
            };
            return Err(RecipeError::OutOfRange(format!("a mass without spring has no natural frequency: {instead}")));
        }
        Ok(match (self.timing, base.structure) {
            (TimingRecipe::FrequencyRatio(ratio), Structure::SingleMass(mass)) => {
                let harmonic = self.kind == ExcitationKind::Harmonic;
                let name = if harmonic { Assumption::HarmonicReference } else { Assumption::ImpulseReference };
                let loaded = base.assumptions.choice_or_first(name, &["base", "loaded"])? == 1;
                let carried = if loaded { carried } else { 0.0 };
                ratio * (mass.stiffness / (mass.mass + carried)).sqrt()
            }
            (TimingRecipe::FrequencyRatio(ratio), _) => ratio * base.natural(),
            (TimingRecipe::ForcedMode(mode), _) => {
                let frequency = base.frequencies.get((mode as usize).wrapping_sub(1)).copied();
                frequency.ok_or_else(|| {
                    RecipeError::OutOfRange(format!(
                        "forced_mode {mode} of a model of {} modes",
                        base.frequencies.len()
                    ))
                })?
            }
            (TimingRecipe::Period(period), _) => TAU / period,
            (TimingRecipe::AngularFrequency(omega), _) => omega,
        })
    }

    fn impulse(&self, base: &Base<'_>, angular_frequency: f64) -> Result<f64, RecipeError> {
        let ratio = match self.strength {
            StrengthRecipe::Impulse(impulse) => return base.assumptions.given(impulse),
            StrengthRecipe::ForceRatio(ratio) => ratio,
            StrengthRecipe::BaseAmplitudeRatio(_) | StrengthRecipe::Force(_) => {
                return Err(RecipeError::OutOfRange("an impulse takes force_ratio or an impulse in N s".into()));
            }
        };
        if let (ImpulseTime::Assumed, Structure::SingleMass(mass)) = (self.impulse_time, base.structure) {
            let omega = match base.assumptions.choice(Assumption::ImpulseFrequency, &["forcing", "natural"])? {
                0 => angular_frequency,
                _ => (mass.stiffness / mass.mass).sqrt(),
            };
            return Ok(base.assumptions.number(Assumption::ImpulseFactor)? * ratio * base.mass * base.gravity / omega);
        }
        let time = match self.impulse_time {
            ImpulseTime::Assumed => assumed_time(base)?,
            stated => stated,
        };
        let seconds = match time {
            ImpulseTime::Seconds(seconds) => seconds,
            ImpulseTime::HalfSine => 2.0 / angular_frequency,
            ImpulseTime::Period => TAU / angular_frequency,
            ImpulseTime::Radian | ImpulseTime::Assumed => 1.0 / angular_frequency,
        };
        Ok(ratio * base.mass * base.gravity * seconds)
    }
}

fn assumed_time(base: &Base<'_>) -> Result<ImpulseTime, RecipeError> {
    let name = match base.kind.family {
        Family::Beam => Assumption::BeamImpulseTime,
        Family::Plate => Assumption::PlateImpulseTime,
        Family::Mass => return Ok(ImpulseTime::Radian),
    };
    let readings = ImpulseTime::WORDS;
    match base.assumptions.values.get(&name) {
        Some(AssumptionValue::Number(seconds)) => Some(ImpulseTime::Seconds(*seconds)),
        Some(AssumptionValue::Choice(word)) => {
            readings.into_iter().find(|(known, _)| known == word).map(|(_, time)| time)
        }
        _ => None,
    }
    .ok_or(RecipeError::Assumption(name, "as a time or a reading"))
}
