//! JSON Schema of the assumptions file, and of an assumption where one may stand.

use serde_json::{Value, json};

use super::assumption_reader::{DEFAULTS, describe_defaults, read_curve, read_entry};
use super::assumption_sheet::{AssumptionSheet, Takes};
use super::stated::{STATED, read_chapters};
use crate::text::words::of_key;
use crate::yaml::schema::{Object, any_of, form, list, one_of_words, ratio, text};
use crate::yaml::{Definitions, Place, Sketch, of_file};

/// JSON Schema of the assumptions file.
#[must_use]
pub fn assumptions_schema() -> Value {
    let definitions = Definitions::default();
    let mut schema = Object::new("Each input that the study uses and does not state, by name")
        .optional(DEFAULTS, Sketch::of(OF_DEFAULTS, &definitions, describe_defaults))
        .optional(STATED, Sketch::of("Inputs that the text states, by chapter", &definitions, read_chapters))
        .schema();
    schema["additionalProperties"] = Sketch::of("An assumption", &definitions, |at| read_entry(at, Place::default()));
    of_file("Assumptions", schema, definitions)
}

const OF_DEFAULTS: &str =
    "Cycles of a run, and which assumption stands where an experiment says assumed or leaves a slot out";

/// A number with or without unit, a reading, or a curve.
pub(super) fn value() -> Value {
    any_of(
        "A value of its kind",
        vec![
            json!({"type": ["number", "string"]}),
            Sketch::of("A curve", &Definitions::default(), read_curve),
            places(),
        ],
    )
}

/// Shares of the sides.
fn places() -> Value {
    let share = || ratio("A share of the side");
    list("Places", any_of("A place", vec![share(), list("One coordinate a side", share())]))
}

/// `{assumed: NAME}` for a place that takes this, with the names of the study's assumptions that fit there.
pub(super) fn assumed(place: &Sketch<'_>, sheet: &AssumptionSheet, takes: Takes<'_>) -> Value {
    const ABOUT: &str = "By an assumption";
    place.shared(&definition(takes), ABOUT, |at| {
        at.form(|_, _| None::<()>, |_| form("assumed", ABOUT, names(sheet, takes)))
    })
}

/// The names that fit; any, where the study declares none of the kind.
fn names(sheet: &AssumptionSheet, takes: Takes<'_>) -> Value {
    let names: Vec<&str> =
        sheet.iter().filter(|(_, entry)| takes.admits(&entry.kind)).map(|(name, _)| name.as_str()).collect();
    let about = format!("The name of an assumption that is {}", takes.words());
    if names.is_empty() { text(&about) } else { one_of_words(&about, &names) }
}

/// Any of them.
pub(super) fn any(sheet: &AssumptionSheet) -> Value {
    let names: Vec<&str> = sheet.iter().map(|(name, _)| name.as_str()).collect();
    if names.is_empty() { text("An assumption") } else { one_of_words("An assumption", &names) }
}

/// `assumed_length`, `assumed_base_loaded`.
fn definition(takes: Takes<'_>) -> String {
    let quantity = takes.quantity.map(|quantity| of_key(&quantity));
    let words = quantity.iter().map(String::as_str).chain(takes.readings.iter().copied());
    words.fold("assumed".to_owned(), |name, word| name + "_" + word)
}
