//! The maximum of a measure over one parameter: a grid, then rounds of two points around the best so far.
//!
//! Each round halves the two intervals beside the best point, so the place of the maximum is known to within the distance
//! to its neighbours. Values come from [`Evaluate`] as they are: ensemble means where the motion is chaotic.

use rayon::prelude::*;

use super::evaluate::{Evaluate, Simulation, evaluate_guarded};
use super::row_failure::RowFailure;
use crate::experiment::{Maximise, ParameterValue};
use crate::measure::Evaluated;
use crate::text::words;

/// Where a maximum lies.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Place {
    /// The parameter's value there.
    pub at: f64,
    /// Distance to the farther of the two points beside it.
    pub within: f64,
}

/// A point that was tried: the parameter's value, the measure that is maximised, everything measured.
struct Tried {
    at: f64,
    value: f64,
    evaluated: Evaluated,
}

/// Finds the maximum. `simulation` measures `maximise.measure` at index `measure` of its measures.
///
/// # Errors
/// The reason of the first point that has no number: a maximum over part of a range is none.
pub(super) fn maximum(
    evaluate: &impl Evaluate,
    simulation: &Simulation<'_>,
    maximise: &Maximise,
    measure: usize,
    done: &(impl Fn() + Sync),
) -> Result<(Evaluated, Place), RowFailure> {
    let all = |points: &[f64]| {
        let attempt = |&at: &f64| {
            let tried = one(evaluate, simulation, maximise, measure, at);
            done();
            tried
        };
        // Through a list, so that of several failures the first in order is reported, not the first in time.
        let tried: Vec<_> = points.par_iter().map(attempt).collect();
        tried.into_iter().collect::<Result<Vec<_>, _>>()
    };
    let mut tried = all(&maximise.grid)?;
    tried.sort_by(|a, b| a.at.total_cmp(&b.at));
    tried.dedup_by(|a, b| a.at == b.at);
    for _ in 0..maximise.refine {
        let best = best(&tried).ok_or(RowFailure::NoGrid)?;
        let between = neighbours(&tried, best).map(|other| between(tried[best].at, tried[other].at));
        let new: Vec<f64> = between.filter(|at| tried.iter().all(|known| known.at != *at)).collect();
        tried.extend(all(&new)?);
        tried.sort_by(|a, b| a.at.total_cmp(&b.at));
    }
    let best = best(&tried).ok_or(RowFailure::NoGrid)?;
    let at = tried[best].at;
    let within = neighbours(&tried, best).map(|other| (tried[other].at - at).abs()).fold(0.0, f64::max);
    Ok((tried.swap_remove(best).evaluated, Place { at, within }))
}

fn one(
    evaluate: &impl Evaluate,
    simulation: &Simulation<'_>,
    maximise: &Maximise,
    measure: usize,
    at: f64,
) -> Result<Tried, RowFailure> {
    let mut recipe = simulation.recipe.clone();
    let place = |reason| RowFailure::At { parameter: words::of_key(&maximise.over), at, reason: Box::new(reason) };
    recipe.set(maximise.over, ParameterValue::Number(at)).map_err(|error| place(error.into()))?;
    let evaluated = evaluate_guarded(evaluate, &Simulation { recipe: &recipe, ..*simulation }).map_err(place)?;
    match evaluated.measured.get(measure) {
        Some(measured) if !measured.value.is_nan() => Ok(Tried { at, value: measured.value, evaluated }),
        _ => Err(place(RowFailure::NoValue(words::of_key(&maximise.measure)))),
    }
}

/// The highest point; of equal ones the first.
fn best(tried: &[Tried]) -> Option<usize> {
    (0..tried.len()).reduce(|best, next| if tried[next].value > tried[best].value { next } else { best })
}

fn neighbours(tried: &[Tried], of: usize) -> impl Iterator<Item = usize> {
    let last = tried.len() - 1;
    [of.checked_sub(1), (of < last).then_some(of + 1)].into_iter().flatten()
}

/// Halfway on the scale on which forcing amplitudes and gaps are plotted, wherever it exists.
fn between(a: f64, b: f64) -> f64 {
    if a > 0.0 && b > 0.0 { (a * b).sqrt() } else { f64::midpoint(a, b) }
}
