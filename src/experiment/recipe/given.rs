//! What of a recipe assumptions stand for.
//!
//! A slot of a recipe is [`Given`]: stated, or the name of an assumption. [`Inputs`] turns it into its value and records the
//! name, so that what a scene depends on is what was read while it was resolved.

use std::cell::RefCell;
use std::collections::{BTreeMap, BTreeSet};

use serde::{Deserialize, Serialize};

use super::assumption::{AssumptionName, AssumptionValue};
use super::assumption_sheet::{ASSUMPTIONS, Assumptions};
use super::error::RecipeError;
use super::slot::Slot;
use crate::scene::{Curve, FieldValue, whole};
use crate::yaml::word::word_of;

/// A value that an experiment states, or the name of the assumption that stands for it.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Given<T = f64> {
    /// Stated; a number is SI or dimensionless.
    Stated(T),
    /// By assumption.
    Assumed(AssumptionName),
}

impl<T> From<T> for Given<T> {
    fn from(value: T) -> Self {
        Self::Stated(value)
    }
}

/// What an assumption can stand for.
pub trait Assumable: Clone {
    /// The value that this assumption stands for; nothing if it is of another kind.
    fn of(value: &AssumptionValue) -> Option<Self>;
}

impl Assumable for f64 {
    fn of(value: &AssumptionValue) -> Option<Self> {
        if let AssumptionValue::Number(number) = value { Some(*number) } else { None }
    }
}

impl Assumable for Curve {
    fn of(value: &AssumptionValue) -> Option<Self> {
        if let AssumptionValue::Curve(curve) = value { Some(curve.clone()) } else { None }
    }
}

/// Places that an assumption lists.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct PlaceList(pub Vec<Vec<f64>>);

impl Assumable for PlaceList {
    fn of(value: &AssumptionValue) -> Option<Self> {
        if let AssumptionValue::Places(places) = value { Some(Self(places.clone())) } else { None }
    }
}

impl Assumable for FieldValue {
    fn of(value: &AssumptionValue) -> Option<Self> {
        match value {
            AssumptionValue::Number(number) => Some(Self::Number(*number)),
            AssumptionValue::Choice(word) => Some(Self::Word(word.clone())),
            AssumptionValue::Curve(_) | AssumptionValue::Places(_) => None,
        }
    }
}

/// A number of modes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Count(pub u32);

impl Assumable for Count {
    fn of(value: &AssumptionValue) -> Option<Self> {
        if let AssumptionValue::Number(number) = value { whole(*number).ok().map(Self) } else { None }
    }
}

/// The assumptions in force while a recipe is resolved, with a record of those that were read.
#[derive(Debug)]
pub(super) struct Inputs<'a> {
    values: &'a BTreeMap<AssumptionName, AssumptionValue>,
    read: RefCell<BTreeSet<AssumptionName>>,
}

impl<'a> Inputs<'a> {
    pub(super) fn new(assumptions: &'a Assumptions) -> Self {
        Self { values: &assumptions.values, read: RefCell::default() }
    }

    /// What was read.
    pub(super) fn read(self) -> BTreeSet<AssumptionName> {
        self.read.into_inner()
    }

    /// The value of a slot.
    ///
    /// # Errors
    /// If its assumption is absent, or of another kind.
    pub(super) fn get<T: Assumable>(&self, given: &Given<T>) -> Result<T, RecipeError> {
        match given {
            Given::Stated(value) => Ok(value.clone()),
            Given::Assumed(name) => {
                if !self.read.borrow().contains(name) {
                    self.read.borrow_mut().insert(name.clone());
                }
                let value = self.values.get(name).and_then(T::of);
                value.ok_or_else(|| RecipeError::Assumption(name.clone()))
            }
        }
    }

    /// The value of a slot that the scene needs although its file need not name it.
    ///
    /// # Errors
    /// If there is none: what needs it, and where it belongs.
    pub(super) fn needed<T: Assumable>(
        &self,
        given: Option<&Given<T>>,
        slot: Slot,
        needs: &str,
    ) -> Result<T, RecipeError> {
        let missing = || {
            let word = word_of(slot);
            RecipeError::out_of_range(format!(
                "{needs} `{word}`, the {}: write it beside what needs it, or declare an assumption for it under `defaults: {word}` in \
                 {ASSUMPTIONS}",
                slot.about()
            ))
        };
        self.get(given.ok_or_else(missing)?)
    }
}
