//! How large the residuals of a run may be if nothing but rounding is in them.
//!
//! At every event and every end of a cycle the state changes from the blocks of one contact state to those of another, by way of
//! the physical coordinates (q, q′): s = V c, c = V⁻¹ s. That costs ε κ(V), relative to the state, and the balances are sums over
//! states. V is well conditioned but for two scales, whose ratios bound κ:
//!
//! - blocks hold (Ω e, e′), physical coordinates (e, e′): their ratio is that of the longest to the shortest time in the run (the
//!   forcing period, the period of the fastest motion, the shortest stretch of the force);
//! - a contact joins a particle to what carries it: the mass matrix, scaled to a diagonal of ones, has the condition
//!   1 + mp φᵀM⁻¹φ, of which the heaviest particle decides.
//!
//! A structure that is damped far beyond critical is judged too strictly: the slow rate of such a pair is a difference of fast ones, which
//! costs digits that are not counted here. Its rows are marked though they keep ten digits and more.
//!
//! bound = 64 ε (events + cycles) longest/shortest max(1, mp φᵀM⁻¹φ),   at most one part in a million.
//!
//! All of it is known of any scene; the edge scenes of the tests print residual and bound side by side.

use crate::options::Options;
use crate::response::Response;
use crate::system::HybridSystem;

/// Roundings of a cycle or an event that may fall together.
const ROUNDINGS: f64 = 64.0;
/// Beyond it a balance proves nothing, however hard the run.
const LARGEST: f64 = 1e-6;

/// Enters the bound of an audited run into its proof.
pub(crate) fn enter(system: &HybridSystem, options: &Options, response: &mut Response) {
    if options.audit {
        let roundings = ROUNDINGS * (response.proof.events as f64 + options.cycles() as f64);
        let times = [system.drive.period, std::f64::consts::TAU / response.highest_frequency];
        let stretches = system.drive.stretches().filter(|time| *time > 0.0);
        let shortest = stretches.chain(times).fold(f64::INFINITY, f64::min);
        let spread = times.into_iter().fold(0.0, f64::max) / shortest;
        let bound = f64::EPSILON * roundings * spread * heaviest(system);
        // Also where the spread is no number.
        response.proof.residual_bound = if bound < LARGEST { bound } else { LARGEST };
    }
}

/// mp φᵀM⁻¹φ of the heaviest particle, by the diagonal of M; 1 at least.
fn heaviest(system: &HybridSystem) -> f64 {
    let n = system.mass.order;
    let carried = |row: &[f64]| (0..n).map(|i| row[i] * row[i] / system.mass.entries[i * n + i]).sum::<f64>();
    system.particles.iter().map(|particle| particle.mass * carried(&particle.floor.row)).fold(1.0, f64::max)
}
