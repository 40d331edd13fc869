//! The JSON Schema (draft 7) of a file that a person writes, so that an editor completes and checks it while it is written.
//!
//! Keys, words, units and limits come from the functions that read the file ([`At`]). What a schema cannot say (ranges in order, columns that
//! exist, a scene that physics accepts) the reader says, which is the judge in everything: a file that it accepts passes the schema, as
//! long as its units are written as people write them.

use serde_json::{Value, json};

use super::at::{At, Definitions, Sketch};

/// The schema of what `reader` reads out of a file.
pub(crate) fn described<T>(title: &str, about: &str, reader: impl FnOnce(At<'_>) -> Option<T>) -> Value {
    let definitions = Definitions::default();
    let schema = Sketch::of(about, &definitions, reader);
    of_file(title, schema, definitions)
}

/// The schema of a file, with what its places share.
pub(crate) fn of_file(title: &str, mut schema: Value, definitions: Definitions) -> Value {
    schema["$schema"] = json!("http://json-schema.org/draft-07/schema#");
    schema["title"] = json!(title);
    let definitions = definitions.into_inner();
    if !definitions.is_empty() {
        schema["definitions"] = Value::Object(definitions);
    }
    schema
}
