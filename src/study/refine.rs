//! Refined sweeps: points are added to a curve where a straight line between two neighbours would miss it.
//!
//! At every point the chord of its two neighbours is missed by some y; over the product of the distances that is half a
//! second derivative, and with it the error in the middle of the intervals beside. In rounds, every interval that misses by
//! more than the tolerance is halved, the widest first. A resonance shows in its flanks long before a point falls into it.
//!
//! What is within the spread of the ensembles is noise and attracts nothing; nor do chaotic stretches, whose curve is no
//! smoother the closer one looks. The points of a curve depend on its own values alone, never on threads or other curves.

use rayon::prelude::*;

use super::tabulate::Outcome;
use super::threshold::{self, number_of};
use crate::experiment::{Assumptions, AxisScale, Case, Curve, Experiment, Refinement, curves};
use crate::measure::Measured;

/// Halvings of the first intervals, at most: from 3 rad/s to 0.0002 rad/s.
const MOST_HALVINGS: u32 = 14;
/// The same beside a chaotic point.
const MOST_CHAOTIC_HALVINGS: u32 = 3;
/// Spreads within which a curve may be straight.
const NOISE: f64 = 2.0;

/// A case of the experiment once its curves are complete.
pub(super) struct Point {
    pub case: Case,
    /// What came of it under its first solver at the baseline; `None` where it lies on no curve.
    pub known: Option<Outcome>,
}

/// All cases with those that were added, curve by curve in the order of their first cases.
pub(super) fn points(
    experiment: &Experiment,
    assumptions: &Assumptions,
    look: &(impl Fn(&Case) -> Outcome + Sync),
) -> Vec<Point> {
    let curves = curves(&experiment.cases, &experiment.refined);
    let refined: Vec<Vec<Point>> =
        curves.par_iter().map(|curve| refine(experiment, assumptions, curve, look)).collect();
    let mut on_a_curve = vec![false; experiment.cases.len()];
    curves.iter().flat_map(|curve| &curve.cases).for_each(|&case| on_a_curve[case] = true);
    let mut refined: Vec<(usize, Vec<Point>)> =
        curves.iter().map(|curve| curve.cases.first().copied().unwrap_or(0)).zip(refined).collect();
    let single = experiment.cases.iter().enumerate().filter(|(index, _)| !on_a_curve[*index]);
    refined.extend(single.map(|(index, case)| (index, vec![Point { case: case.clone(), known: None }])));
    refined.sort_by_key(|(first, _)| *first);
    refined.into_iter().flat_map(|(_, points)| points).collect()
}

/// A point of a curve as the rule sees it.
struct Seen {
    /// The parameter on the scale of the spacing.
    at: f64,
    /// Value and spread of each measure that decides, on the scale of the values; NaN where there is none.
    values: Vec<[f64; 2]>,
    chaotic: bool,
    point: Point,
}

fn refine(
    experiment: &Experiment,
    assumptions: &Assumptions,
    curve: &Curve<'_>,
    look: &(impl Fn(&Case) -> Outcome + Sync),
) -> Vec<Point> {
    let rule = curve.rule;
    let see = |case: Case| {
        let known = look(&case);
        let parameter = number_of(&case, rule.over);
        let at = if rule.spacing == AxisScale::Log { libm::log10(parameter) } else { parameter };
        let chaotic = known.as_ref().is_ok_and(|row| row.evaluated.may_be_chaotic());
        Seen { at, values: values(experiment, rule, &known), chaotic, point: Point { case, known: Some(known) } }
    };
    let mut first: Vec<Case> = curve.cases.iter().map(|&case| experiment.cases[case].clone()).collect();
    if let Some(threshold) = rule.around {
        first.extend(threshold::around(experiment, assumptions, threshold, rule.over, &first));
    }
    let mut seen: Vec<Seen> = first.into_par_iter().map(see).collect();
    seen.sort_by(|a, b| a.at.total_cmp(&b.at));
    let widest = seen.windows(2).fold(0.0_f64, |widest, pair| widest.max(pair[1].at - pair[0].at));
    loop {
        let room = (rule.most as usize).saturating_sub(seen.len());
        let mut wanted = bent(&seen, rule, widest);
        wanted.truncate(room);
        let new: Vec<Case> = wanted.iter().map(|&i| between(&seen[i], &seen[i + 1], rule)).collect();
        if new.is_empty() {
            break;
        }
        seen.extend(new.into_par_iter().map(see).collect::<Vec<_>>());
        seen.sort_by(|a, b| a.at.total_cmp(&b.at));
    }
    seen.into_iter().map(|seen| seen.point).collect()
}

/// The measures that decide.
fn values(experiment: &Experiment, rule: &Refinement, outcome: &Outcome) -> Vec<[f64; 2]> {
    let Ok(row) = outcome else { return Vec::new() };
    let wanted = experiment
        .measures
        .iter()
        .zip(&row.evaluated.measured)
        // Kinds of motion jump from one to the next; only those that are asked for are followed.
        .filter(|(measure, _)| match rule.measures.as_slice() {
            [] => !measure.jumps(),
            named => named.contains(measure),
        });
    wanted
        .map(|(_, Measured { value, spread, .. })| match rule.value_scale {
            AxisScale::Linear => [*value, *spread],
            AxisScale::Log => [libm::log(*value), spread / value],
        })
        .collect()
}

/// The intervals that a straight line misses by more than it may, by their first point; the widest first, of equal ones
/// the worst.
fn bent(seen: &[Seen], rule: &Refinement, widest: f64) -> Vec<usize> {
    let mut wanted: Vec<(f64, f64, usize)> = Vec::new();
    for i in 0..seen.len().saturating_sub(1) {
        let [low, high] = [&seen[i], &seen[i + 1]];
        let width = high.at - low.at;
        let halvings = if low.chaotic || high.chaotic { MOST_CHAOTIC_HALVINGS } else { MOST_HALVINGS };
        if width * f64::from(1_u32 << halvings) <= 1.5 * widest {
            continue;
        }
        let middles = [i, i + 1].into_iter().filter(|&middle| middle > 0 && middle + 1 < seen.len());
        let miss = middles.map(|middle| miss(&seen[middle - 1..=middle + 1], rule) * width * width).fold(0.0, f64::max);
        if miss > 1.0 {
            // Widths differ by rounding; their halvings do not.
            wanted.push((libm::log2(width / widest).round(), miss, i));
        }
    }
    wanted.sort_by(|a, b| b.0.total_cmp(&a.0).then(b.1.total_cmp(&a.1)).then(a.2.cmp(&b.2)));
    wanted.into_iter().map(|(_, _, i)| i).collect()
}

/// By how many tolerances a line misses the middle of an interval near these three points, over its width squared.
fn miss(three: &[Seen], rule: &Refinement) -> f64 {
    let [a, b, c] = three else { return 0.0 };
    let (before, after) = (b.at - a.at, c.at - b.at);
    let of = |((a, b), c): ((&[f64; 2], &[f64; 2]), &[f64; 2])| {
        let chord = (a[0] * after + c[0] * before) / (before + after);
        let off = (b[0] - chord).abs();
        let noise = NOISE * a[1].max(b[1]).max(c[1]);
        let local = match rule.value_scale {
            AxisScale::Linear => (a[0].abs() + b[0].abs() + c[0].abs()) / 3.0,
            AxisScale::Log => 1.0,
        };
        let share = off / (rule.tolerance * local * 4.0 * before * after);
        // A hole in the curve, or a value that is nothing all around, attracts no points.
        if off > noise && share.is_finite() { share } else { 0.0 }
    };
    a.values.iter().zip(&b.values).zip(&c.values).map(of).fold(0.0, f64::max)
}

/// The case halfway.
fn between(low: &Seen, high: &Seen, rule: &Refinement) -> Case {
    let middle = f64::midpoint(low.at, high.at);
    let value = if rule.spacing == AxisScale::Log { libm::exp10(middle) } else { middle };
    low.point.case.with(rule.over, value)
}
