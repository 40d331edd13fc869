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

/// x − Σ aᵢ bᵢ, as if with twice the digits.
#[inline]
pub(crate) fn rest(x: f64, a: &[f64], b: &[f64]) -> f64 {
    let (mut high, mut low) = (x, 0.0);
    for (a, b) in a.iter().zip(b) {
        let [term, of_term] = product(-a, *b);
        let [next, of_sum] = sum(high, term);
        high = next;
        low += of_term + of_sum;
    }
    high + low
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
}
