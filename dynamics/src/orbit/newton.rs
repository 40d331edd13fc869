//! One orbit: Newton's method from a state next to it.

use super::shot::{self, Shot, absolute};
use super::{Orbit, OrbitError};
use crate::budget;
use crate::march;
use crate::motion::{End, MotionKind, Scale, candidates, closest};
use crate::options::{Options, StartState};
use crate::states::States;
use crate::system::HybridSystem;

/// Distance from the orbit, in units of the motion, within which a state is on it.
pub(super) const CLOSED: f64 = 1e-12;
/// A step below this is rounding.
const ROUNDING: f64 = 1e-15;
/// Runs over the period.
const MOST_RUNS: usize = 60;
/// Halvings of a step that leads away.
const HALVINGS: usize = 5;
/// Share of the motion within which a state may be on its way to come again.
const NEAR: f64 = 1e-2;

impl Orbit {
    /// The orbit of so many cycles next to a state at phase 0. One that comes again after a part of them is given with that period.
    ///
    /// # Errors
    /// [`OrbitError`] with the reason.
    pub fn near(system: &HybridSystem, start: &StartState, cycles: u32) -> Result<Self, OrbitError> {
        let start = match absolute(system, start) {
            Some(start) => start,
            // At rest: where so many cycles of the run take it.
            None => last_of(system, &Options { skip: 0, average: cycles, ..Options::default() })?,
        };
        find(system, start, cycles)
    }

    /// The orbit that a run ends next to; its period is that after which the last state comes again.
    ///
    /// # Errors
    /// [`OrbitError`] with the reason: where the run ends in chaos, say.
    pub fn after(system: &HybridSystem, options: &Options) -> Result<Self, OrbitError> {
        repeats(system)?;
        let (response, tape) = budget::within(|| march::named(system, options, States::of(system)))?;
        let scale = Scale::new(system, &tape.reach);
        let chaotic = response.motion.filter(|motion| motion.kind == MotionKind::Chaotic);
        let mut error = chaotic.and_then(|motion| motion.exponent).map(|exponent| OrbitError::Chaotic { exponent });
        if error.is_none() {
            for period in candidates(&scale, &tape.ends, NEAR) {
                let last = tape.ends[tape.ends.len() - 1].clone();
                match find(system, last, u32::try_from(period).unwrap_or(u32::MAX)) {
                    Ok(orbit) => return Ok(orbit),
                    Err(first) => error = error.or(Some(first)),
                }
            }
        }
        let (cycles, miss) = closest(&scale, &tape.ends).unwrap_or((0, f64::INFINITY));
        Err(error.unwrap_or(OrbitError::NeverRepeats { cycles, miss }))
    }

    /// The orbit of so many cycles next to the state that a run ends in, whatever its own period: an unstable one amid chaos, say.
    ///
    /// # Errors
    /// [`OrbitError`] with the reason.
    pub fn beside(system: &HybridSystem, options: &Options, cycles: u32) -> Result<Self, OrbitError> {
        repeats(system)?;
        find(system, last_of(system, options)?, cycles)
    }
}

fn last_of(system: &HybridSystem, options: &Options) -> Result<End, OrbitError> {
    let (_, tape) = budget::within(|| march::taped(system, options, States::of(system), 1))?;
    tape.ends.last().cloned().ok_or(OrbitError::NoCycle)
}

fn repeats(system: &HybridSystem) -> Result<(), OrbitError> {
    if system.drive.repeats { Ok(()) } else { Err(OrbitError::NoPeriod) }
}

/// The orbit next to a state, in its shortest period.
pub(super) fn find(system: &HybridSystem, start: End, cycles: u32) -> Result<Orbit, OrbitError> {
    repeats(system)?;
    let (shot, distance) = closed(system, start, cycles)?;
    let part = shot.shortest_period() as u32;
    let (shot, distance) = if part < cycles { closed(system, shot.start, part)? } else { (shot, distance) };
    shot.orbit(system, distance)
}

/// The run that closes, and how far it is from doing so.
pub(super) fn closed(system: &HybridSystem, start: End, cycles: u32) -> Result<(Shot, f64), OrbitError> {
    let mut shot = Shot::new(system, start, cycles, None)?;
    let mut contacts = shot.contacts();
    let (mut best, mut changed) = (f64::INFINITY, 0);
    let mut runs = 1;
    while runs < MOST_RUNS {
        let miss = shot.misses_by();
        best = best.min(miss);
        let step = if miss.is_finite() { shot.step() } else { None };
        let distance = step.as_ref().map_or(f64::INFINITY, |step| size(step));
        if distance <= ROUNDING {
            return Ok((shot, distance));
        }
        let mut next = None;
        if let Some(step) = step {
            let mut share = 1.0;
            for _ in 0..HALVINGS {
                runs += 1;
                let part: Vec<f64> = step.iter().map(|x| share * x).collect();
                if let Ok(tried) = Shot::new(system, shot.moved(&part), cycles, None) {
                    // What rounding makes of it no longer shrinks.
                    if distance <= CLOSED {
                        let left = tried.step().map_or(f64::INFINITY, |step| size(&step));
                        return Ok(if left < distance { (tried, left) } else { (shot, distance) });
                    }
                    if tried.misses_by() < (1.0 - 0.25 * share) * miss {
                        next = Some(tried);
                        break;
                    }
                }
                share *= 0.5;
            }
        }
        // Where no step leads nearer, the motion itself may.
        let next = match next {
            Some(next) => next,
            None => {
                runs += 1;
                Shot::new(system, shot.end().clone(), cycles, None)?
            }
        };
        let now = next.contacts();
        changed += usize::from(now != contacts);
        contacts = now;
        shot = next;
    }
    // A sequence that settles does so at once; one that goes on changing is that of no orbit.
    if changed > MOST_RUNS / 10 {
        return Err(OrbitError::Grazes { cycles, miss: best });
    }
    Err(if best <= shot::ROUNDING {
        OrbitError::NotAlone { cycles }
    } else {
        OrbitError::NoConvergence { cycles, miss: best }
    })
}

/// The largest part of a step.
pub(super) fn size(step: &[f64]) -> f64 {
    step.iter().fold(0.0, |most, x| most.max(x.abs()))
}
