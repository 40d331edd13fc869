//! The assumptions file.

use serde_json::{Value, json};

use super::parts::{Object, any_of, between, count, list, number, one_of_words, quantity, ratio, text};
use crate::experiment::assumption_sheet::{Kind, kind};
use crate::experiment::quantity::Dimension;
use crate::experiment::word::{from_word, words};
use crate::scene::{Assumption, EQUIVALENT_VISCOUS};

/// JSON Schema of the assumptions file.
#[must_use]
pub fn assumptions_schema() -> Value {
    let names = words::<Assumption>().iter().filter_map(|name| Some((*name, from_word::<Assumption>(name)?)));
    let mut schema = names
        .fold(Object::new("Each input that the study uses and does not state"), |object, (name, assumption)| {
            object.optional(name, entry(name, kind(assumption)))
        })
        .schema();
    schema["$schema"] = json!("http://json-schema.org/draft-07/schema#");
    schema["title"] = json!("Assumptions");
    schema
}

fn entry(name: &str, kind: Kind) -> Value {
    Object::new(&name.replace('_', " "))
        .required("value", value(kind))
        .required("reason", text("Why this value"))
        .optional("range", list("Other values that could be defended", value(kind)))
        .optional("fitted_to", list("Entries that the value was chosen by", text("experiment/entry")))
        .schema()
}

fn value(kind: Kind) -> Value {
    let about = "The value in force";
    match kind {
        Kind::Quantity(dimension) => quantity(about, dimension),
        Kind::Ratio => ratio(about),
        Kind::ContactDamping => any_of(about, vec![ratio(about), one_of_words(about, &[EQUIVALENT_VISCOUS])]),
        Kind::Restitution => between(about, 0.0, 1.0),
        Kind::Choice(readings) => one_of_words(about, readings),
        Kind::Modes => count(about, "modes", 1, 1000),
        Kind::QuantityOr(dimension, readings) => {
            any_of(about, vec![quantity(about, dimension), one_of_words(about, readings)])
        }
        Kind::Curve => Object::new("A curve")
            .required("acceleration_ratio", list("In units of g, increasing", number("Acceleration over g")))
            .required("damping", list("As many", quantity("Damping", Dimension::Damping)))
            .schema(),
    }
}
