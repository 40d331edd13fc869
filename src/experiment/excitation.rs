//! The excitation of a scene.

use super::recipe::{
    Carried, ExcitationKind, ExcitationRecipe, ForcingOrNatural, Given, ImpulseTime, ImpulseTimeRecipe, Parameter,
    Slot, StrengthRecipe, Takes, TimingRecipe,
};
use super::scene_reader::SceneReader;
use crate::scene::{Kind, PulseShape};
use crate::yaml::schema::one_of_words;
use crate::yaml::word::from_word;
use crate::yaml::{At, Choice, Dimension, Key, Keys, Value};

const FORMS: [Key<'static>; 5] = [
    ("single_impulse", "One impulse"),
    ("impulse_train", "Impulses one period apart"),
    ("harmonic", "A harmonic force"),
    ("pulse_train", "Pulses of finite duration"),
    ("none", "Nothing, and the cycle that time is counted in"),
];

const TIMING: [Key<'static>; 4] = [
    ("frequency_ratio", "ω′ = ω/ωn"),
    ("period", "Period"),
    ("angular_frequency", "Angular frequency"),
    ("forced_mode", "Number of the natural frequency that is forced"),
];

const FORCE_RATIO: Key<'static> = ("force_ratio", "f′ = F/(m g)");

impl SceneReader<'_> {
    pub(super) fn excitation(&self, at: At<'_>, kind: &'static Kind) -> Option<ExcitationRecipe> {
        at.choose("the excitation", &FORMS, |choice| match choice.name() {
            "none" => self.silence(&choice, kind),
            name => self.driven(name, choice.keys("the excitation")?, kind),
        })
    }

    fn driven(&self, name: &str, keys: Keys<'_>, kind: &'static Kind) -> Option<ExcitationRecipe> {
        let harmonic = name == "harmonic";
        let place = self.at(&keys, kind, [Parameter::ForceX, Parameter::ForceY]);
        let strengths: &[Key<'_>] = if harmonic {
            &[FORCE_RATIO, ("base_amplitude_ratio", "a ω²/g"), ("force", "Force")]
        } else {
            &[FORCE_RATIO, ("impulse", "Impulse")]
        };
        let strength = keys.exactly_one(strengths, |key, at| self.strength(key, at, kind));
        let impulse_time =
            keys.optional_where(!harmonic, "impulse_time", Slot::ImpulseTime.about(), |at| self.impulse_time(at, kind));
        let slot = if harmonic { Slot::HarmonicReference } else { Slot::FrequencyReference };
        let reference = keys
            .optional_where(kind.is_lumped(), "frequency_reference", slot.about(), |at| self.reading(at, slot, kind));
        let timing = |key: &'static str, at: At<'_>| self.timing(key, at);
        let timing = match name {
            // Time is counted in natural cycles unless the file says otherwise.
            "single_impulse" => keys
                .at_most_one(&TIMING, timing)
                .map(|given| given.unwrap_or(TimingRecipe::FrequencyRatio(Given::Stated(1.0)))),
            _ => keys.exactly_one(&TIMING, timing),
        };
        let pulse = (name == "pulse_train").then(|| self.pulse(&keys));
        keys.close()?;
        let (strength, timing) = (strength?, timing?);
        let kind_of_excitation = match pulse {
            Some(pulse) => {
                let (duration, shape) = pulse?;
                ExcitationKind::PulseTrain { duration, shape }
            }
            None if harmonic => ExcitationKind::Harmonic,
            None if name == "impulse_train" => ExcitationKind::ImpulseTrain,
            None => ExcitationKind::SingleImpulse,
        };
        Some(ExcitationRecipe {
            kind: kind_of_excitation,
            at: place?,
            strength,
            timing,
            frequency_reference: reference?.unwrap_or_else(|| self.left_out(slot, kind, Carried::Base)),
            impulse_time: impulse_time?.unwrap_or_else(|| self.usual_impulse_time(kind)),
        })
    }

    /// `none`, or `{none: {period: 1 s}}` where time is not counted in natural cycles: a mass without spring has none.
    fn silence(&self, choice: &Choice<'_>, kind: &'static Kind) -> Option<ExcitationRecipe> {
        let silent = ExcitationRecipe::silent(self.left_out(Slot::FrequencyReference, kind, Carried::Base));
        if choice.is_bare() {
            return Some(silent);
        }
        let keys = choice.keys("the cycle that time is counted in")?;
        let timing = keys.required("period", "Period", |at| self.timing("period", at));
        keys.close()?;
        Some(ExcitationRecipe { timing: timing?, ..silent })
    }

    /// A time, a reading, an assumption, or `{factor: κ, frequency: forcing}`.
    fn impulse_time(&self, at: At<'_>, kind: &'static Kind) -> Option<ImpulseTimeRecipe> {
        let is_usual = |value: &Value| matches!(value, Value::Scalar(word) if word == "assumed");
        if at.holds(is_usual) && self.by_default::<()>(Slot::ImpulseFactor, kind).is_some() {
            return Some(self.usual_impulse_time(kind));
        }
        let is_factor = |value: &Value| matches!(value, Value::Mapping(entries) if entries.iter().any(|entry| entry.key == "factor"));
        at.either(
            is_factor,
            |at| self.impulse_factor(at, kind),
            |at| {
                let time = self.slot(at, Slot::ImpulseTime, kind, |at| {
                    let readings = Slot::ImpulseTime.takes().readings;
                    let is_reading =
                        |value: &Value| matches!(value, Value::Scalar(word) if readings.contains(&word.as_str()));
                    let reading = |at: At<'_>| {
                        at.form(
                            |node, _| if let Value::Scalar(word) = &node.value { from_word(word) } else { None },
                            |it| one_of_words(it.about(), readings),
                        )
                    };
                    at.either(is_reading, reading, |at| at.above_zero(Dimension::Time).map(ImpulseTime::Seconds))
                });
                time.map(ImpulseTimeRecipe::By)
            },
        )
    }

    fn impulse_factor(&self, at: At<'_>, kind: &'static Kind) -> Option<ImpulseTimeRecipe> {
        let keys = at.keys("an impulse time")?;
        let factor = keys.required("factor", Slot::ImpulseFactor.about(), |at| {
            self.slot(at, Slot::ImpulseFactor, kind, |at| at.ratio())
        });
        let frequency = keys
            .optional("frequency", Slot::ImpulseFrequency.about(), |at| self.reading(at, Slot::ImpulseFrequency, kind));
        keys.close()?;
        let usual = || self.left_out(Slot::ImpulseFrequency, kind, ForcingOrNatural::Forcing);
        Some(ImpulseTimeRecipe::Factor { factor: factor?, frequency: frequency?.unwrap_or_else(usual) })
    }

    /// J = f′ m g/ω, unless the study declares assumptions for it.
    fn usual_impulse_time(&self, kind: &'static Kind) -> ImpulseTimeRecipe {
        if let Some(time) = self.by_default(Slot::ImpulseTime, kind) {
            return ImpulseTimeRecipe::By(time);
        }
        match self.by_default(Slot::ImpulseFactor, kind) {
            Some(factor) => ImpulseTimeRecipe::Factor {
                factor,
                frequency: self.left_out(Slot::ImpulseFrequency, kind, ForcingOrNatural::Forcing),
            },
            None => ImpulseTimeRecipe::By(Given::Stated(ImpulseTime::Radian)),
        }
    }

    fn strength(&self, key: &str, at: At<'_>, kind: &'static Kind) -> Option<StrengthRecipe> {
        let size = |slot: Slot, parameter: Parameter, dimension: Dimension| {
            self.slot(at, slot, kind, |at| self.swept_or(at, parameter, |at| at.quantity(dimension)))
        };
        match key {
            "impulse" => size(Slot::Impulse, Parameter::Impulse, Dimension::Impulse).map(StrengthRecipe::Impulse),
            "force" => size(Slot::Force, Parameter::Force, Dimension::Force).map(StrengthRecipe::Force),
            "base_amplitude_ratio" => {
                self.sweepable(at, Parameter::BaseAmplitudeRatio).map(StrengthRecipe::BaseAmplitudeRatio)
            }
            _ => self.sweepable(at, Parameter::ForceRatio).map(StrengthRecipe::ForceRatio),
        }
    }

    fn timing(&self, key: &str, at: At<'_>) -> Option<TimingRecipe> {
        match key {
            "period" => self
                .given(at, Takes::quantity(Dimension::Time), |at| at.above_zero(Dimension::Time))
                .map(TimingRecipe::Period),
            "angular_frequency" => self
                .given(at, Takes::quantity(Dimension::AngularFrequency), |at| {
                    self.swept_or(at, Parameter::AngularFrequency, |at| at.above_zero(Dimension::AngularFrequency))
                })
                .map(TimingRecipe::AngularFrequency),
            "forced_mode" if self.is_swept(at, Parameter::ForcedMode) => Some(TimingRecipe::ForcedMode(1)),
            "forced_mode" => at.count("", 100_000).map(TimingRecipe::ForcedMode),
            _ => self.sweepable(at, Parameter::FrequencyRatio).map(TimingRecipe::FrequencyRatio),
        }
    }

    fn pulse(&self, keys: &Keys<'_>) -> Option<(Given, PulseShape)> {
        let duration = keys.required("duration", "Duration of a pulse, whole milliseconds of a binomial one", |at| {
            self.given(at, Takes::quantity(Dimension::Time), |at| {
                self.swept_or(at, Parameter::PulseDuration, |at| at.above_zero(Dimension::Time))
            })
        });
        let shape = keys.required("shape", "Shape of a pulse", |at| {
            at.choose("a pulse", &[("rectangular", ""), ("binomial", "")], |choice| {
                choice.bare()?;
                Some(choice.name())
            })
        });
        let (duration, shape) = (duration?, shape?);
        if shape != "binomial" {
            return Some((duration, PulseShape::Rectangular));
        }
        let Given::Stated(seconds) = duration else {
            return keys.wrong("a binomial pulse has a stated or swept duration");
        };
        match PulseShape::binomial(seconds) {
            Ok(shape) => Some((duration, shape)),
            Err(error) => keys.wrong(&error.to_string()),
        }
    }
}
