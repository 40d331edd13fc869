//! Rows to a table: which column an experiment's numbers go into, and in which order.

use std::collections::BTreeMap;

use super::doubt;
use super::failures::Failures;
use super::job::Job;
use super::maximise::Place;
use super::row_failure::RowFailure;
use super::variant::Variant;
use crate::experiment::{Experiment, Parameter};
use crate::measure::{Evaluated, Measure, Measured, PROOF, ProofOf, TraceColumn};
use crate::table::{Column, Data, RowFingerprint, Table};
use crate::text::name;
use crate::text::words;

/// What came of a row.
pub(super) type Outcome = Result<Row, RowFailure>;

/// A row that could be computed.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Row {
    pub evaluated: Evaluated,
    /// Where the maximum lies, if there was one to look for.
    pub place: Option<Place>,
}

/// How many rows have no numbers, and why the first has none.
pub(super) fn failures(outcomes: &[&Outcome]) -> Failures {
    Failures::of(outcomes.iter().filter_map(|outcome| outcome.as_ref().err()))
}

/// The table of an experiment. `outcomes` and `fingerprints` stand in the order of `jobs`.
pub(super) fn table(
    experiment: &Experiment,
    variants: &[Variant],
    jobs: &[Job],
    outcomes: &[&Outcome],
    fingerprints: Vec<RowFingerprint>,
    metadata: BTreeMap<String, String>,
) -> Table {
    let mut columns = Vec::new();
    for parameter in &experiment.swept {
        columns.push(swept_column(experiment, jobs, *parameter));
    }
    let texts = |cell: &dyn Fn(usize) -> String| Data::Text((0..jobs.len()).map(cell).collect());
    if experiment.cases.iter().any(|case| !case.sweep.is_empty()) {
        columns.push(Column::new(name::SWEEP, texts(&|row| experiment.cases[jobs[row].case].sweep.clone())));
    }
    if experiment.cases.iter().any(|case| case.direction.is_some()) {
        let direction = |row: usize| experiment.cases[jobs[row].case].direction.as_ref().map(words::of_key);
        columns.push(Column::new(name::DIRECTION, texts(&|row| direction(row).unwrap_or_default())));
    }
    columns.push(Column::new(name::SOLVER, texts(&|row| jobs[row].solver.label())));
    columns.push(Column::new(name::VARIANT, texts(&|row| variants[jobs[row].variant].label.clone())));

    let floats = |cell: &dyn Fn(&Row) -> f64| {
        Data::Float(outcomes.iter().map(|outcome| outcome.as_ref().map_or(f64::NAN, cell)).collect())
    };
    for (index, measure) in experiment.measures.iter().enumerate() {
        let name = words::of_key(measure);
        if measure.is_name() {
            let of_row = |row: &Row| row.evaluated.motion.map(|motion| motion.to_string());
            columns.push(Column::new(
                &name,
                texts(&|row| outcomes[row].as_ref().ok().and_then(of_row).unwrap_or_default()),
            ));
            continue;
        }
        let of = |part: fn(&Measured) -> f64| floats(&|row| row.evaluated.measured.get(index).map_or(f64::NAN, part));
        columns.extend(measured(*measure, of));
        if let Some(maximise) = experiment.maximise.as_ref().filter(|maximise| maximise.measure == *measure) {
            let column = maximise.column();
            let place = |part: fn(&Place) -> f64| floats(&|row| row.place.as_ref().map_or(f64::NAN, part));
            let unit = maximise.over.unit();
            let within = Column::new(name::numerical(&column), place(|p| p.within)).with_unit(unit);
            columns.push(Column::new(column, place(|p| p.at)).with_unit(unit).with_symbol(maximise.over.symbol()));
            columns.push(within);
        }
    }
    let evaluated: Vec<Option<&Evaluated>> =
        outcomes.iter().map(|outcome| outcome.as_ref().ok().map(|row| &row.evaluated)).collect();
    let failure = |row: usize| outcomes[row].as_ref().err().map(ToString::to_string).unwrap_or_default();
    columns.extend(trust(experiment, &evaluated, |row| jobs[row].is_audited(), texts(&failure)));
    columns.extend(histories(experiment, jobs, outcomes));
    Table { columns, metadata, fingerprints }
}

/// A measure with its errors.
pub(super) fn measured(measure: Measure, of: impl Fn(fn(&Measured) -> f64) -> Data) -> [Column; 3] {
    let ([value, numerical, spread], unit) = (name::with_errors(&words::of_key(&measure)), measure.unit());
    [
        Column::new(value, of(|it| it.value)).with_unit(unit).with_symbol(measure.symbol()),
        Column::new(numerical, of(|it| it.numerical)).with_unit(unit),
        Column::new(spread, of(|it| it.spread)).with_unit(unit),
    ]
}

/// How far rows are to be trusted: what proves them, of those that are audited with their balances, and why a row has failed, which of its
/// numbers are undefined, and what is unknown of it.
pub(super) fn trust(
    experiment: &Experiment,
    rows: &[Option<&Evaluated>],
    is_audited: impl Fn(usize) -> bool,
    failures: Data,
) -> Vec<Column> {
    let audited = audited(rows, is_audited);
    let [momentum, energy, others @ ..] = proof(rows, &audited);
    let mut columns = vec![momentum, energy];
    columns.extend(doubt::residual_bounds(&audited));
    columns.extend(others);
    columns.push(Column::new(name::FAILURE, failures));
    columns.extend(doubt::undefined(experiment, rows.iter().copied()));
    columns.extend(doubt::unknown(rows.iter().copied()));
    columns
}

/// Of these rows those that a run stands behind, and nothing in the place of all others.
fn audited<'a>(rows: &[Option<&'a Evaluated>], is_one: impl Fn(usize) -> bool) -> Vec<Option<&'a Evaluated>> {
    rows.iter().enumerate().map(|(row, it)| it.filter(|it| it.members > 0 && is_one(row))).collect()
}

/// What proves the rows, of which some are audited, in columns; what a row does not have is NaN, or 0 of a count.
fn proof(rows: &[Option<&Evaluated>], audited: &[Option<&Evaluated>]) -> [Column; PROOF.len()] {
    let numbers = |rows: &[Option<&Evaluated>], of: fn(&Evaluated) -> f64| {
        Data::Float(rows.iter().map(|row| row.map_or(f64::NAN, of)).collect())
    };
    PROOF.map(|column| {
        let data = match column.of {
            ProofOf::Number(of) => numbers(rows, of),
            ProofOf::Residual(of) => numbers(audited, of),
            ProofOf::Count(of) => {
                let count = |row: &Option<&Evaluated>| row.map_or(0, |row| i64::try_from(of(row)).unwrap_or(i64::MAX));
                Data::Int(rows.iter().map(count).collect())
            }
        };
        Column::new(column.name, data).with_unit(column.unit)
    })
}

fn swept_column(experiment: &Experiment, jobs: &[Job], parameter: Parameter) -> Column {
    let value = |job: &Job| experiment.cases[job.case].get(parameter);
    let data = if !parameter.words().is_empty() {
        Data::Text(jobs.iter().map(|job| value(job).map_or_else(String::new, |word| words::of_key(&word))).collect())
    } else {
        let number = |job: &Job| experiment.cases[job.case].number(parameter).unwrap_or(f64::NAN);
        Data::Float(jobs.iter().map(number).collect())
    };
    Column::new(words::of_key(&parameter), data).with_unit(parameter.unit()).with_symbol(parameter.symbol())
}

/// The list columns: every name that some row has samples of, in the order of the first that has; empty where a row has none.
fn histories(experiment: &Experiment, jobs: &[Job], outcomes: &[&Outcome]) -> Vec<Column> {
    let of_row = |row: usize| -> &[TraceColumn] {
        let kept = jobs[row].variant == 0 || experiment.trace.is_some();
        outcomes[row].as_ref().ok().filter(|_| kept).map_or(&[], |row| &row.evaluated.trace)
    };
    let mut columns: Vec<Column> = Vec::new();
    for row in 0..outcomes.len() {
        for history in of_row(row).iter().filter(|history| !history.samples.is_empty()) {
            if columns.iter().all(|column| column.name != history.name) {
                let cell = |row| {
                    let same = of_row(row).iter().find(|other| other.name == history.name);
                    same.map_or_else(Vec::new, |other| other.samples.clone())
                };
                let cells = Data::FloatList((0..outcomes.len()).map(cell).collect());
                columns.push(Column::new(history.name.clone(), cells).with_unit(history.unit.clone()));
            }
        }
    }
    columns
}

/// The measures that a row asks for: a maximum's own measure is always among them.
pub(super) fn maximised_index(experiment: &Experiment, of: Measure) -> Option<usize> {
    experiment.measures.iter().position(|measure| *measure == of)
}
