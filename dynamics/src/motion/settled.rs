//! Whether a run has settled, asked at the end of each cycle: the state comes again after a period, and the multipliers of that
//! period prove that it will go on so.
//!
//! The orbit that closes is (1 − M)⁻¹ δ from a state that misses itself by δ after the period (Newton's step), and each further period
//! brings the state nearer by the largest multiplier. Averages over one period are those of the orbit to this distance.

use super::multipliers::Period;
use super::recurrence::{Scale, candidates};
use super::tape::Tape;
use crate::error::EngineError;
use crate::system::HybridSystem;

/// Distance from the orbit, in units of the motion, within which averages are those of the orbit.
const SETTLED: f64 = 1e-12;
/// A miss above this is not worth the multipliers: it is the distance less what a period leaves of it.
const MISSED: f64 = 100.0 * SETTLED;
/// The largest multiplier of a motion that attracts: less by this margin than that of a motion that any push moves for good.
const ATTRACTS: f64 = 1.0 - 1e-3;

/// Cycles of the period in which the run has settled.
pub(crate) fn settled(system: &HybridSystem, tape: &Tape) -> Result<Option<u64>, EngineError> {
    if !system.drive.repeats {
        return Ok(None);
    }
    let scale = Scale::new(system, &tape.reach);
    for period in candidates(&scale, &tape.ends, MISSED) {
        // Where particles are struck at one instant there are no multipliers.
        if tape.last(period).any(|cycle| cycle.blurred) {
            continue;
        }
        let last = tape.ends.len() - 1;
        let miss = scale.miss(&tape.ends[last - period], &tape.ends[last]);
        if Period::new(system, &scale, tape.last(period)).orbit(miss)?.attracts(ATTRACTS, SETTLED) {
            return Ok(Some(period as u64));
        }
    }
    Ok(None)
}
