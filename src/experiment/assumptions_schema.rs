//! JSON Schema of the assumptions file, and of an assumption where one may stand.

use serde_json::Value;

use super::assumption_reader::{DEFAULTS, describe_defaults, read_entry};
use super::stated::{STATED, read_chapters};
use crate::yaml::schema::Object;
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
