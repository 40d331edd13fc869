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
    /// By how much the worst requirement would have to move, in its own unit, for the claim to fail; none where there is no
    /// such number, and none to be moved where it fails already.
    pub reach: Option<f64>,
}

/// Requirements so far: the worst one and its words.
pub(crate) struct Tally {
    worst: Option<Requirement>,
}

struct Requirement {
    outcome: Outcome,
    margin: f64,
    /// What margins are compared in.
    scale: f64,
    u: f64,
    says: String,
}

impl Tally {
    /// No requirement yet.
    pub(crate) fn new() -> Self {
        Self { worst: None }
    }

    /// `margin` ± `u` is to be positive (or zero, where nothing is uncertain).
    pub(crate) fn require(&mut self, margin: f64, u: f64, says: impl FnOnce() -> String) {
        self.require_in(1.0, margin, u, says);
    }

    /// As [`Tally::require`]; margins are compared in units of `scale`, as a millimetre is much of one number and little of another.
    pub(crate) fn require_in(&mut self, scale: f64, margin: f64, u: f64, says: impl FnOnce() -> String) {
        let outcome = if margin >= 2.0 * u {
            Outcome::Holds
        } else if margin <= -2.0 * u {
            Outcome::Fails
        } else {
            Outcome::Undecided
        };
        let worse = match &self.worst {
            None => true,
            Some(worst) => {
                let smaller = || margin / scale < worst.margin / worst.scale;
                outcome > worst.outcome || (outcome == worst.outcome && smaller())
            }
        };
        if worse {
            self.worst = Some(Requirement { outcome, margin, scale, u, says: says() });
        }
    }

    /// As [`Tally::require`], and zero is not positive.
    pub(crate) fn require_strictly(&mut self, margin: f64, u: f64, says: impl FnOnce() -> String) {
        self.require(if margin == 0.0 { -f64::MIN_POSITIVE } else { margin }, u, says);
    }

    /// The worst requirement's answer.
    pub(crate) fn decision(self) -> Result<Decision, Absence> {
        let worst = self.worst.ok_or_else(|| Absence::NoRow("nothing to compare: too few points".into()))?;
        let reach = worst.margin + 2.0 * worst.u;
        Ok(Decision { outcome: worst.outcome, found: worst.says, reach: (reach > 0.0).then_some(reach) })
    }
}
