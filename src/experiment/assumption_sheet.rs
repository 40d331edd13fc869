//! The assumptions file: each input that the study uses and does not state, with value, reason and range.
//!
//! The range is what a reader may believe as well; moving one assumption at a time to its ends gives the sensitivity of
//! every number to what is not known.

use std::collections::{BTreeMap, BTreeSet};

use serde::{Deserialize, Serialize};

use crate::scene::{Assumption, AssumptionValue, Assumptions, EQUIVALENT_VISCOUS, ImpulseTime};

use super::diagnostic::{Findings, Problems};
use super::quantity::Dimension;
use super::reader::{Fields, above_zero, count, list, no_such, number, ratio, scalar, text, unknown};
use super::word::{from_word, word_of, words};
use super::yaml::{Entry, Node, Value, read_tree};

/// The assumptions with all that the file says of them.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct AssumptionSheet {
    /// Entries by name.
    pub entries: BTreeMap<Assumption, AssumptionEntry>,
}

/// One assumption.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct AssumptionEntry {
    /// The value in force.
    pub value: AssumptionValue,
    /// Why this value. Markdown.
    pub reason: String,
    /// Other values that could be defended: the ends of an interval, or the other readings. May be empty.
    pub range: Vec<AssumptionValue>,
    /// Ids of the reference entries that the value was chosen by: their agreement proves nothing.
    pub fitted_to: Vec<String>,
}

impl AssumptionSheet {
    /// The values in force.
    #[must_use]
    pub fn assumptions(&self) -> Assumptions {
        Assumptions { values: self.entries.iter().map(|(name, entry)| (*name, entry.value.clone())).collect() }
    }

    /// One assumption at a time moved to each value of its range, with a label such as `stop_length=0.05`.
    #[must_use]
    pub fn variants(&self, of: &BTreeSet<Assumption>) -> Vec<(String, Assumptions)> {
        let mut variants = Vec::new();
        for (name, entry) in self.entries.iter().filter(|(name, _)| of.contains(name)) {
            for (index, value) in entry.range.iter().filter(|value| **value != entry.value).enumerate() {
                let description = match value {
                    AssumptionValue::Number(number) => number.to_string(),
                    AssumptionValue::Choice(word) => word.clone(),
                    AssumptionValue::Curve(_) => format!("curve_{}", index + 1),
                };
                let mut moved = self.assumptions();
                moved.values.insert(*name, value.clone());
                variants.push((format!("{}={description}", word_of(*name)), moved));
            }
        }
        variants
    }
}

/// What values an assumption takes.
#[derive(Clone, Copy)]
pub(super) enum Kind {
    Quantity(Dimension),
    Ratio,
    /// A damping ratio of contacts, or the equivalent damping curve in its place.
    ContactDamping,
    Restitution,
    Choice(&'static [&'static str]),
    /// A number of modes.
    Modes,
    /// A quantity, or one of these readings.
    QuantityOr(Dimension, &'static [&'static str]),
    Curve,
}

/// Readings of the time by which a force ratio becomes an impulse.
const IMPULSE_TIMES: [&str; ImpulseTime::WORDS.len()] = {
    let [(a, _), (b, _), (c, _)] = ImpulseTime::WORDS;
    [a, b, c]
};

pub(super) fn kind(name: Assumption) -> Kind {
    match name {
        Assumption::Gravity => Kind::Quantity(Dimension::Acceleration),
        Assumption::StopLength => Kind::Quantity(Dimension::Length),
        Assumption::StopRestitution => Kind::Restitution,
        Assumption::ImpulseFactor
        | Assumption::FloorStiffnessRatio
        | Assumption::CeilingMassRatio
        | Assumption::MasslessRatio
        | Assumption::UntunedFrequencyRatio => Kind::Ratio,
        Assumption::ContactDampingRatio
        | Assumption::BeamContactDampingRatio
        | Assumption::BeamArrayDampingRatio
        | Assumption::PlateArrayDampingRatio
        | Assumption::PlateContactDampingRatio => Kind::ContactDamping,
        Assumption::ImpulseFrequency => Kind::Choice(&["forcing", "natural"]),
        Assumption::UndampedMass | Assumption::HarmonicReference | Assumption::ImpulseReference => {
            Kind::Choice(&["base", "loaded"])
        }
        Assumption::EquivalentDampingCurve => Kind::Curve,
        Assumption::BeamModes | Assumption::PlateModes => Kind::Modes,
        Assumption::BeamDamperMass | Assumption::PlateDamperMass | Assumption::ArrayDamperMass => {
            Kind::Choice(&["total", "modal"])
        }
        Assumption::BeamGapFrequency | Assumption::PlateGapFrequency => Kind::Choice(&["clean", "loaded"]),
        Assumption::BeamFloorTuning
        | Assumption::PlateFloorTuning
        | Assumption::BeamArrayFloorTuning
        | Assumption::PlateArrayFloorTuning => Kind::QuantityOr(Dimension::Stiffness, &["clean", "loaded", "untuned"]),
        Assumption::BeamImpulseTime | Assumption::PlateImpulseTime => Kind::QuantityOr(Dimension::Time, &IMPULSE_TIMES),
        Assumption::BeamImpulse | Assumption::PlateImpulse => Kind::Quantity(Dimension::Impulse),
        Assumption::BeamArrayMargin | Assumption::CentredArrayMargin => Kind::Quantity(Dimension::Length),
        Assumption::BeamHarmonicForce | Assumption::PlateHarmonicForce => Kind::Quantity(Dimension::Force),
        Assumption::GridVelocity => Kind::Choice(&["largest", "mean"]),
        Assumption::MassMeasure => Kind::Choice(&["jump", "after", "level"]),
    }
}

/// Reads the assumptions file from its text; `file` only names it in messages.
///
/// # Errors
/// Every mistake of the file, with its place.
pub fn parse_assumptions(file: &str, text: &str) -> Result<AssumptionSheet, Problems> {
    let findings = Findings::default();
    let sheet = read_tree(text, &findings).and_then(|root| read_sheet(&root, &findings));
    findings.finish(file, text, sheet)
}

fn read_sheet(root: &Node, findings: &Findings) -> Option<AssumptionSheet> {
    let Value::Mapping(entries) = &root.value else {
        return findings.wrong(root.span, "the assumptions are written as `name: {value: …, reason: …}`");
    };
    let mut sheet = AssumptionSheet::default();
    for Entry { key, key_span, node } in entries {
        let Some(name) = from_word::<Assumption>(key) else {
            no_such::<()>(findings, *key_span, "assumption", key, words::<Assumption>());
            continue;
        };
        if let Some(entry) = read_entry(node, kind(name), findings) {
            sheet.entries.insert(name, entry);
        }
    }
    Some(sheet)
}

fn read_entry(node: &Node, kind: Kind, findings: &Findings) -> Option<AssumptionEntry> {
    let fields = Fields::open(node, "an assumption", findings)?;
    let value = fields.required("value", |node| read_value(node, kind, findings));
    let reason = fields.required("reason", |node| text(node, findings));
    let range = fields.optional("range", |node| list(node, findings, |node| read_value(node, kind, findings)));
    let fitted_to = fields.optional("fitted_to", |node| list(node, findings, |node| text(node, findings)));
    fields.close()?;
    Some(AssumptionEntry {
        value: value?,
        reason: reason?,
        range: range?.unwrap_or_default(),
        fitted_to: fitted_to?.unwrap_or_default(),
    })
}

/// A value of this assumption.
pub(super) fn read_value_of(name: Assumption, node: &Node, findings: &Findings) -> Option<AssumptionValue> {
    read_value(node, kind(name), findings)
}

fn read_value(node: &Node, kind: Kind, findings: &Findings) -> Option<AssumptionValue> {
    match kind {
        Kind::Quantity(dimension) => above_zero(node, dimension, findings).map(AssumptionValue::Number),
        Kind::Ratio => ratio(node, findings).map(AssumptionValue::Number),
        Kind::ContactDamping => match scalar(node, findings)? {
            EQUIVALENT_VISCOUS => Some(AssumptionValue::Choice(EQUIVALENT_VISCOUS.into())),
            _ => ratio(node, findings).map(AssumptionValue::Number),
        },
        Kind::Restitution => match ratio(node, findings)? {
            value if value <= 1.0 => Some(AssumptionValue::Number(value)),
            _ => findings.wrong(node.span, "a coefficient of restitution lies between 0 and 1"),
        },
        Kind::Choice(readings) => {
            let word = scalar(node, findings)?;
            if readings.contains(&word) {
                return Some(AssumptionValue::Choice(word.into()));
            }
            unknown(findings, node.span, "this assumption", "reading", word, readings)
        }
        Kind::Modes => match count(node, "modes", 1000, findings)? {
            0 => findings.wrong(node.span, "a structure without modes does not move: give it one at least"),
            modes => Some(AssumptionValue::Number(f64::from(modes))),
        },
        Kind::QuantityOr(dimension, readings) => match scalar(node, findings)? {
            word if readings.contains(&word) => Some(AssumptionValue::Choice(word.into())),
            _ => above_zero(node, dimension, findings).map(AssumptionValue::Number),
        },
        Kind::Curve => read_curve(node, findings),
    }
}

/// `{acceleration_ratio: [0.7, …], damping: [2 N s/m, …]}`: acceleration in units of g, increasing.
fn read_curve(node: &Node, findings: &Findings) -> Option<AssumptionValue> {
    let fields = Fields::open(node, "a curve", findings)?;
    let abscissae = fields.required("acceleration_ratio", |node| list(node, findings, |node| number(node, findings)));
    let ordinates =
        fields.required("damping", |node| list(node, findings, |node| above_zero(node, Dimension::Damping, findings)));
    fields.close()?;
    let (abscissae, ordinates) = (abscissae?, ordinates?);
    if abscissae.len() != ordinates.len() || abscissae.len() < 2 {
        return findings.wrong(node.span, "a curve has as many ordinates as abscissae, two at least");
    }
    if !abscissae.is_sorted_by(|a, b| a < b) {
        return findings.wrong(node.span, "the abscissae of a curve increase");
    }
    Some(AssumptionValue::Curve(abscissae.into_iter().zip(ordinates).map(|(x, y)| [x, y]).collect()))
}
