//! All experiments in one picture: the error of a run against its time, event-driven and with the cheapest fixed step that would do
//! for every verdict; a line at the u_val of each number, from which on a run is accurate enough.

use super::measured::Contender;
use super::over_cases::{LEAST, Over, cheapest, fixed_steps, over};
use super::view::AccuracyView;
use crate::experiment::{Axis, AxisScale, AxisUnit, Band, Drawing, FigureSpec, Joined, Level, Panel};
use crate::figure::{FigureError, Picture, draw_table};
use crate::table::{BASELINE, Column, Data, Table};
use crate::text::name;
use crate::text::number::significant;
use crate::text::words::counted;

/// What a run has to reach for entries that are claims, without a tolerance of their own.
const FOR_CLAIMS: f64 = 0.01;

/// One run of a solver.
#[derive(Debug, Clone, Copy)]
struct Run {
    /// s.
    time: f64,
    /// Relative.
    error: f64,
}

/// An experiment in the picture.
pub(super) struct Compared {
    event_driven: Run,
    /// The cheapest fixed step within every tolerance; none of those tried may be.
    fixed_step: Option<Run>,
    /// Its entries are claims alone.
    claims: bool,
    /// u_val of its numbers, relative.
    wanted: Vec<f64>,
}

/// The experiments that have a case that is not chaotic, and entries.
pub(super) fn points(views: &[AccuracyView]) -> Vec<Compared> {
    let compared = |view: &AccuracyView| {
        let regular = view.accuracy.regular();
        let own = over(&regular, Contender::EXACT).filter(|_| !view.entries.is_empty())?;
        let tolerance = view.entries.iter().filter_map(|entry| entry.tolerance).reduce(f64::min);
        let step = cheapest(&fixed_steps(&regular), tolerance.unwrap_or(FOR_CLAIMS));
        let a_run = |of: Over| Run { time: of.time / regular.len() as f64, error: of.error.max(LEAST) };
        Some(Compared {
            event_driven: a_run(own),
            fixed_step: step.map(|(_, of)| a_run(of)),
            claims: tolerance.is_none(),
            wanted: view.entries.iter().filter_map(|entry| entry.uncertainty).collect(),
        })
    };
    views.iter().filter_map(compared).collect()
}

/// What the picture shows, in a sentence or two.
pub(super) fn in_words(points: &[Compared]) -> String {
    let both: Vec<(Run, Run)> = points.iter().filter_map(|it| Some((it.event_driven, it.fixed_step?))).collect();
    let without = points.len() - both.len();
    let middle = |of: &dyn Fn(&(Run, Run)) -> f64| {
        let mut values: Vec<f64> = both.iter().map(of).collect();
        values.sort_by(f64::total_cmp);
        values.get(values.len() / 2).copied()
    };
    let ratios =
        (middle(&|(own, step)| step.time / own.time), middle(&|(own, _)| own.error), middle(&|(_, step)| step.error));
    let (Some(time), Some(own), Some(step)) = ratios else { return String::new() };
    let slower = both.iter().filter(|(own, step)| step.time > own.time).count();
    let mut text = format!(
        "**In short.** The cheapest fixed step that is accurate enough for every verdict takes × {} the time of the event-driven run \
         (median of {}; longer in {slower} of them), with an error of {} where the event-driven run has {}.",
        significant(time, 2),
        counted(both.len(), "experiment", "experiments"),
        significant(step, 1),
        significant(own, 1)
    );
    if without > 0 {
        text += &format!(
            " In {} no step tried is accurate enough.",
            counted(without, "further experiment", "further experiments")
        );
    }
    text + "\n\n"
}

/// The picture.
///
/// # Errors
/// [`FigureError`] if there is nothing to draw.
pub(super) fn scatter(views: &[AccuracyView]) -> Result<Picture, FigureError> {
    let points = points(views);
    let steps = |claims: bool| {
        let of_kind = points.iter().filter(move |it| it.claims == claims);
        of_kind.filter_map(|it| it.fixed_step).collect::<Vec<_>>()
    };
    let kinds = [
        ("event-driven", points.iter().map(|it| it.event_driven).collect()),
        ("cheapest fixed step within every tolerance", steps(false)),
        ("cheapest fixed step within 1 %, for claims", steps(true)),
    ];
    // A point by itself: no line leads to the next.
    let list = |name: &str, unit: &str, of: fn(&Run) -> f64| {
        let cells = kinds.iter().map(|(_, runs)| runs.iter().flat_map(|run| [of(run), f64::NAN]).collect());
        Column::new(name, Data::FloatList(cells.collect())).with_unit(unit)
    };
    let texts = |name: &str, cells: Vec<String>| Column::new(name, Data::Text(cells));
    let table = Table {
        columns: vec![
            texts(name::VARIANT, vec![BASELINE.into(); kinds.len()]),
            texts("kind", kinds.iter().map(|(kind, _)| (*kind).into()).collect()),
            list("time", "s", |run| run.time),
            list("error", "", |run| run.error),
        ],
        ..Table::default()
    };
    let wanted = points.iter().flat_map(|it| &it.wanted).copied().filter(|u| *u > 0.0).collect();
    draw_table("accuracy", &figure(wanted), &table)
}

fn figure(wanted: Vec<f64>) -> FigureSpec {
    let axis = |column: &str, label: &str| Axis {
        label: Some(label.into()),
        scale: AxisScale::Log,
        unit: (column == "time").then(|| AxisUnit::own("s")),
        ..Axis::of(column)
    };
    let label = |first: bool| if first { "u_val of a number: accurate enough from here on" } else { "" };
    let guide = |(index, at): (usize, f64)| Level { at, label: label(index == 0).into() };
    let panel = Panel {
        x: axis("time", "Wall time of a run"),
        y: vec![axis("error", "Relative error")],
        by: vec!["kind".into()],
        band: Band::None,
        over_first: false,
        guides: wanted.into_iter().enumerate().map(guide).collect(),
        markers: true,
        peaks: None,
        strip: None,
        joined: Joined::ByX,
    };
    FigureSpec {
        name: String::new(),
        caption: "Error against time of every experiment.".into(),
        only: None,
        drawing: Drawing::Lines(vec![panel]),
    }
}
