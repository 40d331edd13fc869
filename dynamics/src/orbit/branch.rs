//! A branch of periodic motions: from point to point, with its special points, until it ends.

use super::corrector::{At, Path};
use super::newton::{CLOSED, closed};
use super::origin::Origin;
use super::point::{Along, BranchEnd, BranchError, BranchPoint, Special};
use super::shot::Shot;
use super::slowing::{GRAZES, Slowing};
use super::special;
use super::{Orbit, OrbitError};
use crate::arithmetic::matrix::{dot, length};
use crate::error::EngineError;
use crate::motion::Multiplier;
use crate::system::HybridSystem;

/// A step below this share of the longest leads nowhere.
const SHORTEST: f64 = 1e-11;
/// A step grows by this after a point that was found.
const GROWTH: f64 = 1.5;
/// Points closer than this share of the longest step are not kept.
const KEPT: f64 = 0.06;
/// Tangents of neighbours differ by less than this cosine.
const STRAIGHT: f64 = 0.9;
/// Share of the way to the graze of a contact that slows down, that one step may go.
const TOWARDS: f64 = 0.5;
/// Steps, tried or made, from one point that is kept to the next.
const MOST_STEPS: usize = 400;
/// Halvings between a sequence of contacts and the next.
const HALVINGS: usize = 60;
/// Clearance in units of the motion, of a branch that ends where a contact begins.
const TOUCHES: f64 = 1e-7;

/// Orbits side by side.
#[derive(Debug, Clone, PartialEq)]
pub struct Branch<E> {
    /// In the order of the branch.
    pub points: Vec<BranchPoint>,
    /// How it ends.
    pub end: BranchEnd<E>,
}

impl<E> Branch<E> {
    /// Follows the orbit of a parameter's value within the range, in the parameter of `system_at`.
    ///
    /// # Errors
    /// [`BranchError`], if there is no first point; beyond it nothing that was found is lost ([`BranchEnd`]).
    pub fn follow(
        system_at: impl FnMut(f64) -> Result<HybridSystem, E>,
        orbit: &Orbit,
        parameter: f64,
        along: Along,
    ) -> Result<Self, BranchError<E>> {
        let mut path = Path::new(system_at, orbit.cycles, along, parameter);
        let system = path.system(path.first())?;
        let (shot, distance) = closed(&system, orbit.begin(&system)?, orbit.cycles)?;
        let at = match path.begin(shot, distance) {
            // The nearest systems that numbers can tell apart lead to other contacts: there is no direction to follow it in.
            Err(BranchError::Orbit(error))
                if is_sensitive(&orbit.multipliers) && !matches!(error, OrbitError::Engine(_)) =>
            {
                let alone = BranchPoint { parameter, orbit: orbit.clone(), special: None };
                return Ok(Self { points: vec![alone], end: BranchEnd::Sensitive });
            }
            begun => begun?,
        };
        Follower::new(path, along, &at).run(at)
    }

    /// Follows the motion of twice the period that begins at a period doubling, on the side of it where that motion exists.
    ///
    /// # Errors
    /// As [`Branch::follow`].
    pub fn doubled(
        system_at: impl FnMut(f64) -> Result<HybridSystem, E>,
        doubling: &BranchPoint,
        along: Along,
    ) -> Result<Self, BranchError<E>> {
        let cycles = doubling.orbit.cycles;
        let mut path = Path::new(system_at, 2 * cycles, along, doubling.parameter);
        let share = path.first();
        let system = path.system(share)?;
        let (single, distance) = closed(&system, doubling.orbit.begin(&system)?, cycles)?;
        // Neighbours of the doubled motion differ by the vector of the multiplier −1, and by no parameter.
        let mut tangent = single.flipping().ok_or_else(|| single.unsolved())?;
        tangent.push(0.0);
        let shot = Shot::new(&system, single.start.clone(), 2 * cycles, Some(&single.scale))?;
        let at = At { share, shot, distance, tangent, determinant: 0.0 };
        Follower::new(path, along, &at).run(at)
    }

    /// Follows the two motions, each the mirror image of the other, that begin where a motion loses its symmetry.
    ///
    /// # Errors
    /// As [`Branch::follow`].
    pub fn asymmetric(
        mut system_at: impl FnMut(f64) -> Result<HybridSystem, E>,
        fork: &BranchPoint,
        along: Along,
    ) -> Result<[Self; 2], BranchError<E>> {
        let Orbit { cycles, distance, .. } = fork.orbit;
        let mut follow = |side: f64| {
            let mut path = Path::new(&mut system_at, cycles, along, fork.parameter);
            let share = path.first();
            let system = path.system(share)?;
            let shot = Shot::new(&system, fork.orbit.begin(&system)?, cycles, None)?;
            // Neighbours differ by the vector of the multiplier 1, and by no parameter.
            let [kept, _] = shot.kept().ok_or_else(|| shot.unsolved())?;
            let tangent = kept.iter().map(|x| side * x).chain([0.0]).collect();
            let at = At { share, shot, distance, tangent, determinant: 0.0 };
            Follower::new(path, along, &at).run(at)
        };
        Ok([follow(1.0)?, follow(-1.0)?])
    }
}

/// A branch under way.
struct Follower<F> {
    path: Path<F>,
    along: Along,
    /// `None` where it cannot come back to it.
    origin: Option<Origin>,
    points: Vec<BranchPoint>,
    slowing: Slowing,
    /// Arc since the last point that was kept.
    since: f64,
    /// The present point is not among those that were kept.
    pending: bool,
    /// The present point is beyond a graze, where a branch may turn back with another sequence of contacts (a fold without a tangent).
    turns: bool,
}

/// What lies between a point and the next.
enum Passed {
    /// Special points in their order.
    Specials(Vec<(Special, At)>),
    /// The first point of the branch, after these.
    Origin(Vec<(Special, At)>),
    /// The motion has lost its asymmetry.
    Symmetry,
}

/// What comes after a point.
enum Next<E> {
    At(Box<At>),
    /// The same point: the branch goes on to its other side.
    Turn,
    End(BranchEnd<E>),
}

impl<E, F: FnMut(f64) -> Result<HybridSystem, E>> Follower<F> {
    fn new(path: Path<F>, along: Along, first: &At) -> Self {
        let origin = Some(Origin::of(first));
        Self {
            path,
            along,
            origin,
            points: Vec::new(),
            slowing: Slowing::default(),
            since: 0.0,
            pending: false,
            turns: false,
        }
    }

    fn run(mut self, mut at: At) -> Result<Branch<E>, BranchError<E>> {
        let mut step = self.along.step;
        self.keep(&at, None)?;
        self.slowing.watch(&at.shot, at.share);
        let (mut steps, mut kept) = (0, self.points.len());
        loop {
            if self.points.len() >= self.along.points {
                return self.end(&at, BranchEnd::Points);
            }
            steps = if self.points.len() == kept { steps + 1 } else { 0 };
            kept = self.points.len();
            if steps > MOST_STEPS {
                return self.end_at(&at, BranchEnd::Sensitive);
            }
            let tried = self.limited(&at, step);
            match self.advance(&at, tried)? {
                Ok(Next::At(next)) => {
                    self.slowing.watch(&next.shot, next.share);
                    at = *next;
                    self.origin.iter_mut().for_each(Origin::leave);
                    step = (GROWTH * tried).min(self.along.step);
                    if let Some(share) = self.slowing.graze(&at.shot) {
                        let parameter = self.path.parameter(share);
                        return self.end(&at, BranchEnd::Graze { parameter });
                    }
                }
                Ok(Next::Turn) => at.tangent.iter_mut().for_each(|t| *t = -*t),
                Ok(Next::End(end)) => return self.end(&at, end),
                Err(_) if let Some(same) = self.cleared(&at) => (at, step) = (same, tried),
                Err(_) if tried > SHORTEST * self.along.step => step = 0.5 * tried,
                Err(BranchError::System(error)) => return self.end(&at, BranchEnd::System(error)),
                Err(BranchError::Orbit(error)) => return self.end_at(&at, BranchEnd::Orbit(error)),
            }
        }
    }

    /// Beside a contact that begins, or that comes to the end of a cycle, that is the reason.
    fn end_at(mut self, at: &At, otherwise: BranchEnd<E>) -> Result<Branch<E>, BranchError<E>> {
        let parameter = self.path.parameter(at.share);
        let period = self.path.system(at.share)?.drive.period;
        let end = match otherwise {
            _ if at.shot.margin() <= TOUCHES => BranchEnd::Graze { parameter },
            _ if at.shot.meets_its_ends(period) => BranchEnd::CycleStart,
            BranchEnd::Orbit(OrbitError::Engine(EngineError::Overrun(_))) => otherwise,
            // No step closes when rounding grows above that by itself.
            BranchEnd::Orbit(_) if at.shot.map.multipliers().is_ok_and(|all| is_sensitive(&all)) => {
                BranchEnd::Sensitive
            }
            otherwise => otherwise,
        };
        self.end(at, end)
    }

    /// A step from a point; the error inside says that it was too long.
    fn advance(&mut self, at: &At, step: f64) -> Result<Result<Next<E>, BranchError<E>>, BranchError<E>> {
        let next = match self.path.correct(at, step) {
            Ok(next) => next,
            Err(error) => return Ok(Err(error)),
        };
        if next.shot.contacts() != at.shot.contacts() {
            return self.change(at, next, step);
        }
        if turn(at, &next) < STRAIGHT {
            return Ok(Err(next.shot.unsolved().into()));
        }
        if at.shot.swaps_halves(&next.shot) {
            return Ok(Ok(Next::End(BranchEnd::HalfPeriod)));
        }
        let specials = match self.passed(at, &next, step) {
            Ok(Passed::Specials(specials)) => specials,
            Ok(Passed::Origin(specials)) => return Ok(Ok(self.close(&specials)?)),
            Ok(Passed::Symmetry) => return Ok(Ok(Next::End(BranchEnd::Symmetry))),
            Err(error) => return Ok(Err(error)),
        };
        let beyond = (next.share > 1.0).then_some(1.0).or((next.share < 0.0).then_some(0.0));
        if let Some(end) = beyond {
            let ends = [at.share - end, next.share - end];
            let last = match special::zero(&mut self.path, at, [0.0, step], ends, |at| Ok(at.share - end)) {
                Ok(Some((_, last))) => last,
                Ok(None) => {
                    self.keep_all(&specials)?;
                    return Ok(Ok(Next::End(BranchEnd::Range)));
                }
                Err(error) => return Ok(Err(error)),
            };
            let system = self.path.system(end)?;
            let (shot, distance) = match closed(&system, last.shot.start, self.path.cycles) {
                Ok(closed) => closed,
                // Nothing that was found before is lost.
                Err(error) => return Ok(Err(error.into())),
            };
            self.keep_all(&specials)?;
            let orbit = self.path.orbit(&At { share: end, shot, distance, ..last })?;
            self.pending = false;
            self.points.push(BranchPoint { parameter: self.path.parameter(end), orbit, special: None });
            return Ok(Ok(Next::End(BranchEnd::Range)));
        }
        self.keep_all(&specials)?;
        self.since += step;
        (self.pending, self.turns) = (true, false);
        if self.since >= KEPT * self.along.step {
            self.keep(&next, None)?;
        }
        Ok(Ok(Next::At(Box::new(next))))
    }

    /// The sequence of contacts changes within a step: where, and whether the branch goes on.
    fn change(&mut self, at: &At, beyond: At, step: f64) -> Result<Result<Next<E>, BranchError<E>>, BranchError<E>> {
        let contacts = at.shot.contacts();
        let [mut low, mut high] = [0.0, step];
        let (mut last, mut first) = (None, Some(beyond));
        for _ in 0..HALVINGS {
            let middle = 0.5 * (low + high);
            if middle <= low || middle >= high {
                break;
            }
            match self.path.correct(at, middle) {
                Ok(point) if point.shot.contacts() == contacts => (low, last) = (middle, Some(point)),
                Ok(point) => (high, first) = (middle, Some(point)),
                Err(BranchError::Orbit(_)) => (high, first) = (middle, None),
                Err(error) => return Ok(Err(error)),
            }
        }
        let before = match last.as_ref().map(|edge| self.passed(at, edge, low)).transpose() {
            Ok(Some(Passed::Specials(specials))) => specials,
            Ok(Some(Passed::Origin(specials))) => return Ok(Ok(self.close(&specials)?)),
            Ok(Some(Passed::Symmetry)) => return Ok(Ok(Next::End(BranchEnd::Symmetry))),
            Ok(None) => Vec::new(),
            Err(error) => return Ok(Err(error)),
        };
        if last.is_none() && self.turns {
            self.turns = false;
            return Ok(Ok(Next::Turn));
        }
        let edge = last.as_ref().unwrap_or(at);
        match first {
            Some(beyond) if turn(edge, &beyond) > 0.0 => {
                let is_slow =
                    |at: &At| at.shot.slowest().is_some_and(|slow| at.shot.share_of_speed(slow.approach) <= GRAZES);
                self.turns = is_slow(edge) || is_slow(&beyond);
                // Else a contact passes the instant at which the period begins.
                let special = if self.path.begins_to_stay(edge, &beyond)? {
                    Some(Special::Sticking)
                } else {
                    self.turns.then_some(Special::Graze)
                };
                self.keep_all(&before)?;
                if special.is_some() {
                    self.keep(edge, special)?;
                }
                self.slowing.clear();
                self.pending = true;
                Ok(Ok(Next::At(Box::new(beyond))))
            }
            // Approached by shorter steps, from the side where it exists.
            _ => Ok(Err(BranchError::Orbit(OrbitError::Grazes {
                cycles: self.path.cycles,
                miss: edge.shot.misses_by(),
            }))),
        }
    }

    /// The same point, with a period that begins away from contacts.
    fn cleared(&mut self, at: &At) -> Option<At> {
        let (shift, same) = self.path.cleared(at)?;
        self.origin = self.origin.take().and_then(|origin| origin.seen_from(&mut self.path, shift));
        Some(same)
    }

    /// What lies between a point and the next.
    fn passed(&mut self, at: &At, next: &At, step: f64) -> Result<Passed, BranchError<E>> {
        let met = match &self.origin {
            Some(origin) => origin.between(&mut self.path, at, next, step)?,
            None => None,
        };
        let (last, arc) = met.as_ref().map_or((next, step), |(place, first)| (first, *place));
        Ok(match special::between(&mut self.path, at, last, arc)? {
            Some(specials) if met.is_some() => Passed::Origin(specials),
            Some(specials) => Passed::Specials(specials),
            None => Passed::Symmetry,
        })
    }

    /// Enters the first point again, after the special points on the way to it.
    fn close(&mut self, specials: &[(Special, At)]) -> Result<Next<E>, BranchError<E>> {
        self.keep_all(specials)?;
        self.points.push(BranchPoint { special: None, ..self.points[0].clone() });
        self.pending = false;
        Ok(Next::End(BranchEnd::Closed))
    }

    /// Enters the special points that lie in the range.
    fn keep_all(&mut self, specials: &[(Special, At)]) -> Result<(), BranchError<E>> {
        let mut inside = specials.iter().filter(|(_, at)| (0.0..=1.0).contains(&at.share));
        inside.try_for_each(|(special, at)| self.keep(at, Some(*special)))
    }

    /// Enters a point.
    fn keep(&mut self, at: &At, special: Option<Special>) -> Result<(), BranchError<E>> {
        let orbit = self.path.orbit(at)?;
        self.points.push(BranchPoint { parameter: self.path.parameter(at.share), orbit, special });
        if special.is_none() {
            (self.since, self.pending) = (0.0, false);
        }
        Ok(())
    }

    fn end(mut self, at: &At, end: BranchEnd<E>) -> Result<Branch<E>, BranchError<E>> {
        let grazed = self.points.last().is_some_and(|last| last.special == Some(Special::Graze));
        if self.pending && !(grazed && matches!(end, BranchEnd::Graze { .. })) {
            self.keep(at, None)?;
        }
        if let (BranchEnd::Graze { .. }, Some(last)) = (&end, self.points.last_mut()) {
            last.special = Some(Special::Graze);
        }
        Ok(Branch { points: self.points, end })
    }

    /// A step that does not go all the way to the graze of a contact that slows down.
    fn limited(&self, at: &At, step: f64) -> f64 {
        let left = self.slowing.left(at.tangent[at.tangent.len() - 1]);
        left.map_or(step, |left| step.min((TOWARDS * left).max(SHORTEST * self.along.step)))
    }
}

/// In a period, rounding grows above what an orbit closes to.
fn is_sensitive(multipliers: &[Multiplier]) -> bool {
    multipliers.first().is_some_and(|largest| f64::EPSILON * largest.modulus > CLOSED)
}

/// Cosine of the angle between the tangents of two points.
fn turn(one: &At, other: &At) -> f64 {
    let here = one.onwards(&other.shot);
    dot(&here, &other.tangent) / length(&here)
}
