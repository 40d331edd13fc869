//! Parameters: what a sweep may vary, by the same words as YAML keys and as table columns.

use serde::{Deserialize, Serialize};

use super::part::Part;
use crate::yaml::Dimension;

/// What a sweep may vary. The earlier one varies slower.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Parameter {
    /// f′.
    ForceRatio,
    /// a ω²/g.
    BaseAmplitudeRatio,
    /// ω′.
    FrequencyRatio,
    /// m′ of every damper.
    MassRatio,
    /// mp + ms of every damper, kg.
    Mass,
    /// h′ of every damper; `infinite` allowed.
    GapRatio,
    /// h of every damper, m.
    Gap,
    /// c′.
    DampingRatio,
    /// kf/ks = kc/ks.
    FloorStiffnessRatio,
    /// ζf.
    ContactDampingRatio,
    /// kw/ks; `infinite` leaves the soft walls out (Model 2).
    WallStiffnessRatio,
    /// Limit stop `with` or `without`.
    Stop,
    /// δ, m.
    StopLength,
    /// Duration of a pulse, s.
    PulseDuration,
    /// All dampers `with` or `without`: the clean structure.
    Dampers,
    /// Floors and ceilings `tuned` to the clean structure's first natural frequency, or `untuned`: with the stiffness that the
    /// scene states, else that of the untuned frequency ratio.
    FloorTuning,
    /// Whose mass m′ is a share of: the `total` or the `modal` one.
    MassReading,
    /// Which mode a natural frequency or a mode shape is of, from 1.
    Mode,
    /// Number of the natural frequency of the clean structure that is forced.
    ForcedMode,
    /// Number of modes; along each side of a plate.
    Modes,
    /// Length of a beam or plate, m.
    Length,
    /// m.
    Width,
    /// m.
    Thickness,
    /// λ in C = λ (M + K).
    Rayleigh,
    /// Dampers of an array.
    DamperCount,
    /// mp/(mp + ms).
    ParticleShare,
    /// Place of the force, share of the side.
    ForceX,
    /// The same along the second side.
    ForceY,
    /// Place of the damper, or of the array, share of the side.
    DamperX,
    /// The same along the second side.
    DamperY,
    /// Which of the places that an assumption lists, from 1, of the force and of every damper that stands at one.
    Place,
    /// Amplitude of a harmonic force, N.
    Force,
    /// J, N s.
    Impulse,
    /// Forcing frequency, rad/s.
    AngularFrequency,
    /// Gaps of an array: `uniform` or `optimised`.
    Filling,
}

/// A value that a sweep gives to a parameter.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum ParameterValue {
    /// A number, SI or dimensionless.
    Number(f64),
    /// `infinite`.
    Infinite,
    /// `with`.
    With,
    /// `without`.
    Without,
    /// `tuned`.
    Tuned,
    /// `untuned`.
    Untuned,
    /// `total`.
    Total,
    /// `modal`.
    Modal,
    /// `uniform`.
    Uniform,
    /// `optimised`.
    Optimised,
}

/// What a parameter is: one row of this table; reader, JSON Schema, table columns and pages follow from it.
struct Description {
    takes: ParameterTakes,
    /// Symbol of the field, empty if it has none.
    symbol: &'static str,
    /// The part of a scene that it belongs to.
    of: Option<Part>,
    /// How a scene leaves it to a sweep; empty for what switches a part on or off, or says by itself what it varies.
    mark: &'static str,
}

/// What values a parameter takes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum ParameterTakes {
    /// These words and no number.
    Words(&'static [ParameterValue]),
    /// Numbers with a unit.
    Quantity(Dimension),
    /// Dimensionless numbers.
    Ratio,
    /// Dimensionless numbers, or `infinite`.
    RatioOrInfinite,
}

/// Of dampers the first stands for all.
const DAMPER: Option<Part> = Some(Part::Damper(0));
const STRUCTURE: Option<Part> = Some(Part::Structure);
const EXCITATION: Option<Part> = Some(Part::Excitation);

impl Parameter {
    fn description(self) -> Description {
        use Dimension::{AngularFrequency, Force, Impulse, Length, Mass, Time};
        use ParameterTakes::{Quantity, Ratio, RatioOrInfinite, Words};
        use ParameterValue as Value;
        let (symbol, takes, of, mark) = match self {
            Self::ForceRatio => ("f′", Ratio, EXCITATION, "force_ratio: swept"),
            Self::BaseAmplitudeRatio => ("aω²/g", Ratio, EXCITATION, "base_amplitude_ratio: swept"),
            Self::FrequencyRatio => ("ω′", Ratio, EXCITATION, "frequency_ratio: swept"),
            Self::MassRatio => ("m′", Ratio, DAMPER, "mass_ratio: swept"),
            Self::Mass => ("", Quantity(Mass), DAMPER, "mass: swept"),
            Self::GapRatio => ("h′", RatioOrInfinite, DAMPER, "gap_ratio: swept"),
            Self::Gap => ("h", Quantity(Length), DAMPER, "gap: swept"),
            Self::DampingRatio => ("c′", Ratio, STRUCTURE, "damping_ratio: swept"),
            Self::FloorStiffnessRatio => ("kf/ks", Ratio, DAMPER, "floor: {resilient: {stiffness_ratio: swept, …}}"),
            Self::ContactDampingRatio => ("ζf", Ratio, DAMPER, "floor: {resilient: {damping_ratio: swept, …}}"),
            Self::WallStiffnessRatio => ("kw/ks", RatioOrInfinite, DAMPER, "walls: {stiffness_ratio: swept, …}"),
            Self::Stop => ("", Words(&[Value::With, Value::Without]), DAMPER, ""),
            Self::StopLength => ("δ", Quantity(Length), DAMPER, "stop: {length: swept}"),
            Self::PulseDuration => ("", Quantity(Time), EXCITATION, "duration: swept"),
            Self::Dampers => ("", Words(&[Value::With, Value::Without]), None, ""),
            Self::FloorTuning => ("", Words(&[Value::Tuned, Value::Untuned]), DAMPER, ""),
            Self::MassReading => ("", Words(&[Value::Total, Value::Modal]), DAMPER, "mass_reading: swept"),
            Self::Mode | Self::Place => ("", Ratio, None, ""),
            Self::ForcedMode => ("", Ratio, EXCITATION, "forced_mode: swept"),
            Self::Modes => ("", Ratio, STRUCTURE, "modes: swept"),
            Self::Length => ("", Quantity(Length), STRUCTURE, "length: swept"),
            Self::Width => ("", Quantity(Length), STRUCTURE, "width: swept"),
            Self::Thickness => ("", Quantity(Length), STRUCTURE, "thickness: swept"),
            Self::Rayleigh => ("λ", Ratio, STRUCTURE, "rayleigh: swept"),
            Self::DamperCount => ("", Ratio, DAMPER, "array: {count: swept, …}"),
            Self::ParticleShare => ("", Ratio, DAMPER, "particle_share: swept"),
            Self::ForceX => ("xF/Lx", Ratio, EXCITATION, "at: swept"),
            Self::ForceY => ("yF/Ly", Ratio, EXCITATION, "at: [0.5, swept]"),
            Self::DamperX => ("x/Lx", Ratio, DAMPER, "at: swept"),
            Self::DamperY => ("y/Ly", Ratio, DAMPER, "at: [0.5, swept]"),
            Self::Force => ("F", Quantity(Force), EXCITATION, "force: swept"),
            Self::Impulse => ("J", Quantity(Impulse), EXCITATION, "impulse: swept"),
            Self::AngularFrequency => ("ω", Quantity(AngularFrequency), EXCITATION, "angular_frequency: swept"),
            Self::Filling => ("", Words(&[Value::Uniform, Value::Optimised]), DAMPER, ""),
        };
        Description { takes, symbol, of, mark }
    }

    /// What values it takes.
    #[must_use]
    pub fn takes(self) -> ParameterTakes {
        self.description().takes
    }

    /// The words that it takes instead of numbers; none as a rule.
    #[must_use]
    pub fn words(self) -> &'static [ParameterValue] {
        match self.takes() {
            ParameterTakes::Words(words) => words,
            ParameterTakes::Quantity(_) | ParameterTakes::Ratio | ParameterTakes::RatioOrInfinite => &[],
        }
    }

    /// It takes numbers, and all between two of them.
    #[must_use]
    pub fn varies_smoothly(self) -> bool {
        let is_counted = matches!(self, Self::Mode | Self::ForcedMode | Self::Modes | Self::DamperCount | Self::Place);
        self.words().is_empty() && !is_counted
    }

    /// A scene reads the same assumptions with this value in its place: the size of a quantity never matters, zero and a sign may.
    pub(crate) fn stand_in(self, value: ParameterValue) -> ParameterValue {
        match value {
            ParameterValue::Number(number) if self.varies_smoothly() && number != 0.0 => {
                ParameterValue::Number(number.signum())
            }
            as_it_is => as_it_is,
        }
    }

    /// The drive is proportional to it.
    #[must_use]
    pub fn is_strength(self) -> bool {
        matches!(self, Self::ForceRatio | Self::BaseAmplitudeRatio | Self::Force | Self::Impulse)
    }

    /// Whether it goes no further than this value: the edge of a plate, say. Nothing is below zero.
    #[must_use]
    pub fn ends_at(self, value: f64) -> bool {
        let is_share =
            matches!(self, Self::ForceX | Self::ForceY | Self::DamperX | Self::DamperY | Self::ParticleShare);
        value == 0.0 || is_share && value == 1.0
    }

    /// Unit symbol of its numbers, empty when dimensionless.
    #[must_use]
    pub fn unit(self) -> &'static str {
        match self.takes() {
            ParameterTakes::Quantity(dimension) => dimension.unit(),
            ParameterTakes::Words(_) | ParameterTakes::Ratio | ParameterTakes::RatioOrInfinite => "",
        }
    }

    /// Symbol of the field, empty if it has none.
    #[must_use]
    pub fn symbol(self) -> &'static str {
        self.description().symbol
    }

    /// The part of a scene that it belongs to; of dampers the first stands for all.
    pub(crate) fn part(self) -> Option<Part> {
        self.description().of
    }

    /// How a scene leaves it to a sweep, `gap_ratio: swept`; empty where no value that a scene states is replaced.
    pub(crate) fn mark(self) -> &'static str {
        self.description().mark
    }

    /// True for what a clean structure has no use for.
    pub(crate) fn is_of_dampers(self) -> bool {
        self.part() == DAMPER
    }
}
