//! The scene: structure, dampers, excitation and what is observed, in SI units.

use serde::{Deserialize, Serialize};

use super::{Damper, Excitation, Point, SingleMass, Start, Structure};

/// A scene in SI units: everything a simulation needs, and only the effects that it names.
#[derive(Debug, Clone, PartialEq)]
pub struct Scene {
    /// What vibrates.
    pub structure: Structure,
    /// Acceleration of gravity on the particles, m/s².
    pub gravity: f64,
    /// The particle impact dampers; none is a clean structure.
    pub dampers: Vec<Damper>,
    /// What drives it.
    pub excitation: Excitation,
    /// Where that acts.
    pub force_at: Point,
    /// Where the motion is observed.
    pub observed: Observation,
    /// Initial conditions; static equilibrium without them.
    pub start: Option<Start>,
}

impl Scene {
    /// One mass, which is forced and observed where it is.
    #[must_use]
    pub fn on_one_mass(mass: SingleMass, gravity: f64, dampers: Vec<Damper>, excitation: Excitation) -> Self {
        Self {
            structure: mass.into(),
            gravity,
            dampers,
            excitation,
            force_at: Point::default(),
            observed: Observation { points: vec![Point::default()], take: Take::Largest },
            start: None,
        }
    }

    /// g, in which the accelerations of damping curves and of time histories are given, m/s²: that of the scene, and [by
    /// convention](STANDARD_GRAVITY) where nothing has weight.
    #[must_use]
    pub fn g(&self) -> f64 {
        if self.gravity > 0.0 { self.gravity } else { STANDARD_GRAVITY }
    }
}

/// g₀ by convention, m/s².
pub const STANDARD_GRAVITY: f64 = 9.80665;

/// Where the motion is observed.
#[derive(Debug, Clone, PartialEq)]
pub struct Observation {
    /// The points, one at least; time histories are of the first.
    pub points: Vec<Point>,
    /// What is made of their numbers.
    pub take: Take,
}

/// How one number is taken of several points.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Take {
    /// The largest.
    Largest,
    /// Their mean.
    Mean,
}
