//! The engine: exact motion of a piecewise linear system, from certified event to certified event.

/// What proves a run: residuals of the balances, and how clearly its events were decided.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Proof {
    /// |Σ impulses − momentum gained − impulse of springs, dashpots and gravity| over the impulse that passed, dimensionless.
    pub momentum_residual: f64,
    /// |work of the excitation − energy gained − energy dissipated| over the energy that passed, dimensionless.
    pub energy_residual: f64,
    /// Events of the whole run: contacts made and lost, stops hit; impulses not counted.
    pub events: u64,
    /// The smallest distance, in metres, by which a surface would have to be moved for the sequence of events to change.
    pub smallest_margin: f64,
    /// Simultaneous events that had to be put into an order.
    pub ties: u64,
}

/// Changes whenever the same scene may give other bits. A test holds the bits of fixed scenes against it.
pub const SOLVER_VERSION: u32 = 1;
