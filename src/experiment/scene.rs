//! The `scene` of an experiment: nodes to a [`Recipe`].

use std::cell::RefCell;

use serde_json::json;

use super::recipe::{Assumptions, Carried, MeanRatio, Parameter, Recipe, Slot};
use super::scene_reader::SceneReader;
use super::structure::read_structure;
use crate::measure::Comparison;
use crate::scene::{KINDS, Kind, STANDARD_GRAVITY};
use crate::yaml::{At, Dimension, Node, Sketch, Span, Value};

/// A scene as read, and where it says `swept`.
pub(super) struct ReadScene {
    pub recipe: Recipe,
    pub swept: Vec<(Parameter, Span)>,
    /// Where it says that a gap is optimised.
    pub optimised: Vec<Span>,
}

/// Reads what stands under `scene`.
pub(super) fn read_scene(at: At<'_>, assumptions: &Assumptions) -> Option<ReadScene> {
    let reader = |unknown: &'static Kind| SceneReader {
        assumptions,
        unknown,
        swept: RefCell::default(),
        optimised: RefCell::default(),
    };
    if let At::Sketch(it) = at {
        describe(it, |at, kind| reader(kind).recipe(at));
        return None;
    }
    let reader = reader(KINDS[0]);
    let recipe = reader.recipe(at)?;
    Some(ReadScene { recipe, swept: reader.swept.into_inner(), optimised: reader.optimised.into_inner() })
}

/// What dampers and excitation may say depends on the structure: a schema asks which it is.
fn describe(it: &Sketch<'_>, recipe: impl Fn(At<'_>, &'static Kind) -> Option<Recipe>) {
    let scene = |lumped: bool| {
        let kind = KINDS.iter().rfind(|kind| kind.is_lumped() == lumped)?;
        Some(it.part(it.about(), |at| recipe(at, kind)))
    };
    let lumped = KINDS.iter().filter(|kind| kind.is_lumped());
    let lumped: Vec<_> = lumped.map(|kind| json!({"properties": {"structure": {"required": [kind.name]}}})).collect();
    it.add(json!({
        "if": {"required": ["structure"], "anyOf": lumped},
        "then": scene(true),
        "else": scene(false),
    }));
}

impl SceneReader<'_> {
    fn recipe(&self, at: At<'_>) -> Option<Recipe> {
        let keys = at.keys("the scene")?;
        let vibrating = "The vibrating structure";
        let structure =
            keys.required("structure", vibrating, |at| at.named("structure", vibrating, |at| read_structure(at, self)));
        // What dampers and excitation may say depends on the structure, also on one that has a mistake of its own.
        let named = || at.is_sketch().then_some(self.unknown).or_else(|| kind_named(keys.get("structure")?));
        let Some(kind) = structure.as_ref().map(|structure| structure.kind).or_else(named) else {
            let others =
                ["gravity", "undamped_mass", "mass_measure", "mean_ratio", "dampers", "excitation", "start", "observe"];
            for key in others {
                keys.get(key);
            }
            return keys.close().and(None);
        };
        let gravity = keys.optional("gravity", Slot::Gravity.about(), |at| {
            self.slot(at, Slot::Gravity, kind, |at| at.quantity(Dimension::Acceleration))
        });
        let undamped_mass = keys.optional_where(kind.is_lumped(), "undamped_mass", Slot::UndampedMass.about(), |at| {
            self.reading(at, Slot::UndampedMass, kind)
        });
        let mass_measure =
            keys.optional("mass_measure", Slot::MassMeasure.about(), |at| self.reading(at, Slot::MassMeasure, kind));
        let mean_ratio =
            keys.optional("mean_ratio", Slot::MeanRatio.about(), |at| self.reading(at, Slot::MeanRatio, kind));
        let dampers = keys.optional("dampers", "The dampers", |at| self.dampers(at, kind));
        let excitation = keys.required("excitation", "What drives the structure", |at| self.excitation(at, kind));
        let equilibrium = "Initial conditions; static equilibrium without them";
        let start = keys.optional("start", equilibrium, |at| self.start(at));
        let observe = keys.optional("observe", "Where the motion is observed", |at| self.observe(at, kind));
        keys.close()?;
        Some(Recipe {
            structure: structure?.recipe,
            gravity: gravity?.unwrap_or_else(|| self.left_out(Slot::Gravity, kind, STANDARD_GRAVITY)),
            undamped_mass: undamped_mass?.unwrap_or_else(|| self.left_out(Slot::UndampedMass, kind, Carried::Base)),
            mass_measure: mass_measure?.unwrap_or_else(|| self.left_out(Slot::MassMeasure, kind, Comparison::Jump)),
            mean_ratio: mean_ratio?.unwrap_or_else(|| self.left_out(Slot::MeanRatio, kind, MeanRatio::OfMeans)),
            dampers: dampers?.unwrap_or_default(),
            without_dampers: false,
            excitation: excitation?,
            start: start?,
            observe: observe?.unwrap_or_else(|| self.usual_observation(kind)),
            mode: None,
        })
    }
}

/// The kind of structure that is named, whether its values can be read or not.
fn kind_named(structure: At<'_>) -> Option<&'static Kind> {
    match structure {
        At::Node(Node { value: Value::Mapping(entries), .. }, _) => Kind::named(&entries.first()?.key),
        _ => None,
    }
}
