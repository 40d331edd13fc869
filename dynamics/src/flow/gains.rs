//! Integrals over any number of visits of a contact state, in closed form.
//!
//! Its coordinates obey c′ = Bc, so that the integral of every product of two signals is in G = ∫ c cᵀ dt, and
//!
//! B G + G Bᵀ = [c cᵀ],   B ∫ c dt = [c]:
//!
//! only the ends of a visit matter, not what is watched. What visits gain adds up; one equation for each pair of blocks is
//! solved when all are over, for every observed signal at once. Of velocities alone the equations are solved beforehand, once for each
//! signal ([`VelocitySquare`]). Where two eigenvalues nearly cancel (undamped motion) G would lose digits, and
//! [`crate::flow::integral`] takes its place.

use crate::arithmetic::four::Four;
use crate::arithmetic::lanes::WIDTH;
use crate::arithmetic::wide::widened;
use crate::contact_state::block::{Block, forms, pairs, transposed};
use crate::flow::lyapunov::{Equations, Lyapunov, NEARLY_NEUTRAL};
use crate::flow::signals::Row;
use crate::flow::sums::About;

/// The equations of a contact state's integrals.
pub(crate) struct Closed {
    blocks: Vec<Inverse>,
    /// In the order of [`pairs`]; without that of the harmonic force with itself, which turns for ever.
    equations: Equations,
    /// ω of the harmonic force, the last block.
    drive: Option<f64>,
}

/// ∫ v² dt of a signal as a sum over what the coordinates have gained: with BᵀW + WB = vvᵀ it is Σ W·[c cᵀ].
pub(crate) struct VelocitySquare {
    second: Vec<[f64; 4]>,
    swing: f64,
}

/// B⁻¹, row by row.
type Inverse = [f64; 4];

/// What the coordinates of a contact state have gained over its visits.
#[derive(Debug, Clone, Default)]
pub(crate) struct Gains {
    /// Σ [c], and weighted by the constant force F of each visit.
    pub(crate) first: Vec<[f64; 2]>,
    pub(crate) forced: Vec<[f64; 2]>,
    /// Σ [cₖ cₗᵀ] by [`pairs`] of blocks.
    pub(crate) second: Vec<[f64; 4]>,
    /// Σ |c|² t of the harmonic force.
    pub(crate) swing: f64,
    /// Σ t, Σ F t, Σ F² t.
    pub(crate) time: [f64; 3],
}

/// ∫ c dt, ∫ F c dt and ∫ c cᵀ dt over these visits; pairs of two blocks count for both orders.
pub(crate) struct Integrated {
    first: Vec<f64>,
    forced: Vec<f64>,
    second: Vec<[f64; 4]>,
    time: [f64; 3],
}

impl Gains {
    /// Of no visit yet, to so many blocks.
    pub(crate) fn none(blocks: usize) -> Self {
        let mut none = Self::default();
        none.clear(blocks);
        none
    }

    /// Makes them those of no visit yet, to so many blocks.
    pub(crate) fn clear(&mut self, blocks: usize) {
        for first in [&mut self.first, &mut self.forced] {
            first.clear();
            first.resize(blocks, [0.0; 2]);
        }
        self.second.clear();
        self.second.resize(blocks * (blocks + 1) / 2, [0.0; 4]);
        (self.swing, self.time) = (0.0, [0.0; 3]);
    }

    /// Adds a visit of `length` seconds under the constant force `level`, from `start` to `end`.
    #[inline(always)]
    pub(crate) fn visit(&mut self, start: &[f64], end: &[f64], level: f64, length: f64) {
        let blocks = self.first.len();
        let (start, end) = (&start.as_chunks::<2>().0[..blocks], &end.as_chunks::<2>().0[..blocks]);
        let mut second = self.second.as_mut_slice();
        for k in 0..blocks {
            let ([x0, y0], [x1, y1]) = (start[k], end[k]);
            let (row, rest) = second.split_at_mut(blocks - k);
            let (from, to) = (Four::new([x0, x0, y0, y0]), Four::new([x1, x1, y1, y1]));
            for ((cell, &[u0, v0]), &[u1, v1]) in row.iter_mut().zip(&start[k..]).zip(&end[k..]) {
                let gained = to * Four::new([u1, v1, u1, v1]) - from * Four::new([u0, v0, u0, v0]);
                *cell = (Four::new(*cell) + gained).array();
            }
            second = rest;
        }
        for ((sum, from), to) in self.first.iter_mut().zip(start).zip(end) {
            *sum = [sum[0] + (to[0] - from[0]), sum[1] + (to[1] - from[1])];
        }
        if level != 0.0 {
            for ((sum, from), to) in self.forced.iter_mut().zip(start).zip(end) {
                *sum = [sum[0] + level * (to[0] - from[0]), sum[1] + level * (to[1] - from[1])];
            }
        }
        if let Some([x, y]) = start.last() {
            self.swing += (x * x + y * y) * length;
        }
        self.add_time(level, length);
    }

    /// Adds `length` seconds under a constant force.
    pub(crate) fn add_time(&mut self, level: f64, length: f64) {
        self.time = [self.time[0] + length, self.time[1] + level * length, self.time[2] + level * level * length];
    }
}

impl Closed {
    /// The equations of these blocks, with their matrices; `drive` is ω of the harmonic force, the last of them. `None` where
    /// a solution would lose its digits.
    pub(crate) fn new(blocks: &[Block], matrices: &[[f64; 4]], drive: Option<f64>) -> Option<Self> {
        let turning = drive.map(|omega| [0.0, -omega, omega, 0.0]);
        let matrices: Vec<[f64; 4]> = matrices.iter().copied().chain(turning).collect();
        let alone = drive.map(|_| blocks.len() - 1);
        let equation = |(k, l): (usize, usize)| {
            let apart = blocks[k].keeps_apart(&blocks[l], NEARLY_NEUTRAL);
            let equation = apart.then(|| Lyapunov::new(transposed(matrices[k]), transposed(matrices[l]))).flatten();
            // Pairs of two blocks count for both orders.
            equation.map(|equation| equation.times(if k == l { 1.0 } else { 2.0 }))
        };
        let inverse =
            |(block, [p, q, r, s]): (&Block, &[f64; 4])| [*s, -q, -r, *p].map(|entry| entry / block.determinant);
        Some(Self {
            equations: pairs(blocks.len()).filter(|(k, _)| Some(*k) != alone).map(equation).collect::<Option<_>>()?,
            blocks: blocks.iter().zip(&matrices).map(inverse).collect(),
            drive,
        })
    }

    /// Numbers that it keeps.
    pub(crate) fn size(&self) -> usize {
        self.equations.size() + 4 * self.blocks.len()
    }

    /// The equations of these signals' velocities solved, for any gains.
    pub(crate) fn velocity_squares(&self, rows: &[&Row]) -> Vec<VelocitySquare> {
        let back = self.equations.transposed();
        let of = |row: &&Row| {
            let pair = |(k, l): (usize, usize)| {
                let ([_, _, x, y], [_, _, u, v]) = (row.weights[k], row.weights[l]);
                [x * u, x * v, y * u, y * v]
            };
            let forms: Vec<[f64; 4]> = pairs(self.blocks.len()).map(pair).collect();
            let mut second = back.solve(self.solvable(&forms));
            let mut swing = 0.0;
            if let (Some(omega), Some([xx, xy, yx, yy])) = (self.drive, forms.get(second.len())) {
                swing = 0.5 * (xx + yy);
                second.push([-0.5 * (xy + yx) / omega, 0.5 * (xx - yy) / omega, 0.0, 0.0]);
            }
            VelocitySquare { second, swing }
        };
        rows.iter().map(of).collect()
    }

    /// All pairs but that of the harmonic force with itself, the last.
    fn solvable<'a>(&self, pairs: &'a [[f64; 4]]) -> &'a [[f64; 4]] {
        &pairs[..pairs.len() - usize::from(self.drive.is_some())]
    }

    /// Solves them for what was gained.
    pub(crate) fn solve(&self, gains: &Gains) -> Integrated {
        let mut second = self.equations.solve(self.solvable(&gains.second));
        if let (Some(omega), Some([xx, xy, ..])) = (self.drive, gains.second.get(second.len())) {
            // (xy)′ = ω (x² − y²), (x²)′ = −2 ω x y.
            let (turned, mixed) = (0.5 * xy / omega, -0.5 * xx / omega);
            second.push([0.5 * gains.swing + turned, mixed, mixed, 0.5 * gains.swing - turned]);
        }
        let undone = |gains: &[[f64; 2]]| -> Vec<f64> {
            let each = |([a, b, c, d], [x, y]): (&Inverse, &[f64; 2])| [a * x + b * y, c * x + d * y];
            self.blocks.iter().zip(gains).flat_map(each).collect()
        };
        Integrated { first: undone(&gains.first), forced: undone(&gains.forced), second, time: gains.time }
    }
}

impl VelocitySquare {
    /// Numbers that it keeps.
    pub(crate) fn size(&self) -> usize {
        4 * self.second.len() + 1
    }

    widened! {
        /// Over these visits, and over those.
        pub(crate) fn over | over_wide (&self, gains: [&Gains; 2]) -> [f64; 2] = over_by_registers
    }

    #[inline(always)]
    fn over_by_registers(&self, gains: [&Gains; 2]) -> [f64; 2] {
        let mut sums = [[Four::ZERO; 2]; 2];
        let [of, and] = gains.map(|gains| gains.second.as_chunks::<2>());
        let (weights, last) = self.second.as_chunks::<2>();
        let mut add = |lane: usize, weights: &[f64; 4], gained: [&[f64; 4]; 2]| {
            let weights = Four::new(*weights);
            for (sum, gained) in sums[lane].iter_mut().zip(gained) {
                *sum = *sum + weights * Four::new(*gained);
            }
        };
        for ((weights, of), and) in weights.iter().zip(of.0).zip(and.0) {
            for lane in 0..2 {
                add(lane, &weights[lane], [&of[lane], &and[lane]]);
            }
        }
        for ((weights, of), and) in last.iter().zip(of.1).zip(and.1) {
            add(0, weights, [of, and]);
        }
        let [even, odd] = sums;
        std::array::from_fn(|half| (even[half] + odd[half]).sum() + self.swing * gains[half].swing)
    }
}

impl Integrated {
    /// Those of signals, about where gravity alone would hold each; velocities alone unless `displacement`.
    pub(crate) fn of(&self, rows: &[&Row], displacement: bool) -> Vec<About> {
        let several = |rows: &[&Row]| self.of_several(rows, displacement).into_iter().take(rows.len());
        rows.chunks(WIDTH).flat_map(several).collect()
    }

    widened! {
        fn of_several | of_several_wide (&self, rows: &[&Row], displacement: bool) -> [About; WIDTH] = of_by_registers
    }

    #[inline(always)]
    fn of_by_registers(&self, rows: &[&Row], displacement: bool) -> [About; WIDTH] {
        let [duration, ft, fft] = self.time;
        let weights = |first: usize| -> Vec<[Four; 2]> {
            let lane = |k: usize, entry: usize| Four::padded(rows.iter().map(|row| row.weights[k][entry]));
            (0..self.first.len() / 2).map(|k| [lane(k, first), lane(k, first + 1)]).collect()
        };
        let velocity_square = forms(&self.second, &weights(2), Four::ZERO).array();
        let mut all = velocity_square.map(|velocity_square| About { duration, velocity_square, ..About::default() });
        if !displacement {
            return all;
        }
        let values = weights(0);
        let along = |sums: &[f64]| {
            let sums = values.as_flattened().iter().zip(sums);
            sums.fold(Four::ZERO, |sum, (value, c)| sum + *value * *c).array()
        };
        let (square, moved, forced) =
            (forms(&self.second, &values, Four::ZERO).array(), along(&self.first), along(&self.forced));
        for (lane, (about, row)) in all.iter_mut().zip(rows).enumerate() {
            let force = row.force.p0;
            about.place = row.gravity.p0;
            about.moved = moved[lane] + force * ft;
            about.square = square[lane] + force * (2.0 * forced[lane] + force * fft);
        }
        all
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::contact_state::bank::Bank;
    use crate::contact_state::block::Phase;
    use crate::flow::integral::Panels;
    use crate::flow::parabola::Parabola;
    use crate::flow::sums::Sums;

    #[test]
    fn closed_forms_agree_with_quadrature() {
        let omega = 17.0;
        let matrices = [[0.0, 1.0, -1000.0, -3.2], [-5.0, 140.0, -150.0, -40.0]];
        let blocks = [Block::new(matrices[0]), Block::new(matrices[1]), Block::harmonic(omega)];
        let (start, level, duration) = ([0.03, -0.4, -0.002, 0.005, 0.8, 0.6], 3.0, 0.13);
        let parabola = |p0| Parabola { p0, ..Parabola::default() };
        let row = Row {
            weights: vec![[1.0, 0.0, 0.0, 1.0], [0.3, 0.2, -31.5, 34.0], [0.01, 0.02, 0.34, -0.17]],
            gravity: parabola(-0.01),
            force: parabola(0.002),
        };
        let phase = |(k, [v0, v1, r0, r1]): (usize, &[f64; 4])| {
            let (x, y) = (start[2 * k], start[2 * k + 1]);
            Phase { value: v0 * x + v1 * y, rate: r0 * x + r1 * y }
        };
        let mut panels = Panels::default();
        panels.divide(&blocks, &Bank::default().of(&blocks), duration);
        let shares: Vec<Phase> = row.weights.iter().enumerate().map(phase).collect();
        let sampled = panels.sums(&blocks, shares.iter().copied(), parabola(-0.01 + level * 0.002));

        let end = |(k, [p, q, r, s]): (usize, [f64; 4])| {
            let (kernel, a) = (blocks[k].kernel(duration), blocks[k].decay);
            let (x, y) = (start[2 * k], start[2 * k + 1]);
            [kernel.c * x + kernel.s * ((p + a) * x + q * y), kernel.c * y + kernel.s * (r * x + (s + a) * y)]
        };
        let all = matrices.into_iter().chain([[0.0, -omega, omega, 0.0]]);
        let end: Vec<f64> = all.enumerate().flat_map(end).collect();
        let mut gains = Gains::none(3);
        gains.visit(&start, &end, level, duration);
        let closed = Closed::new(&blocks, &matrices, Some(omega)).unwrap();
        let integrals = Sums::of(&closed.solve(&gains).of(&[&row], true));
        assert!((integrals.displacement / sampled.displacement - 1.0).abs() < 1e-12);
        assert!((integrals.deviation_square / sampled.deviation_square - 1.0).abs() < 1e-12);
        assert!((integrals.velocity_square / sampled.velocity_square - 1.0).abs() < 1e-12);
        // The other way round, for both halves of a window.
        let [square] = &closed.velocity_squares(&[&row])[..] else { panic!("one row has one square") };
        let halves = square.over([&gains, &Gains::none(3)]);
        assert!((halves[0] / sampled.velocity_square - 1.0).abs() < 1e-12);
        assert_eq!(halves[1], 0.0);
    }
}
