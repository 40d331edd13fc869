//! What a place of a scene takes, and of what kind an assumption is that may stand there.

use serde::{Deserialize, Serialize};

use crate::yaml::Dimension;

/// What kind of value an assumption has: a quantity, one of named readings, or either.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct AssumptionKind {
    /// What its numbers are; none for readings alone.
    pub quantity: Option<Quantity>,
    /// Its readings.
    pub readings: Vec<String>,
}

/// What a number, or a curve, is.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Quantity {
    /// Dimensionless, zero or more.
    Ratio,
    /// A whole number, one or more.
    Count,
    /// A damping curve.
    #[serde(rename = "damping_curve")]
    Curve,
    /// One place or several, as shares of the sides.
    Places,
    /// Of this dimension.
    #[serde(untagged)]
    Of(Dimension),
}

/// What a place of a scene takes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Takes<'a> {
    /// Numbers, or a curve.
    pub quantity: Option<Quantity>,
    /// Readings.
    pub readings: &'a [&'a str],
}

impl Takes<'_> {
    /// Of this dimension.
    #[must_use]
    pub fn quantity(dimension: Dimension) -> Self {
        Self { quantity: Some(Quantity::Of(dimension)), readings: &[] }
    }

    /// Dimensionless.
    #[must_use]
    pub fn ratio() -> Self {
        Self { quantity: Some(Quantity::Ratio), readings: &[] }
    }

    /// A number of things.
    #[must_use]
    pub fn count() -> Self {
        Self { quantity: Some(Quantity::Count), readings: &[] }
    }

    /// Every value of the kind has a meaning here.
    #[must_use]
    pub fn admits(self, kind: &AssumptionKind) -> bool {
        (kind.quantity.is_none() || kind.quantity == self.quantity)
            && kind.readings.iter().all(|reading| self.readings.contains(&reading.as_str()))
    }

    /// In words: `a length`, `one of clean, loaded`.
    #[must_use]
    pub fn words(self) -> String {
        in_words(self.quantity, self.readings)
    }
}

impl AssumptionKind {
    /// In words.
    #[must_use]
    pub fn words(&self) -> String {
        let readings: Vec<&str> = self.readings.iter().map(String::as_str).collect();
        in_words(self.quantity, &readings)
    }

    /// Unit symbol of its numbers, empty when dimensionless.
    #[must_use]
    pub fn unit(&self) -> &'static str {
        match self.quantity {
            Some(Quantity::Of(dimension)) => dimension.unit(),
            Some(Quantity::Curve) => Dimension::Damping.unit(),
            Some(Quantity::Ratio | Quantity::Count | Quantity::Places) | None => "",
        }
    }
}

fn in_words(quantity: Option<Quantity>, readings: &[&str]) -> String {
    let quantity = quantity.map(|quantity| match quantity {
        Quantity::Of(dimension) => dimension.name(),
        Quantity::Ratio => "a dimensionless number",
        Quantity::Count => "a whole number",
        Quantity::Curve => "a damping curve",
        Quantity::Places => "a list of places",
    });
    let readings = if readings.is_empty() { None } else { Some(format!("one of {}", readings.join(", "))) };
    match (quantity, readings) {
        (Some(quantity), Some(readings)) => format!("{quantity} or {readings}"),
        (Some(quantity), None) => quantity.into(),
        (None, readings) => readings.unwrap_or_default(),
    }
}
