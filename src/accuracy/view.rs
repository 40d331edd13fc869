//! What was measured of one experiment.

use super::measured::Accuracy;
use super::verdict_price::VerdictPrice;
use crate::study::Machine;

/// One experiment, measured.
#[derive(Debug, Clone, PartialEq)]
pub struct AccuracyView {
    /// Its id.
    pub id: String,
    /// Its title.
    pub title: String,
    /// Where times were taken.
    pub machine: Machine,
    /// What was measured.
    pub accuracy: Accuracy,
    /// The verdicts on it.
    pub entries: Vec<VerdictPrice>,
}
