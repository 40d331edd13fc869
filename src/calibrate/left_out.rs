//! Each fitted entry left out in turn: what the sets that fit the others best say of it.
//!
//! An entry that was fitted agrees because it was fitted. If the others alone choose inputs that give it, it was not needed, and
//! its agreement is evidence after all. "Choose" means every set whose residual without it comes within a tenth of the
//! least one, so that an input on which the entry alone hangs leaves it open. A number that is printed once and read in several places
//! is left out of all of them.

use super::journal::EntryError;
use super::residuals::root_mean_square;
use super::search::Places;
use super::trials::Asked;
use crate::experiment::Residual;
use crate::reference::Check;

/// What exceeds the least residual by less than this share of it is as good.
pub(super) const AS_GOOD: f64 = 0.1;

/// What the fit of the other entries says of one.
#[derive(Debug, Clone, PartialEq)]
pub struct LeftOut {
    /// `ch6-beam-b1-light/uniform`.
    pub id: String,
    /// The sets that fit the others as well as any, the best first: of each input the index of its value.
    pub as_good: Vec<Vec<usize>>,
    /// Root mean square of the others' errors under the first of them.
    pub residual: f64,
    /// The entry's relative errors under them, the least and the largest, 0 for a claim that holds; none where it has no
    /// number under one of them.
    pub errors: Option<[f64; 2]>,
    /// The share of all sets that bring it within a tenth of its number, or as its tolerance says: how often a set taken
    /// blindly does.
    pub by_chance: f64,
}

impl LeftOut {
    /// Whether some set does not bring it near its number: one that any set brings there is no prediction.
    #[must_use]
    pub fn tells_sets_apart(&self) -> bool {
        self.by_chance < 1.0
    }
}

/// Leaves out each entry of `fit` in turn. Of each of `sets` the errors of all entries are given. An entry is left away where no
/// set gives all others a number.
pub(super) fn left_out(
    kind: Residual,
    fit: &[Asked<'_>],
    sets: &[&Places],
    errors: &[Vec<EntryError>],
) -> Vec<LeftOut> {
    let of = |(which, (_, entry)): (usize, &Asked<'_>)| {
        let others = errors.iter().map(|errors| without(fit, which, errors));
        let mut residuals: Vec<(usize, f64)> =
            others.enumerate().filter_map(|(set, residual)| Some((set, residual?))).collect();
        residuals.sort_by(|a, b| a.1.total_cmp(&b.1));
        let residual = residuals.first()?.1;
        let good: Vec<usize> = residuals
            .iter()
            .take_while(|(_, other)| *other <= (1.0 + AS_GOOD) * residual)
            .map(|(set, _)| *set)
            .collect();
        let error = |set: &usize| errors[*set][which].map(|one| relative(kind, one.error));
        let range = |range: Option<[f64; 2]>, set: &usize| {
            let (range, error) = (range?, error(set)?);
            Some([range[0].min(error), range[1].max(error)])
        };
        // A claim that holds has no error, one that fails has an error of one.
        let widest = entry.telling().unwrap_or(0.0);
        let near = (0..sets.len()).filter(|set| error(set).is_some_and(|error| error.abs() <= widest)).count();
        Some(LeftOut {
            id: entry.id.clone(),
            errors: good.iter().fold(Some([f64::INFINITY, f64::NEG_INFINITY]), range),
            as_good: good.into_iter().map(|set| sets[set].clone()).collect(),
            residual,
            by_chance: near as f64 / sets.len() as f64,
        })
    };
    fit.iter().enumerate().filter_map(of).collect()
}

/// Root mean square of the errors that entries have where the others alone choose, among the sets with this value of an input:
/// what tells readings apart by numbers that had no say. None where an entry is left without a choice, or without a number.
///
/// With independent normal errors of one size the likelihood of what was left out is the larger the smaller this is
/// (Stone, 1974; PRESS).
pub(super) fn left_out_error(
    fit: &[Asked<'_>],
    sets: &[&Places],
    errors: &[Vec<EntryError>],
    [input, value]: [usize; 2],
) -> Option<f64> {
    let among: Vec<&Vec<EntryError>> =
        sets.iter().zip(errors).filter(|(places, _)| places[input] == value).map(|(_, errors)| errors).collect();
    let predicted = (0..fit.len()).map(|which| {
        let others = among.iter().filter_map(|errors| Some((without(fit, which, errors)?, errors[which])));
        others.min_by(|a, b| a.0.total_cmp(&b.0)).and_then(|(_, error)| error)
    });
    root_mean_square(predicted)
}

/// The residual of the others, of `errors` of one set.
fn without(fit: &[Asked<'_>], which: usize, errors: &[EntryError]) -> Option<f64> {
    let printed = |entry: usize| match &fit[entry].1.check {
        Check::Value { published, .. } => Some(published.text()),
        _ => None,
    };
    let same = |other: usize| other == which || printed(which).is_some_and(|text| printed(other) == Some(text));
    let others = errors.iter().enumerate().filter(|(other, _)| !same(*other));
    root_mean_square(others.map(|(_, error)| *error))
}

fn relative(kind: Residual, error: f64) -> f64 {
    match kind {
        Residual::Relative => error,
        Residual::Logarithmic => libm::expm1(error),
    }
}
