//! The excitation of a scene.

use super::assumption_sheet::Takes;
use super::quantity::Dimension;
use super::reader::{Choice, Fields, above_zero, count, quantity, ratio};
use super::recipe::{
    Carried, ExcitationKind, ExcitationRecipe, ForcingOrNatural, Given, ImpulseTime, ImpulseTimeRecipe, Parameter,
    Slot, StrengthRecipe, TimingRecipe,
};
use super::scene::{SceneReader, is_word};
use super::word::from_word;
use super::yaml::{Node, Value};
use crate::scene::{Kind, PulseShape};

impl<'t> SceneReader<'t> {
    pub(super) fn excitation(&self, node: &'t Node, kind: &'static Kind) -> Option<ExcitationRecipe> {
        let names = ["single_impulse", "impulse_train", "harmonic", "pulse_train", "none"];
        let choice = Choice::read(node, "the excitation", &names, self.findings)?;
        if choice.name == "none" {
            return self.silence(&choice, kind);
        }
        let fields = choice.fields("the excitation", self.findings)?;
        let at = self.at(&fields, kind, [Parameter::ForceX, Parameter::ForceY]);
        let strength_keys: &[_] = match choice.name {
            "harmonic" => &["force_ratio", "base_amplitude_ratio", "force"],
            _ => &["force_ratio", "impulse"],
        };
        let strength = fields.exactly_one(strength_keys).and_then(|(key, node)| self.strength(key, node, kind));
        let impulse_time = match choice.name {
            "harmonic" => Some(None),
            _ => fields.optional("impulse_time", |node| self.impulse_time(node, kind)),
        };
        let reference_slot = if choice.name == "harmonic" { Slot::HarmonicReference } else { Slot::FrequencyReference };
        let reference = match kind.is_lumped() {
            true => fields.optional("frequency_reference", |node| self.reading(node, reference_slot, kind)),
            false => Some(None),
        };
        let timing_keys = ["frequency_ratio", "period", "angular_frequency", "forced_mode"];
        let timing = match choice.name {
            // Time is counted in natural cycles unless the file says otherwise.
            "single_impulse" => fields.at_most_one(&timing_keys).and_then(|given| match given {
                Some((key, node)) => self.timing(key, node),
                None => Some(TimingRecipe::FrequencyRatio(Given::Stated(1.0))),
            }),
            _ => fields.exactly_one(&timing_keys).and_then(|(key, node)| self.timing(key, node)),
        };
        let pulse = if choice.name == "pulse_train" { Some(self.pulse(&fields)) } else { None };
        fields.close()?;
        let (strength, timing) = (strength?, timing?);
        let kind_of_excitation = match pulse {
            Some(pulse) => {
                let (duration, shape) = pulse?;
                ExcitationKind::PulseTrain { duration, shape }
            }
            None if choice.name == "harmonic" => ExcitationKind::Harmonic,
            None if choice.name == "impulse_train" => ExcitationKind::ImpulseTrain,
            None => ExcitationKind::SingleImpulse,
        };
        Some(ExcitationRecipe {
            kind: kind_of_excitation,
            at: at?,
            strength,
            timing,
            frequency_reference: reference?.unwrap_or_else(|| self.left_out(reference_slot, kind, Carried::Base)),
            impulse_time: impulse_time?.unwrap_or_else(|| self.usual_impulse_time(kind)),
        })
    }

    /// `none`, or `{none: {period: 1 s}}` where time is not counted in natural cycles: a mass without spring has none.
    fn silence(&self, choice: &Choice<'t>, kind: &'static Kind) -> Option<ExcitationRecipe> {
        let silent = ExcitationRecipe::silent(self.left_out(Slot::FrequencyReference, kind, Carried::Base));
        if choice.content.is_none() {
            return Some(silent);
        }
        let fields = choice.fields("the cycle that time is counted in", self.findings)?;
        let timing = fields.required("period", |node| self.timing("period", node));
        fields.close()?;
        Some(ExcitationRecipe { timing: timing?, ..silent })
    }

    /// A time, a reading, an assumption, or `{factor: κ, frequency: forcing}`.
    fn impulse_time(&self, node: &'t Node, kind: &'static Kind) -> Option<ImpulseTimeRecipe> {
        if is_word(node, "assumed") && self.by_default::<()>(Slot::ImpulseFactor, kind).is_some() {
            return Some(self.usual_impulse_time(kind));
        }
        if matches!(&node.value, Value::Mapping(entries) if entries.iter().any(|entry| entry.key == "factor")) {
            let fields = Fields::open(node, "an impulse time", self.findings)?;
            let factor = fields.required("factor", |node| {
                self.slot(node, Slot::ImpulseFactor, kind, |node| ratio(node, self.findings))
            });
            let frequency = fields.optional("frequency", |node| self.reading(node, Slot::ImpulseFrequency, kind));
            fields.close()?;
            let usual = || self.left_out(Slot::ImpulseFrequency, kind, ForcingOrNatural::Forcing);
            return Some(ImpulseTimeRecipe::Factor { factor: factor?, frequency: frequency?.unwrap_or_else(usual) });
        }
        let time = self.slot(node, Slot::ImpulseTime, kind, |node| {
            let reading = match &node.value {
                Value::Scalar(word) if Slot::ImpulseTime.takes().readings.contains(&word.as_str()) => from_word(word),
                _ => None,
            };
            reading.or_else(|| above_zero(node, Dimension::Time, self.findings).map(ImpulseTime::Seconds))
        });
        time.map(ImpulseTimeRecipe::By)
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

    fn strength(&self, key: &str, node: &'t Node, kind: &'static Kind) -> Option<StrengthRecipe> {
        let size = |slot: Slot, parameter: Parameter, dimension: Dimension| {
            self.slot(node, slot, kind, |node| {
                self.swept_or(node, parameter, |node| quantity(node, dimension, self.findings))
            })
        };
        match key {
            "impulse" => size(Slot::Impulse, Parameter::Impulse, Dimension::Impulse).map(StrengthRecipe::Impulse),
            "force" => size(Slot::Force, Parameter::Force, Dimension::Force).map(StrengthRecipe::Force),
            "base_amplitude_ratio" => {
                self.sweepable(node, Parameter::BaseAmplitudeRatio).map(StrengthRecipe::BaseAmplitudeRatio)
            }
            _ => self.sweepable(node, Parameter::ForceRatio).map(StrengthRecipe::ForceRatio),
        }
    }

    fn timing(&self, key: &str, node: &'t Node) -> Option<TimingRecipe> {
        match key {
            "period" => self
                .given(node, Takes::quantity(Dimension::Time), |node| above_zero(node, Dimension::Time, self.findings))
                .map(TimingRecipe::Period),
            "angular_frequency" => self
                .given(node, Takes::quantity(Dimension::AngularFrequency), |node| {
                    self.swept_or(node, Parameter::AngularFrequency, |node| {
                        above_zero(node, Dimension::AngularFrequency, self.findings)
                    })
                })
                .map(TimingRecipe::AngularFrequency),
            "forced_mode" if is_word(node, "swept") => {
                self.swept.borrow_mut().push((Parameter::ForcedMode, node.span));
                Some(TimingRecipe::ForcedMode(1))
            }
            "forced_mode" => count(node, "", 100_000, self.findings).map(TimingRecipe::ForcedMode),
            _ => self.sweepable(node, Parameter::FrequencyRatio).map(TimingRecipe::FrequencyRatio),
        }
    }

    fn pulse(&self, fields: &Fields<'t>) -> Option<(Given, PulseShape)> {
        let duration = fields.required("duration", |node| {
            self.given(node, Takes::quantity(Dimension::Time), |node| {
                self.swept_or(node, Parameter::PulseDuration, |node| above_zero(node, Dimension::Time, self.findings))
            })
        });
        let shape = fields.required("shape", |node| {
            Choice::read(node, "a pulse", &["rectangular", "binomial"], self.findings)?.bare(self.findings)
        });
        let (duration, shape) = (duration?, shape?);
        if shape != "binomial" {
            return Some((duration, PulseShape::Rectangular));
        }
        let Given::Stated(seconds) = duration else {
            return self.findings.wrong(fields.span(), "a binomial pulse has a stated or swept duration");
        };
        // One impulse a step of 1 ms.
        let impulses = (seconds / 1e-3).round().clamp(1.0, 1e6) as u32;
        Some((duration, PulseShape::Binomial { impulses }))
    }
}
