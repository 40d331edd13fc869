//! What is known of the tables that entries read, before anything runs.

use std::collections::{BTreeMap, BTreeSet};

use super::selection::Selection;
use crate::experiment::{Case, Columns, Experiment, Findings, Span};
use crate::table::Data;

/// Most values of a column that a message lists.
const MOST_LISTED: usize = 12;

/// The tables that entries may read.
pub(crate) struct KnownTables<'a> {
    /// The experiments that there are.
    pub(crate) ids: BTreeSet<&'a str>,
    /// The tables of those without mistakes, by their names.
    pub(crate) tables: BTreeMap<String, KnownTable>,
}

/// A table that an experiment will have.
pub(crate) struct KnownTable {
    pub(crate) columns: Columns,
    /// What its rows are of; `None` where that comes out of the run.
    cases: Option<Vec<Case>>,
}

impl KnownTable {
    pub(crate) fn of(experiment: &Experiment) -> Self {
        let is_known = experiment.refined.is_empty()
            && experiment.optimise.is_none()
            && experiment.orbit.is_none()
            && experiment.starts.is_none();
        Self { columns: experiment.columns(), cases: is_known.then(|| experiment.cases.clone()) }
    }

    /// Reports conditions that no row can meet, and more rows than the one that is meant `at` a place. `table` is its name.
    pub(crate) fn check_rows(&self, table: &str, rows: &Selection, one_row: Option<Span>, findings: &Findings) {
        let Some(cases) = &self.cases else { return };
        let mut left: Vec<&Case> = cases.iter().collect();
        let mut is_decided = true;
        for (column, allowed) in &rows.0 {
            let cells: Vec<Data> = cases.iter().filter_map(|case| case.cell(column)).collect();
            if cells.is_empty() {
                // A measure, or what comes with each row.
                is_decided &= &**column == "variant";
                continue;
            }
            if !cells.iter().any(|cell| allowed.admits(cell, 0)) {
                let message = format!("the table of `{table}` has no row with {column} {allowed}");
                findings.report::<()>(column.span(), message, Some(listed(column, &cells)));
                return;
            }
            left.retain(|case| case.cell(column).is_some_and(|cell| allowed.admits(&cell, 0)));
        }
        match (one_row, left.len()) {
            (_, 0) => {
                if let Some((column, _)) =
                    rows.0.iter().find(|(column, _)| cases.iter().any(|case| case.cell(column).is_some()))
                {
                    findings.wrong::<()>(column.span(), format!("the table of `{table}` has no row with {rows}"));
                }
            }
            (Some(at), count @ 2..) if is_decided => {
                let message = format!("`cell` reads one row, and {count} rows of the table of `{table}` are meant");
                findings.report::<()>(at, message, Some(leave_one(&left)));
            }
            _ => {}
        }
    }
}

/// The values of a column, in words.
fn listed(column: &str, cells: &[Data]) -> String {
    let mut values: Vec<String> = Vec::new();
    for value in cells.iter().map(in_words) {
        if !values.contains(&value) {
            values.push(value);
        }
    }
    match values.as_slice() {
        [first, .., last] if values.len() > MOST_LISTED => {
            format!("`{column}` has {} values, {first} to {last}", values.len())
        }
        _ => format!("`{column}` is {}", values.join(", ")),
    }
}

/// Which columns tell these rows apart.
fn leave_one(rows: &[&Case]) -> String {
    let names = rows.iter().flat_map(|case| case.columns()).collect::<BTreeSet<String>>();
    let differs = |name: &String| {
        let mut cells = rows.iter().map(|case| case.cell(name).as_ref().map(in_words));
        let first = cells.next();
        cells.any(|cell| Some(cell) != first)
    };
    let open: Vec<String> = names.into_iter().filter(differs).map(|name| format!("{name}: …")).collect();
    format!("add `where: {{{}}}`, or take `mean`, `largest` or `smallest` of them", open.join(", "))
}

fn in_words(cell: &Data) -> String {
    match cell {
        Data::Text(words) => words.concat(),
        Data::Float(numbers) if numbers == &[f64::INFINITY] => "infinite".into(),
        Data::Float(numbers) => numbers.iter().map(f64::to_string).collect(),
        Data::Int(_) | Data::FloatList(_) => String::new(),
    }
}
