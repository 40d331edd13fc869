//! What all parts of a scene are read with: a value stands there itself, or an assumption in its place, or it is left to the sweep.

use std::cell::RefCell;

use serde::de::DeserializeOwned;

use super::assumed_schema;
use super::assumption_reader::fits;
use super::recipe::{ASSUMPTIONS, AssumptionName, AssumptionSheet, Assumptions, Given, Parameter, Slot, Takes};
use super::stated::names_assumption;
use crate::scene::Kind;
use crate::yaml::word::{from_word, word_of};
use crate::yaml::{At, Dimension, Findings, Node, Span, Value};

/// Stands where the file says `swept` until the sweep's first case takes its place.
pub(super) const PLACEHOLDER: f64 = 1.0;

/// Reads the parts of one scene.
pub(super) struct SceneReader<'t> {
    pub(super) assumptions: &'t Assumptions,
    /// Stands for the structure that a schema does not know.
    pub(super) unknown: &'static Kind,
    /// Where it says `swept`.
    pub(super) swept: RefCell<Vec<(Parameter, Span)>>,
    /// Where it says that a gap is optimised.
    pub(super) optimised: RefCell<Vec<Span>>,
}

pub(super) const AT: &str = "at";

impl SceneReader<'_> {
    /// A dimensionless parameter, `swept`, or an assumption.
    pub(super) fn sweepable(&self, at: At<'_>, parameter: Parameter) -> Option<Given> {
        self.given(at, Takes::ratio(), |at| self.swept_ratio(at, parameter))
    }

    pub(super) fn swept_ratio(&self, at: At<'_>, parameter: Parameter) -> Option<f64> {
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

/// One of the named readings of a slot, without an assumption.
pub(super) fn one_reading<T: DeserializeOwned>(at: At<'_>, slot: Slot) -> Option<T> {
    let names: Vec<_> = slot.takes().readings.iter().map(|word| (*word, "")).collect();
    at.choose(slot.about(), &names, |choice| {
        choice.bare()?;
        from_word(choice.name())
    })
}
