//! Entries with their verdicts, and all that reports say of them.

use serde::{Deserialize, Serialize};

use super::absence::NoTable;
use super::compare::Comparison;
use super::fit::Fit;
use super::motion_behind::MotionBehind;
use super::price::Price;
use super::printed::PrintedUnit;
use super::verdict::Verdict;

/// One number of an entry that has several.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Part {
    /// `half-power width`.
    pub name: String,
    /// Its own verdict.
    pub verdict: Verdict,
    /// What came out, in one line.
    pub found: String,
    /// Against the published number; none where there is nothing to compare.
    pub comparison: Option<Comparison>,
    /// The unit in which the number is published.
    #[serde(default)]
    pub printed_unit: PrintedUnit,
}

/// An entry with its verdict, ready for a report: plain data, no tables needed.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Judged {
    /// `ch3-favourable-impact/velocity-ratio`.
    pub id: String,
    /// The experiment that it reads.
    pub experiment: String,
    /// What it asks for.
    #[serde(default)]
    pub kind: Kind,
    /// What the study says, in one line.
    pub statement: String,
    /// Where it stands: `s. 3.6.5, Fig. 23`.
    pub place: String,
    /// The verdict.
    pub verdict: Verdict,
    /// The verdict that the entry expects.
    pub expected: Verdict,
    /// What came out, in one line: `1.56 ± 0.12, 2.9 % above 1.516`, `true: steps back by at most 0.2 % of the range`.
    pub found: String,
    /// The first table that it reads and that is not there; `None` if all are.
    #[serde(default)]
    pub no_table: Option<NoTable>,
    /// For values.
    pub comparison: Option<Comparison>,
    /// The unit in which a value is published.
    #[serde(default)]
    pub printed_unit: PrintedUnit,
    /// For an entry of several numbers: each with its own verdict. The entry's is the worst of them.
    pub parts: Vec<Part>,
    /// For curves and shapes.
    pub fit: Option<Fit>,
    /// Why it is expected to differ, to be blocked or undecidable; the entry's own note. Markdown.
    pub explanation: String,
    /// Inputs that the study does not give and without which the entry cannot be judged: those that a claim names, and the
    /// assumptions that make up most of a number's u_input.
    #[serde(default)]
    pub blocked_by: Vec<String>,
    /// Why a tolerance was set by hand, if it was.
    pub tolerance_reason: Option<String>,
    /// Of the variants of the assumptions that were run, how many keep the verdict: (kept, run).
    pub robust: Option<(u32, u32)>,
    /// What each of them gives.
    pub moved: Vec<Moved>,
    /// What was simulated for it.
    pub price: Price,
    /// What moves how in the rows that decided it, where that was measured.
    #[serde(default)]
    pub motion: Option<MotionBehind>,
    /// Whether it had a say in the choice of inputs.
    pub role: Role,
}

/// A number or a claim.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Kind {
    /// A published number, or those of a resonance.
    Number,
    /// A claim in words, a curve or a shape.
    #[default]
    Claim,
}

/// The part of an entry in the choice of the inputs that the study does not state.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Role {
    /// An assumption was chosen by it, or a calibration fits it: its agreement proves nothing.
    Fitted,
    /// The same, but a calibration of the others alone predicts it.
    CrossValidated,
    /// A calibration kept it aside, to be tested by it.
    HeldOut,
    /// None.
    #[default]
    Neither,
}

impl Role {
    /// It was used to choose an unstated input, whatever its verdict.
    #[must_use]
    pub fn is_used_in_fits(self) -> bool {
        matches!(self, Self::Fitted | Self::CrossValidated)
    }
}

/// An entry with one assumption moved.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Moved {
    /// `stop_length=0.05`.
    pub variant: String,
    /// What comes out then, in a word or a number.
    pub found: String,
    /// The number, where the entry is one and there is one.
    pub value: Option<f64>,
    /// The verdict that it would have.
    pub verdict: Verdict,
    /// Whether the verdict stays.
    pub kept: bool,
}

impl Judged {
    /// Its numbers against the published ones, each with the name of its part; empty for the one number of a value.
    pub fn comparisons(&self) -> impl Iterator<Item = (&str, &Comparison)> {
        self.comparisons_with_units().map(|(name, comparison, _)| (name, comparison))
    }

    /// The same, each with the unit in which its number is published.
    pub fn comparisons_with_units(&self) -> impl Iterator<Item = (&str, &Comparison, &PrintedUnit)> {
        let parts = self
            .parts
            .iter()
            .filter_map(|part| Some((part.name.as_str(), part.comparison.as_ref()?, &part.printed_unit)));
        self.comparison.iter().map(|comparison| ("", comparison, &self.printed_unit)).chain(parts)
    }

    /// Whether it would still be `fitted` at both of these relative errors, which are 0 for a claim that holds.
    #[must_use]
    pub fn comes_out(&self, errors: [f64; 2]) -> bool {
        let stays = |error: f64| match &self.comparison {
            Some(comparison) => comparison.verdict_of(comparison.published * (1.0 + error), true) == Verdict::Fitted,
            None => error == 0.0,
        };
        self.verdict == Verdict::Fitted && errors.into_iter().all(stays)
    }

    /// True if the verdict is the expected one; `missing` never is.
    #[must_use]
    pub fn as_expected(&self) -> bool {
        self.verdict == self.expected && self.verdict != Verdict::Missing
    }
}
