//! Shows that every entry can fail: damaged copies of its own table must turn its verdict.
//!
//! A comparison that compared nothing reads like a pass. So each column that decided an entry is dropped, a NaN is put
//! into each measure it read, and its numbers are moved: a value just outside its tolerance must differ, the published
//! value itself must not, and some change of the numbers must make a claim fail.

use std::collections::{BTreeMap, BTreeSet};

use super::compare;
use super::entry::{Check, Entry, ReferenceFile};
use super::extraction::Extraction;
use super::judge::judge_noting;
use super::verdict::{Judged, Verdict};
use super::view::{BASELINE, Read, Reads, Role, TableState, Tables, View};
use crate::table::{Data, Table};

/// An entry that passed where it had to fail, or that could not be put to the test.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct SelfTestFailure {
    /// Id of the entry.
    pub id: String,
    /// What was done to the table, and what came out.
    pub reason: String,
}

impl std::fmt::Display for SelfTestFailure {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "{}: {}", self.id, self.reason)
    }
}

/// How far outside its tolerance a moved value is put.
const JUST_OUTSIDE: f64 = 1.05;

/// Puts every entry of a file to the test, on the table of its own experiment among `tables`.
#[must_use]
pub fn self_test(file: &ReferenceFile, tables: &Tables<'_>) -> Vec<SelfTestFailure> {
    let mut failures = Vec::new();
    for entry in &file.entries {
        let failed = match tables.get(&file.experiment) {
            Some(TableState::Present(table)) => {
                Bench { entry, experiment: &file.experiment, tables, table }.run().err()
            }
            _ => Some("its table is missing, so it cannot be put to the test".to_string()),
        };
        failures.extend(failed.map(|reason| SelfTestFailure { id: entry.id.clone(), reason }));
    }
    failures
}

struct Bench<'a> {
    entry: &'a Entry,
    experiment: &'a str,
    tables: &'a Tables<'a>,
    table: &'a Table,
}

impl Bench<'_> {
    fn run(&self) -> Result<(), String> {
        let (judged, reads) = judge_noting(self.entry, self.experiment, self.tables);
        if judged.verdict == Verdict::Missing {
            return Err(format!("it is missing already: {}", judged.found));
        }
        let reads = reads.into_inner();
        if !reads.iter().any(|read| matches!(read.role, Role::Value | Role::Path)) {
            return Err("it reads no measure of its own table".into());
        }
        self.dropped_columns(&reads)?;
        self.not_a_number(&reads)?;
        if !self.entry.blocked_by.is_empty() {
            return Ok(());
        }
        match &self.entry.check {
            Check::Value { from, .. } => self.moved_value(&judged, from, &reads),
            Check::Claim { .. } => self.broken_claim(&judged, &reads),
        }
    }

    fn judge(&self, table: &Table) -> Judged {
        let mut tables: Tables<'_> = self.tables.clone();
        tables.insert(self.experiment.to_string(), TableState::Present(table));
        judge_noting(self.entry, self.experiment, &tables).0
    }

    fn dropped_columns(&self, reads: &BTreeSet<Read>) -> Result<(), String> {
        let columns: BTreeSet<usize> = reads.iter().map(|read| read.column).collect();
        for column in columns {
            let mut table = self.table.clone();
            let name = table.columns.remove(column).name;
            let verdict = self.judge(&table).verdict;
            if verdict != Verdict::Missing {
                return Err(format!("without the column `{name}` it is {verdict:?}, not missing"));
            }
        }
        Ok(())
    }

    fn not_a_number(&self, reads: &BTreeSet<Read>) -> Result<(), String> {
        let mut cells: BTreeMap<usize, Vec<usize>> = BTreeMap::new();
        for read in reads.iter().filter(|read| matches!(read.role, Role::Value | Role::Path)) {
            cells.entry(read.column).or_default().push(read.row);
        }
        for (column, rows) in cells {
            for row in BTreeSet::from([rows[0], rows[rows.len() / 2], rows[rows.len() - 1]]) {
                let mut table = self.table.clone();
                alter(&mut table, column, &[row], |_, _| f64::NAN);
                let verdict = self.judge(&table).verdict;
                if verdict != Verdict::Missing {
                    let name = &self.table.columns[column].name;
                    return Err(format!("with a NaN in `{name}`, row {}, it is {verdict:?}, not missing", row + 1));
                }
            }
        }
        Ok(())
    }

    fn moved_value(&self, judged: &Judged, from: &Extraction, reads: &BTreeSet<Read>) -> Result<(), String> {
        // A feature that does not occur cannot be moved; it differs already.
        let Some(comparison) = judged.comparison else { return Ok(()) };
        let tolerance = compare::tolerance(&comparison);
        for (offset, should_differ) in [(JUST_OUTSIDE, true), (-JUST_OUTSIDE, true), (0.0, false)] {
            let target = comparison.published + offset * tolerance;
            let mut table = self.table.clone();
            self.steer(&mut table, from, comparison.simulated, target, reads)?;
            let moved = self.judge(&table);
            let reached = moved.comparison.map_or(f64::NAN, |comparison| comparison.simulated);
            // A scaled number's own error scales with it; a moved one is exact to rounding.
            if (reached - target).abs() > 0.01 * tolerance {
                return Err(format!("moved to {target}, it reads {reached}: {}", moved.found));
            }
            if (moved.verdict == Verdict::Differs) != should_differ {
                return Err(format!("moved to {target}, it is {:?}", moved.verdict));
            }
        }
        Ok(())
    }

    /// Moves the cells that decided an extraction so that it gives `to` instead of `now`.
    fn steer(
        &self,
        table: &mut Table,
        from: &Extraction,
        now: f64,
        to: f64,
        reads: &BTreeSet<Read>,
    ) -> Result<(), String> {
        let cells = |role: Role, name: &str| -> (usize, Vec<usize>) {
            let column = self.table.columns.iter().position(|column| column.name == name).unwrap_or(usize::MAX);
            (column, reads.iter().filter(|read| read.role == role && read.column == column).map(|r| r.row).collect())
        };
        let mut shift = |(column, rows): (usize, Vec<usize>)| alter(table, column, &rows, |x, _| x + (to - now));
        match from {
            Extraction::Cell(word) | Extraction::Mean(word) => shift(cells(Role::Value, &word.of)),
            Extraction::Maximum(word) | Extraction::Minimum(word) => shift(cells(Role::Value, &word.of)),
            Extraction::End(word) => shift(cells(Role::Value, &word.of)),
            Extraction::AtMaximum(word) => shift(cells(Role::Value, &word.read)),
            Extraction::Argmax(word) | Extraction::Argmin(word) => shift(cells(Role::Coordinate, &word.over)),
            Extraction::Crossing(word) => shift(cells(Role::Coordinate, &word.over)),
            Extraction::FirstAbove(word) => shift(cells(Role::Coordinate, &word.over)),
            Extraction::Parting(word) => shift(cells(Role::Coordinate, &word.over)),
            Extraction::NearestPassage(_) => shift(cells(Role::Path, "time")),
            Extraction::LargestStepBack(word) => {
                let (column, rows) = cells(Role::Value, &word.of);
                alter(table, column, &rows, |x, _| x * to / now);
            }
            Extraction::Times(times) => {
                return self.steer(table, &times.of, now / times.factor, to / times.factor, reads);
            }
            Extraction::Ratio(quotient) => {
                let above = Reads::default();
                for variant in std::iter::once(BASELINE).chain(self.view(BASELINE, &above).variants()) {
                    // A variant without these rows reads nothing, which is what is wanted of it.
                    let _ = quotient.of.take(&self.view(variant, &above));
                }
                for column in above.borrow().iter().map(|read| read.column).collect::<BTreeSet<_>>() {
                    let rows: Vec<usize> = above
                        .borrow()
                        .iter()
                        .filter(|read| read.column == column && read.role == Role::Value)
                        .map(|read| read.row)
                        .collect();
                    alter(table, column, &rows, |x, _| x * to / now);
                }
            }
            Extraction::Number(_) => return Err("its value is a fixed number".into()),
        }
        Ok(())
    }

    fn view<'v>(&'v self, variant: &'v str, reads: &'v Reads) -> View<'v> {
        View { tables: self.tables, home: self.experiment, variant, given: self.entry.rows.clone(), reads }
    }

    /// Some change of the numbers that it reads must make a claim fail.
    fn broken_claim(&self, judged: &Judged, reads: &BTreeSet<Read>) -> Result<(), String> {
        if judged.verdict == Verdict::Differs {
            return Ok(());
        }
        let mut cells: BTreeMap<usize, Vec<usize>> = BTreeMap::new();
        for read in reads.iter().filter(|read| matches!(read.role, Role::Value | Role::Path)) {
            cells.entry(read.column).or_default().push(read.row);
        }
        for (column, rows) in cells {
            let half = rows.len().div_ceil(2);
            for rows in [&rows[..], &rows[..half], &rows[half..]] {
                for damage in DAMAGES {
                    let mut table = self.table.clone();
                    damage.inflict(&mut table, column, rows);
                    if self.judge(&table).verdict == Verdict::Differs {
                        return Ok(());
                    }
                }
            }
        }
        Err("nothing that was done to the measures it reads made it fail".into())
    }
}

/// A change of some cells that keeps them finite.
#[derive(Debug, Clone, Copy)]
enum Damage {
    Mirrored,
    Raised,
    Lowered,
    Flattened,
    SpikeFirst,
    SpikeMiddle,
    SpikeLast,
    Comb,
    OtherComb,
}

const DAMAGES: [Damage; 9] = [
    Damage::Mirrored,
    Damage::Raised,
    Damage::Lowered,
    Damage::Flattened,
    Damage::SpikeFirst,
    Damage::SpikeMiddle,
    Damage::SpikeLast,
    Damage::Comb,
    Damage::OtherComb,
];

impl Damage {
    fn inflict(self, table: &mut Table, column: usize, rows: &[usize]) {
        let Some(column_) = table.columns.get(column) else { return };
        let present: Vec<f64> = rows.iter().flat_map(|&row| numbers(&column_.data, row)).collect();
        let low = present.iter().copied().fold(f64::INFINITY, f64::min);
        let high = present.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        let far = 2.0 * (high - low).max(high.abs()).max(low.abs()).max(1e-3);
        let last = present.len().saturating_sub(1);
        alter(table, column, rows, |x, i| match self {
            Self::Mirrored => low + high - x,
            Self::Raised => x + far,
            Self::Lowered => x - far,
            Self::Flattened => low,
            Self::SpikeFirst if i == 0 => x + far,
            Self::SpikeMiddle if i == last / 2 => x + far,
            Self::SpikeLast if i == last => x + far,
            Self::Comb if i % 2 == 1 => x - far,
            Self::OtherComb if i % 2 == 0 => x - far,
            _ => x,
        });
    }
}

fn numbers(data: &Data, row: usize) -> Vec<f64> {
    match data {
        Data::Float(cells) => cells.get(row).copied().into_iter().collect(),
        #[expect(clippy::cast_precision_loss, reason = "counts are far below 2^53")]
        Data::Int(cells) => cells.get(row).map(|&count| count as f64).into_iter().collect(),
        Data::FloatList(lists) => lists.get(row).cloned().unwrap_or_default(),
        Data::Text(_) => Vec::new(),
    }
}

/// Replaces numbers of a column, counted through the given rows and, in time histories, through their samples. Counts
/// become plain numbers, so that they can be anything.
fn alter(table: &mut Table, column: usize, rows: &[usize], change: impl Fn(f64, usize) -> f64) {
    let Some(column) = table.columns.get_mut(column) else { return };
    if let Data::Int(counts) = &column.data {
        #[expect(clippy::cast_precision_loss, reason = "counts are far below 2^53")]
        let numbers = counts.iter().map(|&count| count as f64).collect();
        column.data = Data::Float(numbers);
    }
    let mut i = 0;
    let mut next = |x: &mut f64| {
        *x = change(*x, i);
        i += 1;
    };
    match &mut column.data {
        Data::Float(cells) => rows.iter().for_each(|&row| {
            if let Some(x) = cells.get_mut(row) {
                next(x);
            }
        }),
        Data::FloatList(lists) => rows.iter().for_each(|&row| {
            if let Some(list) = lists.get_mut(row) {
                list.iter_mut().for_each(&mut next);
            }
        }),
        Data::Int(_) | Data::Text(_) => {}
    }
}
