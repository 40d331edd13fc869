//! Validated inputs as canonical JSON: equal inputs give equal text and equal hash; and the leaves in which two differ.

use std::collections::BTreeSet;

use serde_json::Value;

/// blake3 of a canonical JSON text, in hexadecimal.
#[must_use]
pub fn fingerprint(inputs: &Value) -> String {
    hash(canonical(inputs).as_bytes())
}

/// blake3 of these bytes, in hexadecimal.
pub(super) fn hash(bytes: &[u8]) -> String {
    blake3::hash(bytes).to_hex().to_string()
}

/// One text for equal inputs: keys sorted, no space, shortest digits that read back to the same bits.
#[must_use]
pub fn canonical(inputs: &Value) -> String {
    // The JSON crate keeps keys sorted unless it is built with another map, and a test holds that it is not.
    inputs.to_string()
}

/// A leaf in which two inputs differ.
#[derive(Debug, Clone, PartialEq)]
pub struct Change {
    /// Keys and indices from the root, `["assumptions", "stop_length"]`.
    pub path: Vec<String>,
    /// As it was; `None` if it was not there.
    pub old: Option<Value>,
    /// As it is; `None` if it has gone.
    pub new: Option<Value>,
}

/// Every leaf below `key` in which `new` departs from `old`, in the order of the keys.
#[must_use]
pub fn changes(key: &str, old: Option<&Value>, new: Option<&Value>) -> Vec<Change> {
    let mut found = Vec::new();
    compare(&mut vec![key.to_owned()], old, new, &mut found);
    found
}

fn compare(path: &mut Vec<String>, old: Option<&Value>, new: Option<&Value>, found: &mut Vec<Change>) {
    let mut descend = |key: String, old: Option<&Value>, new: Option<&Value>| {
        path.push(key);
        compare(path, old, new, found);
        path.pop();
    };
    match (old, new) {
        _ if old == new => {}
        (Some(Value::Object(old)), Some(Value::Object(new))) => {
            for key in old.keys().chain(new.keys()).collect::<BTreeSet<_>>() {
                descend(key.clone(), old.get(key), new.get(key));
            }
        }
        (Some(Value::Array(old)), Some(Value::Array(new))) => {
            let common = old.len().min(new.len());
            let ahead = old.iter().zip(new).take_while(|(old, new)| old == new).count();
            let behind = old.iter().rev().zip(new.iter().rev()).take_while(|(old, new)| old == new).count();
            if ahead + behind >= common {
                // Items were put in or taken out, and the others only have other numbers.
                for index in ahead..ahead + old.len() - common {
                    descend(index.to_string(), old.get(index), None);
                }
                for index in ahead..ahead + new.len() - common {
                    descend(index.to_string(), None, new.get(index));
                }
                return;
            }
            for index in 0..old.len().max(new.len()) {
                descend(index.to_string(), old.get(index), new.get(index));
            }
        }
        _ => found.push(Change { path: path.clone(), old: old.cloned(), new: new.cloned() }),
    }
}
