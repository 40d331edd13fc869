//! Economised tables of a contact state: what a cell of time needs to know of each block.
//!
//! A block's share in a signal is value·A(t) + rate·B(t). Over a cell of D seconds, with σ = t/D, a guard is
//!
//! g(σ) = g₀ + σ h(σ),   h = g₀′D + p₂D² σ + Σ value·(A − 1)/σ + rate·(B − Dσ)/σ,
//!
//! so that value and slope at the cell's start enter as they are. Both functions are cut after Chebyshev's seventh polynomial and
//! tabulated by their Bernstein coefficients; what is left out of them, |value| ρ + |rate| ρ, is about 2 (radius D/4)⁸/8! of a
//! block's amplitude, 2⁻¹⁵ of what Taylor's series leaves out. Blocks too fast for a cell are left to the bound as a whole.

use std::cell::OnceCell;

use super::block::{Block, Phase};

/// Bernstein coefficients of h: degree seven.
pub(crate) const KEPT: usize = 8;
/// Chebyshev coefficients that are worked out; those behind the kept ones are the remainder.
const WORKED_OUT: usize = 16;
/// Taylor coefficients that they are made from, for radius·D up to `LONGEST`.
const TERMS: usize = 42;
/// radius·D of the fastest block in the shortest cell.
const SHORTEST: f64 = 0.8;
/// radius·D that suits a block: half a turn and a little, since that is how long a face holds a particle.
const SUITS: f64 = 3.3;
/// radius·D up to which a block is tabulated.
const LONGEST: f64 = 6.5;
/// Lengths of cells, each twice the one before.
const MOST_LEVELS: usize = 24;

/// The tables of a contact state, by length of cell; each is built when it is first asked for.
#[derive(Debug)]
pub(crate) struct Economised {
    shortest: f64,
    levels: Vec<OnceCell<Level>>,
    /// The blocks, fastest first, with the level that suits each.
    pub(crate) fastest: Vec<(usize, usize)>,
}

/// The tables for cells of one length.
#[derive(Debug)]
pub(crate) struct Level {
    /// D, s.
    pub(crate) length: f64,
    /// Blocks that are tabulated.
    rows: Vec<Rows>,
    /// Of each block, tabulated or not, what is left out.
    left_out: Vec<LeftOut>,
}

/// Bernstein coefficients of (A − 1)/σ and of (B − Dσ)/σ.
#[derive(Debug)]
struct Rows {
    block: usize,
    value: [f64; KEPT],
    rate: [f64; KEPT],
}

/// A bound on what the table leaves out of a share, by |value| and |rate|.
#[derive(Debug, Clone, Copy)]
struct LeftOut {
    value: f64,
    rate: f64,
    /// Bound on its slope in σ, over the bound itself.
    steep: f64,
    /// radius·D where all of the block is left out, else 0.
    turn: f64,
}

/// The shares of a signal over a cell, without its value and slope at the start.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Product {
    /// Of h.
    pub(crate) h: [f64; KEPT],
    /// Sum of the tabulated shares' values and of their rates.
    pub(crate) value: f64,
    pub(crate) rate: f64,
}

impl Product {
    pub(crate) const NONE: Self = Self { h: [0.0; KEPT], value: 0.0, rate: 0.0 };
}

impl Economised {
    pub(crate) fn new(blocks: &[Block]) -> Self {
        let radii = blocks.iter().map(|block| block.radius);
        let most = radii.clone().fold(0.0, f64::max);
        let most = if most > 0.0 { most } else { 1.0 };
        let shortest = SHORTEST / most;
        let level = |radius: f64| {
            let (mut level, mut turn) = (0, 2.0 * radius * shortest);
            while turn <= SUITS && level + 1 < MOST_LEVELS {
                (level, turn) = (level + 1, 2.0 * turn);
            }
            level
        };
        let mut fastest: Vec<(usize, usize)> = radii.clone().map(level).enumerate().collect();
        fastest.sort_by(|a, b| blocks[b.0].radius.total_cmp(&blocks[a.0].radius));
        // Cells that suit the slowest block that moves at all.
        let moving = radii.filter(|radius| *radius > 0.0).map(level).max().unwrap_or_else(|| level(most));
        fastest.iter_mut().for_each(|(_, level)| *level = (*level).min(moving));
        Self { shortest, levels: (0..=moving).map(|_| OnceCell::new()).collect(), fastest }
    }

    /// The longest cells.
    pub(crate) fn top(&self) -> usize {
        self.levels.len() - 1
    }

    /// D of a level, s.
    #[inline(always)]
    pub(crate) fn length(&self, level: usize) -> f64 {
        self.shortest * (1_u64 << level) as f64
    }

    #[inline(always)]
    pub(crate) fn level(&self, blocks: &[Block], level: usize) -> &Level {
        self.levels[level].get_or_init(|| Level::new(blocks, self.length(level)))
    }

    /// Numbers that it keeps.
    pub(crate) fn size(&self) -> usize {
        let of = |level: &Level| level.rows.len() * 2 * KEPT + level.left_out.len() * 4;
        self.levels.iter().filter_map(OnceCell::get).map(of).sum()
    }
}

impl Level {
    #[cold]
    fn new(blocks: &[Block], length: f64) -> Self {
        let mut level = Self { length, rows: Vec::new(), left_out: Vec::with_capacity(blocks.len()) };
        for (k, block) in blocks.iter().enumerate() {
            let turn = block.radius * length;
            let amplitude = |order: f64| {
                let unit = |value, rate| block.amplitude(Phase { value, rate }, order, length);
                [unit(1.0, 0.0), unit(0.0, 1.0)]
            };
            if turn > LONGEST {
                let [value, rate] = amplitude(2.0);
                level.left_out.push(LeftOut { value, rate, steep: turn, turn });
                continue;
            }
            // Derivatives to the seventeenth.
            let [most_value, most_rate] = amplitude(18.0);
            let value = Cut::new(block, length, [1.0, 0.0], most_value);
            let rate = Cut::new(block, length, [0.0, length], most_rate);
            let steep = value.slope / value.left_out;
            let steep = steep.max(rate.slope / rate.left_out);
            level.left_out.push(LeftOut { value: value.left_out, rate: rate.left_out, steep, turn: 0.0 });
            level.rows.push(Rows { block: k, value: value.kept, rate: rate.kept });
        }
        level
    }

    /// Σ of these shares.
    #[inline(always)]
    pub(crate) fn product(&self, shares: &[Phase]) -> Product {
        let mut sum = Product::NONE;
        for rows in &self.rows {
            let share = shares[rows.block];
            for i in 0..KEPT {
                sum.h[i] += share.value * rows.value[i] + share.rate * rows.rate[i];
            }
            sum.value += share.value;
            sum.rate += share.rate;
        }
        sum
    }

    /// A bound on what is left out of g.
    #[inline(always)]
    pub(crate) fn left_out(&self, shares: &[Phase]) -> f64 {
        let of = |(bound, share): (&LeftOut, &Phase)| share.value.abs() * bound.value + share.rate.abs() * bound.rate;
        self.left_out.iter().zip(shares).map(of).fold(0.0, |sum, more| sum + more)
    }

    /// A bound on what is left out of h, where the slope of all blocks enters: |share − value − rate t| < 2 radius t amplitude.
    #[inline(always)]
    pub(crate) fn left_out_of_quotient(&self, shares: &[Phase]) -> f64 {
        self.left_out.iter().zip(shares).fold(0.0, |sum, (bound, share)| {
            let whole = if bound.turn > 0.0 { 2.0 * bound.turn } else { 1.0 };
            sum + whole * (share.value.abs() * bound.value + share.rate.abs() * bound.rate)
        })
    }

    /// A bound on the slope in σ of what is left out of g, or of h.
    pub(crate) fn slope_left_out(&self, shares: &[Phase], of_quotient: bool) -> f64 {
        self.left_out.iter().zip(shares).fold(0.0, |sum, (bound, share)| {
            let own = share.value.abs() * bound.value + share.rate.abs() * bound.rate;
            let steep = match (bound.turn > 0.0, of_quotient) {
                (true, true) => 2.0 * bound.turn * bound.turn,
                (true, false) => bound.turn,
                (false, true) => bound.steep,
                // σ times a remainder of h.
                (false, false) => 1.0 + bound.steep,
            };
            sum + own * steep
        })
    }
}

/// (A − 1)/σ or (B − Dσ)/σ, cut.
struct Cut {
    kept: [f64; KEPT],
    left_out: f64,
    slope: f64,
}

impl Cut {
    /// Of the function with this value and slope in σ at the start; its derivative of order j is below `most`·(radius D)ʲ.
    fn new(block: &Block, length: f64, [value, slope]: [f64; 2], most: f64) -> Self {
        let (p, q) = (-2.0 * block.decay * length, -block.determinant * (length * length));
        let turn = block.radius * length;
        let terms = (16 + (4.0 * turn) as usize).min(TERMS);
        // Taylor: tⱼ₊₂ = (p tⱼ₊₁ + q tⱼ/(j + 1))/(j + 2); those below the second are taken off, and the rest divided by σ.
        let (mut before, mut last) = (value, slope);
        let (mut t, mut largest) = ([0.0; TERMS], 0.0_f64);
        let mut behind = most * turn;
        for j in 0..terms {
            let next = (p * last + q * before / (j + 1) as f64) / (j + 2) as f64;
            (before, last) = (last, next);
            if j + 1 < TERMS {
                t[j + 1] = next;
            }
            largest = largest.max(next.abs());
            behind *= turn / (j + 2) as f64;
        }
        let mut c = [0.0; WORKED_OUT];
        for (t, row) in t.iter().zip(&CHEBYSHEV).take(terms) {
            for (c, entry) in c.iter_mut().zip(row) {
                *c += t * entry;
            }
        }
        let mut kept = [0.0; KEPT];
        for (c, row) in c.iter().zip(&BERNSTEIN) {
            for (kept, entry) in kept.iter_mut().zip(row) {
                *kept += c * entry;
            }
        }
        // |cⱼ| < 2 most·turn (turn/4)ʲ/(j + 1)! for those that are not worked out, and Taylor's terms that are not.
        let quarter = 0.25 * turn;
        let fourth = (quarter * quarter) * (quarter * quarter);
        let tail = 2.4 * most * turn * ((fourth * fourth) * (fourth * fourth)) * SEVENTEEN_FACTORIAL + 2.0 * behind;
        let (mut left_out, mut steep) = (tail, 2.0 * 300.0 * tail);
        for (j, c) in c.iter().enumerate().skip(KEPT) {
            left_out += c.abs();
            // |T′ⱼ| ≤ 2j² on [0, 1].
            steep += (2 * j * j) as f64 * c.abs();
        }
        let high = kept.iter().fold(0.0_f64, |high, b| high.max(b.abs()));
        // Rounding, of the sums of value and slope too.
        left_out += f64::EPSILON * (32.0 * (high + largest) + 16.0 * (value + slope));
        Self { kept, left_out, slope: steep }
    }
}

/// 1/17!.
const SEVENTEEN_FACTORIAL: f64 = 1.0 / 355_687_428_096_000.0;

/// xⁱ in Chebyshev polynomials of [0, 1], from x T*ⱼ = (T*ⱼ₊₁ + 2 T*ⱼ + T*ⱼ₋₁)/4.
const CHEBYSHEV: [[f64; WORKED_OUT]; TERMS] = {
    let mut table = [[0.0; WORKED_OUT]; TERMS];
    let mut row = [0.0; TERMS + 1];
    row[0] = 1.0;
    let mut i = 0;
    while i < TERMS {
        let mut next = [0.0; TERMS + 1];
        let mut j = 0;
        while j < TERMS {
            if j < WORKED_OUT {
                table[i][j] = row[j];
            }
            let quarter = 0.25 * row[j];
            next[j] += 2.0 * quarter;
            if j == 0 {
                next[1] += 2.0 * quarter;
            } else {
                next[j + 1] += quarter;
                next[j - 1] += quarter;
            }
            j += 1;
        }
        row = next;
        i += 1;
    }
    table
};

/// The kept Chebyshev polynomials of [0, 1] by their Bernstein coefficients: those in powers of x, T*ⱼ₊₁ = (4x − 2) T*ⱼ − T*ⱼ₋₁, then
/// bᵢ = Σ C(i, m)/C(7, m) aₘ.
const BERNSTEIN: [[f64; KEPT]; KEPT] = {
    let mut powers = [[0.0; KEPT]; KEPT];
    powers[0][0] = 1.0;
    (powers[1][0], powers[1][1]) = (-1.0, 2.0);
    let mut j = 2;
    while j < KEPT {
        let mut m = 0;
        while m < KEPT {
            let shifted = if m > 0 { powers[j - 1][m - 1] } else { 0.0 };
            powers[j][m] = 4.0 * shifted - 2.0 * powers[j - 1][m] - powers[j - 2][m];
            m += 1;
        }
        j += 1;
    }
    let mut table = [[0.0; KEPT]; KEPT];
    let mut j = 0;
    while j < KEPT {
        let mut i = 0;
        while i < KEPT {
            let (mut m, mut share) = (0, 1.0);
            while m <= i {
                table[j][i] += share * powers[j][m];
                if m < KEPT - 1 {
                    share = share * (i - m) as f64 / (KEPT - 1 - m) as f64;
                }
                m += 1;
            }
            i += 1;
        }
        j += 1;
    }
    table
};

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn tables_and_bounds_enclose_every_kind_of_block() {
        // Light, heavy, near critical (both sides and exactly), overdamped, stiff, creeping, drifting, undamped.
        let dampings = [0.0, 0.01, 0.3, 0.999_999_9, 1.0, 1.000_000_1, 1.4, 30.0];
        let mut blocks: Vec<Block> = dampings.iter().map(|z| Block::new([0.0, 1.0, -900.0, -60.0 * z])).collect();
        blocks.push(Block::new([0.0, 1.0, 0.0, -40.0]));
        blocks.push(Block::new([0.0, 1.0, 0.0, 0.0]));
        blocks.push(Block::new([-3.0, 140.0, -150.0, -41.0]));
        blocks.push(Block::harmonic(17.0));
        for block in blocks {
            let tables = Economised::new(&[block]);
            for number in 0..=tables.top() + 1 {
                let level = Level::new(&[block], tables.length(number));
                for share in [
                    Phase { value: 1.0, rate: 0.0 },
                    Phase { value: 0.0, rate: 30.0 },
                    Phase { value: -0.3, rate: 7.0 },
                ] {
                    encloses(&block, &level, share);
                }
            }
        }
    }

    fn encloses(block: &Block, level: &Level, share: Phase) {
        let product = level.product(&[share]);
        let [bound, of_quotient] = [level.left_out(&[share]), level.left_out_of_quotient(&[share])];
        for i in 1..=64 {
            let sigma = f64::from(i) / 64.0;
            let time = sigma * level.length;
            let exact = block.advance(share, block.kernel(time)).value;
            let h = product.h.iter().zip(basis(sigma)).fold(0.0, |sum, (h, basis)| sum + h * basis);
            let table = product.value + sigma * (product.rate * level.length + h);
            let rounding = 16.0 * f64::EPSILON * (share.value.abs() + share.rate.abs() * time);
            assert!(
                (exact - table).abs() <= bound + rounding,
                "{block:?} {share:?} σ = {sigma}: {exact} {table} {bound}"
            );
            // The same over σ, without value and slope at the start.
            let rest = exact - share.value - share.rate * time - sigma * h;
            assert!(
                rest.abs() <= sigma * of_quotient + rounding,
                "{block:?} {share:?} σ = {sigma}: {rest} {of_quotient}"
            );
        }
    }

    fn basis(x: f64) -> [f64; KEPT] {
        let mut b = [0.0; KEPT];
        b[0] = 1.0;
        for round in 1..KEPT {
            for i in (0..=round).rev() {
                b[i] = (1.0 - x) * b[i] + if i > 0 { x * b[i - 1] } else { 0.0 };
            }
        }
        b
    }

    #[test]
    fn a_face_holds_a_particle_for_one_cell() {
        let level = Level::new(&[Block::new([0.0, 1.0, -100.0, -2.0])], 0.32);
        assert!(level.left_out(&[Phase { value: 1.0, rate: 0.0 }]) < 1e-5);
    }
}
