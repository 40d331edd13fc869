//! Strips below a frame, one for each line: which kind of motion its points belong to, in few classes.

use super::attributes::Attributes;
use super::axis::Axis;
use super::canvas::{Pen, Sheet};
use super::error::FigureError;
use super::geometry::{Point, Rect};
use super::group::Group;
use super::line::Curve;
use super::source::Source;
use super::style::{GREY, GRID, KindOfMotion, Look, SPACE, TICK_TEXT};
use crate::dynamics::MotionKind;
use crate::experiment;
use crate::measure::Measure;
use crate::table::Data;
use crate::text::words;

/// Between the lines of a hatching.
const HATCH: f64 = 12.0;
/// Height of a strip.
const HEIGHT: f64 = 24.0;
/// Between the frame and the first, and from one to the next.
const APART: f64 = 6.0;
/// Length of the piece of line that says whose strip it is.
const SAMPLE: f64 = 54.0;

/// The strip of a line.
pub(super) struct Strip {
    /// That of the line, where there are several.
    look: Option<Look>,
    /// Place on the x axis, and kind of motion, in ascending order.
    points: Vec<(f64, MotionKind)>,
}

/// The strips of a panel, in the order of its lines; none unless it asks for them.
pub(super) fn strips(
    source: Source<'_>,
    panel: &experiment::Panel,
    curves: &[Curve],
) -> Result<Vec<Strip>, FigureError> {
    if panel.strip.is_none() {
        return Ok(Vec::new());
    }
    let by = panel.by.iter().map(|name| source.column(name)).collect::<Result<Vec<_>, _>>()?;
    let (x, kinds) = (source.column(&panel.x.column)?, source.column(&words::of_key(&Measure::Motion))?);
    let Data::Text(kinds) = &kinds.data else { return Ok(Vec::new()) };
    let groups = Group::split(source.table.rows(), &by);
    let strip = |(at, group): (usize, &Group)| {
        let point = |&row: &usize| {
            let at = x.data.number(row).filter(|at| at.is_finite())?;
            Some((at, kinds.get(row)?.parse().ok()?))
        };
        let mut points: Vec<(f64, MotionKind)> = group.rows.iter().filter_map(point).collect();
        points.sort_by(|a, b| a.0.total_cmp(&b.0));
        let line = curves.iter().find(|curve| groups.len() > 1 && curve.group == at);
        Strip { look: line.map(|line| line.look), points }
    };
    Ok(groups.iter().enumerate().map(strip).filter(|strip| !strip.points.is_empty()).collect())
}

/// The classes that strips show, in their order.
pub(super) fn classes(strips: &[Strip], along: &experiment::Axis) -> Vec<KindOfMotion> {
    let points = strips.iter().flat_map(|strip| &strip.points).filter(|(x, _)| along.shows(*x));
    let seen: Vec<_> = points.map(|(_, kind)| class(*kind)).collect();
    KindOfMotion::ALL.into_iter().filter(|class| seen.contains(class)).collect()
}

/// Height that strips take below the frame.
pub(super) fn height(strips: &[Strip]) -> f64 {
    first(strips) + (HEIGHT + APART) * u32::try_from(strips.len()).map_or(0.0, f64::from)
}

/// Between the frame and the first strip: a piece of line before it keeps clear of the lowest number of the y axis.
fn first(strips: &[Strip]) -> f64 {
    if strips.iter().any(|strip| strip.look.is_some()) { TICK_TEXT / 2.0 - APART } else { 0.0 }
}

/// Draws a cell in the colours of a kind of motion; what has not settled is of no kind, and hatched.
pub(super) fn cell(sheet: &Sheet, place: &Rect, kind: KindOfMotion) {
    sheet.cell(place, kind.color());
    if kind != KindOfMotion::NotSettled {
        return;
    }
    let height = place.height();
    let mut strokes = Vec::new();
    let mut foot = place.left - height + HATCH;
    while foot < place.right {
        let (low, high) = ((place.left - foot).max(0.0), (place.right - foot).min(height));
        strokes.push([low, high].map(|along| Point { x: foot + along, y: place.bottom - along }));
        foot += HATCH;
    }
    sheet.strokes(&strokes, Pen::solid(GREY, GRID));
}

/// The class that a kind of motion is drawn as.
fn class(kind: MotionKind) -> KindOfMotion {
    match kind {
        MotionKind::AtRest => KindOfMotion::AtRest,
        MotionKind::Periodic { periods: 1, contacts: 1 } | MotionKind::Sticking { periods: 1, contacts: 1 } => {
            KindOfMotion::OneToOne
        }
        MotionKind::Periodic { .. } | MotionKind::Sticking { .. } | MotionKind::CompletedChatter { .. } => {
            KindOfMotion::OtherPeriodic
        }
        MotionKind::QuasiPeriodic => KindOfMotion::QuasiPeriodic,
        MotionKind::Chaotic => KindOfMotion::Chaotic,
        MotionKind::NotSettled => KindOfMotion::NotSettled,
    }
}

/// Draws the strips, each point's colour reaching halfway to its neighbours.
pub(super) fn draw(sheet: &Sheet, x: &Axis, strips: &[Strip], frame: &Rect) {
    let mut top = frame.bottom + APART + first(strips);
    for strip in strips {
        if let Some(Look { color, width, dash, .. }) = strip.look {
            let at = Point { x: frame.left - SPACE, y: top + HEIGHT / 2.0 };
            sheet.line(&[Point { x: at.x - SAMPLE, ..at }, at], Pen { color, width, dash });
        }
        let places: Vec<(f64, MotionKind)> =
            strip.points.iter().filter_map(|(at, kind)| Some((x.share(*at)?, *kind))).collect();
        let halfway = |i: usize, j: usize| (places[i].0 + places[j].0) / 2.0;
        let mut from = 0;
        while from < places.len() {
            let kind = places[from].1;
            let count = places[from..].iter().take_while(|(_, other)| *other == kind).count();
            let next = from + count;
            let left = if from == 0 { places[0].0 } else { halfway(from - 1, from) };
            let right = if next == places.len() { places[next - 1].0 } else { halfway(next - 1, next) };
            from = next;
            if right < 0.0 || left > 1.0 {
                continue;
            }
            let [left, right] = [left, right].map(|share| frame.at(share.clamp(0.0, 1.0), 0.0).x);
            let place = Rect { left, top, right: right.max(left + 2.0), bottom: top + HEIGHT };
            sheet.group(&Attributes::note(&kind.to_string()), || cell(sheet, &place, class(kind)));
        }
        top += HEIGHT + APART;
    }
}
