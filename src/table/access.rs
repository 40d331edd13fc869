//! Building a table and reading from it in memory.

use super::{Column, Data, Table};
use crate::text::name;

/// What is wrong with a table as such.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum TableError {
    /// Columns of different lengths.
    #[error("column `{column}` has {rows} rows where the columns before it have {expected}")]
    Ragged {
        /// Which column.
        column: String,
        /// Its rows.
        rows: usize,
        /// Rows of the first column.
        expected: usize,
    },
    /// Fingerprints that are not one a row.
    #[error("{fingerprints} fingerprints for {rows} rows")]
    Fingerprints {
        /// How many.
        fingerprints: usize,
        /// Rows of the table.
        rows: usize,
    },
    /// Two columns of one name.
    #[error("two columns are called `{0}`")]
    Twice(String),
}

impl Data {
    /// Number of cells.
    #[must_use]
    pub fn len(&self) -> usize {
        match self {
            Self::Float(cells) => cells.len(),
            Self::Int(cells) => cells.len(),
            Self::Text(cells) => cells.len(),
            Self::FloatList(cells) => cells.len(),
        }
    }

    /// The number in a row, if it holds one; counts come as floats.
    #[must_use]
    #[expect(clippy::cast_precision_loss, reason = "counts of events stay far below 2^53")]
    pub fn number(&self, row: usize) -> Option<f64> {
        match self {
            Self::Float(cells) => cells.get(row).copied(),
            Self::Int(cells) => cells.get(row).map(|&count| count as f64),
            Self::Text(_) | Self::FloatList(_) => None,
        }
    }

    /// True without cells.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// The cells of these rows, in this order.
    fn select(&self, rows: &[usize]) -> Self {
        fn pick<T: Clone>(cells: &[T], rows: &[usize]) -> Vec<T> {
            rows.iter().filter_map(|&row| cells.get(row).cloned()).collect()
        }
        match self {
            Self::Float(cells) => Self::Float(pick(cells, rows)),
            Self::Int(cells) => Self::Int(pick(cells, rows)),
            Self::Text(cells) => Self::Text(pick(cells, rows)),
            Self::FloatList(cells) => Self::FloatList(pick(cells, rows)),
        }
    }
}

impl Column {
    /// A column without unit or symbol.
    #[must_use]
    pub fn new(name: impl Into<String>, data: Data) -> Self {
        Self { name: name.into(), unit: String::new(), symbol: String::new(), data }
    }

    /// With the symbol of its unit, `m/s`.
    #[must_use]
    pub fn with_unit(mut self, unit: impl Into<String>) -> Self {
        self.unit = unit.into();
        self
    }

    /// With the symbol of the field, `ψ`.
    #[must_use]
    pub fn with_symbol(mut self, symbol: impl Into<String>) -> Self {
        self.symbol = symbol.into();
        self
    }
}

impl Table {
    /// Whether its numbers depend on an assumption; nothing where the metadata do not say.
    #[must_use]
    pub fn depends_on(&self, assumption: &str) -> Option<bool> {
        Some(self.metadata.get(super::DEPENDS_ON)?.split(", ").any(|name| name == assumption))
    }

    /// Appends a column.
    #[must_use]
    pub fn with(mut self, column: Column) -> Self {
        self.columns.push(column);
        self
    }

    /// Number of rows.
    #[must_use]
    pub fn rows(&self) -> usize {
        self.columns.first().map_or(0, |column| column.data.len())
    }

    /// The column of that name.
    #[must_use]
    pub fn column(&self, name: &str) -> Option<&Column> {
        self.columns.iter().find(|column| column.name == name)
    }

    /// The cells of a numeric column; counts come as floats.
    #[must_use]
    #[expect(clippy::cast_precision_loss, reason = "counts of events stay far below 2^53")]
    pub fn floats(&self, name: &str) -> Option<Vec<f64>> {
        match &self.column(name)?.data {
            Data::Float(cells) => Some(cells.clone()),
            Data::Int(cells) => Some(cells.iter().map(|&n| n as f64).collect()),
            Data::Text(_) | Data::FloatList(_) => None,
        }
    }

    /// The cells of a text column.
    #[must_use]
    pub fn texts(&self, name: &str) -> Option<&[String]> {
        match &self.column(name)?.data {
            Data::Text(cells) => Some(cells),
            _ => None,
        }
    }

    /// True if the momentum or energy of this row does not balance to within rounding.
    #[must_use]
    pub fn is_unbalanced(&self, row: usize) -> bool {
        match self.column(super::RESIDUAL_BOUND).map(|column| &column.data) {
            Some(Data::Float(bounds)) => bounds.get(row).is_some_and(|bound| !bound.is_nan()),
            _ => false,
        }
    }

    /// True if the run of this row has failed.
    #[must_use]
    pub fn has_failed(&self, row: usize) -> bool {
        self.texts(name::FAILURE).and_then(|reasons| reasons.get(row)).is_some_and(|reason| !reason.is_empty())
    }

    /// True if the run of any row has failed.
    #[must_use]
    pub fn has_failures(&self) -> bool {
        self.texts(name::FAILURE).is_some_and(|reasons| reasons.iter().any(|reason| !reason.is_empty()))
    }

    /// The time histories of a list column, one per row.
    #[must_use]
    pub fn lists(&self, name: &str) -> Option<&[Vec<f64>]> {
        match &self.column(name)?.data {
            Data::FloatList(cells) => Some(cells),
            _ => None,
        }
    }

    /// The rows in which a text column holds `text`; none if there is no such column.
    #[must_use]
    pub fn rows_where(&self, name: &str, text: &str) -> Vec<usize> {
        let cells = self.texts(name).unwrap_or_default();
        cells.iter().enumerate().filter(|(_, cell)| *cell == text).map(|(row, _)| row).collect()
    }

    /// These rows, in this order, as a table of their own.
    #[must_use]
    pub fn select(&self, rows: &[usize]) -> Self {
        let columns =
            self.columns.iter().map(|column| Column { data: column.data.select(rows), ..column.clone() }).collect();
        let fingerprints = rows.iter().filter_map(|&row| self.fingerprints.get(row).copied()).collect();
        Self { columns, metadata: self.metadata.clone(), fingerprints }
    }

    /// Whether no assumption is moved in a row; so in a table that knows none.
    pub(crate) fn is_baseline(&self, row: usize) -> bool {
        self.texts(name::VARIANT)
            .and_then(|variants| variants.get(row))
            .is_none_or(|variant| variant == super::BASELINE)
    }

    /// The rows computed with the assumptions as the file gives them; all of a table that knows none.
    #[must_use]
    pub fn baseline(&self) -> Self {
        let rows: Vec<usize> = (0..self.rows()).filter(|row| self.is_baseline(*row)).collect();
        self.select(&rows)
    }

    /// Checks that all columns have the same length and each its own name, and that fingerprints belong to rows.
    ///
    /// # Errors
    /// [`TableError`] that names the column.
    pub fn check(&self) -> Result<(), TableError> {
        for (index, column) in self.columns.iter().enumerate() {
            if column.data.len() != self.rows() {
                return Err(TableError::Ragged {
                    column: column.name.clone(),
                    rows: column.data.len(),
                    expected: self.rows(),
                });
            }
            if self.columns[..index].iter().any(|earlier| earlier.name == column.name) {
                return Err(TableError::Twice(column.name.clone()));
            }
        }
        let (fingerprints, rows) = (self.fingerprints.len(), self.rows());
        if ![0, rows].contains(&fingerprints) {
            return Err(TableError::Fingerprints { fingerprints, rows });
        }
        Ok(())
    }
}
