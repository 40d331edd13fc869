//! Normal modes: natural frequencies and shapes of M q″ + K q = 0, undamped.
//!
//! Where K has a Cholesky factor L, 1/ω² are the eigenvalues of L⁻¹ M L⁻ᵀ: so the low frequencies come out to rounding however far
//! the high ones lie. Else (a structure that floats) ω² are those of the other way round.

use nalgebra::{Cholesky, DMatrix, DVector, Dyn};

use super::{CompileError, Scene, compile};
use crate::dynamics::{HybridSystem, Law, Matrix};

/// One normal mode.
#[derive(Debug, Clone, PartialEq)]
pub struct NormalMode {
    /// ω, rad/s.
    pub frequency: f64,
    /// q.
    pub shape: Vec<f64>,
}

/// All normal modes, slowest first; none if neither matrix is positive definite.
#[must_use]
pub fn normal_modes(mass: &Matrix, stiffness: &Matrix) -> Vec<NormalMode> {
    let dense = |matrix: &Matrix| DMatrix::from_row_slice(matrix.order, matrix.order, &matrix.entries);
    let (m, k) = (dense(mass), dense(stiffness));
    let mut modes = if let Some(factor) = Cholesky::new(k.clone()) {
        against(&factor, &m, |value| 1.0 / value.max(f64::MIN_POSITIVE).sqrt())
    } else if let Some(factor) = Cholesky::new(m) {
        against(&factor, &k, |value| value.max(0.0).sqrt())
    } else {
        Vec::new()
    };
    modes.sort_by(|a, b| a.frequency.total_cmp(&b.frequency));
    modes
}

/// Eigenpairs of L⁻¹ A L⁻ᵀ, brought back by L⁻ᵀ.
fn against(factor: &Cholesky<f64, Dyn>, a: &DMatrix<f64>, frequency: impl Fn(f64) -> f64) -> Vec<NormalMode> {
    let lower = factor.l();
    let solve = |x: &DMatrix<f64>| lower.solve_lower_triangular(x).unwrap_or_else(|| x.clone());
    let reduced = solve(&solve(a).transpose());
    let symmetric = (&reduced + reduced.transpose()) * 0.5;
    let eigen = symmetric.symmetric_eigen();
    let upper = lower.transpose();
    let back = |v: DVector<f64>| upper.solve_upper_triangular(&v).unwrap_or(v);
    let pairs = eigen.eigenvalues.iter().zip(eigen.eigenvectors.column_iter());
    pairs
        .map(|(value, vector)| NormalMode {
            frequency: frequency(*value),
            shape: back(vector.into_owned()).iter().copied().collect(),
        })
        .collect()
}

impl Scene {
    /// Normal modes of the structure with its dampers on board and every particle at rest on its floor, without any dashpot.
    /// The first coordinates are the structure's.
    ///
    /// # Errors
    /// [`CompileError`] where the scene asks for what no model covers.
    pub fn normal_modes(&self) -> Result<Vec<NormalMode>, CompileError> {
        let (mass, stiffness) = at_rest(&compile(self)?);
        Ok(normal_modes(&mass, &stiffness))
    }
}

/// M and K of (q, w), each particle moving with φ·q + w on its floor's spring, or with φ·q alone.
fn at_rest(system: &HybridSystem) -> (Matrix, Matrix) {
    let springs: Vec<(usize, f64)> = system
        .particles
        .iter()
        .enumerate()
        .filter_map(|(j, particle)| match particle.floor.law {
            Law::Resilient { stiffness, .. } => Some((j, stiffness)),
            Law::Rigid { .. } => None,
        })
        .collect();
    let n = system.mass.order;
    let order = n + springs.len();
    let mut mass = Matrix::diagonal(&vec![0.0; order]);
    let mut stiffness = mass.clone();
    for i in 0..n {
        mass.entries[i * order..][..n].copy_from_slice(&system.mass.entries[i * n..][..n]);
        stiffness.entries[i * order..][..n].copy_from_slice(&system.stiffness.entries[i * n..][..n]);
    }
    for (slot, (_, spring)) in springs.iter().enumerate() {
        stiffness.entries[(n + slot) * order + n + slot] = *spring;
    }
    for (j, particle) in system.particles.iter().enumerate() {
        let mut row = particle.floor.row.clone();
        row.resize(order, 0.0);
        if let Some(slot) = springs.iter().position(|(with, _)| *with == j) {
            row[n + slot] = 1.0;
        }
        mass.add_square(particle.mass, &row);
    }
    (mass, stiffness)
}
