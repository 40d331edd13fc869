//! Sums and products that keep what rounding takes off them, in plain arithmetic: the same bits on every processor.
//!
//! a + b = s + e and a b = p + e hold exactly, with s and p as the processor rounds them (Knuth 1969; Veltkamp and Dekker,
//! Numer. Math. 18, 1971). A sum of products that carries all e is as good as one of twice the digits (Ogita, Rump & Oishi,
//! SIAM J. Sci. Comput. 26, 2005).

/// 2²⁷ + 1: cuts a number into two of half its digits.
const CUT: f64 = 134_217_729.0;

/// a + b and what rounding takes off it.
#[inline]
fn sum(a: f64, b: f64) -> [f64; 2] {
    let sum = a + b;
    let part = sum - a;
    [sum, (a - (sum - part)) + (b - part)]
}

/// Two halves that add up to x.
#[inline]
fn halves(x: f64) -> [f64; 2] {
    let cut = CUT * x;
    let high = cut - (cut - x);
    [high, x - high]
}

/// a b and what rounding takes off it.
#[inline]
fn product(a: f64, b: f64) -> [f64; 2] {
    let product = a * b;
    let ([a1, a0], [b1, b0]) = (halves(a), halves(b));
    [product, (((a1 * b1 - product) + a1 * b0) + a0 * b1) + a0 * b0]
}

/// A number of twice the digits: what `high` does not hold is in `low`.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(crate) struct Twice {
    pub(crate) high: f64,
    pub(crate) low: f64,
}

impl Twice {
    #[inline]
    pub(crate) fn of(x: f64) -> Self {
        Self { high: x, low: 0.0 }
    }

    /// Adds a number.
    #[inline]
    pub(crate) fn add(&mut self, x: f64) {
        let [next, of_sum] = sum(self.high, x);
        self.high = next;
        self.low += of_sum;
    }

    /// Adds a product of two numbers.
    #[inline]
    pub(crate) fn add_product(&mut self, a: f64, b: f64) {
        let [term, of_term] = product(a, b);
        let [next, of_sum] = sum(self.high, term);
        self.high = next;
        self.low += of_term + of_sum;
    }

    /// Adds a product with one of these.
    #[inline]
    pub(crate) fn add_times(&mut self, a: f64, b: Self) {
        self.add_product(a, b.high);
        self.low += a * b.low;
    }

    /// The same number, with as much as there is room for in `high`.
    #[inline]
    pub(crate) fn settled(self) -> Self {
        let [high, low] = sum(self.high, self.low);
        Self { high, low }
    }

    /// The number next to it.
    #[inline]
    pub(crate) fn rounded(self) -> f64 {
        self.high + self.low
    }
}

/// x − Σ aᵢ bᵢ, as if with twice the digits.
#[inline]
pub(crate) fn rest(x: f64, a: &[f64], b: &[f64]) -> f64 {
    let mut rest = Twice::of(x);
    a.iter().zip(b).for_each(|(a, b)| rest.add_product(-a, *b));
    rest.rounded()
}

/// (c x + s y, c y − s x) over √(c² + s²), for c² + s² = 1 as near as one number each can make it: a turn that keeps x² + y².
#[inline]
pub(crate) fn turned([c, s]: [f64; 2], [x, y]: [Twice; 2]) -> [Twice; 2] {
    let share = 0.5 * rest(1.0, &[c, s], &[c, s]);
    let sum = |a: f64, x: Twice, b: f64, y: Twice| {
        let mut sum = Twice::default();
        sum.add_times(a, x);
        sum.add_times(b, y);
        sum.low += share * sum.high;
        sum.settled()
    };
    [sum(c, x, s, y), sum(c, y, -s, x)]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn nothing_is_left_of_a_sum_that_cancels() {
        // (1 + s)² = 1 + 2 s + s² with s = 2⁻³⁰, of which a product keeps no 2⁻⁶⁰.
        let small = 1.0 / f64::from(1_u32 << 30);
        assert_eq!(rest(1.0 + 2.0 * small, &[1.0 + small], &[1.0 + small]), -(small * small));
        assert_eq!(rest(1e17, &[1e17, 3.0], &[1.0, 1.0]), -3.0);
        assert_eq!(rest(1.0, &[1e16, -1e16, 1.0], &[1.0, 1.0, 1.0]), 0.0);
    }

    #[test]
    fn a_turn_by_rounded_numbers_keeps_the_length() {
        let square = |[x, y]: [Twice; 2]| {
            let mut sum = Twice::of(-1.0);
            for part in [x, y] {
                sum.add_times(part.high, part);
                sum.low += part.low * part.high;
            }
            sum.rounded()
        };
        let (sine, cosine) = crate::arithmetic::elementary::sin_cos(0.7);
        let mut point = [Twice::of(0.6), Twice::of(0.8)];
        let begin = square(point);
        for _ in 0..1000 {
            point = turned([cosine, sine], point);
        }
        assert!((square(point) - begin).abs() < 1e-28, "{:e}", square(point) - begin);
    }
}
