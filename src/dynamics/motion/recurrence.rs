//! Which states come again: the ends of cycles compared with each other, in units of the motion.

use std::f64::consts::TAU;

use super::tape::{End, Reach};
use crate::dynamics::system::HybridSystem;

/// Longest period that is looked for, in cycles of the drive.
const LONGEST: usize = 32;
/// Periods that are tried by their multipliers.
const TRIED: usize = 4;

/// The motion's own units: what its lengths and speeds reach, of structure and particles each.
pub(super) struct Scale {
    /// Coordinates of the structure.
    order: usize,
    /// Coordinates of structure and particles.
    half: usize,
    /// Length and speed.
    structure: [f64; 2],
    particles: [f64; 2],
}

impl Scale {
    pub(super) fn new(system: &HybridSystem, reach: &Reach) -> Self {
        let order = system.mass.order;
        let half = order + system.particles.len();
        let reach = |first: usize, count: usize| {
            let (mut length, mut speed) = (0.0_f64, 0.0_f64);
            for i in first..first + count {
                let [low, high] = reach.of(i);
                length = length.max(high - low);
                let [low, high] = reach.of(half + i);
                speed = speed.max(high.max(-low));
            }
            let turn = system.drive.period / TAU;
            length = length.max(speed * turn);
            [length, speed.max(length / turn)]
        };
        let (structure, particles) = (reach(0, order), reach(order, half - order));
        let some = |own: [f64; 2], other: [f64; 2]| if own[0] > 0.0 { own } else { other };
        let one = |own: [f64; 2]| if own[0] > 0.0 { own } else { [1.0; 2] };
        Self { order, half, structure: one(some(structure, particles)), particles: one(some(particles, structure)) }
    }

    /// The unit of number `i` of a state.
    pub(super) fn unit(&self, i: usize) -> f64 {
        let of = if i % self.half < self.order { self.structure } else { self.particles };
        of[i / self.half]
    }

    /// From one state to another.
    pub(super) fn miss(&self, from: &End, to: &End) -> impl Iterator<Item = f64> {
        let pairs = from.state.iter().zip(&to.state).enumerate();
        pairs.map(|(i, (from, to))| (to - from) / self.unit(i))
    }

    /// The largest part of the way from one state to another; infinite between different contacts.
    pub(super) fn apart(&self, one: &End, other: &End) -> f64 {
        if one.contacts != other.contacts {
            return f64::INFINITY;
        }
        self.miss(one, other).fold(0.0, |most, x| most.max(x.abs()))
    }
}

/// Periods after which the last state has come again to within `near`, the shortest first.
pub(super) fn candidates(scale: &Scale, ends: &[End], near: f64) -> Vec<usize> {
    let Some((last, before)) = ends.split_last() else { return Vec::new() };
    let close = before.iter().rev().take(LONGEST).enumerate().filter(|(_, end)| scale.apart(end, last) <= near);
    close.map(|(i, _)| i + 1).take(TRIED).collect()
}

/// The cycle after which every state comes again after `period` cycles, to within `tolerance`.
pub(super) fn settled_after(scale: &Scale, ends: &[End], period: usize, tolerance: f64) -> usize {
    let repeats = |i: &usize| scale.apart(&ends[i - period], &ends[*i]) <= tolerance;
    let first = (period..ends.len()).rev().take_while(repeats).last().unwrap_or(ends.len());
    first - period + 1
}

/// How much closer the states of the second half of a run come to their own past than those of the first, over the period of
/// the closest return: 1 where the motion goes on as it is, less where it still settles.
pub(super) fn closing(scale: &Scale, ends: &[End]) -> f64 {
    let Some((last, before)) = ends.split_last() else { return f64::NAN };
    let recent = before.iter().rev().take(LONGEST).enumerate().map(|(i, end)| (i + 1, scale.apart(end, last)));
    let Some((period, _)) = recent.min_by(|a, b| a.1.total_cmp(&b.1)) else { return f64::NAN };
    let returns: Vec<f64> = (period..ends.len()).map(|i| scale.apart(&ends[i - period], &ends[i])).collect();
    let (first, second) = returns.split_at(returns.len() / 2);
    let mean = |part: &[f64]| part.iter().sum::<f64>() / part.len() as f64;
    mean(second) / mean(first)
}
