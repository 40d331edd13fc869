//! Cases: the points of a sweep.

use serde::{Deserialize, Serialize};

use super::range::rounded;
use super::recipe::{Parameter, ParameterValue};
use crate::measure::SolverChoice;
use crate::yaml::word::word_of;

/// One point of the sweep. A parameter that a union of sweeps leaves out of this point is absent.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct Case {
    /// Values by parameter, in the order of [`super::Experiment::swept`].
    pub values: Vec<(Parameter, ParameterValue)>,
    /// The name of the sweep within a union; empty otherwise.
    pub sweep: String,
    /// The way in which the rows of a continued sweep follow each other.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub direction: Option<Direction>,
    /// The solvers it runs under: those of the experiment, unless its named sweep has its own.
    pub solvers: Vec<SolverChoice>,
}

impl Case {
    /// The value that this case gives to `parameter`, if it sets it.
    #[must_use]
    pub fn get(&self, parameter: Parameter) -> Option<ParameterValue> {
        self.values.iter().find(|(name, _)| *name == parameter).map(|(_, value)| *value)
    }

    /// The same as a number, ∞ where it is `infinite`; `None` of a word too.
    #[must_use]
    pub fn number(&self, parameter: Parameter) -> Option<f64> {
        match self.get(parameter)? {
            ParameterValue::Number(x) => Some(x),
            ParameterValue::Infinite => Some(f64::INFINITY),
            _ => None,
        }
    }

    /// The same with another number for a parameter that it has, to 13 digits, as all points of a sweep are.
    #[must_use]
    pub(crate) fn with(&self, parameter: Parameter, number: f64) -> Self {
        let mut case = self.clone();
        let own = case.values.iter_mut().filter(|(name, _)| *name == parameter);
        own.for_each(|(_, value)| *value = ParameterValue::Number(rounded(number)));
        case
    }

    /// In words: `gap_ratio = 50, stop = with`; empty when nothing is swept.
    #[must_use]
    pub fn describe(&self) -> String {
        let description = self.values.iter().map(|(parameter, value)| {
            let value = match value {
                ParameterValue::Number(number) => format!("{number} {}", parameter.unit()),
                other => word_of(*other),
            };
            format!("{} = {}", word_of(*parameter), value.trim_end())
        });
        let direction = self.direction.map(|direction| format!("direction = {}", word_of(direction)));
        description.chain(direction).collect::<Vec<_>>().join(", ")
    }
}

/// The cases of a sweep that differ in this parameter alone, by their index, in the order of their first ones.
pub(super) fn differing_in(cases: &[Case], sweep: &str, over: Parameter) -> Vec<Vec<usize>> {
    let others = |case: &Case| -> Vec<ParameterValue> {
        case.values.iter().filter(|(parameter, _)| *parameter != over).map(|(_, value)| *value).collect()
    };
    let mut keys = Vec::new();
    let mut found: Vec<Vec<usize>> = Vec::new();
    for (index, case) in cases.iter().enumerate().filter(|(_, case)| case.sweep == sweep && case.get(over).is_some()) {
        let key = (case.direction, others(case));
        match keys.iter().position(|known| *known == key) {
            Some(place) => found[place].push(index),
            None => {
                keys.push(key);
                found.push(vec![index]);
            }
        }
    }
    found
}

/// The way that rows follow each other.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Direction {
    /// From the smallest value of the parameter to the largest.
    Up,
    /// From the largest to the smallest.
    Down,
}
