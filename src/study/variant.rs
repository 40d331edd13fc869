//! Variants: the same experiment with one assumption moved to an end of its range.
//!
//! They say how much a published number depends on what the study leaves unstated (u_input of a comparison).

use std::collections::BTreeSet;

use crate::experiment::{AssumptionName, AssumptionSheet, Assumptions, Experiment, Moved};
use crate::table::BASELINE;

/// One set of assumptions under which an experiment runs.
#[derive(Debug, Clone, PartialEq)]
pub struct Variant {
    /// As the table's `variant` column holds it: `baseline`, `stop_length=0.05`.
    pub label: String,
    /// The assumption that was moved; `None` for the baseline.
    pub moved: Option<AssumptionName>,
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

/// The variants of an experiment that uses these assumptions, the baseline first.
#[must_use]
pub fn variants(
    experiment: &Experiment,
    used: &BTreeSet<AssumptionName>,
    sheet: &AssumptionSheet,
    sensitivity: Sensitivity,
) -> Vec<Variant> {
    let mut variants = vec![Variant { label: BASELINE.into(), moved: None, assumptions: sheet.assumptions() }];
    if sensitivity == Sensitivity::Wanted {
        let mut used = used.clone();
        if let Some(wanted) = &experiment.moved {
            used.retain(|name| wanted.contains(name));
        }
        let moved = sheet.variants(&used).into_iter();
        variants.extend(moved.map(|Moved { label, name, assumptions }| Variant {
            label,
            moved: Some(name),
            assumptions,
        }));
    }
    variants
}
