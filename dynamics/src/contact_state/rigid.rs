//! Rigid-body motions along no single coordinate: a structure that its springs hold to itself alone.
//!
//! Where K z = 0, z takes the place of one coordinate: p = T x, with T the unit matrix but for its columns z. In x no spring feels that
//! coordinate, to the bit. To rounding would not do: an eigenvalue of 10⁻¹⁷ in the place of zero has a place of rest, at 10¹⁷.
//!
//! The z come from Cholesky's factors of K with its diagonal scaled to ones and taken out largest first: where what is left is rounding,
//! the rest of the coordinates are free, and K_pp z_p = −K_pf gives what the others do when one of them moves by 1.

use crate::arithmetic::cholesky::Cholesky;
use crate::arithmetic::matrix::Matrix;

/// What is left of the unit diagonal of n coordinates is rounding below this, times n.
const ROUNDING: f64 = 64.0 * f64::EPSILON;

/// T, of its columns z what stands beside their own 1.
pub(crate) struct RigidMotions {
    order: usize,
    /// The coordinates that become those of rigid-body motions.
    free: Vec<usize>,
    /// All others that have springs.
    held: Vec<usize>,
    /// Of each motion what the held ones do.
    with: Vec<Vec<f64>>,
}

impl RigidMotions {
    /// `None` if there is none beside those of coordinates that have no spring at all.
    pub(crate) fn of(stiffness: &Matrix) -> Option<Self> {
        let order = stiffness.order;
        let sprung: Vec<usize> = (0..order).filter(|&i| stiffness.at(i, i) > 0.0).collect();
        let unit = |i: usize| stiffness.at(i, i).sqrt();
        let scaled = |of: &[usize]| Matrix {
            order: of.len(),
            entries: of
                .iter()
                .flat_map(|&i| of.iter().map(move |&j| stiffness.at(i, j) / (unit(i) * unit(j))))
                .collect(),
        };
        let is_held = held(scaled(&sprung));
        let chosen =
            |wanted: bool| sprung.iter().zip(&is_held).filter(|(_, held)| **held == wanted).map(|(&i, _)| i).collect();
        let [held, free]: [Vec<usize>; 2] = [chosen(true), chosen(false)];
        if free.is_empty() {
            return None;
        }
        let factors = Cholesky::new(&scaled(&held)).ok()?;
        let motion = |&f: &usize| {
            let push: Vec<f64> = held.iter().map(|&i| -stiffness.at(i, f) / (unit(i) * unit(f))).collect();
            factors.solve(&push).iter().zip(&held).map(|(z, &i)| z * unit(f) / unit(i)).collect()
        };
        Some(Self { order, with: free.iter().map(motion).collect(), free, held })
    }

    /// Tᵀ A T; where A is the stiffness, `is_stiffness`, what is zero is so to the bit.
    pub(crate) fn form(&self, matrix: &Matrix, is_stiffness: bool) -> Matrix {
        let mut rows: Vec<Vec<f64>> =
            (0..self.order).map(|i| (0..self.order).map(|j| matrix.at(i, j)).collect()).collect();
        rows.iter_mut().for_each(|row| self.times(row, is_stiffness));
        let mut columns: Vec<Vec<f64>> = (0..self.order).map(|j| rows.iter().map(|row| row[j]).collect()).collect();
        columns.iter_mut().for_each(|column| self.times(column, is_stiffness));
        let at = |at: usize| columns[at % self.order][at / self.order];
        Matrix { order: self.order, entries: (0..self.order * self.order).map(at).collect() }
    }

    /// Accelerations of x by (x, x′) from those of p by (p, p′): T⁻¹ S T and T⁻¹ D T.
    pub(crate) fn accelerations(&self, of: &[Vec<f64>]) -> Vec<Vec<f64>> {
        let mut turned = of.to_vec();
        for row in &mut turned {
            let (stiffness, damping) = row.split_at_mut(self.order);
            self.times(stiffness, true);
            self.times(damping, false);
        }
        let free: Vec<Vec<f64>> = self.free.iter().map(|&f| turned[f].clone()).collect();
        for (row, with) in free.iter().zip(&self.with) {
            for (&i, share) in self.held.iter().zip(with) {
                turned[i].iter_mut().zip(row).for_each(|(entry, of_free)| *entry -= share * of_free);
            }
        }
        turned
    }

    /// Block coordinates of (x, x′), V row by row and W column by column, as those of (p, p′).
    pub(crate) fn back(&self, from_blocks: &mut [f64], to_blocks: &mut [f64]) {
        let width = from_blocks.len() / (2 * self.order);
        for half in [0, self.order] {
            let at = |i: usize| (half + i) * width..(half + i + 1) * width;
            for (&f, with) in self.free.iter().zip(&self.with) {
                for (&i, share) in self.held.iter().zip(with) {
                    for k in 0..width {
                        from_blocks[at(i).start + k] += share * from_blocks[at(f).start + k];
                        to_blocks[at(f).start + k] -= share * to_blocks[at(i).start + k];
                    }
                }
            }
        }
    }

    /// A row of a matrix times T. Where a motion is felt by rounding alone, or not at all, as by springs, it is zero to the bit.
    fn times(&self, row: &mut [f64], by_springs: bool) {
        for (&f, with) in self.free.iter().zip(&self.with) {
            let own = row[f];
            let (sum, size) = self.held.iter().zip(with).fold((own, own.abs()), |(sum, size), (&i, share)| {
                (sum + share * row[i], size + (share * row[i]).abs())
            });
            let is_rounding = sum.abs() <= ROUNDING * self.order as f64 * size;
            row[f] = if by_springs || is_rounding { 0.0 } else { sum };
        }
    }
}

/// Which coordinates of a matrix with a unit diagonal are held, taken largest first.
fn held(mut matrix: Matrix) -> Vec<bool> {
    let n = matrix.order;
    let mut held = vec![false; n];
    loop {
        let left = (0..n).filter(|&i| !held[i]);
        let next = left.max_by(|&i, &j| matrix.at(i, i).total_cmp(&matrix.at(j, j)));
        let Some(next) = next.filter(|&i| matrix.at(i, i) > ROUNDING * n as f64) else { return held };
        let row: Vec<f64> = (0..n).map(|j| matrix.at(next, j)).collect();
        for (entries, share) in matrix.entries.chunks_exact_mut(n).zip(row.iter().map(|entry| entry / row[next])) {
            entries.iter_mut().zip(&row).for_each(|(entry, of_next)| *entry -= share * of_next);
        }
        held[next] = true;
    }
}
