//! Tables: what an experiment leaves behind, and all that figures, verdicts and reports read.
//!
//! One row is one case: a sweep point, under one solver, in one variant of the assumptions. Time histories are
//! list-valued cells of the same row, so that an experiment is one table and one file.

mod access;
mod fingerprint;
pub mod parquet;

use std::collections::BTreeMap;

pub use access::TableError;
pub use fingerprint::RowFingerprint;
pub use parquet::ParquetError;

/// The `variant` of a row computed with the assumptions as the file gives them.
pub const BASELINE: &str = "baseline";

/// The key of [`Table::metadata`] that names the assumptions which the numbers depend on, with commas between them.
pub const DEPENDS_ON: &str = "assumptions";

/// The column of the bound that the residuals of a row exceed, NaN in rows that balance; there only if some row does not.
pub const RESIDUAL_BOUND: &str = "residual_bound";

/// The column that says which numbers of a row are undefined, and why; there only if some are.
pub const UNDEFINED: &str = "undefined";

/// The column that says what runs beside a row's own were to say of it and did not, and why; there only if some did not.
pub const UNKNOWN: &str = "unknown";

/// A named column with its unit (empty for dimensionless and text).
#[derive(Debug, Clone, PartialEq)]
pub struct Column {
    /// Name in snake case, the same word as in the YAML: `velocity_ratio`, `force_ratio`.
    pub name: String,
    /// Unit symbol: `m/s`, `mm`; empty when dimensionless.
    pub unit: String,
    /// The symbol of the field, for axes: `ψ`, `f′`; empty if it has none.
    pub symbol: String,
    /// The cells.
    pub data: Data,
}

/// The cells of a column, one per row.
#[derive(Debug, Clone, PartialEq)]
pub enum Data {
    /// Numbers; NaN marks a cell that could not be computed.
    Float(Vec<f64>),
    /// Counts.
    Int(Vec<i64>),
    /// Labels: solver, variant, the levels of a sweep such as `with` and `without`.
    Text(Vec<String>),
    /// One time history per row; all list columns of a row have the same length.
    FloatList(Vec<Vec<f64>>),
}

/// A table in memory; [`Table::metadata`] travels in the file's key-value metadata.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Table {
    /// Columns in the order in which they are stored.
    pub columns: Vec<Column>,
    /// Provenance: experiment, fingerprint, solver version, source. No time stamp, host or path.
    pub metadata: BTreeMap<String, String>,
    /// What each row was computed from; empty where that is not known row by row.
    pub fingerprints: Vec<RowFingerprint>,
}
