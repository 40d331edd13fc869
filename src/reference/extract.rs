//! Takes numbers out of tables. Each comes with its own error, to which the grid of the sweep belongs: a top is known to lie
//! between its neighbours, no better.

use super::absence::Absence;
use super::extracted::Extracted;
use super::extraction::{
    Along, AtMaximum, Cells, Crossing, Difference, Direction, End, Extraction, Lead, Meeting, NearestPassage, Parting,
    Quotient, Side,
};
use super::line::{Position, common, lines};
use super::selection::same;
use super::text::{percent, with_unit};
use super::view::{Cell, Line, View};
use crate::measure::column_words;
use crate::table::BASELINE;

impl Extraction {
    /// Takes the number.
    pub(crate) fn take(&self, view: &View<'_>) -> Result<Extracted, Absence> {
        match self {
            Self::Number(x) => Ok(Extracted::exact(*x, String::new())),
            Self::Cell(cells) => only(cells, view),
            Self::Mean(cells) => mean(cells, view),
            Self::Largest(cells) => extreme(cells, view, 1.0),
            Self::Smallest(cells) => extreme(cells, view, -1.0),
            Self::PathMaximum(cells) => path_extreme(cells, view, f64::max),
            Self::PathMinimum(cells) => path_extreme(cells, view, f64::min),
            Self::Maximum(along) => Ok(along.highest(view, along.line(view)?)),
            Self::Minimum(along) => Ok(along.highest(view, along.line(view)?.inverted()).times(-1.0)),
            Self::Argmax(along) => along.place_of_highest(view, along.line(view)?),
            Self::Argmin(along) => along.place_of_highest(view, along.line(view)?.inverted()),
            Self::AtMaximum(word) => word.take(view),
            Self::End(word) => word.take(view),
            Self::Crossing(word) => word.take(view),
            Self::FirstAbove(word) => {
                let line = view.line(word.source(), &word.of, &word.over, None)?;
                Ok(Extracted::place(line.onset(word.level)?.1, line.over_unit))
            }
            Self::Parting(word) => word.take(view),
            Self::Meeting(word) => word.take(view),
            Self::LargestStepBack(word) => {
                let line = view.line(word.source(), &word.of, &word.over, None)?;
                let line = if word.direction == Direction::Increasing { line } else { line.inverted() };
                Ok(Extracted::cell(line.largest_fall(), &line.unit))
            }
            Self::LargestLead(word) => {
                let lead = word.line(view)?;
                Ok(Extracted::cell(lead.maximum(), &lead.unit))
            }
            Self::ArgmaxLead(word) => {
                let lead = word.line(view)?;
                view.note_end(&lead, lead.highest());
                Ok(Extracted::place(lead.top()?, lead.over_unit))
            }
            Self::NearestPassage(word) => word.take(view),
            Self::Interpolated(word) => word.take(view),
            Self::MeanOver(word) => word.mean(view),
            Self::StandardDeviationOver(word) => word.standard_deviation(view),
            Self::Peak(peak) => peak.take(view),
            Self::Ratio(quotient) => quotient.take(view),
            Self::Difference(difference) => difference.take(view),
            Self::Times(times) => Ok(times.of.take(view)?.times(times.factor)),
        }
    }
}

/// The cell of the one row that is meant.
fn only(cells: &Cells, view: &View<'_>) -> Result<Extracted, Absence> {
    let rows = view.rows(cells.source(), None)?;
    let all = view.cells(&rows, &cells.of)?;
    let &[cell] = all.as_slice() else {
        return Err(Absence::Broken(format!("{} rows where one is meant: `where` must say which", rows.count())));
    };
    Ok(Extracted::cell(cell, view.unit(&rows, &cells.of)?))
}

fn mean(cells: &Cells, view: &View<'_>) -> Result<Extracted, Absence> {
    let rows = view.rows(cells.source(), None)?;
    let all = view.cells(&rows, &cells.of)?;
    #[expect(clippy::cast_precision_loss, reason = "row counts are far below 2^53")]
    let n = all.len() as f64;
    let quadrature = |part: fn(&Cell) -> f64| all.iter().map(|c| part(c) * part(c)).sum::<f64>().sqrt() / n;
    Ok(Extracted {
        value: all.iter().map(|cell| cell.value).sum::<f64>() / n,
        run: quadrature(|cell| cell.run),
        spread: quadrature(|cell| cell.spread),
        unit: view.unit(&rows, &cells.of)?.into(),
        scale: None,
    })
}

impl Along {
    fn line(&self, view: &View<'_>) -> Result<Line, Absence> {
        view.line(self.source(), &self.of, &self.over, None)
    }

    /// The highest value of a line along it.
    fn highest(&self, view: &View<'_>, line: Line) -> Extracted {
        view.note_place(self.source(), &self.over, line.x[line.highest()]);
        Extracted::cell(line.maximum(), &line.unit)
    }

    fn place_of_highest(&self, view: &View<'_>, line: Line) -> Result<Extracted, Absence> {
        view.note_place(self.source(), &self.over, line.x[line.highest()]);
        view.note_end(&line, line.highest());
        Ok(Extracted::place(line.top()?, line.over_unit))
    }
}

impl AtMaximum {
    fn take(&self, view: &View<'_>) -> Result<Extracted, Absence> {
        let line = view.line(self.source(), &self.of, &self.over, None)?;
        let other = view.line(self.source(), &self.read, &self.over, None)?;
        let top = line.x[line.highest()];
        view.note_place(self.source(), &self.over, top);
        view.note_end(&line, line.highest());
        let at = other.x.iter().position(|&x| same(x, top));
        let at = at.ok_or_else(|| Absence::NoRow(format!("no `{}` at the maximum", self.read)))?;
        Ok(Extracted::cell(other.y[at], &other.unit))
    }
}

impl End {
    fn take(&self, view: &View<'_>) -> Result<Extracted, Absence> {
        let line = view.line(self.source(), &self.of, &self.over, None)?;
        let at = if self.end == Side::Low { 0 } else { line.x.len() - 1 };
        Ok(Extracted::cell(line.y[at], &line.unit))
    }
}

impl Crossing {
    fn take(&self, view: &View<'_>) -> Result<Extracted, Absence> {
        let line = view.line(self.source(), &self.of, &self.over, None)?;
        let unit = line.unit.clone();
        let (line, level) = match self.direction {
            Direction::Increasing => (line, self.level),
            Direction::Decreasing => (line.inverted(), -self.level),
        };
        let (_, position) = line.crossing_up(level).ok_or_else(|| {
            let (of, level) = (column_words(&self.of), with_unit(self.level, 4, &unit));
            Absence::Nowhere(format!("the {of} does not cross {level}"))
        })?;
        Ok(Extracted::place(position, line.over_unit))
    }
}

impl Lead {
    /// The lead of one line over the other.
    fn line(&self, view: &View<'_>) -> Result<Line, Absence> {
        let lead = self.pair().lead(view, self.source())?;
        view.note_place(self.source(), &self.over, lead.x[lead.highest()]);
        Ok(lead)
    }
}

impl Quotient {
    fn take(&self, view: &View<'_>) -> Result<Extracted, Absence> {
        let (of, to) = (self.of.take(view)?, self.to.take(view)?);
        if of.unit != to.unit {
            return Err(Absence::Broken(format!("a ratio of `{}` to `{}`", of.unit, to.unit)));
        }
        let value = of.value / to.value;
        if !value.is_finite() {
            return Err(Absence::Broken("a ratio to zero".into()));
        }
        let both = |a: f64, b: f64| libm::hypot(a, value * b) / to.value.abs();
        let (run, spread) = (both(of.run, to.run), both(of.spread, to.spread));
        Ok(Extracted { value, run, spread, unit: String::new(), scale: None })
    }
}

impl Difference {
    fn take(&self, view: &View<'_>) -> Result<Extracted, Absence> {
        let (of, less) = (self.of.take(view)?, self.less.take(view)?);
        if of.unit != less.unit {
            return Err(Absence::Broken(format!("a difference of `{}` and `{}`", of.unit, less.unit)));
        }
        let (run, spread) = (libm::hypot(of.run, less.run), libm::hypot(of.spread, less.spread));
        Ok(Extracted { value: of.value - less.value, run, spread, unit: of.unit, scale: None })
    }
}

impl Extraction {
    /// What the tolerances of design parameters leave of a number that stands in one row, if its table tells: 0 otherwise.
    pub(crate) fn left_by_tolerances(&self, view: &View<'_>) -> f64 {
        let beside = |of: &str| format!("{of}_input");
        let left = match self {
            Self::Cell(cells) => view.rows(cells.source(), None).and_then(|rows| view.cells(&rows, &beside(&cells.of))),
            Self::Maximum(along) => view.line(along.source(), &along.of, &along.over, None).and_then(|line| {
                let left = view.line(along.source(), &beside(&along.of), &along.over, None)?;
                let top = line.x[line.highest()];
                Ok(left.x.iter().position(|&x| same(x, top)).map(|at| left.y[at]).into_iter().collect())
            }),
            _ => return 0.0,
        };
        match left.as_deref() {
            Ok([cell]) => cell.value,
            // No such column, or no number there: a motion that does not settle has no derivative.
            _ => 0.0,
        }
    }
}

/// The largest cell of the rows, or the smallest where `sign` is −1.
fn extreme(cells: &Cells, view: &View<'_>, sign: f64) -> Result<Extracted, Absence> {
    let rows = view.rows(cells.source(), None)?;
    let all = view.cells(&rows, &cells.of)?;
    let best = all.into_iter().reduce(|a, b| if sign * b.value > sign * a.value { b } else { a });
    let best = best.ok_or_else(|| Absence::NoRow(format!("no row has a `{}`", cells.of)))?;
    Ok(Extracted::cell(best, view.unit(&rows, &cells.of)?))
}

/// The largest or the smallest sample of a time history: as exact as its samples are dense.
fn path_extreme(cells: &Cells, view: &View<'_>, pick: fn(f64, f64) -> f64) -> Result<Extracted, Absence> {
    let rows = view.rows(cells.source(), None)?;
    let path = view.path(&rows, &cells.of)?;
    let value = path.iter().copied().reduce(pick);
    let value = value.ok_or_else(|| Absence::NoRow(format!("the time history `{}` is empty", cells.of)))?;
    Ok(Extracted::exact(value, view.unit(&rows, &cells.of)?.into()))
}

/// Standard errors by which two means have to differ. A sweep compares them at a hundred points: two would not do.
const CERTAIN: f64 = 3.0;

impl Parting {
    fn take(&self, view: &View<'_>) -> Result<Extracted, Absence> {
        let both = lines(view, self.source(), &self.of, &self.over, &self.by)?;
        if both.len() != 2 {
            return Err(Absence::Broken(format!("{} lines by `{}` where two part", both.len(), self.by)));
        }
        let shared = common(&both)?;
        let apart = |cells: &[Cell]| {
            let (a, b) = (cells[0], cells[1]);
            let noise = CERTAIN * libm::hypot(a.run, b.run);
            (a.value - b.value).abs() - noise > self.fraction * (a.value + b.value).abs() / 2.0
        };
        let fraction = percent(self.fraction);
        let unit = both[0].1.over_unit.clone();
        let stay_apart = |i: usize| shared[i..].iter().take(2).all(|(_, cells)| apart(cells));
        match (0..shared.len()).find(|i| stay_apart(*i)) {
            None => Err(Absence::Nowhere(format!("the lines never part by {fraction}"))),
            Some(0) => {
                Err(Absence::Nowhere(format!("the lines are more than {fraction} apart from the first point on")))
            }
            Some(i) => {
                let (x, before) = (shared[i].0, shared[i - 1].0);
                Ok(Extracted::place(Position { x, u: (x - before) / 2.0 }, unit))
            }
        }
    }
}

impl Meeting {
    fn take(&self, view: &View<'_>) -> Result<Extracted, Absence> {
        let both = lines(view, self.source(), &self.of, &self.over, &self.by)?;
        if both.len() != 2 {
            return Err(Absence::Broken(format!("{} lines by `{}` where two meet", both.len(), self.by)));
        }
        let shared = common(&both)?;
        let lead = |cells: &[Cell]| cells[0].value - cells[1].value;
        let pair = shared.windows(2).find(|pair| lead(&pair[0].1) * lead(&pair[1].1) <= 0.0);
        let Some([(before, left), (after, right)]) = pair else {
            return Err(Absence::Nowhere("the lines never change places".into()));
        };
        let (from, to) = (lead(left), lead(right));
        let share = if from == to { 0.0 } else { from / (from - to) };
        let place = Position { x: before + share * (after - before), u: (after - before) / 2.0 };
        Ok(Extracted::place(place, both[0].1.over_unit.clone()))
    }
}

impl NearestPassage {
    fn take(&self, view: &View<'_>) -> Result<Extracted, Absence> {
        let rows = view.rows(self.source(), None)?;
        let times = view.path(&rows, "time")?;
        // With an input moved that the period depends on, the cycles that are kept lie elsewhere.
        if view.variant != BASELINE
            && let [first, .., last] = times
            && !(*first..=*last).contains(&self.to)
        {
            let [first, last, to] = [*first, *last, self.to].map(|time| with_unit(time, 4, "s"));
            return Err(Absence::NoRow(format!("the time history goes from {first} to {last}, not to {to}")));
        }
        let (of, through) = (view.path(&rows, &self.of)?, view.path(&rows, &self.through)?);
        let side = self.direction.sign();
        let apart: Vec<f64> = of.iter().zip(through).map(|(a, b)| side * (a - b)).collect();
        let passages = apart.windows(2).zip(times.windows(2)).filter(|(apart, _)| apart[0] < 0.0 && apart[1] >= 0.0);
        let instants: Vec<(f64, f64)> = passages
            .map(|(apart, time)| {
                let width = time[1] - time[0];
                (time[0] + width * apart[0] / (apart[0] - apart[1]), width / 2.0)
            })
            .collect();
        let nearest = instants.iter().min_by(|a, b| (a.0 - self.to).abs().total_cmp(&(b.0 - self.to).abs()));
        let &(value, run) = nearest.ok_or_else(|| {
            let [of, through] = [&self.of, &self.through].map(|path| column_words(path));
            Absence::Nowhere(format!("the {of} never passes the {through} that way"))
        })?;
        if let Some(read) = &self.read {
            let path = view.path(&rows, read)?;
            // The interval of samples that holds the instant.
            let after = times.partition_point(|time| *time < value).clamp(1, times.len() - 1);
            let share = (value - times[after - 1]) / (times[after] - times[after - 1]);
            let step = path[after] - path[after - 1];
            let unit = view.unit(&rows, read)?.into();
            return Ok(Extracted {
                value: path[after - 1] + share * step,
                run: step.abs() / 2.0,
                spread: 0.0,
                unit,
                scale: None,
            });
        }
        let between = instants.windows(2).map(|pair| pair[1].0 - pair[0].0).reduce(f64::min);
        let scale = between.or(Some(times[times.len() - 1] - times[0]));
        Ok(Extracted { value, run, spread: 0.0, unit: view.unit(&rows, "time")?.into(), scale })
    }
}
