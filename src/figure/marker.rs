//! Markers of curves, and the signs of numbers that the study quotes: an open diamond, and a bar of what is uncertain of it.

use std::f64::consts::FRAC_PI_4;

use super::canvas::{Pen, Sheet};
use super::geometry::Point;
use super::style::{CURVE, GUIDE, INK, Look, MARKER, Marker, PAPER, QUOTED};

/// Dash of what stands for a missing coordinate.
pub(super) const DASH: &[f64] = &[16.0, 8.0];

/// A curve's marker.
pub(super) fn draw(sheet: &Sheet, at: Point, look: Look) {
    let corner = |dx: f64, dy: f64| Point { x: at.x + dx * MARKER, y: at.y + dy * MARKER };
    match look.marker {
        Marker::Circle => sheet.disc(at, MARKER, look.color),
        Marker::Square => {
            let corners = [corner(-0.9, -0.9), corner(0.9, -0.9), corner(0.9, 0.9), corner(-0.9, 0.9)];
            sheet.fill(&corners, look.color, 1.0)
        }
        Marker::Up => sheet.fill(&[corner(0.0, -1.2), corner(1.1, 0.8), corner(-1.1, 0.8)], look.color, 1.0),
        Marker::Down => sheet.fill(&[corner(0.0, 1.2), corner(1.1, -0.8), corner(-1.1, -0.8)], look.color, 1.0),
        Marker::Diamond => {
            let corners = [corner(0.0, -1.3), corner(1.1, 0.0), corner(0.0, 1.3), corner(-1.1, 0.0)];
            sheet.fill(&corners, look.color, 1.0)
        }
        Marker::Cross | Marker::Saltire => {
            let turn = if look.marker == Marker::Cross { 0.0 } else { FRAC_PI_4 };
            let [sine, cosine] = [libm::sin(turn), libm::cos(turn)];
            let (long, wide) = (1.1, 0.35);
            let quarter = [[-wide, -long], [wide, -long], [wide, -wide]];
            let turned = |quarters: usize| quarter.map(|at| (0..quarters).fold(at, |[x, y], _| [-y, x]));
            let corners: Vec<Point> =
                (0..4).flat_map(turned).map(|[x, y]| corner(cosine * x - sine * y, sine * x + cosine * y)).collect();
            sheet.fill(&corners, look.color, 1.0)
        }
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

/// A bar with both its ends.
pub(super) fn bar(sheet: &Sheet, ends: [Point; 2]) {
    sheet.line(&ends, Pen::solid(INK, GUIDE));
    ends.into_iter().for_each(|end| cap(sheet, end, ends[0].x == ends[1].x));
}

/// The end of a bar.
pub(super) fn cap(sheet: &Sheet, end: Point, is_upright: bool) {
    let reach = QUOTED / 2.0;
    let ends = if is_upright {
        [-reach, reach].map(|by| Point { x: end.x + by, ..end })
    } else {
        [-reach, reach].map(|by| Point { y: end.y + by, ..end })
    };
    sheet.line(&ends, Pen::solid(INK, GUIDE));
}

/// Where a bar goes on beyond the frame: the head of an arrow at the end that is seen, away from the other one.
pub(super) fn arrow(sheet: &Sheet, end: Point, other: Point) {
    let (dx, dy) = (end.x - other.x, end.y - other.y);
    let length = libm::hypot(dx, dy);
    if length > QUOTED {
        let (along, across) = (QUOTED / length, 0.5 * QUOTED / length);
        let foot = Point { x: end.x - along * dx, y: end.y - along * dy };
        let corner = |side: f64| Point { x: foot.x - side * across * dy, y: foot.y + side * across * dx };
        sheet.fill(&[end, corner(1.0), corner(-1.0)], INK, 1.0);
    }
}
