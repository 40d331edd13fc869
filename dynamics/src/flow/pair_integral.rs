//! Integrals of a signal over one segment in closed form, where no block is near critical damping: for contact states that are
//! visited once or twice, or whose blocks do not all die away, which the sums of [`crate::flow::gains`] do not suit.
//!
//! A block with the eigenvalue λ = −a + iω shares Re w e^(λt), w = s(0) − i (s′(0) + a s(0))/ω; one exponential alone has ω = 0 and w = s(0).
//! So over L seconds
//!
//! ∫ s = Re Σ w_k φ(λ_k),   ∫ s² = ½ Re Σ w_k (w_l φ(λ_k + λ_l) + w̄_l φ(λ_k + λ̄_l)),   φ(z) = (e^(zL) − 1)/z.
//!
//! The exponentials are those of the segment's end. Where zL is small, as of two blocks that turn alike, φ is its power series.

use crate::arithmetic::complexes::Complexes;
use crate::arithmetic::four::Four;
use crate::arithmetic::lanes::WIDTH;
use crate::arithmetic::wide::widened;
use crate::contact_state::bank::{Bank, Kernels, Phases};
use crate::flow::sums::{About, Sums};

/// Below this |zL| the difference in φ would lose digits.
const SMALL: f64 = 0.25;
/// Of the power series: 0.25¹²/13! is beyond rounding.
const LAST_ORDER: u32 = 13;

/// 1 in the places of a register behind one of them.
const BEHIND: [Four; WIDTH] = [
    Four::new([0.0, 1.0, 1.0, 1.0]),
    Four::new([0.0, 0.0, 1.0, 1.0]),
    Four::new([0.0, 0.0, 0.0, 1.0]),
    Four::new([0.0, 0.0, 0.0, 0.0]),
];

/// What the signals of a segment have in common.
#[derive(Debug, Default)]
pub(crate) struct PairIntegrals {
    /// L, s.
    length: f64,
    /// λ and e^(λL) of each block.
    ends: Vec<[Complexes; 2]>,
    /// φ(2λ) and φ(2 Re λ) of each block.
    own: Vec<(Complexes, Four)>,
    /// φ(λ_k + λ_l) ± φ(λ_k + λ̄_l), l > k, row by row from the register of k + 1 on.
    pairs: Vec<[Complexes; 2]>,
    /// w of the signal at hand.
    shares: Vec<Complexes>,
}

impl PairIntegrals {
    widened! {
        /// Of a segment of `length` seconds, at whose end these are the kernels.
        pub(crate) fn set | set_wide (&mut self, bank: &Bank, kernels: &[Kernels], length: f64) = set_by_registers
    }

    #[inline(always)]
    fn set_by_registers(&mut self, bank: &Bank, kernels: &[Kernels], length: f64) {
        self.length = length;
        // What stands in places that do not count is not to be small.
        let large = 1.0 / length;
        self.ends.clear();
        self.own.clear();
        self.pairs.clear();
        for (blocks, kernels) in bank.blocks.iter().zip(kernels) {
            let end = kernels.turned();
            let lambda = Complexes { re: blocks.decay * -1.0, im: blocks.root + blocks.spare * large };
            let twice = lambda.plus(lambda);
            self.ends.push([lambda, end]);
            self.own.push((phi(twice, end.times(end), length), phi_of_real(twice.re, end.square(), length)));
        }
        for k in 0..bank.count.saturating_sub(1) {
            let (row, lane) = (k / WIDTH, k % WIDTH);
            let [decay, root] = [bank.blocks[row].decay, bank.blocks[row].root].map(|of| Four::all(of.at(lane)));
            let end = kernels[row].turned().all(lane);
            for (j, (blocks, kernels)) in bank.blocks.iter().zip(kernels).enumerate().skip((k + 1) / WIDTH) {
                let behind = if j == row { BEHIND[lane] } else { Four::all(1.0) };
                let spare = (blocks.spare + (Four::all(1.0) - behind)) * large;
                let (fall, other) = ((decay + blocks.decay) * -1.0, kernels.turned());
                let sum = Complexes { re: fall, im: root + blocks.root + spare };
                let difference = Complexes { re: fall, im: root - blocks.root + spare };
                let sum = phi(sum, end.times(other), length).scaled(behind);
                let difference = phi(difference, end.times(other.conjugate()), length).scaled(behind);
                self.pairs.push([sum.plus(difference), sum.minus(difference)]);
            }
        }
    }

    /// ∫ s² dt of a signal that starts with these shares.
    pub(crate) fn square(&mut self, bank: &Bank, shares: &[Phases]) -> f64 {
        self.start(bank, shares.iter().copied());
        self.form(bank)
    }

    /// The measures of a motion that starts with these shares, about `place`; velocities alone unless `displacement`.
    pub(crate) fn sums(
        &mut self,
        bank: &Bank,
        shares: impl Iterator<Item = Phases> + Clone,
        place: f64,
        displacement: bool,
    ) -> Sums {
        self.start(bank, bank.blocks.iter().zip(shares.clone()).map(|(blocks, shares)| blocks.derivative(shares)));
        let mut about = About { duration: self.length, velocity_square: self.form(bank), ..About::default() };
        if displacement {
            self.start(bank, shares);
            let moved = self
                .shares
                .iter()
                .zip(&self.ends)
                .fold(Four::ZERO, |sum, (w, [lambda, end])| sum + w.times(phi(*lambda, *end, self.length)).re);
            about = About { place, moved: moved.sum(), square: self.form(bank), ..about };
        }
        Sums::of(&[about])
    }

    #[inline(always)]
    fn start(&mut self, bank: &Bank, shares: impl Iterator<Item = Phases>) {
        self.shares.clear();
        self.shares.extend(bank.blocks.iter().zip(shares).map(|(blocks, shares)| blocks.amplitude(shares)));
    }

    widened! {
        /// ∫ s² of the signal at hand.
        fn form | form_wide (&self, bank: &Bank) -> f64 = form_by_registers
    }

    #[inline(always)]
    fn form_by_registers(&self, bank: &Bank) -> f64 {
        let mut total = Four::ZERO;
        for (w, (turned, fallen)) in self.shares.iter().zip(&self.own) {
            total = total + (w.times(*w).times(*turned).re + w.square() * *fallen) * 0.5;
        }
        let mut pairs = self.pairs.iter();
        for k in 0..bank.count.saturating_sub(1) {
            let mut sum = Complexes::ZERO;
            for (w, [plus, minus]) in self.shares[(k + 1) / WIDTH..].iter().zip(pairs.by_ref()) {
                // w φ(λ_k + λ_l) + w̄ φ(λ_k + λ̄_l).
                sum.re = sum.re + (w.re * plus.re - w.im * minus.im);
                sum.im = sum.im + (w.re * plus.im + w.im * minus.re);
            }
            total = total + self.shares[k / WIDTH].all(k % WIDTH).times(sum).re;
        }
        total.sum()
    }
}

/// (e^(zL) − 1)/z, given e^(zL).
#[inline(always)]
fn phi(z: Complexes, end: Complexes, length: f64) -> Complexes {
    let size = z.square();
    let change = Complexes { re: end.re - Four::all(1.0), im: end.im };
    let direct = change.times(z.conjugate()).scaled(size.map(|size| 1.0 / size));
    let small = size * (length * length);
    if small.array().iter().all(|size| *size >= SMALL * SMALL) {
        return direct;
    }
    Series { x: z.scaled(Four::all(length)), small }.or(&direct, length)
}

/// The same of real numbers that are not positive.
#[inline(always)]
fn phi_of_real(z: Four, end: Four, length: f64) -> Four {
    let x = z * length;
    let mut series = Four::all(1.0);
    for order in (2..LAST_ORDER).rev() {
        series = Four::all(1.0) + series * x * (1.0 / f64::from(order));
    }
    let direct = (end - Four::all(1.0)).zip(z, |change, z| change / z);
    chosen(x * x, series * length, direct)
}

/// Where the first of them is small the second, else the third.
#[inline(always)]
fn chosen(small: Four, series: Four, direct: Four) -> Four {
    let ([a, b, c, d], [e, f, g, h], [i, j, k, l]) = (small.array(), series.array(), direct.array());
    let choose = |small: f64, series: f64, direct: f64| if small < SMALL * SMALL { series } else { direct };
    Four::new([choose(a, e, i), choose(b, f, j), choose(c, g, k), choose(d, h, l)])
}

/// Numbers x = zL, and |x|².
struct Series {
    x: Complexes,
    small: Four,
}

impl Series {
    widened! {
        /// (eˣ − 1)/z by power series where x is small, else `direct`.
        fn or | or_wide (&self, direct: &Complexes, length: f64) -> Complexes = or_by_registers
    }

    #[inline(always)]
    fn or_by_registers(&self, direct: &Complexes, length: f64) -> Complexes {
        let mut sum = Complexes { re: Four::all(1.0), im: Four::ZERO };
        for order in (2..LAST_ORDER).rev() {
            let next = sum.times(self.x).scaled(Four::all(1.0 / f64::from(order)));
            sum = Complexes { re: next.re + Four::all(1.0), im: next.im };
        }
        let choose = |series: Four, direct: Four| chosen(self.small, series * length, direct);
        Complexes { re: choose(sum.re, direct.re), im: choose(sum.im, direct.im) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::contact_state::block::{Block, Phase};
    use crate::flow::integral::Panels;
    use crate::flow::parabola::Parabola;

    #[test]
    fn closed_forms_of_a_segment_agree_with_quadrature_however_short_or_alike_its_blocks() {
        // Two nearly alike, one without damping, one exponential alone, and that of a harmonic force.
        let turning = [(0.4, 26.0), (25.0, 880.0), (31.0, 262.0), (31.1, 262.3), (0.0, 163.0), (90.0, 240.0)];
        let block = |(a, w): (f64, f64)| Block::new([-a, w, -w, -a]);
        let others = [Block::new([-70.0, 0.0, 0.0, -70.0]), Block::harmonic(40.0)];
        let blocks: Vec<Block> = turning.into_iter().map(block).chain(others).collect();
        let bank = Bank::default().of(&blocks);
        let share = |k: usize| {
            let value = 0.3 - 0.1 * k as f64;
            Phase { value, rate: if blocks[k].is_single() { -70.0 * value } else { 7.0 * (k as f64 - 2.6) } }
        };
        let shares: Vec<Phase> = (0..blocks.len()).map(share).collect();
        let several = |shares: &[Phase]| Phases {
            value: Four::padded(shares.iter().map(|share| share.value)),
            rate: Four::padded(shares.iter().map(|share| share.rate)),
        };
        let phases: Vec<Phases> = shares.chunks(WIDTH).map(several).collect();
        let (mut pairs, mut panels) = (PairIntegrals::default(), Panels::default());
        let mut kernels = vec![Kernels::NONE; bank.blocks.len()];
        for length in [1e-4, 1e-3, 4e-3, 0.02, 0.1, 3.0] {
            bank.kernels(&blocks, length, &mut kernels);
            pairs.set(&bank, &kernels, length);
            panels.divide(&blocks, &bank, length);
            // Shares may cancel: rounding is that of each of them.
            let sizes = |shares: &[Phase]| {
                let each = shares.iter().zip(&blocks).map(|(share, block)| block.amplitude(*share, 0.0, length));
                let sum: f64 = each.sum();
                sum * sum * length
            };
            let close = |one: f64, other: f64, size: f64| {
                assert!((one - other).abs() < 1e-14 * size, "{length}: {one} for {other}, {size}");
            };
            let square = panels.square(&blocks, shares.iter().copied());
            close(pairs.square(&bank, &phases), square, sizes(&shares));
            let rest = Parabola { p0: 0.2, ..Parabola::default() };
            let [one, other] = [
                pairs.sums(&bank, phases.iter().copied(), 0.2, true),
                panels.sums(&blocks, shares.iter().copied(), rest),
            ];
            let rates: Vec<Phase> = shares
                .iter()
                .zip(&blocks)
                .map(|(share, block)| Phase { value: share.rate, rate: block.acceleration(*share).value })
                .collect();
            close(one.displacement, other.displacement, (sizes(&shares) * length).sqrt() + 0.2 * length);
            close(one.deviation_square, other.deviation_square, sizes(&shares));
            close(one.velocity_square, other.velocity_square, sizes(&rates));
        }
    }
}
