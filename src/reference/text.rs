//! Numbers for a reader: significant digits, without the noise of doubles.

/// `x` to `digits` significant digits, trailing zeros dropped; an exponent only where zeros would pile up.
pub(crate) fn significant(x: f64, digits: usize) -> String {
    if x == 0.0 {
        return "0".into();
    }
    if !x.is_finite() {
        return if x.is_nan() { "NaN".into() } else { (if x > 0.0 { "infinite" } else { "-infinite" }).into() };
    }
    let scientific = format!("{x:.*e}", digits.max(1) - 1);
    let Some((mantissa, exponent)) = scientific.split_once('e') else { return scientific };
    let exponent: i32 = exponent.parse().unwrap_or(0);
    if !(-4..6).contains(&exponent) {
        return format!("{}e{exponent}", trim(mantissa));
    }
    let decimals = usize::try_from(i32::try_from(digits).unwrap_or(6) - 1 - exponent).unwrap_or(0);
    trim(&format!("{x:.decimals$}"))
}

/// A fraction as per cent: `2.9 %`.
pub(crate) fn percent(fraction: f64) -> String {
    format!("{} %", significant(100.0 * fraction, 2))
}

/// A number with its unit.
pub(crate) fn with_unit(x: f64, digits: usize, unit: &str) -> String {
    let number = significant(x, digits);
    if unit.is_empty() { number } else { format!("{number} {unit}") }
}

fn trim(number: &str) -> String {
    if number.contains('.') { number.trim_end_matches('0').trim_end_matches('.').into() } else { number.into() }
}
