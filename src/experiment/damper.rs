//! The dampers of a scene.

use std::collections::BTreeSet;

use serde_json::json;

use super::recipe::{
    DamperRecipe, Filling, GapRecipe, Given, MassReading, MassRecipe, Parameter, Reference, Slot, SurfaceRecipe,
    SweptSlots,
};
use super::scene_reader::{PLACEHOLDER, SceneReader, one_reading};
use super::stated::names_assumption_value;
use crate::scene::Kind;
use crate::yaml::{At, Dimension, Node, Value, parse_number};

/// Most dampers that a file may name.
pub(super) const MOST_DAMPERS: usize = 64;

impl SceneReader<'_> {
    pub(super) fn dampers(&self, at: At<'_>, kind: &'static Kind) -> Option<Vec<DamperRecipe>> {
        let name = if kind.is_lumped() { "damper" } else { "damper_at_place" };
        let damper = |at: At<'_>| at.named(name, "A particle impact damper", |at| self.damper(at, kind));
        match at {
            At::Node(Node { value: Value::Sequence(items), .. }, _) => {
                if items.is_empty() {
                    return Some(Vec::new());
                }
                if items.len() > MOST_DAMPERS {
                    return at.wrong(format!("{} dampers: {MOST_DAMPERS} at most", items.len()));
                }
                at.list(damper)
            }
            At::Node(..) => at.list(damper),
            At::Sketch(it) => {
                let item = it.part(it.about(), damper);
                it.add(json!({"description": it.about(), "type": "array", "items": item, "maxItems": MOST_DAMPERS}));
                None
            }
        }
    }

    fn damper(&self, at: At<'_>, kind: &'static Kind) -> Option<DamperRecipe> {
        let keys = at.keys("a damper")?;
        let first = self.swept.borrow().len();
        // One mass has one mode and no enclosure unless the file names one; on a beam or plate there always is one.
        let lumped = kind.is_lumped();
        let place = self.at(&keys, kind, [Parameter::DamperX, Parameter::DamperY]);
        let array = keys.optional_where(!lumped, "array", "Dampers side by side", |at| self.array(at, kind));
        let masses =
            [("mass_ratio", "m′: mass of the damper over that of the structure"), ("mass", "Mass of the damper")];
        let mass = keys.exactly_one(&masses, |key, at| match key {
            "mass" if self.is_swept(at, Parameter::Mass) => Some(MassRecipe::Mass(Given::Stated(PLACEHOLDER))),
            "mass" => self.quantity(at, Dimension::Mass).map(MassRecipe::Mass),
            _ => self.sweepable(at, Parameter::MassRatio).map(MassRecipe::Ratio),
        });
        let of_massless = Slot::MasslessRatio.about();
        let massless_ratio = keys.optional_where(lumped, "massless_ratio", of_massless, |at| {
            self.slot(at, Slot::MasslessRatio, kind, |at| at.ratio())
        });
        let mass_reading =
            keys.optional_where(!lumped, "mass_reading", Slot::MassReading.about(), |at| self.mass_reading(at, kind));
        let gap_frequency = keys.optional_where(!lumped, "gap_frequency", Slot::GapFrequency.about(), |at| {
            self.reading(at, Slot::GapFrequency, kind)
        });
        let share = |at: At<'_>| self.sweepable(at, Parameter::ParticleShare);
        let (key, of_share) = ("particle_share", "Particle over the whole damper, mass");
        let particle_share = if lumped {
            keys.optional(key, of_share, share).map(|share| share.unwrap_or(Given::Stated(1.0)))
        } else {
            keys.required(key, of_share, share)
        };
        let gaps = [
            ("gap_ratio", "h′ = h ωn²/g: dimensionless gap clearance"),
            ("gap", "Gap clearance between floor and ceiling"),
        ];
        let gap = keys.exactly_one(&gaps, |key, at| self.gap(key, at));
        let surface = |at: At<'_>| {
            let first = self.swept.borrow().len();
            Some((self.surface(at, kind)?, self.swept_since(first)))
        };
        let floor = keys.required("floor", "The surface that the particle lands on", surface);
        let ceiling = keys.optional("ceiling", "The surface above; like the floor unless stated", surface);
        let stop = keys.optional("stop", "A limit stop", |at| self.stop(at, kind));
        let walls = keys.optional("walls", "Soft walls", |at| self.walls(at, kind));
        let is_rigid = |(surface, _): &(SurfaceRecipe, _)| matches!(surface, SurfaceRecipe::Rigid { .. });
        let are_rigid = floor.as_ref().is_some_and(is_rigid)
            && ceiling.as_ref().is_some_and(|ceiling| ceiling.as_ref().is_none_or(is_rigid));
        if are_rigid && matches!(stop, Some(Some(_))) {
            let message = "a limit stop ends the compression of a resilient face, and both faces are rigid";
            return keys.get("stop")?.wrong(message);
        }
        let rigid = json!({"required": ["rigid"]});
        keys.rule(|| json!({"not": {"required": ["stop"], "properties": {"floor": rigid, "ceiling": rigid}}}));
        keys.close()?;
        let (floor, floor_swept) = floor?;
        let (ceiling, ceiling_swept) = ceiling?.unwrap_or_else(|| (floor.clone(), floor_swept.clone()));
        let swept = SweptSlots { all: self.swept_since(first), floor: floor_swept, ceiling: ceiling_swept };
        Some(DamperRecipe {
            at: place?,
            array: array?,
            mass: mass?,
            mass_reading: mass_reading?.unwrap_or_else(|| self.left_out(Slot::MassReading, kind, MassReading::Total)),
            massless_ratio: massless_ratio?.or_else(|| self.by_default(Slot::MasslessRatio, kind)),
            particle_share: particle_share?,
            gap: gap?,
            gap_frequency: gap_frequency?.unwrap_or_else(|| self.left_out(Slot::GapFrequency, kind, Reference::Clean)),
            floor,
            ceiling,
            stop: stop?,
            walls: walls?,
            swept,
        })
    }

    /// What has been left to a sweep since so many slots were.
    fn swept_since(&self, first: usize) -> BTreeSet<Parameter> {
        self.swept.borrow()[first..].iter().map(|(parameter, _)| *parameter).collect()
    }

    fn gap(&self, key: &str, at: At<'_>) -> Option<GapRecipe> {
        if at.is_word("infinite") {
            return Some(GapRecipe::Infinite);
        }
        if at.is_word("optimised") {
            self.optimised.borrow_mut().push(at.span());
            return Some(GapRecipe::Gap(Given::Stated(PLACEHOLDER)));
        }
        if key == "gap" && self.is_swept(at, Parameter::Gap) {
            return Some(GapRecipe::Gap(Given::Stated(PLACEHOLDER)));
        }
        let is_endless = |value: &Value| matches!(value, Value::Scalar(text) if text == "infinite");
        if key == "gap" && matches!(at, At::Node(node, _) if is_endless(&node.value)) {
            return at.report("`infinite` is no length", Some("write `gap_ratio: infinite`".into()));
        }
        let is_list = |value: &Value| matches!(value, Value::Sequence(_));
        if key != "gap" {
            let each = |at: At<'_>| at.list(|at| at.ratio()).map(GapRecipe::Ratios);
            return at.either(is_list, each, |at| self.sweepable(at, Parameter::GapRatio).map(GapRecipe::Ratio));
        }
        let each = |at: At<'_>| at.list(|at| at.quantity(Dimension::Length)).map(GapRecipe::Gaps);
        let is_filling = |value: &Value| matches!(value, Value::Mapping(_)) && !names_assumption_value(value);
        at.either(
            is_filling,
            |at| self.filled(at),
            |at| at.either(is_list, each, |at| self.quantity(at, Dimension::Length).map(GapRecipe::Gap)),
        )
    }

    /// An array filled in one of two ways, which a sweep chooses.
    fn filled(&self, at: At<'_>) -> Option<GapRecipe> {
        let keys = at.keys("a filling")?;
        let uniform = keys.required("uniform", "The gap of all", |at| self.quantity(at, Dimension::Length));
        let optimised =
            keys.required("optimised", "Gaps, one a damper", |at| at.list(|at| at.quantity(Dimension::Length)));
        self.swept.borrow_mut().push((Parameter::Filling, at.span()));
        keys.close()?;
        Some(GapRecipe::Filled { uniform: uniform?, optimised: optimised?, filling: Filling::Uniform })
    }

    /// `total`, `modal` or a share, an assumption, or swept.
    fn mass_reading(&self, at: At<'_>, kind: &'static Kind) -> Option<Given<MassReading>> {
        if self.is_swept(at, Parameter::MassReading) {
            return Some(Given::Stated(MassReading::Total));
        }
        let share = |at: At<'_>| at.called("A share of the structure's mass", |at| at.ratio()).map(MassReading::Share);
        let is_number = |value: &Value| matches!(value, Value::Scalar(text) if parse_number(text).is_ok());
        self.slot(at, Slot::MassReading, kind, |at| {
            at.either(is_number, share, |at| one_reading(at, Slot::MassReading))
        })
    }
}
