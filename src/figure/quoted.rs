//! What the study's text says of a figure: a number with its place, a place alone, or a value alone.

use super::axis::Extent;
use crate::experiment::{self, AxisScale};

/// A value far outside of the curves would leave them no room: how many times their own range it may take.
const STRETCH: f64 = 3.0;
/// A number that the study's text quotes.
#[derive(Debug, Clone, PartialEq)]
pub struct Quoted {
    /// The y column that it belongs to; it appears in the panels that draw this column.
    pub column: String,
    /// The x column of its place; panels over another one do not show it. `None` for a value of the column as a whole.
    pub over: Option<String>,
    /// Where, in the table's units.
    pub at: QuotedAt,
    /// As printed, with what it belongs to: `study: 5.02, untuned`.
    pub label: String,
    /// u_D, half a unit of the last printed digit, in the table's unit.
    pub u_data: f64,
    /// 2 u_val, or the tolerance set by hand, in the table's unit; `None` without a result to compare.
    pub tolerance: Option<f64>,
}

/// What a quoted number says.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum QuotedAt {
    /// A value at a place.
    Point {
        /// The place.
        x: f64,
        /// The value.
        y: f64,
        /// Which of the two is quoted with its uncertainty.
        known: Known,
    },
    /// A place without a value.
    Place(f64),
    /// A value without a place.
    Level(f64),
}

/// The coordinate that the quoted number is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Known {
    /// The place, at which the curve has a value given beforehand.
    X,
    /// The value.
    Y,
}

impl Quoted {
    /// Whether it belongs to these axes.
    pub(super) fn fits(&self, panel: &experiment::Panel) -> bool {
        panel.y.iter().any(|axis| axis.column == self.column)
            && self.over.as_ref().is_none_or(|over| *over == panel.x.column)
            && !panel.over_first
            // What is said of a whole curve is not said of a part.
            && (panel.x.range.is_none() || self.x().is_some_and(|x| panel.x.shows(x)))
    }

    pub(super) fn x(&self) -> Option<f64> {
        match self.at {
            QuotedAt::Point { x, .. } | QuotedAt::Place(x) => Some(x),
            QuotedAt::Level(_) => None,
        }
    }

    pub(super) fn y(&self) -> Option<f64> {
        match self.at {
            QuotedAt::Point { y, .. } | QuotedAt::Level(y) => Some(y),
            QuotedAt::Place(_) => None,
        }
    }

    pub(super) fn is_point(&self) -> bool {
        matches!(self.at, QuotedAt::Point { .. })
    }

    /// Whether curves of this extent stay readable beside it.
    pub(super) fn leaves_room(&self, curves: Extent, scale: AxisScale) -> bool {
        let QuotedAt::Level(y) = self.at else { return true };
        curves.with(y, scale).span(scale) <= (1.0 + STRETCH) * curves.span(scale)
    }

    /// The ends of its bar, where that stands upright.
    pub(super) fn ends_in_y(&self) -> impl Iterator<Item = f64> {
        let value = match self.at {
            QuotedAt::Level(y) | QuotedAt::Point { y, known: Known::Y, .. } => Some(y),
            QuotedAt::Place(_) | QuotedAt::Point { known: Known::X, .. } => None,
        };
        value.zip(self.tolerance).into_iter().flat_map(|(y, half)| [y - half, y + half])
    }
}
