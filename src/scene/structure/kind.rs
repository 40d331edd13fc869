//! Kinds of structure: the keys that one has in YAML, and how their values become a model.
//!
//! The tables here are all that reading and sweeping know of a structure.

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};

use super::Structure;
use crate::scene::{Assumption, Assumptions, Parameter, RecipeError};

/// A kind of structure.
#[derive(Debug)]
pub struct Kind {
    /// The word in YAML.
    pub name: &'static str,
    /// With its article, for messages: `a cantilever beam`.
    pub what: &'static str,
    /// Which of the study's chapters it belongs with; assumptions differ by it.
    pub family: Family,
    /// Keys, in the order in which they are read.
    pub fields: &'static [Field],
    /// Words for its sides, in the order of the coordinates of a place.
    pub sides: &'static [&'static str],
    /// Where its motion is observed unless the file says so, shares of its sides; none for the nine-point grid.
    pub performance_point: Option<&'static [f64]>,
    /// From values to the model.
    pub build: fn(&Values<'_>) -> Result<Structure, RecipeError>,
}

/// Structures that share their assumptions.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Family {
    /// One mass (chapter 3).
    Mass,
    /// Beams (chapter 4).
    Beam,
    /// Plates (chapter 5).
    Plate,
}

/// A key of a structure.
#[derive(Debug)]
pub struct Field {
    /// The word in YAML.
    pub key: &'static str,
    /// What it takes.
    pub form: Form,
    /// The sweep parameter that varies it.
    pub parameter: Option<Parameter>,
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
    /// Number of modes: one number, or one a side; or this assumption.
    Modes(Assumption),
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
    /// Taken from the assumptions.
    Assumed(Assumption),
}

/// A structure as an experiment names it; in JSON as in YAML, `{kind: {key: value}}`.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(into = "Tagged", try_from = "Tagged")]
pub struct StructureRecipe {
    /// Name of its kind.
    pub kind: String,
    /// Values by key.
    pub values: BTreeMap<String, FieldValue>,
}

type Tagged = BTreeMap<String, BTreeMap<String, FieldValue>>;

impl From<StructureRecipe> for Tagged {
    fn from(recipe: StructureRecipe) -> Self {
        Self::from([(recipe.kind, recipe.values)])
    }
}

impl TryFrom<Tagged> for StructureRecipe {
    type Error = &'static str;

    fn try_from(tagged: Tagged) -> Result<Self, Self::Error> {
        let mut kinds = tagged.into_iter();
        match (kinds.next(), kinds.next()) {
            (Some((kind, values)), None) => Ok(Self { kind, values }),
            _ => Err("a structure is of one kind"),
        }
    }
}

impl StructureRecipe {
    /// One mass on a spring and a dashpot: kg, N/m, c′.
    #[must_use]
    pub fn single_mass(mass: f64, stiffness: f64, damping_ratio: f64) -> Self {
        let values = [("mass", mass), ("stiffness", stiffness), ("damping_ratio", damping_ratio)];
        Self {
            kind: super::single_mass::KIND.name.into(),
            values: values.into_iter().map(|(key, x)| (key.into(), FieldValue::Number(x))).collect(),
        }
    }

    /// Its kind.
    ///
    /// # Errors
    /// [`RecipeError::OutOfRange`] for a name that is none.
    pub fn kind(&self) -> Result<&'static Kind, RecipeError> {
        super::KINDS
            .iter()
            .find(|kind| kind.name == self.kind)
            .copied()
            .ok_or_else(|| RecipeError::OutOfRange(format!("there is no structure `{}`", self.kind)))
    }

    /// Gives the key that `parameter` varies another value; false if it has no such key.
    pub(crate) fn set(&mut self, parameter: Parameter, value: f64) -> Result<bool, RecipeError> {
        let Some(field) = self.kind()?.fields.iter().find(|field| field.parameter == Some(parameter)) else {
            return Ok(false);
        };
        let value = match field.form {
            Form::Modes(_) => FieldValue::Counts(vec![whole(value)?]),
            _ => FieldValue::Number(value),
        };
        self.values.insert(field.key.into(), value);
        Ok(true)
    }

    /// The model.
    ///
    /// # Errors
    /// An assumption that is absent, or values that make no structure.
    pub fn build(&self, assumptions: &Assumptions) -> Result<Structure, RecipeError> {
        (self.kind()?.build)(&Values { recipe: self, assumptions })
    }

    /// The assumptions that its values name.
    pub(crate) fn assumed(&self) -> impl Iterator<Item = Assumption> {
        self.values.values().filter_map(|value| match value {
            FieldValue::Assumed(name) => Some(*name),
            _ => None,
        })
    }
}

/// A whole number above zero, from a sweep.
pub(in crate::scene) fn whole(value: f64) -> Result<u32, RecipeError> {
    if (1.0..=1e6).contains(&value) && value.fract() == 0.0 {
        return Ok(value as u32);
    }
    Err(RecipeError::OutOfRange(format!("a whole number above zero is wanted, not {value}")))
}

/// The values of a structure's keys, for its model.
#[derive(Debug)]
pub struct Values<'a> {
    recipe: &'a StructureRecipe,
    assumptions: &'a Assumptions,
}

impl Values<'_> {
    fn get(&self, key: &str) -> Result<&FieldValue, RecipeError> {
        let value = self.recipe.values.get(key);
        value.ok_or_else(|| RecipeError::structure(format!("`{}` lacks `{key}`", self.recipe.kind)))
    }

    /// A number above zero.
    ///
    /// # Errors
    /// If it is absent, or not above zero.
    pub fn above_zero(&self, key: &str) -> Result<f64, RecipeError> {
        match self.number(key)? {
            value if value > 0.0 && value.is_finite() => Ok(value),
            value => Err(RecipeError::structure(format!("{key} must be above 0, not {value}"))),
        }
    }

    /// A number that is not negative.
    ///
    /// # Errors
    /// If it is absent, or negative.
    pub fn ratio(&self, key: &str) -> Result<f64, RecipeError> {
        match self.number(key)? {
            value if value >= 0.0 && value.is_finite() => Ok(value),
            value => Err(RecipeError::structure(format!("{key} must be 0 or more, not {value}"))),
        }
    }

    /// Any number.
    ///
    /// # Errors
    /// If it is absent.
    pub fn number(&self, key: &str) -> Result<f64, RecipeError> {
        match self.get(key)? {
            FieldValue::Number(value) => Ok(*value),
            FieldValue::Assumed(name) => self.assumptions.number(*name),
            _ => Err(RecipeError::structure(format!("{key} must be a number"))),
        }
    }

    /// Numbers of modes, one a side.
    ///
    /// # Errors
    /// If it is absent, zero, not as many as there are sides, or more than `most` in all.
    pub fn modes<const SIDES: usize>(&self, most: u32, why: &str) -> Result<[u32; SIDES], RecipeError> {
        let refuse = |message: String| Err(RecipeError::structure(message));
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
    pub fn word(&self, key: &str, words: &[&str]) -> Result<usize, RecipeError> {
        match self.recipe.values.get(key) {
            None => Ok(0),
            Some(FieldValue::Word(word)) => words
                .iter()
                .position(|known| known == word)
                .ok_or_else(|| RecipeError::structure(format!("{key} is not `{word}`"))),
            Some(_) => Err(RecipeError::structure(format!("{key} is one of {}", words.join(", ")))),
        }
    }
}
