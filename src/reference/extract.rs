//! Numbers out of a table: one word for each way in which a study quotes a number of its curves.
//!
//! `{argmax: {of: velocity_ratio, over: force_ratio}}` is the force ratio of the largest velocity ratio. Each comes with
//! its own error, to which the grid of the sweep belongs: a top is known to lie between its neighbours, no better.

use serde::{Deserialize, Serialize};

use super::line::{common, lines};
use super::selection::{Selection, same};
use super::text::significant;
use super::view::{Absence, Cell, Source, View};

/// How a number is taken out of a table.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Extraction {
    /// A fixed number, to hold others against.
    Number(f64),
    /// The measure in the one row that is meant.
    Cell(Cells),
    /// Mean of a measure over the rows.
    Mean(Cells),
    /// Largest value along a parameter.
    Maximum(Along),
    /// Smallest value along a parameter.
    Minimum(Along),
    /// The parameter of the largest value.
    Argmax(Along),
    /// The parameter of the smallest value.
    Argmin(Along),
    /// Another measure where this one is largest.
    AtMaximum(AtMaximum),
    /// The measure at the first or last point of a line.
    End(End),
    /// The parameter at which a measure first crosses a level.
    Crossing(Crossing),
    /// The first parameter value at which a measure exceeds a level.
    FirstAbove(FirstAbove),
    /// The first parameter value at which two lines differ by more than a fraction of their mean.
    Parting(Parting),
    /// The largest fall of a rising line, or rise of a falling one: how much it deviates from monotone.
    LargestStepBack(StepBack),
    /// Of the events of a kind in a time history, the time that lies nearest to a given one.
    NearestEvent(NearestEvent),
    /// One number over another.
    Ratio(Box<Quotient>),
    /// A number times a factor.
    Times(Box<Times>),
}

macro_rules! word {
    ($(#[$about:meta])* $name:ident { $($(#[$field_about:meta])* $field:ident: $type:ty,)* }) => {
        $(#[$about])*
        #[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
        #[serde(deny_unknown_fields)]
        pub struct $name {
            /// The measure.
            pub of: String,
            $($(#[$field_about])* pub $field: $type,)*
            /// Conditions beyond the entry's own.
            #[serde(rename = "where", default)]
            pub rows: Selection,
            /// Another experiment's table; the entry's conditions do not hold there.
            #[serde(default)]
            pub table: Option<String>,
        }

        impl $name {
            pub(crate) fn source(&self) -> Source<'_> {
                Source { table: self.table.as_deref(), rows: &self.rows }
            }
        }
    };
}

word! {
    /// A measure in some rows.
    Cells {}
}
word! {
    /// A measure along a parameter.
    Along {
        /// The parameter.
        over: String,
    }
}
word! {
    /// Another measure at the top.
    AtMaximum {
        /// The parameter.
        over: String,
        /// The other measure.
        read: String,
    }
}
word! {
    /// One end of a line.
    End {
        /// The parameter.
        over: String,
        /// Which end.
        end: Side,
    }
}
word! {
    /// Crossing of a level.
    Crossing {
        /// The parameter.
        over: String,
        /// The level.
        level: f64,
        /// Upwards (`increasing`) or downwards.
        direction: Direction,
    }
}
word! {
    /// Onset.
    FirstAbove {
        /// The parameter.
        over: String,
        /// The level to be exceeded.
        above: f64,
    }
}
word! {
    /// Parting of two lines.
    Parting {
        /// The parameter.
        over: String,
        /// The column that tells the two lines apart.
        by: String,
        /// Of their mean.
        fraction: f64,
    }
}
word! {
    /// Deviation from monotone.
    StepBack {
        /// The parameter.
        over: String,
        /// Which way the line should go.
        direction: Direction,
    }
}

/// A time in the time history of the one row that is meant.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct NearestEvent {
    /// Code of the kind of event, in the column `event_kind`.
    pub kind: f64,
    /// The time to be near to, s.
    pub to: f64,
    /// Conditions beyond the entry's own.
    #[serde(rename = "where", default)]
    pub rows: Selection,
}

/// A ratio.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Quotient {
    /// Above the line.
    pub of: Extraction,
    /// Below it.
    pub to: Extraction,
}

/// A multiple.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Times {
    /// The factor.
    pub factor: f64,
    /// Of what.
    pub of: Extraction,
}

/// End of a line.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Side {
    /// The smallest parameter.
    Low,
    /// The largest parameter.
    High,
}

/// Which way.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Direction {
    /// Upwards.
    Increasing,
    /// Downwards.
    Decreasing,
}

/// A number taken out of a table.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Extracted {
    pub value: f64,
    /// Error of the run and of the grid.
    pub run: f64,
    /// Standard deviation of the ensemble where it was read.
    pub spread: f64,
    pub unit: String,
}

impl Extracted {
    fn cell(cell: Cell, unit: &str) -> Self {
        Self { value: cell.value, run: cell.run, spread: cell.spread, unit: unit.into() }
    }

    fn place(position: super::line::Position, unit: String) -> Self {
        Self { value: position.x, run: position.u, spread: 0.0, unit }
    }

    fn times(self, factor: f64) -> Self {
        let size = factor.abs();
        Self { value: self.value * factor, run: self.run * size, spread: self.spread * size, unit: self.unit }
    }
}

impl Extraction {
    /// Takes the number.
    pub(crate) fn take(&self, view: &View<'_>) -> Result<Extracted, Absence> {
        let line = |along: &Along| view.line(along.source(), &along.of, &along.over, None);
        Ok(match self {
            Self::Number(x) => Extracted { value: *x, run: 0.0, spread: 0.0, unit: String::new() },
            Self::Cell(cells) => {
                let rows = view.rows(cells.source(), None)?;
                let all = view.cells(&rows, &cells.of)?;
                let &[cell] = all.as_slice() else {
                    return Err(Absence::Broken(format!(
                        "{} rows where one is meant: `where` must say which",
                        rows.count()
                    )));
                };
                Extracted::cell(cell, view.unit(&rows, &cells.of)?)
            }
            Self::Mean(cells) => {
                let rows = view.rows(cells.source(), None)?;
                let all = view.cells(&rows, &cells.of)?;
                #[expect(clippy::cast_precision_loss, reason = "row counts are far below 2^53")]
                let n = all.len() as f64;
                let quadrature = |part: fn(&Cell) -> f64| all.iter().map(|c| part(c).powi(2)).sum::<f64>().sqrt() / n;
                Extracted {
                    value: all.iter().map(|cell| cell.value).sum::<f64>() / n,
                    run: quadrature(|cell| cell.run),
                    spread: quadrature(|cell| cell.spread),
                    unit: view.unit(&rows, &cells.of)?.into(),
                }
            }
            Self::Maximum(along) => {
                let line = line(along)?;
                Extracted::cell(line.maximum(), &line.unit)
            }
            Self::Minimum(along) => {
                let line = line(along)?.inverted();
                Extracted::cell(line.maximum(), &line.unit).times(-1.0)
            }
            Self::Argmax(along) => {
                let line = line(along)?;
                Extracted::place(line.top()?, line.over_unit)
            }
            Self::Argmin(along) => {
                let line = line(along)?.inverted();
                Extracted::place(line.top()?, line.over_unit)
            }
            Self::AtMaximum(word) => {
                let line = view.line(word.source(), &word.of, &word.over, None)?;
                let other = view.line(word.source(), &word.read, &word.over, None)?;
                let top = line.x[line.highest()];
                let at = other.x.iter().position(|&x| same(x, top));
                let at = at.ok_or_else(|| Absence::NoRow(format!("no `{}` at the maximum", word.read)))?;
                Extracted::cell(other.y[at], &other.unit)
            }
            Self::End(word) => {
                let line = view.line(word.source(), &word.of, &word.over, None)?;
                let at = if word.end == Side::Low { 0 } else { line.x.len() - 1 };
                Extracted::cell(line.y[at], &line.unit)
            }
            Self::Crossing(word) => {
                let line = view.line(word.source(), &word.of, &word.over, None)?;
                let (line, level) = match word.direction {
                    Direction::Increasing => (line, word.level),
                    Direction::Decreasing => (line.inverted(), -word.level),
                };
                let (_, position) = line.crossing_up(level).ok_or_else(|| {
                    Absence::Nowhere(format!("`{}` does not cross {}", word.of, significant(word.level, 4)))
                })?;
                Extracted::place(position, line.over_unit)
            }
            Self::FirstAbove(word) => {
                let line = view.line(word.source(), &word.of, &word.over, None)?;
                Extracted::place(line.onset(word.above)?.1, line.over_unit)
            }
            Self::Parting(word) => word.take(view)?,
            Self::LargestStepBack(word) => {
                let line = view.line(word.source(), &word.of, &word.over, None)?;
                let line = if word.direction == Direction::Increasing { line } else { line.inverted() };
                Extracted::cell(line.largest_fall(), &line.unit)
            }
            Self::NearestEvent(word) => word.take(view)?,
            Self::Ratio(quotient) => {
                let (of, to) = (quotient.of.take(view)?, quotient.to.take(view)?);
                if of.unit != to.unit {
                    return Err(Absence::Broken(format!("a ratio of `{}` to `{}`", of.unit, to.unit)));
                }
                let value = of.value / to.value;
                if !value.is_finite() {
                    return Err(Absence::Broken("a ratio to zero".into()));
                }
                let both = |a: f64, b: f64| a.hypot(value * b) / to.value.abs();
                Extracted { value, run: both(of.run, to.run), spread: both(of.spread, to.spread), unit: String::new() }
            }
            Self::Times(times) => times.of.take(view)?.times(times.factor),
        })
    }

    /// True if every number written into it is finite.
    pub(crate) fn is_sound(&self) -> bool {
        match self {
            Self::Number(x) => x.is_finite(),
            Self::Crossing(word) => word.level.is_finite(),
            Self::FirstAbove(word) => word.above.is_finite(),
            Self::Parting(word) => word.fraction.is_finite() && word.fraction > 0.0,
            Self::NearestEvent(word) => word.kind.is_finite() && word.to.is_finite(),
            Self::Ratio(quotient) => quotient.of.is_sound() && quotient.to.is_sound(),
            Self::Times(times) => times.factor.is_finite() && times.factor != 0.0 && times.of.is_sound(),
            _ => true,
        }
    }

    /// The other experiments whose tables it reads.
    pub(crate) fn tables(&self) -> Vec<&str> {
        let table = match self {
            Self::Number(_) | Self::NearestEvent(_) => None,
            Self::Cell(word) | Self::Mean(word) => word.table.as_deref(),
            Self::Maximum(word) | Self::Minimum(word) | Self::Argmax(word) | Self::Argmin(word) => {
                word.table.as_deref()
            }
            Self::AtMaximum(word) => word.table.as_deref(),
            Self::End(word) => word.table.as_deref(),
            Self::Crossing(word) => word.table.as_deref(),
            Self::FirstAbove(word) => word.table.as_deref(),
            Self::Parting(word) => word.table.as_deref(),
            Self::LargestStepBack(word) => word.table.as_deref(),
            Self::Ratio(quotient) => return [quotient.of.tables(), quotient.to.tables()].concat(),
            Self::Times(times) => return times.of.tables(),
        };
        table.into_iter().collect()
    }
}

impl Parting {
    fn take(&self, view: &View<'_>) -> Result<Extracted, Absence> {
        let both = lines(view, self.source(), &self.of, &self.over, &self.by)?;
        if both.len() != 2 {
            return Err(Absence::Broken(format!("{} lines by `{}` where two part", both.len(), self.by)));
        }
        let shared = common(&both)?;
        let apart = |cells: &[Cell]| {
            let (a, b) = (cells[0].value, cells[1].value);
            (a - b).abs() > self.fraction * (a + b).abs() / 2.0
        };
        let fraction = super::text::percent(self.fraction);
        let unit = both[0].1.over_unit.clone();
        match shared.iter().position(|(_, cells)| apart(cells)) {
            None => Err(Absence::Nowhere(format!("the lines never part by {fraction}"))),
            Some(0) => {
                Err(Absence::Nowhere(format!("the lines are more than {fraction} apart from the first point on")))
            }
            Some(i) => {
                let (x, before) = (shared[i].0, shared[i - 1].0);
                Ok(Extracted { value: x, run: (x - before) / 2.0, spread: 0.0, unit })
            }
        }
    }
}

impl NearestEvent {
    fn take(&self, view: &View<'_>) -> Result<Extracted, Absence> {
        let rows = view.rows(Source { table: None, rows: &self.rows }, None)?;
        let (times, kinds) = (view.path(&rows, "event_time")?, view.path(&rows, "event_kind")?);
        let nearest = times
            .iter()
            .zip(kinds)
            .filter(|(_, kind)| **kind == self.kind)
            .map(|(&time, _)| time)
            .min_by(|a, b| (a - self.to).abs().total_cmp(&(b - self.to).abs()));
        let value = nearest.ok_or_else(|| Absence::Nowhere("the time history has no event of that kind".into()))?;
        Ok(Extracted { value, run: 0.0, spread: 0.0, unit: view.unit(&rows, "event_time")?.into() })
    }
}
