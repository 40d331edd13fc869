//! What proves a run: its balances close, and its events are decided by a margin.

use crate::arithmetic::larger_or_nan;
use crate::response::audit::{Audit, State};
use crate::system::HybridSystem;

/// What proves a run: residuals of the balances, and how clearly its events were decided.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Proof {
    /// |Σ impulses − momentum gained − impulse of springs, dashpots and gravity| over the impulse that passed or was carried, dimensionless.
    pub momentum_residual: f64,
    /// |work of the excitation − energy gained − energy dissipated| over the energy that passed, dimensionless.
    pub energy_residual: f64,
    /// What both may be at most if nothing but rounding is in them; infinite where nobody audited, and for the fixed step, whose
    /// residuals are the error of its step.
    pub residual_bound: f64,
    /// Events of the whole run: contacts made and lost, stops hit; impulses not counted.
    pub events: u64,
    /// The smallest distance, in metres, by which a surface would have to be moved for the sequence of events to change: 0 where particles
    /// strike rigid faces at once. Simultaneous contacts with resilient faces, whose order changes nothing, are left to `ties`. NaN from the
    /// fixed step, which certifies nothing.
    pub smallest_margin: f64,
    /// Decisions within rounding: simultaneous events that had to be put into an order, contacts that graze.
    pub ties: u64,
}

impl Default for Proof {
    /// Of a run that nobody audited.
    fn default() -> Self {
        Self {
            momentum_residual: 0.0,
            energy_residual: 0.0,
            residual_bound: f64::INFINITY,
            events: 0,
            smallest_margin: 0.0,
            ties: 0,
        }
    }
}

impl Proof {
    /// The proof of a run with no event at all.
    #[must_use]
    pub fn linear() -> Self {
        Self { smallest_margin: f64::INFINITY, ..Self::default() }
    }

    /// The proof of several runs of which one number is made: as good as the worst of them.
    #[must_use]
    pub fn of_several(each: &[Self]) -> Self {
        let worst = |part: fn(&Self) -> f64| each.iter().map(part).fold(0.0, larger_or_nan);
        let bounds = each.iter().filter(|one| !one.is_balanced()).map(|one| one.residual_bound);
        Self {
            momentum_residual: worst(|one| one.momentum_residual),
            energy_residual: worst(|one| one.energy_residual),
            // One that does not close is enough.
            residual_bound: bounds.fold(f64::INFINITY, f64::min),
            events: each.iter().map(|one| one.events).sum(),
            smallest_margin: -each.iter().map(|one| -one.smallest_margin).fold(f64::NEG_INFINITY, larger_or_nan),
            ties: each.iter().map(|one| one.ties).sum(),
        }
    }

    /// Enters the balances of an audited run.
    pub(crate) fn balance(&mut self, system: &HybridSystem, audit: &Audit, end: &State) {
        (self.momentum_residual, self.energy_residual) = audit.residuals(system, end);
    }

    /// The larger of both residuals; NaN if one of them is.
    #[must_use]
    pub fn residual(&self) -> f64 {
        larger_or_nan(self.momentum_residual.abs(), self.energy_residual.abs())
    }

    /// The balances of an audited run close to within rounding.
    #[must_use]
    pub fn is_balanced(&self) -> bool {
        self.residual() <= self.residual_bound
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn several_runs_are_proven_as_well_as_the_worst_of_them() {
        let good = Proof { momentum_residual: 1e-16, residual_bound: 1e-13, smallest_margin: 1e-3, ..Proof::default() };
        let loose = Proof { energy_residual: 1e-12, events: 7, ..good };
        let both = Proof::of_several(&[good, loose]);
        assert_eq!((both.energy_residual, both.residual_bound, both.events), (1e-12, 1e-13, 7));
        assert!(!both.is_balanced());
        // A fixed step certifies no margin, and what is no number closes no balance.
        let stepped = Proof { smallest_margin: f64::NAN, momentum_residual: f64::NAN, ..good };
        for pair in [[good, stepped], [stepped, good]] {
            let both = Proof::of_several(&pair);
            assert!(both.smallest_margin.is_nan() && both.momentum_residual.is_nan() && !both.is_balanced());
        }
    }
}
