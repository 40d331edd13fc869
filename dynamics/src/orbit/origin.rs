//! Whether a branch has come back to its first point: a family of motions may be a closed loop (an isola).
//!
//! With z₀ the first point and t₀ its tangent, a branch that comes through z₀ again in the same direction has a point with
//!
//! (z − z₀)·t₀ = 0,   the product growing,
//!
//! and that point is z₀. One that only passes by has one elsewhere.

use super::corrector::{At, Path};
use super::point::BranchError;
use super::section::Shift;
use super::shot::Shot;
use super::special;
use crate::motion::{End, Scale};
use crate::system::HybridSystem;

/// Two points are one within this: state in units of the motion, and share of the range.
const SAME: f64 = 1e-9;
/// A point farther away than this many steps is not reached by one.
const REACHED: f64 = 2.0;

/// The first point of a branch.
pub(super) struct Origin {
    share: f64,
    start: End,
    scale: Scale,
    tangent: Vec<f64>,
    /// The branch has gone on from it; before, rounding decides on which side of it a point is.
    left: bool,
}

impl Origin {
    pub(super) fn of(at: &At) -> Self {
        let At { share, shot, tangent, .. } = at;
        let (start, scale, tangent) = (shot.start.clone(), shot.scale.clone(), tangent.clone());
        Self { share: *share, start, scale, tangent, left: false }
    }

    /// The branch goes on.
    pub(super) fn leave(&mut self) {
        self.left = true;
    }

    /// The same with a period that begins elsewhere; `None` where it is not found there, and of a branch that begins at a fork, and ends
    /// there if it comes back.
    pub(super) fn seen_from<E, F: FnMut(f64) -> Result<HybridSystem, E>>(
        &self,
        path: &mut Path<F>,
        shift: Shift,
    ) -> Option<Self> {
        let along = self.tangent[self.tangent.len() - 1];
        if along == 0.0 {
            return None;
        }
        let (start, _) = path.carried(self.share, &self.start, shift).ok()?;
        let system = path.system(self.share).ok()?;
        let shot = Shot::new(&system, start, path.cycles, None).ok()?;
        let mut onwards = vec![0.0; self.tangent.len()];
        onwards[shot.miss.len()] = along;
        let tangent = path.tangent(&shot, self.share, &onwards).ok()?.x;
        Some(Self { share: self.share, start: shot.start, scale: shot.scale, tangent, left: self.left })
    }

    /// The first point again, if the branch has come to it between a point and the next, `step` along; and how far along.
    pub(super) fn between<E, F: FnMut(f64) -> Result<HybridSystem, E>>(
        &self,
        path: &mut Path<F>,
        from: &At,
        to: &At,
        step: f64,
    ) -> Result<Option<(f64, At)>, BranchError<E>> {
        if !self.left {
            return Ok(None);
        }
        let ends = [self.ahead(from), self.ahead(to)];
        if !(ends[0] < 0.0 && ends[1] >= 0.0) || self.apart(from).min(self.apart(to)) > REACHED * step {
            return Ok(None);
        }
        let met = special::zero(path, from, [0.0, step], ends, |at| Ok(self.ahead(at)))?;
        Ok(met.filter(|(_, at)| self.apart(at) <= SAME))
    }

    /// (z − z₀)·t₀.
    fn ahead(&self, at: &At) -> f64 {
        let moved = self.scale.miss(&self.start, &at.shot.start).chain([at.share - self.share]);
        moved.zip(&self.tangent).fold(0.0, |sum, (z, t)| sum + z * t)
    }

    /// The largest part of z − z₀; infinite between different contacts at the start.
    fn apart(&self, at: &At) -> f64 {
        self.scale.apart(&self.start, &at.shot.start).max((at.share - self.share).abs())
    }
}
