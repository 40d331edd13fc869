//! Moments: mean and spread of c over any number of cycles, by doubling.
//!
//! Every measure that is an integral of x, x² or v² over cycles is linear in Σ c and Σ c cᵀ, so that a million cycles cost
//! twenty squarings and no digit: nothing is divided by I − E, which vanishes at resonance. Second moments are kept about the
//! mean: a motion that hardly moves far from its rest keeps its digits (Chan, Golub & LeVeque, Am. Stat. 37, 1983).

use super::cycle::{Affine, product, sum, times};
use crate::contact_state::block::{pairs, transposed};

/// Of the states of several cycles at the same time within each.
#[derive(Debug, Clone)]
pub(super) struct Moments {
    /// Cycles.
    pub(super) count: f64,
    /// Mean of c, block by block.
    pub(super) mean: Vec<[f64; 2]>,
    /// Σ (cₖ − mean)(cₗ − mean)ᵀ for every one of the [`pairs`].
    pub(super) spread: Vec<[f64; 4]>,
}

impl Moments {
    fn none(blocks: usize) -> Self {
        Self { count: 0.0, mean: vec![[0.0; 2]; blocks], spread: vec![[0.0; 4]; blocks * (blocks + 1) / 2] }
    }

    /// Of one state.
    fn of(c: &[f64]) -> Self {
        Self { count: 1.0, mean: c.as_chunks().0.to_vec(), ..Self::none(c.len() / 2) }
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
        let count = self.count + other.count;
        let share = other.count / count;
        let apart: Vec<[f64; 2]> = self.mean.iter().zip(&other.mean).map(|([a, b], [x, y])| [x - a, y - b]).collect();
        for (((k, l), sum), more) in pairs(apart.len()).zip(&mut self.spread).zip(&other.spread) {
            let between = outer(apart[k], apart[l]).map(|part| self.count * share * part);
            (0..4).for_each(|i| sum[i] += more[i] + between[i]);
        }
        for (mean, apart) in self.mean.iter_mut().zip(&apart) {
            *mean = [mean[0] + share * apart[0], mean[1] + share * apart[1]];
        }
        self.count = count;
    }

    /// The same states, all of them mapped.
    pub(super) fn moved(&self, map: &Affine) -> Self {
        let mean = map.turn.iter().zip(&self.mean).zip(&map.shift);
        let turned =
            |((k, l), old): ((usize, usize), &[f64; 4])| product(product(map.turn[k], *old), transposed(map.turn[l]));
        Self {
            count: self.count,
            mean: mean.map(|((turn, mean), shift)| sum(times(*turn, *mean), *shift)).collect(),
            spread: pairs(self.mean.len()).zip(&self.spread).map(turned).collect(),
        }
    }

    /// Σ c.
    pub(super) fn first(&self) -> Vec<[f64; 2]> {
        self.mean.iter().map(|mean| mean.map(|part| self.count * part)).collect()
    }

    /// Σ cₖ cₗᵀ for every one of the [`pairs`].
    pub(super) fn second(&self) -> Vec<[f64; 4]> {
        let whole = |((k, l), spread): ((usize, usize), &[f64; 4])| {
            let square = outer(self.mean[k], self.mean[l]);
            std::array::from_fn(|i| spread[i] + self.count * square[i])
        };
        pairs(self.mean.len()).zip(&self.spread).map(whole).collect()
    }
}

pub(super) fn outer([a, b]: [f64; 2], [x, y]: [f64; 2]) -> [f64; 4] {
    [a * x, a * y, b * x, b * y]
}
