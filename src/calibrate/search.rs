//! Which sets of inputs are tried: all of a grid, or those along one input after the other.
//!
//! A coordinate search looks at all values of one input while the others are held, takes the best, and goes on to the next
//! input, until no single input improves on what it has; then it moves two inputs by one step at once, which gets it along a
//! valley that lies across the inputs, and begins again where that helps. It depends on residuals alone, never on threads or
//! time.

use std::collections::{BTreeMap, BTreeSet};

use crate::optimise::Stream;

/// The value that each input takes, by its index.
pub(super) type Places = Vec<usize>;

/// What was tried.
#[derive(Debug, Clone, PartialEq, Default)]
pub(super) struct Trail {
    /// The residual of each set; none where an entry has no number.
    pub residuals: BTreeMap<Places, Option<f64>>,
    /// Where each start ended, with its residual.
    pub ends: Vec<(Places, Option<f64>)>,
    /// The budget ended the search.
    pub cut_short: bool,
}

impl Trail {
    /// The best of these sets; of equal ones the first in order.
    pub(super) fn best(&self, wanted: impl Fn(&Places) -> bool) -> Option<(&Places, f64)> {
        let known = self.residuals.iter().filter(|(places, _)| wanted(places));
        known.filter_map(|(places, residual)| Some((places, (*residual)?))).min_by(|a, b| a.1.total_cmp(&b.1))
    }
}

/// Every combination; `counts` holds the number of values of each input.
pub(super) fn grid<E>(
    counts: &[usize],
    residuals: impl FnMut(&[Places]) -> Result<Vec<Option<f64>>, E>,
) -> Result<Trail, E> {
    let total: usize = counts.iter().product();
    let all: Vec<Places> = (0..total).map(|index| places(counts, index)).collect();
    let mut tried = Tried { trail: Trail::default(), budget: total, residuals };
    tried.evaluate(all)?;
    Ok(tried.trail)
}

/// The places of combination `index`; the last input runs fastest.
fn places(counts: &[usize], mut index: usize) -> Places {
    let mut places = vec![0; counts.len()];
    for (place, count) in places.iter_mut().zip(counts).rev() {
        *place = index % count;
        index /= count;
    }
    places
}

/// From `first` and from `starts` − 1 drawn sets, with at most `budget` sets tried.
pub(super) fn coordinate<E>(
    counts: &[usize],
    first: Places,
    starts: u32,
    budget: u32,
    residuals: impl FnMut(&[Places]) -> Result<Vec<Option<f64>>, E>,
) -> Result<Trail, E> {
    let mut tried = Tried { trail: Trail::default(), budget: budget as usize, residuals };
    for start in 0..starts {
        let drawn = |(input, &count): (usize, &usize)| Stream::of(u64::from(start), &[input as u64]).below(count);
        let from = if start == 0 { first.clone() } else { counts.iter().enumerate().map(drawn).collect() };
        let end = tried.descend(counts, from)?;
        let residual = tried.residual(&end);
        tried.trail.ends.push((end, residual));
        if tried.trail.cut_short {
            break;
        }
    }
    Ok(tried.trail)
}

/// What was tried, and the function.
struct Tried<F> {
    trail: Trail,
    budget: usize,
    residuals: F,
}

impl<E, F: FnMut(&[Places]) -> Result<Vec<Option<f64>>, E>> Tried<F> {
    /// Evaluates what is new among `sets`, as far as the budget goes.
    fn evaluate(&mut self, sets: Vec<Places>) -> Result<(), E> {
        let new: BTreeSet<Places> =
            sets.into_iter().filter(|places| !self.trail.residuals.contains_key(places)).collect();
        let room = self.budget - self.trail.residuals.len();
        self.trail.cut_short |= new.len() > room;
        let new: Vec<Places> = new.into_iter().take(room).collect();
        if !new.is_empty() {
            let residuals = (self.residuals)(&new)?;
            self.trail.residuals.extend(new.into_iter().zip(residuals));
        }
        Ok(())
    }

    fn residual(&self, places: &Places) -> Option<f64> {
        self.trail.residuals.get(places).copied().flatten()
    }

    /// The best of `sets`, if it is better than `at`; of equal ones the first.
    fn better(&mut self, at: &Places, sets: Vec<Places>) -> Result<Option<Places>, E> {
        self.evaluate(sets.clone())?;
        let value = |places: &Places| self.residual(places).unwrap_or(f64::INFINITY);
        let best = sets.into_iter().reduce(|best, next| if value(&next) < value(&best) { next } else { best });
        Ok(best.filter(|best| value(best) < value(at)))
    }

    fn descend(&mut self, counts: &[usize], from: Places) -> Result<Places, E> {
        let mut at = from;
        self.evaluate(vec![at.clone()])?;
        loop {
            let before = at.clone();
            for (input, &count) in counts.iter().enumerate() {
                let along = (0..count).map(|place| with(&at, &[(input, place)])).collect();
                if let Some(better) = self.better(&at, along)? {
                    at = better;
                }
            }
            if at == before {
                match self.better(&at, pairs(counts, &at))? {
                    Some(better) => at = better,
                    None => return Ok(at),
                }
            }
            if self.trail.cut_short {
                return Ok(at);
            }
        }
    }
}

/// Two inputs moved by one step each, in all ways.
fn pairs(counts: &[usize], at: &Places) -> Vec<Places> {
    let steps = |input: usize| {
        let place = at[input];
        [place.checked_sub(1), Some(place + 1).filter(|next| *next < counts[input])].into_iter().flatten()
    };
    let mut pairs = Vec::new();
    for one in 0..counts.len() {
        for other in one + 1..counts.len() {
            for place in steps(one) {
                pairs.extend(steps(other).map(|beside| with(at, &[(one, place), (other, beside)])));
            }
        }
    }
    pairs
}

fn with(places: &Places, moved: &[(usize, usize)]) -> Places {
    let mut places = places.clone();
    for (input, place) in moved {
        places[*input] = *place;
    }
    places
}
