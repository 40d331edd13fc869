//! Lines along branches: in the order of the rows, solid where the motion is stable, dashed where it is not, with a marker at each
//! special point.

use crate::dynamics::Special;
use crate::experiment::{self, BranchColumn, Joined, Stability};
use crate::table::{Column, Data};

use super::error::FigureError;
use super::geometry::{Point, Rect};
use super::sample::Sample;
use super::source::Source;
use super::style::MARKER;

/// What branches are drawn by.
pub(super) struct Branches<'a> {
    branch: &'a Column,
    stability: &'a Column,
}

impl<'a> Branches<'a> {
    /// `None` for a panel whose points are joined in another way.
    pub(super) fn of(source: Source<'a>, panel: &experiment::Panel) -> Result<Option<Self>, FigureError> {
        match panel.joined {
            Joined::ByX => Ok(None),
            Joined::AlongBranches => {
                let column = |column: BranchColumn| source.column(column.name());
                Ok(Some(Self { branch: column(BranchColumn::Branch)?, stability: column(BranchColumn::Stability)? }))
            }
        }
    }

    fn is_stable(&self, row: usize) -> bool {
        word(self.stability, row) == Some(Stability::Stable.word())
    }

    /// The stretches of these rows' lines that are stable, or those that are not: stable is what lies between two stable points.
    pub(super) fn samples(&self, x: &Column, y: &Column, rows: &[usize], stability: Stability) -> Vec<Sample> {
        let at = |row: usize| Some(Sample::bare(x.data.number(row)?, y.data.number(row)?));
        let mut samples = Vec::new();
        let is_on = |a: usize, b: usize| self.branch.data.number(a) == self.branch.data.number(b);
        for part in rows.chunk_by(|a, b| is_on(*a, *b)) {
            // A branch of one point is a point.
            if let [alone] = *part
                && self.is_stable(alone) == (stability == Stability::Stable)
            {
                samples.extend((!samples.is_empty()).then(Sample::gap).into_iter().chain(at(alone)));
            }
        }
        for pair in rows.windows(2) {
            let (here, next) = (pair[0], pair[1]);
            let is_stable = self.is_stable(here) && self.is_stable(next);
            let (true, Some(from), Some(to)) =
                (is_on(here, next) && is_stable == (stability == Stability::Stable), at(here), at(next))
            else {
                continue;
            };
            if samples.last() != Some(&from) {
                if !samples.is_empty() {
                    samples.push(Sample::gap());
                }
                samples.push(from);
            }
            samples.push(to);
        }
        samples
    }
}

/// A special point of a branch.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct SpecialPoint {
    pub x: f64,
    pub y: f64,
    pub kind: Special,
}

/// The sign of a special point on a sheet.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Sign {
    pub kind: Special,
    /// The point that it stands for.
    pub of: Point,
    /// Where it stands: at the point, or beside the signs that are there.
    pub at: Point,
}

/// Signs of points in a frame. Of those that would cover each other one of a kind is enough, and those of other kinds stand in a column
/// above or below it; none covers a branch that is a point itself, `alone`.
pub(super) fn signs(points: impl Iterator<Item = (Point, Special)>, alone: &[Point], frame: &Rect) -> Vec<Sign> {
    const APART: f64 = 2.0 * MARKER;
    const ROW: f64 = 2.6 * MARKER;
    let cover = |a: Point, b: Point| (a.x - b.x).abs() < APART && (a.y - b.y).abs() < APART;
    let mut signs: Vec<Sign> = Vec::new();
    for (of, kind) in points {
        if signs.iter().any(|sign| sign.kind == kind && cover(sign.of, of)) {
            continue;
        }
        let column = [0.0, -1.0, -2.0, -3.0, -4.0, 1.0, 2.0, 3.0, 4.0].map(|row| Point { y: of.y + row * ROW, ..of });
        let is_free = |at: &&Point| {
            let within = **at == of || (at.y > frame.top + MARKER && at.y < frame.bottom - MARKER);
            within && signs.iter().map(|sign| &sign.at).chain(alone).all(|taken| !cover(*taken, **at))
        };
        let at = column.iter().find(is_free).copied().unwrap_or(of);
        signs.push(Sign { kind, of, at });
    }
    signs
}

/// The special points of a panel.
pub(super) fn special_points(source: Source<'_>, panel: &experiment::Panel) -> Result<Vec<SpecialPoint>, FigureError> {
    if panel.joined == Joined::ByX {
        return Ok(Vec::new());
    }
    let (x, kinds) = (source.column(&panel.x.column)?, source.column(BranchColumn::SpecialPoint.name())?);
    let mut points = Vec::new();
    for axis in &panel.y {
        let y = source.column(&axis.column)?;
        points.extend((0..source.table.rows()).filter_map(|row| {
            let kind = Special::ALL.into_iter().find(|kind| Some(kind.word()) == word(kinds, row))?;
            let (x, y) = (x.data.number(row)?, y.data.number(row)?);
            (x.is_finite() && y.is_finite()).then_some(SpecialPoint { x, y, kind })
        }));
    }
    Ok(points)
}

fn word(column: &Column, row: usize) -> Option<&str> {
    match &column.data {
        Data::Text(cells) => cells.get(row).map(String::as_str),
        _ => None,
    }
}
