//! Figures of one experiment.

use serde_json::json;

use crate::experiment::{Drawing, Experiment, FigureSpec};
use crate::figure::{FigureError, QuotedPoint, draw};
use crate::reference::{Allowed, Check, Entry, Extraction, ReferenceFile};
use crate::study::{FileHash, PRESENTATION_VERSION, fingerprint};
use crate::table::Table;

/// File name of a figure: the experiment's id, and the figure's own name if it is not the first.
#[must_use]
pub fn figure_name(experiment: &Experiment, figure: &FigureSpec) -> String {
    if figure.name.is_empty() {
        format!("{}.png", experiment.id)
    } else {
        format!("{}-{}.png", experiment.id, figure.name)
    }
}

/// The PNG of one figure, with the numbers that the study quotes.
pub(super) fn png(
    experiment: &Experiment,
    figure: &FigureSpec,
    table: &Table,
    reference: Option<&ReferenceFile>,
) -> Result<Vec<u8>, FigureError> {
    draw(experiment, figure, table, &quoted(figure, table, reference))
}

/// Hash of all that one figure shows: the table of this hash, how it is drawn, and the numbers that the study quotes. The caption
/// stands on the page, and tolerances nowhere.
pub(super) fn shown(
    experiment: &Experiment,
    figure: &FigureSpec,
    table: &Table,
    table_hash: &FileHash,
    reference: Option<&ReferenceFile>,
) -> String {
    let quoted: Vec<String> = quoted(figure, table, reference)
        .iter()
        .map(|QuotedPoint { column, x, y, label }| format!("{column} {x:?} {y:?} {label}"))
        .collect();
    fingerprint(&json!({
        "drawing": figure.drawing,
        // A maximum is told on its axis.
        "maximised": experiment.maximise.as_ref().map(|maximise| maximise.measure),
        "quoted": quoted,
        "table": table_hash.blake3,
        "presentation_version": PRESENTATION_VERSION,
    }))
}

/// The numbers that the study quotes of what a figure draws.
fn quoted(figure: &FigureSpec, table: &Table, reference: Option<&ReferenceFile>) -> Vec<QuotedPoint> {
    let entries = reference.map_or(&[][..], |reference| &reference.entries);
    match &figure.drawing {
        Drawing::Lines(panels) => panels
            .first()
            .map(|panel| entries.iter().filter_map(|entry| quoted_point(entry, &panel.x.column, table)).collect())
            .unwrap_or_default(),
        // A quoted number has no place among colours.
        Drawing::Map(_) => Vec::new(),
    }
}

/// What an entry quotes of a curve over `x`: a point, the height of a maximum, or its place. Other numbers (onsets, ratios
/// of two curves, another experiment's) have no place in the picture.
fn quoted_point(entry: &Entry, x: &str, table: &Table) -> Option<QuotedPoint> {
    let Check::Value { published, from, .. } = &entry.check else { return None };
    let in_unit_of = |column: &str| Some(published.converted_to(&table.column(column)?.unit)?.0);
    let (column, x, y) = match from {
        Extraction::Cell(cell) if cell.table.is_none() => {
            let rows = entry.rows.and(&cell.rows);
            let Some(Allowed::Number(at)) = rows.0.get(x) else { return None };
            (&cell.of, *at, in_unit_of(&cell.of)?)
        }
        Extraction::Maximum(top) if top.table.is_none() && top.over == x => (&top.of, f64::NAN, in_unit_of(&top.of)?),
        Extraction::Argmax(top) if top.table.is_none() && top.over == x => (&top.of, in_unit_of(x)?, f64::NAN),
        _ => return None,
    };
    Some(QuotedPoint { column: column.clone(), x, y, label: "study".into() })
}
