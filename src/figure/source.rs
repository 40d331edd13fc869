//! What curves are read out of: the table behind a figure.

use std::collections::BTreeMap;

use super::error::FigureError;
use super::label;
use crate::experiment::{Axis, Experiment, LineColour, Panel};
use crate::table::{Column, Table};

/// The table behind a figure, asked for columns by name.
#[derive(Clone, Copy)]
pub(super) struct Source<'a> {
    /// Whose table it is.
    pub experiment: Option<&'a Experiment>,
    /// Only the rows to draw.
    pub table: &'a Table,
    /// What the figure is called in messages.
    pub figure: &'a str,
    /// Colours of lines by name, as the study has them.
    pub colours: Option<&'a BTreeMap<String, LineColour>>,
    /// All panels of the figure: what shows in one of them looks the same in the others.
    pub panels: &'a [Panel],
}

impl<'a> Source<'a> {
    /// The column of that name.
    pub(super) fn column(&self, name: &str) -> Result<&'a Column, FigureError> {
        self.table.column(name).ok_or_else(|| FigureError::UnknownColumn {
            figure: self.figure.to_owned(),
            column: name.to_owned(),
            known: self.table.columns.iter().map(|column| column.name.as_str()).collect::<Vec<_>>().join(", "),
        })
    }

    /// The name of a y column in legends and at axes.
    pub(super) fn label(&self, axis: &Axis) -> Result<String, FigureError> {
        let column = self.column(&axis.column)?;
        Ok(axis.label.clone().unwrap_or_else(|| label::of_column(self.experiment, column)))
    }
}
