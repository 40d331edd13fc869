//! Entries: one published number or claim each, with its place in the source.
//!
//! ```yaml
//! # reference/ch3/ch3-forcing-amplitude.yaml
//! entries:
//!   - id: optimum
//!     place: s. 3.6.4, Fig. 19
//!     says: The velocity ratio is largest at f′ = 2.5.
//!     value: "2.5"                      # digits as printed: half a unit of the last one is its uncertainty
//!     from: {argmax: {of: velocity_ratio, over: force_ratio}}
//!   - id: falls-beyond
//!     place: s. 3.6.4
//!     says: Beyond the optimum the velocity ratio decreases.
//!     claim: {monotone: {of: velocity_ratio, over: force_ratio, direction: decreasing, part: after_maximum, slack: 0.02}}
//!     threshold_reason: Chaotic points scatter by a per cent or two.
//!   - id: first-resonance
//!     place: s. 4.3.1, Fig. 33
//!     says: The clean beam has a natural frequency at 26 rad/s.
//!     where: {sweep: clean}
//!     peak: {of: displacement_per_force, over: angular_frequency, at: 26 rad/s}
//!   - id: second-mode
//!     place: s. 4.3.2, Fig. 36
//!     says: The second mode shape of a cantilever.
//!     where: {mode: 2}
//!     mode_shape: {of: shape, over: x, like: {cantilever: 2}, mac: {at_least: 0.999}}
//!     threshold_reason: Lines that differ by a thirtieth of their size lie on each other.
//! not_judged:
//!   - place: s. 3.6.1, Fig. 13
//!     says: Both ratios agree well with those of an earlier study.
//!     reason: The curves of the figure are lost.
//! ```

use std::collections::BTreeSet;

use serde::Serialize;

use super::extraction::Extraction;
use super::mapping::{KnownTables, Seen, mapping};
use super::predicate::Predicate;
use super::printed::Printed;
use super::prose::Prose;
use super::resonance::PrintedPeak;
use super::selection::Selection;
use super::verdict::Verdict;
use super::view::Source;
use crate::text::json;
use crate::yaml::{Findings, Problems};

/// The entries of one experiment.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct ReferenceFile {
    /// Id of the experiment whose table they read, from the file's name.
    pub experiment: String,
    /// In the order of the file.
    pub entries: Vec<Entry>,
    /// What the study says beside these and nothing here can judge.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub not_judged: Vec<NotJudged>,
}

mapping! {
    "a statement that is not judged" NotJudged {
        place: String = required("Where it stands: `s. 3.6.1, Fig. 13`", |at| at.text()),
        says: String = required("What the study says, in one line", |at| at.text()),
        reason: String = required("Why no entry can judge it", |at| at.text()),
    }
}

/// One published number or claim.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Entry {
    /// `ch3-forcing-amplitude/optimum`.
    pub id: String,
    /// Where it stands: `s. 3.6.4, Fig. 19`.
    pub place: String,
    /// What the study says, in one line.
    pub says: String,
    /// How it is checked.
    pub check: Check,
    /// The rows that it speaks of.
    pub rows: Selection,
    /// The verdict that is expected, never [`Verdict::Missing`].
    pub expected: Verdict,
    /// Why, where that is not [`Verdict::Reproduced`]; otherwise a note, or empty. With placeholders, see [`Prose`].
    pub explanation: String,
    /// Inputs that the study does not give and without which a claim cannot be judged.
    pub blocked_by: Vec<String>,
    /// The line of the file on which it starts, counted from 1; no part of what it means.
    #[serde(skip)]
    pub line: u64,
}

/// How an entry is checked.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Check {
    /// A number.
    Value {
        /// As printed.
        published: Printed,
        /// Its counterpart in the table.
        from: Extraction,
        /// Instead of the derived one.
        tolerance: Option<Tolerance>,
    },
    /// The numbers of a resonance.
    Peak {
        /// As printed.
        peak: PrintedPeak,
        /// Instead of the derived ones.
        tolerance: Option<Tolerance>,
    },
    /// A claim in words, or a curve or shape.
    Claim {
        /// The claim.
        predicate: Predicate,
        /// Why its thresholds are what they are; empty if it has none.
        threshold_reason: String,
    },
}

/// A tolerance set by hand.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Tolerance {
    /// How much.
    pub size: ToleranceSize,
    /// Why.
    pub reason: String,
}

/// The size of a tolerance.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum ToleranceSize {
    /// Fraction of the published value.
    Relative(f64),
    /// In the unit in which the value is printed.
    Absolute(f64),
}

impl ReferenceFile {
    /// Looks for the experiments and the columns that its entries name.
    ///
    /// # Errors
    /// Every one that is not there, with its place in the `text` that the entries were read from.
    pub(crate) fn check_tables(&self, file: &str, text: &str, tables: &KnownTables<'_>) -> Result<(), Problems> {
        let findings = Findings::default();
        for entry in &self.entries {
            Seen::of(&entry.rows).check(&self.experiment, tables, &findings);
            entry.seen().check(&self.experiment, tables, &findings);
        }
        findings.finish(file, text, Some(()))
    }

    /// The other experiments whose tables the entries read.
    #[must_use]
    pub fn other_tables(&self) -> BTreeSet<String> {
        let tables = |entry: &Entry| -> Vec<String> {
            entry.sources().iter().filter_map(|source| source.table.map(String::from)).collect()
        };
        self.entries.iter().flat_map(tables).filter(|id| *id != self.experiment).collect()
    }
}

/// Rows that an entry reads.
#[derive(Debug, Clone, PartialEq)]
pub struct Reading {
    /// The experiment whose table it is.
    pub experiment: String,
    /// The rows: those of a line, a map or a list, of which the entry picks for itself.
    pub rows: Selection,
    /// Of a line only what lies around this value of this parameter, if it is read between two points.
    pub around: Option<(String, Printed)>,
}

impl Entry {
    /// The explanation with its placeholders.
    #[must_use]
    pub fn prose(&self) -> Prose {
        // Validation has read it; one written by `check --accept` has no placeholder.
        Prose::parse(&self.explanation).unwrap_or_default()
    }

    /// All that it reads, as an entry of `experiment`.
    #[must_use]
    pub fn readings(&self, experiment: &str) -> Vec<Reading> {
        let around = match &self.check {
            Check::Value { from: Extraction::Interpolated(word), .. } => Some((word.over.to_string(), word.at.clone())),
            _ => None,
        };
        let reading = |source: &Source<'_>| {
            let id = source.table.unwrap_or(experiment);
            let rows = if id == experiment { self.rows.and(source.rows) } else { source.rows.clone() };
            Reading { experiment: id.into(), rows, around: around.clone() }
        };
        self.sources().iter().map(reading).collect()
    }

    /// True if it tells solvers apart; otherwise it reads the event-driven rows, where there are any.
    #[must_use]
    pub fn names_solver(&self) -> bool {
        self.rows.0.contains_key("solver") || json::line(&self.check).contains("\"solver\"")
    }

    fn sources(&self) -> Vec<Source<'_>> {
        match &self.check {
            Check::Peak { .. } => vec![Source { table: None, rows: &self.rows }],
            Check::Value { .. } | Check::Claim { .. } => self.seen().sources(),
        }
    }

    /// What its check reads.
    fn seen(&self) -> Seen<'_> {
        match &self.check {
            Check::Value { from, .. } => Seen::of(from),
            Check::Peak { peak, .. } => Seen::of(peak),
            Check::Claim { predicate, .. } => Seen::of(predicate),
        }
    }
}
