//! Where a branch changes its kind: test functions, and the search for their zeros along the branch.

use nalgebra::DMatrix;

use super::corrector::{At, Path};
use super::fork::{self, Fork};
use super::point::{BranchError, Special};
use crate::motion::{Multiplier, NEUTRAL};
use crate::system::HybridSystem;

/// Evaluations of a test function.
const EVALUATIONS: usize = 60;
/// A step below which points in between need not be found.
const NARROW: f64 = 1e-4;
/// Shares of the range that are one.
const LOCATED: f64 = 1e-13;
/// A pair that has become complex away from the unit circle has not crossed it.
const CROSSES: f64 = 1e-6;

/// What is zero at a special point.
#[derive(Clone, Copy)]
enum Test {
    Fold,
    PeriodDoubling,
    /// The complex pair of this place, from the largest.
    Torus(usize),
}

impl Test {
    fn value<E>(self, at: &At) -> Result<f64, BranchError<E>> {
        Ok(match self {
            Self::Fold => at.tangent[at.tangent.len() - 1],
            Self::PeriodDoubling => {
                let size = at.shot.miss.len();
                (DMatrix::identity(size, size) + &at.shot.map.matrix).determinant()
            }
            Self::Torus(pair) => pairs(&multipliers(at)?).get(pair).map_or(-1.0, |modulus| modulus - 1.0),
        })
    }
}

fn multipliers<E>(at: &At) -> Result<Vec<Multiplier>, BranchError<E>> {
    Ok(at.shot.map.multipliers().map_err(super::OrbitError::from)?)
}

/// Moduli of the complex pairs, largest first.
fn pairs(multipliers: &[Multiplier]) -> Vec<f64> {
    let complex = multipliers.iter().filter(|it| it.angle > 0.0 && it.angle < std::f64::consts::PI);
    complex.step_by(2).map(|it| it.modulus).collect()
}

/// What is between a point and the next.
pub(super) enum Between {
    /// Special points in their order.
    Specials(Vec<(Special, At)>),
    /// The motion has lost its asymmetry: it comes to the branch that begins to have one there.
    Symmetry,
}

/// The special points between a point and the next, `step` along.
pub(super) fn between<E, F: FnMut(f64) -> Result<HybridSystem, E>>(
    path: &mut Path<F>,
    from: &At,
    to: &At,
    step: f64,
) -> Result<Between, BranchError<E>> {
    // A branch that ends here turns here, too, and orbits next to that place are hard to find.
    let mut found = Vec::new();
    match fork::between(path, from, to, step)? {
        Some(Fork::Begins(place, at)) => {
            let period = path.system(at.share)?.drive.period;
            let mirrored = at.shot.comes_upside_down(period);
            found.push((place, if mirrored { Special::SymmetryBreaking } else { Special::BranchPoint }, *at));
        }
        Some(Fork::Joins) => return Ok(Between::Symmetry),
        None => {}
    }
    let outside = |at: &At| -> Result<usize, BranchError<E>> {
        Ok(pairs(&multipliers(at)?).iter().filter(|modulus| **modulus > 1.0 + NEUTRAL).count())
    };
    let mut tests = vec![(Test::Fold, Special::Fold), (Test::PeriodDoubling, Special::PeriodDoubling)];
    let (before, after) = (outside(from)?, outside(to)?);
    if before != after {
        tests.push((Test::Torus(before.min(after)), Special::Torus));
    }
    for (test, special) in tests {
        let ends = [test.value(from)?, test.value(to)?];
        if ends[0] * ends[1] < 0.0
            && let Some((place, at)) = zero(path, from, step, ends, |at| test.value(at))?
            && (!matches!(test, Test::Torus(_)) || test.value(&at)?.abs() < CROSSES)
        {
            found.push((place, special, at));
        }
    }
    found.sort_by(|a, b| a.0.total_cmp(&b.0));
    Ok(Between::Specials(found.into_iter().map(|(_, special, at)| (special, at)).collect()))
}

/// Where a function of the points of a branch vanishes between two of them, by regula falsi (Illinois); an error where points in between
/// are not found: a shorter step may find them.
pub(super) fn zero<E, F: FnMut(f64) -> Result<HybridSystem, E>>(
    path: &mut Path<F>,
    from: &At,
    step: f64,
    ends: [f64; 2],
    value: impl Fn(&At) -> Result<f64, BranchError<E>>,
) -> Result<Option<(f64, At)>, BranchError<E>> {
    let [mut low, mut high] = [(0.0, ends[0]), (step, ends[1])];
    let mut best: Option<(f64, f64, At)> = None;
    for i in 0..EVALUATIONS {
        let chord = (low.0 * high.1 - high.0 * low.1) / (high.1 - low.1);
        let middle = 0.5 * (low.0 + high.0);
        let place = if i % 8 < 7 && chord > low.0 && chord < high.0 { chord } else { middle };
        let at = match path.correct(from, place) {
            Ok(at) => at,
            // Shorter steps would not get over it.
            Err(BranchError::Orbit(_)) if step <= NARROW => break,
            Err(error) => return Err(error),
        };
        let now = value(&at)?;
        if best.as_ref().is_none_or(|(_, least, _)| now.abs() <= least.abs()) {
            best = Some((place, now, at));
        }
        if now == 0.0 {
            break;
        }
        if (now < 0.0) == (low.1 < 0.0) {
            low = (place, now);
            high.1 *= 0.5;
        } else {
            high = (place, now);
            low.1 *= 0.5;
        }
        if high.0 - low.0 <= LOCATED {
            break;
        }
    }
    Ok(best.map(|(place, _, at)| (place, at)))
}
