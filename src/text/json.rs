//! Plain data as JSON: structures, enumerations and maps with text keys always have a form, in which a number that is none is `null`.

use serde::Serialize;
use serde_json::Value;

/// As a value, whose keys are sorted.
pub(crate) fn value(data: &impl Serialize) -> Value {
    serde_json::to_value(data).unwrap_or_else(none)
}

/// In one line; fields stand in the order of their type.
pub(crate) fn line(data: &impl Serialize) -> String {
    serde_json::to_string(data).unwrap_or_else(none)
}

/// Indented, for a file of its own; fields stand in the order of their type.
pub(crate) fn page(data: &impl Serialize) -> String {
    serde_json::to_string_pretty(data).unwrap_or_else(none) + "\n"
}

fn none<T>(error: serde_json::Error) -> T {
    unreachable!("plain data has a JSON form: {error}")
}
