//! Measures read off responses, and what rounding leaves of them.

use std::f64::consts::TAU;
use std::ops::Range;

use super::contact::contact_share;
use super::energy::Energies;
use super::history::History;
use super::impact::Impacts;
use super::{EvaluateError, Measure};
use crate::dynamics::{Averaged, EventKind, Motion, Observed, Response, Sums};
use crate::scene::{Excitation, Scene, Take};

/// What there is to read measures of one run off.
pub(super) struct Reading<'a> {
    pub(super) scene: &'a Scene,
    /// Which mode natural frequencies are of, from 1.
    pub(super) mode: u32,
    /// The run, and the one without damper; absent where nothing asks for them.
    pub(super) response: Option<&'a Response>,
    pub(super) undamped: Option<&'a Response>,
    pub(super) history: Option<History<'a>>,
    pub(super) energies: Option<&'a Energies>,
    /// The averaged cycles, of a run that is not to settle.
    pub(super) given: Averaged,
    /// Modal assurance criterion of the shape, if there is one.
    pub(super) mac: Option<f64>,
}

impl<'a> Reading<'a> {
    /// Of a scene that is not run.
    pub(super) fn of_scene(scene: &'a Scene) -> Self {
        Self {
            scene,
            mode: 1,
            response: None,
            undamped: None,
            history: None,
            energies: None,
            given: Averaged { first: 0, cycles: 0 },
            mac: None,
        }
    }

    /// Of a run alone.
    pub(super) fn of_run(scene: &'a Scene, response: &'a Response) -> Self {
        Self { response: Some(response), ..Self::of_scene(scene) }
    }
}

/// What rounding leaves of a number.
pub(super) fn rounding(value: f64) -> f64 {
    4.0 * f64::EPSILON * value.abs()
}

impl Reading<'_> {
    pub(super) fn read(&self, measure: Measure) -> Result<f64, EvaluateError> {
        if measure.is_modal() {
            return self.modal(measure);
        }
        let response = self.response.ok_or(EvaluateError::NoRun(measure))?;
        let undamped = || self.undamped.ok_or(EvaluateError::NoRun(measure));
        let trace = || self.history.as_ref().ok_or(EvaluateError::NeedsTrace(measure));
        Ok(match measure {
            Measure::VelocityRatio => self.rms_velocity(undamped()?) / self.rms_velocity(response),
            Measure::DisplacementRatio => self.std_displacement(undamped()?) / self.std_displacement(response),
            Measure::RmsVelocity => self.rms_velocity(response),
            Measure::StdDisplacement => self.std_displacement(response),
            Measure::MeanDisplacement => self.mean_displacement(response),
            Measure::UndampedRmsVelocity => self.rms_velocity(undamped()?),
            Measure::FloorImpacts => response.counts.floor_contacts as f64,
            Measure::CeilingImpacts => response.counts.ceiling_contacts as f64,
            Measure::StopImpacts => response.counts.stops as f64,
            Measure::Separations => response.counts.floor_releases as f64,
            Measure::Drift => {
                let half = |i: usize| self.taken(response, |observed| observed.halves[i].rms_velocity());
                (half(0) / half(1) - 1.0).abs()
            }
            Measure::HighestFrequency => response.highest_frequency / TAU,
            Measure::ShortestPeriod => TAU / response.highest_frequency,
            Measure::FloorCompression => trace()?.floor_compression(),
            Measure::CeilingCompression => trace()?.ceiling_compression(),
            Measure::LastPeak => trace()?.last_peak(),
            Measure::PeakVariation => trace()?.peak_variation(),
            Measure::PeakDecayError => trace()?.peak_decay_error(),
            Measure::FloorImpactLag => trace()?.lag(EventKind::FloorContact),
            Measure::CeilingImpactLag => trace()?.lag(EventKind::CeilingContact),
            Measure::DisplacementAmplitude => self.displacement_amplitude(response),
            Measure::VelocityAmplitude => self.velocity_amplitude(response),
            Measure::DisplacementPerForce => self.displacement_amplitude(response) / self.drive(measure)?,
            Measure::VelocityPerForce => self.velocity_amplitude(response) / self.drive(measure)?,
            Measure::DisplacementPerImpulse => self.displacement_amplitude(response) / self.drive(measure)?,
            Measure::VelocityPerImpulse => self.velocity_amplitude(response) / self.drive(measure)?,
            Measure::DisplacementAmplitudeRatio => {
                self.displacement_amplitude(undamped()?) / self.displacement_amplitude(response)
            }
            Measure::VelocityAmplitudeRatio => self.velocity_amplitude(undamped()?) / self.velocity_amplitude(response),
            Measure::UndampedDisplacementAmplitude => self.displacement_amplitude(undamped()?),
            Measure::UndampedVelocityAmplitude => self.velocity_amplitude(undamped()?),
            Measure::DampingMeasure => self.energies.ok_or(EvaluateError::NoRun(measure))?.damping_measure(),
            Measure::MassMeasure => self.energies.ok_or(EvaluateError::NoRun(measure))?.mass_measure(),
            Measure::FinalDisplacement => response.final_displacement,
            Measure::FinalVelocity => response.final_velocity,
            Measure::FinalHeight => response.final_heights.first().copied().unwrap_or(f64::NAN),
            Measure::FloorImpactTime
            | Measure::FloorImpactInterval
            | Measure::FloorIntervalChange
            | Measure::FloorImpactSpeed
            | Measure::FloorImpactPhase
            | Measure::FloorReboundSpeed
            | Measure::FloorRestitution
            | Measure::FloorContactTime
            | Measure::FloorReleaseTime
            | Measure::ChatterEndTime => Impacts::of(response, self.scene, &self.averaged(response)).read(measure),
            Measure::ContactShare => contact_share(response, self.scene, self.averaged(response)),
            Measure::Settled => f64::from(u8::from(response.settled.is_some())),
            Measure::AveragedCycles => {
                let cycles = self.averaged(response);
                (cycles.end - cycles.start) as f64
            }
            Measure::Motion
            | Measure::LargestMultiplier
            | Measure::MultiplierAngle
            | Measure::MultiplierResidual
            | Measure::LyapunovExponent
            | Measure::SettledAfter => {
                // A fixed step proves none.
                response.motion.as_ref().map_or(f64::NAN, |motion| of_motion(motion, measure))
            }
            // Of other runs than this one: who makes those enters them.
            Measure::SettledVelocityRatio
            | Measure::GapElasticity
            | Measure::MassElasticity
            | Measure::StiffnessElasticity
            | Measure::DampingElasticity
            | Measure::ForceElasticity
            | Measure::VelocityRatioInput => f64::NAN,
            Measure::NaturalFrequency
            | Measure::CleanNaturalFrequency
            | Measure::ExactNaturalFrequency
            | Measure::ModeCount
            | Measure::Mac => unreachable!("modal measures are read above"),
        })
    }

    /// The cycles that are averaged over. A run with a time history may go on beyond them.
    pub(super) fn averaged(&self, response: &Response) -> Range<u64> {
        let averaged = response.settled.unwrap_or(self.given);
        averaged.first..averaged.end()
    }

    fn modal(&self, measure: Measure) -> Result<f64, EvaluateError> {
        let model = self.scene.structure.model();
        let number = self.mode as usize;
        let known = |frequencies: &[f64]| frequencies.get(number.wrapping_sub(1)).copied().unwrap_or(f64::NAN);
        Ok(match measure {
            Measure::NaturalFrequency => {
                let modes = self.scene.normal_modes()?;
                known(&modes.iter().map(|mode| mode.frequency).collect::<Vec<_>>())
            }
            Measure::CleanNaturalFrequency => known(&model.natural_frequencies()),
            Measure::ExactNaturalFrequency => model.exact_frequency(number).unwrap_or(f64::NAN),
            Measure::ModeCount => model.natural_frequencies().len() as f64,
            _ => self.mac.ok_or(EvaluateError::NeedsShape(measure))?,
        })
    }

    /// RMS velocity that counts among the observed points, m/s.
    pub(super) fn rms_velocity(&self, response: &Response) -> f64 {
        self.taken(response, |observed| observed.window().rms_velocity())
    }

    fn std_displacement(&self, response: &Response) -> f64 {
        self.taken(response, |observed| Sums::std_displacement(&observed.window()))
    }

    /// The largest is the one of largest modulus, with its sign: a mean may lie on either side.
    fn mean_displacement(&self, response: &Response) -> f64 {
        let farther = |a: f64, b: f64| if b.abs() > a.abs() { b } else { a };
        self.taken_by(response, |observed| Sums::mean_displacement(&observed.window()), farther)
    }

    fn displacement_amplitude(&self, response: &Response) -> f64 {
        self.taken(response, |observed| half_range(observed.extremes.displacement))
    }

    fn velocity_amplitude(&self, response: &Response) -> f64 {
        self.taken(response, |observed| half_range(observed.extremes.velocity))
    }

    /// One number of all observed points.
    fn taken(&self, response: &Response, of: impl Fn(&Observed) -> f64) -> f64 {
        self.taken_by(response, of, f64::max)
    }

    /// The same, of numbers among which the larger of two is not simply the one that is more.
    fn taken_by(&self, response: &Response, of: impl Fn(&Observed) -> f64, larger: impl Fn(f64, f64) -> f64) -> f64 {
        let points = self.scene.observed.points.len();
        let values = response.observed[..points].iter().map(of);
        match self.scene.observed.take {
            Take::Largest => values.reduce(larger).unwrap_or(f64::NAN),
            Take::Mean => values.sum::<f64>() / points as f64,
        }
    }

    /// The force or the impulse that an amplitude is compared with.
    fn drive(&self, measure: Measure) -> Result<f64, EvaluateError> {
        let under = measure.facts().under;
        match &self.scene.excitation {
            excitation if !under.admits(excitation) => {
                Err(EvaluateError::NotUnder { measure, excitation: under.words() })
            }
            Excitation::Harmonic { force, .. } => Ok(force.abs()),
            Excitation::SingleImpulse { impulse, .. }
            | Excitation::ImpulseTrain { impulse, .. }
            | Excitation::PulseTrain { impulse, .. } => Ok(impulse.abs()),
        }
    }
}

/// What the motion says of a measure; its name is no number.
fn of_motion(motion: &Motion, measure: Measure) -> f64 {
    let largest = motion.multipliers.first();
    let value = match measure {
        Measure::LargestMultiplier => largest.map(|it| it.modulus),
        Measure::MultiplierAngle => largest.map(|it| it.angle),
        Measure::MultiplierResidual => Some(motion.residual),
        Measure::LyapunovExponent => motion.exponent.map(|it| it.value),
        Measure::SettledAfter => motion.settled_after.map(|cycles| cycles as f64),
        _ => None,
    };
    value.unwrap_or(f64::NAN)
}

fn half_range([low, high]: [f64; 2]) -> f64 {
    0.5 * (high - low)
}
