//! Measured errors and times to files: pictures, pages, the summary. Times differ from run to run, so that none of this stands
//! in a file that is compared.

use std::collections::BTreeMap;
use std::fs;

use super::measured::{Accuracy, CaseAccuracy, Contender};
use super::page::{AccuracyView, DIVERGED, accuracy_page, accuracy_summary};
use super::scatter::scatter;
use super::verdict_price::VerdictPrice;
use crate::atomic::{self, FileError};
use crate::experiment::Experiment;
use crate::figure::{Beside, Picture, draw, work_precision};
use crate::measure::{SolverChoice, column_words};
use crate::reference::Judged;
use crate::study::{Layout, Machine, runs_of_a_row};
use crate::table::{BASELINE, Column, Data, Table};
use crate::text::number::compact;

/// Smallest error that a logarithmic axis shows: what is exact to the last digit stands here.
const LEAST: f64 = 1e-16;

/// Where measurements wait for the summary, within the study.
const MEASURED: &str = "results/accuracy";

/// Writes the page and the picture of one experiment, with what its verdicts cost, and keeps what was measured for the summary; returns the page.
///
/// # Errors
/// [`FileError`] if a file cannot be written.
pub fn publish_accuracy(
    layout: &Layout,
    experiment: &Experiment,
    accuracy: Accuracy,
    judged: &[Judged],
) -> Result<String, FileError> {
    let id = experiment.id.to_string();
    let table = table(&accuracy);
    let floors: Vec<f64> = accuracy.cases.iter().filter_map(|case| case.floor).collect();
    let floor = floors.iter().copied().reduce(f64::min);
    let events = table.floats("event_error").is_some_and(|errors| errors.iter().any(|error| error.is_finite()));
    let seconds = table.floats("time").unwrap_or_default();
    let times = seconds.iter().fold([f64::INFINITY, 0.0], |[low, high], time| [time.min(low), time.max(high)]);
    // A diagram without a single error to show has no picture; the table says so.
    if let Ok(picture) = draw(experiment, &work_precision(times, floor, events), &table, Beside::default()) {
        write_picture(layout, &format!("reports/accuracy/{id}"), &picture)?;
    }
    let factor = runs_of_a_row(experiment);
    let view = AccuracyView {
        id: id.clone(),
        title: experiment.title.clone(),
        machine: Machine::here(),
        accuracy,
        entries: judged.iter().map(|one| VerdictPrice::of(one, factor)).collect(),
    };
    let page = accuracy_page(&view, &format!("{id}.png"));
    atomic::write(&layout.path(&format!("reports/accuracy/{id}.md")), page.as_bytes())?;
    let kept = serde_json::to_vec(&view).unwrap_or_default();
    atomic::write(&layout.path(&format!("{MEASURED}/{id}.json")), &kept)?;
    Ok(page)
}

/// Writes the summary of all that was measured so far.
///
/// # Errors
/// [`FileError`] if it cannot be written.
pub fn publish_accuracy_summary(layout: &Layout) -> Result<String, FileError> {
    let mut views = BTreeMap::new();
    for entry in fs::read_dir(layout.path(MEASURED)).into_iter().flatten().flatten() {
        let bytes = fs::read(entry.path()).unwrap_or_default();
        // What another version has left does not count.
        if let Ok(view) = serde_json::from_slice::<AccuracyView>(&bytes) {
            views.insert(view.id.clone(), view);
        }
    }
    let views: Vec<AccuracyView> = views.into_values().collect();
    // Nothing measured, nothing to show.
    if let Ok(picture) = scatter(&views) {
        write_picture(layout, "reports/accuracy", &picture)?;
    }
    let text = accuracy_summary(&views);
    atomic::write(&layout.path("reports/accuracy.md"), text.as_bytes())?;
    Ok(text)
}

/// A case by what sets it apart; by its number where nothing does.
fn case_name(case: &CaseAccuracy, number: usize) -> String {
    if case.description.is_empty() {
        return format!("case {}", number + 1);
    }
    let part = |part: &str| {
        let Some((name, value)) = part.split_once(" = ") else { return part.to_owned() };
        let value = value.parse::<f64>().map_or_else(|_| value.to_owned(), |value| compact(value, 3));
        format!("{} {value}", column_words(name))
    };
    case.description.split(", ").map(part).collect::<Vec<_>>().join(", ")
}

fn write_picture(layout: &Layout, stem: &str, picture: &Picture) -> Result<(), FileError> {
    atomic::write_if_changed(&layout.path(&format!("{stem}.svg")), picture.svg.as_bytes())?;
    atomic::write_if_changed(&layout.path(&format!("{stem}.png")), &picture.png)?;
    Ok(())
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
            texts("variant", points().map(|_| BASELINE.into()).collect()),
            texts("solver", points().map(|(_, point)| solver(point.contender)).collect()),
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
