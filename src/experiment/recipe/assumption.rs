//! The name of an assumption, and its value.

use std::sync::Arc;

use serde::{Deserialize, Serialize};

use crate::scene::Curve;

/// The name of an assumption, as the assumptions file declares it.
#[derive(Debug, Clone, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[serde(into = "String", from = "String")]
pub struct AssumptionName(Arc<str>);

impl AssumptionName {
    /// The word in YAML, in tables and in reports.
    #[must_use]
    pub fn as_str(&self) -> &str {
        &self.0
    }
}

impl From<String> for AssumptionName {
    fn from(name: String) -> Self {
        Self(name.into())
    }
}

impl From<&str> for AssumptionName {
    fn from(name: &str) -> Self {
        Self(name.into())
    }
}

impl From<AssumptionName> for String {
    fn from(name: AssumptionName) -> Self {
        name.0.as_ref().into()
    }
}

impl std::fmt::Display for AssumptionName {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(&self.0)
    }
}

/// The value of one assumption.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum AssumptionValue {
    /// A number, SI or dimensionless.
    Number(f64),
    /// One of named readings of the source.
    Choice(String),
    /// A curve through points.
    Curve(Curve),
    /// Places, each of one coordinate a side, as shares of the sides.
    Places(Vec<Vec<f64>>),
}
