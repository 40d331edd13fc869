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

    /// The first sample at or after `time`.
    pub(crate) fn next_sample(&self, time: f64, period: f64) -> u64 {
        let guess = (time / period * self.samples as f64).floor().max(0.0) as u64;
        (guess..).find(|&i| self.instant(i, period) >= time).unwrap_or(guess)
    }
}
