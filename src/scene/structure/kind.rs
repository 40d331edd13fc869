//! Kinds of structure: the keys that one has in YAML, and how their values become a model.
//!
//! The tables here are all that reading and sweeping know of a structure.

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};

use super::Structure;

/// A kind of structure.
#[derive(Debug)]
pub struct Kind {
    /// The word in YAML.
    pub name: &'static str,
    /// With its article, for messages: `a cantilever beam`.
    pub what: &'static str,
    /// Keys, in the order in which they are read.
    pub fields: &'static [Field],
    /// Words for its sides, in the order of the coordinates of a place.
    pub sides: &'static [&'static str],
    /// Where its motion is observed unless the file says so, shares of its sides; none for the nine-point grid.
    pub performance_point: Option<&'static [f64]>,
    /// From values to the model.
    pub build: fn(&Values<'_>) -> Result<Structure, StructureError>,
}

impl Kind {
    /// The kind of this name.
    #[must_use]
    pub fn named(name: &str) -> Option<&'static Self> {
        super::KINDS.iter().find(|kind| kind.name == name).copied()
    }

    /// It is one mass at one place: no sides, and no modes of which one could be meant.
    #[must_use]
    pub fn is_lumped(&self) -> bool {
        self.sides.is_empty()
    }
}

/// Why values make no structure.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("{message}")]
pub struct StructureError {
    /// The key whose value is refused.
    pub key: Option<&'static str>,
    /// What is wrong with it.
    pub message: String,
}

impl StructureError {
    pub(super) fn of(key: &'static str, message: impl Into<String>) -> Self {
        Self { key: Some(key), message: message.into() }
    }
}

/// A key of a structure.
#[derive(Debug)]
pub struct Field {
    /// The word in YAML.
    pub key: &'static str,
    /// What it takes.
    pub form: Form,
    /// A sweep may vary it, by the same word.
    pub swept: bool,
}

/// What a key of a structure takes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Form {
    /// m, above zero.
    Length,
    /// kg, above zero.
    Mass,
    /// N/m, zero or more.
    Stiffness,
    /// Pa, above zero.
    Stress,
    /// kg/m³, above zero.
    Density,
    /// Zero or more, without unit.
    Ratio,
    /// Number of modes: one number, or one a side.
    Modes,
    /// One of these words; the first unless the file says so.
    Word(&'static [&'static str]),
}

/// The value of a key.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum FieldValue {
    /// SI.
    Number(f64),
    /// One number for all sides, or one a side.
    Counts(Vec<u32>),
    /// A word.
    Word(String),
}

/// A whole number above zero.
///
/// # Errors
/// If it is none.
pub fn whole(value: f64) -> Result<u32, StructureError> {
    if (1.0..=1e6).contains(&value) && value.fract() == 0.0 {
        return Ok(value as u32);
    }
    Err(StructureError { key: None, message: format!("a whole number above zero is wanted, not {value}") })
}

/// The values of a structure's keys, for its model.
#[derive(Debug)]
pub struct Values<'a> {
    /// The kind of the structure.
    pub kind: &'static Kind,
    /// Values by key.
    pub values: &'a BTreeMap<String, FieldValue>,
}

impl Values<'_> {
    fn get(&self, key: &'static str) -> Result<&FieldValue, StructureError> {
        let value = self.values.get(key);
        value.ok_or_else(|| StructureError::of(key, format!("`{}` lacks `{key}`", self.kind.name)))
    }

    /// A number above zero.
    ///
    /// # Errors
    /// If it is absent, or not above zero.
    pub fn above_zero(&self, key: &'static str) -> Result<f64, StructureError> {
        match self.number(key)? {
            value if value > 0.0 && value.is_finite() => Ok(value),
            value => Err(StructureError::of(key, format!("{key} must be above 0, not {value}"))),
        }
    }

    /// A number that is not negative.
    ///
    /// # Errors
    /// If it is absent, or negative.
    pub fn ratio(&self, key: &'static str) -> Result<f64, StructureError> {
        match self.number(key)? {
            value if value >= 0.0 && value.is_finite() => Ok(value),
            value => Err(StructureError::of(key, format!("{key} must be 0 or more, not {value}"))),
        }
    }

    /// Any number.
    ///
    /// # Errors
    /// If it is absent.
    pub fn number(&self, key: &'static str) -> Result<f64, StructureError> {
        match self.get(key)? {
            FieldValue::Number(value) => Ok(*value),
            _ => Err(StructureError::of(key, format!("{key} must be a number"))),
        }
    }

    /// Numbers of modes, one a side.
    ///
    /// # Errors
    /// If it is absent, zero, not as many as there are sides, or more than `most` in all.
    pub fn modes<const SIDES: usize>(&self, most: u32, why: &str) -> Result<[u32; SIDES], StructureError> {
        let refuse = |message: String| Err(StructureError::of("modes", message));
        let counts = match self.get("modes")? {
            FieldValue::Counts(counts) => counts.clone(),
            _ => vec![whole(self.number("modes")?)?],
        };
        let counts: [u32; SIDES] = match counts.as_slice() {
            [one] => [*one; SIDES],
            each => match each.try_into() {
                Ok(counts) => counts,
                Err(_) => return refuse(format!("modes are counted along {SIDES} side(s), not {}", each.len())),
            },
        };
        if counts.contains(&0) {
            return refuse("a structure without modes does not move: give it one at least".into());
        }
        let all = counts.iter().map(|count| u64::from(*count)).product::<u64>();
        if all > u64::from(most) {
            return refuse(format!("{all} modes are more than {most}: {why}"));
        }
        Ok(counts)
    }

    /// A word, by its place among the words of its key.
    ///
    /// # Errors
    /// If it is no such word.
    pub fn word(&self, key: &'static str, words: &[&str]) -> Result<usize, StructureError> {
        match self.values.get(key) {
            None => Ok(0),
            Some(FieldValue::Word(word)) => words
                .iter()
                .position(|known| known == word)
                .ok_or_else(|| StructureError::of(key, format!("{key} is not `{word}`"))),
            Some(_) => Err(StructureError::of(key, format!("{key} is one of {}", words.join(", ")))),
        }
    }
}
