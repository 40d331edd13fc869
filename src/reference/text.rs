//! Numbers of verdicts for a reader: as many digits as say something, in the unit in which studies print them.

use serde::de::DeserializeOwned;

use crate::experiment::Parameter;
use crate::measure::{Measure, column_words};
use crate::text::number;

/// Digits with which numbers of a list are told apart at first, and at most.
const LIST_DIGITS: usize = 4;
pub(super) const MOST_DIGITS: usize = 10;

/// `x` to `digits` significant digits, trailing zeros dropped.
pub(crate) fn significant(x: f64, digits: usize) -> String {
    number::compact(x, digits)
}

/// A fraction as per cent: `2.9 %`.
pub(crate) fn percent(fraction: f64) -> String {
    format!("{} %", significant(100.0 * fraction, 2))
}

/// A fraction and its error as per cent: `−1.2 ± 3.4 %`.
pub(crate) fn percents(fraction: f64, error: f64) -> String {
    with_error(100.0 * fraction, 100.0 * error, "%")
}

/// A number and its error with their unit: `0.57 ± 0.33 mm/s`.
pub(crate) fn with_error(x: f64, error: f64, unit: &str) -> String {
    with_error_in_scale_of(x.abs().max(error), x, error, unit)
}

/// A number and its error with their unit, in thousandths where the largest of those that they stand beside is shorter so.
pub(crate) fn with_error_in_scale_of(largest: f64, x: f64, error: f64, unit: &str) -> String {
    let (factor, unit) = scale(largest, unit);
    let (value, error) = number::with_uncertainty(factor * x, factor * error);
    if unit.is_empty() { format!("{value} ± {error}") } else { format!("{value} ± {error} {unit}") }
}

/// A number with its unit; lengths, times and velocities in thousandths where that is shorter.
pub(crate) fn with_unit(x: f64, digits: usize, unit: &str) -> String {
    in_scale_of(x, x, digits, unit)
}

/// The parameter, or the measure, that a column holds.
pub(crate) fn known<K: DeserializeOwned>(column: &str) -> Option<K> {
    serde_json::from_value(serde_json::Value::String(column.into())).ok()
}

/// Where: `ω = 182.2 rad/s`.
pub(crate) fn place(column: &str, x: f64, digits: usize, unit: &str) -> String {
    format!("{} = {}", symbol(column), with_unit(x, digits, unit))
}

/// A number with its unit, in thousandths where the largest of those that it stands beside is shorter so.
pub(crate) fn in_scale_of(largest: f64, x: f64, digits: usize, unit: &str) -> String {
    let (factor, unit) = scale(largest, unit);
    let number = significant(x * factor, digits);
    if unit.is_empty() { number } else { format!("{number} {unit}") }
}

/// The unit in which numbers up to `largest` are shown, and its factor.
fn scale(largest: f64, unit: &str) -> (f64, &str) {
    match unit {
        "m/s" if largest.abs() < 2.0 => (1e3, "mm/s"),
        "m" if largest != 0.0 && largest.abs() < 1.0 => (1e3, "mm"),
        "s" if largest != 0.0 && largest.abs() < 1.0 => (1e3, "ms"),
        _ => (1.0, unit),
    }
}

/// Numbers with their units, each quantity in one unit, in so many digits that two that differ look different.
pub(crate) fn apart(values: &[(f64, &str)]) -> Vec<String> {
    let largest = |unit: &str| {
        values.iter().filter(|(_, of)| *of == unit).fold(0.0_f64, |most, (value, _)| most.max(value.abs()))
    };
    let texts = |digits: usize| -> Vec<String> {
        values.iter().map(|(value, unit)| in_scale_of(largest(unit), *value, digits, unit)).collect()
    };
    let clash = |texts: &[String]| {
        let pair = |i: usize, j: usize| texts[i] == texts[j] && values[i].0 != values[j].0;
        (0..texts.len()).any(|i| (0..i).any(|j| pair(i, j)))
    };
    (LIST_DIGITS..MOST_DIGITS).map(texts).find(|texts| !clash(texts)).unwrap_or_else(|| texts(MOST_DIGITS))
}

/// A column as formulas name it: `f′` for `force_ratio`; in words where it has no symbol.
pub(crate) fn symbol(column: &str) -> String {
    let parameter = known::<Parameter>(column).map(Parameter::symbol);
    let symbol = parameter.or_else(|| known::<Measure>(column).map(Measure::symbol)).unwrap_or_default();
    if symbol.is_empty() { column_words(column) } else { symbol.into() }
}
