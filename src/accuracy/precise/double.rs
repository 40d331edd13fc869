//! Numbers of some 32 digits: the unevaluated sum of two doubles.
//!
//! Sums after Knuth, products after Dekker (splitting after Veltkamp, so that no fused operation is needed), combined as in
//! Hida, Li and Bailey, Algorithms for quad-double precision floating point arithmetic (ARITH-15, 2001).

use std::ops::{Add, AddAssign, Div, Mul, Neg, Sub};

/// hi + lo with |lo| at most half a unit in the last place of hi.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(super) struct Double {
    hi: f64,
    lo: f64,
}

/// a + b and what rounding took from it.
fn two_sum(a: f64, b: f64) -> Double {
    let hi = a + b;
    let c = hi - a;
    Double { hi, lo: (a - (hi - c)) + (b - c) }
}

/// The same where |a| ≥ |b|.
fn quick_two_sum(a: f64, b: f64) -> Double {
    let hi = a + b;
    Double { hi, lo: b - (hi - a) }
}

/// High and low half of the digits.
fn split(a: f64) -> (f64, f64) {
    let c = 134_217_729.0 * a;
    let high = c - (c - a);
    (high, a - high)
}

fn two_product(a: f64, b: f64) -> Double {
    let hi = a * b;
    let ((a1, a2), (b1, b2)) = (split(a), split(b));
    Double { hi, lo: ((a1 * b1 - hi) + a1 * b2 + a2 * b1) + a2 * b2 }
}

impl Double {
    pub(super) const ZERO: Self = Self { hi: 0.0, lo: 0.0 };

    /// The nearest double.
    pub(super) fn near(self) -> f64 {
        self.hi
    }

    pub(super) fn is_negative(self) -> bool {
        self.hi < 0.0
    }
}

impl From<f64> for Double {
    fn from(hi: f64) -> Self {
        Self { hi, lo: 0.0 }
    }
}

impl Add for Double {
    type Output = Self;

    fn add(self, other: Self) -> Self {
        let (s, t) = (two_sum(self.hi, other.hi), two_sum(self.lo, other.lo));
        let s = quick_two_sum(s.hi, s.lo + t.hi);
        quick_two_sum(s.hi, s.lo + t.lo)
    }
}

impl AddAssign for Double {
    fn add_assign(&mut self, other: Self) {
        *self = *self + other;
    }
}

impl Neg for Double {
    type Output = Self;

    fn neg(self) -> Self {
        Self { hi: -self.hi, lo: -self.lo }
    }
}

impl Sub for Double {
    type Output = Self;

    fn sub(self, other: Self) -> Self {
        self + -other
    }
}

impl Mul for Double {
    type Output = Self;

    fn mul(self, other: Self) -> Self {
        let p = two_product(self.hi, other.hi);
        quick_two_sum(p.hi, p.lo + (self.hi * other.lo + self.lo * other.hi))
    }
}

impl Mul<f64> for Double {
    type Output = Self;

    fn mul(self, other: f64) -> Self {
        let p = two_product(self.hi, other);
        quick_two_sum(p.hi, p.lo + self.lo * other)
    }
}

impl Div for Double {
    type Output = Self;

    fn div(self, other: Self) -> Self {
        // Long division, a double of the quotient at a time.
        let first = self.hi / other.hi;
        let rest = self - other * first;
        let second = rest.hi / other.hi;
        let rest = rest - other * second;
        let sum = quick_two_sum(first, second);
        sum + Self::from(rest.hi / other.hi)
    }
}

#[cfg(test)]
mod tests {
    use super::Double;

    #[test]
    fn a_third_times_three_is_one_to_thirty_digits() {
        let third = Double::from(1.0) / Double::from(3.0);
        let off = third * 3.0 - Double::from(1.0);
        assert!(off.near().abs() < 1e-31, "{off:?}");
        let e = (1..30).rev().fold(Double::from(1.0), |sum, k| Double::from(1.0) + sum / Double::from(f64::from(k)));
        // e = 2.71828182845904523536028747135266249775724709369995…; the double nearest to it, and what that leaves.
        let rest = e - Double::from(std::f64::consts::E);
        assert!((rest.near() - 1.445_646_891_729_250_2e-16).abs() < 1e-30, "{rest:?}");
    }
}
