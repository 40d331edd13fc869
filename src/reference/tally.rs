//! Requirements with their margins: the worst one speaks for a claim.

use super::view::Absence;

/// What a predicate is worth, best first.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum Outcome {
    Holds,
    Undecided,
    Fails,
}

/// A decided claim, and the sentence that explains it.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Decision {
    pub outcome: Outcome,
    pub found: String,
}

/// Requirements so far: the worst one and its words.
pub(crate) struct Tally {
    worst: Option<(Outcome, f64, String)>,
}

impl Tally {
    /// No requirement yet.
    pub(crate) fn new() -> Self {
        Self { worst: None }
    }

    /// `margin` ± `u` is to be positive (or zero, where nothing is uncertain).
    pub(crate) fn require(&mut self, margin: f64, u: f64, says: impl FnOnce() -> String) {
        let outcome = if margin >= 2.0 * u {
            Outcome::Holds
        } else if margin <= -2.0 * u {
            Outcome::Fails
        } else {
            Outcome::Undecided
        };
        let worse = match &self.worst {
            None => true,
            Some((worst, smallest, _)) => outcome > *worst || (outcome == *worst && margin < *smallest),
        };
        if worse {
            self.worst = Some((outcome, margin, says()));
        }
    }

    /// As [`Tally::require`], and zero is not positive.
    pub(crate) fn require_strictly(&mut self, margin: f64, u: f64, says: impl FnOnce() -> String) {
        self.require(if margin == 0.0 { -f64::MIN_POSITIVE } else { margin }, u, says);
    }

    /// The worst requirement's answer.
    pub(crate) fn decision(self) -> Result<Decision, Absence> {
        let (outcome, _, found) =
            self.worst.ok_or_else(|| Absence::NoRow("nothing to compare: too few points".into()))?;
        Ok(Decision { outcome, found })
    }
}
