//! Polynomials on [0, 1], of windows to the eleventh degree and of cells to the seventh: values, Bernstein coefficients, roots; and the nearest
//! root of an expansion to the seventh order.

use crate::arithmetic::four::Four;

/// Degree of the window polynomials: twelve coefficients, which fill whole vector registers.
pub(crate) const DEGREE: usize = 11;

/// Coefficients in powers of σ, or Bernstein coefficients.
pub(crate) type Coefficients = [f64; DEGREE + 1];

/// Value and slope at x of Σ aⱼ xʲ, by Estrin's scheme on four at a time.
#[inline]
pub(crate) fn evaluate<const N: usize>(a: &[f64; N], x: f64) -> (f64, f64) {
    let (x2, x4) = (x * x, (x * x) * (x * x));
    let four = |i: usize| (a[i] + a[i + 1] * x) + (a[i + 2] + a[i + 3] * x) * x2;
    let pair = |j: usize| j as f64 * a[j] + (j + 1) as f64 * a[j + 1] * x;
    let mut i = N - 4;
    let (mut value, mut slope) = (four(i), pair(i + 1) + (i + 3) as f64 * a[i + 3] * x2);
    while i > 0 {
        i -= 4;
        value = four(i) + x4 * value;
        slope = (pair(i + 1) + pair(i + 3) * x2) + x4 * slope;
    }
    (value, slope)
}

/// Bernstein coefficients on [0, 1] of Σ aⱼ xʲ: bᵢ = Σ_{j≤i} C(i, j)/C(n, j) aⱼ, by repeated sums.
#[inline(always)]
pub(crate) fn bernstein(a: &Coefficients) -> Coefficients {
    let mut b = [0.0; DEGREE + 1];
    for j in 0..DEGREE + 1 {
        b[j] = a[j] * INVERSE_BINOMIAL[j];
    }
    // Eleven rounds of known length each, so that the compiler keeps them in registers.
    sums::<0>(&mut b);
    sums::<1>(&mut b);
    sums::<2>(&mut b);
    sums::<3>(&mut b);
    sums::<4>(&mut b);
    sums::<5>(&mut b);
    sums::<6>(&mut b);
    sums::<7>(&mut b);
    sums::<8>(&mut b);
    sums::<9>(&mut b);
    sums::<10>(&mut b);
    b
}

/// Bernstein coefficients on [0, x] and on [x, 1], by de Casteljau's averages.
#[inline]
pub(crate) fn cut<const N: usize>(b: &[f64; N], x: f64) -> [[f64; N]; 2] {
    let (mut left, mut right) = (*b, *b);
    for round in 0..N {
        left[round] = right[0];
        for i in 0..N - 1 - round {
            right[i] = (1.0 - x) * right[i] + x * right[i + 1];
        }
    }
    [left, right]
}

#[inline(always)]
fn sums<const ROUND: usize>(b: &mut Coefficients) {
    let mut i = DEGREE;
    while i > ROUND {
        b[i] += b[i - 1];
        i -= 1;
    }
}

/// 1/C(n, j).
const INVERSE_BINOMIAL: Coefficients = {
    let mut table = [0.0; DEGREE + 1];
    let mut binomial = 1.0;
    let mut j = 0;
    while j <= DEGREE {
        table[j] = 1.0 / binomial;
        binomial = binomial * (DEGREE - j) as f64 / (j + 1) as f64;
        j += 1;
    }
    table
};

/// Newton's method stops at a step below this share of the root: the next would be its square, so that three digits or so are known.
pub(crate) const THREE_DIGITS: f64 = 0.03;

/// The root below `high` by Newton steps from `x`, until one moves by no more than `share` of it. Gives with it the slope before the last
/// step, and that step.
#[inline(always)]
pub(crate) fn root(evaluate: impl Fn(f64) -> (f64, f64), mut x: f64, high: f64, share: f64) -> (f64, f64, f64) {
    let (mut lower, mut upper) = (0.0, high);
    let mut last = (x, f64::NAN, f64::INFINITY);
    for _ in 0..60 {
        let (value, slope) = evaluate(x);
        if value > 0.0 {
            lower = x
        } else {
            upper = x
        }
        let mut next = x - value / slope;
        if !(next >= lower && next <= upper) {
            next = 0.5 * (lower + upper);
        }
        let step = (next - x).abs();
        x = next;
        last = (x, slope, step);
        if step <= share * x {
            break;
        }
    }
    last
}

/// Whether a polynomial may fall and rise again: by Descartes' rule for its slope not if its coefficients rise up to one and fall from
/// there on.
#[inline(always)]
pub(crate) fn may_turn<const N: usize>(b: &[f64; N]) -> bool {
    let steps: [f64; N] = std::array::from_fn(|i| if i + 1 < N { b[i + 1] - b[i] } else { f64::NEG_INFINITY });
    !Signs::of(&steps, 0.0).positive_then_negative()
}

/// Whether σ^`order` p has a slope that is positive, then negative: but for a power of σ that is order p + σ p′, p with each coefficient
/// times its power.
#[inline(always)]
pub(crate) fn rises_then_falls<const N: usize>(b: &[f64; N], order: usize) -> bool {
    let slope: [f64; N] = std::array::from_fn(|i| order as f64 * b[i] + i as f64 * (b[i] - b[i.saturating_sub(1)]));
    Signs::of(&slope, 0.0).positive_then_negative()
}

/// Which Bernstein coefficients are surely positive, and which surely negative: one bit each, the first the lowest.
#[derive(Clone, Copy)]
pub(crate) struct Signs<const N: usize> {
    pub(crate) positive: u64,
    negative: u64,
}

impl<const N: usize> Signs<N> {
    const ALL: u64 = (1 << N) - 1;

    #[inline(always)]
    pub(crate) fn of(b: &[f64; N], doubt: f64) -> Self {
        // Their bits are summed up as numbers, several at a time; those of 2⁵² + n end in those of n.
        const MANY: f64 = (1_u64 << 52) as f64;
        let behind = (1 << N) as f64;
        let (mut sum, mut bits) = (Four::ZERO, Four::new([1.0, 2.0, 4.0, 8.0]));
        for b in b.as_chunks().0 {
            let positive = Four::new(*b).zip(bits, |b, bit| if b > doubt { bit } else { 0.0 });
            let negative = Four::new(*b).zip(bits * behind, |b, bit| if b < -doubt { bit } else { 0.0 });
            (sum, bits) = (sum + positive + negative, bits * 16.0);
        }
        let both = (sum.sum() + MANY).to_bits();
        Self { positive: both & Self::ALL, negative: both >> N & Self::ALL }
    }

    #[inline(always)]
    pub(crate) fn are_all_positive(self) -> bool {
        self.positive == Self::ALL
    }

    #[inline(always)]
    pub(crate) fn begin_positive(self) -> bool {
        self.positive & 1 == 1
    }

    /// Positive, then doubtful, then negative; any of them may be missing.
    #[inline(always)]
    pub(crate) fn positive_then_negative(self) -> bool {
        come_first(self.positive) && come_first(Self::ALL & !self.negative)
    }

    /// The same with both ends.
    #[inline(always)]
    pub(crate) fn change_once(self) -> bool {
        self.positive != 0 && self.negative != 0 && self.positive_then_negative()
    }

    /// Where the control polygon falls to `level`, behind the coefficients that are surely positive.
    #[inline(always)]
    pub(crate) fn crossing(self, b: &[f64; N], level: f64) -> f64 {
        let first = self.positive.trailing_ones() as usize;
        let (before, after) = (b[first - 1], b[first]);
        ((first - 1) as f64 + (before - level) / (before - after)).min(first as f64) * const { 1.0 / (N - 1) as f64 }
    }
}

/// The coefficients of these bits are the first ones, or none.
#[inline(always)]
pub(crate) fn come_first(bits: u64) -> bool {
    bits & (bits + 1) == 0
}

/// The root of smallest modulus of a polynomial whose constant is small; NaN if that does not settle.
///
/// x = −a₀/a₁ − x² (a₂ + a₃ x + …)/a₁ by iteration: one division, and each round gains as many digits as x is small.
#[inline]
pub(crate) fn nearest_root(a: &[f64; 8]) -> f64 {
    let inverse = 1.0 / a[1];
    let first = -a[0] * inverse;
    // The reversed series to the fourth power, then as often as it takes.
    let (u, w) = (a[2] * inverse * first, a[3] * inverse * (first * first));
    let mut x =
        first * ((1.0 - u) + (2.0 * u * u - w) + (5.0 * u * (w - u * u) - a[4] * inverse * (first * first * first)));
    for _ in 0..20 {
        let x2 = x * x;
        let rest = (a[2] + a[3] * x) + x2 * ((a[4] + a[5] * x) + x2 * (a[6] + a[7] * x));
        let next = first - x2 * (rest * inverse);
        let step = (next - x).abs();
        x = next;
        if step <= 1e-17 + 4.0 * f64::EPSILON * x.abs() {
            return x;
        }
    }
    newton_root(a, first)
}

/// The same by Newton's method, where the curvature is too strong for the iteration.
#[cold]
fn newton_root(a: &[f64; 8], guess: f64) -> f64 {
    let mut x = guess;
    for _ in 0..20 {
        let (value, slope) = a.iter().rev().fold((0.0, 0.0), |(value, slope), a| (value * x + a, slope * x + value));
        let step = value / slope;
        x -= step;
        // Quadratic convergence: what is left is the square of this.
        if step.abs() <= 1e-6 * x.abs() {
            return x;
        }
    }
    f64::NAN
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bernstein_coefficients_enclose_the_polynomial() {
        let a = [0.3, -1.2, 0.7, 0.25, -0.1, 0.05, 0.02, -0.01, 0.004, 0.3, -0.2, 0.1];
        let b = bernstein(&a);
        assert!((b[0] - a[0]).abs() < 1e-16 && (b[DEGREE] - a.iter().sum::<f64>()).abs() < 1e-15);
        for i in 0..=20 {
            let x = f64::from(i) / 20.0;
            let y = a.iter().rev().fold(0.0, |sum, a| sum * x + a);
            assert!(y >= b.iter().copied().fold(f64::INFINITY, f64::min) - 1e-15);
            assert!(y <= b.iter().copied().fold(f64::NEG_INFINITY, f64::max) + 1e-15);
        }
    }
}
