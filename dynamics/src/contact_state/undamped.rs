//! Modes of a contact state without dashpots: M e″ = −K e.
//!
//! With K = L Lᵀ and L⁻¹ M L⁻ᵀ = U diag(1/ω²) Uᵀ the shapes are Φ = L⁻ᵀ U and Φ⁻¹ = Uᵀ Lᵀ. In x = ω Φ⁻¹ e and y = Φ⁻¹ e′ each block is
//! [[0, ω], [−ω, 0]] to the bit: no rounding damps it or feeds it, and places do not mix with rates, so that a motion can be run
//! backwards. Jacobi's rotations keep the digits of slow modes beside fast ones (Demmel & Veselić, SIAM J. Matrix Anal. Appl. 13, 1992).

use crate::arithmetic::cholesky::Cholesky;
use crate::arithmetic::exact;
use crate::arithmetic::matrix::{Matrix, dot};
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
}

impl NormalModes {
    /// `None` where K is not positive.
    pub(crate) fn new(stiffness: &Matrix, mass: &Matrix) -> Option<Self> {
        let n = mass.order;
        let factor = Cholesky::new(stiffness).ok()?;
        // L⁻¹ M, row by row, since M is symmetric; then its columns.
        let half: Vec<Vec<f64>> = mass.entries.chunks_exact(n).map(|row| factor.forward(row)).collect();
        let column = |j: usize| factor.forward(&half.iter().map(|row| row[j]).collect::<Vec<_>>());
        let columns: Vec<Vec<f64>> = (0..n).map(column).collect();
        let mut inner = Matrix { order: n, entries: Vec::with_capacity(n * n) };
        for i in 0..n {
            inner.entries.extend((0..n).map(|j| 0.5 * (columns[i][j] + columns[j][i])));
        }
        let axes = turn_to_axes(&mut inner)?;
        let shapes: Vec<Vec<f64>> = axes.iter().map(|axis| factor.backward(axis)).collect();
        let mut inverse: Vec<Vec<f64>> = axes.iter().map(|axis| factor.spread(axis)).collect();
        invert_again(&shapes, &mut inverse);
        let omega: Vec<f64> = (0..n).map(|k| 1.0 / inner.at(k, k).sqrt()).collect();
        let are_frequencies = omega.iter().all(|omega| *omega > 0.0 && omega.is_finite());
        are_frequencies.then_some(Self { omega, shapes, inverse })
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

/// Leaves the eigenvalues on the diagonal; gives the eigenvectors. `None` where it does not end.
fn turn_to_axes(matrix: &mut Matrix) -> Option<Vec<Vec<f64>>> {
    let n = matrix.order;
    let mut axes = Matrix::diagonal(&vec![1.0; n]).entries;
    for _ in 0..MOST_SWEEPS {
        let mut still = true;
        for p in 0..n {
            for q in p + 1..n {
                let [first, second, between] = [matrix.at(p, p), matrix.at(q, q), matrix.at(p, q)];
                if !(between.abs() > f64::EPSILON * (first * second).sqrt()) {
                    continue;
                }
                still = false;
                let half = (second - first) / (2.0 * between);
                let tangent = half.signum() / (half.abs() + (1.0 + half * half).sqrt());
                let cosine = 1.0 / (1.0 + tangent * tangent).sqrt();
                let sine = tangent * cosine;
                let turn = |x: f64, y: f64| [cosine * x - sine * y, sine * x + cosine * y];
                turn_rows(&mut matrix.entries, n, [p, q], turn);
                turn_rows(&mut axes, n, [p, q], turn);
                // It stays symmetric.
                for k in 0..n {
                    matrix.entries[k * n + p] = matrix.entries[p * n + k];
                    matrix.entries[k * n + q] = matrix.entries[q * n + k];
                }
                matrix.entries[p * n + p] = first - tangent * between;
                matrix.entries[q * n + q] = second + tangent * between;
                matrix.entries[p * n + q] = 0.0;
                matrix.entries[q * n + p] = 0.0;
            }
        }
        if still {
            return Some(axes.chunks_exact(n).map(<[f64]>::to_vec).collect());
        }
    }
    None
}

/// Turns row p and row q > p of a matrix of `n` columns, entry by entry.
#[inline(always)]
fn turn_rows(entries: &mut [f64], n: usize, [p, q]: [usize; 2], turn: impl Fn(f64, f64) -> [f64; 2]) {
    let (before, behind) = entries.split_at_mut(q * n);
    for (x, y) in before[p * n..][..n].iter_mut().zip(&mut behind[..n]) {
        [*x, *y] = turn(*x, *y);
    }
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
