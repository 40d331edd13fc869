//! A panel put on the sheet: grid, bands, curves, markers, frame, numbers, legend, in this order.

use crate::experiment::{Band, Joined};
use crate::text::number::compact;

use super::attributes::{Attributes, Labelled};
use super::canvas::{Anchor, Lettering, Pen, Sheet, UNITS, text_width};
use super::contact;
use super::geometry::{Point, Rect};
use super::layout::{Place, line_height};
use super::line::{Curve, Join};
use super::marker;
use super::obstacles::Obstacles;
use super::panel::Panel;
use super::peak::PeakMark;
use super::quoted_sign::QuotedSign;
use super::strip;
use super::style::{
    BAND_OPACITY, CLOSER_OPACITY, CURVE, Color, FRAME, GREY, GRID, GUIDE, GUIDE_DASH, INK, LABEL_TEXT, Look, MARKER,
    MINOR_TICK, Marker, NOTE_TEXT, PALE, SPACE, STACK_OPACITY, TICK, TICK_TEXT,
};

/// Where a panel's legend goes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum LegendPlace {
    None,
    Within(Rect),
    Above,
}

/// Draws a panel into its frame.
pub(super) fn panel(
    sheet: &Sheet,
    panel: &Panel<'_>,
    place: &Place,
    legend: LegendPlace,
    letter: Option<char>,
    x_labels: bool,
) {
    let frame = &place.frame;
    let mut taken = obstacles(panel, frame);
    if let LegendPlace::Within(place) = legend {
        taken.boxes.push(place);
    }
    grid(sheet, panel, frame);
    let opacity = if panel.spec.band == Band::Stacked { STACK_OPACITY } else { BAND_OPACITY };
    for curve in &panel.curves {
        for band in panel.bands(frame, curve) {
            sheet.fill(&band, curve.look.color, opacity);
        }
    }
    for [from, to] in &panel.closer {
        let [left, right] = [from, to].map(|end| panel.x.share_clamped(*end));
        let corners = [frame.at(left, 0.0), frame.at(left, 1.0), frame.at(right, 1.0), frame.at(right, 0.0)];
        sheet.fill(&corners, INK, CLOSER_OPACITY);
    }
    QuotedSign::all(panel, frame).for_each(|one| one.uncertainty(sheet));
    for guide in &panel.spec.guides {
        // A legend names it.
        let label = if panel.legend.is_empty() { guide.label.as_str() } else { "" };
        level(sheet, panel, frame, guide.at, label, GREY, &mut taken);
    }
    for curve in &panel.curves {
        if let Some(limit) = &curve.at_infinity {
            level(sheet, panel, frame, limit.y, &limit.label, curve.look.color, &mut taken);
        }
    }
    contact::draw(sheet, &panel.x, panel.impulses, &panel.contacts, frame);
    let [x, y] = [(&panel.x, &panel.x_label), (&panel.y, &panel.y_label)].map(|(axis, label)| Labelled { axis, label });
    sheet.group(&Attributes::frame(frame, UNITS, x, y), || curves(sheet, panel, frame));
    for sign in panel.signs(frame) {
        if sign.at != sign.of {
            sheet.line(&[sign.of, sign.at], Pen::solid(INK, GRID));
        }
        marker::draw(sheet, sign.at, Look::of_special(sign.kind));
    }
    peak_marks(sheet, panel, frame, &mut taken);
    QuotedSign::all(panel, frame).for_each(|one| one.draw(sheet));
    QuotedSign::all(panel, frame).for_each(|one| one.write(sheet, &mut taken));
    axes(sheet, panel, frame, x_labels);
    strip::draw(sheet, &panel.x, &panel.strips, frame);
    y_label(sheet, place);
    if let Some(letter) = letter {
        // Clear of the numbers at the y axis.
        let at = Point { x: frame.left, y: frame.top - SPACE - LABEL_TEXT / 2.0 };
        write(sheet, at, &format!("({letter})"), LABEL_TEXT, Anchor::Left, INK);
    }
    match legend {
        LegendPlace::None => {}
        LegendPlace::Within(place) => panel.legend.draw_column(sheet, &place),
        LegendPlace::Above => panel.legend.draw_above(sheet, frame),
    }
}

fn grid(sheet: &Sheet, panel: &Panel<'_>, frame: &Rect) {
    for tick in panel.x_ticks().iter().filter(|tick| !tick.label.is_empty()) {
        sheet.line(&[frame.at(tick.at, 0.0), frame.at(tick.at, 1.0)], Pen::solid(PALE, GRID));
    }
    for tick in panel.y_ticks().iter().filter(|tick| !tick.label.is_empty()) {
        sheet.line(&[frame.at(0.0, tick.at), frame.at(1.0, tick.at)], Pen::solid(PALE, GRID));
    }
}

fn curves(sheet: &Sheet, panel: &Panel<'_>, frame: &Rect) {
    for one in &panel.curves {
        sheet.group(&Attributes::name(&one.name.full()), || curve(sheet, panel, frame, one));
    }
}

fn curve(sheet: &Sheet, panel: &Panel<'_>, frame: &Rect, curve: &Curve) {
    let pen = Pen { color: curve.look.color, width: curve.look.width, dash: curve.look.dash };
    if curve.join == Join::Dots {
        return sheet.dots(&panel.dots(frame, curve), pen);
    }
    for stretch in panel.stretches(frame, curve) {
        // A point between two gaps would be no line at all.
        if let [alone] = stretch.as_slice() {
            // A branch of one point is all that is seen of it.
            let size = if panel.spec.joined == Joined::AlongBranches { 1.6 * CURVE } else { CURVE };
            sheet.disc(*alone, size, curve.look.color);
        }
        sheet.line(&stretch, pen);
        let marked = match (panel.spec.markers, panel.spec.band) {
            (true, _) => stretch.as_slice(),
            // Where a search ended.
            (false, Band::Seeds) => &stretch[stretch.len() - 1..],
            (false, _) => &[],
        };
        for &at in marked {
            marker::draw(sheet, at, curve.look);
        }
    }
}

/// A triangle on each peak, with its place on the x axis where there is room for the number.
fn peak_marks(sheet: &Sheet, panel: &Panel<'_>, frame: &Rect, taken: &mut Obstacles) {
    for PeakMark { at, x, look } in panel.peak_marks(frame) {
        marker::draw(sheet, at, Look { marker: Marker::Down, ..look });
        let text = compact(panel.x.displayed(x), 4);
        let (width, half) = (text_width(&text, NOTE_TEXT), NOTE_TEXT / 2.0);
        let (up, aside) = (half + MARKER + SPACE / 2.0, width / 2.0 + MARKER + SPACE / 2.0);
        let higher = |rows: f64| up + rows * NOTE_TEXT;
        let places = [
            (0.0, up),
            (aside, 0.0),
            (-aside, 0.0),
            (aside, up),
            (-aside, up),
            (0.0, higher(1.0)),
            (aside, higher(1.0)),
            (-aside, higher(1.0)),
            (0.0, higher(2.0)),
            (1.6 * aside, 0.0),
            (-1.6 * aside, 0.0),
            (aside, -up),
            (-aside, -up),
        ];
        let place = places.map(|(right, up)| {
            let (x, y) = (at.x + right, at.y - up);
            Rect { left: x - width / 2.0, top: y - half, right: x + width / 2.0, bottom: y + half }
        });
        let room = frame.grown(-SPACE / 2.0);
        let within = |place: &Rect| place.left > room.left && place.right < room.right && place.top > room.top;
        if let Some(place) = place.into_iter().find(|place| within(place) && taken.leave_free(&place.grown(2.0))) {
            write(sheet, place.at(0.5, 0.5), &text, NOTE_TEXT, Anchor::Centre, look.color);
            taken.boxes.push(place);
        }
    }
}

/// A labelled horizontal line; the label stands at an end where nothing is in its way.
fn level(sheet: &Sheet, panel: &Panel<'_>, frame: &Rect, y: f64, label: &str, color: Color, taken: &mut Obstacles) {
    let Some(ends) = panel.level(frame, y) else { return };
    sheet.line(&ends, Pen { color, width: GUIDE, dash: GUIDE_DASH });
    if label.is_empty() {
        return;
    }
    let (width, half) = (text_width(label, NOTE_TEXT), NOTE_TEXT / 2.0);
    let across = [20_u8, 0, 10, 19, 1, 18, 2, 17, 3, 16, 4, 15, 5, 14, 6, 13, 7, 12, 8, 11, 9];
    let places: Vec<Rect> = across
        .into_iter()
        .flat_map(|step| [-1.0, 1.0].map(|down| (f64::from(step) / 20.0, down)))
        .map(|(across, down)| {
            let left = frame.left + SPACE + across * (frame.width() - 2.0 * SPACE - width);
            let middle = ends[0].y + down * (half + SPACE / 2.0);
            Rect { left, top: middle - half, right: left + width, bottom: middle + half }
        })
        .collect();
    let inside = places.iter().filter(|place| place.top > frame.top && place.bottom < frame.bottom);
    let place = *taken.clearest(inside, -2.0).unwrap_or(&places[0]);
    taken.boxes.push(place);
    let lettering = Lettering { text: label, size: NOTE_TEXT, anchor: Anchor::Left, upright: false, color };
    sheet.text_over_lines(place.at(0.0, 0.5), &lettering);
}

fn axes(sheet: &Sheet, panel: &Panel<'_>, frame: &Rect, x_labels: bool) {
    let pen = Pen::solid(INK, FRAME);
    let below = strip::height(&panel.strips);
    let corners = [frame.at(0.0, 0.0), frame.at(1.0, 0.0), frame.at(1.0, 1.0), frame.at(0.0, 1.0)];
    sheet.line(&[corners[0], corners[1], corners[2], corners[3], corners[0], corners[1]], pen);
    for tick in panel.x_ticks() {
        let length = if tick.label.is_empty() { MINOR_TICK } else { TICK };
        for (end, inwards) in [(0.0, -length), (1.0, length)] {
            let from = frame.at(tick.at, end);
            sheet.line(&[from, Point { y: from.y + inwards, ..from }], pen);
        }
        if x_labels {
            let at = frame.at(tick.at, 0.0);
            let at = Point { y: at.y + below + SPACE + TICK_TEXT / 2.0, ..at };
            write(sheet, at, &tick.label, TICK_TEXT, Anchor::Centre, INK);
        }
    }
    for tick in panel.y_ticks() {
        let length = if tick.label.is_empty() { MINOR_TICK } else { TICK };
        for (end, inwards) in [(0.0, length), (1.0, -length)] {
            let from = frame.at(end, tick.at);
            sheet.line(&[from, Point { x: from.x + inwards, ..from }], pen);
        }
        let at = frame.at(0.0, tick.at);
        write(sheet, Point { x: at.x - SPACE, ..at }, &tick.label, TICK_TEXT, Anchor::Right, INK);
    }
    if x_labels {
        let at = frame.at(0.5, 0.0);
        let at = Point { y: at.y + below + 2.0 * SPACE + TICK_TEXT + LABEL_TEXT / 2.0, ..at };
        write(sheet, at, &panel.x_label, LABEL_TEXT, Anchor::Centre, INK);
    }
}

fn y_label(sheet: &Sheet, place: &Place) {
    let mut at = Point { x: SPACE + LABEL_TEXT / 2.0, y: place.frame.at(0.0, 0.5).y };
    for text in &place.y_label {
        let line = Lettering { text, size: LABEL_TEXT, anchor: Anchor::Centre, upright: true, color: INK };
        sheet.text(at, &line);
        at.x += line_height();
    }
}

/// All that a legend or a label must not cover.
pub(super) fn obstacles(panel: &Panel<'_>, frame: &Rect) -> Obstacles {
    let mut obstacles = Obstacles::default();
    for curve in &panel.curves {
        obstacles.lines.extend(panel.stretches(frame, curve));
        obstacles.lines.extend(panel.bands(frame, curve));
        if let Some(limit) = &curve.at_infinity {
            obstacles.lines.extend(panel.level(frame, limit.y).map(Vec::from));
        }
    }
    for guide in &panel.spec.guides {
        obstacles.lines.extend(panel.level(frame, guide.at).map(Vec::from));
    }
    if !panel.contacts.is_empty() {
        let (top, bottom) = (frame.top + contact::BAR, frame.bottom - contact::BAR);
        obstacles.boxes.extend([Rect { bottom: top, ..*frame }, Rect { top: bottom, ..*frame }]);
    }
    let around = |at: Point| Rect { left: at.x, top: at.y, right: at.x, bottom: at.y }.grown(MARKER);
    obstacles.boxes.extend(panel.signs(frame).into_iter().map(|sign| around(sign.at)));
    obstacles.boxes.extend(panel.peak_marks(frame).into_iter().map(|mark| around(mark.at).grown(0.2 * MARKER)));
    if panel.spec.markers {
        let samples = panel.curves.iter().filter(|curve| curve.join == Join::Line).flat_map(|curve| &curve.samples);
        obstacles.boxes.extend(samples.filter_map(|sample| panel.place(frame, sample.x, sample.y)).map(around));
    }
    QuotedSign::all(panel, frame).for_each(|one| one.obstacle(&mut obstacles));
    obstacles
}

fn write(sheet: &Sheet, at: Point, text: &str, size: f64, anchor: Anchor, color: Color) {
    if text.is_empty() {
        return;
    }
    sheet.text(at, &Lettering { text, size, anchor, upright: false, color })
}
