//! The validated `orbit`: which periodic motion is followed along which parameter.

use serde::{Deserialize, Serialize};

use super::case::Case;
use super::figure_spec::AxisScale;
use super::recipe::{Parameter, ParameterValue};
use crate::measure::SolverChoice;

/// Branches of periodic motions in the place of a sweep. Its rows are the motions, branch by branch.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Continuation {
    /// The parameter that is followed.
    pub along: Parameter,
    /// Its least value.
    pub from: f64,
    /// Its largest value.
    pub to: f64,
    /// The scale on which steps are equal.
    pub spacing: AxisScale,
    /// Where motions are taken from the ends of runs: each begins a branch.
    pub starts: Vec<f64>,
    /// Forcing periods of these motions; `None` for those of the motion that a run ends in.
    pub periods: Option<u32>,
    /// How many times over the branch is switched to that begins at a period doubling.
    pub doublings: u32,
    /// Whether the motions are followed, too, that begin where one loses its symmetry.
    #[serde(default, skip_serializing_if = "is_false")]
    pub asymmetric: bool,
    /// Points to either side of the first one beyond which a branch is not followed.
    pub points: u32,
}

/// What an experiment without the key means: its fingerprint is the same as before there was one.
#[allow(clippy::trivially_copy_pass_by_ref, reason = "serde wants it so")]
fn is_false(it: &bool) -> bool {
    !*it
}

impl Continuation {
    /// The parameter at a share of its range; the ends and the starts are met to the bit.
    #[must_use]
    pub fn at(&self, share: f64) -> f64 {
        if share == 0.0 {
            return self.from;
        } else if share == 1.0 {
            return self.to;
        } else if let Some(start) = self.starts.iter().find(|start| self.share(**start) == share) {
            return *start;
        }
        match self.spacing {
            AxisScale::Linear => self.from + share * (self.to - self.from),
            AxisScale::Log => self.from * libm::exp(share * libm::log(self.to / self.from)),
        }
    }

    /// The share of its range at a value.
    #[must_use]
    pub fn share(&self, value: f64) -> f64 {
        match self.spacing {
            AxisScale::Linear => (value - self.from) / (self.to - self.from),
            AxisScale::Log => libm::log(value / self.from) / libm::log(self.to / self.from),
        }
    }

    /// The scene that the first motion is taken from, as a case.
    pub(super) fn first_case(&self) -> Case {
        let start = self.starts.first().copied().unwrap_or(self.from);
        let values = vec![(self.along, ParameterValue::Number(start))];
        Case { values, sweep: String::new(), solvers: vec![SolverChoice::EventDriven], direction: None }
    }
}

/// What the table of branches says of each orbit, beside its motion, its multipliers and what is measured.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum BranchColumn {
    /// Which branch, from 1.
    Branch,
    /// Forcing periods after which the motion comes again.
    Periods,
    /// Contacts made in that time.
    Contacts,
    /// Whether it attracts.
    Stability,
    /// What happens there; empty where nothing does.
    SpecialPoint,
    /// At the ends of a branch why it goes no further; empty elsewhere.
    BranchEnd,
}

impl BranchColumn {
    /// All of them, in the order of the table.
    pub const ALL: [Self; 6] =
        [Self::Branch, Self::Periods, Self::Contacts, Self::Stability, Self::SpecialPoint, Self::BranchEnd];

    /// The word in the table.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Branch => "branch",
            Self::Periods => "periods",
            Self::Contacts => "contacts",
            Self::Stability => "stability",
            Self::SpecialPoint => "special_point",
            Self::BranchEnd => "branch_end",
        }
    }

    /// What it says, in one line.
    #[must_use]
    pub fn about(self) -> &'static str {
        match self {
            Self::Branch => {
                "which branch, from 1: those that begin at the starts, then those that begin at special points"
            }
            Self::Periods => "forcing periods after which the motion comes again",
            Self::Contacts => "contacts made in that time, impacts on stops among them",
            Self::Stability => "`stable` where no multiplier exceeds 1, else `unstable`",
            Self::SpecialPoint => {
                "what happens at this point: `fold`, `period doubling`, `torus` (a quasi-periodic motion begins), `graze`, `sticking` (a particle begins or ceases to stay on a rigid face that it lands on), `symmetry breaking` (two motions begin, each the other upside down) or `branch point` (another branch crosses); empty elsewhere"
            }
            Self::BranchEnd => "in the first and the last row of a branch why it goes no further; empty elsewhere",
        }
    }

    /// It holds words; the others hold counts.
    #[must_use]
    pub fn is_word(self) -> bool {
        matches!(self, Self::Stability | Self::SpecialPoint | Self::BranchEnd)
    }
}

/// Whether a motion attracts.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Stability {
    /// No multiplier exceeds 1.
    Stable,
    /// One does.
    Unstable,
}

impl Stability {
    /// Both.
    pub const ALL: [Self; 2] = [Self::Stable, Self::Unstable];

    /// The word in the table.
    #[must_use]
    pub fn word(self) -> &'static str {
        match self {
            Self::Stable => "stable",
            Self::Unstable => "unstable",
        }
    }
}
