//! The real Schur form A = Q T Qᵀ: T upper triangular but for 2 × 2 pieces of complex pairs.
//!
//! The library's iteration shifts by det − tr·h + h², which is all rounding where several slow eigenvalues are nearly equal
//! beside a fast one (light particles on dashpots of one kind), and it has no other shift to go on with. Where it stalls, the
//! iteration here takes over: shifts as products of differences, and an exceptional shift every tenth sweep (Francis, Comput. J.
//! 4, 1961; Wilkinson & Reinsch, Handbook for Automatic Computation II, 1971, II/15).

use nalgebra::{DMatrix, Hessenberg, Schur};

use crate::arithmetic::wide::widened;
use crate::error::EngineError;

/// Sweeps for each eigenvalue; three are usual.
const SWEEPS: usize = 30;
/// Every so many sweeps without a result the shift is another one.
const PATIENCE: usize = 10;

/// Q and T.
pub(crate) fn schur(a: DMatrix<f64>) -> Result<[DMatrix<f64>; 2], EngineError> {
    let order = a.nrows();
    let library = Schur::try_new(a.clone(), f64::EPSILON, SWEEPS * order).map(|form| form.unpack().into());
    library.or_else(|| Francis::form(a)).ok_or(EngineError::NoSchurForm { order })
}

/// The iteration on a Hessenberg form.
struct Francis {
    q: DMatrix<f64>,
    t: DMatrix<f64>,
}

impl Francis {
    /// Q and T, if the iteration ends.
    fn form(a: DMatrix<f64>) -> Option<[DMatrix<f64>; 2]> {
        let (q, t) = Hessenberg::new(a).unpack();
        let mut form = Self { q, t };
        form.run().then_some([form.q, form.t])
    }

    widened! {
        /// False if it does not end.
        fn run | run_wide (&mut self) -> bool = run_by_registers
    }

    #[inline(always)]
    fn run_by_registers(&mut self) -> bool {
        let (mut end, mut sweeps, mut in_vain) = (self.t.nrows(), 0, 0);
        while end > 1 {
            let begin = self.split(end);
            if end - begin > 2 {
                (sweeps, in_vain) = (sweeps + 1, in_vain + 1);
                if sweeps > SWEEPS * self.t.nrows() {
                    return false;
                }
                self.sweep(begin, end, in_vain % PATIENCE == 0);
                continue;
            }
            if end - begin == 2 {
                self.part(begin);
            }
            (end, in_vain) = (begin, 0);
        }
        true
    }

    /// Where the last piece before `end` begins; what is rounding there becomes zero.
    fn split(&mut self, end: usize) -> usize {
        let t = &mut self.t;
        for i in (1..end).rev() {
            if t[(i, i - 1)].abs() <= f64::EPSILON * (t[(i - 1, i - 1)].abs() + t[(i, i)].abs()) {
                t[(i, i - 1)] = 0.0;
                return i;
            }
        }
        0
    }

    /// One double step on the rows and columns from `begin` to `end`.
    #[inline(always)]
    fn sweep(&mut self, begin: usize, end: usize, exceptional: bool) {
        let (t, last) = (&self.t, end - 1);
        let mut shifts = [t[(last, last)], t[(last - 1, last - 1)], t[(last, last - 1)] * t[(last - 1, last)]];
        if exceptional {
            let size = t[(last, last - 1)].abs() + t[(last - 1, last - 2)].abs();
            let place = t[(last, last)] + 0.75 * size;
            shifts = [place, place, -0.4375 * size * size];
        }
        // The first column of (T − σ₁)(T − σ₂), up to a factor.
        let [x, y, w] = shifts;
        let z = t[(begin, begin)];
        let (r, s) = (x - z, y - z);
        let below = t[(begin + 1, begin)];
        let mut axis = [
            (r * s - w) / below + t[(begin, begin + 1)],
            t[(begin + 1, begin + 1)] - z - r - s,
            t[(begin + 2, begin + 1)],
        ];
        for k in begin..last {
            let size = if k + 2 < end { 3 } else { 2 };
            if k > begin {
                axis = [0, 1, 2].map(|i| if i < size { self.t[(k + i, k - 1)] } else { 0.0 });
            }
            if size == 3 {
                self.reflect(k, axis, end)
            } else {
                self.reflect(k, [axis[0], axis[1]], end)
            }
            if k > begin {
                (1..size).for_each(|i| self.t[(k + i, k - 1)] = 0.0);
            }
        }
    }

    /// Reflects the rows and columns from `k` on so that `axis` points along the first of them.
    #[inline(always)]
    fn reflect<const SIZE: usize>(&mut self, k: usize, axis: [f64; SIZE], end: usize) {
        let largest = axis.iter().fold(0.0_f64, |most, x| most.max(x.abs()));
        if largest == 0.0 {
            return;
        }
        let mut v = axis.map(|x| x / largest);
        let length = v.iter().fold(0.0, |sum, x| sum + x * x).sqrt();
        v[0] += if v[0] < 0.0 { -length } else { length };
        let factor = 2.0 / v.iter().fold(0.0, |sum, x| sum + x * x);
        let order = self.t.nrows();
        for column in self.t.as_mut_slice().chunks_exact_mut(order).skip(k.saturating_sub(1)) {
            let entries = &mut column[k..k + SIZE];
            let share = factor * v.iter().zip(&*entries).fold(0.0, |sum, (v, entry)| sum + v * entry);
            entries.iter_mut().zip(v).for_each(|(entry, v)| *entry -= share * v);
        }
        for (matrix, rows) in [(&mut self.t, order.min(end.min(k + 4))), (&mut self.q, order)] {
            let mut columns = matrix.as_mut_slice()[k * order..(k + SIZE) * order].chunks_exact_mut(order);
            let mut columns: [&mut [f64]; SIZE] =
                std::array::from_fn(|_| &mut columns.next().expect("one for each entry")[..rows]);
            for row in 0..rows {
                let share = factor * v.iter().zip(&columns).fold(0.0, |sum, (v, column)| sum + v * column[row]);
                columns.iter_mut().zip(v).for_each(|(column, v)| column[row] -= share * v);
            }
        }
    }

    /// A piece of order two with real eigenvalues becomes triangular.
    fn part(&mut self, i: usize) {
        let (b, c) = (self.t[(i, i + 1)], self.t[(i + 1, i)]);
        let half = 0.5 * (self.t[(i, i)] - self.t[(i + 1, i + 1)]);
        let discriminant = half * half + b * c;
        if discriminant >= 0.0 {
            // (T − λ)(x, 1) = 0 in the second row, λ the eigenvalue nearer to the first entry.
            let x = half + discriminant.sqrt().copysign(half);
            self.reflect(i, [x, c], i + 2);
            self.t[(i + 1, i)] = 0.0;
        }
    }
}

#[cfg(test)]
pub(crate) mod tests {
    use super::*;

    /// Numbers between two bounds, drawn evenly.
    pub(crate) fn numbers(mut state: u64) -> impl FnMut(f64, f64) -> f64 {
        move |low, high| {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            low + (high - low) * ((state >> 11) as f64 / (1_u64 << 53) as f64)
        }
    }

    #[test]
    fn equal_slow_eigenvalues_beside_fast_ones_are_decomposed() {
        // Light particles of one kind on dashpots of one kind, on oscillators: as many eigenvalues near k/c.
        for seed in 0..300_u64 {
            let mut number = numbers(seed);
            let (modes, particles) = (number(2.0, 6.99) as usize, number(4.0, 6.99) as usize);
            let (mass, stiffness, damping) = (number(5e-4, 5e-3), number(1e2, 1e3), number(10.0, 50.0));
            let count = modes + particles;
            let mut matrix = DMatrix::zeros(2 * count, 2 * count);
            (0..modes).for_each(|i| matrix[(count + i, i)] = -900.0 * ((i + 1) * (i + 1)) as f64);
            for j in 0..particles {
                let row: Vec<f64> = (0..modes).map(|_| number(-1.4, 1.4)).collect();
                for (half, size) in [(0, stiffness), (count, damping)] {
                    let column = half + modes + j;
                    for i in 0..modes {
                        matrix[(count + i, column)] += size * row[i];
                    }
                    matrix[(count + modes + j, column)] -= size / mass;
                }
                for column in 0..2 * count {
                    let face = (0..modes).fold(0.0, |sum, i| sum + row[i] * matrix[(count + i, column)]);
                    matrix[(count + modes + j, column)] -= face;
                }
            }
            // Lengths by frequencies, as the engine scales them.
            for i in 0..count {
                let frequency = matrix[(count + i, i)].abs().sqrt();
                matrix[(i, count + i)] = frequency;
                (count..2 * count).for_each(|row| matrix[(row, i)] /= frequency);
            }
            let largest = matrix.amax();
            for [q, t] in [schur(matrix.clone()).unwrap(), Francis::form(matrix.clone()).unwrap()] {
                assert!((&q * q.transpose() - DMatrix::identity(2 * count, 2 * count)).amax() < 1e-13);
                assert!((&q * &t * q.transpose() - &matrix).amax() < 1e-13 * largest, "seed {seed}");
                for i in 2..2 * count {
                    assert!((0..i - 1).all(|j| t[(i, j)] == 0.0));
                    assert!(t[(i, i - 1)] == 0.0 || t[(i - 1, i - 2)] == 0.0, "seed {seed}");
                }
            }
        }
    }
}
