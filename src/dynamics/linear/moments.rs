//! Moments: Σ c and Σ c cᵀ over any number of cycles, by doubling.
//!
//! Every measure that is an integral of x, x² or v² over cycles is linear in them, so that a million cycles cost twenty
//! squarings and no digit: nothing is divided by I − E, which vanishes at resonance.

use super::cycle::{Affine, product, times};
use crate::dynamics::block::{pairs, transposed};

/// Sums over the states of several cycles at the same time within each.
#[derive(Debug, Clone)]
pub(super) struct Moments {
    /// Cycles.
    pub(super) count: f64,
    /// Σ c, block by block.
    pub(super) first: Vec<[f64; 2]>,
    /// Σ cₖ cₗᵀ for every one of the [`pairs`].
    pub(super) second: Vec<[f64; 4]>,
}

impl Moments {
    fn none(blocks: usize) -> Self {
        Self { count: 0.0, first: vec![[0.0; 2]; blocks], second: vec![[0.0; 4]; blocks * (blocks + 1) / 2] }
    }

    /// Of one state.
    fn of(c: &[f64]) -> Self {
        let first: Vec<[f64; 2]> = c.chunks_exact(2).map(|pair| [pair[0], pair[1]]).collect();
        let second = pairs(first.len()).map(|(k, l)| outer(first[k], first[l])).collect();
        Self { count: 1.0, first, second }
    }

    /// Of `cycles` states, the first of them `start` and each the `map` of the one before.
    pub(super) fn over(map: &Affine, start: &[f64], cycles: u64) -> Self {
        let mut sum = Self::none(start.len() / 2);
        // The map of as many cycles as are summed up so far.
        let mut power: Option<Affine> = None;
        for bit in (0..u64::BITS - cycles.leading_zeros()).rev() {
            if let Some(so_far) = &power {
                sum.add(&sum.moved(so_far));
                power = Some(so_far.then(so_far));
            }
            if cycles >> bit & 1 == 1 {
                sum = sum.moved(map);
                sum.add(&Self::of(start));
                power = Some(power.map_or_else(|| map.clone(), |so_far| so_far.then(map)));
            }
        }
        sum
    }

    pub(super) fn add(&mut self, other: &Self) {
        self.count += other.count;
        for (sum, more) in self.first.iter_mut().zip(&other.first) {
            sum.iter_mut().zip(more).for_each(|(sum, more)| *sum += more);
        }
        for (sum, more) in self.second.iter_mut().zip(&other.second) {
            sum.iter_mut().zip(more).for_each(|(sum, more)| *sum += more);
        }
    }

    /// The same states, all of them mapped.
    pub(super) fn moved(&self, map: &Affine) -> Self {
        let turned: Vec<[f64; 2]> =
            map.turn.iter().zip(&self.first).map(|(turn, first)| times(*turn, *first)).collect();
        let shifts = map.shift.iter().any(|shift| *shift != [0.0; 2]);
        let mut second = Vec::with_capacity(self.second.len());
        for ((k, l), old) in pairs(self.first.len()).zip(&self.second) {
            let mut new = product(product(map.turn[k], *old), transposed(map.turn[l]));
            if shifts {
                let (dk, dl) = (map.shift[k], map.shift[l]);
                let parts = [outer(turned[k], dl), outer(dk, turned[l]), outer(dk, dl).map(|part| self.count * part)];
                for part in parts {
                    new.iter_mut().zip(part).for_each(|(sum, more)| *sum += more);
                }
            }
            second.push(new);
        }
        let first = turned
            .iter()
            .zip(&map.shift)
            .map(|(turned, shift)| [turned[0] + self.count * shift[0], turned[1] + self.count * shift[1]])
            .collect();
        Self { count: self.count, first, second }
    }

    /// The mean state.
    pub(super) fn mean(&self) -> Vec<f64> {
        self.first.iter().flatten().map(|sum| sum / self.count).collect()
    }
}

pub(super) fn outer([a, b]: [f64; 2], [x, y]: [f64; 2]) -> [f64; 4] {
    [a * x, a * y, b * x, b * y]
}
