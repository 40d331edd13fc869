//! Numbers taken out of tables, with their own errors.

use super::line::Position;
use super::text::apart;
use super::view::Cell;

/// A number taken out of a table.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Extracted {
    pub value: f64,
    /// Error of the run and of the grid.
    pub run: f64,
    /// Standard deviation of the ensemble where it was read.
    pub spread: f64,
    pub unit: String,
    /// What an agreement is measured against where zero is no natural origin, as with an instant: the time between two of
    /// its kind.
    pub scale: Option<f64>,
}

impl Extracted {
    pub(super) fn cell(cell: Cell, unit: &str) -> Self {
        Self { value: cell.value, run: cell.run, spread: cell.spread, unit: unit.into(), scale: None }
    }

    pub(super) fn place(position: Position, unit: String) -> Self {
        Self { value: position.x, run: position.u, spread: 0.0, unit, scale: None }
    }

    pub(super) fn exact(value: f64, unit: String) -> Self {
        Self { value, run: 0.0, spread: 0.0, unit, scale: None }
    }

    pub(super) fn times(self, factor: f64) -> Self {
        let size = factor.abs();
        Self {
            value: self.value * factor,
            run: self.run * size,
            spread: self.spread * size,
            unit: self.unit,
            scale: self.scale.map(|scale| scale * size),
        }
    }
}

/// As [`apart`], of numbers that were taken out of tables.
pub(crate) fn listed(values: &[Extracted]) -> Vec<String> {
    apart(&values.iter().map(|one| (one.value, one.unit.as_str())).collect::<Vec<_>>())
}
