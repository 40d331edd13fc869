//! Slots: the places of a scene for which a study may declare a default assumption.
//!
//! Such an assumption stands there where an experiment writes plain `assumed`, and where it leaves the slot out. One row a slot
//! below says what it takes; reading, checking and JSON Schema follow.

use serde::{Deserialize, Serialize};

use super::quantity::{Quantity, Takes};
use crate::yaml::Dimension;

macro_rules! slots {
    ($($Slot:ident: $quantity:expr, $readings:expr, $about:literal;)*) => {
        /// A place of a scene.
        #[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
        #[serde(rename_all = "snake_case")]
        pub enum Slot {
            $(#[doc = $about] $Slot,)*
        }

        impl Slot {
            /// All of them.
            pub const ALL: &[Self] = &[$(Self::$Slot,)*];

            /// What it takes.
            #[must_use]
            pub const fn takes(self) -> Takes<'static> {
                match self {
                    $(Self::$Slot => Takes { quantity: $quantity, readings: $readings },)*
                }
            }

            /// What it is, in one line.
            #[must_use]
            pub const fn about(self) -> &'static str {
                match self {
                    $(Self::$Slot => $about,)*
                }
            }
        }
    };
}

const RATIO: Option<Quantity> = Some(Quantity::Ratio);
const CURVE: Option<Quantity> = Some(Quantity::Curve);

const fn of(dimension: Dimension) -> Option<Quantity> {
    Some(Quantity::Of(dimension))
}

slots! {
    Gravity: of(Dimension::Acceleration), &[], "acceleration of gravity on the particles";
    UndampedMass: None, &["base", "loaded"], "what one mass weighs in the run without dampers";
    MassMeasure: None, &["jump", "after", "level"], "how the mass measure compares kinetic energies with those of the clean structure";
    MeanRatio: None, &["of_means", "of_each"], "velocity ratio over several settings: that of the mean RMS velocities, or the mean of those of each";
    Modes: Some(Quantity::Count), &[], "number of modes, along each side of a plate";
    MassReading: RATIO, &["total", "modal"], "whose mass a mass ratio is a share of, or which share of the structure's";
    MasslessRatio: RATIO, &[], "mass ratio that stands for 0 under a resilient surface";
    GapFrequency: None, &["clean", "loaded"], "whose first natural frequency stands in a gap ratio";
    StiffnessRatio: RATIO, &[], "stiffness of a surface over that of the structure's spring";
    Stiffness: of(Dimension::Stiffness), &["clean", "loaded", "untuned"], "stiffness of a surface, or what it is tuned to";
    UntunedFrequencyRatio: RATIO, &[], "frequency of an untuned surface over that of the clean structure";
    DampingRatio: RATIO, &["equivalent_viscous"], "damping ratio of a surface under the particle, or the damping curve";
    DampingCurve: CURVE, &[], "damping of surfaces against RMS base acceleration";
    StopLength: of(Dimension::Length), &[], "length of a limit stop";
    StopRestitution: RATIO, &[], "restitution of a limit stop";
    CeilingMassRatio: RATIO, &[], "share of the base mass that the ceiling side of soft walls carries";
    Order: None, &["columns", "rows"], "in which order the dampers of an array are counted";
    Margin: of(Dimension::Length), &[], "distance that an array keeps from the ends of the structure";
    FrequencyReference: None, &["base", "loaded"], "whose natural frequency a frequency ratio of 1 means on one mass, under impulses";
    HarmonicReference: None, &["base", "loaded"], "the same under a harmonic force";
    ImpulseTime: of(Dimension::Time), &["radian", "half_sine", "period"], "time by which a force ratio becomes an impulse";
    ImpulseFactor: RATIO, &[], "the same times the angular frequency";
    ImpulseFrequency: None, &["forcing", "natural"], "which angular frequency that is";
    Impulse: of(Dimension::Impulse), &[], "impulse";
    Force: of(Dimension::Force), &[], "amplitude of a harmonic force";
    Take: None, &["largest", "mean"], "how one number is taken of several points";
}
