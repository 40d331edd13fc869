//! Recipes: scenes as experiments name them, in dimensionless parameters and with assumptions, and how they become SI.
//!
//! A [`Recipe`] holds what the file says. [`Recipe::set`] gives a swept parameter its value, [`Recipe::resolve`] makes the
//! [`crate::scene::Scene`], and `Recipe::dependencies` says which assumptions were read for it.

mod assumption;
mod assumption_sheet;
mod drive;
mod error;
mod given;
mod parameter;
mod part;
mod parts;
mod place;
mod quantity;
mod readings;
mod resolve;
mod set;
mod slot;
mod structure;
mod swept;

pub use assumption::{AssumptionName, AssumptionValue};
pub(crate) use assumption_sheet::assumption_of;
pub use assumption_sheet::{ASSUMPTIONS, AssumptionEntry, AssumptionSheet, Assumptions, Cycles, Moved};
pub use error::RecipeError;
pub use given::{Assumable, Given};
pub use parameter::{Parameter, ParameterTakes, ParameterValue};
pub use part::Part;
pub use parts::{
    Carried, ContactDampingConstant, ContactDampingRatio, ContactDampingRecipe, DamperRecipe, ExcitationKind,
    ExcitationRecipe, Filling, FloorStiffness, ForcingOrNatural, GapRecipe, GapWord, ImpulseTime, ImpulseTimeRecipe,
    MassReading, MassRecipe, MeanRatio, ObserveRecipe, PointsRecipe, Recipe, Reference, StiffnessRecipe, StopRecipe,
    StrengthRecipe, SurfaceRecipe, TimingRecipe, WallRecipe,
};
pub use place::{ArrayOrder, ArrayRecipe, Coordinate, PlaceRecipe};
pub use quantity::{AssumptionKind, Quantity, Takes};
pub(in crate::experiment) use resolve::Dependencies;
pub use slot::Slot;
pub use structure::StructureRecipe;
pub use swept::SweptSlots;
