//! Scenes in SI units: structure + dampers + excitation + the effects in force, and what they compile to.
//!
//! A [`Scene`] names each effect that it has; what it does not name is not compiled into the [`crate::dynamics::HybridSystem`].

mod compile;
mod damper;
mod definition;
mod describe;
mod design;
mod effect;
mod excitation;
mod normal_modes;
mod start;
mod structure;
mod switch;

pub(crate) use compile::drive;
pub use compile::{CompileError, compile};
pub use damper::{ContactDamping, ContactEnd, Curve, Damper, LimitStop, Surface, Walls};
pub use definition::{Observation, STANDARD_GRAVITY, Scene, Take};
pub use design::Design;
pub use effect::{EffectUse, effects};
pub use excitation::{Excitation, NoBinomialPulse, PulseShape};
pub use normal_modes::{NormalMode, normal_modes};
pub use start::{ParticleStart, Start, StartError};
pub use structure::{
    CantileverBeam, ClampedBeam, Field, FieldValue, Form, KINDS, Kind, Matrices, Model, Point, SingleMass, Structure,
    StructureError, SupportedPlate, Values, whole,
};
pub use switch::{Switching, switched};
