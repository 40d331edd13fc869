//! What an entry sees of the tables: the rows it means, as cells with their own errors, as lines and as time histories.
//!
//! Every cell that is looked at is noted, so that the self-test can damage exactly those. What cannot be read (no table,
//! no column, no row, NaN, a failed run) is an [`Absence`], never a number.

use std::cell::RefCell;
use std::collections::{BTreeMap, BTreeSet};

use super::absence::{Absence, NoTable, WhyNoTable};
use super::columns::{Found, find, find_if_any, height, labels, parameter};
use super::selection::{Allowed, Selection, same};
use super::text::{known, significant, symbol, with_unit};
use crate::experiment::{Parameter, SearchPoint, assumption_of};
use crate::table::{BASELINE, Data, Table, UNKNOWN};
use crate::text::name;
use crate::text::words::EVENT_DRIVEN;

/// The solver that is meant where an entry names none.
const DEFAULT_SOLVER: &str = EVENT_DRIVEN;

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
    /// Nor is there such an experiment.
    NoExperiment,
}

/// Tables by experiment; one that is not listed has not been run.
pub type Tables<'a> = BTreeMap<String, TableState<'a>>;

/// What a cell was read as.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum Role {
    /// A condition on it chose the rows.
    Filter,
    /// An abscissa.
    Coordinate,
    /// A measure.
    Value,
    /// The uncertainty of a measure.
    Error,
    /// A time history.
    Path,
}

/// A cell that was looked at.
#[derive(Debug, Clone, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) struct Read {
    /// The experiment whose table it stands in.
    pub table: String,
    pub column: usize,
    pub role: Role,
    pub row: usize,
}

/// Cells that were looked at. Verdicts look at the same ones many times over: noting them again costs next to nothing.
#[derive(Debug, Default)]
pub(crate) struct Reads {
    tables: RefCell<BTreeMap<String, OfTable>>,
    places: RefCell<Vec<Place>>,
    ends: RefCell<Vec<String>>,
}

/// A point of a curve that an entry speaks of.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Place {
    /// The experiment whose table the curve stands in.
    pub table: String,
    /// What the curve is over.
    pub over: String,
    pub x: f64,
    /// The rows of the curve there: one, of a difference of two curves two.
    pub rows: Vec<usize>,
}

/// Rows of tables, by experiment and in their order.
pub(crate) type RowsByTable = BTreeMap<String, Vec<usize>>;

/// Of one table: by column and role, whether each row was looked at.
type OfTable = BTreeMap<(usize, Role), Vec<bool>>;

impl Reads {
    fn note(&self, table: &str, column: usize, role: Role, rows: &[usize]) {
        let mut tables = self.tables.borrow_mut();
        if !tables.contains_key(table) {
            tables.insert(table.to_owned(), OfTable::new());
        }
        let Some(columns) = tables.get_mut(table) else { return };
        let seen = columns.entry((column, role)).or_default();
        let height = rows.iter().max().map_or(0, |row| row + 1);
        seen.resize(height.max(seen.len()), false);
        rows.iter().for_each(|&row| seen[row] = true);
    }

    /// The points of curves that were spoken of, each once.
    pub(crate) fn places(&self) -> Vec<Place> {
        self.places.borrow().clone()
    }

    /// That optima lie at the first or last point that was looked at, in words: `; the optimum is at the end of the range, f′ = 100, and may
    /// lie beyond`. Empty if none does.
    pub(crate) fn ends(&self) -> String {
        match self.ends.borrow().as_slice() {
            [] => String::new(),
            [one] => format!("; the optimum is at the end of the range, {one}, and may lie beyond"),
            many => format!("; optima are at the end of the range, {}, and may lie beyond", many.join(" and ")),
        }
    }

    /// One by one.
    pub(crate) fn cells(&self) -> BTreeSet<Read> {
        let of_column = |table: &str, (column, role): (usize, Role), seen: &[bool]| -> Vec<Read> {
            let rows = (0..seen.len()).filter(|&row| seen[row]);
            rows.map(|row| Read { table: table.to_owned(), column, role, row }).collect()
        };
        let tables = self.tables.borrow();
        let columns = tables.iter().flat_map(|(table, columns)| columns.iter().map(move |it| (table, it)));
        columns.flat_map(|(table, (key, seen))| of_column(table, *key, seen)).collect()
    }

    /// By experiment, the rows that were looked at for more than to choose rows.
    pub(crate) fn decisive_rows(&self) -> RowsByTable {
        let rows = |columns: &OfTable| -> Vec<usize> {
            let mut any: Vec<bool> = Vec::new();
            for (_, seen) in columns.iter().filter(|((_, role), _)| *role != Role::Filter) {
                any.resize(any.len().max(seen.len()), false);
                any.iter_mut().zip(seen).for_each(|(any, seen)| *any |= seen);
            }
            (0..any.len()).filter(|&row| any[row]).collect()
        };
        let tables = self.tables.borrow();
        tables.iter().map(|(id, columns)| (id.clone(), rows(columns))).filter(|(_, rows)| !rows.is_empty()).collect()
    }
}

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
    id: String,
    table: &'a Table,
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
        let mut rows = Rows { id: id.into(), table, indices: (0..height(table)).collect() };
        let open = |name: &str| !selection.0.contains_key(name) && by != Some(name);
        let (variant, variants) = labels(table, name::VARIANT)?;
        let mut asked = vec![variant];
        // First, as a table with twenty variants has twenty times the rows.
        if open(name::VARIANT) {
            let was_run = variants.iter().any(|label| label == self.variant);
            let stays = !was_run && !table.depends_on(assumption_of(self.variant)).unwrap_or(at_home);
            let wanted = if stays { BASELINE } else { self.variant };
            rows.indices.retain(|&row| variants[row] == wanted);
        }
        for (name, allowed) in &selection.0 {
            let found = parameter(table, name)?;
            asked.push(found);
            rows.indices.retain(|&row| allowed.admits(&found.column.data, row));
        }
        let (solver, solvers) = labels(table, name::SOLVER)?;
        asked.push(solver);
        if open(name::SOLVER) && rows.indices.iter().any(|&row| solvers[row] == DEFAULT_SOLVER) {
            rows.indices.retain(|&row| solvers[row] == DEFAULT_SOLVER);
        }
        let (failure, failures) = labels(table, name::FAILURE)?;
        asked.push(failure);
        if rows.indices.is_empty() {
            return Err(Absence::NoRow(if selection.0.is_empty() {
                format!("`{id}` has no row")
            } else {
                format!("`{id}` has no row with {selection}")
            }));
        }
        for found in asked {
            self.note_all(&rows, found, Role::Filter);
        }
        if let Some(&row) = rows.indices.iter().find(|&&row| !failures[row].is_empty()) {
            return Err(Absence::Broken(format!("a run failed: {}", failures[row])));
        }
        if let Some(&row) = rows.indices.iter().find(|&&row| table.is_unbalanced(row)) {
            return Err(Absence::Broken(format!(
                "the balances of row {} do not close: its numbers prove nothing",
                row + 1
            )));
        }
        Ok(rows)
    }

    /// A measure in each of the rows.
    pub(crate) fn cells(&self, rows: &Rows<'_>, of: &str) -> Result<Vec<Cell>, Absence> {
        let found = find(rows.table, of)?;
        self.note_all(rows, found, Role::Value);
        let errors = self.errors(rows, of)?;
        let error = |found: Option<Found<'_>>, none: f64, row: usize| {
            found.map_or(none, |found| found.column.data.number(row).unwrap_or(f64::NAN))
        };
        rows.indices
            .iter()
            .map(|&row| {
                let broken = |what: &str| Absence::Broken(format!("`{of}` {what} in row {}", row + 1));
                let value = found.column.data.number(row).ok_or_else(|| broken("is no column of numbers"))?;
                let (own, spread) = (error(errors.own, 0.0, row), error(errors.spread, 0.0, row));
                let members = error(errors.members, 1.0, row);
                let has_error = own >= 0.0 && spread >= 0.0 && members >= 0.0;
                // The time to what never happens, for one.
                if value == f64::INFINITY && has_error {
                    return Err(Absence::Nowhere(format!("`{of}` is ∞ in row {}", row + 1)));
                }
                if !value.is_finite() {
                    return Err(broken(&format!("is {}", significant(value, 3))));
                }
                if !(has_error && own.is_finite() && spread.is_finite()) {
                    let unknown = rows.table.texts(UNKNOWN).map_or("", |reasons| reasons[row].as_str());
                    return Err(match unknown {
                        "" => broken("has no error of its own"),
                        why => Absence::Broken(format!("the error of `{of}` is not known in row {}: {why}", row + 1)),
                    });
                }
                Ok(Cell { value, run: own.max(spread / members.max(1.0).sqrt()), spread })
            })
            .collect()
    }

    /// A coordinate of each of the rows, finite.
    pub(crate) fn coordinates(&self, rows: &Rows<'_>, name: &str) -> Result<Vec<f64>, Absence> {
        let found = parameter(rows.table, name)?;
        self.note_all(rows, found, Role::Coordinate);
        let coordinate = |&row: &usize| {
            let x = found.column.data.number(row).filter(|x| x.is_finite());
            x.ok_or_else(|| Absence::Broken(format!("`{name}` is no finite number in row {}", row + 1)))
        };
        rows.indices.iter().map(coordinate).collect()
    }

    /// The columns that say how uncertain a measure is. A measure has all of them, the place of a maximum or an onset no spread, and a
    /// parameter none; of those that belong together none may be missing.
    fn errors<'t>(&self, rows: &Rows<'t>, of: &str) -> Result<Errors<'t>, Absence> {
        let (numerical, of_spread) = (name::numerical(of), name::spread(of));
        let (own, spread) = (find_if_any(rows.table, &numerical), find_if_any(rows.table, &of_spread));
        let whole = if SearchPoint::is_place(of) { own.is_some() } else { spread.is_some() == own.is_some() };
        if !whole {
            return Err(Absence::Broken(format!("`{of}` lacks a part of its error: `{numerical}` or `{of_spread}`")));
        }
        let members = if spread.is_some() { Some(find(rows.table, name::MEMBERS)?) } else { None };
        for found in [own, spread, members].into_iter().flatten() {
            self.note_all(rows, found, Role::Error);
        }
        Ok(Errors { own, spread, members })
    }

    /// A measure along a parameter. Rows whose parameter is absent (another part of a union) or infinite are no part of
    /// the line.
    pub(crate) fn line(&self, source: Source<'_>, of: &str, over: &str, by: Option<&str>) -> Result<Line, Absence> {
        let mut rows = self.rows(source, by)?;
        let along = parameter(rows.table, over)?;
        let abscissa = |row: usize| along.column.data.number(row).filter(|x| x.is_finite());
        rows.indices.retain(|&row| abscissa(row).is_some());
        if rows.indices.is_empty() {
            return Err(Absence::NoRow(format!("no row has a `{over}`")));
        }
        self.note_all(&rows, along, Role::Coordinate);
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
            over_unit: along.column.unit.clone(),
            of: of.into(),
            unit: find(rows.table, of)?.column.unit.clone(),
            x,
            y,
        })
    }

    /// The values that a column takes in the rows: numbers increasing, ∞ last, words in their order of appearance.
    pub(crate) fn levels(&self, rows: &Rows<'_>, by: &str) -> Result<Vec<Allowed>, Absence> {
        let found = parameter(rows.table, by)?;
        self.note_all(rows, found, Role::Filter);
        let data = &found.column.data;
        if let Data::Text(cells) = data {
            let mut words: Vec<&String> = Vec::new();
            for &row in &rows.indices {
                if !cells[row].is_empty() && !words.contains(&&cells[row]) {
                    words.push(&cells[row]);
                }
            }
            return Ok(words.into_iter().map(|word| Allowed::Text(word.clone())).collect());
        }
        let mut numbers: Vec<f64> =
            rows.indices.iter().filter_map(|&row| data.number(row)).filter(|x| !x.is_nan()).collect();
        numbers.sort_by(f64::total_cmp);
        numbers.dedup_by(|a, b| same(*a, *b));
        Ok(numbers
            .into_iter()
            .map(|x| if x == f64::INFINITY { Allowed::Text("infinite".into()) } else { Allowed::Number(x) })
            .collect())
    }

    /// A time history of the one row that is meant, finite throughout.
    pub(crate) fn path(&self, rows: &Rows<'a>, of: &str) -> Result<&'a [f64], Absence> {
        let &[row] = rows.indices.as_slice() else {
            return Err(Absence::Broken(format!("{} rows where a time history needs one", rows.indices.len())));
        };
        let found = find(rows.table, of)?;
        let Data::FloatList(lists) = &found.column.data else {
            return Err(Absence::Broken(format!("`{of}` is no time history")));
        };
        let path = lists[row].as_slice();
        if path.is_empty() {
            // A row of maximised points keeps none, nor does one of another sweep.
            return Err(Absence::NoRow(format!("the time history `{of}` is empty")));
        }
        self.note_all(rows, found, Role::Path);
        if !path.iter().all(|x| x.is_finite()) {
            return Err(Absence::Broken(format!("the time history `{of}` is not finite throughout")));
        }
        Ok(path)
    }

    /// The unit of a column.
    pub(crate) fn unit(&self, rows: &Rows<'a>, of: &str) -> Result<&'a str, Absence> {
        find(rows.table, of).map(|found| found.column.unit.as_str())
    }

    /// The variants of the assumptions that the tables looked at so far hold, apart from the baseline; the entry's own first.
    pub(crate) fn variants(&self) -> Vec<&'a str> {
        let mut found: Vec<&str> = Vec::new();
        let read = self.reads.tables.borrow();
        let others = read.keys().map(String::as_str).filter(|id| *id != self.home);
        for table in std::iter::once(self.home).chain(others).filter_map(|id| self.table(id).ok()) {
            for label in labels(table, name::VARIANT).map_or(&[][..], |(_, labels)| labels) {
                if label != BASELINE && !found.contains(&label.as_str()) {
                    found.push(label);
                }
            }
        }
        found
    }

    fn table(&self, id: &str) -> Result<&'a Table, Absence> {
        let (why, reason) = match self.tables.get(id) {
            Some(TableState::Present(table)) => return Ok(table),
            Some(TableState::Stale) => (WhyNoTable::Stale, format!("the table of `{id}` is stale: run it again")),
            Some(TableState::Failed(reason)) => (WhyNoTable::Failed, format!("`{id}` failed: {reason}")),
            Some(TableState::NotRun) | None => (WhyNoTable::NotRun, format!("`{id}` has not been run")),
            Some(TableState::NoExperiment) => (
                WhyNoTable::NoExperiment,
                format!("there is no experiment `{id}`: its file was renamed or is not there"),
            ),
        };
        Err(Absence::NoTable { table: NoTable { experiment: id.to_owned(), why }, reason })
    }

    /// Notes that what the entry says of a curve is of this point.
    pub(crate) fn note_place(&self, source: Source<'_>, over: &str, x: f64) {
        if self.variant != BASELINE {
            return;
        }
        // What was read a moment ago can be read again.
        let Ok(Rows { id, table, indices }) = self.rows(source, None) else { return };
        let Ok(along) = parameter(table, over) else { return };
        let here = |row: &usize| along.column.data.number(*row).is_some_and(|other| same(other, x));
        let place = Place { table: id, over: over.to_owned(), x, rows: indices.into_iter().filter(here).collect() };
        let mut places = self.reads.places.borrow_mut();
        if !places.contains(&place) {
            places.push(place);
        }
    }

    /// Notes that the best point of a line is its first or its last, unless the parameter can go no further.
    pub(crate) fn note_end(&self, line: &Line, best: usize) {
        let x = line.x[best];
        let is_inner = best > 0 && best + 1 < line.x.len() || line.x.len() < 2;
        if self.variant != BASELINE
            || is_inner
            || known::<Parameter>(&line.over).map_or(x == 0.0, |over| over.ends_at(x))
        {
            return;
        }
        let end = format!("{} = {}", symbol(&line.over), with_unit(x, 4, &line.over_unit));
        let mut ends = self.reads.ends.borrow_mut();
        if !ends.contains(&end) {
            ends.push(end);
        }
    }

    /// Notes a column in each of the rows.
    fn note_all(&self, rows: &Rows<'_>, found: Found<'_>, role: Role) {
        self.reads.note(&rows.id, found.index, role, &rows.indices);
    }
}

/// Columns of the uncertainty of a measure.
struct Errors<'t> {
    own: Option<Found<'t>>,
    spread: Option<Found<'t>>,
    members: Option<Found<'t>>,
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
