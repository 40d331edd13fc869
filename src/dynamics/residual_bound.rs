//! How large the residuals of a run may be if nothing but rounding is in them.
//!
//! Every event and every cycle rounds the state once, and the rounding of the fastest motion enters the balance with the ratio
//! of its frequency to the forcing's:
//!
//! bound = 64 ε (events + cycles) max(1, ω T/2π),   at most one part in a million.
//!
//! The largest residual among the study's rows is a hundredth of it.

use super::{HybridSystem, Options, Proof, Response};

/// Roundings of a cycle or an event that may fall together.
const ROUNDINGS: f64 = 64.0;
/// Beyond it a balance proves nothing, however hard the run.
const LARGEST: f64 = 1e-6;

/// Enters the bound of an audited run into its proof.
pub(super) fn enter(system: &HybridSystem, options: &Options, response: &mut Response) {
    if options.audit {
        let roundings = ROUNDINGS * (response.proof.events as f64 + options.cycles() as f64);
        let spread = (response.highest_frequency * system.drive.period / std::f64::consts::TAU).max(1.0);
        let bound = f64::EPSILON * roundings * spread;
        // Also where the spread is no number.
        response.proof.residual_bound = if bound < LARGEST { bound } else { LARGEST };
    }
}

impl Proof {
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
