//! Structures: what vibrates. One file each, with its equation and source at its head.
//!
//! A new structure is one file and one line below: it supplies its YAML keys ([`Kind`]) and its matrices and shapes
//! ([`Model`]); reading, sweeping, compiling, measuring and reporting follow.

mod beam;
mod kind;
mod model;
mod polynomial;
mod register;

pub use kind::{Field, FieldValue, Form, Kind, StructureError, Values, whole};
pub use model::{Matrices, Model, Point};

register::structures! {
    single_mass::SingleMass,
    cantilever_beam::CantileverBeam,
    supported_plate::SupportedPlate,
    clamped_beam::ClampedBeam,
}
