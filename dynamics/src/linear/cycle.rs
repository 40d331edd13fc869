//! A forcing cycle as an affine map of block coordinates, c ← E c + d.
//!
//! Blocks do not mix, so the map is a 2 × 2 matrix and a pair for each of them; n cycles are its n-th power, by squaring.
//! A harmonic force needs no d: block coordinates are those beside its steady answer, and it is in phase again after a cycle.

use crate::arithmetic::few::Few;
use crate::arithmetic::matrix::dot;
use crate::budget;
use crate::flow::Flow;
use crate::system::{DrivePhase, HybridSystem, Tick};

/// c ← E c + d, block by block.
#[derive(Debug, Clone)]
pub(super) struct Affine {
    /// E, row by row.
    pub(super) turn: Few<[f64; 4]>,
    /// d.
    pub(super) shift: Few<[f64; 2]>,
}

impl Affine {
    /// Nothing moves.
    fn identity(blocks: usize) -> Self {
        Self { turn: Few::from_elem([1.0, 0.0, 0.0, 1.0], blocks), shift: Few::from_elem([0.0; 2], blocks) }
    }

    /// The free flow over a time.
    pub(super) fn flow(flow: &Flow, time: f64) -> Self {
        let turn = flow.matrices_after(time).collect();
        Self { turn, shift: Few::from_elem([0.0; 2], flow.own) }
    }

    /// This map, and the next one after it.
    pub(super) fn then(&self, next: &Self) -> Self {
        let turn = next.turn.iter().zip(&self.turn).map(|(a, b)| product(*a, *b)).collect();
        let shift = (next.turn.iter().zip(&self.shift).zip(&next.shift))
            .map(|((turn, shift), more)| sum(times(*turn, *shift), *more))
            .collect();
        Self { turn, shift }
    }

    /// Where a state goes.
    pub(super) fn apply(&self, c: &[f64]) -> Vec<f64> {
        let mut moved = Vec::with_capacity(c.len());
        for ((turn, shift), pair) in self.turn.iter().zip(&self.shift).zip(c.as_chunks().0) {
            moved.extend(sum(times(*turn, *pair), *shift));
        }
        moved
    }

    /// Where a state is after `cycles` of it.
    pub(super) fn repeat(&self, c: &[f64], mut cycles: u64) -> Vec<f64> {
        let (mut state, mut power) = (c.to_vec(), self.clone());
        while cycles > 0 {
            if cycles % 2 == 1 {
                state = power.apply(&state);
            }
            cycles /= 2;
            if cycles > 0 {
                power = power.then(&power);
            }
        }
        state
    }

    /// The state that it leaves where it is, c = E c + d; `None` at resonance without damping.
    pub(super) fn fixed_point(&self) -> Option<Vec<f64>> {
        let mut state = Vec::with_capacity(2 * self.turn.len());
        for ([p, q, r, s], shift) in self.turn.iter().zip(&self.shift) {
            if *shift == [0.0; 2] {
                state.extend([0.0; 2]);
                continue;
            }
            let (a, d) = (1.0 - p, 1.0 - s);
            let determinant = a * d - q * r;
            if !(determinant > 1e-18) {
                return None;
            }
            state.push((d * shift[0] + q * shift[1]) / determinant);
            state.push((r * shift[0] + a * shift[1]) / determinant);
        }
        Some(state)
    }
}

pub(super) fn times([p, q, r, s]: [f64; 4], [x, y]: [f64; 2]) -> [f64; 2] {
    [p * x + q * y, r * x + s * y]
}

pub(super) fn sum([a, b]: [f64; 2], [x, y]: [f64; 2]) -> [f64; 2] {
    [a + x, b + y]
}

/// A B.
pub(super) fn product([a, b, c, d]: [f64; 4], [p, q, r, s]: [f64; 4]) -> [f64; 4] {
    [a * p + b * r, a * q + b * s, c * p + d * r, c * q + d * s]
}

/// A stretch of a cycle between two jumps of the force.
pub(super) struct Segment {
    /// When in the cycle it begins, s.
    pub(super) begin: f64,
    /// s.
    pub(super) length: f64,
    /// Impulse that opens it, N s.
    pub(super) impulse: f64,
    /// Constant force throughout, N.
    pub(super) level: f64,
    /// What that makes of the state before.
    pub(super) jump: Affine,
    /// And the flow after it.
    pub(super) flow: Affine,
    /// Phase of the harmonic force when it begins.
    pub(super) drive: DrivePhase,
}

/// A forcing cycle.
pub(super) struct Cycle {
    /// In order.
    pub(super) segments: Vec<Segment>,
    /// Force before its first jump, N.
    pub(super) before: f64,
    /// The whole of it.
    pub(super) map: Affine,
}

impl Cycle {
    /// The cycle with these jumps of the force, after one that ended with the force `before`; `answer` is M⁻¹b, and `kick` an
    /// impulse added to the first.
    pub(super) fn new(
        system: &HybridSystem,
        flow: &Flow,
        ticks: &[Tick],
        before: f64,
        kick: f64,
        answer: &[f64],
    ) -> Self {
        let period = system.drive.period;
        let mut segments: Vec<Segment> = Vec::with_capacity(ticks.len());
        let mut map = Affine::identity(flow.own);
        let mut level = before;
        for (i, tick) in ticks.iter().enumerate() {
            if budget::spend(1) {
                break;
            }
            let end = ticks.get(i + 1).map_or(period, |next| next.time);
            let impulse = tick.impulse + if i == 0 { kick } else { 0.0 };
            let jump = Affine {
                shift: jump(system, flow, impulse, [level, tick.level], answer),
                ..Affine::identity(flow.own)
            };
            level = tick.level;
            let length = (end - tick.time).max(0.0);
            let free = Affine::flow(flow, length);
            map = map.then(&jump).then(&free);
            let drive = DrivePhase::of(&system.drive, tick.time);
            segments.push(Segment { begin: tick.time, length, impulse, level, jump, flow: free, drive });
        }
        Self { segments, before, map }
    }
}

/// Block coordinates of (p, p′); those of the drive are its phase.
pub(super) fn enter(flow: &Flow, p: &[f64], rate: &[f64], level: f64, drive: DrivePhase) -> Vec<f64> {
    let mut c = vec![0.0; 2 * flow.blocks.len()];
    flow.enter(p, rate, level, drive, &mut Vec::new(), &mut c);
    c.truncate(2 * flow.own);
    c
}

/// What an impulse and a change of the force do to block coordinates: rates jump, and so does the rest that they count from.
pub(super) fn jump(
    system: &HybridSystem,
    flow: &Flow,
    impulse: f64,
    [before, after]: [f64; 2],
    answer: &[f64],
) -> Few<[f64; 2]> {
    let still = DrivePhase::default();
    let [rest, _] = flow.at_rest(before, still);
    let mut rate: Vec<f64> = answer.iter().map(|jump| impulse * jump).collect();
    for &j in &flow.modes.attached {
        // The particle itself is not struck: its compression changes against the structure.
        let face = dot(&system.particles[j].floor.row, answer);
        rate.push(-impulse * face);
    }
    enter(flow, &rest, &rate, after, still).as_chunks().0.into()
}
