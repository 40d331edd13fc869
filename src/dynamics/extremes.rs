//! The range of an observed motion: its largest and smallest displacement and velocity, on the exact flow.
//!
//! A segment is walked in steps short against everything that still moves. Where a derivative changes its sign within a step, and the
//! crest may be the highest so far, it is closed in on. A pair of extrema within one step, which escapes that, differs by far less than
//! the range. Most of a segment is passed over: while
//!
//! s + s′τ ± ½ max|s″| τ²
//!
//! keeps within the range that is known, for s the displacement and the velocity, nothing new can come. Steps and jumps are 2ⁿ of the
//! shortest step, so that a few kernels a block are enough.

use super::block::{Block, Kernel, Phase};
use super::crest::{Motion, Node, crest};
use super::parabola::Parabola;

/// Steps a radian of the fastest block that moves visibly.
const STEPS_A_RADIAN: f64 = 4.0;
/// Share of the whole below which a block does not move visibly.
const INVISIBLE: f64 = 1e-13;
/// Strides after each other by kernels; their rounding adds up to some 1e-14 of the motion.
const STRIDES_IN_A_ROW: u64 = 32;
/// Derivatives of a share up to this one are bounded.
const THIRD: f64 = 3.0;
/// Most steps of a segment.
const MOST_STEPS: f64 = 1e6;

/// The range of an observed motion; lowest and highest value, NaN where nobody looked.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Extremes {
    /// m.
    pub displacement: [f64; 2],
    /// m/s.
    pub velocity: [f64; 2],
}

impl Default for Extremes {
    fn default() -> Self {
        Self { displacement: [f64::NAN; 2], velocity: [f64::NAN; 2] }
    }
}

impl Extremes {
    /// Of the displacement, order 0, or of the velocity.
    pub(crate) fn of(&self, order: usize) -> [f64; 2] {
        if order == 0 { self.displacement } else { self.velocity }
    }

    /// Takes an instant into the range.
    pub(crate) fn take(&mut self, displacement: f64, velocity: f64) {
        // The smaller of NaN and a number is the number.
        for (range, value) in [(&mut self.displacement, displacement), (&mut self.velocity, velocity)] {
            *range = [range[0].min(value), range[1].max(value)];
        }
    }
}

/// Takes the segment of `length` seconds that starts with these phases into the range.
pub(crate) fn take(extremes: &mut Extremes, blocks: &[Block], start: &[Phase], rest: Parabola, length: f64) {
    let advance = |block: &Block, phase: &Phase, t: f64| block.advance(*phase, block.kernel(t));
    let at = |t: f64| motion(blocks, blocks.iter().zip(start).map(|(block, phase)| advance(block, phase, t)), rest, t);
    let node = |time: f64, phases: &[Phase]| {
        let [displacement, velocity, acceleration, _] = motion(blocks, phases.iter().copied(), rest, time);
        Node { time, motion: [displacement, velocity, acceleration] }
    };
    let mut phases = start.to_vec();
    let mut here = node(0.0, &phases);
    extremes.take(here.motion[0], here.motion[1]);
    let mut bounds = Bounds { speeds: vec![0.0; blocks.len()], bend: 0.0, snap: 0.0 };
    let fastest = bounds.renew(blocks, &phases, rest, length);
    let steps = (STEPS_A_RADIAN * fastest * length).ceil().clamp(1.0, MOST_STEPS);
    let (last, step) = (steps as u64, length / steps);
    let mut strides: Vec<Vec<Kernel>> = Vec::new();
    let (mut place, mut taken, mut short) = (0_u64, 0_u64, 1_u64);
    while place < last {
        let left = last - place;
        // Surely within the range for so many steps; else as far as a crest does not escape.
        let within = (bounds.within(&here, extremes) / step) as u64;
        if within >= left {
            break;
        }
        let jumps = within > short;
        let doublings = (if jumps { within } else { short.min(left) }).ilog2();
        while strides.len() <= doublings as usize {
            let stride = step * (1_u64 << strides.len()) as f64;
            strides.push(blocks.iter().map(|block| block.kernel(stride)).collect());
        }
        place += 1 << doublings;
        taken += 1;
        let t = if place == last { length } else { length * (place as f64 / steps) };
        if taken.is_multiple_of(STRIDES_IN_A_ROW) || place == last {
            let from = blocks.iter().zip(start);
            phases.iter_mut().zip(from).for_each(|(now, (block, from))| *now = advance(block, from, t));
        } else {
            let kernels = blocks.iter().zip(&strides[doublings as usize]);
            phases.iter_mut().zip(kernels).for_each(|(now, (block, kernel))| *now = block.advance(*now, *kernel));
        }
        let next = node(t, &phases);
        extremes.take(next.motion[0], next.motion[1]);
        for order in if jumps { 0..0 } else { 0..2 } {
            if let Some(turn) = crest(order, here, next, || extremes.of(order), at) {
                extremes.take(turn[0], turn[1]);
            }
        }
        here = next;
        let fastest = bounds.renew(blocks, &phases, rest, length - t);
        short = (1.0 / (STEPS_A_RADIAN * fastest * step)).clamp(1.0, MOST_STEPS) as u64;
    }
}

/// The motion whose blocks are in these phases.
fn motion(blocks: &[Block], phases: impl Iterator<Item = Phase>, rest: Parabola, t: f64) -> Motion {
    let mut motion = [rest.at(t), rest.rate(t), 2.0 * rest.p2, 0.0];
    blocks.iter().zip(phases).for_each(|(block, phase)| block.add_motion(&mut motion, phase));
    motion
}

/// What bounds a motion from an instant to the end of its segment.
struct Bounds {
    /// The velocity of each block's share, m/s.
    speeds: Vec<f64>,
    /// The acceleration, m/s².
    bend: f64,
    /// The rate of that, m/s³.
    snap: f64,
}

impl Bounds {
    /// The bounds from now on, for `left` seconds. Gives the radius of the fastest block that moves visibly.
    fn renew(&mut self, blocks: &[Block], phases: &[Phase], rest: Parabola, left: f64) -> f64 {
        (self.bend, self.snap) = (2.0 * rest.p2.abs(), 0.0);
        let mut whole = 0.0;
        for ((speed, block), phase) in self.speeds.iter_mut().zip(blocks).zip(phases) {
            *speed = block.amplitude(*phase, THIRD, left) * block.radius;
            whole += *speed;
            self.bend += *speed * block.radius;
            self.snap += *speed * (block.radius * block.radius);
        }
        let visible = self.speeds.iter().zip(blocks).filter(|(speed, _)| **speed > INVISIBLE * whole);
        visible.fold(0.0_f64, |fastest, (_, block)| fastest.max(block.radius))
    }

    /// For how long displacement and velocity keep within what is known of them.
    fn within(&self, here: &Node, known: &Extremes) -> f64 {
        let [displacement, velocity, acceleration] = here.motion;
        let of = |order: usize, value: f64, slope: f64, curvature: f64| {
            let [low, high] = known.of(order);
            until(high - value, slope, curvature).min(until(value - low, -slope, curvature))
        };
        of(0, displacement, velocity, self.bend).min(of(1, velocity, acceleration, self.snap))
    }
}

/// When bτ + ½cτ², c ≥ 0, comes to `room`; 0 where there is none.
fn until(room: f64, slope: f64, curvature: f64) -> f64 {
    if !(room > 0.0) {
        return 0.0;
    }
    let root = (slope * slope + 2.0 * curvature * room).sqrt();
    if slope > 0.0 { 2.0 * room / (slope + root) } else { (root - slope) / curvature }
}
