//! What the study's text says of a figure: a number with its place is an open diamond, a place alone a vertical line, a value
//! alone a horizontal one. Across each a bar: the tolerance of its verdict, and thick u_D, half a unit of its last digit.

use super::axis::{Axis, Extent};
use super::canvas::{Anchor, Lettering, Pen, Sheet, text_width};
use super::geometry::{Point, Rect};
use super::legend::Obstacles;
use super::panel::Panel;
use super::style::{CURVE, GRID, GUIDE, INK, NOTE_TEXT, PAPER, QUOTED, SPACE, TICK};
use crate::experiment::{self, AxisScale};
use crate::text::number::compact;

/// Dash of what stands for a missing coordinate.
pub(super) const DASH: &[f64] = &[16.0, 8.0];
/// Lines nearer than this look like one, unless the dashes of one begin so much later.
const NEAR: f64 = 9.0;
const LATE: f64 = 12.0;
/// Room around a label with nothing in its way.
const ROOM: f64 = 6.0;
/// A value far outside of the curves would leave them no room: how many times their own range it may take.
const STRETCH: f64 = 3.0;
/// Where the bar of the first line of a panel stands, as a share of the frame from its end, and the distance of the next.
const FIRST_BAR: f64 = 0.04;
const BAR_APART: f64 = 0.035;
/// How near to the end of a bar a label seems to be that of its line.
const BESIDE: f64 = 6.0 * QUOTED;

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

    /// What it takes of a frame, as `number` of the panel.
    pub(super) fn obstacle(&self, number: usize, panel: &Panel<'_>, frame: &Rect, obstacles: &mut Obstacles) {
        let at = self.place(panel, frame);
        if let Some(ends) = self.visible_bar(number, panel, frame) {
            obstacles.lines.push(ends.map(|(end, _)| end).to_vec());
        }
        match self.line(panel, frame) {
            Some(line) => obstacles.lines.push(line.to_vec()),
            None => {
                let spot = Rect { left: at.x, top: at.y, right: at.x, bottom: at.y };
                obstacles.boxes.push(spot.grown(QUOTED + SPACE / 2.0));
            }
        }
    }

    fn place(&self, panel: &Panel<'_>, frame: &Rect) -> Point {
        let along = |axis: &Axis, at: Option<f64>| axis.share_clamped(at.unwrap_or(f64::NAN));
        frame.at(along(&panel.x, self.x()), along(&panel.y, self.y()))
    }

    /// Its bars, which lie below the curves, as `number` of the panel.
    pub(super) fn uncertainty(&self, number: usize, sheet: &Sheet, panel: &Panel<'_>, frame: &Rect) {
        let Some(ends) = self.visible_bar(number, panel, frame) else { return };
        let [from, to] = ends.map(|(end, _)| end);
        sheet.line(&[from, to], Pen::solid(INK, GUIDE));
        for ((end, is_within), other) in ends.into_iter().zip([to, from]) {
            if is_within { cap(sheet, end, from.x == to.x) } else { arrow(sheet, end, other) }
        }
        let [from, to] = self.bar(self.u_data, number, panel, frame).map(|(end, _)| end);
        sheet.line(&[from, to], Pen::solid(INK, 2.0 * CURVE));
    }

    /// The bar of its tolerance; none where it goes on beyond the frame at both ends, as a line from edge to edge says nothing.
    fn visible_bar(&self, number: usize, panel: &Panel<'_>, frame: &Rect) -> Option<[(Point, bool); 2]> {
        let ends = self.bar(self.tolerance?, number, panel, frame);
        ends.iter().any(|(_, is_within)| *is_within).then_some(ends)
    }

    /// As printed, with the tolerance where no bar shows it.
    fn text(&self, number: usize, panel: &Panel<'_>, frame: &Rect) -> String {
        let axis = if matches!(self.at, QuotedAt::Place(_) | QuotedAt::Point { known: Known::X, .. }) {
            &panel.x
        } else {
            &panel.y
        };
        match (self.tolerance, self.visible_bar(number, panel, frame)) {
            (Some(tolerance), None) => {
                let tolerance = format!("{} {}", compact(axis.displayed(tolerance), 2), axis.unit);
                format!("{} (± {})", self.label, tolerance.trim_end())
            }
            _ => self.label.clone(),
        }
    }

    /// The ends of a bar of this half width, and whether they lie within the frame. The bars of lines stand beside each other.
    fn bar(&self, half: f64, number: usize, panel: &Panel<'_>, frame: &Rect) -> [(Point, bool); 2] {
        let row = u32::try_from(number).map_or(0.0, f64::from);
        let ends = |axis: &Axis, at: f64| {
            [at - half, at + half].map(|end| (axis.share_clamped(end), axis.share(end).is_some_and(is_share)))
        };
        let across = |y: f64, along: f64| ends(&panel.x, along).map(|(share, within)| (frame.at(share, y), within));
        let at = self.place(panel, frame);
        let up = |x: f64, along: f64| {
            ends(&panel.y, along).map(|(share, within)| (Point { x, y: frame.at(0.0, share).y }, within))
        };
        match self.at {
            QuotedAt::Place(x) => across((FIRST_BAR + BAR_APART * row).min(1.0), x),
            QuotedAt::Level(y) => up(frame.at((1.0 - FIRST_BAR - BAR_APART * row).max(0.0), 0.0).x, y),
            QuotedAt::Point { x, known: Known::X, .. } => across(panel.y.share_clamped(self.y().unwrap_or(x)), x),
            QuotedAt::Point { y, known: Known::Y, .. } => up(at.x, y),
        }
    }

    /// The line or the diamond, as `number` of the panel.
    pub(super) fn draw(&self, number: usize, sheet: &Sheet, panel: &Panel<'_>, frame: &Rect) {
        let pen = Pen { color: INK, width: 1.2 * GUIDE, dash: DASH };
        match self.line(panel, frame) {
            Some([from, to]) => {
                // Dashes of lines that almost coincide lie beside the gaps of the other: two lines are seen.
                let near = |other: &Point| (other.x - from.x).abs() < NEAR && (other.y - from.y).abs() < NEAR;
                let before = panel.quoted[..number].iter().filter_map(|one| one.line(panel, frame));
                let late = if before.filter(|[other, _]| near(other)).count() % 2 == 1 { LATE } else { 0.0 };
                let (dx, dy) = (to.x - from.x, to.y - from.y);
                let share = late / libm::hypot(dx, dy);
                sheet.line(&[Point { x: from.x + share * dx, y: from.y + share * dy }, to], pen)
            }
            None => diamond(sheet, self.place(panel, frame), QUOTED),
        }
    }

    /// The label, where nothing is in its way, as `number` of the panel.
    pub(super) fn write(&self, number: usize, sheet: &Sheet, panel: &Panel<'_>, frame: &Rect, taken: &mut Obstacles) {
        if self.x().is_some_and(|x| panel.is_shown_closer(x)) {
            return;
        }
        let at = self.place(panel, frame);
        let text = self.text(number, panel, frame);
        let forms = forms(&text);
        let places: Vec<Vec<Rect>> = forms.iter().map(|lines| self.label_places(at, lines, frame)).collect();
        let others = || panel.quoted.iter().enumerate().filter(|(other, _)| *other != number);
        // There it would read as the label of another line.
        let strays = |place: &Rect| others().any(|(other, one)| one.claims(place, other, panel, frame));
        let other_lines: Vec<Rect> = others().filter_map(|(_, one)| one.line(panel, frame)).map(spanned).collect();
        let crosses = |place: &Rect| {
            let (from, to) = self.lead_to(at, place);
            // What surrounds its own place is not on its way.
            let boxes = taken.boxes.iter().filter(|taken| !taken.meets(from, from));
            other_lines.iter().chain(boxes).any(|other| other.meets(from, to))
        };
        let of_form = |form: usize, room: f64| {
            let room = frame.grown(-room);
            places[form].iter().filter(move |place| place.lies_within(&room)).map(move |place| (form, place))
        };
        let own = |form: usize, room: f64| of_form(form, room).filter(|(_, place)| !strays(place));
        // Clear of the ticks and with nothing on its way, in one line or in two; else as little in the way as may be.
        let free = |form: usize, room: f64| own(form, room).filter(|(_, place)| taken.leave_free(&place.grown(ROOM)));
        let clear = |form: usize| free(form, TICK).find(|(_, place)| !crosses(place));
        let chosen = (0..forms.len())
            .find_map(clear)
            .or_else(|| (0..forms.len()).find_map(|form| free(form, TICK).next()))
            .or_else(|| free(0, 0.0).next())
            .or_else(|| Some((0, taken.clearest(own(0, 0.0).map(|(_, place)| place), 1.0)?)))
            .or_else(|| Some((0, taken.clearest(of_form(0, 0.0).map(|(_, place)| place), 1.0)?)))
            .or_else(|| of_form(0, 0.0).next());
        let Some((form, place)) = chosen.map(|(form, place)| (form, *place)) else { return };
        taken.boxes.push(place);
        let (from, to) = self.lead_to(at, &place);
        lead(sheet, from, to, if self.is_point() { Some(QUOTED) } else { None });
        let upright = place.height() > place.width();
        // A text beside its line or diamond ends there, or begins there.
        let ends_there = !upright && !matches!(self.at, QuotedAt::Level(_)) && place.right <= at.x;
        for (line, text) in (0_u32..).zip(&forms[form]) {
            let down = (f64::from(line) + 0.5) * place.height() / forms[form].len() as f64;
            let (start, anchor) = match (upright, ends_there) {
                (true, _) => (place.at(0.5, 0.0), Anchor::Left),
                (false, true) => (Point { x: place.right, y: place.top + down }, Anchor::Right),
                (false, false) => (Point { x: place.left, y: place.top + down }, Anchor::Left),
            };
            sheet.text_over_lines(start, &Lettering { text, size: NOTE_TEXT, anchor, upright, color: INK });
        }
    }

    /// The line that leads from what is named to its label in this place.
    fn lead_to(&self, at: Point, place: &Rect) -> (Point, Point) {
        let from = match self.at {
            QuotedAt::Place(_) => Point { y: place.at(0.0, 0.5).y, ..at },
            QuotedAt::Level(_) => Point { x: place.at(0.5, 0.0).x, ..at },
            QuotedAt::Point { .. } => at,
        };
        (from, Point { x: from.x.clamp(place.left, place.right), y: from.y.clamp(place.top, place.bottom) })
    }

    /// Whether a label in this place would seem to be its own, as `number` of the panel: across its line, or in the row of its bar.
    fn claims(&self, place: &Rect, number: usize, panel: &Panel<'_>, frame: &Rect) -> bool {
        let Some(line) = self.line(panel, frame) else { return false };
        let in_row = |ends: [(Point, bool); 2]| {
            let [from, to] = ends.map(|(end, _)| end);
            place.meets(Point { x: from.x - BESIDE, ..from }, Point { x: to.x + BESIDE, ..to })
        };
        // A line across has its bar upright: no row.
        let bar = self.visible_bar(number, panel, frame).filter(|_| matches!(self.at, QuotedAt::Place(_)));
        place.meets(line[0], line[1]) || bar.is_some_and(in_row)
    }

    /// From edge to edge of the frame, what stands for a missing coordinate.
    fn line(&self, panel: &Panel<'_>, frame: &Rect) -> Option<[Point; 2]> {
        let at = self.place(panel, frame);
        match self.at {
            QuotedAt::Place(_) => Some([Point { y: frame.bottom, ..at }, Point { y: frame.top, ..at }]),
            QuotedAt::Level(_) => Some([Point { x: frame.left, ..at }, Point { x: frame.right, ..at }]),
            QuotedAt::Point { .. } => None,
        }
    }

    /// Where a label of these lines may stand, the best places first; some leave the frame.
    fn label_places(&self, at: Point, lines: &[&str], frame: &Rect) -> Vec<Rect> {
        let width = lines.iter().map(|line| text_width(line, NOTE_TEXT)).fold(0.0, f64::max);
        let half = NOTE_TEXT * lines.len() as f64 / 2.0;
        let about = |x: f64, y: f64| Rect { left: x, top: y - half, right: x + width, bottom: y + half };
        let steps = |count: u8| (0..=count).map(move |step| f64::from(step) / f64::from(count));
        match self.at {
            QuotedAt::Place(_) => {
                let aside = [at.x + SPACE / 2.0, at.x - SPACE / 2.0 - width];
                let down =
                    |share: f64, height: f64| frame.top + SPACE + share * (frame.height() - height - 2.0 * SPACE);
                let level = steps(30).flat_map(|share| aside.map(|x| about(x, down(share, 2.0 * half) + half)));
                // Along the line, where another one stands in the way across.
                let beside = [at.x + SPACE / 2.0, at.x - SPACE / 2.0 - 2.0 * half];
                let along = steps(30).filter(|_| lines.len() == 1).flat_map(|share| {
                    let top = down(share, width);
                    beside.map(|left| Rect { left, top, right: left + 2.0 * half, bottom: top + width })
                });
                // Beyond other lines that stand close, with a line that leads there.
                let further = (2_u8..=20).flat_map(|times| {
                    let away = SPACE / 2.0 + f64::from(times) * QUOTED;
                    steps(30).flat_map(move |share| {
                        [at.x + away, at.x - away - width].map(|x| about(x, down(share, 2.0 * half) + half))
                    })
                });
                level.chain(along).chain(further).collect()
            }
            QuotedAt::Level(_) => {
                let left = |share: f64| frame.left + SPACE + share * (frame.width() - 2.0 * SPACE - width);
                let rows = [1.0, 3.0, 5.0, 7.0, 9.0, 11.0];
                let beside = |row: f64| {
                    steps(20).flat_map(move |share| {
                        [-1.0, 1.0].map(|down| about(left(share), at.y + down * (row * half + SPACE / 2.0)))
                    })
                };
                rows.into_iter().flat_map(beside).collect()
            }
            QuotedAt::Point { .. } => {
                let away = QUOTED + SPACE / 2.0 + 1.1 * ROOM;
                let rows = [0.0, 1.0, -1.0, 1.5, -1.5, 2.5, -2.5, 3.5, -3.5, 4.5, -4.5];
                let beside = |further: f64| {
                    let aside = [at.x + away + further, at.x - away - further - width];
                    rows.into_iter().flat_map(move |down| aside.map(|x| about(x, at.y + down * 2.0 * half)))
                };
                let above = [-1.0, 1.0, -2.0, 2.0].map(|down| about(at.x - width / 2.0, at.y + down * (away + half)));
                let further = [1.0, 2.0, 3.0, 4.0].into_iter().flat_map(|times| beside(times * 2.0 * QUOTED));
                beside(0.0).chain(above).chain(further).collect()
            }
        }
    }
}

fn is_share(share: f64) -> bool {
    (0.0..=1.0).contains(&share)
}

/// A bar with both its ends.
pub(super) fn bar(sheet: &Sheet, ends: [Point; 2]) {
    sheet.line(&ends, Pen::solid(INK, GUIDE));
    ends.into_iter().for_each(|end| cap(sheet, end, ends[0].x == ends[1].x));
}

/// A label in one line, and in two where it has a part after a comma.
fn forms(text: &str) -> Vec<Vec<&str>> {
    let two = text.split_once(", ").map(|(first, _)| text.split_at(first.len() + 1));
    let two = two.map(|(first, rest)| vec![first, rest.trim_start()]);
    std::iter::once(vec![text]).chain(two).collect()
}

/// A line to a label from what it names, where the two are apart. It begins at this distance, or else with a dot: the line that is named
/// may not be the only one that it meets.
fn lead(sheet: &Sheet, at: Point, label: Point, distance: Option<f64>) {
    let (dx, dy) = (label.x - at.x, label.y - at.y);
    let length = libm::hypot(dx, dy);
    if length > 2.0 * QUOTED {
        let share = distance.unwrap_or(0.0) / length;
        sheet.line(&[Point { x: at.x + share * dx, y: at.y + share * dy }, label], Pen::solid(INK, GRID));
        if distance.is_none() {
            sheet.disc(at, CURVE, INK);
        }
    }
}

/// What a level or upright stretch takes.
fn spanned([a, b]: [Point; 2]) -> Rect {
    Rect { left: a.x.min(b.x), top: a.y.min(b.y), right: a.x.max(b.x), bottom: a.y.max(b.y) }
}

/// The end of a bar.
fn cap(sheet: &Sheet, end: Point, is_upright: bool) {
    let reach = QUOTED / 2.0;
    let ends = if is_upright {
        [-reach, reach].map(|by| Point { x: end.x + by, ..end })
    } else {
        [-reach, reach].map(|by| Point { y: end.y + by, ..end })
    };
    sheet.line(&ends, Pen::solid(INK, GUIDE));
}

/// Where a bar goes on beyond the frame: the head of an arrow at the end that is seen, away from the other one.
fn arrow(sheet: &Sheet, end: Point, other: Point) {
    let (dx, dy) = (end.x - other.x, end.y - other.y);
    let length = libm::hypot(dx, dy);
    if length > QUOTED {
        let (along, across) = (QUOTED / length, 0.5 * QUOTED / length);
        let foot = Point { x: end.x - along * dx, y: end.y - along * dy };
        let corner = |side: f64| Point { x: foot.x - side * across * dy, y: foot.y + side * across * dx };
        sheet.fill(&[end, corner(1.0), corner(-1.0)], INK, 1.0);
    }
}

/// The open diamond of a number that the study quotes.
pub(super) fn diamond(sheet: &Sheet, at: Point, size: f64) {
    let corner = |dx: f64, dy: f64| Point { x: at.x + dx * size, y: at.y + dy * size };
    let corners = [corner(0.0, -1.0), corner(0.8, 0.0), corner(0.0, 1.0), corner(-0.8, 0.0)];
    sheet.fill(&corners, PAPER, 1.0);
    let closed = [corners[0], corners[1], corners[2], corners[3], corners[0], corners[1]];
    sheet.line(&closed, Pen::solid(INK, CURVE * 0.8));
}
