//! Cells: the motion of a few blocks over a fixed length of time, from tables that are built once.
//!
//! A block's share is value·A(t) + rate·B(t), and over a cell of D seconds A and B are fixed functions of σ = t/D. Their expansion in
//! Chebyshev polynomials, cut after the seventh, leaves out some 1e-5 of the amplitude:
//!
//! A(σD) − 1 = Σⱼ cⱼ T*ⱼ(σ),   |what is left out| ≤ Σ |cⱼ| from the eighth on,
//!
//! so that what a guard does in half a turn of the fastest block is known from eight numbers a block: no power, no change of
//! basis, no exponential. Where a guard starts at zero it is looked at divided by a power of σ, with tables of its own.

use std::cell::OnceCell;

use crate::arithmetic::four::Four;
use crate::arithmetic::lanes::WIDTH;
use crate::contact_state::bank::{Bank, Kernels, Phases, Transfer};
use crate::contact_state::block::Block;
use crate::flow::series::taylor;

/// ρD of the fastest block: half a turn and a little, since that is how long a face holds a particle.
pub(crate) const REACH: f64 = 3.3;
/// Cells of a segment.
pub(crate) const MOST: usize = 4;
/// Coefficients of a cell.
pub(crate) const KEPT: usize = 8;
/// Coefficients that are worked out: 3.3³⁰/30! is below rounding.
const TERMS: usize = 30;
/// Roundings of a coefficient that a table may be off by.
const ROUNDINGS: f64 = 32.0 * f64::EPSILON;

/// Coefficients of a polynomial on a cell: in Bernstein's form or by powers of σ, by registers.
pub(crate) type Cell = [Four; KEPT / WIDTH];

/// The cells of a flow of no more than one register of blocks.
#[derive(Debug)]
pub(crate) struct Cells {
    /// D, s.
    pub(crate) length: f64,
    /// From a segment's start to that of each cell.
    pub(crate) transfers: [Transfer; MOST],
    blocks: usize,
    /// Of A − 1 and B − t, and of both over σ.
    tables: [Tables; 2],
    /// What of both is of higher order, over σ² and over σ³; few motions ask for them.
    higher: OnceCell<Box<[Tables; 2]>>,
}

/// The shares of all blocks over a cell.
#[derive(Debug)]
pub(crate) struct Tables {
    /// Block by block, for its value and its rate.
    bernstein: [[Cell; 2]; WIDTH],
    powers: [[Cell; 2]; WIDTH],
    /// Bounds of what is left out, of its slope, and of the bend of what is kept, by value and by rate.
    bounds: [[Four; 2]; 3],
}

impl Cells {
    /// Of these blocks, which have one register.
    #[cold]
    pub(crate) fn new(bank: &Bank, each: &[Block], pace: f64) -> Self {
        let length = REACH / pace;
        let mut transfers = [Transfer::NONE; MOST];
        for (i, transfer) in transfers.iter_mut().enumerate().skip(1) {
            let mut kernels = [Kernels::NONE];
            bank.kernels(each, i as f64 * length, &mut kernels);
            *transfer = kernels[0].transfer();
        }
        Self {
            length,
            transfers,
            blocks: each.len(),
            tables: [0, 1].map(|order| Tables::new(each, length, order)),
            higher: OnceCell::new(),
        }
    }

    /// Numbers that they keep.
    pub(crate) const fn size() -> usize {
        (size_of::<Self>() + size_of::<[Tables; 2]>()) / size_of::<f64>()
    }

    /// The tables of these blocks for a guard that starts as σ to this power.
    #[inline(always)]
    pub(crate) fn tables(&self, each: &[Block], order: usize) -> &Tables {
        self.tables.get(order).unwrap_or_else(|| {
            let higher = || Box::new([2, 3].map(|order| Tables::new(each, self.length, order)));
            &self.higher.get_or_init(higher)[order - 2]
        })
    }

    /// What the shares do beside their values and slopes at the cell's start, in Bernstein's form.
    #[inline(always)]
    pub(crate) fn bernstein(&self, tables: &Tables, shares: Phases) -> Cell {
        self.sum(&tables.bernstein, shares)
    }

    /// The same by powers.
    #[inline(always)]
    pub(crate) fn powers(&self, tables: &Tables, shares: Phases) -> Cell {
        self.sum(&tables.powers, shares)
    }

    #[inline(always)]
    fn sum(&self, table: &[[Cell; 2]; WIDTH], shares: Phases) -> Cell {
        let mut sum = [Four::ZERO; KEPT / WIDTH];
        for (lane, [value, rate]) in table.iter().enumerate().take(self.blocks) {
            let share = shares.at(lane);
            for ((sum, value), rate) in sum.iter_mut().zip(value).zip(rate) {
                *sum = *sum + (*value * share.value + *rate * share.rate);
            }
        }
        sum
    }
}

impl Tables {
    /// A bound on what is left out of the shares.
    #[inline(always)]
    pub(crate) fn left_out(&self, shares: Phases) -> f64 {
        self.bound(0, shares)
    }

    /// Bounds on the slope of what is left out, and on the bend of what is kept.
    #[inline(always)]
    pub(crate) fn turning(&self, shares: Phases) -> [f64; 2] {
        [self.bound(1, shares), self.bound(2, shares)]
    }

    #[inline(always)]
    fn bound(&self, which: usize, Phases { value, rate }: Phases) -> f64 {
        let [by_value, by_rate] = &self.bounds[which];
        (value.abs() * *by_value + rate.abs() * *by_rate).sum()
    }

    #[cold]
    fn new(each: &[Block], length: f64, order: usize) -> Self {
        let mut tables = Self {
            bernstein: [[[Four::ZERO; KEPT / WIDTH]; 2]; WIDTH],
            powers: [[[Four::ZERO; KEPT / WIDTH]; 2]; WIDTH],
            bounds: [[Four::ZERO; 2]; 3],
        };
        for (lane, block) in each.iter().enumerate() {
            let [mut value, mut rate] = taylor::<TERMS>(block, length);
            (value[0], rate[1]) = (0.0, 0.0);
            for (i, (series, unit)) in [(value, 1.0), (rate, length)].into_iter().enumerate() {
                let economised = Economised::new(&series[order..]);
                tables.bernstein[lane][i] = registers(economised.bernstein.map(|b| b * unit));
                tables.powers[lane][i] = registers(economised.powers.map(|a| a * unit));
                for (to, bound) in tables.bounds.iter_mut().zip(economised.bounds) {
                    to[i].set(lane, bound * unit);
                }
            }
        }
        tables
    }
}

fn registers(coefficients: [f64; KEPT]) -> Cell {
    let [a, b, c, d, e, f, g, h] = coefficients;
    [Four::new([a, b, c, d]), Four::new([e, f, g, h])]
}

/// A function on [0, 1], cut after the seventh Chebyshev polynomial.
struct Economised {
    bernstein: [f64; KEPT],
    powers: [f64; KEPT],
    bounds: [f64; 3],
}

impl Economised {
    fn new(taylor: &[f64]) -> Self {
        let mut chebyshev = [0.0; TERMS];
        for (t, row) in taylor.iter().zip(&POWERS_BY_CHEBYSHEV) {
            chebyshev.iter_mut().zip(row).for_each(|(c, e)| *c += t * e);
        }
        let (mut bernstein, mut powers) = ([0.0; KEPT], [0.0; KEPT]);
        for (j, c) in chebyshev.iter().enumerate().take(KEPT) {
            for i in 0..KEPT {
                bernstein[i] += c * CHEBYSHEV_BY_BERNSTEIN[j][i];
                powers[i] += c * CHEBYSHEV_BY_POWERS[j][i];
            }
        }
        let largest = |numbers: &[f64]| numbers.iter().fold(0.0_f64, |most, number| most.max(number.abs()));
        let rounding = ROUNDINGS * (largest(&bernstein) + largest(&powers) + largest(taylor));
        // The slope of eight powers that are each off by as much: 0 + 1 + … + 7 times.
        let (mut left_out, mut slope, mut bend) = (rounding, 28.0 * rounding, 0.0_f64);
        for (j, c) in chebyshev.iter().enumerate().skip(KEPT) {
            left_out += c.abs();
            slope += 2.0 * (j * j) as f64 * c.abs();
        }
        for [a, b, c] in bernstein.array_windows() {
            bend = bend.max((c - 2.0 * b + a).abs());
        }
        Self { bernstein, powers, bounds: [left_out, slope, ((KEPT - 1) * (KEPT - 2)) as f64 * bend] }
    }
}

/// x^i by T*ⱼ: x T*ⱼ = (T*ⱼ₊₁ + 2 T*ⱼ + T*ⱼ₋₁)/4.
const POWERS_BY_CHEBYSHEV: [[f64; TERMS]; TERMS] = {
    let mut rows = [[0.0; TERMS]; TERMS];
    rows[0][0] = 1.0;
    let mut i = 1;
    while i < TERMS {
        let mut j = 0;
        while j < i {
            let quarter = 0.25 * rows[i - 1][j];
            rows[i][j] += 2.0 * quarter;
            rows[i][j + 1] += if j == 0 { 2.0 * quarter } else { quarter };
            if j > 0 {
                rows[i][j - 1] += quarter;
            }
            j += 1;
        }
        i += 1;
    }
    rows
};

/// T*ⱼ by powers: T*ⱼ₊₁ = 2 (2x − 1) T*ⱼ − T*ⱼ₋₁.
const CHEBYSHEV_BY_POWERS: [[f64; KEPT]; KEPT] = {
    let mut rows = [[0.0; KEPT]; KEPT];
    rows[0][0] = 1.0;
    (rows[1][0], rows[1][1]) = (-1.0, 2.0);
    let mut j = 1;
    while j + 1 < KEPT {
        let mut i = 0;
        while i < KEPT {
            let before = if i > 0 { 4.0 * rows[j][i - 1] } else { 0.0 };
            rows[j + 1][i] = before - 2.0 * rows[j][i] - rows[j - 1][i];
            i += 1;
        }
        j += 1;
    }
    rows
};

/// The same in Bernstein's form: bᵢ = Σ_{m≤i} C(i, m)/C(7, m) aₘ.
const CHEBYSHEV_BY_BERNSTEIN: [[f64; KEPT]; KEPT] = {
    let mut rows = [[0.0; KEPT]; KEPT];
    let mut j = 0;
    while j < KEPT {
        let mut i = 0;
        while i < KEPT {
            // C(i, m)/C(7, m) from m to m + 1: (i − m)/(7 − m).
            let (mut m, mut share) = (0, 1.0);
            while m <= i {
                rows[j][i] += share * CHEBYSHEV_BY_POWERS[j][m];
                share *= (i - m) as f64 / (KEPT - 1 - m) as f64;
                m += 1;
            }
            i += 1;
        }
        j += 1;
    }
    rows
};

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_a_cell_leaves_out_stays_within_its_bounds_for_every_kind_of_block() {
        // Light and heavy damping, critical but for a rounding, a drift, a creep and one exponential alone, each with a fast neighbour.
        let matrices = [
            [0.0, 1.0, -900.0, -3.0],
            [0.0, 1.0, -9.0, -40.0],
            [0.0, 1.0, -100.0, -20.0 * (1.0 + f64::EPSILON)],
            [0.0, 1.0, 0.0, 0.0],
            [0.0, 1.0, 0.0, -7.0],
            [-12.0, 0.0, 0.0, -12.0],
        ];
        for own in matrices {
            let each = [own, [0.0, 1.0, -1600.0, -1.0]].map(Block::new);
            let bank = Bank::default().of(&each);
            let cells = Cells::new(&bank, &each, each[0].radius.max(each[1].radius));
            for (value, rate) in [(1.0, 0.0), (0.0, 30.0), (-0.4, 17.0)] {
                // One exponential alone knows no other rate.
                let own_rate = if each[0].is_single() { -each[0].decay * value } else { rate };
                let shares = Phases {
                    value: Four::new([value, 0.3 * value, 0.0, 0.0]),
                    rate: Four::new([own_rate, -rate, 0.0, 0.0]),
                };
                for order in 0..=3 {
                    // What is known of a guard that starts so: its value, its slope, and its bend.
                    let mut sum = [shares.value.sum(), shares.rate.sum() * cells.length, 0.0];
                    if order == 3 {
                        let bend = bank.blocks[0].acceleration(shares).value.sum();
                        sum[2] = 0.5 * bend * (cells.length * cells.length);
                    }
                    let tables = cells.tables(&each, order);
                    let powers: Vec<f64> = cells.powers(tables, shares).iter().flat_map(|four| four.array()).collect();
                    let bernstein: Vec<f64> =
                        cells.bernstein(tables, shares).iter().flat_map(|four| four.array()).collect();
                    let (left_out, [slope, _]) = (tables.left_out(shares), tables.turning(shares));
                    assert!((powers.iter().sum::<f64>() - bernstein[KEPT - 1]).abs() < left_out);
                    let scale = shares.value.abs().sum() + shares.rate.abs().sum() * cells.length;
                    assert!(left_out < 1e-4 * scale, "{own:?}: {left_out}");
                    let kept = |x: f64| powers.iter().rev().fold(0.0, |sum, a| sum * x + a);
                    let mut before = None;
                    for i in 1..=200 {
                        let x = f64::from(i) / 200.0;
                        let mut kernels = [Kernels::NONE];
                        bank.kernels(&each, x * cells.length, &mut kernels);
                        let moved = bank.blocks[0].advance(shares, &kernels[0].transfer()).value.sum();
                        let power = (0..order).map(|_| x).product::<f64>();
                        let exact = (moved - sum[0] - x * (sum[1] + x * sum[2])) / power;
                        // The comparison itself rounds, by what is divided.
                        let rounding = 4.0 * f64::EPSILON * (scale + sum[2].abs()) / power;
                        let off = exact - kept(x);
                        assert!(off.abs() <= left_out + rounding, "{own:?} at {x}: {off:e}, {left_out:e}");
                        let step = before.replace(off).map_or(0.0, |before: f64| (off - before).abs());
                        assert!(step <= slope / 200.0 + 4.0 * rounding, "{own:?} at {x}");
                    }
                }
            }
        }
    }
}
