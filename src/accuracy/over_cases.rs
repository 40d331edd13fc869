//! Error and time of a contender over the cases of an experiment.

use super::measured::{CaseAccuracy, Contender, Point};
use crate::measure::SolverChoice;
use crate::text::number::quantity;
use crate::text::words;

/// Errors as large as the number itself are in no line with smaller ones.
const SENSELESS: f64 = 0.3;
/// A run that is off by ten times the number has diverged; by how much says nothing and would only stretch an axis.
pub(super) const DIVERGED: f64 = 10.0;
/// Smallest error that a logarithmic axis shows: what is exact to the last digit stands here.
pub(super) const LEAST: f64 = 1e-16;

/// Every fixed step that all of these cases were run with, s.
pub(super) fn fixed_steps(cases: &[&CaseAccuracy]) -> Vec<(f64, Over)> {
    let mut steps: Vec<(f64, Over)> = Vec::new();
    for point in cases.iter().flat_map(|case| &case.points) {
        if let Contender::FixedStep { time_step } = point.contender
            && steps.iter().all(|(known, _)| *known != time_step)
            && let Some(of) = over(cases, point.contender)
        {
            steps.push((time_step, of));
        }
    }
    steps
}

/// The worst error of a contender over cases, and its time over all of them.
#[derive(Debug, Clone, Copy)]
pub(super) struct Over {
    pub error: f64,
    pub time: f64,
}

pub(super) fn over(cases: &[&CaseAccuracy], contender: Contender) -> Option<Over> {
    let points: Vec<&Point> =
        cases.iter().filter_map(|case| case.points.iter().find(|point| point.contender == contender)).collect();
    (points.len() == cases.len() && !points.is_empty()).then(|| Over {
        error: points.iter().map(|point| point.error).fold(0.0, f64::max),
        time: points.iter().map(|point| point.times.median).sum(),
    })
}

/// By how much the time grows when the error falls to a tenth: the slope of the straight line through log time over log error.
pub(super) fn next_digit(points: &[Over]) -> Option<f64> {
    let points: Vec<[f64; 2]> = points
        .iter()
        .filter(|of| of.error > 0.0 && of.error < SENSELESS)
        .map(|of| [libm::log10(of.error), libm::log10(of.time)])
        .collect();
    let count = points.len() as f64;
    let mean = |i: usize| points.iter().map(|point| point[i]).sum::<f64>() / count;
    let [x, y] = [mean(0), mean(1)];
    let square: f64 = points.iter().map(|point| (point[0] - x) * (point[0] - x)).sum();
    let product: f64 = points.iter().map(|point| (point[0] - x) * (point[1] - y)).sum();
    let span =
        points.iter().fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], [x, _]| [low.min(*x), high.max(*x)]);
    // A slope over less than one digit says nothing.
    (points.len() > 2 && span[1] - span[0] >= 1.0).then(|| libm::exp10(-product / square))
}

/// The fixed step that takes the least time of those within this error.
pub(super) fn cheapest(steps: &[(f64, Over)], error: f64) -> Option<(f64, Over)> {
    let within = steps.iter().filter(|(_, of)| of.error <= error);
    within.min_by(|a, b| a.1.time.total_cmp(&b.1.time)).copied()
}

/// `event-driven, windows × 0.5`; `fixed step 10 µs`.
pub(super) fn name(contender: Contender) -> String {
    match contender {
        Contender::EventDriven { window_factor: 1.0 } => "event-driven".into(),
        Contender::EventDriven { window_factor } => format!("event-driven, windows × {window_factor}"),
        Contender::FixedStep { time_step } => words::of_solver(&SolverChoice::FixedStep { time_step }.label()),
    }
}

pub(super) fn seconds(value: f64) -> String {
    quantity(value, "s", 3)
}
