//! The instant at which a period begins and states are compared: away from contacts.
//!
//! Along a branch the instants of contacts move. One that moves through the beginning of the period makes the state there jump, though
//! nothing happens to the motion: on one side the period begins just before the impact, on the other just after it. Where the force
//! does not jump at that instant, any other does as well: with the flow φ of a part t of a cycle
//!
//! P′ = φ P φ⁻¹,   F sin(ω t′ + φ₀),   t′ counted from there,
//!
//! has the same orbits, multipliers and branches. The middle of the longest time without contacts is taken.

use super::Orbit;
use super::corrector::{At, Path};
use super::newton::closed;
use super::point::BranchError;
use super::shot::{Contacts, Shot, state_after};
use crate::arithmetic::elimination::Solved;
use crate::motion::End;
use crate::system::{Drive, HybridSystem};

/// A contact closer to the beginning than this share of a cycle may be in the way.
const NEAR: f64 = 0.05;
/// It is left, if contacts are farther from another instant by this factor.
const CLEARER: f64 = 2.0;
/// To the side, in units of the motion, to see which way the branch leads.
const ASIDE: f64 = 1e-7;

/// From one beginning of the period to another.
#[derive(Clone, Copy)]
pub(super) struct Shift {
    /// The former one, as a share of a cycle of the drive.
    from: f64,
    /// Cycles until the new one, so that a motion of several cycles begins in the same one of them.
    whole: u32,
    /// And the part of a cycle that follows them.
    part: f64,
}

impl Shift {
    /// Between two shares of a cycle, of a motion of so many cycles.
    fn new(from: f64, to: f64, cycles: u32) -> Self {
        let (whole, part) = if to > from { (0, to - from) } else { (cycles - 1, 1.0 + to - from) };
        Self { from, whole, part }
    }
}

/// The share of a cycle after which no contact is near, if one is near its beginning now.
fn clearer(shot: &Shot, period: f64) -> Option<f64> {
    let mut at: Vec<f64> = shot.response.events.iter().map(|event| event.time / period).collect();
    at.sort_unstable_by(f64::total_cmp);
    let near = at.iter().fold(0.5_f64, |near, at| near.min(*at).min(1.0 - at));
    let next = at.iter().skip(1).copied().chain(at.first().map(|first| 1.0 + first));
    let pause = |(from, to): (f64, f64)| (0.5 * (to - from), (0.5 * (from + to)) % 1.0);
    let (clear, middle) = at.iter().copied().zip(next).map(pause).max_by(|a, b| a.0.total_cmp(&b.0))?;
    (near <= NEAR && clear >= CLEARER * near && middle > 0.0).then_some(middle)
}

impl<E, F: FnMut(f64) -> Result<HybridSystem, E>> Path<F> {
    /// The system whose cycles begin later by a share of a cycle.
    pub(super) fn system_late(&mut self, share: f64, late: f64) -> Result<HybridSystem, BranchError<E>> {
        let parameter = self.parameter(share);
        let mut system = (self.system_at)(parameter).map_err(BranchError::System)?;
        let period = system.drive.period;
        if let Some(harmonic) = system.drive.harmonic.as_mut() {
            harmonic.phase += late * period * harmonic.angular_frequency;
        }
        Ok(system)
    }

    /// The same point, with a period that begins away from contacts; `None` where it does, or where the force jumps.
    pub(super) fn cleared(&mut self, at: &At) -> Option<(Shift, At)> {
        let drive = self.system(at.share).ok()?.drive;
        drive.harmonic_alone()?;
        let middle = clearer(&at.shot, drive.period)?;
        let before = self.late;
        self.late = (before + middle) % 1.0;
        let shift = Shift::new(before, self.late, self.cycles);
        let seen = self.seen_from(at, shift);
        if seen.is_err() {
            self.late = before;
        }
        seen.ok().map(|at| (shift, at))
    }

    /// The point and its tangent after a shift.
    fn seen_from(&mut self, at: &At, shift: Shift) -> Result<At, BranchError<E>> {
        let count = at.shot.miss.len();
        let along = at.tangent[count];
        let (start, contacts) = self.carried(at.share, &at.shot.start, shift)?;
        let system = self.system(at.share)?;
        let (shot, distance) = closed(&system, start.clone(), self.cycles)?;
        let mut onwards = vec![0.0; count + 1];
        onwards[count] = along;
        for aside in [-ASIDE, ASIDE] {
            let moves: Vec<f64> = at.tangent[..count].iter().map(|t| aside * t).collect();
            let (beside, others) = self.carried(at.share + aside * along, &at.shot.moved(&moves), shift)?;
            if others == contacts && beside.contacts == start.contacts {
                let moved = shot.scale.miss(&start, &beside).map(|moved| moved / aside);
                onwards.iter_mut().zip(moved).for_each(|(onwards, moved)| *onwards = moved);
                break;
            }
        }
        let Solved { x: tangent, determinant } = self.tangent(&shot, at.share, &onwards)?;
        Ok(At { share: at.share, shot, distance, tangent, determinant })
    }

    /// A state at another beginning of the period, and the contacts on the way.
    pub(super) fn carried(
        &mut self,
        share: f64,
        start: &End,
        Shift { from, whole, part }: Shift,
    ) -> Result<(End, Contacts), BranchError<E>> {
        let system = self.system_late(share, from)?;
        let (at, mut contacts) =
            if whole > 0 { state_after(&system, start, whole)? } else { (start.clone(), Contacts::new()) };
        let drive = Drive { period: part * system.drive.period, ..system.drive.clone() };
        let (end, others) = state_after(&HybridSystem { drive, ..system }, &at, 1)?;
        contacts.extend(others);
        Ok((end, contacts))
    }

    /// A point as it is seen from the beginning of the drive's own cycle.
    pub(super) fn orbit(&mut self, at: &At) -> Result<Orbit, BranchError<E>> {
        let own = self.system_late(at.share, 0.0)?;
        if self.late == 0.0 {
            return Ok(at.shot.orbit(&own, at.distance)?);
        }
        let (start, _) = self.carried(at.share, &at.shot.start, Shift::new(self.late, 0.0, self.cycles))?;
        // What unstable motions made of rounding on the way is taken off again, unless a contact is at that very instant.
        match closed(&own, start.clone(), self.cycles) {
            Ok((shot, distance)) => Ok(shot.orbit(&own, distance)?),
            Err(_) => Ok(Shot::new(&own, start, self.cycles, None)?.orbit(&own, at.distance)?),
        }
    }
}
