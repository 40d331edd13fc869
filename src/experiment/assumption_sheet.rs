//! The assumptions file: each input that a study uses and does not state, with kind, value, reason and range.
//!
//! ```yaml
//! defaults:                          # which assumption stands where an experiment says `assumed` or leaves the slot out
//!   gravity: gravity                 # on every structure
//!   modes: {cantilever_beam: beam_modes, supported_plate: plate_modes}
//! gravity: {quantity: acceleration, value: 9.81 m/s^2, range: [9.80665 m/s^2], reason: The usual rounding.}
//! ```
//!
//! The range is what a reader may believe as well; moving one assumption at a time to its ends gives the sensitivity of
//! every number to what is not known.

use std::collections::{BTreeMap, BTreeSet};
use std::sync::Arc;

use serde::{Deserialize, Serialize};

use super::diagnostic::{Findings, Problems, place};
use super::quantity::Dimension;
use super::reader::{Fields, above_zero, count, list, no_such, ratio, scalar, text, unknown};
use super::recipe::{AssumptionName, AssumptionValue, Assumptions, Slot};
use super::word::{closest, from_word, words};
use super::yaml::{Entry, Node, Value, read_tree};
use crate::dynamics::Spline;
use crate::scene::{Curve, KINDS};
use crate::text::number::significant;

/// The name of the file within a study.
pub const ASSUMPTIONS: &str = "experiments/assumptions.yaml";

/// The assumptions with all that the file says of them.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct AssumptionSheet {
    /// Entries in the order of the file.
    entries: Vec<(AssumptionName, Arc<AssumptionEntry>)>,
    /// Which assumption stands for a slot on a kind of structure.
    defaults: Arc<BTreeMap<(Slot, &'static str), AssumptionName>>,
}

/// One assumption.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct AssumptionEntry {
    /// What kind of value it has.
    pub kind: AssumptionKind,
    /// The value in force.
    pub value: AssumptionValue,
    /// Why this value. Markdown.
    pub reason: String,
    /// Other values that could be defended: the ends of an interval, or the other readings. May be empty.
    pub range: Vec<AssumptionValue>,
    /// Ids of the reference entries that the value was chosen by: their agreement proves nothing.
    pub fitted_to: Vec<String>,
    /// The line of the file where it stands.
    #[serde(skip)]
    pub line: usize,
}

/// What kind of value an assumption has: a quantity, one of named readings, or either.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct AssumptionKind {
    /// What its numbers are; none for readings alone.
    pub quantity: Option<Quantity>,
    /// Its readings.
    pub readings: Vec<String>,
}

/// What a number, or a curve, is.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Quantity {
    /// Dimensionless, zero or more.
    Ratio,
    /// A whole number, one or more.
    Count,
    /// A damping curve.
    #[serde(rename = "damping_curve")]
    Curve,
    /// Of this dimension.
    #[serde(untagged)]
    Of(Dimension),
}

/// What a place of a scene takes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Takes<'a> {
    /// Numbers, or a curve.
    pub quantity: Option<Quantity>,
    /// Readings.
    pub readings: &'a [&'a str],
}

impl Takes<'_> {
    /// Of this dimension.
    #[must_use]
    pub fn quantity(dimension: Dimension) -> Self {
        Self { quantity: Some(Quantity::Of(dimension)), readings: &[] }
    }

    /// Dimensionless.
    #[must_use]
    pub fn ratio() -> Self {
        Self { quantity: Some(Quantity::Ratio), readings: &[] }
    }

    /// Every value of the kind has a meaning here.
    #[must_use]
    pub fn admits(self, kind: &AssumptionKind) -> bool {
        (kind.quantity.is_none() || kind.quantity == self.quantity)
            && kind.readings.iter().all(|reading| self.readings.contains(&reading.as_str()))
    }

    /// In words: `a length`, `one of clean, loaded`.
    #[must_use]
    pub fn words(self) -> String {
        in_words(self.quantity, self.readings)
    }
}

impl AssumptionKind {
    /// In words.
    #[must_use]
    pub fn words(&self) -> String {
        let readings: Vec<&str> = self.readings.iter().map(String::as_str).collect();
        in_words(self.quantity, &readings)
    }

    /// Unit symbol of its numbers, empty when dimensionless.
    #[must_use]
    pub fn unit(&self) -> &'static str {
        match self.quantity {
            Some(Quantity::Of(dimension)) => dimension.unit(),
            Some(Quantity::Curve) => Dimension::Damping.unit(),
            Some(Quantity::Ratio | Quantity::Count) | None => "",
        }
    }
}

fn in_words(quantity: Option<Quantity>, readings: &[&str]) -> String {
    let quantity = quantity.map(|quantity| match quantity {
        Quantity::Of(dimension) => dimension.name(),
        Quantity::Ratio => "a dimensionless number",
        Quantity::Count => "a whole number",
        Quantity::Curve => "a damping curve",
    });
    let readings = if readings.is_empty() { None } else { Some(format!("one of {}", readings.join(", "))) };
    match (quantity, readings) {
        (Some(quantity), Some(readings)) => format!("{quantity} or {readings}"),
        (Some(quantity), None) => quantity.into(),
        (None, readings) => readings.unwrap_or_default(),
    }
}

/// One assumption moved to a value of its range.
#[derive(Debug, Clone, PartialEq)]
pub struct Moved {
    /// Such as `stop_length=0.05`.
    pub label: String,
    /// Which.
    pub name: AssumptionName,
    /// All values in force then.
    pub assumptions: Assumptions,
}

impl AssumptionSheet {
    /// The entries in the order of the file.
    pub fn iter(&self) -> impl Iterator<Item = (&AssumptionName, &AssumptionEntry)> {
        self.entries.iter().map(|(name, entry)| (name, entry.as_ref()))
    }

    /// The entry of this name.
    #[must_use]
    pub fn get(&self, name: &AssumptionName) -> Option<&AssumptionEntry> {
        self.iter().find(|(known, _)| *known == name).map(|(_, entry)| entry)
    }

    /// The assumption that stands for a slot on this kind of structure, if the study declares one.
    #[must_use]
    pub fn default_of(&self, slot: Slot, structure: &'static str) -> Option<&AssumptionName> {
        self.defaults.get(&(slot, structure))
    }

    /// The assumptions that stand for some slot by default.
    pub fn defaults(&self) -> impl Iterator<Item = &AssumptionName> {
        self.defaults.values()
    }

    /// The values in force.
    #[must_use]
    pub fn assumptions(&self) -> Assumptions {
        let values = self.iter().map(|(name, entry)| (name.clone(), entry.value.clone())).collect();
        Assumptions { values, sheet: Arc::new(self.clone()) }
    }

    /// One assumption at a time moved to each value of its range.
    #[must_use]
    pub fn variants(&self, of: &BTreeSet<AssumptionName>) -> Vec<Moved> {
        let mut variants = Vec::new();
        let in_force = self.assumptions();
        for (name, entry) in self.iter().filter(|(name, _)| of.contains(*name)) {
            for (index, value) in entry.range.iter().filter(|value| **value != entry.value).enumerate() {
                let description = match value {
                    AssumptionValue::Number(number) => number.to_string(),
                    AssumptionValue::Choice(word) => word.clone(),
                    AssumptionValue::Curve(_) => format!("curve_{}", index + 1),
                };
                let mut assumptions = in_force.clone();
                assumptions.values.insert(name.clone(), value.clone());
                variants.push(Moved { label: format!("{name}={description}"), name: name.clone(), assumptions });
            }
        }
        variants
    }

    /// Names as they are declared, for suggestions.
    pub(super) fn names(&self) -> Vec<&str> {
        self.iter().map(|(name, _)| name.as_str()).collect()
    }

    /// The declared name that a word is, or a refusal with the nearest one.
    pub(super) fn named(&self, node: &Node, findings: &Findings) -> Option<AssumptionName> {
        let word = scalar(node, findings)?;
        if let Some((name, _)) = self.iter().find(|(name, _)| name.as_str() == word) {
            return Some(name.clone());
        }
        if closest(word, self.names()).is_some() {
            return no_such(findings, node.span, "assumption", word, &self.names());
        }
        let help = format!("declare it in {ASSUMPTIONS}: `{word}: {{quantity: …, value: …, reason: …}}`");
        findings.report(node.span, format!("`{word}` is not an assumption"), Some(help))
    }

    /// A value of this assumption.
    pub(super) fn value_of(&self, name: &AssumptionName, node: &Node, findings: &Findings) -> Option<AssumptionValue> {
        read_value(node, &self.get(name)?.kind, findings)
    }
}

/// Reads the assumptions file from its text; `file` only names it in messages.
///
/// # Errors
/// Every mistake of the file, with its place.
pub fn parse_assumptions(file: &str, text: &str) -> Result<AssumptionSheet, Problems> {
    let findings = Findings::default();
    let sheet = read_tree(text, &findings).and_then(|root| read_sheet(&root, text, &findings));
    findings.finish(file, text, sheet)
}

fn read_sheet(root: &Node, text: &str, findings: &Findings) -> Option<AssumptionSheet> {
    let Value::Mapping(entries) = &root.value else {
        return findings.wrong(root.span, "the assumptions are written as `name: {value: …, reason: …}`");
    };
    let mut sheet = AssumptionSheet::default();
    for Entry { key, key_span, node } in entries.iter().filter(|entry| entry.key != DEFAULTS) {
        if !is_name(key) {
            findings.wrong::<()>(*key_span, format!("`{key}` cannot name an assumption: use letters, digits and `_`"));
        } else if let Some(entry) = read_entry(node, place(text, *key_span).line, findings) {
            sheet.entries.push((AssumptionName::from(key.as_str()), Arc::new(entry)));
        }
    }
    if let Some(defaults) = entries.iter().find(|entry| entry.key == DEFAULTS) {
        sheet.defaults = Arc::new(read_defaults(&defaults.node, &sheet, findings)?);
    }
    Some(sheet)
}

/// The key of the defaults, which no assumption can have for a name.
const DEFAULTS: &str = "defaults";

/// What stands in column names and labels of variants.
fn is_name(key: &str) -> bool {
    !key.is_empty() && key.len() <= 64 && key.chars().all(|c| c.is_ascii_alphanumeric() || c == '_')
}

type Defaults = BTreeMap<(Slot, &'static str), AssumptionName>;

/// `slot: name` for every structure, or `slot: {structure: name}`.
fn read_defaults(node: &Node, sheet: &AssumptionSheet, findings: &Findings) -> Option<Defaults> {
    let Value::Mapping(entries) = &node.value else {
        return findings
            .wrong(node.span, "defaults are written as `slot: assumption` or `slot: {structure: assumption}`");
    };
    let mut defaults = Defaults::new();
    for Entry { key, key_span, node } in entries {
        let Some(slot) = from_word::<Slot>(key) else {
            no_such::<()>(findings, *key_span, "slot of a scene", key, words::<Slot>());
            continue;
        };
        let name = |node: &Node| {
            let name = sheet.named(node, findings)?;
            fits(sheet, &name, node, slot.takes(), &format!("`{key}`"), findings).then_some(name)
        };
        if let Value::Mapping(each) = &node.value {
            for Entry { key, key_span, node } in each {
                let Some(kind) = KINDS.iter().find(|kind| kind.name == key) else {
                    let known: Vec<&str> = KINDS.iter().map(|kind| kind.name).collect();
                    no_such::<()>(findings, *key_span, "structure", key, &known);
                    continue;
                };
                defaults.extend(name(node).map(|name| ((slot, kind.name), name)));
            }
        } else if let Some(name) = name(node) {
            defaults.extend(KINDS.iter().map(|kind| ((slot, kind.name), name.clone())));
        }
    }
    Some(defaults)
}

/// Whether an assumption is of the kind that a place takes; if it is not, that is reported with the line of both.
pub(super) fn fits(
    sheet: &AssumptionSheet,
    name: &AssumptionName,
    at: &Node,
    takes: Takes<'_>,
    place: &str,
    findings: &Findings,
) -> bool {
    let Some(entry) = sheet.get(name).filter(|entry| !takes.admits(&entry.kind)) else { return true };
    let message = format!(
        "{place} takes {}, but the assumption `{name}` ({ASSUMPTIONS}, line {}) is {}",
        takes.words(),
        entry.line,
        entry.kind.words()
    );
    findings.wrong::<()>(at.span, message);
    false
}

fn read_entry(node: &Node, line: usize, findings: &Findings) -> Option<AssumptionEntry> {
    let fields = Fields::open(node, "an assumption", findings)?;
    let quantity = fields.optional("quantity", |node| read_quantity(node, findings));
    let readings =
        fields.optional("readings", |node| list(node, findings, |node| scalar(node, findings).map(str::to_owned)));
    let kind = match (quantity, readings) {
        (Some(None), Some(None)) => {
            let help = "add `quantity: length`, `quantity: ratio`, …, or `readings: [one, other]`".to_owned();
            findings.report(node.span, "this assumption has no kind", Some(help))
        }
        (Some(quantity), Some(readings)) => Some(AssumptionKind { quantity, readings: readings.unwrap_or_default() }),
        _ => None,
    };
    let value = |node: &Node| read_value(node, kind.as_ref()?, findings);
    let in_force = fields.required("value", value);
    let reason = fields.required("reason", |node| text(node, findings));
    let range = fields.optional("range", |node| list(node, findings, value));
    let fitted_to = fields.optional("fitted_to", |node| list(node, findings, |node| text(node, findings)));
    fields.close()?;
    Some(AssumptionEntry {
        value: in_force?,
        reason: reason?,
        range: range?.unwrap_or_default(),
        fitted_to: fitted_to?.unwrap_or_default(),
        line,
        kind: kind?,
    })
}

/// The words that are no dimensions.
pub(super) const COUNTED: [(&str, Quantity); 3] =
    [("ratio", Quantity::Ratio), ("count", Quantity::Count), ("damping_curve", Quantity::Curve)];

fn read_quantity(node: &Node, findings: &Findings) -> Option<Quantity> {
    let word = scalar(node, findings)?;
    let counted = COUNTED.into_iter().find(|(known, _)| *known == word).map(|(_, quantity)| quantity);
    counted.or_else(|| from_word::<Dimension>(word).map(Quantity::Of)).or_else(|| {
        let known: Vec<&str> =
            COUNTED.iter().map(|(word, _)| *word).chain(words::<Dimension>().iter().copied()).collect();
        no_such(findings, node.span, "kind of quantity", word, &known)
    })
}

fn read_value(node: &Node, kind: &AssumptionKind, findings: &Findings) -> Option<AssumptionValue> {
    if !kind.readings.is_empty() {
        let word = match (&node.value, kind.quantity) {
            (Value::Scalar(_), _) | (_, None) => scalar(node, findings)?,
            _ => "",
        };
        if kind.readings.iter().any(|reading| reading == word) {
            return Some(AssumptionValue::Choice(word.into()));
        }
        if kind.quantity.is_none() {
            let known: Vec<&str> = kind.readings.iter().map(String::as_str).collect();
            return unknown(findings, node.span, "this assumption", "reading", word, &known);
        }
    }
    match kind.quantity? {
        Quantity::Of(dimension) => above_zero(node, dimension, findings).map(AssumptionValue::Number),
        Quantity::Ratio => ratio(node, findings).map(AssumptionValue::Number),
        Quantity::Count => match count(node, "", MOST_COUNTED, findings)? {
            0 => findings.wrong(node.span, "a whole number, one or more, is wanted"),
            count => Some(AssumptionValue::Number(f64::from(count))),
        },
        Quantity::Curve => read_curve(node, findings).map(AssumptionValue::Curve),
    }
}

/// Most of what an assumption counts.
pub(super) const MOST_COUNTED: u32 = 1000;

/// `{acceleration_ratio: [0.7, …], damping: [2 N s/m, …]}`: RMS acceleration in units of g, increasing.
pub(super) fn read_curve(node: &Node, findings: &Findings) -> Option<Curve> {
    let fields = Fields::open(node, "a curve", findings)?;
    let placed = |node: &Node, value: Option<f64>| value.map(|value| (value, node.span));
    let accelerations = fields.required("acceleration_ratio", |node| {
        list(node, findings, |node| placed(node, ratio(node, findings))).map(|list| (list, node.span))
    });
    let dampings = fields.required("damping", |node| {
        list(node, findings, |node| placed(node, above_zero(node, Dimension::Damping, findings)))
    });
    fields.close()?;
    let ((accelerations, at), dampings) = (accelerations?, dampings?);
    if accelerations.len() != dampings.len() || accelerations.len() < 2 {
        let message = format!(
            "a curve has one damping for each acceleration, and two points at least; here are {} accelerations and {} \
             dampings",
            accelerations.len(),
            dampings.len()
        );
        return findings.wrong(at, message);
    }
    if let Some(pair) = accelerations.windows(2).find(|pair| pair[1].0 <= pair[0].0) {
        let message = format!("the accelerations of a curve increase, and {} follows {}", pair[1].0, pair[0].0);
        return findings.wrong(pair[1].1, message);
    }
    let curve: Curve = accelerations.iter().zip(&dampings).map(|((x, _), (y, _))| [*x, *y]).collect();
    let [x, y] = Spline::through(&curve)?.lowest();
    if y >= 0.0 {
        return Some(curve);
    }
    // A dashpot that drives the motion.
    let after = accelerations.iter().position(|(acceleration, _)| *acceleration >= x).unwrap_or(0);
    let message = format!(
        "the spline through this curve falls to {} N s/m at {} g, between its points",
        significant(y, 2),
        significant(x, 2)
    );
    findings.report(dampings[after].1, message, Some("add a point there".into()))
}
