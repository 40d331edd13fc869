//! Branches to a table: a row for each orbit, in the order along each branch.

use std::collections::BTreeMap;

use super::failures::Failures;
use super::row_failure::RowFailure;
use super::tabulate::{measured, trust};
use super::variant::Variant;
use crate::dynamics::{Orbit, Special};
use crate::experiment::{BranchColumn, Continuation, Experiment, Stability};
use crate::measure::{Evaluated, Measure, Measured, SolverChoice};
use crate::table::{Column, Data, Table};
use crate::text::name;
use crate::text::words;

/// A point of a branch, or what stands in the place of a branch that could not begin.
pub(super) struct BranchRow {
    /// Index of the variant.
    pub variant: usize,
    /// From 1.
    pub branch: usize,
    pub parameter: f64,
    pub special: Option<Special>,
    /// Why the branch goes no further.
    pub ends: Vec<String>,
    pub orbit: Result<Orbit, RowFailure>,
    pub measured: Result<Evaluated, RowFailure>,
}

impl BranchRow {
    /// Why it has no numbers.
    fn failure(&self) -> Option<&RowFailure> {
        self.orbit.as_ref().err().or(self.measured.as_ref().err())
    }

    fn word(&self, column: BranchColumn) -> String {
        match (column, &self.orbit) {
            (BranchColumn::Stability, Ok(orbit)) => {
                let stability = if orbit.is_stable() { Stability::Stable } else { Stability::Unstable };
                stability.word().into()
            }
            (BranchColumn::SpecialPoint, _) => self.special.map_or("", Special::word).into(),
            (BranchColumn::BranchEnd, _) => self.ends.join("; "),
            _ => String::new(),
        }
    }

    fn count(&self, column: BranchColumn) -> i64 {
        let count = match (column, &self.orbit) {
            (BranchColumn::Branch, _) => self.branch as u64,
            (BranchColumn::Periods, Ok(orbit)) => u64::from(orbit.cycles),
            (BranchColumn::Contacts, Ok(orbit)) => orbit.contacts,
            _ => 0,
        };
        i64::try_from(count).unwrap_or(i64::MAX)
    }

    /// What is known of every orbit; its name is no number.
    fn of_orbit(&self, measure: Measure) -> f64 {
        let Ok(orbit) = &self.orbit else { return f64::NAN };
        let largest = orbit.multipliers.first();
        match measure {
            Measure::LargestMultiplier => largest.map_or(f64::NAN, |it| it.modulus),
            Measure::MultiplierAngle => largest.map_or(f64::NAN, |it| it.angle),
            Measure::MultiplierResidual => orbit.residual,
            _ => f64::NAN,
        }
    }
}

/// Rows without numbers.
pub(super) fn failures(rows: &[BranchRow]) -> Failures {
    Failures::of(rows.iter().filter_map(BranchRow::failure))
}

/// The table.
pub(super) fn table(
    experiment: &Experiment,
    continuation: &Continuation,
    variants: &[Variant],
    rows: &[BranchRow],
    metadata: BTreeMap<String, String>,
) -> Table {
    let texts = |cell: &dyn Fn(&BranchRow) -> String| Data::Text(rows.iter().map(cell).collect());
    let floats = |cell: &dyn Fn(&BranchRow) -> f64| Data::Float(rows.iter().map(cell).collect());
    let along = continuation.along;
    let parameter = Column::new(words::of_key(&along), floats(&|row| row.parameter));
    let mut columns = vec![parameter.with_unit(along.unit()).with_symbol(along.symbol())];
    columns.extend(BranchColumn::ALL.map(|column| {
        let data = if column.is_word() {
            texts(&|row| row.word(column))
        } else {
            Data::Int(rows.iter().map(|row| row.count(column)).collect())
        };
        Column::new(column.name(), data)
    }));
    columns.extend(Measure::OF_AN_ORBIT.map(|measure| {
        let name = words::of_key(&measure);
        if measure.is_name() {
            return Column::new(
                name,
                texts(&|row| row.orbit.as_ref().map_or_else(|_| String::new(), |o| o.kind.to_string())),
            );
        }
        let data = floats(&|row| row.of_orbit(measure));
        Column::new(name, data).with_unit(measure.unit()).with_symbol(measure.symbol())
    }));
    columns.push(Column::new(name::SOLVER, texts(&|_| SolverChoice::EventDriven.label())));
    columns.push(Column::new(name::VARIANT, texts(&|row| variants[row.variant].label.clone())));
    for (index, measure) in experiment.measures.iter().enumerate() {
        let of = |part: fn(&Measured) -> f64| {
            floats(&|row| row.measured.as_ref().map_or(f64::NAN, |it| it.measured.get(index).map_or(f64::NAN, part)))
        };
        columns.extend(measured(*measure, of));
    }
    let evaluated: Vec<Option<&Evaluated>> = rows.iter().map(|row| row.measured.as_ref().ok()).collect();
    let failures = texts(&|row| row.failure().map(ToString::to_string).unwrap_or_default());
    // Orbits are audited under all assumptions.
    columns.extend(trust(experiment, &evaluated, |_| true, failures));
    Table { columns, metadata, fingerprints: Vec::new() }
}
