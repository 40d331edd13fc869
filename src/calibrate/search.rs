//! Which sets of inputs are tried: all of a grid, or those along one input after the other.
//!
//! A coordinate search looks at all values of one input while the others are held, takes the best, and goes on to the next
//! input, until no single input improves on what it has; then it moves two inputs by one step at once, which gets it along a
//! valley that lies across the inputs, and begins again where that helps. It depends on residuals alone, never on threads or
//! time.
//!
//! A global search first moves each input alone, and holds those that hardly change the residual (screening); over the others it
//! runs CMA-ES, which begins again with twice as many individuals wherever it has converged (`crate::optimise`), on the places
//! of the values; the best set that it finds is where a coordinate search of all inputs begins.
//!
//! With each set goes the level that its residual has to reach to matter: to be the next step it has to be below the residual of
//! the set in hand, to enter the profile of an input it has to be below the least one found with that value. Of a set above all of
//! these the search needs to know no more than that, and comes to the same answer.

use std::collections::{BTreeMap, BTreeSet};

use crate::optimise::{Bounds, CmaEs, Optimiser, Score, Stream};

/// The value that each input takes, by its index.
pub(super) type Places = Vec<usize>;

/// What is known of the residual of a set.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Residue {
    /// The residual; none where an entry has no number.
    Exact(Option<f64>),
    /// It is above this, or there is none.
    AtLeast(f64),
}

/// What was tried.
#[derive(Debug, Clone, PartialEq, Default)]
pub(super) struct Trail {
    /// The residual of each set.
    pub residuals: BTreeMap<Places, Residue>,
    /// Where each start ended, with its residual.
    pub ends: Vec<(Places, Option<f64>)>,
    /// The budget ended the search.
    pub cut_short: bool,
    /// Inputs that the screening of a global search held.
    pub held: Vec<usize>,
}

impl Trail {
    /// The best of these sets; of equal ones the first in order.
    pub(super) fn best(&self, wanted: impl Fn(&Places) -> bool) -> Option<(&Places, f64)> {
        let known = self.residuals.iter().filter(|(places, _)| wanted(places));
        let exact = known.filter_map(|(places, residual)| match residual {
            Residue::Exact(residual) => Some((places, (*residual)?)),
            Residue::AtLeast(_) => None,
        });
        exact.min_by(|a, b| a.1.total_cmp(&b.1))
    }

    /// The best set of all; of equal ones that which differs from `first` in the fewest inputs.
    pub(super) fn best_near(&self, first: &Places) -> Option<(&Places, f64)> {
        let (_, least) = self.best(|_| true)?;
        let moved = |places: &Places| places.iter().zip(first).filter(|(a, b)| a != b).count();
        let equal = self.residuals.iter().filter(|(_, residual)| **residual == Residue::Exact(Some(least)));
        equal.map(|(places, _)| (places, least)).min_by_key(|(places, _)| moved(places))
    }

    /// True if no set has another residual than those that differ from it in this input alone, and some were run to their ends.
    pub(super) fn does_not_depend_on(&self, input: usize) -> bool {
        let mut groups: BTreeMap<Places, Vec<&Residue>> = BTreeMap::new();
        for (places, residual) in &self.residuals {
            groups.entry(with(places, &[(input, 0)])).or_default().push(residual);
        }
        let alike = |a: &Residue, b: &Residue| match (a, b) {
            (Residue::Exact(a), Residue::Exact(b)) => a == b,
            (Residue::Exact(Some(value)), Residue::AtLeast(bound))
            | (Residue::AtLeast(bound), Residue::Exact(Some(value))) => bound <= value,
            _ => true,
        };
        let is_exact = |one: &&&Residue| matches!(one, Residue::Exact(Some(_)));
        groups.values().any(|group| group.iter().filter(is_exact).count() > 1)
            && groups.values().all(|group| group.iter().all(|one| group.iter().all(|other| alike(one, other))))
    }
}

/// Sets of a grid that are run side by side.
const SIDE_BY_SIDE: usize = 32;

/// Every combination; `counts` holds the number of values of each input.
pub(super) fn grid<E>(
    counts: &[usize],
    residuals: impl FnMut(&[(Places, f64)]) -> Result<Vec<Residue>, E>,
) -> Result<Trail, E> {
    let total: usize = counts.iter().product();
    let all: Vec<Places> = (0..total).map(|index| places(counts, index)).collect();
    let mut tried = Tried::new(counts, total, residuals);
    for some in all.chunks(SIDE_BY_SIDE) {
        tried.evaluate(some.to_vec(), f64::NEG_INFINITY)?;
    }
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
    residuals: impl FnMut(&[(Places, f64)]) -> Result<Vec<Residue>, E>,
) -> Result<Trail, E> {
    let mut tried = Tried::new(counts, budget as usize, residuals);
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

/// An input that moved alone changes the residual by less than this share of it hardly matters.
const HARDLY: f64 = 0.02;
/// The share of the budget that is left to the coordinate search at the end.
const LAST_PART: f64 = 0.25;
/// What is this many times the least residual is bad, however bad it is.
const BAD: f64 = 3.0;
/// Generations without a new set that end it.
const NOTHING_NEW: u32 = 50;

/// All over the space, from `first` on, with at most `budget` sets tried.
pub(super) fn global<E>(
    counts: &[usize],
    first: &Places,
    budget: u32,
    residuals: impl FnMut(&[(Places, f64)]) -> Result<Vec<Residue>, E>,
) -> Result<Trail, E> {
    let mut tried = Tried::new(counts, budget as usize, residuals);
    let along = |input: usize| (0..counts[input]).map(move |place| with(first, &[(input, place)]));
    tried.evaluate((0..counts.len()).flat_map(along).collect(), f64::INFINITY)?;
    let matters = |input: &usize| {
        let residuals: Vec<f64> =
            along(*input).map(|places| tried.residual(&places).unwrap_or(f64::INFINITY)).collect();
        let [low, high] = [f64::min, f64::max].map(|of| residuals.iter().copied().fold(residuals[0], of));
        high > low * (1.0 + HARDLY)
    };
    let (free, held): (Vec<usize>, Vec<usize>) = (0..counts.len()).partition(matters);
    tried.trail.held = held;
    tried.spread_out(counts, first, &free)?;
    let from = tried.trail.best(|_| true).map_or_else(|| first.clone(), |(places, _)| places.clone());
    let end = tried.descend(counts, from)?;
    let residual = tried.residual(&end);
    tried.trail.ends.push((end, residual));
    Ok(tried.trail)
}

/// What was tried, and the function.
struct Tried<F> {
    trail: Trail,
    budget: usize,
    /// Of each value of each input the least residual so far; infinite where there is none.
    profiles: Vec<Vec<f64>>,
    residuals: F,
}

impl<E, F: FnMut(&[(Places, f64)]) -> Result<Vec<Residue>, E>> Tried<F> {
    fn new(counts: &[usize], budget: usize, residuals: F) -> Self {
        let profiles = counts.iter().map(|&count| vec![f64::INFINITY; count]).collect();
        Self { trail: Trail::default(), budget, profiles, residuals }
    }

    /// Evaluates what is new among `sets`, as far as the budget goes; each as far as it may be below `level` or enter a profile.
    fn evaluate(&mut self, sets: Vec<Places>, level: f64) -> Result<(), E> {
        let sets: BTreeSet<Places> = sets.into_iter().collect();
        let (known, new): (Vec<Places>, Vec<Places>) =
            sets.into_iter().partition(|places| self.trail.residuals.contains_key(places));
        let room = self.budget - self.trail.residuals.len();
        self.trail.cut_short |= new.len() > room;
        let wanted = known.into_iter().chain(new.into_iter().take(room)).map(|places| {
            let level =
                places.iter().zip(&self.profiles).fold(level, |level, (place, profile)| level.max(profile[*place]));
            (places, level)
        });
        let open = |(places, level): &(Places, f64)| match self.trail.residuals.get(places) {
            None => true,
            Some(Residue::Exact(_)) => false,
            // Given up when less was at stake.
            Some(Residue::AtLeast(bound)) => *bound <= *level,
        };
        let wanted: Vec<(Places, f64)> = wanted.filter(open).collect();
        if wanted.is_empty() {
            return Ok(());
        }
        let residuals = (self.residuals)(&wanted)?;
        for ((places, _), residual) in wanted.into_iter().zip(residuals) {
            if let Residue::Exact(Some(value)) = residual {
                for (place, profile) in places.iter().zip(&mut self.profiles) {
                    profile[*place] = profile[*place].min(value);
                }
            }
            self.trail.residuals.insert(places, residual);
        }
        Ok(())
    }

    /// CMA-ES over the `free` inputs, the others as in `first`.
    fn spread_out(&mut self, counts: &[usize], first: &Places, free: &[usize]) -> Result<(), E> {
        let Ok(bounds) = Bounds::new(free.iter().map(|&input| [0.0, counts[input] as f64]).collect()) else {
            return Ok(());
        };
        let place = |x: f64, input: usize| (x as usize).min(counts[input] - 1);
        let most = self.budget - (self.budget as f64 * LAST_PART) as usize;
        let (mut strategy, mut idle) = (CmaEs::new(bounds, None, 0), 0);
        while self.trail.residuals.len() < most && idle < NOTHING_NEW {
            let moved = |point: Vec<f64>| {
                let moved: Vec<_> = free.iter().zip(point).map(|(&input, x)| (input, place(x, input))).collect();
                with(first, &moved)
            };
            let sets: Vec<Places> = strategy.ask().into_iter().map(moved).collect();
            let known = self.trail.residuals.len();
            let bad = BAD * self.trail.best(|_| true).map_or(f64::INFINITY, |(_, residual)| residual);
            self.evaluate(sets.clone(), bad)?;
            idle = if self.trail.residuals.len() > known { 0 } else { idle + 1 };
            let score =
                |places: &Places| Score { value: self.residual(places).map_or(bad, |residual| residual.min(bad)) };
            strategy.tell(&sets.iter().map(score).collect::<Vec<_>>());
        }
        Ok(())
    }

    fn residual(&self, places: &Places) -> Option<f64> {
        match self.trail.residuals.get(places) {
            Some(Residue::Exact(residual)) => *residual,
            _ => None,
        }
    }

    /// The best of `sets`, if it is better than `at`; of equal ones the first.
    fn better(&mut self, at: &Places, sets: Vec<Places>) -> Result<Option<Places>, E> {
        let in_hand = self.residual(at).unwrap_or(f64::INFINITY);
        self.evaluate(sets.clone(), in_hand)?;
        let value = |places: &Places| self.residual(places).unwrap_or(f64::INFINITY);
        let best = sets.into_iter().reduce(|best, next| if value(&next) < value(&best) { next } else { best });
        Ok(best.filter(|best| value(best) < in_hand))
    }

    fn descend(&mut self, counts: &[usize], from: Places) -> Result<Places, E> {
        let mut at = from;
        self.evaluate(vec![at.clone()], f64::INFINITY)?;
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

#[cfg(test)]
mod tests {
    use std::collections::BTreeSet;
    use std::convert::Infallible;

    use crate::experiment::CalibrationSearch;

    use super::*;

    const COUNTS: [usize; 4] = [5, 4, 3, 4];
    const FIRST: [usize; 4] = [0; 4];
    const ENTRIES: usize = 6;

    /// Errors of entries under a set: a smooth valley, made rough; now and then an entry without a number.
    fn errors(landscape: u64, places: &Places) -> Vec<Option<f64>> {
        let of = |entry: usize| {
            let key: Vec<u64> = places.iter().map(|place| *place as u64).chain([entry as u64]).collect();
            let rough = Stream::of(landscape, &key).below(1000) as f64 / 1000.0;
            let best = Stream::of(landscape, &[7, entry as u64]).below(4) as f64;
            let off = places.iter().map(|place| (*place as f64 - best) * (*place as f64 - best)).sum::<f64>();
            (rough > 0.004).then_some(0.1 * off.sqrt() + rough)
        };
        (0..ENTRIES).map(of).collect()
    }

    fn root(errors: &[f64]) -> f64 {
        (errors.iter().map(|error| error * error).sum::<f64>() / ENTRIES as f64).sqrt()
    }

    /// The trail, and the entries that were evaluated; given up where that is `allowed`.
    fn searched(landscape: u64, search: CalibrationSearch, allowed: bool) -> (Trail, usize) {
        let mut evaluated = BTreeSet::new();
        let residuals = |sets: &[(Places, f64)]| {
            let one = |(places, level): &(Places, f64)| {
                let mut known = Vec::new();
                for (entry, error) in errors(landscape, places).into_iter().enumerate() {
                    let bound = root(&known);
                    if allowed && bound > *level {
                        return Residue::AtLeast(bound);
                    }
                    evaluated.insert((places.clone(), entry));
                    let Some(error) = error else { return Residue::Exact(None) };
                    known.push(error);
                }
                Residue::Exact(Some(root(&known)))
            };
            Ok::<_, Infallible>(sets.iter().map(one).collect())
        };
        let trail = match search {
            CalibrationSearch::Grid => grid(&COUNTS, residuals),
            CalibrationSearch::Coordinate { starts, budget } => {
                coordinate(&COUNTS, FIRST.to_vec(), starts, budget, residuals)
            }
            CalibrationSearch::Global { budget } => global(&COUNTS, &FIRST.to_vec(), budget, residuals),
        };
        (trail.unwrap_or_else(|never| match never {}), evaluated.len())
    }

    #[test]
    fn sets_given_up_early_change_no_answer() {
        let mut shares = [0.0; 3];
        let coordinate = |budget| CalibrationSearch::Coordinate { starts: 3, budget };
        let global = CalibrationSearch::Global { budget: 60 };
        for (search, share) in [(CalibrationSearch::Grid, 0), (coordinate(200), 1), (coordinate(25), 1), (global, 2)] {
            for landscape in 0..100 {
                let (whole, all) = searched(landscape, search, false);
                let (stopped, some) = searched(landscape, search, true);
                let answer = |trail: &Trail| {
                    let profiles = COUNTS.iter().enumerate().flat_map(|(input, &count)| {
                        (0..count).map(move |value| {
                            trail.best(|places| places[input] == value).map(|(at, r)| (at.clone(), r))
                        })
                    });
                    (profiles.collect::<Vec<_>>(), trail.residuals.keys().cloned().collect::<Vec<_>>())
                };
                assert_eq!(answer(&stopped), answer(&whole), "landscape {landscape}, {search:?}");
                assert_eq!(
                    (&stopped.ends, &stopped.held, stopped.cut_short),
                    (&whole.ends, &whole.held, whole.cut_short)
                );
                shares[share] += some as f64 / all as f64 / if share == 1 { 200.0 } else { 100.0 };
            }
        }
        assert!(
            shares[0] < 0.9 && shares[1] < 0.97 && shares[2] < 0.97,
            "of the entries {shares:?} were evaluated, on a grid, in a search along inputs and in a global one"
        );
    }

    #[test]
    fn a_global_search_comes_near_the_least_residual_with_a_quarter_of_the_sets() {
        let ranks: Vec<usize> = (0..100)
            .map(|landscape| {
                let (all, _) = searched(landscape, CalibrationSearch::Grid, false);
                let (global, _) = searched(landscape, CalibrationSearch::Global { budget: 60 }, true);
                let (_, found) = global.best(|_| true).expect("a set with a residual");
                assert!(global.residuals.len() <= 60);
                all.residuals.values().filter(|it| matches!(it, Residue::Exact(Some(it)) if *it < found)).count()
            })
            .collect();
        let mean = ranks.iter().sum::<usize>() as f64 / ranks.len() as f64;
        assert!(mean < 3.0, "of 240 sets {mean} are better");
    }
}
