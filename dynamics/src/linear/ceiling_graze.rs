//! How strong a drive lets a particle that bounces on a rigid floor, once a period, first touch the ceiling.
//!
//! Such a particle leaves the floor with gT/2, comes back with the opposite, and gives the structure m g T. The impact fixes the velocity
//! of the harmonic share there, ω S, whatever the strength: what grows is its place C. At a time t of the flight the particle is
//!
//!   a(t) + C (1 − cos ωt),   a(t) = g t (T − t)/2 − S sin ωt + the part of the impulses,
//!
//! above the floor, which grows with C everywhere. So the ceiling is first touched at C = min (h − a)/(1 − cos ωt), and the strength is
//! √(C² + S²) over the amplitude of the present drive. Motions with C below zero do not attract.

use std::f64::consts::TAU;

use super::struck::{Struck, harmonic_velocity, least, restitution};
use crate::arithmetic::elementary::sin_cos;

/// Times of the flight that are looked at, evenly spaced.
const TIMES: u32 = 512;

/// The share of the drive's present strength; `None` on a resilient floor, without gravity, and where a motion that attracts touches the
/// ceiling however weak it is.
pub(super) fn share(struck: &Struck<'_>) -> Option<f64> {
    let Struck { particle, gravity, omega, amplitude, .. } = *struck;
    if !(gravity > 0.0) {
        return None;
    }
    let period = struck.period();
    let (leaves, impulse) = (0.5 * gravity * period, particle.mass * gravity * period);
    let [before, after] = [period, 0.0].map(|time| struck.answer(time));
    let train = [before, after].map(|at| -impulse * at.v);
    let s = harmonic_velocity(restitution(&particle.floor)?, [-leaves, leaves], train) / omega;
    let place = |t: f64| {
        let (sine, cosine) = sin_cos(omega * t);
        let floor = s * sine - impulse * (struck.answer(t).x - after.x);
        (particle.gap - 0.5 * gravity * t * (period - t) + floor) / (1.0 - cosine)
    };
    let times: Vec<f64> = (1..TIMES).map(|i| TAU / omega * f64::from(i) / f64::from(TIMES)).collect();
    let c = least(&times, place);
    (c > 0.0 && c.is_finite()).then(|| libm::hypot(c, s) / amplitude)
}
