//! A contact that slows down along a branch, and the parameter at which it has no speed left.
//!
//! λ is a smooth function of the speed v of a rigid impact, so that v = 0 is extrapolated from the last points. It is not where a particle
//! rests on its face and flies for a moment only: the flight begins where the face falls as fast as the particle would, lasts t, and ends
//! with v ~ t³. There λ is a smooth function of t, with λ − λ₀ ~ t², so that ∛v takes the place of v.

use super::shot::Shot;
use crate::arithmetic::lagrange::{combined, weights};

/// A contact slower than this, in units of the motion, is about to graze.
pub(super) const GRAZES: f64 = 1e-3;
/// The same after a flight from rest, which is a thousandth of a cycle then.
const LANDS: f64 = 1e-8;
/// Points that the zero is extrapolated from.
const EXTRAPOLATED: usize = 5;
/// The last points among which they are chosen.
const WATCHED: usize = 12;
/// From one of them to the next the speed falls below this share: closer ones would extrapolate their rounding.
const SLOWER: f64 = 0.8;

/// The slowest contact at the last points, while it slows down.
#[derive(Default)]
pub(super) struct Slowing(Vec<Slow>);

/// At a point.
struct Slow {
    /// Of the range.
    share: f64,
    speed: f64,
    flight: Flight,
}

/// What comes before a contact.
#[derive(Clone, Copy, PartialEq)]
enum Flight {
    Free,
    FromRest,
}

impl Slow {
    /// What λ is a smooth function of.
    fn value(&self) -> f64 {
        match self.flight {
            Flight::Free => self.speed,
            Flight::FromRest => libm::cbrt(self.speed),
        }
    }

    /// What the way in λ is proportional to.
    fn way(&self) -> f64 {
        match self.flight {
            Flight::Free => self.speed,
            Flight::FromRest => self.value() * self.value(),
        }
    }
}

impl Slowing {
    /// Enters the next point.
    pub(super) fn watch(&mut self, shot: &Shot, share: f64) {
        let Some(slowest) = shot.slowest() else { return self.clear() };
        let speed = slowest.approach.abs();
        let flight = if shot.flies_from_rest(&slowest) { Flight::FromRest } else { Flight::Free };
        if self.0.last().is_some_and(|last| speed >= last.speed || flight != last.flight) {
            self.clear();
        }
        if self.0.last().is_some_and(|last| speed > SLOWER * last.speed) {
            return;
        }
        self.0.push(Slow { share, speed, flight });
        if self.0.len() > WATCHED {
            self.0.remove(0);
        }
    }

    pub(super) fn clear(&mut self) {
        self.0.clear();
    }

    /// The arc that is left to the zero, where a step of 1 moves the parameter by so much of its range.
    pub(super) fn left(&self, forwards: f64) -> Option<f64> {
        let [.., before, last] = &self.0[..] else { return None };
        let along = (last.share - before.share).abs() / forwards.abs().max(f64::EPSILON);
        let left = along * last.way() / (before.way() - last.way());
        (left > 0.0).then_some(left)
    }

    /// Share of the range at which no speed is left, once there is little.
    pub(super) fn graze(&self, shot: &Shot) -> Option<f64> {
        let points = &self.0;
        let is_slow = |last: &Slow| {
            let share = shot.share_of_speed(last.speed);
            share <= if last.flight == Flight::FromRest { LANDS } else { GRAZES }
        };
        if points.len() < EXTRAPOLATED || !points.last().is_some_and(is_slow) {
            return None;
        }
        // The first windows lack the next power of the speed, the last ones may extrapolate what a slow contact makes of rounding.
        let zeros: Vec<f64> = points.windows(EXTRAPOLATED).map(extrapolated).collect();
        let closest = zeros.windows(2).min_by(|a, b| (a[1] - a[0]).abs().total_cmp(&(b[1] - b[0]).abs()));
        closest.map(|pair| pair[1]).or_else(|| zeros.first().copied())
    }
}

/// λ at the speed zero: the polynomial through the points.
fn extrapolated(points: &[Slow]) -> f64 {
    let speeds: Vec<f64> = points.iter().map(Slow::value).collect();
    combined(&weights(&speeds, 0.0), points.iter().map(|point| point.share))
}
