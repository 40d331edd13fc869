//! How strong a drive the particles bear before the first of them leaves its floor.
//!
//! While every particle rests on its floor the motion is linear in the strength f of the drive: in the steady state the distance or the
//! push that must stay positive is g(t) = g₀ − f d(t), g₀ that of the scene at rest. So the first is lost at
//!
//! f = g₀/max d(t),
//!
//! which takes the steady state under one strength alone. On a rigid floor g₀ is gravity, and f d(t) the downward acceleration.

use super::Steady;
use super::bound::guards;
use super::range;
use crate::response::extremes::Extremes;
use crate::system::HybridSystem;

/// A loss below this share of what there is to lose is rounding.
const NOTHING: f64 = 1e-13;

/// The share of the drive's present strength; `None` where none takes a particle off its floor.
pub(super) fn share(system: &HybridSystem, Steady { flow, cycle, state }: &Steady) -> Option<f64> {
    let shares = guards(system, flow).into_iter().filter_map(|guard| {
        let mut extremes = Extremes::default();
        range::take(flow, guard.row, cycle, state, 1, &mut extremes);
        let at_rest = guard.of(guard.row.gravity.p0);
        let lowest = extremes.displacement.into_iter().map(|value| guard.of(value)).fold(f64::INFINITY, f64::min);
        let loss = at_rest - lowest;
        (at_rest > 0.0 && loss > NOTHING * at_rest).then(|| at_rest / loss)
    });
    shares.reduce(f64::min)
}
