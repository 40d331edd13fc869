//! A row by what is swept.

use crate::experiment::{Experiment, Parameter};
use crate::table::Table;
use crate::text::name;
use crate::text::number::quantity;
use crate::text::words::of_key;

/// A row by what is swept: `f′ = 2.5, h′ = 50`; empty where nothing is.
#[must_use]
pub fn row_in_words(experiment: &Experiment, table: &Table, row: usize) -> String {
    described(experiment, table, row, |_| true)
}

/// A row by those swept parameters that are wanted.
pub(super) fn described(
    experiment: &Experiment,
    table: &Table,
    row: usize,
    wanted: impl Fn(Parameter) -> bool,
) -> String {
    let parts = experiment.swept.iter().filter(|parameter| wanted(**parameter)).filter_map(|parameter| {
        let column = of_key(parameter);
        let name = if parameter.symbol().is_empty() { column.replace('_', " ") } else { parameter.symbol().into() };
        let value = match (table.floats(&column), table.texts(&column)) {
            (Some(numbers), _) if !numbers[row].is_nan() => quantity(numbers[row], parameter.unit(), 4),
            (None, Some(words)) if !words[row].is_empty() => words[row].clone(),
            _ => return None,
        };
        Some(format!("{name} = {value}"))
    });
    let direction = table.texts(name::DIRECTION).map(|words| words[row].clone()).filter(|word| !word.is_empty());
    parts.chain(direction).collect::<Vec<_>>().join(", ")
}
