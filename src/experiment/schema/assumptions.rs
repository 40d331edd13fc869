//! The assumptions file.

use serde_json::{Value, json};

use super::parts::{Object, any_of, form, list, number, one_of_words, quantity, text};
use crate::experiment::assumption_sheet::COUNTED;
use crate::experiment::quantity::Dimension;
use crate::experiment::recipe::Slot;
use crate::experiment::word::{word_of, words};
use crate::scene::KINDS;

/// JSON Schema of the assumptions file.
#[must_use]
pub fn assumptions_schema() -> Value {
    let mut schema = Object::new("Each input that the study uses and does not state, by name")
        .optional("defaults", defaults())
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
    any_of("A value of its kind", vec![json!({"type": ["number", "string"]}), curve()])
}

/// Damping against acceleration.
pub(super) fn curve() -> Value {
    Object::new("A curve")
        .required("acceleration_ratio", list("In units of g, increasing", number("Acceleration over g")))
        .required("damping", list("As many", quantity("Damping", Dimension::Damping)))
        .schema()
}

fn defaults() -> Value {
    Slot::ALL
        .iter()
        .fold(
            Object::new("Which assumption stands where an experiment says assumed or leaves a slot out"),
            |object, slot| {
                let by_structure = KINDS.iter().fold(Object::new("By structure"), |object, kind| {
                    object.optional(kind.name, text("An assumption"))
                });
                object
                    .optional(&word_of(slot), any_of(slot.about(), vec![text("An assumption"), by_structure.schema()]))
            },
        )
        .schema()
}

/// `{assumed: NAME}`.
pub(super) fn assumed() -> Value {
    form("assumed", "By the assumption of this name", text("The name of an assumption"))
}
