//! The largest Lyapunov exponent: the mean rate at which a tangent vector grows, one cycle after the other (Benettin et al.,
//! Meccanica 15, 1980).

use super::recurrence::Scale;
use super::tangent::Tangent;
use super::tape::Tape;
use crate::arithmetic::matrix::mean;
use crate::system::HybridSystem;

/// Cycles are put together to so many batches, whose scatter is the error of the mean.
const BATCHES: usize = 10;
/// Share of the cycles in which the vector turns to where it grows most.
const TURNING: f64 = 0.1;

/// A Lyapunov exponent.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Exponent {
    /// Mean growth of ln |δx| in a cycle of the drive.
    pub value: f64,
    /// Standard error of it: from the scatter of the cycles and their number.
    pub error: f64,
}

impl Exponent {
    /// Over the last `count` cycles of a tape. `None` where they are too few, or where nothing is left of the vector.
    pub(super) fn of(system: &HybridSystem, scale: &Scale, tape: &Tape, count: usize) -> Option<Self> {
        let mut tangent = Tangent::new(system);
        let size = tangent.size();
        // No direction is left out.
        let mut vectors = [(0..size).map(|i| scale.unit(i) / (1.0 + i as f64)).collect::<Vec<f64>>()];
        let mut growths = Vec::new();
        let mut length = norm(scale, &vectors[0]);
        for cycle in tape.last(count) {
            cycle.steps.iter().for_each(|step| tangent.carry(cycle, step, &mut vectors));
            let now = norm(scale, &vectors[0]);
            if !(now > 0.0 && now.is_finite()) {
                return None;
            }
            growths.push(libm::log(now / length));
            vectors[0].iter_mut().for_each(|x| *x /= now);
            length = 1.0;
        }
        let turning = (TURNING * growths.len() as f64) as usize;
        let growths = &growths[turning..];
        let batch = growths.len() / BATCHES;
        if batch == 0 {
            return None;
        }
        let means: Vec<f64> = growths.rchunks_exact(batch).take(BATCHES).map(mean).collect();
        let value = mean(&means);
        let square: f64 = means.iter().map(|x| (x - value) * (x - value)).sum();
        let count = BATCHES as f64;
        let scatter = (square / (count * (count - 1.0))).sqrt();
        // What a vector that only gets longer and shorter by e leaves of the mean.
        let resolution = 1.0 / (batch as f64 * count);
        Some(Self { value, error: libm::hypot(scatter, resolution) })
    }
}

fn norm(scale: &Scale, vector: &[f64]) -> f64 {
    let parts = vector.iter().enumerate().map(|(i, x)| x / scale.unit(i));
    parts.fold(0.0, |sum, x| sum + x * x).sqrt()
}
