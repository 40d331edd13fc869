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
use std::path::Path;

use serde::{Deserialize, Serialize};

use super::entry_mistake::EntryMistake;
use super::extraction::Extraction;
use super::mode_shape::ModeShape;
use super::predicate::Predicate;
use super::printed::Printed;
use super::problem::{ReferenceMistake, ReferenceProblem};
use super::prose::Prose;
use super::resonance::PrintedPeak;
use super::selection::Selection;
use super::tube::Curve;
use super::verdict::Verdict;
use super::view::Source;
use crate::experiment::{Spanned, from_yaml, position};

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

/// A statement of the study without an entry.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct NotJudged {
    /// Where it stands: `s. 3.6.1, Fig. 13`.
    pub place: String,
    /// What the study says, in one line.
    pub says: String,
    /// Why no entry can judge it.
    pub reason: String,
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
            Check::Value { from: Extraction::Interpolated(word), .. } => Some((word.over.clone(), word.at.clone())),
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
        self.rows.0.contains_key("solver")
            || serde_json::to_string(&self.check).is_ok_and(|text| text.contains("\"solver\""))
    }

    fn sources(&self) -> Vec<Source<'_>> {
        match &self.check {
            Check::Value { from, .. } => from.sources(),
            Check::Peak { .. } => vec![Source { table: None, rows: &self.rows }],
            Check::Claim { predicate, .. } => predicate.sources(),
        }
    }
}

/// Why a reference file cannot be used.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("{}", .problems.iter().map(|problem| format!("{file}: {problem}")).collect::<Vec<_>>().join("\n"))]
pub struct ReferenceError {
    /// The file, as it was named by the caller.
    pub file: String,
    /// All that is wrong, in the order of the file, each with line and column.
    pub problems: Vec<ReferenceProblem>,
}

/// Reads a reference file; its name is the id of its experiment.
///
/// # Errors
/// If it cannot be read or understood: every unsound entry is named.
pub fn load_reference(path: &Path) -> Result<ReferenceFile, ReferenceError> {
    let file = path.display().to_string();
    let fail = |problem| ReferenceError { file: file.clone(), problems: vec![problem] };
    let experiment = path.file_stem().and_then(|stem| stem.to_str()).unwrap_or_default();
    let text =
        std::fs::read_to_string(path).map_err(|error| fail(ReferenceMistake::Unreadable(error.to_string()).into()))?;
    parse_reference(experiment, &text).map_err(|problems| ReferenceError { file: file.clone(), problems })
}

/// Reads the text of a reference file.
///
/// # Errors
/// All that is wrong, each with line and column.
pub fn parse_reference(experiment: &str, text: &str) -> Result<ReferenceFile, Vec<ReferenceProblem>> {
    let raw: RawReference = from_yaml(text).map_err(|mistake| vec![mistake.into()])?;
    let mut problems = Vec::new();
    let mut ids = BTreeSet::new();
    let mut entries = Vec::new();
    for spanned in raw.entries {
        let (line, column) = position(&spanned);
        let name = spanned.value.id.clone();
        let mut found = Vec::new();
        if !ids.insert(name.clone()) {
            found.push(EntryMistake::SameId);
        }
        match spanned.value.validated(experiment) {
            Ok(entry) => entries.push(Entry { line, ..entry }),
            Err(more) => found.extend(more),
        }
        let problem = |mistake| {
            let mistake = ReferenceMistake::Entry { entry: name.clone(), mistake };
            ReferenceProblem { at: Some((line, column)), mistake }
        };
        problems.extend(found.into_iter().map(problem));
    }
    if entries.is_empty() && problems.is_empty() {
        problems.push(ReferenceProblem::on_line(1, ReferenceMistake::NoEntry));
    }
    for entry in &entries {
        let names = |name: &String| !name.contains('/') && !ids.contains(name);
        for name in entry.prose().placeholders().filter_map(|one| one.entry.clone()).filter(names) {
            let mistake = ReferenceMistake::Entry { entry: entry.id.clone(), mistake: EntryMistake::Placeholder(name) };
            problems.push(ReferenceProblem::on_line(entry.line, mistake));
        }
    }
    let mut not_judged = Vec::new();
    for spanned in raw.not_judged {
        let NotJudged { place, says, reason } = &spanned.value;
        if [place, says, reason].iter().any(|text| text.trim().is_empty()) {
            let at = Some(position(&spanned));
            problems.push(ReferenceProblem { at, mistake: ReferenceMistake::NotJudged });
        }
        not_judged.push(spanned.value);
    }
    if problems.is_empty() {
        Ok(ReferenceFile { experiment: experiment.into(), entries, not_judged })
    } else {
        Err(problems)
    }
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct RawReference {
    entries: Vec<Spanned<RawEntry>>,
    #[serde(default)]
    not_judged: Vec<Spanned<NotJudged>>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct RawEntry {
    id: String,
    place: String,
    says: String,
    value: Option<String>,
    from: Option<Extraction>,
    tolerance: Option<RawTolerance>,
    claim: Option<Predicate>,
    peak: Option<PrintedPeak>,
    curve: Option<Curve>,
    mode_shape: Option<ModeShape>,
    threshold_reason: Option<String>,
    #[serde(rename = "where", default)]
    rows: Selection,
    expected: Option<Verdict>,
    explanation: Option<String>,
    #[serde(default)]
    blocked_by: Vec<String>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct RawTolerance {
    relative: Option<f64>,
    absolute: Option<f64>,
    reason: String,
}

impl RawEntry {
    fn validated(self, experiment: &str) -> Result<Entry, Vec<EntryMistake>> {
        let mut wrong: Vec<EntryMistake> = Vec::new();
        let filled = |text: &Option<String>| text.as_ref().is_some_and(|text| !text.trim().is_empty());
        if self.id.is_empty() || !self.id.chars().all(|c| c.is_ascii_lowercase() || c.is_ascii_digit() || c == '-') {
            wrong.push(EntryMistake::BadId);
        }
        if self.place.trim().is_empty() || self.says.trim().is_empty() {
            wrong.push(EntryMistake::NoPlace);
        }
        let expected = self.expected.unwrap_or(Verdict::Reproduced);
        if expected == Verdict::Missing {
            wrong.push(EntryMistake::ExpectsMissing);
        }
        if expected != Verdict::Reproduced && !filled(&self.explanation) {
            wrong.push(EntryMistake::NoExplanation);
        }
        if let Err(error) = Prose::parse(self.explanation.as_deref().unwrap_or_default()) {
            wrong.push(EntryMistake::Explanation(error));
        }
        let is_number = self.value.is_some() || self.peak.is_some();
        if expected == Verdict::Blocked && self.blocked_by.is_empty() && !is_number {
            wrong.push(EntryMistake::NotBlockedBy);
        }
        if is_number && !self.blocked_by.is_empty() {
            wrong.push(EntryMistake::NumberBlockedBy);
        }
        let threshold_reason = self.threshold_reason.clone().unwrap_or_default().trim().to_string();
        let kinds = [
            self.value.is_some(),
            self.claim.is_some(),
            self.peak.is_some(),
            self.curve.is_some(),
            self.mode_shape.is_some(),
        ];
        if kinds.iter().filter(|given| **given).count() != 1 {
            wrong.push(EntryMistake::NotOneKind);
            return Err(wrong);
        }
        let claim = self.claim.or(self.curve.map(Predicate::Curve)).or(self.mode_shape.map(Predicate::ModeShape));
        let check = match (self.value, self.from, claim) {
            (Some(value), Some(from), None) => {
                if !threshold_reason.is_empty() {
                    wrong.push(EntryMistake::ThresholdReasonOfValue);
                }
                if !from.is_sound() {
                    wrong.push(EntryMistake::UnsoundFrom);
                }
                let tolerance = self.tolerance.and_then(|raw| raw.validated(&mut wrong));
                match Printed::parse(&value) {
                    Ok(published) => Some(Check::Value { published, from, tolerance }),
                    Err(error) => {
                        wrong.push(EntryMistake::Value(error));
                        None
                    }
                }
            }
            (None, None, Some(predicate)) => {
                if let Some(flaw) = predicate.flaw() {
                    wrong.push(EntryMistake::Claim(flaw));
                }
                if self.tolerance.is_some() {
                    wrong.push(EntryMistake::ToleranceOfClaim);
                }
                if predicate.has_threshold() && threshold_reason.is_empty() {
                    wrong.push(EntryMistake::NoThresholdReason);
                }
                Some(Check::Claim { predicate, threshold_reason })
            }
            (Some(_), None, None) => {
                wrong.push(EntryMistake::NoFrom);
                None
            }
            (None, None, None) => self.peak.map(|peak| {
                if !threshold_reason.is_empty() {
                    wrong.push(EntryMistake::ThresholdReasonOfValue);
                }
                wrong.extend(peak.flaw());
                let tolerance = self.tolerance.and_then(|raw| raw.validated(&mut wrong));
                if tolerance.as_ref().is_some_and(|given| matches!(given.size, ToleranceSize::Absolute(_))) {
                    wrong.push(EntryMistake::AbsoluteToleranceOfPeak);
                }
                Check::Peak { peak, tolerance }
            }),
            _ => {
                wrong.push(EntryMistake::FromWithoutValue);
                None
            }
        };
        match check {
            Some(check) if wrong.is_empty() => Ok(Entry {
                id: format!("{experiment}/{}", self.id),
                place: self.place,
                says: self.says,
                check,
                rows: self.rows,
                expected,
                explanation: self.explanation.unwrap_or_default().trim().to_string(),
                blocked_by: self.blocked_by,
                line: 0,
            }),
            _ => Err(wrong),
        }
    }
}

impl RawTolerance {
    fn validated(self, wrong: &mut Vec<EntryMistake>) -> Option<Tolerance> {
        let size = match (self.relative, self.absolute) {
            (Some(fraction), None) => ToleranceSize::Relative(fraction),
            (None, Some(distance)) => ToleranceSize::Absolute(distance),
            _ => {
                wrong.push(EntryMistake::ToleranceWithoutSize);
                return None;
            }
        };
        let (ToleranceSize::Relative(amount) | ToleranceSize::Absolute(amount)) = size;
        if !(amount.is_finite() && amount > 0.0) {
            wrong.push(EntryMistake::ToleranceNotAboveZero);
        }
        if self.reason.trim().is_empty() {
            wrong.push(EntryMistake::NoToleranceReason);
        }
        Some(Tolerance { size, reason: self.reason.trim().into() })
    }
}
