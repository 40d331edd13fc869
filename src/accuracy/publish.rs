//! Measured errors and times to files: a record of what was measured, and from it and the verdicts pages, pictures and summary,
//! which can so be written again without measuring. Times differ from run to run, so that none of this stands in a file that
//! is compared.

use std::collections::BTreeMap;
use std::fs;

use super::measured::{Accuracy, Contender};
use super::over_cases::{DIVERGED, LEAST};
use super::page::{accuracy_page, accuracy_summary, case_name};
use super::scatter::scatter;
use super::verdict_price::VerdictPrice;
use super::view::AccuracyView;
use crate::atomic::{self, FileError};
use crate::experiment::Experiment;
use crate::figure::{Beside, draw, work_precision};
use crate::measure::SolverChoice;
use crate::reference::Judged;
use crate::study::{Layout, Machine, runs_of_a_row};
use crate::table::{BASELINE, Column, Data, Table};
use crate::text::json;
use crate::text::name;

/// The record, within the study.
const RECORD: &str = "reports/accuracy.json";
/// The folder of pages and pictures.
const PAGES: &str = "reports/accuracy";

/// What was measured of an experiment, and where.
#[derive(Debug, Clone, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct Measured {
    /// Where times were taken.
    pub machine: Machine,
    /// What was measured.
    pub accuracy: Accuracy,
}

/// Whether the record, pages and pictures can be written, before anything is measured; leaves nothing behind.
///
/// # Errors
/// [`FileError`] with the system's reason.
pub fn check_publishable(layout: &Layout) -> Result<(), FileError> {
    atomic::check_writable(&layout.path(RECORD))?;
    atomic::check_writable(&layout.path(PAGES).join("page.md"))
}

/// All that was measured so far, by experiment; what cannot be read counts as nothing.
#[must_use]
pub fn read_measured(layout: &Layout) -> BTreeMap<String, Measured> {
    let bytes = fs::read(layout.path(RECORD)).unwrap_or_default();
    serde_json::from_slice(&bytes).unwrap_or_default()
}

/// Adds what was measured of an experiment now to the record, and writes it.
///
/// # Errors
/// [`FileError`] if it cannot be written.
pub fn keep_measured(
    layout: &Layout,
    record: &mut BTreeMap<String, Measured>,
    experiment: &Experiment,
    accuracy: Accuracy,
) -> Result<(), FileError> {
    record.insert(experiment.id.to_string(), Measured { machine: Machine::here(), accuracy });
    let lines: Vec<String> =
        record.iter().map(|(id, measured)| format!("\"{id}\": {}", json::line(measured))).collect();
    atomic::write(&layout.path(RECORD), format!("{{\n{}\n}}\n", lines.join(",\n")).as_bytes())
}

/// What was measured of an experiment, beside the verdicts on it.
#[must_use]
pub fn accuracy_view(experiment: &Experiment, measured: Measured, judged: &[Judged]) -> AccuracyView {
    let factor = runs_of_a_row(experiment);
    AccuracyView {
        id: experiment.id.to_string(),
        title: experiment.title.clone(),
        machine: measured.machine,
        accuracy: measured.accuracy,
        entries: judged.iter().map(|one| VerdictPrice::of(one, factor)).collect(),
    }
}

/// Writes the page and the picture of one experiment; returns the page.
///
/// # Errors
/// [`FileError`] if a file cannot be written.
pub fn publish_accuracy(layout: &Layout, experiment: &Experiment, view: &AccuracyView) -> Result<String, FileError> {
    let id = &view.id;
    let table = table(&view.accuracy);
    let floors: Vec<f64> = view.accuracy.cases.iter().filter_map(|case| case.floor).collect();
    let floor = floors.iter().copied().reduce(f64::min);
    let events = table.floats("event_error").is_some_and(|errors| errors.iter().any(|error| error.is_finite()));
    let seconds = table.floats("time").unwrap_or_default();
    let times = seconds.iter().fold([f64::INFINITY, 0.0], |[low, high], time| [time.min(low), time.max(high)]);
    // A diagram without a single error to show has no picture; the table says so.
    if let Ok(picture) = draw(experiment, &work_precision(times, floor, events), &table, Beside::default()) {
        let path = layout.path(&format!("{PAGES}/{id}.png"));
        atomic::write_if_changed(&path, &picture.png)?;
    }
    let page = accuracy_page(view, &format!("{id}.png"));
    atomic::write_if_changed(&layout.path(&format!("{PAGES}/{id}.md")), page.as_bytes())?;
    Ok(page)
}

/// Writes the summary of all that was measured so far.
///
/// # Errors
/// [`FileError`] if it cannot be written.
pub fn publish_accuracy_summary(layout: &Layout, views: &[AccuracyView]) -> Result<String, FileError> {
    // Nothing measured, nothing to show.
    if let Ok(picture) = scatter(views) {
        atomic::write_if_changed(&layout.path("reports/accuracy.png"), &picture.png)?;
    }
    let text = accuracy_summary(views);
    atomic::write(&layout.path("reports/accuracy.md"), text.as_bytes())?;
    Ok(text)
}

/// A row a point, as the diagram wants it.
fn table(accuracy: &Accuracy) -> Table {
    let points = || {
        let cases = accuracy.cases.iter().enumerate();
        cases.flat_map(|(number, case)| case.points.iter().map(move |point| (number, point)))
    };
    let solver = |contender: Contender| match contender {
        Contender::EventDriven { .. } => SolverChoice::EventDriven.label(),
        Contender::FixedStep { .. } => "fixed_step".into(),
    };
    let shown = |error: f64| error.clamp(LEAST, DIVERGED);
    let floats = |name: &str, unit: &str, data: Vec<f64>| Column {
        name: name.into(),
        unit: unit.into(),
        symbol: String::new(),
        data: Data::Float(data),
    };
    let texts = |name: &str, data: Vec<String>| Column::new(name, Data::Text(data));
    Table {
        columns: vec![
            texts(name::VARIANT, points().map(|_| BASELINE.into()).collect()),
            texts(name::SOLVER, points().map(|(_, point)| solver(point.contender)).collect()),
            texts("case", points().map(|(number, _)| case_name(&accuracy.cases[number], number)).collect()),
            floats("time", "s", points().map(|(_, point)| point.times.median).collect()),
            floats("error", "", points().map(|(_, point)| shown(point.error)).collect()),
            floats(
                "event_error",
                "",
                points()
                    // Where the motion is chaotic, events part sooner or later whatever the solver.
                    .map(|(number, point)| point.events.error.filter(|_| accuracy.cases[number].floor.is_none()))
                    .map(|error| error.map_or(f64::NAN, shown))
                    .collect(),
            ),
        ],
        ..Table::default()
    }
}
