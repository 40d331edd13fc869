//! Features of lines: where the top is and how well the grid knows it, where two lines part, how many peaks there are.

use super::absence::Absence;
use super::compare::COVERAGE;
use super::selection::{Allowed, same};
use super::text::{place, with_unit};
use super::view::{Cell, Line, Source, View};
use crate::measure::column_words;
use crate::optimise::{Point, overshoot};
use crate::yaml::At;

/// A place on the abscissa: half the bracket that surely holds it is twice its uncertainty.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Position {
    pub x: f64,
    pub u: f64,
}

/// Two or more lines of one measure, by a column: `stop` with and without.
pub(crate) type Lines = Vec<(Allowed, Line)>;

/// The lines into which `by` splits the rows.
pub(crate) fn lines(view: &View<'_>, source: Source<'_>, of: &str, over: &str, by: &str) -> Result<Lines, Absence> {
    let levels = view.levels(&view.rows(source, Some(by))?, by)?;
    levels
        .into_iter()
        .map(|level| {
            let rows = source.rows.with(by, level.clone());
            let line = view.line(Source { rows: &rows, ..source }, of, over, Some(by))?;
            Ok((level, line))
        })
        .collect()
}

/// The abscissae that all lines share, with the cells of each line there.
pub(crate) fn common(lines: &Lines) -> Result<Vec<(f64, Vec<Cell>)>, Absence> {
    let Some(((_, first), others)) = lines.split_first() else {
        return Err(Absence::NoRow("no line to compare".into()));
    };
    if others.is_empty() {
        return Err(Absence::NoRow(format!("one line of `{}` where two or more are compared", first.of)));
    }
    let at = |line: &Line, x: f64| {
        let near = line.x.partition_point(|&other| other < x && !same(other, x));
        line.x.get(near).is_some_and(|&other| same(other, x)).then(|| line.y[near])
    };
    let shared: Vec<(f64, Vec<Cell>)> = first
        .x
        .iter()
        .zip(&first.y)
        .filter_map(|(&x, &cell)| {
            let mut cells = vec![cell];
            for (_, line) in others {
                cells.push(at(line, x)?);
            }
            Some((x, cells))
        })
        .collect();
    if shared.len() < 2 {
        return Err(Absence::NoRow(format!(
            "the lines share {} points of `{}`; two are needed",
            shared.len(),
            first.over
        )));
    }
    Ok(shared)
}

/// Two of the lines into which a column splits the rows.
pub(crate) struct Pair<'a> {
    pub of: &'a str,
    pub over: &'a str,
    pub by: &'a str,
    /// Level of the line that is said to be ahead, and of the other.
    pub above: &'a str,
    pub below: &'a str,
}

impl Pair<'_> {
    /// That it is two, for a reader.
    pub(crate) fn of_two_lines(&self, at: At<'_>) -> Option<()> {
        if self.above == self.below { at.under("below").wrong("a line is not above itself") } else { Some(()) }
    }

    /// How far the one is above the other, where they share an abscissa.
    pub(crate) fn lead(&self, view: &View<'_>, source: Source<'_>) -> Result<Line, Absence> {
        let all = lines(view, source, self.of, self.over, self.by)?;
        let line = |level: &str| {
            let found = all.iter().find(|(allowed, _)| allowed.is_level(level));
            found.cloned().ok_or_else(|| Absence::NoRow(format!("no line with {} = {level}", self.by)))
        };
        let pair = vec![line(self.above)?, line(self.below)?];
        let (x, y) = common(&pair)?.into_iter().map(|(x, cells)| (x, cells[0].less(&cells[1]))).unzip();
        Ok(Line { x, y, ..pair[0].1.clone() })
    }
}

impl Cell {
    /// The difference to another, with the errors of both.
    pub(crate) fn less(&self, other: &Self) -> Self {
        Self {
            value: self.value - other.value,
            run: libm::hypot(self.run, other.run),
            spread: libm::hypot(self.spread, other.spread),
        }
    }
}

impl Line {
    /// Where the top is. Every point that its own error allows to be the highest counts, and the top lies between their
    /// outer neighbours.
    pub(crate) fn top(&self) -> Result<Position, Absence> {
        let last = self.x.len() - 1;
        if last == 0 {
            return Err(Absence::NoRow(format!("one point of `{}` has no highest", self.of)));
        }
        let best = self.highest();
        let may_be_top = |i: &usize| {
            let (cell, top) = (self.y[*i], self.y[best]);
            cell.value + COVERAGE * libm::hypot(cell.run, top.run) >= top.value
        };
        let first = (0..=best).find(may_be_top).unwrap_or(best);
        let final_ = (best..=last).rev().find(may_be_top).unwrap_or(best);
        let (left, right) = (self.x[first.saturating_sub(1)], self.x[(final_ + 1).min(last)]);
        let x = self.x[best];
        Ok(Position { x, u: (x - left).max(right - x) / 2.0 })
    }

    /// The highest value; how far the curve may rise between the grid's points (the vertex of the parabola through the
    /// highest three) adds to its error.
    pub(crate) fn maximum(&self) -> Cell {
        let best = self.highest();
        let cell = self.y[best];
        let point = |i: usize| Some(Point { x: *self.x.get(i)?, y: self.y.get(i)?.value });
        Cell { run: libm::hypot(cell.run, overshoot(best, point)), ..cell }
    }

    /// The largest fall below what was reached before, and its error.
    pub(crate) fn largest_fall(&self) -> Cell {
        let mut reached = self.y[0];
        let mut largest = Cell { value: 0.0, run: 0.0, spread: 0.0 };
        for &cell in &self.y {
            if cell.value > reached.value {
                reached = cell;
            } else if reached.value - cell.value > largest.value {
                largest =
                    Cell { value: reached.value - cell.value, run: libm::hypot(reached.run, cell.run), spread: 0.0 };
            }
        }
        largest
    }

    /// The first point above a level, and the bracket that holds the onset.
    pub(crate) fn onset(&self, above: f64) -> Result<(usize, Position), Absence> {
        match self.y.iter().position(|cell| cell.value > above) {
            None => {
                let level = with_unit(above, 4, &self.unit);
                Err(Absence::Nowhere(format!("the {} never exceeds {level}", column_words(&self.of))))
            }
            Some(0) => Err(Absence::Nowhere(format!(
                "the {} exceeds {} from the first point on, {}: its onset lies below the sweep",
                column_words(&self.of),
                with_unit(above, 4, &self.unit),
                place(&self.over, self.x[0], 4, &self.over_unit)
            ))),
            Some(i) => Ok((i, Position { x: self.x[i], u: (self.x[i] - self.x[i - 1]) / 2.0 })),
        }
    }

    /// Where the line first crosses a level upwards.
    pub(crate) fn crossing_up(&self, level: f64) -> Option<(usize, Position)> {
        let i = (1..self.x.len()).find(|&i| self.y[i - 1].value < level && self.y[i].value >= level)?;
        let (low, high) = (self.y[i - 1].value, self.y[i].value);
        let width = self.x[i] - self.x[i - 1];
        let x = self.x[i - 1] + width * (level - low) / (high - low);
        Some((i, Position { x, u: width / 2.0 }))
    }

    /// Prominence of each interior peak, with the error of the difference that it is: how far one has to descend from the
    /// peak before the line rises above it, or to the higher of the two feet.
    pub(crate) fn prominences(&self) -> Vec<(f64, Cell)> {
        let value = |i: usize| self.y[i].value;
        let mut found = Vec::new();
        let mut i = 1;
        while i + 1 < self.x.len() {
            // A plateau counts once, at its first point.
            let end = (i..self.x.len()).find(|&j| value(j) != value(i)).unwrap_or(self.x.len());
            if end < self.x.len() && value(i - 1) < value(i) && value(end) < value(i) {
                let foot = |side: &mut dyn Iterator<Item = usize>| {
                    side.take_while(|&j| value(j) <= value(i)).min_by(|&a, &b| value(a).total_cmp(&value(b)))
                };
                let feet = [foot(&mut (0..i).rev()), foot(&mut (end..self.x.len()))];
                if let Some(foot) = feet.into_iter().flatten().max_by(|&a, &b| value(a).total_cmp(&value(b))) {
                    let run = libm::hypot(self.y[i].run, self.y[foot].run);
                    found.push((self.x[i], Cell { value: value(i) - value(foot), run, spread: 0.0 }));
                }
            }
            i = end.max(i + 1);
        }
        found
    }
}
