//! Mode shapes of uniform beams in closed form, over shares of the length. Written so that they stay accurate however high
//! the mode is: nowhere is a large number subtracted from another.
//!
//! φ = cosh βx − cos βx − σ (sinh βx − sin βx) with cos β cosh β = ∓1 (R. D. Blevins, Formulas for Natural Frequency and
//! Mode Shape, table 8-1).

use std::f64::consts::PI;

/// A beam's mode, clamped at 0.
#[derive(Debug, Clone, Copy)]
pub(super) struct Mode {
    beta: f64,
    /// Which end is at 1.
    end: End,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum End {
    Free,
    Clamped,
}

impl Mode {
    /// The n-th mode of a cantilever, counted from 1.
    pub(super) fn cantilever(n: u32) -> Self {
        Self::new(f64::from(n) - 0.5, -1.0, End::Free)
    }

    /// The n-th mode of a beam clamped at both ends, counted from 1.
    pub(super) fn clamped(n: u32) -> Self {
        Self::new(f64::from(n) + 0.5, 1.0, End::Clamped)
    }

    /// Newton's method on cos β = ±1/cosh β; the start is off by less than 1/cosh of itself.
    fn new(halves: f64, sign: f64, end: End) -> Self {
        let mut beta = halves * PI;
        for _ in 0..20 {
            let slope = -libm::sin(beta) + sign * libm::sinh(beta) / (libm::cosh(beta) * libm::cosh(beta));
            let step = (libm::cos(beta) - sign / libm::cosh(beta)) / slope;
            if !step.is_finite() {
                break;
            }
            beta -= step;
        }
        Self { beta, end }
    }

    /// The deflection at a share of the length.
    pub(super) fn at(&self, x: f64) -> f64 {
        let beta = self.beta;
        let (sin, cos, fading) = (libm::sin(beta), libm::cos(beta), libm::exp(-beta));
        // Both from the condition at the far end, numerator and denominator over e^β/2.
        let (below, above) = match self.end {
            End::Free => (1.0 - fading * fading + 2.0 * fading * sin, 2.0 * (sin - cos - fading)),
            End::Clamped => (1.0 - fading * fading - 2.0 * fading * sin, 2.0 * (cos - sin - fading)),
        };
        // 1 − σ is of the order of e^−β, and stands before e^βx.
        let growing = above / below;
        let one_plus_sigma = 2.0 - growing * fading;
        let sigma = 1.0 - growing * fading;
        0.5 * growing * libm::exp(beta * (x - 1.0)) + 0.5 * one_plus_sigma * libm::exp(-beta * x) - libm::cos(beta * x)
            + sigma * libm::sin(beta * x)
    }
}

/// sin nπx, zero at both ends.
pub(super) fn sine(n: u32, x: f64) -> f64 {
    libm::sin(f64::from(n) * PI * x)
}

#[cfg(test)]
mod tests {
    use super::Mode;

    #[test]
    fn the_roots_are_those_of_the_tables() {
        let roots = [1.875_104_068_711_961, 4.694_091_132_974_175, 7.854_757_438_237_613, 10.995_540_734_875_467];
        for (n, root) in (1..).zip(roots) {
            assert!((Mode::cantilever(n).beta - root).abs() < 1e-12);
        }
        for (n, root) in (1..).zip([4.730_040_744_862_704, 7.853_204_624_095_838]) {
            assert!((Mode::clamped(n).beta - root).abs() < 1e-12);
        }
    }

    #[test]
    fn high_modes_keep_to_both_ends() {
        for n in 1..=60 {
            let cantilever = Mode::cantilever(n);
            assert!(cantilever.at(0.0).abs() < 1e-12, "{n}");
            assert!((cantilever.at(1.0).abs() - 2.0).abs() < 1e-9, "{n}: {}", cantilever.at(1.0));
            let clamped = Mode::clamped(n);
            assert!(clamped.at(0.0).abs() < 1e-12 && clamped.at(1.0).abs() < 1e-9, "{n}: {}", clamped.at(1.0));
        }
    }
}
