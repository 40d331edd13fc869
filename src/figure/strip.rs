//! Strips below a frame, one for each line: which kind of motion its points belong to, in few classes.

use super::attributes::Attributes;
use super::canvas::{Pen, Sheet};
use super::error::FigureError;
use super::geometry::{Point, Rect};
use super::group::{Group, number};
use super::line::{Curve, Source};
use super::panel::Panel;
use super::style::{KindOfMotion, Look, SPACE};
use crate::dynamics::MotionKind;
use crate::experiment;
use crate::measure::Measure;
use crate::table::Data;
use crate::text::words;

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
            let at = number(x, row).filter(|at| at.is_finite())?;
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
pub(super) fn classes(strips: &[Strip]) -> Vec<KindOfMotion> {
    let seen: Vec<_> = strips.iter().flat_map(|strip| &strip.points).map(|(_, kind)| class(*kind)).collect();
    KindOfMotion::ALL.into_iter().filter(|class| seen.contains(class)).collect()
}

/// Height that strips take below the frame.
pub(super) fn height(strips: &[Strip]) -> f64 {
    (HEIGHT + APART) * u32::try_from(strips.len()).map_or(0.0, f64::from)
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
pub(super) fn draw(sheet: &Sheet, panel: &Panel<'_>, frame: &Rect) {
    let mut top = frame.bottom + APART;
    for strip in &panel.strips {
        if let Some(Look { color, width, dash, .. }) = strip.look {
            let at = Point { x: frame.left - SPACE, y: top + HEIGHT / 2.0 };
            sheet.line(&[Point { x: at.x - SAMPLE, ..at }, at], Pen { color, width, dash });
        }
        let places: Vec<(f64, MotionKind)> =
            strip.points.iter().filter_map(|(x, kind)| Some((panel.x.share(*x)?, *kind))).collect();
        let halfway = |i: usize, j: usize| (places[i].0 + places[j].0) / 2.0;
        let mut from = 0;
        while from < places.len() {
            let kind = places[from].1;
            let count = places[from..].iter().take_while(|(_, other)| *other == kind).count();
            let next = from + count;
            let left = if from == 0 { places[0].0 } else { halfway(from - 1, from) };
            let right = if next == places.len() { places[next - 1].0 } else { halfway(next - 1, next) };
            let [left, right] = [left, right].map(|share| frame.at(share.clamp(0.0, 1.0), 0.0).x);
            let place = Rect { left, top, right: right.max(left + 2.0), bottom: top + HEIGHT };
            sheet.group(&Attributes::note(&kind.to_string()), || sheet.cell(&place, class(kind).color()));
            from = next;
        }
        top += HEIGHT + APART;
    }
}
