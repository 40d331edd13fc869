//! JSON Schema of a reference file: its entries, and the names of claims and extractions. What stands inside a claim is
//! checked by the reader alone.

use serde_json::{Value, json};

use super::extraction::Extraction;
use super::predicate::Predicate;
use super::verdict::Verdict;
use crate::experiment::{Object, list, text, words_of};

/// JSON Schema of a reference file.
#[must_use]
pub fn reference_schema() -> Value {
    let object = |about: &str| json!({"description": about, "type": "object"});
    let mut expected = words_of::<Verdict>("The verdict that is expected; reproduced unless stated");
    if let Some(words) = expected["enum"].as_array_mut() {
        words.retain(|word| word != "missing");
    }
    let size = json!({"type": "number", "exclusiveMinimum": 0});
    let tolerance = Object::new("A tolerance set by hand")
        .exactly_one(vec![("relative", size.clone()), ("absolute", size)])
        .required("reason", text("Why"))
        .schema();
    let one_of = |about: &str, names: Value| json!({"description": about, "type": "object", "propertyNames": names, "minProperties": 1, "maxProperties": 1});
    let entry = Object::new("One published number or claim")
        .required("id", json!({"description": "Unique in the file", "type": "string", "pattern": "^[a-z0-9-]+$"}))
        .required("place", text("Where it stands: s. 3.6.3, Fig. 18"))
        .required("says", text("What the study says, in one line"))
        .exactly_one(vec![
            ("value", json!({"description": "The number as printed, in quotes: its digits count", "type": "string"})),
            ("claim", one_of("A claim in words", words_of::<Predicate>("A claim"))),
            ("peak", object("The numbers of a resonance")),
            ("curve", object("A published curve")),
            ("mode_shape", object("A published or analytic shape")),
        ])
        .optional("from", one_of("Its counterpart in the table", words_of::<Extraction>("An extraction")))
        .optional("where", object("The rows that are meant, by parameter"))
        .optional("tolerance", tolerance)
        .optional("threshold_reason", text("Why the thresholds of a claim are what they are"))
        .optional("expected", expected)
        .optional("explanation", text("Why it is expected to differ, to be blocked or undecidable; or a note"))
        .optional("blocked_by", list("Inputs that the study does not give and a claim waits for", text("An input")))
        .rule(
            json!({"if": {"required": ["value"]}, "then": {"required": ["from"], "not": {"required": ["blocked_by"]}}}),
        )
        .rule(json!({"if": {"required": ["peak"]}, "then": {"not": {"required": ["blocked_by"]}}}))
        .rule(json!({
            "if": {"required": ["expected"], "properties": {"expected": {"not": {"const": "reproduced"}}}},
            "then": {"required": ["explanation"]},
        }))
        .schema();
    let not_judged = Object::new("A statement without an entry")
        .required("place", text("Where it stands: s. 3.6.1, Fig. 13"))
        .required("says", text("What the study says, in one line"))
        .required("reason", text("Why no entry can judge it"))
        .schema();
    let mut schema = Object::new("What the study says of one experiment")
        .required("entries", list("Entries", entry))
        .optional("not_judged", list("What the study says beside these and nothing here can judge", not_judged))
        .schema();
    schema["$schema"] = json!("http://json-schema.org/draft-07/schema#");
    schema["title"] = json!("Reference");
    schema
}
