//! Time histories: evenly spaced instants of a few cycles.

/// Which instants to keep.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct TraceRequest {
    /// First cycle.
    pub from_cycle: u64,
    /// One past the last.
    pub to_cycle: u64,
    /// Samples a cycle.
    pub samples: u64,
}

impl TraceRequest {
    pub(crate) fn covers(&self, cycle: u64) -> bool {
        (self.from_cycle..self.to_cycle).contains(&cycle)
    }

    pub(crate) fn instant(&self, i: u64, period: f64) -> f64 {
        period * i as f64 / self.samples as f64
    }
}
