//! The `scene` of an experiment: nodes to a [`Recipe`].

use std::cell::RefCell;

use crate::scene::{
    ArrayRecipe, Assumption, ContactDampingRecipe, Coordinate, DamperRecipe, ExcitationKind, ExcitationRecipe, Family,
    GapRecipe, Given, ImpulseTime, KINDS, Kind, MassReading, MassRecipe, ObserveRecipe, Parameter, Part, PlaceRecipe,
    PointsRecipe, PulseShape, Recipe, StiffnessRecipe, StopRecipe, StrengthRecipe, SurfaceRecipe, Take, TimingRecipe,
    WallRecipe,
};

use super::diagnostic::{Findings, Span};
use super::quantity::Dimension;
use super::reader::{Choice, Fields, above_zero, boolean, count, list, number, one_or_more, quantity, ratio};
use super::structure::read_structure;
use super::yaml::{Node, Value};

/// Stands where the file says `swept` until the sweep's first case takes its place.
const PLACEHOLDER: f64 = 1.0;

/// Most dampers that a file may name.
const MOST_DAMPERS: usize = 64;

/// A scene as read, and where it says `swept`.
pub(super) struct ReadScene {
    pub recipe: Recipe,
    pub swept: Vec<(Parameter, Span)>,
    /// Where each part stands.
    pub parts: Vec<(Part, Span)>,
}

/// Reads the node under `scene`.
pub(super) fn read_scene(node: &Node, findings: &Findings) -> Option<ReadScene> {
    let reader = SceneReader { findings, swept: RefCell::default(), parts: RefCell::default() };
    let recipe = reader.recipe(node)?;
    Some(ReadScene { recipe, swept: reader.swept.into_inner(), parts: reader.parts.into_inner() })
}

struct SceneReader<'t> {
    findings: &'t Findings,
    swept: RefCell<Vec<(Parameter, Span)>>,
    parts: RefCell<Vec<(Part, Span)>>,
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
            observe: observe?.unwrap_or_default(),
            mode: None,
        })
    }

    /// One coordinate a side; `along` are the parameters that may stand for them.
    fn place(&self, node: &'t Node, kind: &Kind, along: [Parameter; 2]) -> Option<PlaceRecipe> {
        let coordinate = |node: &'t Node, parameter: Parameter| {
            if is_word(node, "swept") {
                self.swept.borrow_mut().push((parameter, node.span));
                return Some(Coordinate::Share(0.5));
            }
            self.coordinate(node)
        };
        if kind.sides.len() < 2 {
            return Some(PlaceRecipe(vec![coordinate(node, along[0])?]));
        }
        match &node.value {
            Value::Sequence(items) if items.len() == 2 => {
                let (x, y) = (coordinate(&items[0], along[0]), coordinate(&items[1], along[1]));
                Some(PlaceRecipe(vec![x?, y?]))
            }
            _ => self.findings.report(
                node.span,
                format!("a place on {} is two coordinates", kind.what),
                Some("write [0.25, 0.5], or lengths with units".into()),
            ),
        }
    }

    /// `0.25`, a share of the side, or `20 cm`.
    fn coordinate(&self, node: &'t Node) -> Option<Coordinate> {
        let with_unit =
            matches!(&node.value, Value::Scalar(text) if text.trim_end().ends_with(|c: char| c.is_alphabetic()));
        if with_unit {
            return quantity(node, Dimension::Length, self.findings).map(Coordinate::Length);
        }
        let share = number(node, self.findings)?;
        if (0.0..=1.0).contains(&share) {
            return Some(Coordinate::Share(share));
        }
        self.findings.report(
            node.span,
            format!("{share} is a place outside the structure: a number without unit is a share of the side, 0 to 1"),
            Some("write for example 0.5, or 20 cm".into()),
        )
    }

    /// The place under `at`: there must be one, except on a single mass, where there must be none.
    fn at(&self, fields: &Fields<'t>, kind: &Kind, along: [Parameter; 2]) -> Option<PlaceRecipe> {
        if kind.sides.is_empty() {
            return Some(PlaceRecipe::default());
        }
        fields.required("at", |node| self.place(node, kind, along))
    }

    fn observe(&self, node: &'t Node, kind: &Kind) -> Option<ObserveRecipe> {
        // Observed points are not swept.
        let point = |node: &'t Node| match node.value {
            _ if is_word(node, "swept") => self.findings.wrong(node.span, "observed points cannot be swept"),
            _ => self.place(node, kind, [Parameter::DamperX, Parameter::DamperY]),
        };
        let Value::Mapping(entries) = &node.value else {
            return Some(ObserveRecipe { points: PointsRecipe::Points(vec![point(node)?]), take: Some(Take::Largest) });
        };
        if entries.iter().any(|entry| entry.key == "points") {
            let fields = Fields::open(node, "what is observed", self.findings)?;
            let points = fields.required("points", |node| list(node, self.findings, point));
            let take = fields.optional("take", |node| self.take(node));
            fields.close()?;
            return Some(ObserveRecipe { points: PointsRecipe::Points(points?), take: take?.flatten() });
        }
        let choice = Choice::read(node, "what is observed", &["nine_point_grid"], self.findings)?;
        let take = match choice.content {
            Some(node) => self.take(node)?,
            None => None,
        };
        Some(ObserveRecipe { points: PointsRecipe::NinePointGrid, take })
    }

    /// `largest`, `mean`, or `assumed`.
    #[expect(clippy::option_option, reason = "assumed and wrong are two things")]
    fn take(&self, node: &'t Node) -> Option<Option<Take>> {
        let names = ["largest", "mean", "assumed"];
        let choice = Choice::read(node, "what is taken of several points", &names, self.findings)?;
        Some(match choice.bare(self.findings)? {
            "largest" => Some(Take::Largest),
            "mean" => Some(Take::Mean),
            _ => None,
        })
    }

    fn array(&self, node: &'t Node, kind: &Kind) -> Option<ArrayRecipe> {
        let fields = Fields::open(node, "an array of dampers", self.findings)?;
        let most = MOST_DAMPERS as u32;
        let count = fields.required("count", |node| {
            if is_word(node, "swept") {
                self.swept.borrow_mut().push((Parameter::DamperCount, node.span));
                return Some(vec![1]);
            }
            one_or_more(node, self.findings, |node| match count(node, "dampers", most, self.findings)? {
                0 => self.findings.wrong(node.span, "an array has one damper at least"),
                count => Some(count),
            })
        });
        let spacing = fields.required("spacing", |node| {
            one_or_more(node, self.findings, |node| quantity(node, Dimension::Length, self.findings))
        });
        let centred = fields.optional("centred", |node| boolean(node, self.findings));
        fields.close()?;
        // A plate's array lies around its place, a beam's begins there.
        let usual = kind.sides.len() > 1;
        Some(ArrayRecipe { count: count?, spacing: spacing?, centred: centred?.unwrap_or(usual) })
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

    /// `assumed`, or a reading, which a sweep may vary.
    fn mass_reading(&self, node: &'t Node) -> Option<MassReading> {
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

    fn excitation(&self, node: &'t Node, kind: &Kind) -> Option<ExcitationRecipe> {
        let names = ["single_impulse", "impulse_train", "harmonic", "pulse_train", "none"];
        let choice = Choice::read(node, "the excitation", &names, self.findings)?;
        if choice.name == "none" {
            return choice.bare(self.findings).map(|_| ExcitationRecipe::silent());
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
            "impulse" => self
                .swept_or(node, Parameter::Impulse, |node| quantity(node, Dimension::Impulse, self.findings))
                .map(StrengthRecipe::Impulse),
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
