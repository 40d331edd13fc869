//! A point that is looked for over one parameter: the maximum of a measure, or the onset of events.
//!
//! Of a maximum every point is run once. Those that come near the highest are then looked at with the runs beside them, so that the mean
//! of an ensemble stands there where the motion is chaotic: no luck of a single run is the maximum.
//!
//! For a maximum each round halves the two intervals beside the best point of each of the highest peaks of a grid, as a low peak may hide
//! a higher one between its points. So its place is known to within the distance to its neighbours, and its value to what a parabola
//! rises between them; a peak that no point of the grid is next to is not seen. An onset lies between the last point of the grid without an event and the first one with some;
//! as events are certified, halving that interval closes in on it to [`KNOWN`] of the parameter. Where the motion is chaotic, events
//! begin here and there between two points of the grid, and sooner in a longer run: the onset is then known to no more than their
//! distance. Its values are ensemble means where the motion is chaotic.

use std::ops::RangeInclusive;

use rayon::prelude::*;

use super::evaluate::{Evaluate, Simulation, evaluate_guarded};
use super::row_failure::RowFailure;
use crate::experiment::{MOST_PEAKS, Maximise, ParameterValue, SearchPoint};
use crate::measure::{Evaluated, Request, Rigour, SolverChoice};
use crate::optimise::{Point, overshoot};
use crate::text::words;

/// An onset is known to this share of the parameter.
const KNOWN: f64 = 1e-12;

/// Points of the grid of an onset that are tried at once.
const AT_ONCE: usize = 8;

/// Share of the whole rise of a measure within which a point comes near the highest. A single run of chaotic motion is off from its mean by a
/// few per cent; where two motions attract it may be the lower one, and the mean of both the maximum. [`SPREADS`] stands in its place where
/// runs are seen to spread more.
const NEAR: f64 = 0.8;

/// Standard deviations of single runs within which a point comes near the highest.
const SPREADS: f64 = 4.0;

/// Where the point lies.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Place {
    /// The parameter's value there.
    pub at: f64,
    /// Distance to the farther of the two points beside it.
    pub within: f64,
}

/// The point that was looked for.
pub(super) struct Sought {
    /// Everything measured there.
    pub evaluated: Evaluated,
    pub place: Place,
    /// How far the measure that is maximised may rise above its value there, between the points beside it.
    pub rise: f64,
}

/// A point that was tried: the parameter's value, the measure that is maximised, everything measured.
struct Tried {
    at: f64,
    value: f64,
    evaluated: Evaluated,
    rigour: Rigour,
}

/// Where a point is looked for: one case, measured at values of the parameter.
pub(super) struct Along<'a, E, D> {
    /// What measures.
    pub evaluate: &'a E,
    /// The case; `maximise.measure` stands at index `measure` of its measures.
    pub simulation: Simulation<'a>,
    /// Which point is looked for.
    pub maximise: &'a Maximise,
    /// See `simulation`.
    pub measure: usize,
    /// Called after every point.
    pub done: D,
}

impl<E: Evaluate, D: Fn() + Sync> Along<'_, E, D> {
    /// The point that is looked for.
    ///
    /// # Errors
    /// The reason of the first point that has no number: a maximum over part of a range is none. Beyond an onset none is asked for.
    /// [`RowFailure::NoOnset`] where all points of the grid, or none, have events.
    pub(super) fn found(&self) -> Result<Sought, RowFailure> {
        match self.maximise.wanted {
            SearchPoint::Maximum => self.maximum(),
            SearchPoint::Onset => self.onset(),
        }
    }

    fn maximum(&self) -> Result<Sought, RowFailure> {
        let mut tried = self.all(&self.maximise.grid, Rigour::Step)?;
        tried.sort_by(|a, b| a.at.total_cmp(&b.at));
        tried.dedup_by(|a, b| a.at == b.at);
        self.look_at_highest(&mut tried)?;
        let peaks = peaks(&tried);
        for _ in 0..self.maximise.refine {
            let mut new = Vec::new();
            for within in &peaks {
                let Some(best) = best(&tried, within) else { continue };
                new.extend(neighbours(&tried, best).map(|other| between(tried[best].at, tried[other].at)));
            }
            new.sort_by(f64::total_cmp);
            new.dedup();
            new.retain(|at| tried.iter().all(|known| known.at != *at));
            tried.extend(self.all(&new, Rigour::Step)?);
            tried.sort_by(|a, b| a.at.total_cmp(&b.at));
            self.look_at_highest(&mut tried)?;
        }
        let best = best(&tried, &(f64::NEG_INFINITY..=f64::INFINITY)).ok_or(RowFailure::NoGrid)?;
        let at = tried[best].at;
        let within = neighbours(&tried, best).map(|other| (tried[other].at - at).abs()).fold(0.0, f64::max);
        let rise = overshoot(best, |i| tried.get(i).map(|one| Point { x: one.at, y: one.value }));
        Ok(Sought { evaluated: tried.swap_remove(best).evaluated, place: Place { at, within }, rise })
    }

    /// Looks at the points that come near the highest, until no other does.
    fn look_at_highest(&self, tried: &mut [Tried]) -> Result<(), RowFailure> {
        // A fixed step is a run alone, whoever looks.
        if self.simulation.solver != SolverChoice::EventDriven {
            return Ok(());
        }
        loop {
            let looked = || tried.iter().filter(|one| one.rigour == Rigour::Look);
            let highest = |all: &mut dyn Iterator<Item = &Tried>| all.map(|one| one.value).reduce(f64::max);
            let Some(best) = highest(&mut looked()).or_else(|| highest(&mut tried.iter())) else { return Ok(()) };
            let lowest = tried.iter().map(|one| one.value).fold(best, f64::min);
            let spread = looked().map(|one| one.evaluated.measured[self.measure].spread).fold(0.0, f64::max);
            // A single run is all that stands for a motion without an ensemble.
            let is_mean = self.simulation.settings.ensemble >= 2 && best.is_finite();
            let near = if is_mean { best - f64::max(NEAR * (best - lowest), SPREADS * spread) } else { best };
            let new: Vec<usize> =
                (0..tried.len()).filter(|&i| tried[i].rigour == Rigour::Step && tried[i].value >= near).collect();
            if new.is_empty() {
                return Ok(());
            }
            let again: Vec<_> = new.par_iter().map(|&i| self.tried(tried[i].at, Rigour::Look)).collect();
            for (i, again) in new.into_iter().zip(again) {
                tried[i] = again?;
            }
        }
    }

    /// The smallest value of the parameter at which the measure is above zero, as far as the grid tells.
    fn onset(&self) -> Result<Sought, RowFailure> {
        let mut tried = Vec::new();
        // What lies beyond the first point with events is not asked for.
        for points in self.maximise.grid.chunks(AT_ONCE) {
            tried.extend(self.all(points, Rigour::Look)?);
            if tried.iter().any(|one: &Tried| one.value > 0.0) {
                break;
            }
        }
        let missed = |before| RowFailure::NoOnset { measure: words::of_key(&self.maximise.measure), before };
        let first = tried.iter().position(|one| one.value > 0.0).ok_or_else(|| missed(false))?;
        let before = first.checked_sub(1).map(|last| tried[last].at).ok_or_else(|| missed(true))?;
        let mut below = before;
        let mut is_chaotic = tried[first - 1..=first].iter().any(|one| one.evaluated.may_be_chaotic());
        let mut above = tried.swap_remove(first);
        for _ in 0..self.maximise.points_after_grid() {
            let at = between(below, above.at);
            if (above.at - below).abs() <= KNOWN * above.at.abs() || at <= below || at >= above.at {
                break;
            }
            let tried = self.one(at, Rigour::Look)?;
            is_chaotic |= tried.evaluated.may_be_chaotic();
            if tried.value > 0.0 {
                above = tried;
            } else {
                below = at;
            }
        }
        let from = if is_chaotic { before } else { below };
        Ok(Sought { evaluated: above.evaluated, place: Place { at: above.at, within: above.at - from }, rise: 0.0 })
    }

    /// Several points; of several failures the first in order is reported, not the first in time.
    fn all(&self, points: &[f64], rigour: Rigour) -> Result<Vec<Tried>, RowFailure> {
        let tried: Vec<_> = points.par_iter().map(|&at| self.one(at, rigour)).collect();
        tried.into_iter().collect()
    }

    fn one(&self, at: f64, rigour: Rigour) -> Result<Tried, RowFailure> {
        let tried = self.tried(at, rigour);
        (self.done)();
        tried
    }

    fn tried(&self, at: f64, rigour: Rigour) -> Result<Tried, RowFailure> {
        let Self { simulation, maximise, .. } = self;
        let mut recipe = simulation.recipe.clone();
        let place = |reason| RowFailure::At { parameter: words::of_key(&maximise.over), at, reason: Box::new(reason) };
        recipe.set(maximise.over, ParameterValue::Number(at)).map_err(|error| place(error.into()))?;
        let request = Request { rigour, ..simulation.request };
        let simulation = Simulation { recipe: &recipe, request, ..*simulation };
        let evaluated = evaluate_guarded(self.evaluate, &simulation).map_err(place)?;
        match evaluated.measured.get(self.measure) {
            Some(measured) if !measured.value.is_nan() => Ok(Tried { at, value: measured.value, evaluated, rigour }),
            _ => Err(place(RowFailure::NoValue(words::of_key(&maximise.measure)))),
        }
    }
}

/// The highest point of a range; of equal ones the first.
fn best(tried: &[Tried], within: &RangeInclusive<f64>) -> Option<usize> {
    let inside = (0..tried.len()).filter(|&i| within.contains(&tried[i].at));
    inside.reduce(|best, next| if tried[next].value > tried[best].value { next } else { best })
}

/// The ranges between the neighbours of the highest peaks, highest first; of equal ones the first.
fn peaks(tried: &[Tried]) -> Vec<RangeInclusive<f64>> {
    let is_peak = |&i: &usize| neighbours(tried, i).all(|other| tried[other].value <= tried[i].value);
    let mut peaks: Vec<usize> = (0..tried.len()).filter(is_peak).collect();
    peaks.sort_by(|&one, &other| tried[other].value.total_cmp(&tried[one].value));
    peaks.truncate(MOST_PEAKS);
    let ends = |i: usize| tried[i.saturating_sub(1)].at..=tried[(i + 1).min(tried.len() - 1)].at;
    peaks.into_iter().map(ends).collect()
}

fn neighbours(tried: &[Tried], of: usize) -> impl Iterator<Item = usize> {
    let last = tried.len() - 1;
    [of.checked_sub(1), (of < last).then_some(of + 1)].into_iter().flatten()
}

/// Halfway on the scale on which forcing amplitudes and gaps are plotted, wherever it exists.
fn between(a: f64, b: f64) -> f64 {
    if a > 0.0 && b > 0.0 { (a * b).sqrt() } else { f64::midpoint(a, b) }
}
