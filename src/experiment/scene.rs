//! The `scene` of an experiment: nodes to a [`Recipe`].

use std::cell::RefCell;

use super::assumption_reader::{fits, read_curve};
use super::assumption_sheet::{ASSUMPTIONS, Takes};
use super::diagnostic::{Findings, Span};
use super::quantity::{Dimension, parse_number};
use super::reader::{Choice, Fields, above_zero, boolean, list, number, quantity, ratio};
use super::recipe::{
    AssumptionName, Assumptions, Carried, ContactDampingRatio, ContactDampingRecipe, DamperRecipe, Filling,
    FloorStiffness, GapRecipe, Given, MassReading, MassRecipe, Parameter, Part, Recipe, Reference, Slot,
    StiffnessRecipe, StopRecipe, SurfaceRecipe, WallRecipe,
};
use super::structure::read_structure;
use super::word::{from_word, word_of};
use super::yaml::{Node, Value};
use crate::measure::Comparison;
use crate::scene::{KINDS, Kind};
use serde::de::DeserializeOwned;

/// Stands where the file says `swept` until the sweep's first case takes its place.
const PLACEHOLDER: f64 = 1.0;
/// g₀ by convention, m/s²: gravity where neither experiment nor study gives one.
const STANDARD_GRAVITY: f64 = 9.80665;

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
pub(super) fn read_scene(node: &Node, assumptions: &Assumptions, findings: &Findings) -> Option<ReadScene> {
    let reader = SceneReader {
        findings,
        assumptions,
        swept: RefCell::default(),
        optimised: RefCell::default(),
        parts: RefCell::default(),
    };
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
    pub(super) assumptions: &'t Assumptions,
    pub(super) swept: RefCell<Vec<(Parameter, Span)>>,
    optimised: RefCell<Vec<Span>>,
    pub(super) parts: RefCell<Vec<(Part, Span)>>,
}

impl<'t> SceneReader<'t> {
    fn recipe(&self, node: &'t Node) -> Option<Recipe> {
        let fields = Fields::open(node, "the scene", self.findings)?;
        let structure = fields.required("structure", |node| {
            self.parts.borrow_mut().push((Part::Structure, node.span));
            read_structure(node, self)
        });
        // What dampers and excitation may say depends on the structure; one that is wrong is taken for a single mass.
        let kind = structure.as_ref().map_or(KINDS[0], |structure| structure.kind);
        let gravity = fields.optional("gravity", |node| {
            self.slot(node, Slot::Gravity, kind, |node| quantity(node, Dimension::Acceleration, self.findings))
        });
        let undamped_mass = match kind.is_lumped() {
            true => fields.optional("undamped_mass", |node| self.reading(node, Slot::UndampedMass, kind)),
            false => Some(None),
        };
        let mass_measure = fields.optional("mass_measure", |node| self.reading(node, Slot::MassMeasure, kind));
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
            gravity: gravity?.unwrap_or_else(|| self.left_out(Slot::Gravity, kind, STANDARD_GRAVITY)),
            undamped_mass: undamped_mass?.unwrap_or_else(|| self.left_out(Slot::UndampedMass, kind, Carried::Base)),
            mass_measure: mass_measure?.unwrap_or_else(|| self.left_out(Slot::MassMeasure, kind, Comparison::Jump)),
            dampers: dampers?.unwrap_or_default(),
            without_dampers: false,
            excitation: excitation?,
            start: start?,
            observe: observe?.unwrap_or_else(|| self.usual_observation(kind)),
            mode: None,
        })
    }

    fn dampers(&self, node: &'t Node, kind: &'static Kind) -> Option<Vec<DamperRecipe>> {
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

    fn damper(&self, node: &'t Node, kind: &'static Kind) -> Option<DamperRecipe> {
        let fields = Fields::open(node, "a damper", self.findings)?;
        let at = self.at(&fields, kind, [Parameter::DamperX, Parameter::DamperY]);
        let array = if kind.is_lumped() { Some(None) } else { fields.optional("array", |node| self.array(node, kind)) };
        let mass = fields.exactly_one(&["mass_ratio", "mass"]).and_then(|(key, node)| match key {
            "mass" => self.quantity(node, Dimension::Mass).map(MassRecipe::Mass),
            _ => self.sweepable(node, Parameter::MassRatio).map(MassRecipe::Ratio),
        });
        let share = |node: &'t Node| self.sweepable(node, Parameter::ParticleShare);
        // One mass has one mode and no enclosure unless the file names one; on a beam or plate there always is one.
        let lumped = kind.is_lumped();
        let massless_ratio = match lumped {
            true => fields.optional("massless_ratio", |node| {
                self.slot(node, Slot::MasslessRatio, kind, |node| ratio(node, self.findings))
            }),
            false => Some(None),
        };
        let (mass_reading, gap_frequency, particle_share) = if lumped {
            let share = fields.optional("particle_share", share);
            (Some(None), Some(None), share.map(|share| share.unwrap_or(Given::Stated(1.0))))
        } else {
            (
                fields.optional("mass_reading", |node| self.mass_reading(node, kind)),
                fields.optional("gap_frequency", |node| self.reading(node, Slot::GapFrequency, kind)),
                fields.required("particle_share", share),
            )
        };
        let gap = fields.exactly_one(&["gap_ratio", "gap"]).and_then(|(key, node)| match key {
            _ if is_word(node, "infinite") => Some(GapRecipe::Infinite),
            _ if is_word(node, "optimised") => {
                self.optimised.borrow_mut().push(node.span);
                Some(GapRecipe::Gap(Given::Stated(PLACEHOLDER)))
            }
            "gap" if names_assumption(node) => self.quantity(node, Dimension::Length).map(GapRecipe::Gap),
            "gap" if matches!(node.value, Value::Mapping(_)) => self.filled(node),
            "gap" if matches!(node.value, Value::Sequence(_)) => {
                list(node, self.findings, |node| quantity(node, Dimension::Length, self.findings)).map(GapRecipe::Gaps)
            }
            _ if matches!(node.value, Value::Sequence(_)) => {
                list(node, self.findings, |node| ratio(node, self.findings)).map(GapRecipe::Ratios)
            }
            "gap" => self.quantity(node, Dimension::Length).map(GapRecipe::Gap),
            _ => self.sweepable(node, Parameter::GapRatio).map(GapRecipe::Ratio),
        });
        let floor = fields.required("floor", |node| self.surface(node, kind));
        let ceiling = fields.optional("ceiling", |node| self.surface(node, kind));
        let stop = fields.optional("stop", |node| self.stop(node, kind));
        let walls = fields.optional("walls", |node| self.walls(node, kind));
        fields.close()?;
        let floor = floor?;
        let ceiling = ceiling?.unwrap_or_else(|| floor.clone());
        Some(DamperRecipe {
            at: at?,
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
        })
    }

    /// An array filled in one of two ways, which a sweep chooses.
    fn filled(&self, node: &'t Node) -> Option<GapRecipe> {
        let fields = Fields::open(node, "a filling", self.findings)?;
        let length = |node: &'t Node| quantity(node, Dimension::Length, self.findings);
        let uniform = fields.required("uniform", |node| self.quantity(node, Dimension::Length));
        let optimised = fields.required("optimised", |node| list(node, self.findings, length));
        self.swept.borrow_mut().push((Parameter::Filling, node.span));
        fields.close()?;
        Some(GapRecipe::Filled { uniform: uniform?, optimised: optimised?, filling: Filling::Uniform })
    }

    /// `total`, `modal` or a share, an assumption, or swept.
    fn mass_reading(&self, node: &'t Node, kind: &'static Kind) -> Option<Given<MassReading>> {
        if is_word(node, "swept") {
            self.swept.borrow_mut().push((Parameter::MassReading, node.span));
            return Some(Given::Stated(MassReading::Total));
        }
        let share = |node: &'t Node| ratio(node, self.findings).map(MassReading::Share);
        self.slot(node, Slot::MassReading, kind, |node| match &node.value {
            Value::Scalar(text) if parse_number(text).is_ok() => share(node),
            _ => from_word(
                Choice::read(node, Slot::MassReading.about(), Slot::MassReading.takes().readings, self.findings)?
                    .bare(self.findings)?,
            ),
        })
    }

    fn surface(&self, node: &'t Node, kind: &'static Kind) -> Option<SurfaceRecipe> {
        let choice = Choice::read(node, "a surface", &["rigid", "resilient"], self.findings)?;
        if choice.name == "rigid" {
            let fields = choice.fields("a rigid surface", self.findings)?;
            let restitution =
                fields.required("restitution", |node| self.given(node, Takes::ratio(), |node| self.restitution(node)));
            fields.close()?;
            return Some(SurfaceRecipe::Rigid { restitution: restitution? });
        }
        let fields = choice.fields("a resilient surface", self.findings)?;
        let stiffness = fields.exactly_one(&["stiffness_ratio", "stiffness"]).and_then(|(key, node)| match key {
            "stiffness" => self.stiffness(node, kind).map(StiffnessRecipe::By),
            _ => self
                .slot(node, Slot::StiffnessRatio, kind, |node| self.swept_ratio(node, Parameter::FloorStiffnessRatio))
                .map(StiffnessRecipe::Ratio),
        });
        let untuned_ratio = fields.optional("untuned_frequency_ratio", |node| {
            self.slot(node, Slot::UntunedFrequencyRatio, kind, |node| ratio(node, self.findings))
        });
        let damping = fields.exactly_one(&["damping_ratio", "damping"]).and_then(|(key, node)| match key {
            "damping" if is_word(node, "equivalent_viscous") => {
                Some(ContactDampingRecipe::Ratio(Given::Stated(ContactDampingRatio::EquivalentViscous)))
            }
            "damping" => self.quantity(node, Dimension::Damping).map(ContactDampingRecipe::Damping),
            _ => self
                .slot(node, Slot::DampingRatio, kind, |node| {
                    self.swept_ratio(node, Parameter::ContactDampingRatio).map(ContactDampingRatio::Ratio)
                })
                .map(ContactDampingRecipe::Ratio),
        });
        let damping_curve = fields.optional("damping_curve", |node| {
            self.slot(node, Slot::DampingCurve, kind, |node| read_curve(node, self.findings))
        });
        let no_tension = fields.optional("no_tension", |node| boolean(node, self.findings));
        fields.close()?;
        Some(SurfaceRecipe::Resilient {
            stiffness: stiffness?,
            untuned_ratio: untuned_ratio?.or_else(|| self.by_default(Slot::UntunedFrequencyRatio, kind)),
            damping: damping?,
            damping_curve: damping_curve?.or_else(|| self.by_default(Slot::DampingCurve, kind)),
            no_tension: no_tension?.unwrap_or(false),
        })
    }

    /// A stiffness, what it is tuned to, an assumption, or swept between `tuned` and `untuned`.
    fn stiffness(&self, node: &'t Node, kind: &'static Kind) -> Option<Given<FloorStiffness>> {
        let tunings = [
            ("tuned", FloorStiffness::Clean),
            ("clean", FloorStiffness::Clean),
            ("loaded", FloorStiffness::Loaded),
            ("untuned", FloorStiffness::Untuned),
        ];
        if let Some((_, tuning)) = tunings.into_iter().find(|(word, _)| is_word(node, word)) {
            return Some(Given::Stated(tuning));
        }
        if is_word(node, "swept") {
            self.swept.borrow_mut().push((Parameter::FloorTuning, node.span));
            return Some(Given::Stated(FloorStiffness::Clean));
        }
        self.slot(node, Slot::Stiffness, kind, |node| {
            above_zero(node, Dimension::Stiffness, self.findings).map(FloorStiffness::Stiffness)
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

    fn stop(&self, node: &'t Node, kind: &'static Kind) -> Option<StopRecipe> {
        let rebound = || self.left_out(Slot::StopRestitution, kind, 0.0);
        if is_word(node, "assumed") {
            let length = self.slot(node, Slot::StopLength, kind, |_| None)?;
            return Some(StopRecipe { length, restitution: rebound() });
        }
        let fields = Fields::open(node, "a limit stop", self.findings)?;
        let length = fields.required("length", |node| {
            self.slot(node, Slot::StopLength, kind, |node| {
                self.swept_or(node, Parameter::StopLength, |node| above_zero(node, Dimension::Length, self.findings))
            })
        });
        let restitution = fields.optional("restitution", |node| {
            self.slot(node, Slot::StopRestitution, kind, |node| self.restitution(node))
        });
        fields.close()?;
        Some(StopRecipe { length: length?, restitution: restitution?.unwrap_or_else(rebound) })
    }

    fn walls(&self, node: &'t Node, kind: &'static Kind) -> Option<WallRecipe> {
        let fields = Fields::open(node, "a pair of soft walls", self.findings)?;
        let stiffness_ratio =
            fields.required("stiffness_ratio", |node| self.sweepable(node, Parameter::WallStiffnessRatio));
        let damping = fields.required("damping", |node| self.quantity(node, Dimension::Damping));
        let mass = fields.optional("ceiling_mass_ratio", |node| {
            self.slot(node, Slot::CeilingMassRatio, kind, |node| ratio(node, self.findings))
        });
        fields.close()?;
        Some(WallRecipe {
            stiffness_ratio: stiffness_ratio?,
            damping: damping?,
            ceiling_mass_ratio: mass?.or_else(|| self.by_default(Slot::CeilingMassRatio, kind)),
        })
    }

    /// A dimensionless parameter, `swept`, or an assumption.
    pub(super) fn sweepable(&self, node: &'t Node, parameter: Parameter) -> Option<Given> {
        self.given(node, Takes::ratio(), |node| self.swept_ratio(node, parameter))
    }

    fn swept_ratio(&self, node: &'t Node, parameter: Parameter) -> Option<f64> {
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

    /// A quantity, or an assumption.
    pub(super) fn quantity(&self, node: &'t Node, dimension: Dimension) -> Option<Given> {
        self.given(node, Takes::quantity(dimension), |node| quantity(node, dimension, self.findings))
    }

    /// A value, or `{assumed: NAME}`.
    pub(super) fn given<T>(
        &self,
        node: &'t Node,
        takes: Takes<'_>,
        read: impl FnOnce(&'t Node) -> Option<T>,
    ) -> Option<Given<T>> {
        if names_assumption(node) {
            return self.named(node, takes, "this key").map(Given::Assumed);
        }
        read(node).map(Given::Stated)
    }

    /// A value, `{assumed: NAME}`, or `assumed` where the study declares which assumption that is.
    pub(super) fn slot<T>(
        &self,
        node: &'t Node,
        slot: Slot,
        kind: &'static Kind,
        read: impl FnOnce(&'t Node) -> Option<T>,
    ) -> Option<Given<T>> {
        let word = word_of(slot);
        if is_word(node, "assumed") {
            return self.by_default(slot, kind).or_else(|| {
                let message = format!("no assumption stands for `{word}` on {}", kind.what);
                let help =
                    format!("write `{{assumed: NAME}}`, or declare one under `defaults: {word}` in {ASSUMPTIONS}");
                self.findings.report(node.span, message, Some(help))
            });
        }
        if names_assumption(node) {
            return self.named(node, slot.takes(), &format!("`{word}`")).map(Given::Assumed);
        }
        read(node).map(Given::Stated)
    }

    /// One of the named readings of a slot.
    pub(super) fn reading<T: DeserializeOwned>(
        &self,
        node: &'t Node,
        slot: Slot,
        kind: &'static Kind,
    ) -> Option<Given<T>> {
        self.slot(node, slot, kind, |node| {
            let choice = Choice::read(node, slot.about(), slot.takes().readings, self.findings)?;
            from_word(choice.bare(self.findings)?)
        })
    }

    /// The assumption that stands for a slot by the study's own declaration.
    pub(super) fn by_default<T>(&self, slot: Slot, kind: &'static Kind) -> Option<Given<T>> {
        self.assumptions.sheet.default_of(slot, kind.name).cloned().map(Given::Assumed)
    }

    /// What stands for a slot that the file leaves out: the study's assumption, or else this.
    pub(super) fn left_out<T>(&self, slot: Slot, kind: &'static Kind, general: T) -> Given<T> {
        self.by_default(slot, kind).unwrap_or(Given::Stated(general))
    }

    /// The assumption that `{assumed: NAME}` names, if it is one that fits.
    pub(super) fn named(&self, node: &'t Node, takes: Takes<'_>, place: &str) -> Option<AssumptionName> {
        let Value::Mapping(entries) = &node.value else { return None };
        let entry = entries.first()?;
        let sheet = &self.assumptions.sheet;
        let name = sheet.named(&entry.node, self.findings)?;
        fits(sheet, &name, &entry.node, takes, place, self.findings).then_some(name)
    }
}

/// It says `{assumed: …}`.
pub(super) fn names_assumption(node: &Node) -> bool {
    matches!(&node.value, Value::Mapping(entries) if matches!(entries.as_slice(), [entry] if entry.key == "assumed"))
}

pub(super) fn is_word(node: &Node, word: &str) -> bool {
    matches!(&node.value, Value::Scalar(text) if text == word)
}
