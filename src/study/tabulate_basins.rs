//! Motions that random starts end in to a table, and back.
//!
//! The share of a motion is k of n starts. Its interval is Wilson's (J. Am. Stat. Assoc. 22, 209, 1927), the shares p from which k/n is
//! no more than z standard deviations away: |k/n − p| ≤ z √(p (1 − p)/n). It stays within 0 and 1, and has a width at both.

use std::collections::BTreeMap;

use super::failures::Failures;
use super::job::Job;
use super::tabulate::{self, Outcome, Row};
use super::untabulate::Cells;
use super::variant::Variant;
use crate::experiment::{BasinColumn, Experiment, Rank, Starts};
use crate::table::{Column, Data, RowFingerprint, Table};
use crate::text::name;

/// Standard deviations of the interval that readers are shown: 95 %.
const WIDE: f64 = 1.96;

/// A motion and the starts that end in it.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Basin {
    pub name: String,
    pub rank: Rank,
    pub starts: usize,
    pub rms_difference: f64,
}

/// A motion of a case, or what stands in the place of a case without one.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct BasinRow {
    pub basin: Option<Basin>,
    pub outcome: Outcome,
}

impl BasinRow {
    fn word(&self, column: BasinColumn) -> String {
        let Some(basin) = &self.basin else { return String::new() };
        match column {
            BasinColumn::Rank => basin.rank.word().into(),
            _ => basin.name.clone(),
        }
    }

    fn number(&self, column: BasinColumn, all: u32) -> f64 {
        let Some(basin) = &self.basin else { return f64::NAN };
        let (found, all) = (basin.starts as f64, f64::from(all));
        let share = found / all;
        match column {
            BasinColumn::Share => share,
            BasinColumn::ShareError => {
                let [low, high] = wilson(found, all, 1.0);
                (share - low).max(high - share)
            }
            BasinColumn::ShareSpread => 0.0,
            BasinColumn::ShareLow => wilson(found, all, WIDE)[0],
            BasinColumn::ShareHigh => wilson(found, all, WIDE)[1],
            BasinColumn::RmsDifference => basin.rms_difference,
            BasinColumn::Basin | BasinColumn::Rank | BasinColumn::Starts => f64::NAN,
        }
    }
}

/// Both ends of Wilson's interval of a share.
fn wilson(found: f64, all: f64, z: f64) -> [f64; 2] {
    let (share, square) = (found / all, z * z / all);
    let middle = share + 0.5 * square;
    let half = (square * (share * (1.0 - share) + 0.25 * square)).sqrt();
    // At 0 and 1 one end is the share itself; rounding would miss it.
    let low = if found == 0.0 { 0.0 } else { (middle - half) / (1.0 + square) };
    let high = if found == all { 1.0 } else { (middle + half) / (1.0 + square) };
    [low, high]
}

/// Rows without numbers.
pub(super) fn failures(lines: &[(Job, &BasinRow)]) -> Failures {
    Failures::of(lines.iter().filter_map(|(_, row)| row.outcome.as_ref().err()))
}

/// The table: that of the cases, a row for each of their motions, with what is said of it before the solver.
pub(super) fn table(
    experiment: &Experiment,
    starts: &Starts,
    variants: &[Variant],
    lines: &[(Job, &BasinRow)],
    fingerprints: Vec<RowFingerprint>,
    metadata: BTreeMap<String, String>,
) -> Table {
    let jobs: Vec<Job> = lines.iter().map(|(job, _)| *job).collect();
    let outcomes: Vec<&Outcome> = lines.iter().map(|(_, row)| &row.outcome).collect();
    let mut table = tabulate::table(experiment, variants, &jobs, &outcomes, fingerprints, metadata);
    let columns = BasinColumn::ALL.map(|column| {
        let data = if column.is_word() {
            Data::Text(lines.iter().map(|(_, row)| row.word(column)).collect())
        } else if column == BasinColumn::Starts {
            let count =
                |row: &BasinRow| row.basin.as_ref().map_or(0, |basin| i64::try_from(basin.starts).unwrap_or(i64::MAX));
            Data::Int(lines.iter().map(|(_, row)| count(row)).collect())
        } else {
            Data::Float(lines.iter().map(|(_, row)| row.number(column, starts.count)).collect())
        };
        Column::new(column.name(), data)
    });
    let at = table.columns.iter().position(|column| column.name == name::SOLVER).unwrap_or(0);
    table.columns.splice(at..at, columns);
    table
}

/// The rows of a case, from a table that holds them alone.
pub(super) fn read(experiment: &Experiment, table: &Table) -> Option<Vec<BasinRow>> {
    let cells = Cells::of(experiment, table)?;
    let texts = |column: BasinColumn| table.texts(column.name());
    let (names, ranks) = (texts(BasinColumn::Basin)?, texts(BasinColumn::Rank)?);
    let differences = table.floats(BasinColumn::RmsDifference.name())?;
    let Data::Int(starts) = &table.column(BasinColumn::Starts.name())?.data else { return None };
    let row = |row: usize| {
        let rank = Rank::of_word(&ranks[row])?;
        let basin = Basin {
            name: names[row].clone(),
            rank,
            starts: usize::try_from(starts[row]).ok()?,
            rms_difference: differences[row],
        };
        let whole: Row = cells.row(row)?;
        Some(BasinRow { basin: Some(basin), outcome: Ok(whole) })
    };
    (0..table.rows()).map(row).collect()
}

#[cfg(test)]
mod tests {
    use super::wilson;

    #[test]
    fn wilsons_interval_is_that_of_its_quadratic_and_stays_within_0_and_1() {
        for (found, all) in [(0.0, 50.0), (1.0, 7.0), (60.0, 200.0), (200.0, 200.0)] {
            for z in [1.0, 1.96] {
                for p in wilson(found, all, z) {
                    assert!((0.0..=1.0).contains(&p));
                    let away = found / all - p;
                    let off = away * away - z * z * p * (1.0 - p) / all;
                    assert!(off.abs() < 1e-14, "{found} of {all}: {p} misses by {off}");
                }
            }
        }
    }
}
