//! What the study's text says of a figure: a number with its place is an open diamond, a place alone a vertical line, a value
//! alone a horizontal one. About each the tolerance of its verdict, 2 u_val, and u_D, half a unit of its last digit.

use super::axis::{Axis, Extent};
use super::canvas::{Anchor, Lettering, Pen, Sheet, text_width};
use super::geometry::{Point, Rect};
use super::legend::Obstacles;
use super::panel::Panel;
use super::style::{CURVE, GUIDE, INK, NOTE_TEXT, PAPER, QUOTED, QUOTED_OPACITY, SPACE};
use crate::experiment::{self, AxisScale};

/// Dash of what stands for a missing coordinate.
pub(super) const DASH: &[f64] = &[16.0, 8.0];
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
        let span = |extent: Extent| match scale {
            AxisScale::Linear => extent.largest - extent.least,
            AxisScale::Log => libm::log10(extent.largest / extent.least),
        };
        span(curves.with(y, scale)) <= (1.0 + STRETCH) * span(curves)
    }

    /// What it takes of a frame.
    pub(super) fn obstacle(&self, panel: &Panel<'_>, frame: &Rect, obstacles: &mut Obstacles) {
        let at = self.place(panel, frame);
        match self.at {
            QuotedAt::Point { .. } => {
                let spot = Rect { left: at.x, top: at.y, right: at.x, bottom: at.y };
                obstacles.boxes.push(spot.grown(QUOTED + SPACE / 2.0));
            }
            QuotedAt::Place(_) => {
                obstacles.lines.push(vec![Point { y: frame.top, ..at }, Point { y: frame.bottom, ..at }]);
            }
            QuotedAt::Level(_) => {
                obstacles.lines.push(vec![Point { x: frame.left, ..at }, Point { x: frame.right, ..at }]);
            }
        }
    }

    fn place(&self, panel: &Panel<'_>, frame: &Rect) -> Point {
        let along = |axis: &Axis, at: Option<f64>| axis.share_clamped(at.unwrap_or(f64::NAN));
        frame.at(along(&panel.x, self.x()), along(&panel.y, self.y()))
    }

    /// Bands and bars, which lie below the curves.
    pub(super) fn uncertainty(&self, sheet: &Sheet, panel: &Panel<'_>, frame: &Rect) {
        let Some(tolerance) = self.tolerance else { return };
        let ends = |axis: &Axis, at: f64, half: f64| [at - half, at + half].map(|end| axis.share_clamped(end));
        let at = self.place(panel, frame);
        match self.at {
            QuotedAt::Place(x) => {
                let [low, high] = ends(&panel.x, x, tolerance);
                fill(sheet, &[frame.at(low, 0.0), frame.at(low, 1.0), frame.at(high, 1.0), frame.at(high, 0.0)]);
            }
            QuotedAt::Level(y) => {
                let [low, high] = ends(&panel.y, y, tolerance);
                fill(sheet, &[frame.at(0.0, low), frame.at(0.0, high), frame.at(1.0, high), frame.at(1.0, low)]);
            }
            QuotedAt::Point { x, y, known } => {
                for (half, width) in [(tolerance, GUIDE), (self.u_data, 2.0 * CURVE)] {
                    let bar = match known {
                        Known::X => ends(&panel.x, x, half).map(|share| Point { x: frame.at(share, 0.0).x, ..at }),
                        Known::Y => ends(&panel.y, y, half).map(|share| Point { y: frame.at(0.0, share).y, ..at }),
                    };
                    sheet.line(&bar, Pen::solid(INK, width));
                    if width == GUIDE {
                        bar.into_iter().for_each(|end| cap(sheet, end, known));
                    }
                }
            }
        }
    }

    /// The line or the diamond.
    pub(super) fn draw(&self, sheet: &Sheet, panel: &Panel<'_>, frame: &Rect) {
        let at = self.place(panel, frame);
        let pen = Pen { color: INK, width: 1.2 * GUIDE, dash: DASH };
        match self.at {
            QuotedAt::Place(_) => sheet.line(&[Point { y: frame.bottom, ..at }, Point { y: frame.top, ..at }], pen),
            QuotedAt::Level(_) => sheet.line(&[Point { x: frame.left, ..at }, Point { x: frame.right, ..at }], pen),
            QuotedAt::Point { .. } => diamond(sheet, at, QUOTED),
        }
    }

    /// The label, where nothing is in its way.
    pub(super) fn write(&self, sheet: &Sheet, panel: &Panel<'_>, frame: &Rect, taken: &mut Obstacles) {
        let at = self.place(panel, frame);
        let (width, half) = (text_width(&self.label, NOTE_TEXT), NOTE_TEXT / 2.0);
        let about = |x: f64, y: f64| Rect { left: x, top: y - half, right: x + width, bottom: y + half };
        let aside = [at.x + SPACE / 2.0, at.x - SPACE / 2.0 - width];
        let places: Vec<Rect> = match self.at {
            QuotedAt::Place(_) => (0..=30_u8)
                .map(|step| {
                    frame.top + half + SPACE / 2.0 + f64::from(step) / 30.0 * (frame.height() - 2.0 * half - SPACE)
                })
                .flat_map(|y| aside.map(|x| about(x, y)))
                .collect(),
            QuotedAt::Level(_) => (0..=20_u8)
                .map(|step| frame.left + SPACE + f64::from(step) / 20.0 * (frame.width() - 2.0 * SPACE - width))
                .flat_map(|x| [-1.0, 1.0].map(|down| about(x, at.y + down * (half + SPACE / 2.0))))
                .collect(),
            QuotedAt::Point { .. } => {
                let away = QUOTED + SPACE / 2.0;
                let rows = [0.0, 1.0, -1.0, 1.5, -1.5, 2.5, -2.5, 3.5, -3.5, 4.5, -4.5];
                let beside =
                    rows.map(|down| [at.x + away, at.x - away - width].map(|x| about(x, at.y + down * 2.0 * half)));
                let above = [-1.0, 1.0, -2.0, 2.0].map(|down| about(at.x - width / 2.0, at.y + down * (away + half)));
                beside.into_iter().flatten().chain(above).collect()
            }
        };
        let inside = || places.iter().filter(|place| place.lies_within(frame));
        let free = inside().find(|place| taken.leave_free(&place.grown(1.0)));
        // Over a curve it can be read, over another label it cannot.
        let legible = || inside().find(|place| taken.leave_boxes_free(&place.grown(1.0)));
        let Some(place) = free.or_else(legible).or_else(|| inside().next()).copied() else { return };
        taken.boxes.push(place);
        sheet.fill(&place.corners(), PAPER, 0.85);
        let lettering =
            Lettering { text: &self.label, size: NOTE_TEXT, anchor: Anchor::Left, upright: false, color: INK };
        sheet.text(place.at(0.0, 0.5), &lettering);
    }
}

fn fill(sheet: &Sheet, corners: &[Point]) {
    sheet.fill(corners, INK, QUOTED_OPACITY);
}

/// The end of a bar.
fn cap(sheet: &Sheet, end: Point, known: Known) {
    let reach = QUOTED / 2.0;
    let ends = match known {
        Known::X => [-reach, reach].map(|by| Point { y: end.y + by, ..end }),
        Known::Y => [-reach, reach].map(|by| Point { x: end.x + by, ..end }),
    };
    sheet.line(&ends, Pen::solid(INK, GUIDE));
}

/// The open diamond of a number that the study quotes.
pub(super) fn diamond(sheet: &Sheet, at: Point, size: f64) {
    let corner = |dx: f64, dy: f64| Point { x: at.x + dx * size, y: at.y + dy * size };
    let corners = [corner(0.0, -1.0), corner(0.8, 0.0), corner(0.0, 1.0), corner(-0.8, 0.0)];
    sheet.fill(&corners, PAPER, 1.0);
    let closed = [corners[0], corners[1], corners[2], corners[3], corners[0], corners[1]];
    sheet.line(&closed, Pen::solid(INK, CURVE * 0.8));
}
