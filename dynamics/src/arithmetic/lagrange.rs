//! The polynomial through a few points, by Lagrange's formula.

/// Lagrange's weights of values at some places, for that at another.
pub(crate) fn weights(places: &[f64], at: f64) -> Vec<f64> {
    let weight = |i: usize| {
        let others = places.iter().enumerate().filter(|(k, _)| *k != i);
        others.fold(1.0, |weight, (_, other)| weight * (at - other) / (places[i] - other))
    };
    (0..places.len()).map(weight).collect()
}

/// The sum of values by their weights.
pub(crate) fn combined(weights: &[f64], values: impl IntoIterator<Item = f64>) -> f64 {
    weights.iter().zip(values).fold(0.0, |sum, (weight, value)| sum + weight * value)
}
