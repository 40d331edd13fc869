//! Variants: the same experiment with one assumption moved to an end of its range.
//!
//! They say how much a published number depends on what the study leaves unstated (u_input of a comparison).

use crate::scene::{Assumption, Assumptions};

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

impl Variant {
    /// The assumptions as the file gives them.
    #[must_use]
    pub fn baseline(assumptions: Assumptions) -> Self {
        Self { label: crate::table::BASELINE.into(), moved: None, assumptions }
    }
}
