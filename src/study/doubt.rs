//! What a table says of rows whose numbers are to be doubted: columns that are there only where some row gives cause.

use crate::experiment::Experiment;
use crate::measure::{Evaluated, Particles};
use crate::table::{Column, Data, UNDEFINED, UNKNOWN};

pub(super) use crate::table::RESIDUAL_BOUND;

/// The bound that the residuals of an audited row exceed; NaN in all other rows.
pub(super) fn residual_bounds(audited: &[Option<&Evaluated>]) -> Option<Column> {
    let exceeded = |row: &Option<&Evaluated>| {
        row.map(|row| row.proof).filter(|proof| !proof.is_balanced()).map_or(f64::NAN, |proof| proof.residual_bound)
    };
    let bounds: Vec<f64> = audited.iter().map(exceeded).collect();
    bounds.iter().any(|bound| !bound.is_nan()).then(|| Column::new(RESIDUAL_BOUND, Data::Float(bounds)))
}

/// Which numbers of a row are undefined, and why; empty in other rows.
pub(super) fn undefined<'a>(
    experiment: &Experiment,
    rows: impl Iterator<Item = Option<&'a Evaluated>>,
) -> Option<Column> {
    let particles = match experiment.recipe.dampers.as_slice() {
        [] => Particles::One,
        [one] if one.array.is_none() => Particles::One,
        _ => Particles::Several,
    };
    let of_row =
        |row: Option<&Evaluated>| row.map_or_else(String::new, |row| row.undefined(&experiment.measures, particles));
    texts(UNDEFINED, rows.map(of_row).collect())
}

/// What is unknown of a row, and why; empty in other rows.
pub(super) fn unknown<'a>(rows: impl Iterator<Item = Option<&'a Evaluated>>) -> Option<Column> {
    let of_row = |row: Option<&Evaluated>| row.and_then(|row| row.unknown.clone()).unwrap_or_default();
    texts(UNKNOWN, rows.map(of_row).collect())
}

fn texts(name: &str, texts: Vec<String>) -> Option<Column> {
    texts.iter().any(|text| !text.is_empty()).then(|| Column::new(name, Data::Text(texts)))
}
