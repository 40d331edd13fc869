//! Numbers as a study prints them: the digits say how well it knows them.
//!
//! Half a unit of the last printed digit is the uncertainty of the datum: `2.5` is 2.5 ± 0.05, `1.99e-1 s` is
//! 0.199 s ± 0.0005 s, `149` is 149 ± 0.5.

use serde::{Deserialize, Serialize};

use super::mapping::Reads;
use crate::measure::Measure;
use crate::yaml::At;

/// A number with its unit, as printed.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[serde(into = "String")]
pub struct Printed {
    text: String,
    value: f64,
    half_unit: f64,
    unit: String,
}

/// Why a text is not a printed number.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum PrintedError {
    /// Not a decimal number.
    #[error(
        "`{0}` is not a printed number: write digits as the study prints them, with a decimal point, and a unit: `427.3 mm/s`, `1.516`"
    )]
    NotANumber(String),
    /// Not among the known units.
    #[error("`{0}` is not a unit that published values use here: {1}")]
    UnknownUnit(String, String),
}

/// Units by dimension, with their factor to the first of the dimension.
const UNITS: [(&str, &[(&str, f64)]); 10] = [
    ("a length", &[("m", 1.0), ("mm", 1e-3), ("cm", 1e-2), ("µm", 1e-6)]),
    ("a velocity", &[("m/s", 1.0), ("mm/s", 1e-3)]),
    ("a time", &[("s", 1.0), ("ms", 1e-3)]),
    ("a frequency", &[("Hz", 1.0), ("rad/s", 1.0 / std::f64::consts::TAU)]),
    ("a force", &[("N", 1.0), ("kN", 1e3)]),
    ("an impulse", &[("N s", 1.0)]),
    ("an angle", &[("rad", 1.0)]),
    ("an acceleration", &[("m/s²", 1.0), ("g", 9.81)]),
    ("a receptance", &[("m/N", 1.0), ("mm/N", 1e-3), ("µm/N", 1e-6)]),
    ("dimensionless", &[("", 1.0)]),
];

/// Every unit that a number may be printed in, of measures too.
pub(super) fn symbols() -> Vec<&'static str> {
    let mut known = Vec::new();
    let of_kinds = UNITS.iter().flat_map(|(_, units)| units.iter().map(|(symbol, _)| *symbol));
    for symbol in of_kinds.chain(Measure::ALL.iter().map(|measure| measure.unit())) {
        if !symbol.is_empty() && !known.contains(&symbol) {
            known.push(symbol);
        }
    }
    known
}

fn unit(symbol: &str) -> Option<(&'static str, f64)> {
    UNITS.iter().find_map(|(dimension, units)| {
        units.iter().find(|(known, _)| *known == symbol).map(|(_, factor)| (*dimension, *factor))
    })
}

/// The unit in which a number is published, and what one of it is in the unit of its column: 0.001 of mm/s beside m/s.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct PrintedUnit {
    /// Empty if the number is dimensionless.
    pub symbol: String,
    /// One of it.
    pub worth: f64,
}

impl Default for PrintedUnit {
    fn default() -> Self {
        Self { symbol: String::new(), worth: 1.0 }
    }
}

/// Units in which a number may be printed that is compared with one in `symbol`.
pub(super) fn units_beside(symbol: &str) -> Vec<&str> {
    let of_kind = UNITS.iter().find(|(_, units)| units.iter().any(|(known, _)| *known == symbol));
    of_kind.map_or_else(|| vec![symbol], |(_, units)| units.iter().map(|(known, _)| *known).collect())
}

impl Reads for Printed {}

impl Printed {
    pub(crate) fn read(at: At<'_>) -> Option<Self> {
        let text = at.text()?;
        Self::parse(&text).map_err(|error| at.wrong::<()>(error.to_string())).ok()
    }

    /// Reads a number as printed, `427.3 mm/s`.
    ///
    /// # Errors
    /// If it is no decimal number or its unit is unknown.
    pub fn parse(text: &str) -> Result<Self, PrintedError> {
        let text = text.trim();
        let (number, symbol) = text.split_once(' ').map_or((text, ""), |(number, symbol)| (number, symbol.trim()));
        let wrong = || PrintedError::NotANumber(text.into());
        if !number.starts_with(|c: char| c.is_ascii_digit() || c == '-') {
            return Err(wrong());
        }
        let (mantissa, exponent) = match number.split_once(['e', 'E']) {
            Some((mantissa, exponent)) => (mantissa, exponent.parse::<i32>().map_err(|_| wrong())?),
            None => (number, 0),
        };
        let decimals = mantissa.split_once('.').map_or(0, |(_, decimals)| decimals.len());
        let decimals = i32::try_from(decimals).map_err(|_| wrong())?;
        let value: f64 = number.parse().map_err(|_| wrong())?;
        // Through the decimal parser, so that 5e-4 is the double nearest to 5e-4.
        let half_unit: f64 =
            format!("5e{}", exponent.saturating_sub(decimals).saturating_sub(1)).parse().map_err(|_| wrong())?;
        if !value.is_finite() || !half_unit.is_finite() || half_unit == 0.0 {
            return Err(wrong());
        }
        // What a measure is counted in can be printed, too, as it stands.
        let of_a_measure = || Measure::ALL.iter().any(|measure| measure.unit() == symbol);
        if unit(symbol).is_none() && !of_a_measure() {
            return Err(PrintedError::UnknownUnit(symbol.into(), symbols().join(", ")));
        }
        Ok(Self { text: text.into(), value, half_unit, unit: symbol.into() })
    }

    /// The number, in its own unit.
    #[must_use]
    pub fn value(&self) -> f64 {
        self.value
    }

    /// u_D: half a unit of the last printed digit, in the number's own unit.
    #[must_use]
    pub fn half_unit(&self) -> f64 {
        self.half_unit
    }

    /// Its unit, as printed; empty if it is dimensionless.
    #[must_use]
    pub fn unit(&self) -> &str {
        &self.unit
    }

    /// As printed.
    #[must_use]
    pub fn text(&self) -> &str {
        &self.text
    }

    /// That it is of another kind than numbers in `unit`.
    pub(super) fn unlike(&self, unit: &str) -> String {
        let column = match unit {
            "" => "a column without unit".into(),
            unit => format!("a column in `{unit}`"),
        };
        format!("`{}` cannot be held against {column}", self.text)
    }

    /// Value and u_D in another unit of the same dimension; `None` if it is of another dimension.
    #[must_use]
    pub fn converted_to(&self, symbol: &str) -> Option<(f64, f64)> {
        if self.unit == symbol {
            return Some((self.value, self.half_unit));
        }
        let ((own, from), (other, to)) = (unit(&self.unit)?, unit(symbol)?);
        let factor = from / to;
        (own == other).then_some((self.value * factor, self.half_unit * factor))
    }
}

impl From<Printed> for String {
    fn from(printed: Printed) -> Self {
        printed.text
    }
}
