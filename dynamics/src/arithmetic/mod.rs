//! Arithmetic: vectors, matrices and elementary functions, several numbers at a time, the same bits on every processor.

pub(crate) mod cholesky;
pub(crate) mod complexes;
pub(crate) mod dense;
pub(crate) mod elementary;
pub(crate) mod elimination;
pub(crate) mod exact;
pub(crate) mod few;
pub(crate) mod four;
pub(crate) mod gauss;
pub(crate) mod lagrange;
pub(crate) mod lanes;
pub(crate) mod matrix;
pub(crate) mod quadrature;
pub(crate) mod schur;
pub(crate) mod superposition;
pub(crate) mod wide;

/// The larger of two numbers, NaN if one of them is: where what is no number proves nothing.
pub(crate) fn larger_or_nan(a: f64, b: f64) -> f64 {
    if a.is_nan() || b.is_nan() { f64::NAN } else { a.max(b) }
}
