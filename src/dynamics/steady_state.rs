//! The steady state: what every cycle repeats once all transients are gone.

use super::extremes::Extremes;
use super::sums::Sums;

/// The motion that comes again in every cycle.
#[derive(Debug, Clone, PartialEq)]
pub struct SteadyState {
    /// In the order of [`HybridSystem::observed_rows`](super::HybridSystem::observed_rows).
    pub observed: Vec<SteadyMotion>,
    /// A lower bound on how far, in metres, every particle stays from leaving its floor; infinite where there is none.
    pub margin: f64,
}

/// One observed motion in the steady state.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SteadyMotion {
    /// Integrals over one cycle.
    pub cycle: Sums,
    /// Largest and smallest values.
    pub extremes: Extremes,
}
