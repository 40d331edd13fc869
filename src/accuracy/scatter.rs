//! All experiments in one picture: the error of a run against its time, event-driven and with the cheapest fixed step that would do for
//! every verdict; beside the latter what the verdicts ask for, their u_val.

use super::measured::{CaseAccuracy, Contender};
use super::page::{AccuracyView, Over, fixed_steps, over};
use crate::experiment::{Axis, AxisScale, Band, Drawing, FigureSpec, Panel};
use crate::figure::{FigureError, Picture, draw_table};
use crate::table::{BASELINE, Column, Data, Table};

/// Least error shown: what is exact to the last digit.
const LEAST: f64 = 1e-16;

/// Points of one kind.
#[derive(Default)]
struct Points {
    times: Vec<f64>,
    errors: Vec<f64>,
}

impl Points {
    /// A point by itself: no line leads to the next.
    fn add(&mut self, time: f64, error: f64) {
        self.times.extend([time, f64::NAN]);
        self.errors.extend([error.max(LEAST), f64::NAN]);
    }
}

/// The picture.
///
/// # Errors
/// [`FigureError`] if there is nothing to draw.
pub(super) fn scatter(views: &[AccuracyView]) -> Result<Picture, FigureError> {
    let (mut exact, mut fixed, mut wanted) = (Points::default(), Points::default(), Points::default());
    for view in views {
        let regular: Vec<&CaseAccuracy> = view.accuracy.cases.iter().filter(|case| case.floor.is_none()).collect();
        let count = regular.len() as f64;
        let Some(own) = over(&regular, Contender::EventDriven { window_factor: 1.0 }) else { continue };
        exact.add(own.time / count, own.error);
        let tolerance = view.entries.iter().filter_map(|entry| entry.tolerance).reduce(f64::min);
        let does = |of: &Over| tolerance.is_some_and(|tolerance| of.error <= tolerance);
        let steps = fixed_steps(&regular);
        let cheapest =
            steps.iter().map(|(_, of)| of).filter(|of| does(of)).min_by(|a, b| a.time.total_cmp(&b.time)).copied();
        if let Some(step) = cheapest {
            fixed.add(step.time / count, step.error);
            view.entries.iter().filter_map(|entry| entry.uncertainty).for_each(|u| wanted.add(step.time / count, u));
        }
    }
    let kinds = [
        ("event-driven", exact),
        ("cheapest fixed step within every tolerance", fixed),
        ("u_val of the verdicts: accurate enough from here on", wanted),
    ];
    let list = |name: &str, unit: &str, of: fn(&Points) -> &Vec<f64>| {
        Column::new(name, Data::FloatList(kinds.iter().map(|(_, points)| of(points).clone()).collect())).with_unit(unit)
    };
    let texts = |name: &str, cells: Vec<String>| Column::new(name, Data::Text(cells));
    let table = Table {
        columns: vec![
            texts("variant", vec![BASELINE.into(); kinds.len()]),
            texts("kind", kinds.iter().map(|(kind, _)| (*kind).into()).collect()),
            list("time", "s", |points| &points.times),
            list("error", "", |points| &points.errors),
        ],
        ..Table::default()
    };
    draw_table("accuracy", &figure(), &table)
}

fn figure() -> FigureSpec {
    let axis = |column: &str, label: &str| Axis {
        column: column.into(),
        label: Some(label.into()),
        scale: AxisScale::Log,
        reach: None,
    };
    let panel = Panel {
        x: axis("time", "Wall time of a run"),
        y: vec![axis("error", "Relative error")],
        by: vec!["kind".into()],
        band: Band::None,
        over_first: false,
        guides: Vec::new(),
        markers: true,
        peaks: None,
        strip: None,
    };
    FigureSpec {
        name: String::new(),
        caption: "Error against time of every experiment.".into(),
        only: None,
        drawing: Drawing::Lines(vec![panel]),
    }
}
