//! Assumptions: every input that the study uses and does not state, by name, in one file.

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};

use super::recipe::{Given, RecipeError};

/// A curve through measured points (abscissa, ordinate), abscissae increasing; end values outside.
pub type Curve = Vec<[f64; 2]>;

/// The reading of a contact damping ratio that puts the equivalent damping curve in its place.
pub const EQUIVALENT_VISCOUS: &str = "equivalent_viscous";

/// The names of the unstated inputs. The same word stands in `experiments/assumptions.yaml`.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Assumption {
    /// Acceleration of gravity, m/s².
    Gravity,
    /// κ in J = κ f′ m g/ω: how the dimensionless forcing amplitude f′ = F/(m g) of an impulse F δ(t) becomes N s.
    ImpulseFactor,
    /// Which ω that is: `forcing` or `natural` frequency.
    ImpulseFrequency,
    /// Floor and ceiling damping ratio ζf = cf/(2 √(kf mp)), or `equivalent_viscous`: cf by [`Self::EquivalentDampingCurve`].
    /// So are the other damping ratios of contacts.
    ContactDampingRatio,
    /// kf/ks where the text gives none.
    FloorStiffnessRatio,
    /// c_eq against RMS base acceleration, points (g, N s/m).
    EquivalentDampingCurve,
    /// δ, m.
    StopLength,
    /// Restitution of the limit stop.
    StopRestitution,
    /// The mass of the run "without an impact damper": `base` alone or `loaded` with the particle fixed to it.
    UndampedMass,
    /// The frequency that a frequency ratio of 1 means under harmonic force: `base` √(k/m) or `loaded` √(k/(m+mp)).
    HarmonicReference,
    /// The same under impulses.
    ImpulseReference,
    /// mt/m, the share of the base mass that the ceiling side of the enclosure carries in Model 3.
    CeilingMassRatio,
    /// The mass ratio that stands for m′ = 0 of a particle on a resilient floor (a contact without mass is singular).
    MasslessRatio,
    /// Number of modes of a beam.
    BeamModes,
    /// Number of modes of a plate along each side.
    PlateModes,
    /// What m′ on beams is a share of: the `total` mass, or the `modal` mass at unit largest amplitude.
    BeamDamperMass,
    /// The same on plates.
    PlateDamperMass,
    /// ω₁ in h′ = h ω₁²/g on beams: of the `clean` structure or of the `loaded` one.
    BeamGapFrequency,
    /// The same on plates.
    PlateGapFrequency,
    /// Floors on beams: a stiffness, N/m, or what they are tuned to, kf = mp ω²: `clean`, `loaded`, or `untuned`.
    BeamFloorTuning,
    /// The same on plates.
    PlateFloorTuning,
    /// ω/ω₁ of an untuned floor.
    UntunedFrequencyRatio,
    /// ζf on beams.
    BeamContactDampingRatio,
    /// ζf on plates.
    PlateContactDampingRatio,
    /// τ in J = f′ m g τ on beams: s, or `radian`, `half_sine`, `period` of the forcing.
    BeamImpulseTime,
    /// The same on plates.
    PlateImpulseTime,
    /// F of a harmonic force on beams, N.
    BeamHarmonicForce,
    /// The same on plates.
    PlateHarmonicForce,
    /// What is made of the velocities of several points: the `largest` or the `mean`.
    GridVelocity,
    /// J of the impulses on beams where the text gives no amplitude (chapter 6), N s.
    BeamImpulse,
    /// The same on plates.
    PlateImpulse,
    /// Distance that an array of dampers keeps from the ends of a beam, m.
    BeamArrayMargin,
    /// The same of an array that is centred on a force, m.
    CentredArrayMargin,
    /// What m′ of an optimised array is a share of (chapter 6): the `total` mass, or the `modal` mass at unit largest
    /// amplitude.
    ArrayDamperMass,
    /// Floors of an optimised array on a beam: a stiffness, N/m, or what they are tuned to, as in [`Self::BeamFloorTuning`].
    BeamArrayFloorTuning,
    /// The same on a plate.
    PlateArrayFloorTuning,
    /// ζf of an optimised array on a beam.
    BeamArrayDampingRatio,
    /// The same on a plate.
    PlateArrayDampingRatio,
    /// How the mass measure compares kinetic energies with those of the clean structure: `jump`, `after`, `level`.
    MassMeasure,
}

/// The value of one assumption, SI.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum AssumptionValue {
    /// A number, SI or dimensionless.
    Number(f64),
    /// One of named readings of the source.
    Choice(String),
    /// A curve through points.
    Curve(Curve),
}

/// The set in force: values only; reasons and ranges stay with the file (see `spec`).
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct Assumptions {
    /// Every assumption that the file names.
    pub values: BTreeMap<Assumption, AssumptionValue>,
}

impl Assumptions {
    /// The number that an assumption holds.
    ///
    /// # Errors
    /// If it is absent or not a number.
    pub fn number(&self, name: Assumption) -> Result<f64, RecipeError> {
        match self.values.get(&name) {
            Some(AssumptionValue::Number(x)) => Ok(*x),
            _ => Err(RecipeError::Assumption(name, "as a number")),
        }
    }

    /// The index of the choice that an assumption holds among `choices`.
    ///
    /// # Errors
    /// If it is absent or not one of `choices`.
    pub fn choice(&self, name: Assumption, choices: &'static [&'static str]) -> Result<usize, RecipeError> {
        match self.values.get(&name) {
            Some(AssumptionValue::Choice(word)) => choices.iter().position(|choice| choice == word),
            _ => None,
        }
        .ok_or(RecipeError::Assumption(name, "as one of its named readings"))
    }

    /// The same of a reading that most studies have no need to state: the first choice where the file does not name it.
    ///
    /// # Errors
    /// If it is there and not one of `choices`.
    pub fn choice_or_first(&self, name: Assumption, choices: &'static [&'static str]) -> Result<usize, RecipeError> {
        if self.values.contains_key(&name) { self.choice(name, choices) } else { Ok(0) }
    }

    /// The curve that an assumption holds.
    ///
    /// # Errors
    /// If it is absent or not a curve.
    pub fn curve(&self, name: Assumption) -> Result<&Curve, RecipeError> {
        match self.values.get(&name) {
            Some(AssumptionValue::Curve(curve)) => Ok(curve),
            _ => Err(RecipeError::Assumption(name, "as a curve")),
        }
    }

    /// True if a damping ratio is left to the equivalent damping curve.
    #[must_use]
    pub fn is_equivalent_viscous(&self, given: Given) -> bool {
        let Given::Assumed(name) = given else { return false };
        matches!(self.values.get(&name), Some(AssumptionValue::Choice(word)) if word == EQUIVALENT_VISCOUS)
    }

    /// The number that was stated, or the assumption's.
    ///
    /// # Errors
    /// As [`Assumptions::number`].
    pub fn given(&self, given: Given) -> Result<f64, RecipeError> {
        match given {
            Given::Stated(x) => Ok(x),
            Given::Assumed(name) => self.number(name),
        }
    }
}
