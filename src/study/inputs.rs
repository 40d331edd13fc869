//! What something was made from, part by part. A part is kept as its canonical JSON text: that two are equal is seen without
//! reading either, and only those that differ are read to say where.
//! The JSON crate keeps keys sorted and writes the shortest digits, so that equal inputs have one text.

use std::collections::{BTreeMap, BTreeSet};

use serde::{Deserialize, Serialize};
use serde_json::Value;
use serde_json::value::{RawValue, to_raw_value};

use super::canonical::{Change, changes, hash};
use crate::text::json;

/// The parts by name.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
#[serde(transparent)]
pub struct Inputs(BTreeMap<String, Part>);

#[derive(Debug, Clone, Serialize, Deserialize)]
#[serde(transparent)]
struct Part(Box<RawValue>);

impl PartialEq for Part {
    fn eq(&self, other: &Self) -> bool {
        self.0.get() == other.0.get()
    }
}

impl Part {
    fn of(value: &Value) -> Self {
        Self(to_raw_value(value).unwrap_or_else(|error| unreachable!("a JSON value has a text: {error}")))
    }

    fn value(&self) -> Value {
        serde_json::from_str(self.0.get()).unwrap_or_else(|error| unreachable!("it was read as JSON: {error}"))
    }
}

impl Inputs {
    /// These parts.
    #[must_use]
    pub fn of<const N: usize>(parts: [(&str, Value); N]) -> Self {
        Self(parts.into_iter().map(|(name, value)| (name.to_owned(), Part::of(&value))).collect())
    }

    /// blake3 of all parts as one canonical JSON text, in hexadecimal.
    #[must_use]
    pub fn fingerprint(&self) -> String {
        hash(json::line(self).as_bytes())
    }

    /// True if these parts are the same in both.
    #[must_use]
    pub fn agree_in(&self, other: &Self, parts: &[&str]) -> bool {
        parts.iter().all(|part| self.0.get(*part) == other.0.get(*part))
    }

    /// Every leaf in which `new` departs from this, in the order of the keys; the first key is the part's.
    #[must_use]
    pub fn changes_to(&self, new: &Self) -> Vec<Change> {
        let names: BTreeSet<&String> = self.0.keys().chain(new.0.keys()).collect();
        let of_part = |name: &String| {
            let (old, new) = (self.0.get(name), new.0.get(name));
            if old == new {
                return Vec::new();
            }
            let [old, new] = [old, new].map(|part| part.map(Part::value));
            changes(name, old.as_ref(), new.as_ref())
        };
        names.into_iter().flat_map(of_part).collect()
    }
}
