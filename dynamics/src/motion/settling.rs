//! Tells, without naming the motion, whether a neighbouring start stays beside a run.
//!
//! Where a run has come so near a periodic orbit that the orbit draws it in, a start that is much closer to the run than the run to the
//! orbit is drawn in as well. That the orbit does so is seen in how far the state misses itself after a period: less and less.

use std::ops::Range;

use super::recurrence::{Scale, candidates, settled_after};
use super::tape::{End, Reach};
use crate::system::HybridSystem;

/// The run counts as near from the cycle after which no state misses itself by more than this, in units of the motion.
const NEAR: f64 = 1e-2;
/// How closely the last state comes again.
const CLOSE: f64 = 1e-6;
/// The last miss over that where the run first counts as near, at most, for the orbit to draw the run in.
const DRAWN_IN: f64 = 1e-3;
/// How far a neighbour may be from the run where that is near.
const BESIDE: f64 = 1e-8;

/// A run that an orbit draws in.
#[derive(Debug, Clone, PartialEq)]
pub struct Settling {
    scale: Scale,
    /// Cycles after which it is near.
    pub(crate) after: u64,
    /// Where it is then.
    end: End,
}

impl Settling {
    /// The states at the ends of cycles tell it: all of what the motion is until it comes again stands in them.
    pub(crate) fn is_told(system: &HybridSystem) -> bool {
        system.drive.repeats && system.drive.half_cycles.is_none()
    }

    /// Of a run by the ends of its cycles, in units of those averaged. `None` if no orbit draws it in, or so late that
    /// a neighbouring run would have to make most of its cycles all the same.
    pub(crate) fn of(system: &HybridSystem, ends: &[End], averaged: Range<u64>) -> Option<Self> {
        let ends = &ends[..ends.len().min(averaged.end as usize)];
        let mut reach = Reach::default();
        ends.iter().skip(averaged.start as usize).for_each(|end| reach.take(&end.state));
        let scale = Scale::new(system, &reach);
        let period = *candidates(&scale, ends, CLOSE).first()?;
        let after = settled_after(&scale, ends, period, NEAR);
        let miss = |last: usize| scale.apart(&ends[last - period], &ends[last]);
        let is_drawn_in = miss(ends.len() - 1) <= DRAWN_IN * miss(after - 1 + period);
        let spares = 4 * after <= 3 * ends.len();
        let end = ends[after - 1].clone();
        (is_drawn_in && spares).then_some(Self { scale, after: after as u64, end })
    }

    /// A neighbour that is at `end` after as many cycles is beside the run.
    pub(crate) fn is_beside(&self, end: &End) -> bool {
        self.scale.apart(&self.end, end) <= BESIDE
    }
}
