//! Why there is no figure.

pub use super::raster::RasterError;

/// Why a figure cannot be drawn.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum FigureError {
    /// The figure names a column that the table lacks.
    #[error("figure {figure} draws `{column}`, which the table does not have; it has {known}")]
    UnknownColumn {
        /// Which figure.
        figure: String,
        /// The column it names.
        column: String,
        /// The table's columns.
        known: String,
    },
    /// The figure draws a column of text.
    #[error("figure {figure} draws `{column}`, which holds text; text columns go under `by`")]
    Text {
        /// Which figure.
        figure: String,
        /// The column.
        column: String,
    },
    /// A time history against a number, or the other way round.
    #[error("figure {figure} draws `{y}` against `{x}`, but only one of them is a time history")]
    Mixed {
        /// Which figure.
        figure: String,
        /// Column of the x axis.
        x: String,
        /// Column of the y axis.
        y: String,
    },
    /// Two rows of a map give one place two values.
    #[error(
        "figure {figure} draws one value of `{column}` a place, and two rows at ({x}, {y}) differ: split them with `by`"
    )]
    Twice {
        /// Which figure.
        figure: String,
        /// The column of the colour.
        column: String,
        /// The place's x.
        x: String,
        /// The place's y.
        y: String,
    },
    /// A panel of a map of lists has several rows.
    #[error("figure {figure} draws one list of `{column}` a panel, and {rows} rows share one: split them with `by`")]
    ManyFields {
        /// Which figure.
        figure: String,
        /// The column of the colour.
        column: String,
        /// How many.
        rows: usize,
    },
    /// No row has a number to draw.
    #[error(
        "figure {figure} has nothing to draw: no row under the assumptions in force has a number for each of its axes"
    )]
    Nothing {
        /// Which figure.
        figure: String,
    },
    /// The drawing itself failed.
    #[error("figure {figure} cannot be drawn: {source}")]
    Drawing {
        /// Which figure.
        figure: String,
        /// Why.
        source: RasterError,
    },
}
