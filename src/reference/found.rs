//! What an entry reads under one variant of the assumptions, without a verdict.

use super::decide::decide;
use super::entry::{Check, Entry};
use super::tally::Outcome;
use super::view::{Reads, Tables, View};

/// What came out for an entry.
#[derive(Debug, Clone, PartialEq)]
pub enum Found {
    /// A number beside the published one, in the same unit.
    Number {
        /// What came out.
        simulated: f64,
        /// What is published.
        published: f64,
    },
    /// A claim that holds, or does not.
    Claim {
        /// It holds, by more than its uncertainty.
        holds: bool,
    },
    /// Nothing, and why.
    Nothing(String),
}

impl Entry {
    /// What this entry of `experiment` reads where the table's column `variant` says so.
    #[must_use]
    pub fn found(&self, experiment: &str, tables: &Tables<'_>, variant: &str) -> Found {
        let reads = Reads::default();
        let view = View { tables, home: experiment, variant, given: self.rows.clone(), reads: &reads };
        match &self.check {
            Check::Value { published, from, .. } => match from.take(&view) {
                Ok(simulated) => match published.converted_to(&simulated.unit) {
                    Some((published, _)) => Found::Number { simulated: simulated.value, published },
                    None => Found::Nothing(format!("`{}` is of another unit", published.text())),
                },
                Err(absence) => Found::Nothing(absence.reason().into()),
            },
            Check::Claim { predicate, .. } => match decide(predicate, &view) {
                Ok(decision) => Found::Claim { holds: decision.outcome == Outcome::Holds },
                Err(absence) => Found::Nothing(absence.reason().into()),
            },
            Check::Peak { .. } => Found::Nothing("the numbers of a resonance are not calibrated by".into()),
        }
    }
}
