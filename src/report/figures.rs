//! Figures of one experiment.

use serde_json::json;

use super::quoted::{Said, quoted};
use crate::experiment::{Drawing, Experiment, FigureSpec, SCENE_DRAWING};
use crate::figure::{FigureError, Picture, draw, draw_svg, figure_stem};
use crate::study::{FileHash, PRESENTATION_VERSION, fingerprint};
use crate::table::Table;

/// File name of the drawing of what an experiment simulates.
#[must_use]
pub fn scene_name(experiment: &Experiment) -> String {
    format!("{}-{SCENE_DRAWING}.svg", experiment.id)
}

/// File name of a figure as pages show it: PNG, or SVG where it moves.
#[must_use]
pub fn figure_name(experiment: &Experiment, figure: &FigureSpec) -> String {
    let ending = if matches!(figure.drawing, Drawing::Animation(_)) { "svg" } else { "png" };
    format!("{}.{ending}", figure_stem(experiment, figure))
}

/// One figure, with the numbers that the study quotes.
pub(super) fn picture(
    experiment: &Experiment,
    figure: &FigureSpec,
    table: &Table,
    said: Said<'_>,
) -> Result<Picture, FigureError> {
    let quoted = quoted(experiment, figure, table, said);
    draw(experiment, figure, table, said.beside(&quoted))
}

/// As [`picture`], as SVG alone.
pub(super) fn vector(
    experiment: &Experiment,
    figure: &FigureSpec,
    table: &Table,
    said: Said<'_>,
) -> Result<String, FigureError> {
    let quoted = quoted(experiment, figure, table, said);
    draw_svg(experiment, figure, table, said.beside(&quoted))
}

/// Hash of all that one figure shows: the table of this hash, how it is drawn, and the numbers that the study quotes with their
/// tolerances. The caption stands on the page.
pub(super) fn shown(
    experiment: &Experiment,
    figure: &FigureSpec,
    table: &Table,
    table_hash: &FileHash,
    said: Said<'_>,
) -> String {
    let quoted: Vec<String> = quoted(experiment, figure, table, said).iter().map(|one| format!("{one:?}")).collect();
    fingerprint(&json!({
        "drawing": figure.drawing,
        "only": figure.only,
        // A maximum is told on its axis.
        "maximised": experiment.maximise.as_ref().map(|maximise| maximise.measure),
        "quoted": quoted,
        "impulses": said.impulses,
        "colours": said.colours,
        "table": table_hash.blake3,
        "presentation_version": PRESENTATION_VERSION,
    }))
}
