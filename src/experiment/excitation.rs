//! The excitation of a scene.

use crate::scene::{
    ExcitationKind, ExcitationRecipe, Given, ImpulseTime, Kind, Parameter, PulseShape, StrengthRecipe, TimingRecipe,
};

use super::quantity::Dimension;
use super::reader::{Choice, Fields, above_zero, count, quantity};
use super::scene::{SceneReader, is_word};
use super::yaml::Node;

impl<'t> SceneReader<'t> {
    pub(super) fn excitation(&self, node: &'t Node, kind: &Kind) -> Option<ExcitationRecipe> {
        let names = ["single_impulse", "impulse_train", "harmonic", "pulse_train", "none"];
        let choice = Choice::read(node, "the excitation", &names, self.findings)?;
        if choice.name == "none" {
            return self.silence(&choice);
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
            _ => fields.optional("impulse_time", |node| self.impulse_time(node)),
        };
        let timing_keys = ["frequency_ratio", "period", "angular_frequency", "forced_mode"];
        let timing = match choice.name {
            // Time is counted in natural cycles unless the file says otherwise.
            "single_impulse" => fields.at_most_one(&timing_keys).and_then(|given| match given {
                Some((key, node)) => self.timing(key, node),
                None => Some(TimingRecipe::FrequencyRatio(1.0)),
            }),
            _ => fields.exactly_one(&timing_keys).and_then(|(key, node)| self.timing(key, node)),
        };
        let pulse = if choice.name == "pulse_train" { Some(self.pulse(&fields)) } else { None };
        fields.close()?;
        let (strength, timing) = (strength?, timing?);
        let kind = match pulse {
            Some(pulse) => {
                let (duration, shape) = pulse?;
                ExcitationKind::PulseTrain { duration, shape }
            }
            None if choice.name == "harmonic" => ExcitationKind::Harmonic,
            None if choice.name == "impulse_train" => ExcitationKind::ImpulseTrain,
            None => ExcitationKind::SingleImpulse,
        };
        let impulse_time = impulse_time?.unwrap_or(ImpulseTime::Assumed);
        Some(ExcitationRecipe { kind, at: at?, strength, timing, impulse_time })
    }

    /// `none`, or `{none: {period: 1 s}}` where time is not counted in natural cycles: a mass without spring has none.
    fn silence(&self, choice: &Choice<'t>) -> Option<ExcitationRecipe> {
        let silent = ExcitationRecipe::silent();
        if choice.content.is_none() {
            return Some(silent);
        }
        let fields = choice.fields("the cycle that time is counted in", self.findings)?;
        let timing = fields.required("period", |node| self.timing("period", node));
        fields.close()?;
        Some(ExcitationRecipe { timing: timing?, ..silent })
    }

    /// `assumed`, a time, or a reading.
    fn impulse_time(&self, node: &'t Node) -> Option<ImpulseTime> {
        if is_word(node, "assumed") {
            return Some(ImpulseTime::Assumed);
        }
        match ImpulseTime::WORDS.into_iter().find(|(word, _)| is_word(node, word)) {
            Some((_, time)) => Some(time),
            None => above_zero(node, Dimension::Time, self.findings).map(ImpulseTime::Seconds),
        }
    }

    fn strength(&self, key: &str, node: &'t Node, kind: &Kind) -> Option<StrengthRecipe> {
        match key {
            "impulse" => {
                if let (true, Some(name)) = (is_word(node, "assumed"), kind.family.impulse()) {
                    return Some(StrengthRecipe::Impulse(Given::Assumed(name)));
                }
                let impulse =
                    self.swept_or(node, Parameter::Impulse, |node| quantity(node, Dimension::Impulse, self.findings));
                impulse.map(Given::Stated).map(StrengthRecipe::Impulse)
            }
            "force" => {
                if let (true, Some(name)) = (is_word(node, "assumed"), kind.family.harmonic_force()) {
                    return Some(StrengthRecipe::Force(Given::Assumed(name)));
                }
                let force =
                    self.swept_or(node, Parameter::Force, |node| quantity(node, Dimension::Force, self.findings));
                force.map(Given::Stated).map(StrengthRecipe::Force)
            }
            "base_amplitude_ratio" => {
                self.sweepable(node, Parameter::BaseAmplitudeRatio).map(StrengthRecipe::BaseAmplitudeRatio)
            }
            _ => self.sweepable(node, Parameter::ForceRatio).map(StrengthRecipe::ForceRatio),
        }
    }

    fn timing(&self, key: &str, node: &'t Node) -> Option<TimingRecipe> {
        match key {
            "period" => above_zero(node, Dimension::Time, self.findings).map(TimingRecipe::Period),
            "angular_frequency" => self
                .swept_or(node, Parameter::AngularFrequency, |node| {
                    above_zero(node, Dimension::AngularFrequency, self.findings)
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

    fn pulse(&self, fields: &Fields<'t>) -> Option<(f64, PulseShape)> {
        let duration = fields.required("duration", |node| {
            self.swept_or(node, Parameter::PulseDuration, |node| above_zero(node, Dimension::Time, self.findings))
        });
        let shape = fields.required("shape", |node| {
            Choice::read(node, "a pulse", &["rectangular", "binomial"], self.findings)?.bare(self.findings)
        });
        let (duration, shape) = (duration?, shape?);
        // As the study's figure 31: one impulse a step of 1 ms.
        let impulses = (duration / 1e-3).round().clamp(1.0, 1e6) as u32;
        Some((duration, if shape == "binomial" { PulseShape::Binomial { impulses } } else { PulseShape::Rectangular }))
    }
}
