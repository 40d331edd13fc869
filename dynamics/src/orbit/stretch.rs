//! Part of a step along a branch, and how near multipliers are to those of a special point.

use super::corrector::At;
use super::point::BranchError;
use crate::motion::Multiplier;

/// A multiplier is at 1 or −1 within this; two that meet there are known to the root of rounding.
pub(super) const MEETS: f64 = 1e-4;

/// Part of a step along a branch: the points at its ends, and their places along the tangent of the point that those between them are
/// predicted from.
#[derive(Clone, Copy)]
pub(super) struct Stretch<'a> {
    pub(super) base: &'a At,
    /// Of that point along the step.
    pub(super) from: f64,
    pub(super) places: [f64; 2],
    pub(super) ends: [&'a At; 2],
}

impl<'a> Stretch<'a> {
    /// A whole step.
    pub(super) fn whole(from: &'a At, to: &'a At, step: f64) -> Self {
        Self { base: from, from: 0.0, places: [0.0, step], ends: [from, to] }
    }

    pub(super) fn length(&self) -> f64 {
        self.places[1] - self.places[0]
    }

    pub(super) fn place(&self, share: f64) -> f64 {
        self.places[0] + self.length() * share
    }
}

/// How far the multiplier next to a real number is from it.
pub(super) fn nearest<E>(at: &At, real: f64) -> Result<f64, BranchError<E>> {
    Ok(multipliers(at)?.iter().fold(f64::INFINITY, |least, it| least.min(away(it, real))))
}

pub(super) fn multipliers<E>(at: &At) -> Result<Vec<Multiplier>, BranchError<E>> {
    Ok(at.shot.map.multipliers().map_err(super::OrbitError::from)?)
}

/// From a number on the real axis.
pub(super) fn away(it: &Multiplier, real: f64) -> f64 {
    let (sin, cos) = libm::sincos(it.angle);
    libm::hypot(it.modulus * cos - real, it.modulus * sin)
}
