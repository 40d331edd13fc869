//! The structure of a recipe: values by key, of which any may stand for an assumption.

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};

use super::error::RecipeError;
use super::given::{Count, Given, Inputs};
use super::parameter::Parameter;
use crate::scene::{FieldValue, Form, Kind, Structure, Values, whole};
use crate::yaml::word::word_of;

/// A structure as an experiment names it; in JSON as in YAML, `{kind: {key: value}}`.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(into = "Tagged", try_from = "Tagged")]
pub struct StructureRecipe {
    /// Name of its kind.
    pub kind: String,
    /// Values by key.
    pub values: BTreeMap<String, Given<FieldValue>>,
}

type Tagged = BTreeMap<String, BTreeMap<String, Given<FieldValue>>>;

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
        let value = |(key, x): (&str, f64)| (key.to_owned(), Given::Stated(FieldValue::Number(x)));
        Self { kind: "single_mass".into(), values: values.into_iter().map(value).collect() }
    }

    /// Its kind.
    ///
    /// # Errors
    /// [`RecipeError::OutOfRange`] for a name that is none.
    pub fn kind(&self) -> Result<&'static Kind, RecipeError> {
        Kind::named(&self.kind)
            .ok_or_else(|| RecipeError::out_of_range(format!("there is no structure `{}`", self.kind)))
    }

    /// Gives the key that `parameter` varies another value; false if it has no such key.
    pub(super) fn set(&mut self, parameter: Parameter, value: f64) -> Result<bool, RecipeError> {
        let word = word_of(parameter);
        let Some(field) = self.kind()?.fields.iter().find(|field| field.swept && field.key == word) else {
            return Ok(false);
        };
        let value = match field.form {
            Form::Modes => FieldValue::Counts(vec![whole(value)?]),
            _ => FieldValue::Number(value),
        };
        self.values.insert(word, value.into());
        Ok(true)
    }

    /// The model.
    pub(super) fn build(&self, inputs: &Inputs<'_>) -> Result<Structure, RecipeError> {
        let kind = self.kind()?;
        let mut values = BTreeMap::new();
        for field in kind.fields {
            let Some(given) = self.values.get(field.key) else { continue };
            let value = match (given, field.form) {
                (Given::Assumed(name), Form::Modes) => {
                    FieldValue::Counts(vec![inputs.get::<Count>(&Given::Assumed(name.clone()))?.0])
                }
                _ => inputs.get(given)?,
            };
            values.insert(field.key.to_owned(), value);
        }
        Ok((kind.build)(&Values { kind, values: &values })?)
    }
}
