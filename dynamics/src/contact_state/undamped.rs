//! Modes of a contact state without dashpots: M e″ = −K e.
//!
//! With K = L Lᵀ, M = R Rᵀ and G = L⁻¹ R, rotations U leave the rows of Uᵀ G at right angles, of lengths 1/ω; the shapes are Φ = L⁻ᵀ U and
//! Φ⁻¹ = Uᵀ Lᵀ. In x = ω Φ⁻¹ e and y = Φ⁻¹ e′ each block is [[0, ω], [−ω, 0]] to the bit: no rounding damps it or feeds it, and places do
//! not mix with rates, so that a motion can be run backwards. Jacobi's rotations, of rows rather than of G Gᵀ, keep the digits of slow
//! modes beside fast ones (Demmel & Veselić, SIAM J. Matrix Anal. Appl. 13, 1992).

use crate::arithmetic::cholesky::Cholesky;
use crate::arithmetic::exact;
use crate::arithmetic::four::Four;
use crate::arithmetic::lanes::WIDTH;
use crate::arithmetic::matrix::{Matrix, dot};
use crate::arithmetic::wide::widened;
use crate::contact_state::spectral::Spectral;

/// Sweeps of rotations; eight are usual.
const MOST_SWEEPS: usize = 40;

/// Normal modes: e = Φ ξ with Φᵀ K Φ = 1 and Φᵀ M Φ = 1/ω².
pub(crate) struct NormalModes {
    /// ω, rad/s.
    pub(crate) omega: Vec<f64>,
    /// Φ, mode by mode.
    pub(crate) shapes: Vec<Vec<f64>>,
    /// Φ⁻¹, mode by mode.
    pub(crate) inverse: Vec<Vec<f64>>,
    /// ω Φ, ω Φ⁻¹ and Φ⁻¹/ω, coordinate by coordinate and in each mode by mode: what any dashpots mix.
    pub(crate) factors: Vec<[f64; 3]>,
}

impl NormalModes {
    /// `None` where K is not positive.
    pub(crate) fn new(stiffness: &Matrix, mass: &Matrix) -> Option<Self> {
        let n = mass.order;
        let factor = Cholesky::new(stiffness).ok()?;
        let root = Cholesky::new(mass).ok()?;
        let columns: Vec<Vec<f64>> = (0..n).map(|j| factor.forward(&root.column(j))).collect();
        let mut rows = Rows::new(&columns);
        if !rows.turn_apart() {
            return None;
        }
        let axes = rows.axes();
        let shapes: Vec<Vec<f64>> = axes.iter().map(|axis| factor.backward(axis)).collect();
        let mut inverse: Vec<Vec<f64>> = axes.iter().map(|axis| factor.spread(axis)).collect();
        invert_again(&shapes, &mut inverse);
        let omega: Vec<f64> = rows.squares().into_iter().map(|square| 1.0 / square.sqrt()).collect();
        let are_frequencies = omega.iter().all(|omega| *omega > 0.0 && omega.is_finite());
        let factors = (0..n * n).map(|at| (at / n, at % n)).map(|(i, k)| {
            let from = inverse[k][i] / omega[k];
            [shapes[k][i] * omega[k], omega[k] * omega[k] * from, from]
        });
        let factors = factors.collect();
        are_frequencies.then_some(Self { omega, shapes, inverse, factors })
    }

    /// What stays at rest under a constant load, which alone would give these accelerations.
    pub(crate) fn rest(&self, load: &[f64]) -> Vec<f64> {
        let mut rest = vec![0.0; load.len()];
        for ((omega, shape), inverse) in self.omega.iter().zip(&self.shapes).zip(&self.inverse) {
            let share = dot(inverse, load) / (omega * omega);
            rest.iter_mut().zip(shape).for_each(|(sum, entry)| *sum += share * entry);
        }
        rest
    }

    /// The blocks of (e, e′) where no dashpot acts.
    pub(crate) fn undamped(&self) -> Spectral {
        let n = self.omega.len();
        let width = 2 * n;
        let [mut from_blocks, mut to_blocks] = [vec![0.0; width * width], vec![0.0; width * width]];
        for (k, &omega) in self.omega.iter().enumerate() {
            for i in 0..n {
                from_blocks[i * width + 2 * k] = self.shapes[k][i] / omega;
                from_blocks[(n + i) * width + 2 * k + 1] = self.shapes[k][i];
                to_blocks[2 * k * width + i] = self.inverse[k][i] * omega;
                to_blocks[(2 * k + 1) * width + n + i] = self.inverse[k][i];
            }
        }
        let matrices = self.omega.iter().map(|&omega| [0.0, omega, -omega, 0.0]).collect();
        Spectral::new(from_blocks, to_blocks, matrices, f64::INFINITY)
    }
}

/// Rows of G, each with its row of U behind it, in whole registers.
struct Rows {
    count: usize,
    /// Registers of a row of either.
    registers: usize,
    entries: Vec<Four>,
}

impl Rows {
    /// G, column by column, and U = 1.
    fn new(columns: &[Vec<f64>]) -> Self {
        let count = columns.len();
        let registers = count.div_ceil(WIDTH);
        let mut entries = Vec::with_capacity(2 * count * registers);
        for i in 0..count {
            let own: Vec<f64> = columns.iter().map(|column| column[i]).collect();
            let mut unit = vec![0.0; count];
            unit[i] = 1.0;
            for row in [own, unit] {
                entries.extend(row.chunks(WIDTH).map(|few| Four::padded(few.iter().copied())));
            }
        }
        Self { count, registers, entries }
    }

    /// |g|² of each row.
    #[inline(always)]
    fn squares(&self) -> Vec<f64> {
        let rows = self.entries.chunks_exact(2 * self.registers);
        rows.map(|row| product(&row[..self.registers], &row[..self.registers])).collect()
    }

    /// U, row by row.
    fn axes(&self) -> Vec<Vec<f64>> {
        let rows = self.entries.chunks_exact(2 * self.registers);
        rows.map(|row| row[self.registers..].iter().flat_map(|four| four.array()).take(self.count).collect()).collect()
    }

    widened! {
        /// Turns the rows of G until each is at right angles to all others; whether that ends.
        fn turn_apart | turn_apart_wide (&mut self) -> bool = turn_apart_by_registers
    }

    #[inline(always)]
    fn turn_apart_by_registers(&mut self) -> bool {
        let (n, registers) = (self.count, self.registers);
        // As near to a right angle as a sum of so many products can tell.
        let level = f64::EPSILON * (n as f64).sqrt();
        for _ in 0..MOST_SWEEPS {
            let mut still = true;
            let mut squares = self.squares();
            for p in 0..n {
                let (before, behind) = self.entries.split_at_mut(2 * (p + 1) * registers);
                let one = &mut before[2 * p * registers..];
                for (other, q) in behind.chunks_exact_mut(2 * registers).zip(p + 1..) {
                    let [first, second] = [squares[p], squares[q]];
                    let between = product(&one[..registers], &other[..registers]);
                    if !(between.abs() > level * (first * second).sqrt()) {
                        continue;
                    }
                    still = false;
                    let half = (second - first) / (2.0 * between);
                    let tangent = half.signum() / (half.abs() + (1.0 + half * half).sqrt());
                    let cosine = 1.0 / (1.0 + tangent * tangent).sqrt();
                    let sine = tangent * cosine;
                    for (x, y) in one.iter_mut().zip(other) {
                        (*x, *y) = (*x * cosine - *y * sine, *x * sine + *y * cosine);
                    }
                    (squares[p], squares[q]) = (first - tangent * between, second + tangent * between);
                }
            }
            if still {
                return true;
            }
        }
        false
    }
}

/// x·y.
#[inline(always)]
fn product(x: &[Four], y: &[Four]) -> f64 {
    x.iter().zip(y).fold(Four::ZERO, |sum, (x, y)| sum + *x * *y).sum()
}

/// W ← W + (1 − W V) W, V column by column and W row by row.
fn invert_again(v: &[Vec<f64>], w: &mut [Vec<f64>]) {
    let n = v.len();
    let mut next = w.to_vec();
    for (i, row) in next.iter_mut().enumerate() {
        for j in 0..n {
            let unit = f64::from(u8::from(i == j));
            let rest = exact::rest(unit, &w[i], &v[j]);
            row.iter_mut().zip(&w[j]).for_each(|(entry, other)| *entry += rest * other);
        }
    }
    w.clone_from_slice(&next);
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_soft_mass_beside_a_hard_contact_keeps_its_digits() {
        // A mass on 1 N/m carries a light one on a spring up to 10¹² times harder: λ² μ − λ (μ + k (1 + μ)) + k = 0.
        for (light, hard) in [(0.1, 50.0), (0.1, 1e6), (1e-3, 1e12), (0.5, 1e12)] {
            let mass = Matrix { order: 2, entries: vec![1.0 + light, light, light, light] };
            let modes = NormalModes::new(&Matrix::diagonal(&[1.0, hard]), &mass).expect("it is positive");
            let spectral = modes.undamped();
            let sum: f64 = light + hard * (1.0 + light);
            let slow = 2.0 * hard / (sum + (sum * sum - 4.0 * light * hard).sqrt());
            let slowest = spectral.blocks.iter().fold(f64::INFINITY, |least, block| least.min(block.determinant));
            assert!((slowest / slow - 1.0).abs() < 1e-14, "{light}, {hard}: {slowest} for {slow}");
            assert!(spectral.blocks.iter().all(|block| block.decay == 0.0));
        }
    }
}
