//! The `scene` of an experiment: nodes to a [`Recipe`].

use std::cell::RefCell;

use crate::scene::{
    Assumption, ContactDampingRecipe, DamperRecipe, ExcitationRecipe, GapRecipe, Given, MassRecipe, Parameter,
    PulseShape, Recipe, StiffnessRecipe, StopRecipe, StrengthRecipe, StructureRecipe, SurfaceRecipe, TimingRecipe,
    WallRecipe,
};

use super::diagnostic::{Findings, Span};
use super::quantity::Dimension;
use super::reader::{Choice, Fields, above_zero, boolean, list, number, quantity, ratio};
use super::yaml::{Node, Value};

/// Stands where the file says `swept` until the sweep's first case takes its place.
const PLACEHOLDER: f64 = 1.0;

/// Most dampers that a file may name.
const MOST_DAMPERS: usize = 64;

/// A scene as read, and where it says `swept`.
pub(super) struct ReadScene {
    pub recipe: Recipe,
    pub swept: Vec<(Parameter, Span)>,
}

/// Reads the node under `scene`.
pub(super) fn read_scene(node: &Node, findings: &Findings) -> Option<ReadScene> {
    let reader = SceneReader { findings, swept: RefCell::default() };
    let recipe = reader.recipe(node)?;
    Some(ReadScene { recipe, swept: reader.swept.into_inner() })
}

struct SceneReader<'t> {
    findings: &'t Findings,
    swept: RefCell<Vec<(Parameter, Span)>>,
}

impl<'t> SceneReader<'t> {
    fn recipe(&self, node: &'t Node) -> Option<Recipe> {
        let fields = Fields::open(node, "the scene", self.findings)?;
        let structure = fields.required("structure", |node| self.structure(node));
        let gravity = fields.optional("gravity", |node| {
            self.given(node, Assumption::Gravity, |node| quantity(node, Dimension::Acceleration, self.findings))
        });
        let dampers = fields.optional("dampers", |node| self.dampers(node));
        let excitation = fields.required("excitation", |node| self.excitation(node));
        fields.close()?;
        Some(Recipe {
            structure: structure?,
            gravity: gravity?.unwrap_or(Given::Assumed(Assumption::Gravity)),
            dampers: dampers?.unwrap_or_default(),
            excitation: excitation?,
        })
    }

    fn structure(&self, node: &'t Node) -> Option<StructureRecipe> {
        let choice = Choice::read(node, "the structure", &["single_mass"], self.findings)?;
        let fields = choice.fields("a single mass", self.findings)?;
        let mass = fields.required("mass", |node| above_zero(node, Dimension::Mass, self.findings));
        let stiffness = fields.required("stiffness", |node| above_zero(node, Dimension::Stiffness, self.findings));
        let damping_ratio = fields.required("damping_ratio", |node| self.sweepable(node, Parameter::DampingRatio));
        fields.close()?;
        Some(StructureRecipe::SingleMass { mass: mass?, stiffness: stiffness?, damping_ratio: damping_ratio? })
    }

    fn dampers(&self, node: &'t Node) -> Option<Vec<DamperRecipe>> {
        match &node.value {
            Value::Sequence(items) if items.is_empty() => Some(Vec::new()),
            Value::Sequence(items) if items.len() > MOST_DAMPERS => {
                self.findings.wrong(node.span, format!("{} dampers: {MOST_DAMPERS} at most", items.len()))
            }
            _ => list(node, self.findings, |node| self.damper(node)),
        }
    }

    fn damper(&self, node: &'t Node) -> Option<DamperRecipe> {
        let fields = Fields::open(node, "a damper", self.findings)?;
        let mass = fields.exactly_one(&["mass_ratio", "mass"]).and_then(|(key, node)| match key {
            "mass" => quantity(node, Dimension::Mass, self.findings).map(MassRecipe::Mass),
            _ => self.sweepable(node, Parameter::MassRatio).map(MassRecipe::Ratio),
        });
        let gap = fields.exactly_one(&["gap_ratio", "gap"]).and_then(|(key, node)| match key {
            _ if is_word(node, "infinite") => Some(GapRecipe::Infinite),
            "gap" => quantity(node, Dimension::Length, self.findings).map(GapRecipe::Gap),
            _ => self.sweepable(node, Parameter::GapRatio).map(GapRecipe::Ratio),
        });
        let floor = fields.required("floor", |node| self.surface(node));
        let ceiling = fields.optional("ceiling", |node| self.surface(node));
        let stop = fields.optional("stop", |node| self.stop(node));
        let walls = fields.optional("walls", |node| self.walls(node));
        fields.close()?;
        let floor = floor?;
        let ceiling = ceiling?.unwrap_or_else(|| floor.clone());
        Some(DamperRecipe { mass: mass?, gap: gap?, floor, ceiling, stop: stop?, walls: walls? })
    }

    fn surface(&self, node: &'t Node) -> Option<SurfaceRecipe> {
        let choice = Choice::read(node, "a surface", &["rigid", "resilient"], self.findings)?;
        if choice.name == "rigid" {
            let fields = choice.fields("a rigid surface", self.findings)?;
            let restitution = fields.required("restitution", |node| self.restitution(node));
            fields.close()?;
            return Some(SurfaceRecipe::Rigid { restitution: restitution? });
        }
        let fields = choice.fields("a resilient surface", self.findings)?;
        let stiffness = fields.exactly_one(&["stiffness_ratio", "stiffness"]).and_then(|(key, node)| match key {
            "stiffness" => above_zero(node, Dimension::Stiffness, self.findings).map(StiffnessRecipe::Stiffness),
            _ => self
                .given(node, Assumption::FloorStiffnessRatio, |node| {
                    self.sweepable(node, Parameter::FloorStiffnessRatio)
                })
                .map(StiffnessRecipe::Ratio),
        });
        let damping = fields.exactly_one(&["damping_ratio", "damping"]).and_then(|(key, node)| match key {
            "damping" if is_word(node, "equivalent_viscous") => Some(ContactDampingRecipe::EquivalentViscous),
            "damping" => quantity(node, Dimension::Damping, self.findings).map(ContactDampingRecipe::Damping),
            _ => self
                .given(node, Assumption::ContactDampingRatio, |node| {
                    self.sweepable(node, Parameter::ContactDampingRatio)
                })
                .map(ContactDampingRecipe::Ratio),
        });
        let no_tension = fields.optional("no_tension", |node| boolean(node, self.findings));
        fields.close()?;
        Some(SurfaceRecipe::Resilient {
            stiffness: stiffness?,
            damping: damping?,
            no_tension: no_tension?.unwrap_or(false),
        })
    }

    fn restitution(&self, node: &'t Node) -> Option<f64> {
        let value = number(node, self.findings)?;
        if (0.0..=1.0).contains(&value) {
            Some(value)
        } else {
            self.findings.wrong(node.span, "a coefficient of restitution lies between 0 and 1")
        }
    }

    fn stop(&self, node: &'t Node) -> Option<StopRecipe> {
        let restitution_assumed = Given::Assumed(Assumption::StopRestitution);
        if is_word(node, "assumed") {
            return Some(StopRecipe {
                length: Given::Assumed(Assumption::StopLength),
                restitution: restitution_assumed,
            });
        }
        let fields = Fields::open(node, "a limit stop", self.findings)?;
        let length = fields.required("length", |node| {
            self.given(node, Assumption::StopLength, |node| {
                self.swept_or(node, Parameter::StopLength, |node| above_zero(node, Dimension::Length, self.findings))
            })
        });
        let restitution = fields.optional("restitution", |node| {
            self.given(node, Assumption::StopRestitution, |node| self.restitution(node))
        });
        fields.close()?;
        Some(StopRecipe { length: length?, restitution: restitution?.unwrap_or(restitution_assumed) })
    }

    fn walls(&self, node: &'t Node) -> Option<WallRecipe> {
        let fields = Fields::open(node, "a pair of soft walls", self.findings)?;
        let stiffness_ratio =
            fields.required("stiffness_ratio", |node| self.sweepable(node, Parameter::WallStiffnessRatio));
        let damping = fields.required("damping", |node| quantity(node, Dimension::Damping, self.findings));
        let mass = fields.optional("ceiling_mass_ratio", |node| {
            self.given(node, Assumption::CeilingMassRatio, |node| ratio(node, self.findings))
        });
        fields.close()?;
        Some(WallRecipe {
            stiffness_ratio: stiffness_ratio?,
            damping: damping?,
            ceiling_mass_ratio: mass?.unwrap_or(Given::Assumed(Assumption::CeilingMassRatio)),
        })
    }

    fn excitation(&self, node: &'t Node) -> Option<ExcitationRecipe> {
        let names = ["single_impulse", "impulse_train", "harmonic", "pulse_train"];
        let choice = Choice::read(node, "the excitation", &names, self.findings)?;
        let fields = choice.fields("the excitation", self.findings)?;
        let strength_keys: &[_] = match choice.name {
            "harmonic" => &["force_ratio", "base_amplitude_ratio", "force"],
            _ => &["force_ratio", "impulse"],
        };
        let strength = fields.exactly_one(strength_keys).and_then(|(key, node)| self.strength(key, node));
        let timing_keys = ["frequency_ratio", "period", "angular_frequency"];
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
        Some(match pulse {
            Some(pulse) => {
                let (duration, shape) = pulse?;
                ExcitationRecipe::PulseTrain { strength, timing, duration, shape }
            }
            None if choice.name == "harmonic" => ExcitationRecipe::Harmonic { strength, timing },
            None if choice.name == "impulse_train" => ExcitationRecipe::ImpulseTrain { strength, timing },
            None => ExcitationRecipe::SingleImpulse { strength, timing },
        })
    }

    fn strength(&self, key: &str, node: &'t Node) -> Option<StrengthRecipe> {
        match key {
            "impulse" => quantity(node, Dimension::Impulse, self.findings).map(StrengthRecipe::Impulse),
            "force" => quantity(node, Dimension::Force, self.findings).map(StrengthRecipe::Force),
            "base_amplitude_ratio" => {
                self.sweepable(node, Parameter::BaseAmplitudeRatio).map(StrengthRecipe::BaseAmplitudeRatio)
            }
            _ => self.sweepable(node, Parameter::ForceRatio).map(StrengthRecipe::ForceRatio),
        }
    }

    fn timing(&self, key: &str, node: &'t Node) -> Option<TimingRecipe> {
        match key {
            "period" => above_zero(node, Dimension::Time, self.findings).map(TimingRecipe::Period),
            "angular_frequency" => {
                above_zero(node, Dimension::AngularFrequency, self.findings).map(TimingRecipe::AngularFrequency)
            }
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

    /// A dimensionless parameter, or `swept`.
    fn sweepable(&self, node: &'t Node, parameter: Parameter) -> Option<f64> {
        self.swept_or(node, parameter, |node| ratio(node, self.findings))
    }

    fn swept_or(
        &self,
        node: &'t Node,
        parameter: Parameter,
        read: impl FnOnce(&'t Node) -> Option<f64>,
    ) -> Option<f64> {
        if is_word(node, "swept") {
            self.swept.borrow_mut().push((parameter, node.span));
            return Some(PLACEHOLDER);
        }
        read(node)
    }

    /// A value, or `assumed`.
    fn given(
        &self,
        node: &'t Node,
        assumption: Assumption,
        read: impl FnOnce(&'t Node) -> Option<f64>,
    ) -> Option<Given> {
        if is_word(node, "assumed") { Some(Given::Assumed(assumption)) } else { read(node).map(Given::Stated) }
    }
}

fn is_word(node: &Node, word: &str) -> bool {
    matches!(&node.value, Value::Scalar(text) if text == word)
}
