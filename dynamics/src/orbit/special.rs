//! Where a branch changes its kind: test functions, and the search for their zeros along the branch.

use nalgebra::DMatrix;

use super::corrector::{At, Path};
use super::fork::{self, Fork};
use super::point::{BranchError, Special};
use super::stretch::{MEETS, Stretch, away, multipliers, nearest};
use crate::motion::{Multiplier, NEUTRAL};
use crate::system::HybridSystem;

/// Evaluations of a test function.
const EVALUATIONS: usize = 60;
/// A step below which points in between need not be found.
const NARROW: f64 = 1e-4;
/// Shares of the range that are one.
const LOCATED: f64 = 1e-13;
/// A special point of one kind is the same one within this share of a step.
const SAME: f64 = 1e-6;
/// Halvings of a step in which a special point hides.
const HALVINGS: usize = 40;
/// Where a stretch is divided: elsewhere, if there is no orbit, or one whose stability is unsure.
const MIDDLES: [f64; 5] = [0.5, 0.4, 0.6, 0.2, 0.05];
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

    /// A multiplier is where it has to be. Where the motion is not smooth, the function jumps over zero.
    fn is_met<E>(self, at: &At) -> Result<bool, BranchError<E>> {
        let has = |real: f64| Ok(nearest(at, real)? < MEETS);
        match self {
            Self::Fold => has(1.0),
            Self::PeriodDoubling => has(-1.0),
            Self::Torus(_) => Ok(self.value(at)?.abs() < CROSSES),
        }
    }
}

/// Moduli of the complex pairs, largest first.
fn pairs(multipliers: &[Multiplier]) -> Vec<f64> {
    let complex = multipliers.iter().filter(|it| it.angle > 0.0 && it.angle < std::f64::consts::PI);
    complex.step_by(2).map(|it| it.modulus).collect()
}

/// Special points with their places along a step; `None` as in [`between`].
type Found = Option<Vec<(f64, Special, At)>>;

/// The special points between a point and the next, `step` along, in their order; `None` where the motion has lost its asymmetry, and
/// comes to the branch that begins to have one there.
pub(super) fn between<E, F: FnMut(f64) -> Result<HybridSystem, E>>(
    path: &mut Path<F>,
    from: &At,
    to: &At,
    step: f64,
) -> Result<Option<Vec<(Special, At)>>, BranchError<E>> {
    let whole = Stretch::whole(from, to, step);
    let Some(mut found) = watched(path, whole)? else { return Ok(None) };
    let outside = [Outside::of(from)?, Outside::of(to)?];
    if !explained(outside, &found)? {
        // Two changes in one step hide each other, and one next to a graze is hidden by multipliers without bound.
        let mut finer = Vec::new();
        refined(path, whole, outside, HALVINGS, &mut finer)?;
        let has = |list: &[(f64, Special, At)], one: &(f64, Special, At)| {
            list.iter().any(|other| other.1 == one.1 && (other.0 - one.0).abs() <= SAME * step)
        };
        if explained(outside, &finer)? {
            let (again, new): (Vec<_>, Vec<_>) = finer.into_iter().partition(|one| has(&found, one));
            found.retain(|old| has(&again, old));
            found.extend(new);
        } else if finer.len() > found.len() {
            found = finer;
        }
    }
    found.sort_by(|a, b| a.0.total_cmp(&b.0));
    Ok(Some(found.into_iter().map(|(_, special, at)| (special, at)).collect()))
}

/// Zeros of the test functions whose sign changes along a stretch.
fn watched<E, F: FnMut(f64) -> Result<HybridSystem, E>>(
    path: &mut Path<F>,
    stretch: Stretch<'_>,
) -> Result<Found, BranchError<E>> {
    // A branch that ends here turns here, too, and orbits next to that place are hard to find.
    let mut found = Vec::new();
    match fork::between(path, stretch)? {
        Some(Fork::Begins(place, at)) => {
            let period = path.system(at.share)?.drive.period;
            let mirrored = at.shot.comes_upside_down(period);
            found.push((
                stretch.from + place,
                if mirrored { Special::SymmetryBreaking } else { Special::BranchPoint },
                *at,
            ));
        }
        Some(Fork::Joins) => return Ok(None),
        None => {}
    }
    let outside = |at: &At| -> Result<usize, BranchError<E>> {
        Ok(pairs(&multipliers(at)?).iter().filter(|modulus| **modulus > 1.0 + NEUTRAL).count())
    };
    let [from, to] = stretch.ends;
    let mut tests = vec![(Test::Fold, Special::Fold), (Test::PeriodDoubling, Special::PeriodDoubling)];
    let (before, after) = (outside(from)?, outside(to)?);
    if before != after {
        tests.push((Test::Torus(before.min(after)), Special::Torus));
    }
    for (test, special) in tests {
        let ends = [test.value(from)?, test.value(to)?];
        if ends[0] * ends[1] < 0.0
            && let Some((place, at)) = zero(path, stretch.base, stretch.places, ends, |at| test.value(at))?
            && test.is_met(&at)?
        {
            found.push((stretch.from + place, special, at));
        }
    }
    Ok(Some(found))
}

/// Multipliers outside the unit circle.
#[derive(Clone, Copy)]
struct Outside {
    /// Above 1.
    above: usize,
    /// Below −1.
    below: usize,
    all: usize,
    /// One is so close to the circle that rounding decides on which side.
    unsure: bool,
}

impl Outside {
    fn of<E>(at: &At) -> Result<Self, BranchError<E>> {
        let multipliers = multipliers(at)?;
        let outside = || multipliers.iter().filter(|it| it.modulus > 1.0);
        Ok(Self {
            above: outside().filter(|it| it.angle == 0.0).count(),
            below: outside().filter(|it| it.angle == std::f64::consts::PI).count(),
            all: outside().count(),
            unsure: multipliers.iter().any(|it| (it.modulus - 1.0).abs() <= CROSSES),
        })
    }
}

/// The special points account for the multipliers that are outside the unit circle before and after them: each has its own number of
/// others outside, which those before and after it differ from by the critical ones. Real ones become complex, and the other way round,
/// two at a time.
fn explained<E>([before, after]: [Outside; 2], found: &[(f64, Special, At)]) -> Result<bool, BranchError<E>> {
    if before.unsure || after.unsure {
        return Ok(true);
    }
    let mut in_order: Vec<&(f64, Special, At)> = found.iter().collect();
    in_order.sort_by(|a, b| a.0.total_cmp(&b.0));
    let (mut all, mut above, mut below) = (before.all, before.above, before.below);
    for (_, special, at) in in_order {
        let (critical, real) = match special {
            Special::Torus => (2, None),
            Special::PeriodDoubling => (1, Some(-1.0)),
            _ => (1, Some(1.0)),
        };
        let mut multipliers = multipliers(at)?;
        let off = |it: &Multiplier| real.map_or_else(|| off_circle(it), |real| away(it, real));
        multipliers.sort_by(|a, b| off(a).total_cmp(&off(b)));
        let others = multipliers.iter().skip(critical).filter(|it| it.modulus > 1.0).count();
        all = match all {
            _ if all == others => others + critical,
            _ if all == others + critical => others,
            _ => return Ok(false),
        };
        above += usize::from(real == Some(1.0));
        below += usize::from(real == Some(-1.0));
    }
    Ok(all == after.all && (above + after.above).is_multiple_of(2) && (below + after.below).is_multiple_of(2))
}

/// Of a complex one, from the unit circle.
fn off_circle(it: &Multiplier) -> f64 {
    if it.angle > 0.0 && it.angle < std::f64::consts::PI { (it.modulus - 1.0).abs() } else { f64::INFINITY }
}

/// The special points of a stretch, halved where those found do not account for its multipliers.
fn refined<E, F: FnMut(f64) -> Result<HybridSystem, E>>(
    path: &mut Path<F>,
    stretch: Stretch<'_>,
    outside: [Outside; 2],
    halvings: usize,
    found: &mut Vec<(f64, Special, At)>,
) -> Result<(), BranchError<E>> {
    let here = match watched(path, stretch) {
        Ok(here) => here.unwrap_or_default(),
        Err(BranchError::Orbit(_)) => Vec::new(),
        Err(other) => return Err(other),
    };
    if halvings == 0 || explained(outside, &here)? {
        found.extend(here);
        return Ok(());
    }
    for share in MIDDLES {
        let place = stretch.place(share);
        let middle = match path.correct(stretch.base, place) {
            Ok(at) if at.shot.contacts() == stretch.base.shot.contacts() => at,
            Ok(_) | Err(BranchError::Orbit(_)) => continue,
            Err(other) => return Err(other),
        };
        let between = Outside::of(&middle)?;
        if between.unsure {
            continue;
        }
        let [low, high] = stretch.places;
        let [from, to] = stretch.ends;
        let first = Stretch { places: [low, place], ends: [from, &middle], ..stretch };
        // Orbits next to a fork are found from close by.
        let arc = middle.ahead(to);
        let second = if arc > 0.0 {
            Stretch { base: &middle, from: stretch.from + place, places: [0.0, arc], ends: [&middle, to] }
        } else {
            Stretch { places: [place, high], ends: [&middle, to], ..stretch }
        };
        refined(path, first, [outside[0], between], halvings - 1, found)?;
        return refined(path, second, [between, outside[1]], halvings - 1, found);
    }
    found.extend(here);
    Ok(())
}

/// Where a function of the points of a branch vanishes between two of them, by regula falsi (Illinois); an error where points in between
/// are not found: a shorter step may find them.
pub(super) fn zero<E, F: FnMut(f64) -> Result<HybridSystem, E>>(
    path: &mut Path<F>,
    from: &At,
    places: [f64; 2],
    ends: [f64; 2],
    value: impl Fn(&At) -> Result<f64, BranchError<E>>,
) -> Result<Option<(f64, At)>, BranchError<E>> {
    let [mut low, mut high] = [(places[0], ends[0]), (places[1], ends[1])];
    let step = places[1] - places[0];
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
