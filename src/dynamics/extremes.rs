//! The range of an observed motion: its largest and smallest displacement and velocity, on the exact flow.
//!
//! A segment is walked in steps short against everything that still moves, all of one length, so that one kernel a block takes it from
//! step to step. Where a derivative changes its sign within a step, and the crest may be the highest so far, it is closed in on. A pair of
//! extrema within one step, which escapes that, differs by far less than the range.

use super::block::{Block, Kernel, Phase};
use super::crest::{Motion, Node, crest};
use super::parabola::Parabola;

/// Steps a radian of the fastest block that moves visibly.
const STEPS_A_RADIAN: f64 = 4.0;
/// Share of the whole below which a block does not move visibly.
const INVISIBLE: f64 = 1e-13;
/// Steps after each other by one kernel; their rounding adds up to some 1e-14 of the motion.
const STEPS_OF_ONE_KERNEL: u64 = 32;
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
    let motion = |phases: &mut dyn Iterator<Item = Phase>, t: f64| -> Motion {
        let mut motion = [rest.at(t), rest.rate(t), 2.0 * rest.p2, 0.0];
        blocks.iter().zip(phases).for_each(|(block, now)| block.add_motion(&mut motion, now));
        motion
    };
    let at = |t: f64| motion(&mut blocks.iter().zip(start).map(|(block, phase)| advance(block, phase, t)), t);
    let speed = |(block, phase): (&Block, &Phase)| (phase.value * block.radius).abs().max(phase.rate.abs());
    let whole: f64 = blocks.iter().zip(start).map(speed).sum();
    let fastest = blocks
        .iter()
        .zip(start)
        .filter(|pair| speed(*pair) > INVISIBLE * whole)
        .fold(0.0_f64, |fastest, (block, _)| fastest.max(block.radius));
    let steps = (STEPS_A_RADIAN * fastest * length).ceil().clamp(1.0, MOST_STEPS);
    let of_a_step: Vec<Kernel> = blocks.iter().map(|block| block.kernel(length / steps)).collect();
    let mut phases = start.to_vec();
    let node = |time: f64, [displacement, velocity, acceleration, _]: Motion| Node {
        time,
        motion: [displacement, velocity, acceleration],
    };
    let mut here = node(0.0, motion(&mut phases.iter().copied(), 0.0));
    extremes.take(here.motion[0], here.motion[1]);
    for step in 1..=steps as u64 {
        let t = if step as f64 == steps { length } else { length * (step as f64 / steps) };
        if step.is_multiple_of(STEPS_OF_ONE_KERNEL) || t == length {
            phases
                .iter_mut()
                .zip(blocks.iter().zip(start))
                .for_each(|(now, (block, from))| *now = advance(block, from, t));
        } else {
            let kernels = blocks.iter().zip(&of_a_step);
            phases.iter_mut().zip(kernels).for_each(|(now, (block, kernel))| *now = block.advance(*now, *kernel));
        }
        let next = node(t, motion(&mut phases.iter().copied(), t));
        extremes.take(next.motion[0], next.motion[1]);
        for order in [0, 1] {
            if let Some(turn) = crest(order, here, next, extremes.of(order), at) {
                extremes.take(turn[0], turn[1]);
            }
        }
        here = next;
    }
}
