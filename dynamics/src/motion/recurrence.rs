//! Which states come again: the ends of cycles compared with each other, in units of the motion.

use std::f64::consts::TAU;

use super::tape::{End, Reach};
use crate::arithmetic::matrix::mean;
use crate::system::HybridSystem;

/// Longest period that is looked for, in cycles of the drive.
const LONGEST: usize = 32;
/// Periods that are tried by their multipliers.
const TRIED: usize = 4;

/// Share of the units of structure and particles that those of the other are at least: a stop is a particle that does not move.
const LEAST: f64 = 1e-2;

/// The motion's own units: what its lengths and speeds reach, of structure and particles each.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Scale {
    /// Coordinates of the structure.
    order: usize,
    /// Coordinates of structure and particles.
    half: usize,
    /// Length and speed.
    structure: [f64; 2],
    particles: [f64; 2],
}

impl Scale {
    pub(crate) fn new(system: &HybridSystem, reach: &Reach) -> Self {
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

    /// Of one period, whose ends say little: the structure moves at `speed` on average.
    pub(crate) fn of_period(system: &HybridSystem, reach: &Reach, speed: f64) -> Self {
        let mut scale = Self::new(system, reach);
        let moves = [speed * system.drive.period / TAU, speed];
        for ((structure, particles), least) in scale.structure.iter_mut().zip(&mut scale.particles).zip(moves) {
            *structure = structure.max(least).max(LEAST * *particles);
            *particles = particles.max(LEAST * *structure);
        }
        scale
    }

    /// The unit of number `i` of a state.
    pub(crate) fn unit(&self, i: usize) -> f64 {
        let of = if i % self.half < self.order { self.structure } else { self.particles };
        of[i / self.half]
    }

    /// The unit that number `i` of a state rounds in, relative to its own: particles and structure move with each other.
    pub(crate) fn rounds(&self, i: usize) -> f64 {
        let kind = i / self.half;
        self.structure[kind].max(self.particles[kind]) / self.unit(i)
    }

    /// From one state to another.
    pub(crate) fn miss(&self, from: &End, to: &End) -> impl Iterator<Item = f64> {
        let pairs = from.state.iter().zip(&to.state).enumerate();
        pairs.map(|(i, (from, to))| (to - from) / self.unit(i))
    }

    /// The largest part of the way from one state to another; infinite between different contacts.
    pub(crate) fn apart(&self, one: &End, other: &End) -> f64 {
        if one.contacts != other.contacts {
            return f64::INFINITY;
        }
        self.miss(one, other).fold(0.0, |most, x| most.max(x.abs()))
    }
}

/// A motion that comes again, by its states at the ends of the cycles of one period.
#[derive(Debug, Clone, PartialEq)]
pub struct Recurring {
    scale: Scale,
    ends: Vec<End>,
    /// How far the run may be from the orbit that closes, in units of the motion.
    within: f64,
}

impl Recurring {
    pub(super) fn new(scale: &Scale, ends: &[End], within: f64) -> Self {
        Self { scale: scale.clone(), ends: ends.to_vec(), within }
    }

    /// Both are the same motion, be it some cycles later: each run is as near to its orbit as its naming asks for, so that two of one
    /// orbit are no farther apart than both of that together.
    #[must_use]
    pub fn is(&self, other: &Self) -> bool {
        let Some(last) = self.ends.last() else { return false };
        let unit = |i: usize| self.within * self.scale.unit(i) + other.within * other.scale.unit(i);
        let meets = |end: &End| {
            let mut pairs = end.state.iter().zip(&last.state).enumerate();
            end.contacts == last.contacts && pairs.all(|(i, (a, b))| (a - b).abs() <= unit(i))
        };
        self.ends.len() == other.ends.len() && other.ends.iter().any(meets)
    }
}

/// Periods after which the last state has come again to within `near`, the shortest first.
pub(crate) fn candidates(scale: &Scale, ends: &[End], near: f64) -> Vec<usize> {
    let Some((last, before)) = ends.split_last() else { return Vec::new() };
    let close = before.iter().rev().take(LONGEST).enumerate().filter(|(_, end)| scale.apart(end, last) <= near);
    close.map(|(i, _)| i + 1).take(TRIED).collect()
}

/// The period after which the last state comes closest to itself, and how close.
pub(crate) fn closest(scale: &Scale, ends: &[End]) -> Option<(usize, f64)> {
    let (last, before) = ends.split_last()?;
    let returns = before.iter().rev().take(LONGEST).enumerate().map(|(i, end)| (i + 1, scale.apart(end, last)));
    returns.min_by(|a, b| a.1.total_cmp(&b.1))
}

/// The cycle, counted from one, after which every state comes again after `period` cycles, to within `tolerance`.
pub(super) fn settled_after(scale: &Scale, ends: &[End], period: usize, tolerance: f64) -> usize {
    let repeats = |i: &usize| scale.apart(&ends[i - period], &ends[*i]) <= tolerance;
    let first = (period..ends.len()).rev().take_while(repeats).last().unwrap_or(ends.len());
    first - period + 1
}

/// How much closer the states of the second half of a run come to their own past than those of the first, over the period of
/// the closest return: 1 where the motion goes on as it is, less where it still settles.
pub(super) fn closing(scale: &Scale, ends: &[End]) -> f64 {
    let Some((period, _)) = closest(scale, ends) else { return f64::NAN };
    let returns: Vec<f64> = (period..ends.len()).map(|i| scale.apart(&ends[i - period], &ends[i])).collect();
    let (first, second) = returns.split_at(returns.len() / 2);
    mean(second) / mean(first)
}
