//! Numbers of a whole stretch of a line: its mean and its standard deviation along the parameter, and its value between
//! two points. The points need not be even: each stretch between two of them counts by its length.

use super::absence::Absence;
use super::extracted::Extracted;
use super::mapping::word;
use super::name::{Column, in_unit_of};
use super::printed::Printed;
use super::selection::same;
use super::text::with_unit;
use super::view::{Cell, Line, View};
use crate::yaml::At;

word! {
    "a stretch" Stretch, in_order {
        of: Column = required("The measure", Column::read),
        over: Column = required("The parameter", Column::read),
        from: Option<f64> = optional("From here on; from the first point if absent", in_unit_of(over.as_ref())),
        to: Option<f64> = optional("Up to here; to the last point if absent", in_unit_of(over.as_ref())),
    }
}
word! {
    "a number between points" Interpolated {
        of: Column = required("The measure", Column::read),
        over: Column = required("The parameter", Column::read),
        at: Printed =
            required("Where, as printed: half a unit of the last digit is open, and what it does to the measure adds to its error", Printed::read),
    }
}

impl Stretch {
    fn in_order(&self, at: At<'_>) -> Option<()> {
        match self.from.zip(self.to) {
            Some((from, to)) if from >= to => at.under("to").wrong("a stretch of nothing: `to` is not above `from`"),
            _ => Some(()),
        }
    }

    /// ∫ y dx over the length.
    pub(crate) fn mean(&self, view: &View<'_>) -> Result<Extracted, Absence> {
        self.take(view, |line| mean_of(line, |a, b| (a + b) / 2.0))
    }

    /// √ of the mean of (y − mean)² of the points, each of which counts by the stretch around it: on an even grid what a program gives
    /// for the list of them.
    pub(crate) fn standard_deviation(&self, view: &View<'_>) -> Result<Extracted, Absence> {
        self.take(view, |line| {
            let mean = mean_of(line, |a, b| (a + b) / 2.0);
            let square = |y: f64| (y - mean) * (y - mean);
            mean_of(line, |a, b| (square(a) + square(b)) / 2.0).sqrt()
        })
    }

    /// What leaving out every other point changes is twice the grid's uncertainty; the points' own errors are taken as one.
    fn take(&self, view: &View<'_>, of: impl Fn(&Line) -> f64) -> Result<Extracted, Absence> {
        let whole = self.cut(&view.line(self.source(), &self.of, &self.over, None)?)?;
        let value = of(&whole);
        let last = whole.x.len() - 1;
        let half: Vec<usize> = (0..=last).filter(|i| i % 2 == 0 || *i == last).collect();
        let coarse = Line {
            x: half.iter().map(|&i| whole.x[i]).collect(),
            y: half.iter().map(|&i| whole.y[i]).collect(),
            ..whole.clone()
        };
        let grid = (of(&coarse) - value).abs() / 2.0;
        let part = |part: fn(&Cell) -> f64| {
            let of_line = Line { y: whole.y.iter().map(|c| Cell { value: part(c), ..*c }).collect(), ..whole.clone() };
            mean_of(&of_line, |a, b| (a + b) / 2.0)
        };
        let run = libm::hypot(grid, part(|cell| cell.run));
        Ok(Extracted { value, run, spread: part(|cell| cell.spread), unit: whole.unit.clone(), scale: None })
    }

    /// The line between the ends, which it must reach.
    fn cut(&self, line: &Line) -> Result<Line, Absence> {
        let (first, last) = (line.x[0], line.x[line.x.len() - 1]);
        let (from, to) = (self.from.unwrap_or(first), self.to.unwrap_or(last));
        let short = |end: f64| {
            Absence::Broken(format!(
                "`{}` goes from {} to {}, not to {}",
                self.over,
                with_unit(first, 4, &line.over_unit),
                with_unit(last, 4, &line.over_unit),
                with_unit(end, 4, &line.over_unit)
            ))
        };
        for end in [from, to] {
            if (end < first && !same(end, first)) || (end > last && !same(end, last)) {
                return Err(short(end));
            }
        }
        let within = |x: f64| x > from && x < to && !same(x, from) && !same(x, to);
        let inner = line.x.iter().zip(&line.y).filter(|(x, _)| within(**x)).map(|(x, cell)| (*x, *cell));
        let ends = [from, to].map(|end| (end, straight(line, end)));
        let points: Vec<(f64, Cell)> = std::iter::once(ends[0]).chain(inner).chain([ends[1]]).collect();
        if points[0].0 >= points[points.len() - 1].0 {
            return Err(Absence::NoRow(format!("one point of `{}` is no stretch", self.over)));
        }
        let (x, y) = points.into_iter().unzip();
        Ok(Line { x, y, ..line.clone() })
    }
}

impl Interpolated {
    pub(crate) fn take(&self, view: &View<'_>) -> Result<Extracted, Absence> {
        let line = view.line(self.source(), &self.of, &self.over, None)?;
        let (at, half_unit) = self.at.converted_to(&line.over_unit).ok_or_else(|| {
            Absence::Broken(format!("`{}` is no `{}` in `{}`", self.at.text(), self.over, line.over_unit))
        })?;
        let (first, last) = (line.x[0], line.x[line.x.len() - 1]);
        if at < first && !same(at, first) || at > last && !same(at, last) {
            return Err(Absence::Broken(format!(
                "`{}` goes from {} to {}, past {}",
                self.over,
                with_unit(first, 4, &line.over_unit),
                with_unit(last, 4, &line.over_unit),
                self.at.text()
            )));
        }
        let cell = straight(&line, at);
        let value = curved(&line, at);
        let reach = |end: f64| curved(&line, end.clamp(first, last));
        let place = (reach(at + half_unit) - reach(at - half_unit)).abs() / 2.0;
        let grid = (value - cell.value).abs() / 2.0;
        let run = libm::hypot(libm::hypot(cell.run, grid), place);
        Ok(Extracted { value, run, spread: cell.spread, unit: line.unit.clone(), scale: None })
    }
}

fn mean_of(line: &Line, between: impl Fn(f64, f64) -> f64) -> f64 {
    let stretches = line.x.windows(2).zip(line.y.windows(2));
    let sum: f64 = stretches.map(|(x, y)| (x[1] - x[0]) * between(y[0].value, y[1].value)).sum();
    sum / (line.x[line.x.len() - 1] - line.x[0])
}

/// The index of the point before `x`, so that another one follows; 0 on a line of one point.
fn before(line: &Line, x: f64) -> usize {
    line.x.partition_point(|&point| point <= x).saturating_sub(1).min(line.x.len().saturating_sub(2))
}

/// On the straight line between two points.
fn straight(line: &Line, x: f64) -> Cell {
    let i = before(line, x);
    let Some(next) = line.y.get(i + 1) else { return line.y[i] };
    let share = (x - line.x[i]) / (line.x[i + 1] - line.x[i]);
    let mix = |a: f64, b: f64| a + share * (b - a);
    let here = line.y[i];
    Cell { value: mix(here.value, next.value), run: mix(here.run, next.run), spread: mix(here.spread, next.spread) }
}

/// On the polynomial through the four points around, fewer near an end.
fn curved(line: &Line, x: f64) -> f64 {
    let i = before(line, x);
    let around = i.saturating_sub(1)..(i + 3).min(line.x.len());
    around
        .clone()
        .map(|j| {
            let weight: f64 =
                around.clone().filter(|k| *k != j).map(|k| (x - line.x[k]) / (line.x[j] - line.x[k])).product();
            weight * line.y[j].value
        })
        .sum()
}
