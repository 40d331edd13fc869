//! Small dense matrices of many digits.

use super::double::Double;
use crate::dynamics::Matrix;

/// Row by row.
#[derive(Debug, Clone)]
pub(super) struct Square {
    order: usize,
    entries: Vec<Double>,
}

impl Square {
    pub(super) fn of(matrix: &Matrix) -> Self {
        Self { order: matrix.order, entries: matrix.entries.iter().map(|entry| Double::from(*entry)).collect() }
    }

    /// Adds s·a·aᵀ.
    pub(super) fn add_square(&mut self, s: f64, a: &[f64]) {
        for i in 0..self.order {
            for j in 0..self.order {
                self.entries[i * self.order + j] += Double::from(s) * a[i] * a[j];
            }
        }
    }

    /// A⁻¹ of each of these columns, by elimination with pivots; `None` for a singular matrix.
    pub(super) fn solve(&self, columns: &[Vec<Double>]) -> Option<Vec<Vec<Double>>> {
        let n = self.order;
        let mut a = self.entries.clone();
        let mut x: Vec<Vec<Double>> = columns.to_vec();
        for k in 0..n {
            let pivot = (k..n).max_by(|i, j| a[i * n + k].near().abs().total_cmp(&a[j * n + k].near().abs()))?;
            if a[pivot * n + k].near() == 0.0 {
                return None;
            }
            for j in 0..n {
                a.swap(k * n + j, pivot * n + j);
            }
            x.iter_mut().for_each(|column| column.swap(k, pivot));
            for i in 0..n {
                if i == k || a[i * n + k].near() == 0.0 {
                    continue;
                }
                let factor = a[i * n + k] / a[k * n + k];
                for j in k..n {
                    let by = factor * a[k * n + j];
                    a[i * n + j] = a[i * n + j] - by;
                }
                for column in &mut x {
                    let by = factor * column[k];
                    column[i] = column[i] - by;
                }
            }
        }
        for column in &mut x {
            for k in 0..n {
                column[k] = column[k] / a[k * n + k];
            }
        }
        Some(x)
    }

    pub(super) fn column(&self, j: usize) -> Vec<Double> {
        (0..self.order).map(|i| self.entries[i * self.order + j]).collect()
    }
}

/// Σ aᵢ xᵢ.
pub(super) fn dot(a: &[f64], x: &[Double]) -> Double {
    a.iter().zip(x).filter(|(a, _)| **a != 0.0).fold(Double::ZERO, |sum, (a, x)| sum + *x * *a)
}
