//! The assumptions file.

use std::collections::BTreeMap;

use serde_json::{Value, json};

use super::parts::{Object, any_of, form, list, number, one_of_words, quantity, ratio, reference, text};
use crate::experiment::assumption_reader::{COUNTED, read_cycles};
use crate::experiment::assumption_sheet::{AssumptionSheet, Quantity, Takes};
use crate::experiment::at::{Definitions, Sketch};
use crate::experiment::quantity::Dimension;
use crate::experiment::recipe::Slot;
use crate::experiment::stated::{STATED, read_chapters};
use crate::experiment::word::{from_word, word_of, words};
use crate::scene::{Form, KINDS};
use crate::text::words::of_key;

/// JSON Schema of the assumptions file.
#[must_use]
pub fn assumptions_schema() -> Value {
    let mut schema = Object::new("Each input that the study uses and does not state, by name")
        .optional("defaults", defaults())
        .optional(STATED, Sketch::of("Inputs that the text states, by chapter", &Definitions::default(), read_chapters))
        .schema();
    schema["additionalProperties"] = entry();
    schema["$schema"] = json!("http://json-schema.org/draft-07/schema#");
    schema["title"] = json!("Assumptions");
    schema
}

fn entry() -> Value {
    let kinds: Vec<&str> = COUNTED.iter().map(|(word, _)| *word).chain(words::<Dimension>().iter().copied()).collect();
    let mut schema = Object::new("An assumption")
        .optional("quantity", one_of_words("What its numbers are", &kinds))
        .optional("readings", list("Its readings", text("A reading")))
        .required("value", value())
        .required("reason", text("Why this value"))
        .optional("range", list("Other values that could be defended", value()))
        .optional("fitted_to", list("Entries that the value was chosen by", text("experiment/entry")))
        .schema();
    schema["anyOf"] = json!([{"required": ["quantity"]}, {"required": ["readings"]}]);
    schema
}

/// A number with or without unit, a reading, or a curve.
fn value() -> Value {
    any_of("A value of its kind", vec![json!({"type": ["number", "string"]}), curve(), places()])
}

/// Shares of the sides.
fn places() -> Value {
    let share = || ratio("A share of the side");
    list("Places", any_of("A place", vec![share(), list("One coordinate a side", share())]))
}

/// Damping against acceleration.
pub(in crate::experiment) fn curve() -> Value {
    Object::new("A curve")
        .required("acceleration_ratio", list("In units of g, increasing", number("Acceleration over g")))
        .required("damping", list("As many", quantity("Damping", Dimension::Damping)))
        .schema()
}

fn defaults() -> Value {
    let all = Object::new(
        "Cycles of a run, and which assumption stands where an experiment says assumed or leaves a slot out",
    )
    .optional("run", Sketch::of("Cycles of experiments that do not say", &Definitions::default(), read_cycles));
    Slot::ALL
        .iter()
        .fold(all, |object, slot| {
            let by_structure = KINDS
                .iter()
                .fold(Object::new("By structure"), |object, kind| object.optional(kind.name, text("An assumption")));
            object.optional(&word_of(slot), any_of(slot.about(), vec![text("An assumption"), by_structure.schema()]))
        })
        .schema()
}

/// `{assumed: NAME}` for a place that takes this.
pub(in crate::experiment) fn assumed(takes: Takes<'_>) -> Value {
    reference(&definition(takes))
}

/// What each place that an assumption can stand in takes, and the names of the study's assumptions that fit there.
pub(in crate::experiment) fn definitions(sheet: &AssumptionSheet) -> Vec<(String, Value)> {
    let counted = COUNTED.iter().map(|(_, quantity)| *quantity);
    let quantities = counted.chain(words::<Dimension>().iter().filter_map(|word| from_word(word)).map(Quantity::Of));
    let quantities = quantities.map(|quantity| Takes { quantity: Some(quantity), readings: &[] });
    let slots = Slot::ALL.iter().map(|slot| slot.takes());
    let fields = KINDS.iter().flat_map(|kind| kind.fields).filter_map(|field| match field.form {
        Form::Word(readings) => Some(Takes { quantity: None, readings }),
        _ => None,
    });
    let all: BTreeMap<String, Takes<'_>> =
        quantities.chain(slots).chain(fields).map(|takes| (definition(takes), takes)).collect();
    all.into_iter().map(|(name, takes)| (name, form("assumed", "By an assumption", names(sheet, takes)))).collect()
}

/// The names that fit; any, where the study declares none of the kind.
fn names(sheet: &AssumptionSheet, takes: Takes<'_>) -> Value {
    let names: Vec<&str> =
        sheet.iter().filter(|(_, entry)| takes.admits(&entry.kind)).map(|(name, _)| name.as_str()).collect();
    let about = format!("The name of an assumption that is {}", takes.words());
    if names.is_empty() { text(&about) } else { one_of_words(&about, &names) }
}

/// Any of them.
pub(in crate::experiment) fn any(sheet: &AssumptionSheet) -> Value {
    let names: Vec<&str> = sheet.iter().map(|(name, _)| name.as_str()).collect();
    if names.is_empty() { text("An assumption") } else { one_of_words("An assumption", &names) }
}

/// `assumed_length`, `assumed_base_loaded`.
fn definition(takes: Takes<'_>) -> String {
    let quantity = takes.quantity.map(|quantity| of_key(&quantity));
    let words = quantity.iter().map(String::as_str).chain(takes.readings.iter().copied());
    words.fold("assumed".to_owned(), |name, word| name + "_" + word)
}
