//! Where a branch loses its symmetry: a pitchfork.
//!
//! A motion that comes again upside down after half a period has the map M = N² of a whole one, N that of half a period and the mirror.
//! Where N has the eigenvalue 1 the branch turns. Where it has −1 the branch goes on, but M has the multiplier 1 there and two motions
//! begin that are each other's mirror image: det [1 − M, −∂P/∂λ; tᵀ] changes its sign, which it does not at a fold.
//!
//! Next to that point the equations are as good as singular: along the vector of the multiplier 1 an orbit at the distance d from it is
//! known to its rounding over d. But the determinant feels that by its square only. So the point is interpolated from orbits at
//! some distance to both sides, as a zero of det(1 − M), for which no ∂P/∂λ is needed.

use super::corrector::{At, Path};
use super::newton::size;
use super::point::BranchError;
use super::shot::Shot;
use super::stretch::{MEETS, Stretch, nearest};
use crate::arithmetic::lagrange::{combined, weights};
use crate::motion::End;
use crate::system::HybridSystem;

/// Orbits to both sides, in units of their distance.
const PLACES: [f64; 4] = [-3.0, -1.0, 1.0, 3.0];
/// That distance along the branch: the largest.
const DISTANCE: f64 = 2e-4;
/// The same, as a part of the step that passes the point.
const OF_STEP: f64 = 0.05;
/// The same, as a part of the way to the ends of the stretch.
const OF_ROOM: f64 = 0.2;
/// Distances that are tried, each this part of the last one, until a multiplier is so close to 1.
const FINER: usize = 6;
const CLOSER: f64 = 0.125;
const EXACT: f64 = 1e-7;
/// Halvings of a stretch until its sign changes within a millionth of it.
const HALVINGS: u32 = 20;
/// Rounds, until the point lies between the orbits.
const ROUNDS: usize = 4;
/// Where the branch turns within this part of a step from the point, it turns there.
const TURNS: f64 = 0.1;

/// What happens between two points of a branch.
pub(super) enum Fork {
    /// Two motions without the symmetry begin at this place along the step.
    Begins(f64, Box<At>),
    /// This is one of them, and it ends.
    Joins,
}

/// The pitchfork along a stretch.
pub(super) fn between<E, F: FnMut(f64) -> Result<HybridSystem, E>>(
    path: &mut Path<F>,
    stretch: Stretch<'_>,
) -> Result<Option<Fork>, BranchError<E>> {
    let [from, to] = stretch.ends;
    let Some(middle) = crosses(from.determinant, to.determinant) else { return Ok(None) };
    let forwards = |at: &At| at.tangent[at.tangent.len() - 1];
    let turns_there = |turn: f64| (turn - middle).abs() <= TURNS || from.shot.swaps_sides(&to.shot);
    if crosses(forwards(from), forwards(to)).is_some_and(turns_there) {
        // A fold in the same step as a graze looks the same; there the motion has no mirror image.
        return Ok(from.shot.has_both_sides().then_some(Fork::Joins));
    }
    let mut apart = DISTANCE.min(OF_STEP * stretch.length());
    let mut middle = stretch.place(middle);
    let mut best: Option<(f64, f64, Box<At>)> = None;
    for round in 0..FINER {
        if round == 1 {
            // The determinant is far from straight next to a graze, beyond which there are no such orbits, or next to another multiplier at 1.
            let [low, high] = enclosed(path, stretch)?;
            middle = 0.5 * (low + high);
            apart = apart.min(OF_ROOM * (middle - stretch.places[0]).min(stretch.places[1] - middle));
        }
        if let Some((place, at)) = interpolated(path, stretch.base, middle, apart)? {
            let off = nearest(&at, 1.0)?;
            if best.as_ref().is_none_or(|(least, ..)| off < *least) {
                best = Some((off, place, at));
            }
            if off <= EXACT {
                break;
            }
        }
        apart *= CLOSER;
    }
    Ok(best.filter(|(off, ..)| *off < MEETS).map(|(_, place, at)| Fork::Begins(place, at)))
}

/// Places around the change of sign, as close to it as orbits are found.
fn enclosed<E, F: FnMut(f64) -> Result<HybridSystem, E>>(
    path: &mut Path<F>,
    stretch: Stretch<'_>,
) -> Result<[f64; 2], BranchError<E>> {
    let [mut low, mut high] = stretch.places;
    let begin = stretch.ends[0].determinant;
    for _ in 0..HALVINGS {
        let middle = 0.5 * (low + high);
        match path.correct(stretch.base, middle) {
            Ok(at) if at.determinant * begin > 0.0 => low = middle,
            Ok(_) => high = middle,
            Err(BranchError::Orbit(_)) => break,
            Err(other) => return Err(other),
        }
    }
    Ok([low, high])
}

/// Where a number that changes its sign is zero, as a share of the way.
fn crosses(from: f64, to: f64) -> Option<f64> {
    (from * to < 0.0).then(|| from / (from - to))
}

/// The point with the determinant zero, next to a place along a step; `None` where orbits beside it are not found.
fn interpolated<E, F: FnMut(f64) -> Result<HybridSystem, E>>(
    path: &mut Path<F>,
    from: &At,
    mut middle: f64,
    apart: f64,
) -> Result<Option<(f64, Box<At>)>, BranchError<E>> {
    for _ in 0..ROUNDS {
        let places = PLACES.map(|place| middle + place * apart);
        let mut orbits = Vec::new();
        for place in places {
            match path.correct(from, place) {
                Ok(at) if at.shot.contacts() == from.shot.contacts() => orbits.push(at),
                Ok(_) | Err(BranchError::Orbit(_)) => return Ok(None),
                Err(other) => return Err(other),
            }
        }
        let determinants: Vec<f64> = orbits.iter().map(|at| at.shot.closing().determinant()).collect();
        let place = combined(&weights(&determinants, 0.0), places);
        if (place - middle).abs() <= apart {
            let weights = weights(&places, place);
            let number = |i: usize| combined(&weights, orbits.iter().map(|at| at.shot.start.state[i]));
            let state = (0..from.shot.start.state.len()).map(number).collect();
            let start = End { state, contacts: orbits[0].shot.start.contacts.clone() };
            let share = combined(&weights, orbits.iter().map(|at| at.share));
            return Ok(Some((place, Box::new(closed(path, share, start, from.tangent.clone())?))));
        }
        middle = place;
    }
    Ok(None)
}

/// The orbit there: closed across the vector of the multiplier 1, and along it as interpolated.
fn closed<E, F: FnMut(f64) -> Result<HybridSystem, E>>(
    path: &mut Path<F>,
    share: f64,
    start: End,
    tangent: Vec<f64>,
) -> Result<At, BranchError<E>> {
    let system = path.system(share)?;
    let first = Shot::new(&system, start, path.cycles, None)?;
    let step = |shot: &Shot| shot.kept().and_then(|kept| shot.step_beside(&kept)).ok_or_else(|| shot.unsolved());
    let shot = Shot::new(&system, first.moved(&step(&first)?), path.cycles, None)?;
    let distance = size(&step(&shot)?);
    Ok(At { share, shot, distance, tangent, determinant: 0.0 })
}
