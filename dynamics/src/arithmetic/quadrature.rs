//! Gauss-Legendre rules: ∫f over [−1, 1] by n values of f, exact for polynomials up to the degree 2n − 1.
//!
//! The nodes are the zeros of the Legendre polynomial Pₙ, which all are real. From beyond them Newton's method comes down to the
//! largest, and to the next one once those that are known are divided out.

/// Nodes x > 0 and weights of the rule of 2 `N` points; −x has the same weight as x.
pub(crate) const fn half<const N: usize>() -> [[f64; 2]; N] {
    let mut rule = [[0.0; 2]; N];
    let mut known = 0;
    while known < N {
        let mut x = 1.01;
        let mut step = 0;
        while step < 64 {
            let [p, slope] = legendre(2 * N, x);
            let (mut others, mut i) = (0.0, 0);
            // The last steps are those of Pₙ itself, free of what the others have rounded.
            while i < known && step < 60 {
                others += 1.0 / (x - rule[i][0]);
                i += 1;
            }
            x -= p / (slope - p * others);
            step += 1;
        }
        let [_, slope] = legendre(2 * N, x);
        rule[known] = [x, 2.0 / ((1.0 - x) * (1.0 + x) * slope * slope)];
        known += 1;
    }
    rule
}

/// Pₙ and its derivative, at an x that is not 1.
const fn legendre(n: usize, x: f64) -> [f64; 2] {
    let (mut before, mut p, mut k) = (0.0, 1.0, 0);
    while k < n {
        let j = k as f64;
        (before, p) = (p, ((2.0 * j + 1.0) * x * p - j * before) / (j + 1.0));
        k += 1;
    }
    [p, n as f64 * (before - x * p) / ((1.0 - x) * (1.0 + x))]
}

/// Nodes and weights of the ten-point rule on [0, 1].
pub(crate) const TEN: [[f64; 2]; 10] = {
    let (half, mut rule, mut i) = (half::<5>(), [[0.0; 2]; 10], 0);
    while i < 5 {
        let [x, weight] = half[i];
        rule[2 * i] = [0.5 - 0.5 * x, 0.5 * weight];
        rule[2 * i + 1] = [0.5 + 0.5 * x, 0.5 * weight];
        i += 1;
    }
    rule
};

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_rule_of_n_points_integrates_even_powers_up_to_2n_to_rounding() {
        fn check<const N: usize>() {
            for power in (0..4 * N).step_by(2) {
                let term = |[x, weight]: [f64; 2]| (0..power).fold(2.0 * weight, |term, _| term * x);
                let sum: f64 = half::<N>().into_iter().map(term).sum();
                let exact = 2.0 / (power as f64 + 1.0);
                assert!((sum - exact).abs() < 1e-15, "{N} {power}: {sum} for {exact}");
            }
        }
        check::<4>();
        check::<5>();
        check::<8>();
        check::<12>();
    }
}
