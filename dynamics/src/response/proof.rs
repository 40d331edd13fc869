//! What proves a run: its balances close, and its events are decided by a margin.

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

    /// Enters the balances of an audited run.
    pub(crate) fn balance(&mut self, system: &HybridSystem, audit: &Audit, end: &State) {
        (self.momentum_residual, self.energy_residual) = audit.residuals(system, end);
    }

    /// The larger of both residuals; NaN if one of them is.
    #[must_use]
    pub fn residual(&self) -> f64 {
        let (momentum, energy) = (self.momentum_residual.abs(), self.energy_residual.abs());
        if momentum.is_nan() || energy.is_nan() { f64::NAN } else { momentum.max(energy) }
    }

    /// The balances of an audited run close to within rounding.
    #[must_use]
    pub fn is_balanced(&self) -> bool {
        self.residual() <= self.residual_bound
    }
}
