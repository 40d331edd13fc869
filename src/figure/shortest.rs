//! Numbers in attributes of an SVG, and at the ends of an axis for machines.

/// A number to so many digits in the fewest letters that read back, `1500` or `9.608e-18`; `NaN` if it is none.
pub(super) fn shortest(number: f64, digits: usize) -> String {
    let rounded: f64 = format!("{number:.0$e}", digits.saturating_sub(1)).parse().unwrap_or(f64::NAN);
    let (plain, exponential) = (rounded.to_string(), format!("{rounded:e}"));
    if exponential.len() < plain.len() { exponential } else { plain }
}
