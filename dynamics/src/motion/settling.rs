//! Whether a run draws near a motion that comes again, told by the ends of its cycles alone: enough to say that what starts beside it
//! stays beside it, and not enough to name the motion.
//!
//! If the state comes again after a period, at the end of the run closer than after so many cycles, and at no time in between farther
//! than then, the run itself is a neighbour of its orbit that the orbit has drawn in. A start that is moved by much less, and after so
//! many cycles still is, is drawn in as well: its remaining cycles need not be run.

use super::recurrence::{Scale, candidates, settled_after};
use super::tape::{End, Reach};
use crate::options::StartState;
use crate::system::HybridSystem;

/// How closely the last state of a run that draws near has come again, in units of the motion.
const CLOSE: f64 = 1e-6;
/// How closely its states come again from where it counts as near: farther than [`CLOSE`], so that it has been drawn in since.
const NEAR: f64 = 1e-2;
/// How far a neighbour may be from it there: as much less than [`NEAR`] as what is drawn in with it has no other way to go.
const BESIDE: f64 = 1e-8;

/// A run that draws near a motion that comes again.
#[derive(Debug, Clone, PartialEq)]
pub struct Settling {
    scale: Scale,
    /// Cycles after which it is near.
    pub(crate) after: u32,
    /// Where it is then.
    end: End,
}

impl Settling {
    /// Of a run by the ends of its cycles, in units of those from the `first` on. `None` if it does not draw near a motion that comes
    /// again, or too late to spare a neighbour a good part of its cycles.
    pub(crate) fn of(system: &HybridSystem, ends: &[End], first: usize) -> Option<Self> {
        if !system.drive.repeats {
            return None;
        }
        let mut reach = Reach::default();
        ends.iter().skip(first).for_each(|end| reach.take(&end.state));
        let scale = Scale::new(system, &reach);
        let period = *candidates(&scale, ends, CLOSE).first()?;
        let after = settled_after(&scale, ends, period, NEAR);
        let end = ends.get(after.checked_sub(1)?)?.clone();
        let spares = 4 * after <= 3 * ends.len();
        Some(Self { scale, after: u32::try_from(after).ok()?, end }).filter(|_| spares)
    }

    /// A run that is at `other` after as many cycles is beside it.
    pub(crate) fn is_beside(&self, system: &HybridSystem, other: &StartState) -> bool {
        let StartState::Given { q, rate, particles } = other else { return false };
        let Some(absolute) = other.absolute(system) else { return false };
        let contacts = particles.iter().map(|(contact, ..)| *contact).collect();
        self.scale.apart(&self.end, &End::new([q, rate], &absolute, contacts)) <= BESIDE
    }
}
