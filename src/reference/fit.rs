//! How well a whole curve or shape agrees, in one number with its limit: what a report shows beside a value's comparison.

use serde::{Deserialize, Serialize};

/// A curve or shape held against a published or analytic one.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Fit {
    /// What it was held against: `cantilever, mode 2`.
    pub against: String,
    /// What is measured.
    pub measure: FitMeasure,
    /// How many points were compared.
    pub points: usize,
    /// The number that came out.
    pub value: f64,
    /// Its own uncertainty.
    pub u: f64,
    /// The number that it must not pass.
    pub limit: f64,
    /// Where the departure is largest, or which other shape comes nearest.
    pub remark: String,
}

/// The number in which an agreement is told, and on which side of its limit it has to be.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum FitMeasure {
    /// Largest departure in widths of the tube: at most 1.
    TubeWidths,
    /// Modal assurance criterion, at least its limit: the shapes are the same.
    MacAtLeast,
    /// Modal assurance criterion, at most its limit: the shapes are different.
    MacAtMost,
}
