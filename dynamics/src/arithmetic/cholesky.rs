//! Cholesky factors of matrices of masses and springs; own loops, since their bits reach the results.

use crate::arithmetic::matrix::Matrix;
use crate::error::EngineError;

/// A = L Lᵀ.
#[derive(Clone)]
pub(crate) struct Cholesky {
    order: usize,
    lower: Vec<f64>,
}

impl Cholesky {
    pub(crate) fn new(mass: &Matrix) -> Result<Self, EngineError> {
        let n = mass.order;
        let mut lower = vec![0.0; n * n];
        for j in 0..n {
            let pivot = (0..j).fold(mass.at(j, j), |sum, k| sum - lower[j * n + k] * lower[j * n + k]);
            if !(pivot > 0.0) {
                return Err(EngineError::MassNotPositive { row: j });
            }
            lower[j * n + j] = pivot.sqrt();
            for i in j + 1..n {
                let sum = (0..j).fold(mass.at(i, j), |sum, k| sum - lower[i * n + k] * lower[j * n + k]);
                lower[i * n + j] = sum / lower[j * n + j];
            }
        }
        Ok(Self { order: n, lower })
    }

    /// A column of L.
    pub(crate) fn column(&self, j: usize) -> Vec<f64> {
        self.lower.iter().skip(j).step_by(self.order).copied().collect()
    }

    /// A⁻¹ b.
    pub(crate) fn solve(&self, b: &[f64]) -> Vec<f64> {
        self.backward(&self.forward(b))
    }

    /// L⁻¹ b.
    pub(crate) fn forward(&self, b: &[f64]) -> Vec<f64> {
        let n = self.order;
        let mut x = b.to_vec();
        for i in 0..n {
            x[i] = (0..i).fold(x[i], |sum, k| sum - self.lower[i * n + k] * x[k]) / self.lower[i * n + i];
        }
        x
    }

    /// L b.
    pub(crate) fn spread(&self, b: &[f64]) -> Vec<f64> {
        let n = self.order;
        (0..n).map(|i| (0..=i).fold(0.0, |sum, k| sum + self.lower[i * n + k] * b[k])).collect()
    }

    /// L⁻ᵀ b.
    pub(crate) fn backward(&self, b: &[f64]) -> Vec<f64> {
        let n = self.order;
        let mut x = b.to_vec();
        for i in (0..n).rev() {
            x[i] = (i + 1..n).fold(x[i], |sum, k| sum - self.lower[k * n + i] * x[k]) / self.lower[i * n + i];
        }
        x
    }
}
