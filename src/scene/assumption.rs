//! Assumptions: every input that the study uses and does not state, by name, in one file.

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};

/// A curve through measured points (abscissa, ordinate), abscissae increasing; end values outside.
pub type Curve = Vec<[f64; 2]>;

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
    /// Floor and ceiling damping ratio ζf = cf/(2 √(kf mp)).
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
