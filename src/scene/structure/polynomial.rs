//! The polynomial basis of the cantilever, ξ², ξ³, … ξ^(N+1), spanned so that nothing is lost.
//!
//! In powers of ξ the mass matrix has a condition number of 2·10¹² at N = 8 and no Cholesky factor in double precision at N = 11.
//! Here the same space is spanned by the twofold integrals ψ_i of Legendre polynomials, which vanish with their slope at the clamp:
//! ∫ ψ_i″ψ_j″ dξ = δ_ij exactly, and their coefficients over the orthonormal Legendre polynomials are known in closed form, five
//! to a column at most. Turning the columns in pairs until they are orthogonal (one-sided Jacobi) leaves the stiffness the unit
//! matrix and makes the mass diagonal: the columns are the modes, their squared lengths 1/β⁴, each to its own last digits.

use std::sync::OnceLock;

/// Most polynomials: the frequencies of the highest grow with the fourth power of their number.
pub(super) const MOST: usize = 60;

/// A mode of the polynomial space, ∫ w² dξ = 1.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Mode {
    /// β: ω = β² √(EI/(ρA L⁴)).
    pub(super) beta: f64,
    /// Over √(2k+1) P_k(2ξ − 1).
    coefficients: Vec<f64>,
}

/// The modes of N polynomials, slowest first. They are the same for every beam, and worked out once.
pub(super) fn modes(count: usize) -> Vec<Mode> {
    static KNOWN: [OnceLock<Vec<Mode>>; MOST + 1] = [const { OnceLock::new() }; MOST + 1];
    match KNOWN.get(count) {
        Some(known) => known.get_or_init(|| rayleigh_ritz(count)).clone(),
        None => rayleigh_ritz(count),
    }
}

fn rayleigh_ritz(count: usize) -> Vec<Mode> {
    let mut columns: Vec<Vec<f64>> = (0..count).map(|i| twofold_integral(i, count + 2)).collect();
    // A handful of sweeps; the bound only ends a loop that rounding might keep going.
    for _ in 0..40 {
        let mut turned = false;
        for i in 0..count {
            for j in i + 1..count {
                turned |= turn(&mut columns, i, j);
            }
        }
        if !turned {
            break;
        }
    }
    let mut modes: Vec<Mode> = columns
        .into_iter()
        .map(|column| {
            let length = norm(&column);
            let tip: f64 = column.iter().enumerate().map(|(k, c)| c * (2.0 * k as f64 + 1.0).sqrt()).sum();
            // Sign as the exact modes have it: positive curvature at the clamp, so that φ(L) alternates from +2.
            let scale = 1.0 / length * tip.signum();
            Mode { beta: 1.0 / length.sqrt(), coefficients: column.iter().map(|c| c * scale).collect() }
        })
        .collect();
    modes.sort_by(|a, b| a.beta.total_cmp(&b.beta));
    for mode in modes.iter_mut().skip(1).step_by(2) {
        mode.coefficients.iter_mut().for_each(|c| *c = -*c);
    }
    modes
}

/// All modes at ξ.
pub(super) fn at(modes: &[Mode], xi: f64) -> Vec<f64> {
    let size = modes.first().map_or(0, |mode| mode.coefficients.len());
    let t = 2.0 * xi - 1.0;
    let mut legendre = vec![1.0; size];
    if size > 1 {
        legendre[1] = t;
    }
    for k in 2..size {
        let n = k as f64;
        legendre[k] = ((2.0 * n - 1.0) * t * legendre[k - 1] - (n - 1.0) * legendre[k - 2]) / n;
    }
    for (k, value) in legendre.iter_mut().enumerate() {
        *value *= (2.0 * k as f64 + 1.0).sqrt();
    }
    modes.iter().map(|mode| dot(&mode.coefficients, &legendre)).collect()
}

/// ψ_i over the orthonormal Legendre polynomials: P_i integrated twice from the clamp, scaled to ∫ ψ″² dξ = 1.
fn twofold_integral(i: usize, size: usize) -> Vec<f64> {
    let mut unit = vec![0.0; size + 2];
    unit[i] = 1.0;
    let twice = integral(&integral(&unit));
    // d²/dξ² = 4 d²/dt² and ∫ P_i² dξ = 1/(2i+1).
    let scale = (2.0 * i as f64 + 1.0).sqrt() / 4.0;
    (0..size).map(|k| scale * twice[k] / (2.0 * k as f64 + 1.0).sqrt()).collect()
}

/// ∫ from −1 of Σ c_k P_k dt: ∫ P_k = (P_(k+1) − P_(k−1))/(2k+1), ∫ P_0 = P_1 + P_0.
fn integral(c: &[f64]) -> Vec<f64> {
    let mut sum = vec![0.0; c.len()];
    for (k, c) in c.iter().enumerate().filter(|(_, c)| **c != 0.0) {
        let share = c / (2.0 * k as f64 + 1.0);
        sum[k + 1] += share;
        if k == 0 { sum[0] += share } else { sum[k - 1] -= share }
    }
    sum
}

/// Turns two columns so that they become orthogonal; false if they were.
fn turn(columns: &mut [Vec<f64>], i: usize, j: usize) -> bool {
    let (a, b, c) = (dot(&columns[i], &columns[i]), dot(&columns[j], &columns[j]), dot(&columns[i], &columns[j]));
    if c.abs() <= f64::EPSILON * (a * b).sqrt() {
        return false;
    }
    let zeta = (b - a) / (2.0 * c);
    let tangent = zeta.signum() / (zeta.abs() + libm::hypot(1.0, zeta));
    let cosine = 1.0 / libm::hypot(1.0, tangent);
    let sine = cosine * tangent;
    let (left, right) = columns.split_at_mut(j);
    for (x, y) in left[i].iter_mut().zip(&mut right[0]) {
        (*x, *y) = (cosine * *x - sine * *y, sine * *x + cosine * *y);
    }
    true
}

fn norm(column: &[f64]) -> f64 {
    dot(column, column).sqrt()
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    crate::dynamics::dot(a, b)
}
