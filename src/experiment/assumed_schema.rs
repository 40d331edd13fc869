//! JSON Schema of `{assumed: NAME}`, and of the names.

use serde_json::Value;

use super::recipe::{AssumptionSheet, Takes};
use crate::text::words::of_key;
use crate::yaml::Sketch;
use crate::yaml::schema::{form, one_of_words, text};

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
