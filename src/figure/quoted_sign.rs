//! How a quoted number is drawn: with its place as an open diamond, a place alone as a vertical line, a value alone as a horizontal one.
//! Across each a bar: the tolerance of its verdict, and thick u_D, half a unit of its last digit.

use super::axis::Axis;
use super::canvas::{Anchor, Lettering, Pen, Sheet, text_width};
use super::geometry::{Point, Rect};
use super::marker::{DASH, arrow, cap, diamond};
use super::obstacles::Obstacles;
use super::panel::Panel;
use super::quoted::{Known, Quoted, QuotedAt};
use super::style::{CURVE, GRID, GUIDE, INK, NOTE_TEXT, QUOTED, SPACE, TICK};
use crate::text::number::compact;

/// Lines nearer than this look like one, unless the dashes of one begin so much later.
const NEAR: f64 = 9.0;
const LATE: f64 = 12.0;
/// Room around a label with nothing in its way.
const ROOM: f64 = 6.0;
/// Where the bar of the first line of a panel stands, as a share of the frame from its end, and the distance of the next.
const FIRST_BAR: f64 = 0.04;
const BAR_APART: f64 = 0.035;
/// How near to the end of a bar a label seems to be that of its line.
const BESIDE: f64 = 6.0 * QUOTED;

/// A quoted number in the frame of a panel.
#[derive(Clone, Copy)]
pub(super) struct QuotedSign<'p> {
    said: &'p Quoted,
    /// Which of those of the panel it is, from 0.
    number: usize,
    panel: &'p Panel<'p>,
    frame: &'p Rect,
}

impl<'p> QuotedSign<'p> {
    /// All that a panel shows in this frame.
    pub(super) fn all(panel: &'p Panel<'p>, frame: &'p Rect) -> impl Iterator<Item = Self> + Clone {
        panel.quoted.iter().enumerate().map(move |(number, said)| Self { said, number, panel, frame })
    }

    /// What it takes of a frame.
    pub(super) fn obstacle(&self, obstacles: &mut Obstacles) {
        let at = self.place();
        if let Some(ends) = self.visible_bar() {
            obstacles.lines.push(ends.map(|(end, _)| end).to_vec());
        }
        match self.line() {
            Some(line) => obstacles.lines.push(line.to_vec()),
            None => {
                let spot = Rect { left: at.x, top: at.y, right: at.x, bottom: at.y };
                obstacles.boxes.push(spot.grown(QUOTED + SPACE / 2.0));
            }
        }
    }

    fn place(&self) -> Point {
        let along = |axis: &Axis, at: Option<f64>| axis.share_clamped(at.unwrap_or(f64::NAN));
        self.frame.at(along(&self.panel.x, self.said.x()), along(&self.panel.y, self.said.y()))
    }

    /// Its bars, which lie below the curves.
    pub(super) fn uncertainty(&self, sheet: &Sheet) {
        let Some(ends) = self.visible_bar() else { return };
        let [from, to] = ends.map(|(end, _)| end);
        sheet.line(&[from, to], Pen::solid(INK, GUIDE));
        for ((end, is_within), other) in ends.into_iter().zip([to, from]) {
            if is_within { cap(sheet, end, from.x == to.x) } else { arrow(sheet, end, other) }
        }
        let [from, to] = self.bar(self.said.u_data).map(|(end, _)| end);
        sheet.line(&[from, to], Pen::solid(INK, 2.0 * CURVE));
    }

    /// The bar of its tolerance; none where it goes on beyond the frame at both ends, as a line from edge to edge says nothing.
    fn visible_bar(&self) -> Option<[(Point, bool); 2]> {
        let ends = self.bar(self.said.tolerance?);
        ends.iter().any(|(_, is_within)| *is_within).then_some(ends)
    }

    /// As printed, with the tolerance where no bar shows it.
    fn text(&self) -> String {
        let axis = if matches!(self.said.at, QuotedAt::Place(_) | QuotedAt::Point { known: Known::X, .. }) {
            &self.panel.x
        } else {
            &self.panel.y
        };
        match (self.said.tolerance, self.visible_bar()) {
            (Some(tolerance), None) => {
                let tolerance = format!("{} {}", compact(axis.displayed(tolerance), 2), axis.unit);
                format!("{} (± {})", self.said.label, tolerance.trim_end())
            }
            _ => self.said.label.clone(),
        }
    }

    /// The ends of a bar of this half width, and whether they lie within the frame. The bars of lines stand beside each other.
    fn bar(&self, half: f64) -> [(Point, bool); 2] {
        let row = u32::try_from(self.number).map_or(0.0, f64::from);
        let ends = |axis: &Axis, at: f64| {
            [at - half, at + half].map(|end| (axis.share_clamped(end), axis.share(end).is_some_and(is_share)))
        };
        let across =
            |y: f64, along: f64| ends(&self.panel.x, along).map(|(share, within)| (self.frame.at(share, y), within));
        let at = self.place();
        let up = |x: f64, along: f64| {
            ends(&self.panel.y, along).map(|(share, within)| (Point { x, y: self.frame.at(0.0, share).y }, within))
        };
        match self.said.at {
            QuotedAt::Place(x) => across((FIRST_BAR + BAR_APART * row).min(1.0), x),
            QuotedAt::Level(y) => up(self.frame.at((1.0 - FIRST_BAR - BAR_APART * row).max(0.0), 0.0).x, y),
            QuotedAt::Point { x, known: Known::X, .. } => {
                across(self.panel.y.share_clamped(self.said.y().unwrap_or(x)), x)
            }
            QuotedAt::Point { y, known: Known::Y, .. } => up(at.x, y),
        }
    }

    /// The line or the diamond.
    pub(super) fn draw(&self, sheet: &Sheet) {
        let pen = Pen { color: INK, width: 1.2 * GUIDE, dash: DASH };
        match self.line() {
            Some([from, to]) => {
                // Dashes of lines that almost coincide lie beside the gaps of the other: two lines are seen.
                let near = |other: &Point| (other.x - from.x).abs() < NEAR && (other.y - from.y).abs() < NEAR;
                let before = Self::all(self.panel, self.frame).take(self.number).filter_map(|one| one.line());
                let late = if before.filter(|[other, _]| near(other)).count() % 2 == 1 { LATE } else { 0.0 };
                let (dx, dy) = (to.x - from.x, to.y - from.y);
                let share = late / libm::hypot(dx, dy);
                sheet.line(&[Point { x: from.x + share * dx, y: from.y + share * dy }, to], pen)
            }
            None => diamond(sheet, self.place(), QUOTED),
        }
    }

    /// The label, where nothing is in its way.
    pub(super) fn write(&self, sheet: &Sheet, taken: &mut Obstacles) {
        if self.said.x().is_some_and(|x| self.panel.is_shown_closer(x)) {
            return;
        }
        let at = self.place();
        let text = self.text();
        let forms = forms(&text);
        let places: Vec<Vec<Rect>> = forms.iter().map(|lines| self.label_places(at, lines)).collect();
        let others = || Self::all(self.panel, self.frame).filter(|other| other.number != self.number);
        // There it would read as the label of another line.
        let strays = |place: &Rect| others().any(|one| one.claims(place));
        let other_lines: Vec<Rect> = others().filter_map(|one| one.line()).map(spanned).collect();
        let crosses = |place: &Rect| {
            let (from, to) = self.lead_to(at, place);
            // What surrounds its own place is not on its way.
            let boxes = taken.boxes.iter().filter(|taken| !taken.meets(from, from));
            other_lines.iter().chain(boxes).any(|other| other.meets(from, to))
        };
        let of_form = |form: usize, room: f64| {
            let room = self.frame.grown(-room);
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
        lead(sheet, from, to, if self.said.is_point() { Some(QUOTED) } else { None });
        let upright = place.height() > place.width();
        // A text beside its line or diamond ends there, or begins there.
        let ends_there = !upright && !matches!(self.said.at, QuotedAt::Level(_)) && place.right <= at.x;
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
        let from = match self.said.at {
            QuotedAt::Place(_) => Point { y: place.at(0.0, 0.5).y, ..at },
            QuotedAt::Level(_) => Point { x: place.at(0.5, 0.0).x, ..at },
            QuotedAt::Point { .. } => at,
        };
        (from, Point { x: from.x.clamp(place.left, place.right), y: from.y.clamp(place.top, place.bottom) })
    }

    /// Whether a label in this place would seem to be its own: across its line, or in the row of its bar.
    fn claims(&self, place: &Rect) -> bool {
        let Some(line) = self.line() else { return false };
        let in_row = |ends: [(Point, bool); 2]| {
            let [from, to] = ends.map(|(end, _)| end);
            place.meets(Point { x: from.x - BESIDE, ..from }, Point { x: to.x + BESIDE, ..to })
        };
        // A line across has its bar upright: no row.
        let bar = self.visible_bar().filter(|_| matches!(self.said.at, QuotedAt::Place(_)));
        place.meets(line[0], line[1]) || bar.is_some_and(in_row)
    }

    /// From edge to edge of the frame, what stands for a missing coordinate.
    fn line(&self) -> Option<[Point; 2]> {
        let at = self.place();
        match self.said.at {
            QuotedAt::Place(_) => Some([Point { y: self.frame.bottom, ..at }, Point { y: self.frame.top, ..at }]),
            QuotedAt::Level(_) => Some([Point { x: self.frame.left, ..at }, Point { x: self.frame.right, ..at }]),
            QuotedAt::Point { .. } => None,
        }
    }

    /// Where a label of these lines may stand, the best places first; some leave the frame.
    fn label_places(&self, at: Point, lines: &[&str]) -> Vec<Rect> {
        let width = lines.iter().map(|line| text_width(line, NOTE_TEXT)).fold(0.0, f64::max);
        let half = NOTE_TEXT * lines.len() as f64 / 2.0;
        let about = |x: f64, y: f64| Rect { left: x, top: y - half, right: x + width, bottom: y + half };
        let steps = |count: u8| (0..=count).map(move |step| f64::from(step) / f64::from(count));
        match self.said.at {
            QuotedAt::Place(_) => {
                let aside = [at.x + SPACE / 2.0, at.x - SPACE / 2.0 - width];
                let down = |share: f64, height: f64| {
                    self.frame.top + SPACE + share * (self.frame.height() - height - 2.0 * SPACE)
                };
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
                let left = |share: f64| self.frame.left + SPACE + share * (self.frame.width() - 2.0 * SPACE - width);
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
