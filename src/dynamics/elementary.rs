//! Elementary functions: the same bits on every processor.
//!
//! The `libm` crate compiles to plain arithmetic, without the C library's choice of kernels at run time.

#[inline]
pub(crate) fn exp(x: f64) -> f64 {
    libm::exp(x)
}

#[inline]
pub(crate) fn sin_cos(x: f64) -> (f64, f64) {
    libm::sincos(x)
}
