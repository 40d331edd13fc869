//! The `scene` of an experiment: nodes to a [`Recipe`].

use std::cell::RefCell;
use std::collections::BTreeSet;

use serde::de::DeserializeOwned;
use serde_json::json;

use super::assumed_schema;
use super::assumption_reader::{fits, read_curve};
use super::recipe::{
    ASSUMPTIONS, AssumptionName, AssumptionSheet, Assumptions, Carried, ContactDampingConstant, ContactDampingRatio,
    ContactDampingRecipe, DamperRecipe, Filling, FloorStiffness, GapRecipe, Given, MassReading, MassRecipe, MeanRatio,
    Parameter, Quantity, Recipe, Reference, Slot, StiffnessRecipe, StopRecipe, SurfaceRecipe, SweptSlots, Takes,
    WallRecipe,
};
use super::stated::{names_assumption, names_assumption_value};
use super::structure::read_structure;
use crate::measure::Comparison;
use crate::scene::{KINDS, Kind, STANDARD_GRAVITY};
use crate::yaml::word::{from_word, word_of};
use crate::yaml::{At, Dimension, Findings, Keys, Node, Sketch, Span, Value, parse_number};

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

pub(super) struct SceneReader<'t> {
    pub(super) assumptions: &'t Assumptions,
    /// Stands for the structure that a schema does not know.
    unknown: &'static Kind,
    pub(super) swept: RefCell<Vec<(Parameter, Span)>>,
    optimised: RefCell<Vec<Span>>,
}

pub(super) const AT: &str = "at";

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

    fn dampers(&self, at: At<'_>, kind: &'static Kind) -> Option<Vec<DamperRecipe>> {
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

    fn surface(&self, at: At<'_>, kind: &'static Kind) -> Option<SurfaceRecipe> {
        let forms = [("rigid", "A rigid surface"), ("resilient", "A resilient surface")];
        at.named("surface", "A surface that the particle lands on", |at| {
            at.choose("a surface", &forms, |choice| {
                if choice.name() == "resilient" {
                    return self.resilient(choice.keys("a resilient surface")?, kind);
                }
                let keys = choice.keys("a rigid surface")?;
                let restitution =
                    keys.required("restitution", RESTITUTION, |at| self.given(at, Takes::ratio(), restitution));
                keys.close()?;
                Some(SurfaceRecipe::Rigid { restitution: restitution? })
            })
        })
    }

    fn resilient(&self, keys: Keys<'_>, kind: &'static Kind) -> Option<SurfaceRecipe> {
        let stiffnesses = [
            ("stiffness_ratio", "kf/ks: stiffness over that of the structure"),
            ("stiffness", "Stiffness, or what it is tuned to"),
        ];
        let stiffness = keys.exactly_one(&stiffnesses, |key, at| match key {
            "stiffness" => self.stiffness(at, kind).map(StiffnessRecipe::By),
            _ => self
                .slot(at, Slot::StiffnessRatio, kind, |at| self.swept_ratio(at, Parameter::FloorStiffnessRatio))
                .map(StiffnessRecipe::Ratio),
        });
        let untuned = Slot::UntunedFrequencyRatio;
        let untuned_ratio = keys
            .optional("untuned_frequency_ratio", untuned.about(), |at| self.slot(at, untuned, kind, |at| at.ratio()));
        let dampings = [("damping_ratio", "Damping ratio under the particle"), ("damping", "Damping")];
        let damping = keys.exactly_one(&dampings, |key, at| match key {
            "damping" if at.is_word("equivalent_viscous") => {
                Some(ContactDampingRecipe::Ratio(Given::Stated(ContactDampingRatio::EquivalentViscous)))
            }
            "damping" => {
                let takes =
                    Takes { quantity: Some(Quantity::Of(Dimension::Damping)), readings: &["equivalent_viscous"] };
                let constant = |at: At<'_>| at.quantity(Dimension::Damping).map(ContactDampingConstant::Constant);
                self.given(at, takes, constant).map(ContactDampingRecipe::Damping)
            }
            _ => self
                .slot(at, Slot::DampingRatio, kind, |at| {
                    self.swept_ratio(at, Parameter::ContactDampingRatio).map(ContactDampingRatio::Ratio)
                })
                .map(ContactDampingRecipe::Ratio),
        });
        let damping_curve = keys.optional("damping_curve", Slot::DampingCurve.about(), |at| {
            self.slot(at, Slot::DampingCurve, kind, read_curve)
        });
        let pull = "The surface does not pull at a particle that leaves it";
        let no_tension = keys.optional("no_tension", pull, |at| at.boolean());
        keys.close()?;
        Some(SurfaceRecipe::Resilient {
            stiffness: stiffness?,
            untuned_ratio: untuned_ratio?.or_else(|| self.by_default(untuned, kind)),
            damping: damping?,
            damping_curve: damping_curve?.or_else(|| self.by_default(Slot::DampingCurve, kind)),
            no_tension: no_tension?.unwrap_or(false),
        })
    }

    /// A stiffness, what it is tuned to, an assumption, or swept between `tuned` and `untuned`.
    fn stiffness(&self, at: At<'_>, kind: &'static Kind) -> Option<Given<FloorStiffness>> {
        let tunings = [
            ("tuned", FloorStiffness::Clean),
            ("clean", FloorStiffness::Clean),
            ("loaded", FloorStiffness::Loaded),
            ("untuned", FloorStiffness::Untuned),
        ];
        if let Some((_, tuning)) = tunings.into_iter().find(|(word, _)| at.is_word(word)) {
            return Some(Given::Stated(tuning));
        }
        if self.is_swept(at, Parameter::FloorTuning) {
            return Some(Given::Stated(FloorStiffness::Clean));
        }
        self.slot(at, Slot::Stiffness, kind, |at| at.above_zero(Dimension::Stiffness).map(FloorStiffness::Stiffness))
    }

    fn stop(&self, at: At<'_>, kind: &'static Kind) -> Option<StopRecipe> {
        let rebound = || self.left_out(Slot::StopRestitution, kind, 0.0);
        if at.is_word("assumed") {
            let length = self.slot(at, Slot::StopLength, kind, |_| None)?;
            return Some(StopRecipe { length, restitution: rebound() });
        }
        let keys = at.keys("a limit stop")?;
        let length = keys.required("length", "Length of the limit stop", |at| {
            self.slot(at, Slot::StopLength, kind, |at| {
                self.swept_or(at, Parameter::StopLength, |at| at.above_zero(Dimension::Length))
            })
        });
        let rebounds =
            keys.optional("restitution", RESTITUTION, |at| self.slot(at, Slot::StopRestitution, kind, restitution));
        keys.close()?;
        Some(StopRecipe { length: length?, restitution: rebounds?.unwrap_or_else(rebound) })
    }

    fn walls(&self, at: At<'_>, kind: &'static Kind) -> Option<WallRecipe> {
        let keys = at.keys("a pair of soft walls")?;
        let stiffness_ratio = keys.required("stiffness_ratio", "kw/ks: stiffness over that of the structure", |at| {
            self.sweepable(at, Parameter::WallStiffnessRatio)
        });
        let damping = keys.required("damping", "Damping of the walls", |at| self.quantity(at, Dimension::Damping));
        let mass = keys.optional("ceiling_mass_ratio", "Mass of the ceiling over that of the base", |at| {
            self.slot(at, Slot::CeilingMassRatio, kind, |at| at.ratio())
        });
        keys.close()?;
        Some(WallRecipe {
            stiffness_ratio: stiffness_ratio?,
            damping: damping?,
            ceiling_mass_ratio: mass?.or_else(|| self.by_default(Slot::CeilingMassRatio, kind)),
        })
    }

    /// A dimensionless parameter, `swept`, or an assumption.
    pub(super) fn sweepable(&self, at: At<'_>, parameter: Parameter) -> Option<Given> {
        self.given(at, Takes::ratio(), |at| self.swept_ratio(at, parameter))
    }

    fn swept_ratio(&self, at: At<'_>, parameter: Parameter) -> Option<f64> {
        self.swept_or(at, parameter, |at| at.ratio())
    }

    /// It says `swept`, which is noted.
    pub(super) fn is_swept(&self, at: At<'_>, parameter: Parameter) -> bool {
        let swept = at.is_word("swept");
        if swept {
            self.swept.borrow_mut().push((parameter, at.span()));
        }
        swept
    }

    pub(super) fn swept_or<'n>(
        &self,
        at: At<'n>,
        parameter: Parameter,
        read: impl FnOnce(At<'n>) -> Option<f64>,
    ) -> Option<f64> {
        if self.is_swept(at, parameter) { Some(PLACEHOLDER) } else { read(at) }
    }

    /// A quantity, or an assumption.
    pub(super) fn quantity(&self, at: At<'_>, dimension: Dimension) -> Option<Given> {
        self.given(at, Takes::quantity(dimension), |at| at.quantity(dimension))
    }

    /// A value, or `{assumed: NAME}`.
    pub(super) fn given<'n, T>(
        &self,
        at: At<'n>,
        takes: Takes<'_>,
        read: impl FnOnce(At<'n>) -> Option<T>,
    ) -> Option<Given<T>> {
        match self.assumption(at, takes, || "this key".into()) {
            Some(name) => name.map(Given::Assumed),
            None => read(at).map(Given::Stated),
        }
    }

    /// A value, `{assumed: NAME}`, or `assumed` where the study declares which assumption that is.
    pub(super) fn slot<'n, T>(
        &self,
        at: At<'n>,
        slot: Slot,
        kind: &'static Kind,
        read: impl FnOnce(At<'n>) -> Option<T>,
    ) -> Option<Given<T>> {
        if at.is_word("assumed") {
            return self.by_default(slot, kind).or_else(|| {
                let word = word_of(slot);
                let message = format!("no assumption stands for `{word}` on {}", kind.what);
                let help = format!(
                    "write a value, or `{{assumed: NAME}}`, or declare an assumption under `defaults: {word}` in {ASSUMPTIONS}"
                );
                at.report(message, Some(help))
            });
        }
        match self.assumption(at, slot.takes(), || format!("`{}`", word_of(slot))) {
            Some(name) => name.map(Given::Assumed),
            None => read(at).map(Given::Stated),
        }
    }

    /// One of the named readings of a slot.
    pub(super) fn reading<T: DeserializeOwned>(&self, at: At<'_>, slot: Slot, kind: &'static Kind) -> Option<Given<T>> {
        self.slot(at, slot, kind, |at| one_reading(at, slot))
    }

    /// The assumption that stands for a slot by the study's own declaration.
    pub(super) fn by_default<T>(&self, slot: Slot, kind: &'static Kind) -> Option<Given<T>> {
        self.assumptions.sheet.default_of(slot, kind.name).cloned().map(Given::Assumed)
    }

    /// What stands for a slot that the file leaves out: the study's assumption, or else this.
    pub(super) fn left_out<T>(&self, slot: Slot, kind: &'static Kind, general: T) -> Given<T> {
        self.by_default(slot, kind).unwrap_or(Given::Stated(general))
    }

    /// The assumption that `{assumed: NAME}` names; `None`: it does not say so, `Some(None)`: it names none that fits.
    #[expect(clippy::option_option, reason = "absent and wrong are two things")]
    pub(super) fn assumption(
        &self,
        at: At<'_>,
        takes: Takes<'_>,
        place: impl FnOnce() -> String,
    ) -> Option<Option<AssumptionName>> {
        assumption(&self.assumptions.sheet, at, takes, place)
    }
}

/// The kind of structure that is named, whether its values can be read or not.
fn kind_named(structure: At<'_>) -> Option<&'static Kind> {
    match structure {
        At::Node(Node { value: Value::Mapping(entries), .. }, _) => Kind::named(&entries.first()?.key),
        _ => None,
    }
}

/// The assumption that `{assumed: NAME}` names; `None`: it does not say so, `Some(None)`: it names none that fits.
#[expect(clippy::option_option, reason = "absent and wrong are two things")]
pub(super) fn assumption(
    sheet: &AssumptionSheet,
    at: At<'_>,
    takes: Takes<'_>,
    place: impl FnOnce() -> String,
) -> Option<Option<AssumptionName>> {
    match at {
        At::Node(Node { value: Value::Scalar(word), .. }, _) if word == "assumed" => {
            let help = "write a value, or `{assumed: NAME}`: no default can be declared for it";
            Some(at.report(format!("no assumption stands for {}", place()), Some(help.into())))
        }
        At::Node(node, findings) => names_assumption(node).then(|| named(sheet, node, takes, &place(), findings)),
        At::Sketch(it) => {
            it.add(assumed_schema::assumed(it, sheet, takes));
            None
        }
    }
}

fn named(
    sheet: &AssumptionSheet,
    node: &Node,
    takes: Takes<'_>,
    place: &str,
    findings: &Findings,
) -> Option<AssumptionName> {
    let Value::Mapping(entries) = &node.value else { return None };
    let entry = entries.first()?;
    let name = sheet.named(&entry.node, findings)?;
    fits(sheet, &name, &entry.node, takes, place, findings).then_some(name)
}

const RESTITUTION: &str = "Coefficient of restitution, 0 to 1";

fn restitution(at: At<'_>) -> Option<f64> {
    at.within([0.0, 1.0], "a coefficient of restitution lies between 0 and 1")
}

/// One of the named readings of a slot, without an assumption.
fn one_reading<T: DeserializeOwned>(at: At<'_>, slot: Slot) -> Option<T> {
    let names: Vec<_> = slot.takes().readings.iter().map(|word| (*word, "")).collect();
    at.choose(slot.about(), &names, |choice| {
        choice.bare()?;
        from_word(choice.name())
    })
}
