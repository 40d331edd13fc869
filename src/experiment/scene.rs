//! The `scene` of an experiment: nodes to a [`Recipe`].

use std::cell::RefCell;

use crate::scene::{
    Assumption, ContactDampingRecipe, DamperRecipe, Family, Filling, GapRecipe, Given, KINDS, Kind, MassReading,
    MassRecipe, Parameter, Part, Recipe, StiffnessRecipe, StopRecipe, SurfaceRecipe, WallRecipe,
};

use super::diagnostic::{Findings, Span};
use super::quantity::Dimension;
use super::reader::{Choice, Fields, above_zero, boolean, list, no_such, number, quantity, ratio, scalar};
use super::structure::read_structure;
use super::word::word_of;
use super::yaml::{Node, Value};

/// Stands where the file says `swept` until the sweep's first case takes its place.
const PLACEHOLDER: f64 = 1.0;

/// Most dampers that a file may name.
pub(super) const MOST_DAMPERS: usize = 64;

/// A scene as read, and where it says `swept`.
pub(super) struct ReadScene {
    pub recipe: Recipe,
    pub swept: Vec<(Parameter, Span)>,
    /// Where it says that a gap is optimised.
    pub optimised: Vec<Span>,
    /// Where each part stands.
    pub parts: Vec<(Part, Span)>,
}

/// Reads the node under `scene`.
pub(super) fn read_scene(node: &Node, findings: &Findings) -> Option<ReadScene> {
    let reader =
        SceneReader { findings, swept: RefCell::default(), optimised: RefCell::default(), parts: RefCell::default() };
    let recipe = reader.recipe(node)?;
    Some(ReadScene {
        recipe,
        swept: reader.swept.into_inner(),
        optimised: reader.optimised.into_inner(),
        parts: reader.parts.into_inner(),
    })
}

pub(super) struct SceneReader<'t> {
    pub(super) findings: &'t Findings,
    pub(super) swept: RefCell<Vec<(Parameter, Span)>>,
    optimised: RefCell<Vec<Span>>,
    pub(super) parts: RefCell<Vec<(Part, Span)>>,
}

impl<'t> SceneReader<'t> {
    fn recipe(&self, node: &'t Node) -> Option<Recipe> {
        let fields = Fields::open(node, "the scene", self.findings)?;
        let structure = fields.required("structure", |node| {
            self.parts.borrow_mut().push((Part::Structure, node.span));
            read_structure(node, self.findings, &self.swept)
        });
        let gravity = fields.optional("gravity", |node| {
            self.given(node, Assumption::Gravity, |node| quantity(node, Dimension::Acceleration, self.findings))
        });
        // What dampers and excitation may say depends on the structure; one that is wrong is taken for a single mass.
        let kind = structure.as_ref().map_or(KINDS[0], |structure| structure.kind);
        let dampers = fields.optional("dampers", |node| self.dampers(node, kind));
        let excitation = fields.required("excitation", |node| {
            self.parts.borrow_mut().push((Part::Excitation, node.span));
            self.excitation(node, kind)
        });
        let start = fields.optional("start", |node| self.start(node));
        let observe = fields.optional("observe", |node| {
            self.parts.borrow_mut().push((Part::Observe, node.span));
            self.observe(node, kind)
        });
        fields.close()?;
        Some(Recipe {
            structure: structure?.recipe,
            gravity: gravity?.unwrap_or(Given::Assumed(Assumption::Gravity)),
            dampers: dampers?.unwrap_or_default(),
            without_dampers: false,
            excitation: excitation?,
            start: start?,
            observe: observe?.unwrap_or_default(),
            mode: None,
        })
    }

    fn dampers(&self, node: &'t Node, kind: &Kind) -> Option<Vec<DamperRecipe>> {
        match &node.value {
            Value::Sequence(items) if items.is_empty() => Some(Vec::new()),
            Value::Sequence(items) if items.len() > MOST_DAMPERS => {
                self.findings.wrong(node.span, format!("{} dampers: {MOST_DAMPERS} at most", items.len()))
            }
            Value::Sequence(items) => {
                let mut parts = self.parts.borrow_mut();
                parts.extend(items.iter().enumerate().map(|(index, item)| (Part::Damper(index), item.span)));
                drop(parts);
                list(node, self.findings, |node| self.damper(node, kind))
            }
            _ => list(node, self.findings, |node| self.damper(node, kind)),
        }
    }

    fn damper(&self, node: &'t Node, kind: &Kind) -> Option<DamperRecipe> {
        let fields = Fields::open(node, "a damper", self.findings)?;
        let at = self.at(&fields, kind, [Parameter::DamperX, Parameter::DamperY]);
        let array =
            if kind.sides.is_empty() { Some(None) } else { fields.optional("array", |node| self.array(node, kind)) };
        let mass = fields.exactly_one(&["mass_ratio", "mass"]).and_then(|(key, node)| match key {
            "mass" => quantity(node, Dimension::Mass, self.findings).map(MassRecipe::Mass),
            _ => self.sweepable(node, Parameter::MassRatio).map(MassRecipe::Ratio),
        });
        let share = |node: &'t Node| self.sweepable(node, Parameter::ParticleShare);
        // On one mass the study has no enclosure; on a beam or plate it always has.
        let (mass_reading, particle_share) = if kind.family == Family::Mass {
            (Some(None), fields.optional("particle_share", share).map(|share| share.unwrap_or(1.0)))
        } else {
            let reading = fields.optional("mass_reading", |node| self.mass_reading(node));
            (reading, fields.required("particle_share", share))
        };
        let gap = fields.exactly_one(&["gap_ratio", "gap"]).and_then(|(key, node)| match key {
            _ if is_word(node, "infinite") => Some(GapRecipe::Infinite),
            _ if is_word(node, "optimised") => {
                self.optimised.borrow_mut().push(node.span);
                Some(GapRecipe::Gap(PLACEHOLDER))
            }
            "gap" if matches!(node.value, Value::Mapping(_)) => self.filled(node),
            "gap" if matches!(node.value, Value::Sequence(_)) => {
                list(node, self.findings, |node| quantity(node, Dimension::Length, self.findings)).map(GapRecipe::Gaps)
            }
            _ if matches!(node.value, Value::Sequence(_)) => {
                list(node, self.findings, |node| ratio(node, self.findings)).map(GapRecipe::Ratios)
            }
            "gap" => quantity(node, Dimension::Length, self.findings).map(GapRecipe::Gap),
            _ => self.sweepable(node, Parameter::GapRatio).map(GapRecipe::Ratio),
        });
        let floor = fields.required("floor", |node| self.surface(node, kind));
        let ceiling = fields.optional("ceiling", |node| self.surface(node, kind));
        let stop = fields.optional("stop", |node| self.stop(node));
        let walls = fields.optional("walls", |node| self.walls(node));
        fields.close()?;
        let floor = floor?;
        let ceiling = ceiling?.unwrap_or_else(|| floor.clone());
        Some(DamperRecipe {
            at: at?,
            array: array?,
            mass: mass?,
            mass_reading: mass_reading?.unwrap_or(MassReading::Assumed),
            particle_share: particle_share?,
            gap: gap?,
            floor,
            ceiling,
            stop: stop?,
            walls: walls?,
        })
    }

    /// An array filled in one of two ways, which a sweep chooses.
    fn filled(&self, node: &'t Node) -> Option<GapRecipe> {
        let fields = Fields::open(node, "a filling", self.findings)?;
        let length = |node: &'t Node| quantity(node, Dimension::Length, self.findings);
        let uniform = fields.required("uniform", length);
        let optimised = fields.required("optimised", |node| list(node, self.findings, length));
        self.swept.borrow_mut().push((Parameter::Filling, node.span));
        fields.close()?;
        Some(GapRecipe::Filled { uniform: uniform?, optimised: optimised?, filling: Filling::Uniform })
    }

    /// `assumed`, or a reading, which a sweep may vary.
    fn mass_reading(&self, node: &'t Node) -> Option<MassReading> {
        if let Some(named) = self.named(node, &[Assumption::ArrayDamperMass]) {
            return named.map(MassReading::By);
        }
        let names = ["assumed", "total", "modal", "swept"];
        let choice = Choice::read(node, "the reading of a mass ratio", &names, self.findings)?;
        Some(match choice.bare(self.findings)? {
            "total" => MassReading::Total,
            "modal" => MassReading::Modal,
            "swept" => {
                self.swept.borrow_mut().push((Parameter::MassReading, node.span));
                MassReading::Total
            }
            _ => MassReading::Assumed,
        })
    }

    fn surface(&self, node: &'t Node, kind: &Kind) -> Option<SurfaceRecipe> {
        let choice = Choice::read(node, "a surface", &["rigid", "resilient"], self.findings)?;
        if choice.name == "rigid" {
            let fields = choice.fields("a rigid surface", self.findings)?;
            let restitution = fields.required("restitution", |node| self.restitution(node));
            fields.close()?;
            return Some(SurfaceRecipe::Rigid { restitution: restitution? });
        }
        let fields = choice.fields("a resilient surface", self.findings)?;
        let stiffness = fields.exactly_one(&["stiffness_ratio", "stiffness"]).and_then(|(key, node)| match key {
            "stiffness" if is_word(node, "tuned") => Some(StiffnessRecipe::Tuned),
            "stiffness" if is_word(node, "untuned") => Some(StiffnessRecipe::Untuned),
            "stiffness" if is_word(node, "assumed") => Some(StiffnessRecipe::Assumed),
            "stiffness" if names_assumption(node) => {
                self.named(node, kind.family.array_floor_tuning().as_slice())?.map(StiffnessRecipe::By)
            }
            "stiffness" if is_word(node, "swept") => {
                self.swept.borrow_mut().push((Parameter::FloorTuning, node.span));
                Some(StiffnessRecipe::Tuned)
            }
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
            _ if names_assumption(node) => {
                let named = self.named(node, kind.family.array_damping_ratio().as_slice())?;
                named.map(Given::Assumed).map(ContactDampingRecipe::Ratio)
            }
            _ => self
                .given(node, kind.family.contact_damping_ratio(), |node| {
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

    /// A dimensionless parameter, or `swept`.
    pub(super) fn sweepable(&self, node: &'t Node, parameter: Parameter) -> Option<f64> {
        self.swept_or(node, parameter, |node| ratio(node, self.findings))
    }

    pub(super) fn swept_or(
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

    /// The assumption that `{assumed: NAME}` names in the place of the usual one; `None` where the file says something else.
    pub(super) fn named(&self, node: &'t Node, offered: &[Assumption]) -> Option<Option<Assumption>> {
        let Value::Mapping(entries) = &node.value else { return None };
        let [entry] = entries.as_slice() else { return None };
        if !names_assumption(node) {
            return None;
        }
        let named = scalar(&entry.node, self.findings).and_then(|word| {
            let known = offered.iter().find(|name| word_of(**name) == word);
            known.copied().or_else(|| {
                let words: Vec<String> = offered.iter().map(word_of).collect();
                let words: Vec<&str> = words.iter().map(String::as_str).collect();
                no_such(self.findings, entry.node.span, "assumption for this key", word, &words)
            })
        });
        Some(named)
    }

    /// A value, or `assumed`.
    pub(super) fn given(
        &self,
        node: &'t Node,
        assumption: Assumption,
        read: impl FnOnce(&'t Node) -> Option<f64>,
    ) -> Option<Given> {
        if is_word(node, "assumed") { Some(Given::Assumed(assumption)) } else { read(node).map(Given::Stated) }
    }
}

/// It says `{assumed: …}`.
fn names_assumption(node: &Node) -> bool {
    matches!(&node.value, Value::Mapping(entries) if matches!(entries.as_slice(), [entry] if entry.key == "assumed"))
}

pub(super) fn is_word(node: &Node, word: &str) -> bool {
    matches!(&node.value, Value::Scalar(text) if text == word)
}
