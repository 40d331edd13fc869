//! What an entry sees of the tables: the rows it means, as cells with their own errors, as lines and as time histories.
//!
//! Every cell that is looked at is noted, so that the self-test can damage exactly those. What cannot be read (no table,
//! no column, no row, NaN, a failed run) is an [`Absence`], never a number.

use std::cell::RefCell;
use std::collections::{BTreeMap, BTreeSet};

use super::selection::{Allowed, Selection, same};
use super::text::significant;
use crate::table::{Column, Data, Table};

/// The variant without any assumption moved.
pub(crate) const BASELINE: &str = "baseline";
/// The solver that is meant where an entry names none.
const DEFAULT_SOLVER: &str = "event_driven";

/// The state in which the table of an experiment is.
#[derive(Debug, Clone, PartialEq)]
pub enum TableState<'a> {
    /// Up to date.
    Present(&'a Table),
    /// There is one, of another meaning of the experiment, its assumptions or the solver.
    Stale,
    /// The experiment failed as a whole, for this reason.
    Failed(String),
    /// There is none.
    NotRun,
}

/// Tables by experiment; one that is not listed has not been run.
pub type Tables<'a> = BTreeMap<String, TableState<'a>>;

/// Why there is no number.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) enum Absence {
    /// No row is meant by the conditions.
    NoRow(String),
    /// The rows are there, what they should hold is not: no table, no column, NaN, failed.
    Broken(String),
    /// All is there, but what the entry speaks of does not happen: no crossing, no parting.
    Nowhere(String),
}

impl Absence {
    pub(crate) fn reason(&self) -> &str {
        match self {
            Self::NoRow(reason) | Self::Broken(reason) | Self::Nowhere(reason) => reason,
        }
    }
}

/// What a cell was read as.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum Role {
    /// A condition on it chose the rows.
    Filter,
    /// An abscissa.
    Coordinate,
    /// A measure.
    Value,
    /// A time history.
    Path,
}

/// A cell of the entry's own table that was looked at.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) struct Read {
    pub column: usize,
    pub role: Role,
    pub row: usize,
}

pub(crate) type Reads = RefCell<BTreeSet<Read>>;

/// Which rows of which table: an absent table is the entry's own.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Source<'s> {
    pub table: Option<&'s str>,
    pub rows: &'s Selection,
}

/// A measured number with its own errors.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Cell {
    pub value: f64,
    /// The run's own error; in chaotic points no less than the standard error of the ensemble's mean.
    pub run: f64,
    /// Standard deviation of the ensemble.
    pub spread: f64,
}

/// A measure along a parameter: abscissae finite and increasing, values finite.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Line {
    pub over: String,
    pub over_unit: String,
    pub of: String,
    pub unit: String,
    pub x: Vec<f64>,
    pub y: Vec<Cell>,
}

/// The rows that an entry means.
pub(crate) struct Rows<'a> {
    table: &'a Table,
    at_home: bool,
    indices: Vec<usize>,
}

/// One entry's view: its own table, one variant of the assumptions, its conditions.
#[derive(Clone)]
pub(crate) struct View<'a> {
    pub tables: &'a Tables<'a>,
    pub home: &'a str,
    pub variant: &'a str,
    pub given: Selection,
    pub reads: &'a Reads,
}

impl<'a> View<'a> {
    /// The same view with one condition more.
    pub(crate) fn narrowed(&self, column: &str, allowed: &Allowed) -> Self {
        Self { given: self.given.with(column, allowed.clone()), ..self.clone() }
    }

    /// The rows meant; `by` is a column that splits them into lines and is not narrowed to its default.
    pub(crate) fn rows(&self, source: Source<'_>, by: Option<&str>) -> Result<Rows<'a>, Absence> {
        let id = source.table.unwrap_or(self.home);
        let at_home = id == self.home;
        let table = self.table(id)?;
        let selection = if at_home { self.given.and(source.rows) } else { source.rows.clone() };
        let mut indices: Vec<usize> = (0..height(table)).collect();
        for (name, allowed) in &selection.0 {
            let (column, Column { data, .. }) = find(table, name)?;
            self.note(at_home, column, Role::Filter, 0);
            indices.retain(|&row| allowed.admits(data, row));
        }
        let mut keep = |name: &str, wanted: &str, or_all: bool| {
            if let Ok((_, Column { data: Data::Text(cells), .. })) = find(table, name)
                && (!or_all || indices.iter().any(|&row| cells[row] == wanted))
            {
                indices.retain(|&row| cells[row] == wanted);
            }
        };
        if !selection.0.contains_key("variant") && by != Some("variant") {
            let elsewhere = !at_home && !has_text(table, "variant", self.variant);
            keep("variant", if elsewhere { BASELINE } else { self.variant }, false);
        }
        if !selection.0.contains_key("solver") && by != Some("solver") {
            keep("solver", DEFAULT_SOLVER, true);
        }
        if indices.is_empty() {
            return Err(Absence::NoRow(if selection.0.is_empty() {
                format!("`{id}` has no row")
            } else {
                format!("`{id}` has no row with {selection}")
            }));
        }
        if let Ok((_, Column { data: Data::Text(cells), .. })) = find(table, "failure")
            && let Some(&row) = indices.iter().find(|&&row| !cells[row].is_empty())
        {
            return Err(Absence::Broken(format!("a run failed: {}", cells[row])));
        }
        Ok(Rows { table, at_home, indices })
    }

    /// A measure in each of the rows.
    pub(crate) fn cells(&self, rows: &Rows<'_>, of: &str) -> Result<Vec<Cell>, Absence> {
        let (column, found) = find(rows.table, of)?;
        let companion = |suffix: &str| find(rows.table, &format!("{of}{suffix}")).ok().map(|(_, column)| &column.data);
        let (own, spreads) = (companion("_num"), companion("_spread"));
        let members = find(rows.table, "members").ok().map(|(_, column)| &column.data);
        rows.indices
            .iter()
            .map(|&row| {
                self.note(rows.at_home, column, Role::Value, row);
                let broken = |what: &str| Absence::Broken(format!("`{of}` {what} in row {}", row + 1));
                let value = number(&found.data, row).ok_or_else(|| broken("is no column of numbers"))?;
                let own = own.map_or(Some(0.0), |data| number(data, row)).unwrap_or(f64::NAN);
                let spread = spreads.map_or(Some(0.0), |data| number(data, row)).unwrap_or(f64::NAN);
                if !value.is_finite() {
                    return Err(broken(&format!("is {}", significant(value, 3))));
                }
                if !(own.is_finite() && spread.is_finite() && own >= 0.0 && spread >= 0.0) {
                    return Err(broken("has no error of its own"));
                }
                let members = members.and_then(|data| number(data, row)).unwrap_or(1.0).max(1.0);
                Ok(Cell { value, run: own.max(spread / members.sqrt()), spread })
            })
            .collect()
    }

    /// A measure along a parameter. Rows whose parameter is absent (another part of a union) or infinite are no part of
    /// the line.
    pub(crate) fn line(&self, source: Source<'_>, of: &str, over: &str, by: Option<&str>) -> Result<Line, Absence> {
        let mut rows = self.rows(source, by)?;
        let (column, along) = find(rows.table, over)?;
        let abscissa = |row: usize| number(&along.data, row).filter(|x| x.is_finite());
        rows.indices.retain(|&row| abscissa(row).is_some());
        if rows.indices.is_empty() {
            return Err(Absence::NoRow(format!("no row has a `{over}`")));
        }
        for &row in &rows.indices {
            self.note(rows.at_home, column, Role::Coordinate, row);
        }
        let cells = self.cells(&rows, of)?;
        let mut points: Vec<(f64, Cell)> =
            rows.indices.iter().filter_map(|&row| abscissa(row)).zip(cells.iter().copied()).collect();
        points.sort_by(|a, b| a.0.total_cmp(&b.0));
        // One point that two sweeps of a union share gave the same bits twice.
        points.dedup();
        if let Some(pair) = points.windows(2).find(|pair| same(pair[0].0, pair[1].0)) {
            return Err(Absence::Broken(format!(
                "two rows at {over} = {} differ in `{of}`: `where` must say which one is meant",
                significant(pair[0].0, 6)
            )));
        }
        let (x, y) = points.into_iter().unzip();
        Ok(Line {
            over: over.into(),
            over_unit: along.unit.clone(),
            of: of.into(),
            unit: find(rows.table, of)?.1.unit.clone(),
            x,
            y,
        })
    }

    /// The values that a column takes in the rows: numbers increasing, ∞ last, words in their order of appearance.
    pub(crate) fn levels(&self, rows: &Rows<'_>, by: &str) -> Result<Vec<Allowed>, Absence> {
        let (column, found) = find(rows.table, by)?;
        self.note(rows.at_home, column, Role::Filter, 0);
        if let Data::Text(cells) = &found.data {
            let mut words: Vec<&String> = Vec::new();
            for &row in &rows.indices {
                if !cells[row].is_empty() && !words.contains(&&cells[row]) {
                    words.push(&cells[row]);
                }
            }
            return Ok(words.into_iter().map(|word| Allowed::Text(word.clone())).collect());
        }
        let mut numbers: Vec<f64> =
            rows.indices.iter().filter_map(|&row| number(&found.data, row)).filter(|x| !x.is_nan()).collect();
        numbers.sort_by(f64::total_cmp);
        numbers.dedup_by(|a, b| same(*a, *b));
        Ok(numbers
            .into_iter()
            .map(|x| if x == f64::INFINITY { Allowed::Text("infinite".into()) } else { Allowed::Number(x) })
            .collect())
    }

    /// A time history of the one row that is meant; whoever uses its samples asks whether they are [`finite`].
    pub(crate) fn path(&self, rows: &Rows<'a>, of: &str) -> Result<&'a [f64], Absence> {
        let &[row] = rows.indices.as_slice() else {
            return Err(Absence::Broken(format!("{} rows where a time history needs one", rows.indices.len())));
        };
        let (column, found) = find(rows.table, of)?;
        self.note(rows.at_home, column, Role::Path, row);
        let Data::FloatList(lists) = &found.data else {
            return Err(Absence::Broken(format!("`{of}` is no time history")));
        };
        let path = lists[row].as_slice();
        if path.is_empty() {
            // Variants keep no time history.
            return Err(Absence::NoRow(format!("the time history `{of}` is empty")));
        }

        Ok(path)
    }

    /// The unit of a column.
    pub(crate) fn unit(&self, rows: &Rows<'a>, of: &str) -> Result<&'a str, Absence> {
        find(rows.table, of).map(|(_, column)| column.unit.as_str())
    }

    /// The variants of the assumptions that the entry's own table holds, apart from the baseline.
    pub(crate) fn variants(&self) -> Vec<&'a str> {
        let mut found: Vec<&str> = Vec::new();
        if let Ok(table) = self.table(self.home)
            && let Ok((_, Column { data: Data::Text(cells), .. })) = find(table, "variant")
        {
            for cell in cells {
                if cell != BASELINE && !found.contains(&cell.as_str()) {
                    found.push(cell);
                }
            }
        }
        found
    }

    fn table(&self, id: &str) -> Result<&'a Table, Absence> {
        match self.tables.get(id) {
            Some(TableState::Present(table)) => Ok(table),
            Some(TableState::Stale) => Err(Absence::Broken(format!("the table of `{id}` is stale: run it again"))),
            Some(TableState::Failed(reason)) => Err(Absence::Broken(format!("`{id}` failed: {reason}"))),
            Some(TableState::NotRun) | None => Err(Absence::Broken(format!("`{id}` has not been run"))),
        }
    }

    fn note(&self, at_home: bool, column: usize, role: Role, row: usize) {
        if at_home {
            self.reads.borrow_mut().insert(Read { column, role, row });
        }
    }
}

impl Rows<'_> {
    pub(crate) fn count(&self) -> usize {
        self.indices.len()
    }
}

impl Line {
    /// Largest less smallest value.
    pub(crate) fn range(&self) -> f64 {
        let extreme = |pick: fn(f64, f64) -> f64| self.y.iter().map(|cell| cell.value).reduce(pick).unwrap_or(0.0);
        extreme(f64::max) - extreme(f64::min)
    }

    /// Index of the largest value, the first of equals.
    pub(crate) fn highest(&self) -> usize {
        (1..self.y.len()).fold(0, |best, i| if self.y[i].value > self.y[best].value { i } else { best })
    }

    /// The same line upside down.
    pub(crate) fn inverted(mut self) -> Self {
        for cell in &mut self.y {
            cell.value = -cell.value;
        }
        self
    }
}

/// Refuses samples that are no numbers.
pub(crate) fn finite(samples: &[f64], of: &str) -> Result<(), Absence> {
    if samples.iter().all(|x| x.is_finite()) {
        Ok(())
    } else {
        Err(Absence::Broken(format!("the time history `{of}` is not finite throughout")))
    }
}

fn height(table: &Table) -> usize {
    let length = |data: &Data| match data {
        Data::Float(cells) => cells.len(),
        Data::Int(cells) => cells.len(),
        Data::Text(cells) => cells.len(),
        Data::FloatList(cells) => cells.len(),
    };
    table.columns.iter().map(|column| length(&column.data)).min().unwrap_or(0)
}

fn find<'t>(table: &'t Table, name: &str) -> Result<(usize, &'t Column), Absence> {
    let found = table.columns.iter().enumerate().find(|(_, column)| column.name == name);
    found.ok_or_else(|| Absence::Broken(format!("there is no column `{name}`")))
}

fn has_text(table: &Table, name: &str, wanted: &str) -> bool {
    matches!(find(table, name), Ok((_, Column { data: Data::Text(cells), .. })) if cells.iter().any(|cell| cell == wanted))
}

fn number(data: &Data, row: usize) -> Option<f64> {
    match data {
        Data::Float(cells) => cells.get(row).copied(),
        #[expect(clippy::cast_precision_loss, reason = "counts are far below 2^53")]
        Data::Int(cells) => cells.get(row).map(|&count| count as f64),
        Data::Text(_) | Data::FloatList(_) => None,
    }
}
