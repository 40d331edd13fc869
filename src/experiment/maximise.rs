//! The point that is looked for over a parameter in each row: the maximum of a measure, or its onset.

use serde::{Deserialize, Serialize};

use super::recipe::Parameter;
use crate::measure::Measure;
use crate::yaml::word::word_of;

/// Maximum of a measure over one parameter, or where it ceases to be zero.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Maximise {
    /// Of which measure.
    pub measure: Measure,
    /// Over which parameter.
    pub over: Parameter,
    /// The grid.
    pub grid: Vec<f64>,
    /// Points added around the best one, round by round, to sharpen the maximum.
    pub refine: u32,
    /// Which point is looked for.
    #[serde(default, skip_serializing_if = "SearchPoint::is_maximum")]
    pub wanted: SearchPoint,
}

/// A point that is looked for over a parameter.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum SearchPoint {
    /// Where the measure is largest.
    #[default]
    Maximum,
    /// From where on it is above zero: the first event of a kind.
    Onset,
}

impl SearchPoint {
    fn is_maximum(&self) -> bool {
        *self == Self::Maximum
    }

    /// How the name of the column ends that says where the point lies.
    fn ending(self) -> String {
        format!("_at_{}", word_of(self))
    }

    /// True for the name of a column that says where a point lies.
    pub(crate) fn is_place(column: &str) -> bool {
        [Self::Maximum, Self::Onset].into_iter().any(|point| column.ends_with(&point.ending()))
    }
}

impl Maximise {
    /// The column that says where the point lies: `force_ratio_at_maximum`.
    pub(crate) fn column(&self) -> String {
        word_of(self.over) + &self.wanted.ending()
    }

    /// Points that are looked at, at most.
    pub(crate) fn points(&self) -> u64 {
        self.grid.len() as u64 + self.points_after_grid()
    }

    /// Points that are looked at after the grid, at most.
    pub(crate) fn points_after_grid(&self) -> u64 {
        match self.wanted {
            SearchPoint::Maximum => 2 * MOST_PEAKS as u64 * u64::from(self.refine),
            SearchPoint::Onset => MOST_BISECTIONS,
        }
    }
}

/// Peaks of a grid that a maximum is looked for at, the highest: a low one may hide a higher one between its points.
pub(crate) const MOST_PEAKS: usize = 5;

/// Bisections that bring any interval below the distance of two numbers that an onset is known by.
const MOST_BISECTIONS: u64 = 60;
