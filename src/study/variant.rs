//! Variants: the same experiment with one assumption moved to an end of its range.
//!
//! They say how much a published number depends on what the study leaves unstated (u_input of a comparison).

use std::collections::BTreeSet;

use crate::experiment::{AssumptionSheet, Experiment};
use crate::scene::{Assumption, Assumptions};
use crate::table::BASELINE;

/// One set of assumptions under which an experiment runs.
#[derive(Debug, Clone, PartialEq)]
pub struct Variant {
    /// As the table's `variant` column holds it: `baseline`, `stop_length=0.05`.
    pub label: String,
    /// The assumption that was moved; `None` for the baseline.
    pub moved: Option<Assumption>,
    /// All values in force.
    pub assumptions: Assumptions,
}

/// Whether the ends of the assumptions are run as well.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Sensitivity {
    /// Yes: a published value is held against the result, and its uncertainty needs them.
    Wanted,
    /// No: the baseline says all that is asked.
    NotWanted,
}

/// The variants of an experiment that depends on the assumptions in `used`, the baseline first.
#[must_use]
pub fn variants(
    experiment: &Experiment,
    sheet: &AssumptionSheet,
    used: &BTreeSet<Assumption>,
    sensitivity: Sensitivity,
) -> Vec<Variant> {
    let baseline = sheet.assumptions();
    let mut variants = Vec::new();
    if sensitivity == Sensitivity::Wanted {
        let mut used = used.clone();
        if let Some(wanted) = &experiment.moved {
            used.retain(|name| wanted.contains(name));
        }
        for (label, assumptions) in sheet.variants(&used) {
            let moved = assumptions.values.iter().find(|(name, value)| baseline.values.get(name) != Some(value));
            let moved = moved.map(|(name, _)| *name);
            variants.push(Variant { label, moved, assumptions });
        }
    }
    variants.insert(0, Variant { label: BASELINE.into(), moved: None, assumptions: baseline });
    variants
}
