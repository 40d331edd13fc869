//! Scenes: structure + dampers + excitation + the effects in force.
//!
//! A [`Recipe`] is what an experiment names, in the study's dimensionless parameters (Table 1 of the study). It resolves
//! into a [`Scene`], all SI, given the [`Assumptions`] for what the study leaves open.

mod assumption;
mod compile;
mod describe;
mod drive;
mod effect;
mod leaning;
mod normal_modes;
mod parameter;
mod place;
mod recipe;
mod resolve;
mod start;
mod structure;
mod switch;

use serde::{Deserialize, Serialize};

pub use assumption::{Assumption, AssumptionValue, Assumptions, Curve, EQUIVALENT_VISCOUS};
pub use compile::{CompileError, compile};
pub use effect::{EffectUse, effects};
pub use normal_modes::{NormalMode, normal_modes};
pub use parameter::{Parameter, ParameterValue};
pub use place::{Coordinate, PlaceRecipe};
pub use recipe::{
    ArrayRecipe, ContactDampingRecipe, DamperRecipe, ExcitationKind, ExcitationRecipe, Filling, GapRecipe, GapWord,
    Given, ImpulseTime, MassReading, MassRecipe, ObserveRecipe, Part, PointsRecipe, PulseShape, Recipe, RecipeError,
    StiffnessRecipe, StopRecipe, StrengthRecipe, SurfaceRecipe, TimingRecipe, WallRecipe,
};
pub use start::{ParticleStart, StartRecipe};
pub use structure::{
    CantileverBeam, ClampedBeam, Family, Field, FieldValue, Form, KINDS, Kind, Matrices, Model, Point, SingleMass,
    Structure, StructureRecipe, SupportedPlate, Values,
};
pub use switch::{Switching, switched};

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
        }
    }
}

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

/// One particle in its enclosure.
#[derive(Debug, Clone, PartialEq)]
pub struct Damper {
    /// Where it sits.
    pub at: Point,
    /// mp, kg.
    pub particle_mass: f64,
    /// ms, kg: fixed to the structure there.
    pub enclosure_mass: f64,
    /// Gap clearance h, m; infinite when no ceiling can be met.
    pub gap: f64,
    /// The floor, at gap coordinate u = 0.
    pub floor: Surface,
    /// The ceiling, at u = h.
    pub ceiling: Surface,
    /// Limit stop of both surfaces.
    pub stop: Option<LimitStop>,
    /// Soft lateral walls (Model 3).
    pub walls: Option<Walls>,
}

impl Damper {
    /// A particle alone between two faces of one kind, with neither enclosure mass, stop nor walls.
    #[must_use]
    pub fn between(surface: Surface, particle_mass: f64, gap: f64) -> Self {
        Self {
            at: Point::default(),
            particle_mass,
            enclosure_mass: 0.0,
            gap,
            floor: surface.clone(),
            ceiling: surface,
            stop: None,
            walls: None,
        }
    }
}

/// How a surface pushes back.
#[derive(Debug, Clone, PartialEq)]
pub enum Surface {
    /// Impulse-momentum contact (Model 1).
    Rigid {
        /// Coefficient of restitution ε, 0 to 1.
        restitution: f64,
    },
    /// Spring and dashpot (Models 2 and 3).
    Resilient {
        /// kf or kc, N/m.
        stiffness: f64,
        /// cf or cc.
        damping: ContactDamping,
        /// Where a contact ends.
        ends: ContactEnd,
    },
}

/// The dashpot of a resilient surface.
#[derive(Debug, Clone, PartialEq)]
pub enum ContactDamping {
    /// A constant, N s/m.
    Constant(f64),
    /// Equivalent viscous damping (s. 3.3): renewed at every half cycle of the base acceleration from its RMS over the
    /// half cycle before, in units of g, by a spline through the curve (g, N s/m).
    EquivalentViscous(Curve),
}

/// Where a resilient contact ends.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ContactEnd {
    /// At zero gap, as in the study.
    ZeroGap,
    /// Where the contact force would turn to tension.
    ZeroForce,
}

/// Inelastic stop that limits the compression of a resilient surface.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LimitStop {
    /// δ, m: the largest compression.
    pub length: f64,
    /// Restitution of the impact on the stop.
    pub restitution: f64,
}

/// Soft lateral walls: the ceiling side of the enclosure is a third body tied to the base (Model 3).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Walls {
    /// kw, N/m.
    pub stiffness: f64,
    /// cw, N s/m.
    pub damping: f64,
    /// mt, kg, the body that carries the ceiling; taken off the base mass.
    pub ceiling_mass: f64,
}

/// What drives the structure. `period` is the forcing cycle.
#[derive(Debug, Clone, PartialEq)]
pub enum Excitation {
    /// One impulse at t = 0; `cycle` is only the unit in which time is counted.
    SingleImpulse {
        /// J, N s.
        impulse: f64,
        /// s.
        cycle: f64,
    },
    /// J at t = 0, T, 2T, …
    ImpulseTrain {
        /// J, N s.
        impulse: f64,
        /// T, s.
        period: f64,
    },
    /// F sin(ω t), T = 2π/ω.
    Harmonic {
        /// F, N; negative turns the phase by π.
        force: f64,
        /// ω, rad/s.
        angular_frequency: f64,
    },
    /// Pulses of finite duration with impulse J, one a period.
    PulseTrain {
        /// J, N s.
        impulse: f64,
        /// T, s.
        period: f64,
        /// s.
        duration: f64,
        /// How the impulse is spread over the duration.
        shape: PulseShape,
    },
}

impl Excitation {
    /// The forcing cycle, s.
    #[must_use]
    pub fn period(&self) -> f64 {
        match self {
            Self::SingleImpulse { cycle, .. } => *cycle,
            Self::ImpulseTrain { period, .. } | Self::PulseTrain { period, .. } => *period,
            Self::Harmonic { angular_frequency, .. } => std::f64::consts::TAU / angular_frequency,
        }
    }
}
