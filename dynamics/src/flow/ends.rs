//! Whether the ends of a short segment leave digits of ∫ s′² dt.
//!
//! In closed form it is a difference of squares that may be larger than it by far: its rounding is some ε A² over the slowest rate, with A
//! the sum of amplitude·radius over all blocks. No velocity in the segment is known before it is integrated; those at its ends stand for it.
//!
//! Amplitudes are worked out signal by signal, from shares that have to be gathered first. A bound is one sum over the coordinates,
//! A ≤ Σ w |c| with fixed weights w, for several signals at once; where it is small enough, as nearly everywhere, A is, too. That takes an
//! eighth off the time of a run on a plate.

use crate::arithmetic::four::Four;
use crate::arithmetic::lanes::WIDTH;
use crate::contact_state::bank::{Bank, Blocks, Phases};
use crate::contact_state::block::Block;
use crate::flow::signals::Row;

/// Share of an integral that its rounding stays below.
const LOST: f64 = 1e-9;
/// Of a sum in another order.
const SAFE: f64 = 0.99;

/// The bounds of a flow's signals.
pub(crate) struct Ends {
    /// Of four signals at a time, by coordinate: weights of the rate, and those that bound A.
    weights: Vec<Vec<[Four; 2]>>,
}

impl Ends {
    pub(crate) fn new(rows: &[&Row], blocks: &[Block]) -> Self {
        let of = |row: &&Row| -> Vec<[f64; 2]> {
            let each = blocks.iter().zip(&row.weights).flat_map(|(block, &[v0, v1, r0, r1])| {
                let spread = if block.is_near_critical() { 0.0 } else { block.inverse_root };
                [[v0, r0], [v1, r1]]
                    .map(|[v, r]| [r, block.radius * (v.abs() + (r + block.decay * v).abs() * spread.abs())])
            });
            each.collect()
        };
        let several = |rows: &[&Row]| {
            let all: Vec<Vec<[f64; 2]>> = rows.iter().map(of).collect();
            let at = |i: usize| [0, 1].map(|part| Four::padded(all.iter().map(|row| row[i][part])));
            (0..2 * blocks.len()).map(at).collect()
        };
        Self { weights: rows.chunks(WIDTH).map(several).collect() }
    }

    /// Numbers that it keeps.
    pub(crate) fn size(&self) -> usize {
        self.weights.iter().map(|of| 2 * WIDTH * of.len()).sum()
    }

    /// No signal loses its digits, as far as the bound tells, between these coordinates; the slowest block turns by `turn`.
    #[inline(always)]
    pub(crate) fn keep_digits(&self, [start, end]: [&[f64]; 2], turn: f64) -> bool {
        self.weights.iter().all(|weights| {
            let mut sums = [Four::ZERO; 3];
            for ((&[rate, bound], &from), &to) in weights.iter().zip(start).zip(end) {
                let [first, last, most] = sums;
                sums = [first + rate * from, last + rate * to, most + bound * from.abs()];
            }
            let [first, last, most] = sums;
            let fastest = (first * first).zip(last * last, f64::max);
            // Of signals that are none both sides are zero.
            (most * most).zip(fastest, |most, fastest| f64::EPSILON * most - SAFE * LOST * turn * fastest).largest()
                <= 0.0
        })
    }
}

/// The same of one signal, by its amplitudes.
pub(crate) fn cancel(row: &Row, bank: &Bank, [start, end]: [&[f64]; 2], turn: f64) -> bool {
    let rate = |c| row.together(c).map(|shares| shares.rate.sum()).sum::<f64>();
    let reach = |(blocks, shares): (&Blocks, Phases)| (blocks.amplitudes(shares) * blocks.radius).sum();
    let reach: f64 = bank.blocks.iter().zip(row.together(start)).map(reach).sum();
    let fastest = rate(start).abs().max(rate(end).abs());
    f64::EPSILON * reach * reach > LOST * (fastest * fastest) * turn
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::flow::parabola::Parabola;

    #[test]
    fn where_the_bound_tells_that_digits_are_kept_the_amplitudes_tell_so_too() {
        let matrices = [
            [0.0, 1.0, -9e4, -3.0],
            [0.0, 1.0, -25.0, -4.0],
            [-5.0, 140.0, -150.0, -40.0],
            [0.0, 1.0, -9.0, -40.0],
            [0.0, 1.0, -4.0, -0.1],
        ];
        let blocks = matrices.map(Block::new);
        let bank = Bank::default().of(&blocks);
        let none = Parabola::default();
        let row = |scale: f64| Row {
            weights: (0..blocks.len())
                .map(|k| [1.0, 0.1, -0.2, 1.0].map(|weight| weight * libm::pow(scale, k as f64)))
                .collect(),
            gravity: none,
            force: none,
        };
        let rows = [0.01, 0.3, 1.0, 2.0, 30.0].map(row);
        let coordinates = |seed: f64| -> Vec<f64> {
            (0..2 * WIDTH * bank.blocks.len())
                .map(|i| if i < 2 * blocks.len() { libm::sin(seed * (i + 1) as f64) } else { 0.0 })
                .collect()
        };
        let mut counts = [0, 0];
        for seed in 1..200 {
            let [start, end] = [f64::from(seed), 0.5 + f64::from(seed)].map(coordinates);
            for turn in [1e-2, 1e-4, 1e-6, 1e-8] {
                // Of one signal, and of five, which takes two registers.
                for some in (0..rows.len()).map(|i| &rows[i..=i]).chain([&rows[..]]) {
                    let keep = Ends::new(&some.iter().collect::<Vec<_>>(), &blocks).keep_digits([&start, &end], turn);
                    let lost = some.iter().any(|row| cancel(row, &bank, [&start, &end], turn));
                    assert!(!(keep && lost), "seed {seed}, turn {turn}");
                    counts[usize::from(keep)] += 1;
                }
            }
        }
        assert!(counts.iter().all(|count| *count > 50), "{counts:?}");
    }
}
