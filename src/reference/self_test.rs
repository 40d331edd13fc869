//! Shows that every entry can fail: damaged copies of the tables that it reads must turn its verdict.
//!
//! A comparison that compared nothing reads like a pass. So each column that an entry read is dropped, a NaN is put among
//! the numbers of each, and the numbers of its own experiment are moved. A value just outside its tolerance must differ,
//! and the published value itself must not. A claim must fail under some change of what it read, first of all one that
//! carries it just past its own margin.

use std::collections::{BTreeMap, BTreeSet};

use super::damage::{Damage, alter, extremes, numbers};
use super::decide::decide;
use super::entry::{Check, Entry, ReferenceFile};
use super::extraction::Extraction;
use super::judge::judge_noting;
use super::judged::Judged;
use super::predicate::Predicate;
use super::resonance::{Feature, Peak};
use super::verdict::Verdict;
use super::view::{Read, Reads, Role, TableState, Tables, View};
use crate::table::{BASELINE, Table};

/// An entry that passed where it had to fail, or that could not be put to the test.
#[derive(Debug, Clone, PartialEq)]
pub struct SelfTestFailure {
    /// Id of the entry.
    pub id: String,
    /// What was done to the table, and what came out.
    pub reason: Flaw,
}

/// What is wrong with an entry: what was done to the table, and what came out.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum Flaw {
    /// There is no table.
    #[error("its table is missing, so it cannot be put to the test")]
    NoTable,
    /// It has no result even on the undamaged table.
    #[error("it is missing already: {0}")]
    Missing(String),
    /// Nothing that it reads was measured in its own experiment.
    #[error("it reads no measure of its own table")]
    NoMeasure,
    /// It is a constant.
    #[error("its value is a fixed number")]
    FixedNumber,
    /// Data were taken away and it still has a verdict.
    #[error("{damage} it is {verdict:?}, not missing")]
    NotMissing {
        /// What was done.
        damage: String,
        /// The verdict then.
        verdict: Verdict,
    },
    /// Its numbers were moved and it reads something else.
    #[error("moved to {target}, it reads {reached}: {found}")]
    ReadsOther {
        /// Where its value was to be.
        target: f64,
        /// What it reads.
        reached: f64,
        /// In words.
        found: String,
    },
    /// Its value was moved across its tolerance and the verdict did not follow.
    #[error("moved to {target}, it is {verdict:?}")]
    WrongVerdict {
        /// Where its value is.
        target: f64,
        /// The verdict there.
        verdict: Verdict,
    },
    /// No change made it fail.
    #[error("nothing that was done to the measures it reads made it fail")]
    Unbreakable,
    /// One of its numbers.
    #[error("{name}: {reason}")]
    Part {
        /// Which.
        name: String,
        /// What is wrong with it.
        reason: Box<Self>,
    },
}

impl std::fmt::Display for SelfTestFailure {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "{}: {}", self.id, self.reason)
    }
}

/// How far outside its tolerance, or past its margin, something is put: just outside.
const JUST_OUTSIDE: f64 = 1.05;
/// The same for changes of many numbers, of which a claim's margin sees a part.
const FURTHER_OUTSIDE: [f64; 2] = [2.0, 10.0];
/// Most numbers of a column that are moved one at a time.
const SPIKES: usize = 512;

/// Puts every entry of a file to the test, on the table of its own experiment among `tables`.
#[must_use]
pub fn self_test(file: &ReferenceFile, tables: &Tables<'_>) -> Vec<SelfTestFailure> {
    let mut failures = Vec::new();
    for entry in &file.entries {
        let failed = match tables.get(&file.experiment) {
            Some(TableState::Present(table)) => {
                // What an unstated input blocks must be able to fail once it is stated.
                let entry = Entry { blocked_by: Vec::new(), ..entry.clone() };
                Trial { entry: &entry, experiment: &file.experiment, tables, table }.run().err()
            }
            _ => Some(Flaw::NoTable),
        };
        failures.extend(failed.map(|reason| SelfTestFailure { id: entry.id.clone(), reason }));
    }
    failures
}

/// One entry under test.
struct Trial<'a> {
    entry: &'a Entry,
    experiment: &'a str,
    tables: &'a Tables<'a>,
    /// Of its own experiment.
    table: &'a Table,
}

impl Trial<'_> {
    fn run(&self) -> Result<(), Flaw> {
        let (judged, reads) = judge_noting(self.entry, self.experiment, self.tables);
        if judged.verdict == Verdict::Missing {
            return Err(Flaw::Missing(judged.found));
        }
        let reads = reads.cells();
        if self.measures(&reads).is_empty() {
            return Err(Flaw::NoMeasure);
        }
        self.without_columns(&reads)?;
        self.not_a_number(&reads)?;
        match &self.entry.check {
            Check::Value { from, .. } => self.moved_value(&judged, from, &reads),
            Check::Peak { peak, tolerance } => {
                // Each number as if it were an entry of its own.
                peak.numbers().into_iter().try_for_each(|number| {
                    let name = number.peak.read.words();
                    let check = Check::Value {
                        published: number.published.clone(),
                        from: Extraction::Peak(number.peak),
                        tolerance: tolerance.clone(),
                    };
                    let entry = Entry { check, ..self.entry.clone() };
                    Trial { entry: &entry, ..*self }
                        .run()
                        .map_err(|reason| Flaw::Part { name: name.to_string(), reason: Box::new(reason) })
                })
            }
            Check::Claim { predicate, .. } => self.broken_claim(&judged, predicate, &reads),
        }
    }

    fn judge(&self, table: &Table) -> Judged {
        self.judge_with(self.experiment, table)
    }

    /// The verdict with another table of that experiment.
    fn judge_with(&self, experiment: &str, table: &Table) -> Judged {
        let mut tables: Tables<'_> = self.tables.clone();
        tables.insert(experiment.to_string(), TableState::Present(table));
        judge_noting(self.entry, self.experiment, &tables).0
    }

    fn view<'v>(&'v self, variant: &'v str, reads: &'v Reads) -> View<'v> {
        View { tables: self.tables, home: self.experiment, variant, given: self.entry.rows.clone(), reads }
    }

    fn at_home<'r>(&self, reads: &'r BTreeSet<Read>) -> impl Iterator<Item = &'r Read> + use<'r, '_> {
        reads.iter().filter(|read| read.table == self.experiment)
    }

    /// The measures and time histories that it read of its own table: their rows by column.
    fn measures(&self, reads: &BTreeSet<Read>) -> BTreeMap<usize, Vec<usize>> {
        by_column(self.at_home(reads).filter(|read| matches!(read.role, Role::Value | Role::Path)))
    }

    /// All that it read, of any table: experiment, its table, column, rows.
    fn all_reads<'r>(&'r self, reads: &'r BTreeSet<Read>) -> Vec<(&'r str, &'r Table, usize, Vec<usize>)> {
        let experiments: BTreeSet<&str> = reads.iter().map(|read| read.table.as_str()).collect();
        let of = |experiment| match self.tables.get(experiment) {
            Some(TableState::Present(table)) => by_column(reads.iter().filter(|read| read.table == experiment))
                .into_iter()
                .map(|(column, rows)| (experiment, *table, column, rows))
                .collect(),
            _ => Vec::new(),
        };
        experiments.into_iter().flat_map(of).collect()
    }

    fn without_columns(&self, reads: &BTreeSet<Read>) -> Result<(), Flaw> {
        for (experiment, table, column, _) in self.all_reads(reads) {
            let mut table = table.clone();
            let name = table.columns.remove(column).name;
            let verdict = self.judge_with(experiment, &table).verdict;
            if verdict != Verdict::Missing {
                return Err(Flaw::NotMissing {
                    damage: format!("without the column `{name}` of `{experiment}`"),
                    verdict,
                });
            }
        }
        Ok(())
    }

    fn not_a_number(&self, reads: &BTreeSet<Read>) -> Result<(), Flaw> {
        for (experiment, table, column, rows) in self.all_reads(reads) {
            let count = numbers(table, column, &rows).len();
            if count == 0 {
                // Words.
                continue;
            }
            for at in BTreeSet::from([0, count / 2, count - 1]) {
                let mut damaged = table.clone();
                alter(&mut damaged, column, &rows, |x, i| if i == at { f64::NAN } else { x });
                let verdict = self.judge_with(experiment, &damaged).verdict;
                if verdict != Verdict::Missing {
                    let name = &table.columns[column].name;
                    let nan = format!("with a NaN for number {} of the {count} that it reads", at + 1);
                    return Err(Flaw::NotMissing { damage: format!("{nan} in `{name}` of `{experiment}`"), verdict });
                }
            }
        }
        Ok(())
    }

    fn moved_value(&self, judged: &Judged, from: &Extraction, reads: &BTreeSet<Read>) -> Result<(), Flaw> {
        // A feature that does not occur cannot be moved; it differs already.
        let Some(comparison) = judged.comparison else { return Ok(()) };
        // The nearest of several instants is never farther than half the time between two of them.
        let farthest = match from {
            Extraction::NearestPassage(_) => {
                let now = from.take(&self.view(BASELINE, &Reads::default())).ok();
                now.and_then(|now| now.scale).map_or(f64::INFINITY, |between| between / 2.0)
            }
            _ => f64::INFINITY,
        };
        for (offset, should_differ) in [(JUST_OUTSIDE, true), (-JUST_OUTSIDE, true), (0.0, false)] {
            // None of a count: any other number of events is outside.
            let mut tolerance = if comparison.tolerance() > 0.0 { comparison.tolerance() } else { 1.0 };
            // The uncertainty of a scaled number scales with it, and its tolerance: it is moved outside of that one too.
            for last in [false, false, true] {
                let target = comparison.published + offset * tolerance;
                // No deviation is below zero, however wide its tolerance.
                if target < 0.0 && matches!(from, Extraction::StandardDeviationOver(_)) {
                    break;
                }
                if offset.abs() * tolerance > farthest {
                    break;
                }
                let mut table = self.table.clone();
                self.steer(&mut table, from, comparison.simulated, target, reads)?;
                let moved = self.judge(&table);
                let reached = moved.comparison.map_or(f64::NAN, |comparison| comparison.simulated);
                // A scaled number's own error scales with it; a moved one is exact to rounding.
                if (reached - target).abs() > 0.01 * tolerance {
                    return Err(Flaw::ReadsOther { target, reached, found: moved.found });
                }
                if (moved.verdict == Verdict::Differs) == should_differ {
                    break;
                }
                if last || !should_differ {
                    return Err(Flaw::WrongVerdict { target, verdict: moved.verdict });
                }
                tolerance = moved.comparison.map_or(tolerance, |comparison| comparison.tolerance());
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
    ) -> Result<(), Flaw> {
        let column_of =
            |name: &str| self.table.columns.iter().position(|column| column.name == name).unwrap_or(usize::MAX);
        let cells = |role: Role, name: &str| -> (usize, Vec<usize>) {
            let column = column_of(name);
            let read = self.at_home(reads).filter(|read| read.role == role && read.column == column);
            (column, read.map(|read| read.row).collect())
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
            Extraction::Meeting(word) => shift(cells(Role::Coordinate, &word.over)),
            Extraction::Largest(word) | Extraction::Smallest(word) => shift(cells(Role::Value, &word.of)),
            Extraction::Interpolated(word) => shift(cells(Role::Value, &word.of)),
            Extraction::MeanOver(word) => shift(cells(Role::Value, &word.of)),
            Extraction::StandardDeviationOver(word) => {
                // The deviation of each variant moves as far as the baseline's, so that the sensitivity stays what it is.
                for variant in std::iter::once(BASELINE).chain(self.view(BASELINE, &Reads::default()).variants()) {
                    let own = Reads::default();
                    let Ok(there) = from.take(&self.view(variant, &own)) else { continue };
                    let own = own.cells();
                    let read = self
                        .at_home(&own)
                        .filter(|read| read.role == Role::Value && read.column == column_of(&word.of));
                    let rows: Vec<usize> = read.map(|read| read.row).collect();
                    let factor = (there.value + to - now) / there.value;
                    alter(table, column_of(&word.of), &rows, |x, _| x * factor);
                }
            }
            Extraction::Peak(peak) => match peak.read {
                Feature::Place => shift(cells(Role::Coordinate, &peak.over)),
                Feature::Height => {
                    let (column, rows) = cells(Role::Value, &peak.of);
                    alter(table, column, &rows, |x, _| x * to / now);
                }
                Feature::HalfPowerWidth => {
                    let at = Peak { read: Feature::Place, ..peak.clone() };
                    let place = at.take(&self.view(BASELINE, &Reads::default()));
                    let place = place.map_err(|absence| Flaw::Missing(absence.reason().to_string()))?.value;
                    let (column, rows) = cells(Role::Coordinate, &peak.over);
                    alter(table, column, &rows, |x, _| place + (x - place) * to / now);
                }
            },
            Extraction::PathMaximum(word) | Extraction::PathMinimum(word) => shift(cells(Role::Path, &word.of)),
            Extraction::NearestPassage(word) => shift(cells(Role::Path, word.read.as_deref().unwrap_or("time"))),
            Extraction::LargestStepBack(word) => {
                let (column, rows) = cells(Role::Value, &word.of);
                alter(table, column, &rows, |x, _| x * to / now);
            }
            Extraction::Times(times) => {
                return self.steer(table, &times.of, now / times.factor, to / times.factor, reads);
            }
            // Both are moved by what is read first, in all variants: the sensitivity stays what it is.
            Extraction::Ratio(quotient) => {
                for (column, rows) in self.values_of(&quotient.of) {
                    alter(table, column, &rows, |x, _| x * to / now);
                }
            }
            Extraction::Difference(difference) => {
                for (column, rows) in self.values_of(&difference.of) {
                    alter(table, column, &rows, |x, _| x + (to - now));
                }
            }
            Extraction::LargestLead(word) => {
                let is_above =
                    |row: &usize| self.table.texts(&word.by).is_some_and(|levels| levels[*row] == word.above);
                let (column, mut rows) = cells(Role::Value, &word.of);
                rows.retain(is_above);
                shift((column, rows));
            }
            Extraction::ArgmaxLead(word) => shift(cells(Role::Coordinate, &word.over)),
            Extraction::Number(_) => return Err(Flaw::FixedNumber),
        }
        Ok(())
    }

    /// The cells of measures that an extraction reads in any variant, by column.
    fn values_of(&self, extraction: &Extraction) -> BTreeMap<usize, Vec<usize>> {
        let read = Reads::default();
        for variant in std::iter::once(BASELINE).chain(self.view(BASELINE, &read).variants()) {
            // A variant without these rows reads nothing, which is what is wanted of it.
            let _ = extraction.take(&self.view(variant, &read));
        }
        let cells = read.cells();
        by_column(self.at_home(&cells).filter(|read| read.role == Role::Value))
    }

    /// True if a shape that is said to be different from another fails when it is that very one: no small damage makes two
    /// shapes alike.
    fn takes_no_double(&self, predicate: &Predicate, reads: &BTreeSet<Read>) -> Result<bool, Flaw> {
        let Predicate::ModeShape(claim) = predicate else { return Ok(false) };
        let double = claim.double(&self.view(BASELINE, &Reads::default()));
        let double = double.map_err(|absence| Flaw::Missing(absence.reason().to_string()))?;
        let mut table = self.table.clone();
        for (column, rows) in self.measures(reads) {
            if self.table.columns[column].name == *claim.of {
                alter(&mut table, column, &rows, |x, i| double.get(i % double.len().max(1)).copied().unwrap_or(x));
            }
        }
        Ok(self.judge(&table).verdict == Verdict::Differs)
    }

    /// Some change of the numbers that it reads must make a claim fail. One that two tops lie apart cannot be refuted on a
    /// coarse grid; it must at least be left open.
    fn broken_claim(&self, judged: &Judged, predicate: &Predicate, reads: &BTreeSet<Read>) -> Result<(), Flaw> {
        if judged.verdict == Verdict::Differs {
            return Ok(());
        }
        let reach = decide(predicate, &self.view(BASELINE, &Reads::default())).ok().and_then(|decision| decision.reach);
        if self.takes_no_double(predicate, reads)? {
            return Ok(());
        }
        let mut left_open = false;
        for (column, rows) in self.measures(reads) {
            // Halves of what no assumption moves: of two lines, each by itself.
            let own: Vec<usize> = rows.iter().copied().filter(|row| self.table.is_baseline(*row)).collect();
            let (first, second) = own.split_at(own.len().div_ceil(2));
            for (rows, spikes) in [(rows.as_slice(), SPIKES), (first, 0), (second, 0)] {
                let present = numbers(self.table, column, rows);
                for (damage, by) in damages(&present, spikes, reach) {
                    let mut table = self.table.clone();
                    damage.inflict(&mut table, column, rows, by);
                    match self.judge(&table).verdict {
                        Verdict::Differs => return Ok(()),
                        Verdict::Undecidable if judged.verdict != Verdict::Undecidable => left_open = true,
                        _ => {}
                    }
                }
            }
        }
        if left_open { Ok(()) } else { Err(Flaw::Unbreakable) }
    }
}

/// What is to be tried on these numbers, the smallest changes first: just past the claim's margin, where it has one in their
/// unit, and as far as the numbers themselves reach.
fn damages(present: &[f64], spikes: usize, reach: Option<f64>) -> Vec<(Damage, f64)> {
    let (low, high) = extremes(present);
    let far = 2.0 * (high - low).max(high.abs()).max(low.abs());
    let far = if far > 0.0 { far } else { 1.0 };
    let near = |reach: f64| std::iter::once(JUST_OUTSIDE).chain(FURTHER_OUTSIDE).map(move |times| times * reach);
    let sizes: Vec<f64> = reach.into_iter().flat_map(near).chain([far]).collect();
    let sized = |damage| sizes.iter().flat_map(move |&size| [(damage, size), (damage, -size)]);
    let sizes_of = |damage: Damage| if damage.has_size() { sized(damage).collect() } else { vec![(damage, 0.0)] };
    Damage::all(present.len(), spikes).into_iter().flat_map(sizes_of).collect()
}

fn by_column<'r>(reads: impl Iterator<Item = &'r Read>) -> BTreeMap<usize, Vec<usize>> {
    let mut columns: BTreeMap<usize, BTreeSet<usize>> = BTreeMap::new();
    for read in reads {
        columns.entry(read.column).or_default().insert(read.row);
    }
    columns.into_iter().map(|(column, rows)| (column, rows.into_iter().collect())).collect()
}
