//! Recipes: scenes as experiments name them, in dimensionless parameters and with assumptions, and how they become SI.
//!
//! A [`Recipe`] holds what the file says. [`Recipe::set`] gives a swept parameter its value, [`Recipe::resolve`] makes the
//! [`crate::scene::Scene`], and `Recipe::dependencies` says which assumptions were read for it.

mod assumption_sheet;
mod drive;
mod given;
mod parameter;
mod parts;
mod place;
mod resolve;
mod slot;
mod structure;
mod swept;

pub(crate) use assumption_sheet::assumption_of;
pub use assumption_sheet::{
    ASSUMPTIONS, AssumptionEntry, AssumptionKind, AssumptionSheet, Cycles, Moved, Quantity, Takes,
};
pub use given::{Assumable, AssumptionName, AssumptionValue, Assumptions, Given};
pub use parameter::{Parameter, ParameterTakes, ParameterValue};
pub use parts::{
    ArrayOrder, ArrayRecipe, Carried, ContactDampingConstant, ContactDampingRatio, ContactDampingRecipe, DamperRecipe,
    ExcitationKind, ExcitationRecipe, Filling, FloorStiffness, ForcingOrNatural, GapRecipe, GapWord, ImpulseTime,
    ImpulseTimeRecipe, MassReading, MassRecipe, MeanRatio, ObserveRecipe, Part, PointsRecipe, Recipe, RecipeError,
    Reference, StiffnessRecipe, StopRecipe, StrengthRecipe, SurfaceRecipe, TimingRecipe, WallRecipe,
};
pub use place::{Coordinate, PlaceRecipe};
pub(in crate::experiment) use resolve::Dependencies;
pub use slot::Slot;
pub use structure::StructureRecipe;
pub use swept::SweptSlots;
