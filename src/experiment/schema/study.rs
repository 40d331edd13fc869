//! What a study says of itself.

use serde_json::{Value, json};

use super::parts::{Object, list, text, words_of};
use crate::experiment::about_study::{LineColour, PublicationKind};

/// JSON Schema of `study.yaml`.
#[must_use]
pub fn study_schema() -> Value {
    let publication = Object::new("The publication that is reproduced")
        .required("type", words_of::<PublicationKind>("What it is"))
        .required("name", text("Its title, or a description"));
    let finding = Object::new("A conclusion of the publication")
        .required("says", text("In a sentence"))
        .required("entries", list("The entries whose verdicts decide it", text("experiment/entry")));
    let by_key = |about: &str, keys: Value, value: Value| json!({"description": about, "type": "object", "propertyNames": keys, "additionalProperties": value});
    let number = json!({"pattern": "^[0-9]{1,2}$"});
    let mut schema = Object::new("What the study is")
        .optional("title", text("A few words"))
        .optional("about", text("The sentence that opens the index of its reports"))
        .optional("source", publication.schema())
        .optional("chapters", by_key("Subjects of the publication's chapters, by number", number, text("A subject")))
        .optional(
            "colours",
            by_key("Colours of lines of these names, in every figure", json!({}), words_of::<LineColour>("A colour")),
        )
        .optional("findings", list("What the publication concludes", finding.schema()))
        .schema();
    schema["$schema"] = json!("http://json-schema.org/draft-07/schema#");
    schema["title"] = json!("Study");
    schema
}
