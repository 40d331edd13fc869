//! The readings that assumptions may stand for, by their words.

use super::assumption::AssumptionValue;
use super::given::Assumable;
use super::parts::{
    Carried, ContactDampingConstant, ContactDampingRatio, FloorStiffness, ForcingOrNatural, ImpulseTime, MassReading,
    MeanRatio, Reference,
};
use super::place::ArrayOrder;
use crate::measure::Comparison;
use crate::scene::Take;
use crate::yaml::word::from_word;

/// Readings whose words are their names in snake case.
macro_rules! readings {
    ($($Type:ty),*) => {
        $(impl Assumable for $Type {
            fn of(value: &AssumptionValue) -> Option<Self> {
                if let AssumptionValue::Choice(word) = value { from_word(word) } else { None }
            }
        })*
    };
}
readings!(Take, Carried, Reference, ArrayOrder, ForcingOrNatural, MeanRatio, Comparison);

/// A number, or a reading in its place.
macro_rules! numbers_or_readings {
    ($($Type:ident::$Number:ident),*) => {
        $(impl Assumable for $Type {
            fn of(value: &AssumptionValue) -> Option<Self> {
                match value {
                    AssumptionValue::Number(number) => Some(Self::$Number(*number)),
                    AssumptionValue::Choice(word) => from_word(word),
                    AssumptionValue::Curve(_) | AssumptionValue::Places(_) => None,
                }
            }
        })*
    };
}
numbers_or_readings!(
    MassReading::Share,
    FloorStiffness::Stiffness,
    ImpulseTime::Seconds,
    ContactDampingRatio::Ratio,
    ContactDampingConstant::Constant
);
