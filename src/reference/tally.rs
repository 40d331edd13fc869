//! Requirements with their margins: the worst one speaks for a claim.

use super::absence::Absence;
use super::compare::COVERAGE;
use super::text::{percents, with_error};

/// What a predicate is worth, best first.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum Outcome {
    Holds,
    Undecided,
    Fails,
}

/// In what a margin is shown.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum Shown {
    Unit(String),
    PercentOf(f64),
}

/// How far the worst requirement is on the right side, with its error.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Margin {
    value: f64,
    u: f64,
    shown: Shown,
}

impl Margin {
    /// Whether its error matters: it is not even twice what it has to be.
    fn is_close(&self) -> bool {
        self.shown != Shown::PercentOf(0.0) && self.value.abs() < 2.0 * COVERAGE * self.u
    }

    /// `0.57 ± 0.33 mm/s`, `−1.2 ± 3.4 %`.
    fn words(&self) -> String {
        // Of a strict requirement a number next to zero stands for zero.
        let value = if self.value == strict(0.0) { 0.0 } else { self.value };
        let wide = COVERAGE * self.u;
        match &self.shown {
            Shown::Unit(unit) => with_error(value, wide, unit),
            Shown::PercentOf(whole) => percents(value / whole.abs(), wide / whole.abs()),
        }
    }
}

/// A decided claim, and the sentence that explains it.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Decision {
    pub outcome: Outcome,
    pub found: String,
    /// By how much the worst requirement would have to move, in its own unit, for the claim to fail; none where there is no
    /// such number, and none to be moved where it fails already.
    pub reach: Option<f64>,
    /// None where no single number decides, or `found` gives its error.
    pub margin: Option<Margin>,
}

impl Decision {
    /// What came out, with the margin where its error matters.
    pub(crate) fn words(&self) -> String {
        match &self.margin {
            Some(margin) if margin.is_close() => format!("{}; margin {}", self.found, margin.words()),
            _ => self.found.clone(),
        }
    }
}

/// A margin of which zero is not positive.
pub(crate) fn strict(margin: f64) -> f64 {
    if margin == 0.0 { -f64::MIN_POSITIVE } else { margin }
}

/// Requirements so far: the worst one and its words.
pub(crate) struct Tally {
    shown: Shown,
    worst: Option<Requirement>,
}

struct Requirement {
    outcome: Outcome,
    margin: f64,
    /// What margins are compared in.
    scale: f64,
    u: f64,
    shown: Shown,
    says: String,
}

impl Tally {
    /// No requirement yet; margins are in this unit.
    pub(crate) fn new(unit: &str) -> Self {
        Self { shown: Shown::Unit(unit.into()), worst: None }
    }

    /// As [`Tally::new`]; margins are shown as percentages of a range.
    pub(crate) fn of_range(range: f64) -> Self {
        Self { shown: Shown::PercentOf(range), worst: None }
    }

    /// `margin` ± `u` is to be positive (or zero, where nothing is uncertain).
    pub(crate) fn require(&mut self, margin: f64, u: f64, says: impl FnOnce() -> String) {
        self.require_in(1.0, self.shown.clone(), margin, u, says);
    }

    /// As [`Tally::require`]; margins are compared in units of `scale`, as a millimetre is much of one number and little of another.
    pub(crate) fn require_in(&mut self, scale: f64, shown: Shown, margin: f64, u: f64, says: impl FnOnce() -> String) {
        let outcome = if margin >= COVERAGE * u {
            Outcome::Holds
        } else if margin <= -COVERAGE * u {
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
            self.worst = Some(Requirement { outcome, margin, scale, u, shown, says: says() });
        }
    }

    /// As [`Tally::require`], and zero is not positive.
    pub(crate) fn require_strictly(&mut self, margin: f64, u: f64, says: impl FnOnce() -> String) {
        self.require(strict(margin), u, says);
    }

    /// The worst requirement's answer.
    pub(crate) fn decision(self) -> Result<Decision, Absence> {
        let worst = self.worst.ok_or_else(|| Absence::NoRow("nothing to compare: too few points".into()))?;
        let reach = worst.margin + COVERAGE * worst.u;
        Ok(Decision {
            outcome: worst.outcome,
            found: worst.says,
            reach: (reach > 0.0).then_some(reach),
            margin: Some(Margin { value: worst.margin, u: worst.u, shown: worst.shown }),
        })
    }
}
