//! Polynomials by their terms, and sine and cosine by their series.

use super::double::Double;

/// Terms in the place of t/span.
pub(super) fn scaled(terms: &[Double], span: f64) -> Vec<Double> {
    let mut power = Double::from(1.0);
    terms
        .iter()
        .map(|term| {
            let scaled = *term * power;
            power = power * span;
            scaled
        })
        .collect()
}

/// ∫₀¹ of the square.
pub(super) fn square(a: &[Double]) -> Double {
    let mut sum = Double::ZERO;
    for i in 0..a.len() {
        for j in i..a.len() {
            let product = a[i] * a[j];
            // What is below the last digit of the sum is left out.
            if product.near().abs() < 1e-34 * sum.near().abs() {
                continue;
            }
            let twice = if i == j { 1.0 } else { 2.0 };
            sum += product * twice / Double::from((i + j + 1) as f64);
        }
    }
    sum
}

/// By their series, at half angles of a few steps back.
pub(super) fn sin_cos(angle: Double) -> [Double; 2] {
    const HALVINGS: i32 = 6;
    let small = angle * libm::ldexp(1.0, -HALVINGS);
    let (mut sine, mut cosine) = (Double::ZERO, Double::ZERO);
    let mut term = Double::from(1.0);
    for k in 0..24_i32 {
        match k % 4 {
            0 => cosine += term,
            1 => sine += term,
            2 => cosine = cosine - term,
            _ => sine = sine - term,
        }
        term = term * small / Double::from(f64::from(k + 1));
    }
    for _ in 0..HALVINGS {
        (sine, cosine) = (sine * cosine * 2.0, cosine * cosine - sine * sine);
    }
    [sine, cosine]
}
