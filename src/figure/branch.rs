//! Lines along branches: in the order of the rows, solid where the motion is stable, dashed where it is not, with a marker at each
//! special point.

use crate::dynamics::Special;
use crate::experiment::{self, BranchColumn, Joined, Stability};
use crate::table::{Column, Data};

use super::error::FigureError;
use super::group::number;
use super::line::{Sample, Source};

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
        let at = |row: usize| Some(Sample::bare(number(x, row)?, number(y, row)?));
        let mut samples = Vec::new();
        for pair in rows.windows(2) {
            let (here, next) = (pair[0], pair[1]);
            let is_stable = self.is_stable(here) && self.is_stable(next);
            let joined = number(self.branch, here) == number(self.branch, next);
            let (true, Some(from), Some(to)) =
                (joined && is_stable == (stability == Stability::Stable), at(here), at(next))
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
            let (x, y) = (number(x, row)?, number(y, row)?);
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
