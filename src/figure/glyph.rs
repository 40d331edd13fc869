//! Signs of mechanical drawings: springs, dashpots, supports, arrows.

use super::canvas::{Pen, Sheet};
use super::geometry::{Point, Rect};
use super::style::{Color, INK, THIN_CURVE};

const PEN: Pen = Pen { color: INK, width: THIN_CURVE, dash: &[] };

/// The point so far along and beside the stretch from `a` to `b`, in pixels.
fn beside(a: Point, b: Point, along: f64, aside: f64) -> Point {
    let (dx, dy) = (b.x - a.x, b.y - a.y);
    let length = libm::hypot(dx, dy).max(f64::MIN_POSITIVE);
    Point { x: a.x + (along * dx - aside * dy) / length, y: a.y + (along * dy + aside * dx) / length }
}

fn length(a: Point, b: Point) -> f64 {
    libm::hypot(b.x - a.x, b.y - a.y)
}

/// A zigzag.
pub(super) fn spring(sheet: &Sheet, a: Point, b: Point) {
    let long = length(a, b);
    let turn =
        |i: u8| beside(a, b, (0.2 + 0.6 * f64::from(i) / 8.0) * long, if i.is_multiple_of(2) { 16.0 } else { -16.0 });
    let points: Vec<Point> = [a, beside(a, b, 0.15 * long, 0.0)]
        .into_iter()
        .chain((0..=8).map(turn))
        .chain([beside(a, b, 0.85 * long, 0.0), b])
        .collect();
    sheet.line(&points, PEN);
}

/// A piston in a cup.
pub(super) fn dashpot(sheet: &Sheet, a: Point, b: Point) {
    let long = length(a, b);
    let at = |along: f64, aside: f64| beside(a, b, along * long, aside);
    sheet.line(&[a, at(0.5, 0.0)], PEN);
    sheet.line(&[at(0.5, -12.0), at(0.5, 12.0)], PEN);
    sheet.line(&[at(0.3, -18.0), at(0.7, -18.0), at(0.7, 18.0), at(0.3, 18.0)], PEN);
    sheet.line(&[at(0.7, 0.0), b], PEN);
}

/// Ground: hatched, with a line on the side that carries.
pub(super) fn hatch(sheet: &Sheet, place: &Rect) {
    const EVERY: f64 = 18.0;
    let upright = place.height() > place.width();
    let long = place.height().max(place.width());
    let mut along = 0.0;
    while along + EVERY <= long {
        let ends = if upright {
            [Point { x: place.left, y: place.top + along + EVERY }, Point { x: place.right, y: place.top + along }]
        } else {
            [Point { x: place.left + along, y: place.bottom }, Point { x: place.left + along + EVERY, y: place.top }]
        };
        sheet.line(&ends, PEN);
        along += EVERY;
    }
    let edge = if upright {
        [Point { x: place.right, y: place.top }, Point { x: place.right, y: place.bottom }]
    } else {
        [Point { x: place.left, y: place.top }, Point { x: place.right, y: place.top }]
    };
    sheet.line(&edge, Pen { width: 2.0 * THIN_CURVE, ..PEN });
}

/// From its tail to its tip.
pub(super) fn arrow(sheet: &Sheet, tail: Point, tip: Point, color: Color) {
    let long = length(tail, tip);
    let neck = beside(tail, tip, long - 20.0, 0.0);
    sheet.line(&[tail, neck], Pen::solid(color, 2.0 * THIN_CURVE));
    sheet.fill(&[tip, beside(tail, tip, long - 24.0, 12.0), beside(tail, tip, long - 24.0, -12.0)], color, 1.0);
}
