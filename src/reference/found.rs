//! What an entry reads under one variant of the assumptions, without a verdict.

use super::compare::telling;
use super::decide::decide;
use super::entry::{Check, Entry, ToleranceSize};
use super::extraction::Extraction;
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
        /// Standard deviation of the ensemble, where there is one.
        spread: f64,
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
    /// The widest error, as a share of the published value, of an agreement that says something: W of V&V 20 as it is used here, or a
    /// tolerance set by hand. None for a claim, and for an instant, whose scale lies in its table.
    #[must_use]
    pub fn telling(&self) -> Option<f64> {
        let Check::Value { published, from, tolerance } = &self.check else { return None };
        let size = published.value().abs();
        match (tolerance, from) {
            (_, Extraction::NearestPassage(word)) if word.read.is_none() => None,
            (Some(tolerance), _) => Some(match tolerance.size {
                ToleranceSize::Relative(share) => share,
                ToleranceSize::Absolute(distance) => distance / size,
            }),
            (None, _) => Some(telling(published.half_unit(), size) / size),
        }
    }

    /// What this entry of `experiment` reads where the table's column `variant` says so.
    #[must_use]
    pub fn found(&self, experiment: &str, tables: &Tables<'_>, variant: &str) -> Found {
        let reads = Reads::default();
        let view = View { tables, home: experiment, variant, given: self.rows.clone(), reads: &reads };
        match &self.check {
            Check::Value { published, from, .. } => match from.take(&view) {
                Ok(simulated) => match published.converted_to(&simulated.unit) {
                    Some((published, _)) => {
                        Found::Number { simulated: simulated.value, published, spread: simulated.spread }
                    }
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
