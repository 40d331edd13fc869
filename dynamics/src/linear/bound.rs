//! The proof that no particle ever leaves its floor.
//!
//! In every cycle but the first the state is the steady one plus a transient E^n a. The steady guard is bounded below by
//! branch and bound over one cycle; the transient by the amplitudes of its blocks, which only decay. If the first bound
//! exceeds the second the guard holds for ever. The first cycle, which may be kicked, is bounded by itself. A bound that
//! decides nothing says nothing: then the run is simulated.

use super::cycle::Cycle;
use crate::budget;
use crate::contact_state::block::{Block, Phase};
use crate::flow::Flow;
use crate::flow::signals::Row;
use crate::system::{HybridSystem, Law};

/// Bisections after which a guard counts as undecided.
const MOST_PIECES: usize = 400;

/// What must stay positive: a constant and a signal.
pub(super) struct Guard<'a> {
    pub(super) row: &'a Row,
    sign: f64,
    /// Beside the row's own rest.
    constant: f64,
    /// A distance, in metres.
    is_distance: bool,
}

/// The guards of particles at rest on their floors, held against a run.
pub(super) struct Watch<'a> {
    pub(super) system: &'a HybridSystem,
    pub(super) flow: &'a Flow,
    pub(super) first: &'a Cycle,
    pub(super) regular: &'a Cycle,
    /// State at the start of the run.
    pub(super) start: &'a [f64],
    /// The state that a regular cycle leaves where it is.
    pub(super) steady: &'a [f64],
    /// Where the first cycle that is regular begins, less that.
    pub(super) transient: &'a [f64],
}

impl Watch<'_> {
    /// How far, in metres, every guard that is a distance stays from zero throughout; `None` if some guard might not.
    pub(super) fn margin(&self) -> Option<f64> {
        let mut margin = f64::INFINITY;
        for guard in guards(self.system, self.flow) {
            let transient = guard.transient(self.flow, self.transient)?;
            let later = guard.lowest(self.flow, self.regular, self.steady, transient)? - transient;
            let bound = later.min(guard.lowest(self.flow, self.first, self.start, 0.0)?);
            if guard.is_distance {
                margin = margin.min(bound);
            }
        }
        Some(margin)
    }
}

/// What must stay positive while every particle rests on its floor.
pub(super) fn guards<'a>(system: &HybridSystem, flow: &'a Flow) -> Vec<Guard<'a>> {
    let mut guards = Vec::new();
    for (particle, rows) in system.particles.iter().zip(&flow.rows.guards) {
        let guard = |row, sign, constant, is_distance| Guard { row: flow.rows.row(row), sign, constant, is_distance };
        guards.extend(rows.across.map(|across| guard(across.way, 1.0, particle.gap, true)));
        match particle.floor.law {
            Law::Resilient { no_tension, stop, .. } => {
                let holds = if no_tension { rows.second } else { rows.first };
                guards.push(guard(holds, -1.0, 0.0, !no_tension));
                guards.extend(stop.map(|stop| guard(rows.first, 1.0, stop.length, true)));
            }
            // What the floor pushes, per mass: its acceleration and gravity.
            Law::Rigid { .. } => guards.push(guard(rows.first, 1.0, system.gravity, false)),
        }
    }
    guards
}

impl Guard<'_> {
    /// Its value at one of its row.
    pub(super) fn of(&self, row: f64) -> f64 {
        self.constant + self.sign * row
    }

    /// Shares of the guard from those of its row.
    fn shares(&self, phases: impl Iterator<Item = Phase>) -> Vec<Phase> {
        phases.map(|share| Phase { value: self.sign * share.value, rate: self.sign * share.rate }).collect()
    }

    /// Bound on the guard's transient from the state `a` on, for ever.
    fn transient(&self, flow: &Flow, a: &[f64]) -> Option<f64> {
        let shares = self.shares(self.row.phases(a));
        flow.blocks.iter().zip(shares).try_fold(0.0, |sum, (block, share)| Some(sum + for_ever(block, share)?))
    }

    /// A lower bound on the guard over a cycle that begins in state `c`; `None` if it may be below `least`.
    fn lowest(&self, flow: &Flow, cycle: &Cycle, c: &[f64], least: f64) -> Option<f64> {
        let mut state = c.to_vec();
        let mut lowest = f64::INFINITY;
        for segment in &cycle.segments {
            let start = segment.jump.apply(&state);
            state = segment.flow.apply(&start);
            let (drive, rest) = self.row.outside(flow, segment.level, segment.drive);
            let shares = self.shares(self.row.phases(&start).chain(drive));
            let signal = Signal { blocks: &flow.blocks, shares, constant: self.constant + self.sign * rest };
            lowest = lowest.min(signal.lowest(segment.length, least)?);
        }
        Some(lowest)
    }
}

/// |share| from now on, for ever; `None` where it grows.
fn for_ever(block: &Block, share: Phase) -> Option<f64> {
    if block.decay < 0.0 || block.determinant <= 0.0 {
        return (share == Phase::default()).then_some(0.0);
    }
    let simple = if !block.oscillates() || block.is_near_critical() {
        block.amplitude(share, 0.0, f64::INFINITY)
    } else {
        let [[_, turn], _] = block.eigenvalues();
        libm::hypot(share.value, (share.rate + block.decay * share.value) / turn)
    };
    // e^(−at) S(t) ≤ t e^(−σt) ≤ 1/(eσ) with σ the slower rate, at critical damping and on both sides of it.
    let slower = if block.oscillates() { block.decay } else { block.determinant / block.radius };
    let rate = (share.rate + block.decay * share.value).abs();
    let bound = simple.min(share.value.abs() + rate / (std::f64::consts::E * slower));
    bound.is_finite().then_some(bound)
}

/// constant + Σ shares, over a stretch without jumps.
struct Signal<'a> {
    blocks: &'a [Block],
    shares: Vec<Phase>,
    constant: f64,
}

impl Signal<'_> {
    /// A lower bound over `length` that is not far below what is reached; `None` if `least` may be reached.
    fn lowest(&self, length: f64, least: f64) -> Option<f64> {
        let reach = |order: f64| {
            self.blocks.iter().zip(&self.shares).fold(0.0, |sum, (b, share)| sum + b.amplitude(*share, order, length))
        };
        // What may be rounding is not held against zero.
        let least = least + 1e-13 * (self.constant.abs() + reach(0.0));
        let whole = self.constant - reach(0.0);
        if whole > least {
            return Some(whole);
        }
        let mut open = vec![[0.0, length]];
        let (mut sampled, mut lowest) = (f64::INFINITY, f64::INFINITY);
        let mut pieces = 0;
        while let Some([begin, end]) = open.pop().filter(|_| !budget::spend(1)) {
            let (middle, bound) = self.piece(begin, end);
            sampled = sampled.min(middle);
            pieces += 1;
            if !(sampled > least) || pieces > MOST_PIECES {
                return None;
            }
            if bound > least + 0.8 * (sampled - least) || (bound > least && pieces > MOST_PIECES / 2) {
                lowest = lowest.min(bound);
            } else {
                let half = f64::midpoint(begin, end);
                open.extend([[half, end], [begin, half]]);
            }
        }
        Some(lowest)
    }

    /// The value in the middle of a stretch, and a lower bound on the whole of it by the second derivative.
    fn piece(&self, begin: f64, end: f64) -> (f64, f64) {
        let h = 0.5 * (end - begin);
        let (mut value, mut rate, mut bend, mut reach) = (self.constant, 0.0, 0.0, 0.0);
        for (block, share) in self.blocks.iter().zip(&self.shares) {
            let from = block.advance(*share, block.kernel(begin));
            let middle = block.advance(from, block.kernel(h));
            value += middle.value;
            rate += middle.rate;
            bend += block.radius * block.radius * block.amplitude(from, 2.0, 2.0 * h);
            reach += block.amplitude(from, 0.0, 2.0 * h);
        }
        (value, (value - rate.abs() * h - 0.5 * bend * h * h).max(self.constant - reach))
    }
}
