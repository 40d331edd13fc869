//! The assumptions file read: the defaults and the assumptions of a study, with every mistake at its place.

use std::sync::Arc;

use serde_json::{Value as Schema, json};

use super::recipe::{
    ASSUMPTIONS, AssumptionEntry, AssumptionKind, AssumptionName, AssumptionSheet, AssumptionValue, Cycles, Quantity,
    Slot, Takes,
};
use super::stated::{STATED, names_assumption, read_chapters};
use crate::dynamics::Spline;
use crate::scene::{Curve, KINDS, Kind};
use crate::text::number::significant;
use crate::yaml::reader::{above_zero, count, list, no_such, ratio, scalar, unknown};
use crate::yaml::word::{from_word, words};
use crate::yaml::{
    At, Definitions, Dimension, Entry, Findings, Key, Node, Place, Problems, Sketch, Value, place, read_tree, schema,
};

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
    for Entry { key, key_span, node } in entries.iter().filter(|entry| entry.key != DEFAULTS && entry.key != STATED) {
        if !is_name(key) {
            findings.wrong::<()>(*key_span, format!("`{key}` cannot name an assumption: use letters, digits and `_`"));
        } else if let Some(entry) = read_entry(At::Node(node, findings), place(text, *key_span)) {
            sheet.entries.push((AssumptionName::from(key.as_str()), Arc::new(entry)));
        }
    }
    let part = |part: &str| entries.iter().find(|entry| entry.key == part).map(|entry| At::Node(&entry.node, findings));
    if let Some(defaults) = part(DEFAULTS) {
        read_defaults(defaults, &mut sheet);
    }
    if let Some(stated) = part(STATED) {
        sheet.stated = Arc::new(read_chapters(stated)?);
    }
    Some(sheet)
}

/// The key of the defaults, which no assumption can have for a name.
pub(super) const DEFAULTS: &str = "defaults";
/// The default that is no slot of a scene.
const RUN: &str = "run";

/// What stands in column names and labels of variants.
fn is_name(key: &str) -> bool {
    !key.is_empty() && key.len() <= 64 && key.chars().all(|c| c.is_ascii_alphanumeric() || c == '_')
}

/// What one of the defaults says.
enum Default {
    Cycles(Cycles),
    Slot(Slot, Vec<(&'static str, AssumptionName)>),
}

/// `slot: name` for every structure, or `slot: {structure: name}`.
fn read_defaults(at: At<'_>, sheet: &mut AssumptionSheet) -> Option<()> {
    let form = "defaults are written as `slot: assumption` or `slot: {structure: assumption}`";
    for default in read_each_default(at, form, sheet)? {
        match default {
            Default::Cycles(cycles) => sheet.cycles = Some(cycles),
            Default::Slot(slot, names) => {
                Arc::make_mut(&mut sheet.defaults).extend(names.into_iter().map(|(kind, name)| ((slot, kind), name)));
            }
        }
    }
    Some(())
}

fn read_each_default(at: At<'_>, form: &str, sheet: &AssumptionSheet) -> Option<Vec<Default>> {
    let slots = words::<Slot>().iter().map(|word| (*word, from_word::<Slot>(word).map_or("", Slot::about)));
    let known: Vec<Key<'_>> = slots.chain([(RUN, "Cycles of experiments that do not say")]).collect();
    at.by_known_name(form, "slot of a scene", &known, |key, at| {
        if key == RUN {
            return read_cycles(at).map(Default::Cycles);
        }
        let slot = from_word::<Slot>(key)?;
        let name = |at: At<'_>| {
            let read = |node: &Node, findings: &Findings| {
                let name = sheet.named(node, findings)?;
                fits(sheet, &name, node, slot.takes(), &format!("`{key}`"), findings).then_some(name)
            };
            at.form(read, |_| schema::text("An assumption"))
        };
        let on_each = |at: At<'_>| {
            let kinds: Vec<Key<'_>> = KINDS.iter().map(|kind| (kind.name, "An assumption")).collect();
            at.by_known_name("", "structure", &kinds, |kind, at| Some((Kind::named(kind)?.name, name(at)?)))
        };
        let on_all = |at: At<'_>| name(at).map(|name| KINDS.iter().map(|kind| (kind.name, name.clone())).collect());
        let is_mapping = |value: &Value| matches!(value, Value::Mapping(_));
        at.either(is_mapping, on_each, on_all).map(|names| Default::Slot(slot, names))
    })
}

/// The schema of the defaults.
pub(super) fn describe_defaults(at: At<'_>) -> Option<()> {
    read_defaults(at, &mut AssumptionSheet::default())
}

/// `{skip: 25 cycles, average: 100 cycles}`.
fn read_cycles(at: At<'_>) -> Option<Cycles> {
    let keys = at.keys("a run")?;
    let skip = keys.required("skip", SKIP, read_skip);
    let average = keys.required("average", AVERAGE, read_average);
    keys.close()?;
    Some(Cycles { skip: skip?, average: average? })
}

/// Most forcing cycles of a run.
pub(super) const MOST_CYCLES: u32 = 10_000_000;
/// What an editor says of the cycles of a run.
pub(super) const SKIP: &str = "Cycles before the averaging; by default those of the study";
pub(super) const AVERAGE: &str = "Cycles that are averaged; by default those of the study";

/// Cycles that are left out.
pub(super) fn read_skip(at: At<'_>) -> Option<u32> {
    at.count("cycles", MOST_CYCLES)
}

/// Cycles that are averaged over.
pub(super) fn read_average(at: At<'_>) -> Option<u32> {
    at.count_from(1, "cycles", MOST_CYCLES, "one cycle at least is averaged")
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
        entry.place.line,
        entry.kind.words()
    );
    findings.wrong::<()>(at.span, message);
    false
}

pub(super) fn read_entry(at: At<'_>, place: Place) -> Option<AssumptionEntry> {
    let keys = at.keys("an assumption")?;
    let quantity = keys.optional("quantity", "What its numbers are", read_quantity);
    let readings = keys.optional("readings", "Its readings", |at| {
        at.list(|at| at.form(|node, findings| scalar(node, findings).map(str::to_owned), |it| schema::text(it.about())))
    });
    let kind = match (quantity, readings) {
        (Some(None), Some(None)) => {
            let help = format!("add `quantity: …`, one of {}, or `readings: [one, other]`", quantities().join(", "));
            at.report("this assumption has no kind", Some(help))
        }
        (Some(quantity), Some(readings)) => Some(AssumptionKind { quantity, readings: readings.unwrap_or_default() }),
        _ => None,
    };
    let value = |node: &Node, findings: &Findings| read_value(node, kind.as_ref()?, findings);
    let in_force = keys.required("value", "A value of its kind", |at| at.form(value, |_| any_value()));
    let reason = keys.required("reason", "Why this value", |at| at.text());
    let other = |node: &Node, findings: &Findings| {
        let other = value(node, findings)?;
        in_force.as_ref().is_none_or(|one| alike(one, &other, node, findings)).then_some(other)
    };
    let range = keys
        .optional("range", "Other values that could be defended", |at| at.list(|at| at.form(other, |_| any_value())));
    let fitted_to = "Entries that the value was chosen by, experiment/entry";
    let fitted_to = keys.optional("fitted_to", fitted_to, |at| at.list(|at| at.text()));
    keys.rule(|| json!({"anyOf": [{"required": ["quantity"]}, {"required": ["readings"]}]}));
    keys.close()?;
    Some(AssumptionEntry {
        value: in_force?,
        reason: reason?,
        range: range?.unwrap_or_default(),
        fitted_to: fitted_to?.unwrap_or_default(),
        place,
        kind: kind?,
    })
}

/// The words that are no dimensions.
const COUNTED: [(&str, Quantity); 4] = [
    ("ratio", Quantity::Ratio),
    ("count", Quantity::Count),
    ("damping_curve", Quantity::Curve),
    ("places", Quantity::Places),
];

/// Kinds of quantities.
fn quantities() -> Vec<&'static str> {
    COUNTED.iter().map(|(word, _)| *word).chain(words::<Dimension>().iter().copied()).collect()
}

fn read_quantity(at: At<'_>) -> Option<Quantity> {
    let read = |node: &Node, findings: &Findings| {
        let word = scalar(node, findings)?;
        let counted = COUNTED.into_iter().find(|(known, _)| *known == word).map(|(_, quantity)| quantity);
        counted
            .or_else(|| from_word::<Dimension>(word).map(Quantity::Of))
            .or_else(|| no_such(findings, node.span, "kind of quantity", word, &quantities()))
    };
    at.form(read, |it| schema::one_of_words(it.about(), &quantities()))
}

pub(super) fn read_value(node: &Node, kind: &AssumptionKind, findings: &Findings) -> Option<AssumptionValue> {
    if names_assumption(node) {
        let help = "write the value itself; a scene that takes the other assumption names that one in its place";
        return findings.report(
            node.span,
            "the value of an assumption cannot be another assumption",
            Some(help.into()),
        );
    }
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
        Quantity::Curve => read_curve(At::Node(node, findings)).map(AssumptionValue::Curve),
        Quantity::Places => read_places(node, findings).map(AssumptionValue::Places),
    }
}

/// `[[0.25, 0.5], …]` on a plate, `[0.25, …]` on a beam: shares of the sides.
fn read_places(node: &Node, findings: &Findings) -> Option<Vec<Vec<f64>>> {
    let share = |node: &Node| match ratio(node, findings)? {
        share if share <= 1.0 => Some(share),
        share => findings.wrong(node.span, format!("{share} is no share of a side, which lies between 0 and 1")),
    };
    let places = list(node, findings, |node| match node.value {
        Value::Sequence(_) => list(node, findings, share),
        _ => Some(vec![share(node)?]),
    })?;
    match places.iter().find(|place| place.len() != places[0].len() || place.len() > 2) {
        None => Some(places),
        Some(_) => findings.wrong(node.span, "each place has one coordinate on a beam, two on a plate"),
    }
}

/// Two values of one assumption list as many places, so that each is number n in both; if not, that is reported.
pub(super) fn alike(one: &AssumptionValue, other: &AssumptionValue, at: &Node, findings: &Findings) -> bool {
    let (AssumptionValue::Places(one), AssumptionValue::Places(other)) = (one, other) else { return true };
    let shape = |places: &[Vec<f64>]| (places.len(), places.first().map(Vec::len));
    if shape(one) == shape(other) {
        return true;
    }
    findings.wrong::<()>(at.span, format!("{} places, where the value in force has {}", other.len(), one.len()));
    false
}

/// Most of what an assumption counts.
pub(super) const MOST_COUNTED: u32 = 1000;

/// `{acceleration_ratio: [0.7, …], damping: [2 N s/m, …]}`: RMS acceleration in units of g, increasing.
pub(super) fn read_curve(at: At<'_>) -> Option<Curve> {
    let keys = at.keys("a curve")?;
    let in_g = "Accelerations over g, increasing";
    let accelerations = keys.required("acceleration_ratio", in_g, |at| {
        at.list(|at| Some((at.ratio()?, at.span()))).map(|list| (list, at.span()))
    });
    let dampings = keys.required("damping", "As many dampings", |at| {
        at.list(|at| Some((at.above_zero(Dimension::Damping)?, at.span())))
    });
    keys.close()?;
    let ((accelerations, accelerations_at), dampings) = (accelerations?, dampings?);
    if accelerations.len() != dampings.len() || accelerations.len() < 2 {
        let message = format!(
            "a curve has one damping for each acceleration, and two points at least; here are {} accelerations and {} \
             dampings",
            accelerations.len(),
            dampings.len()
        );
        return at.wrong_at(accelerations_at, message);
    }
    if let Some(pair) = accelerations.windows(2).find(|pair| pair[1].0 <= pair[0].0) {
        let message = format!("the accelerations of a curve increase, and {} follows {}", pair[1].0, pair[0].0);
        return at.wrong_at(pair[1].1, message);
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
    at.report_at(dampings[after].1, message, Some("add a point there".into()))
}

impl AssumptionSheet {
    /// A value of this assumption.
    pub(super) fn value_of(&self, name: &AssumptionName, node: &Node, findings: &Findings) -> Option<AssumptionValue> {
        let entry = self.get(name)?;
        let value = read_value(node, &entry.kind, findings)?;
        alike(&entry.value, &value, node, findings).then_some(value)
    }
}

/// A number with or without unit, a reading, or a curve.
pub(super) fn any_value() -> Schema {
    schema::any_of(
        "A value of its kind",
        vec![
            json!({"type": ["number", "string"]}),
            Sketch::of("A curve", &Definitions::default(), read_curve),
            places(),
        ],
    )
}

/// Shares of the sides.
fn places() -> Schema {
    let share = || schema::ratio("A share of the side");
    schema::list("Places", schema::any_of("A place", vec![share(), schema::list("One coordinate a side", share())]))
}
