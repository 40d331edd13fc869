//! Work-precision diagrams: error against wall time, both logarithmic.

use crate::experiment::{Axis, AxisScale, AxisUnit, Band, Drawing, FigureSpec, Joined, Level, Panel};
use crate::text::name;

/// The figure of a table with the columns `solver`, `case`, `time` (s), `error` and `event_error`; all panels show the `times` from the
/// first to the second; `floor` is the error below which chaos leaves no meaning.
#[must_use]
pub fn work_precision(times: [f64; 2], floor: Option<f64>, events: bool) -> FigureSpec {
    let axis = |column: &str, label: &str, reach| Axis {
        label: Some(label.into()),
        scale: AxisScale::Log,
        reach,
        // Beside each other, figures are compared in one unit.
        unit: (column == "time").then(|| AxisUnit::own("s")),
        ..Axis::of(column)
    };
    let panel = |column: &str, label: &str, guides: Vec<Level>| Panel {
        x: axis("time", "Wall time of a run", Some(times)),
        y: vec![axis(column, label, None)],
        by: vec![name::SOLVER.into(), "case".into()],
        band: Band::None,
        over_first: false,
        guides,
        markers: true,
        peaks: None,
        strip: None,
        joined: Joined::ByX,
    };
    let guide = floor.map(|at| Level { at, label: "spread of the chaotic motion".into() });
    let mut panels = vec![panel("error", "Relative error", guide.into_iter().collect())];
    if events {
        panels.push(panel("event_error", "Error of event times / T", Vec::new()));
    }
    FigureSpec {
        name: String::new(),
        only: None,
        caption: "Error against wall time.".into(),
        drawing: Drawing::Lines(panels),
    }
}
