//! What a particle that meets its faces once a period does to the structure: the steady response to a train of unit impulses, and the
//! amplitude that the harmonic drive alone gives the faces. Both are linear, so that the structure without its particle is solved once.

use std::f64::consts::TAU;

use super::Steady;
use super::cycle::{Affine, jump, times};
use crate::arithmetic::cholesky::Cholesky;
use crate::arithmetic::matrix::dot;
use crate::error::EngineError;
use crate::system::{DrivePhase, Face, HybridSystem, Particle};

/// Place and velocity.
#[derive(Clone, Copy)]
pub(super) struct At {
    pub(super) x: f64,
    pub(super) v: f64,
}

/// A structure under a harmonic force, struck once a period by the one particle between its faces.
pub(super) struct Struck<'a> {
    pub(super) particle: &'a Particle,
    pub(super) ceiling: &'a Face,
    pub(super) gravity: f64,
    /// ω, rad/s.
    pub(super) omega: f64,
    /// Amplitude of the faces under the present drive alone, m.
    pub(super) amplitude: f64,
    steady: Steady,
    /// Block coordinates just after an impulse.
    start: Vec<f64>,
}

impl<'a> Struck<'a> {
    /// `None` unless one particle flies between faces that move as one, under a harmonic force alone on a damped structure.
    pub(super) fn of(system: &'a HybridSystem) -> Result<Option<Self>, EngineError> {
        let [particle @ Particle { floor, ceiling: Some(ceiling), .. }] = &system.particles[..] else {
            return Ok(None);
        };
        let Some(harmonic) = system.drive.harmonic_alone().filter(|_| floor.row == ceiling.row) else {
            return Ok(None);
        };
        let bare = HybridSystem { particles: Vec::new(), ..system.clone() };
        let Some(steady) = Steady::of(&bare)? else { return Ok(None) };
        let (omega, row) = (harmonic.angular_frequency, &floor.row);
        let [q, rate] = steady.flow.left(&steady.state, 0.0, 0.0, DrivePhase::of(&bare.drive, 0.0));
        let amplitude = libm::hypot(dot(row, &q), dot(row, &rate) / omega);
        let answer = Cholesky::new(&system.mass)?.solve(row);
        let unit: Vec<f64> = jump(&bare, &steady.flow, 1.0, [0.0; 2], &answer).concat();
        let mut train = Affine::flow(&steady.flow, TAU / omega);
        let struck = train.turn.iter().zip(unit.as_chunks().0);
        train.shift = struck.map(|(turn, jump)| times(*turn, *jump)).collect();
        let Some(before) = train.fixed_point().filter(|_| amplitude > 0.0) else { return Ok(None) };
        let start = before.iter().zip(&unit).map(|(before, jump)| before + jump).collect();
        Ok(Some(Self { particle, ceiling, gravity: system.gravity, omega, amplitude, steady, start }))
    }

    /// T, s.
    pub(super) fn period(&self) -> f64 {
        TAU / self.omega
    }

    /// The faces, a time after one of the impulses.
    pub(super) fn answer(&self, time: f64) -> At {
        let flow = &self.steady.flow;
        let state = Affine::flow(flow, time).apply(&self.start);
        let [q, rate] = flow.left(&state, 0.0, 0.0, DrivePhase::default());
        let row = &self.particle.floor.row;
        At { x: dot(row, &q), v: dot(row, &rate) }
    }
}

/// ε of a rigid face.
pub(super) fn restitution(face: &Face) -> Option<f64> {
    face.law.is_rigid().then(|| face.law.restitution())
}

/// The velocity of the harmonic share at an impact, by Newton's restitution: (1 + ε) H′ is v⁺ + ε v⁻ of the particle less the same of
/// the impulse train.
pub(super) fn harmonic_velocity(restitution: f64, particle: [f64; 2], train: [f64; 2]) -> f64 {
    let [before, after] = [0, 1].map(|side| particle[side] - train[side]);
    (after + restitution * before) / (1.0 + restitution)
}

/// The least value of a function between two of these places, by the golden section around each place that is lower than its
/// neighbours; infinite where it is nowhere finite.
pub(super) fn least(places: &[f64], value: impl Fn(f64) -> f64) -> f64 {
    let values: Vec<f64> = places.iter().map(|place| value(*place)).collect();
    let is_low = |i: &usize| values[*i].is_finite() && values[*i] <= values[i - 1] && values[*i] <= values[i + 1];
    let low = (1..places.len() - 1).filter(is_low);
    low.map(|i| golden_section(places[i - 1], places[i + 1], &value)).fold(f64::INFINITY, f64::min)
}

fn golden_section(mut low: f64, mut high: f64, value: &impl Fn(f64) -> f64) -> f64 {
    const SECTION: f64 = 0.618_033_988_749_894_8;
    const STEPS: u32 = 80;
    let inner = |low: f64, high: f64| [high - SECTION * (high - low), low + SECTION * (high - low)];
    let [mut left, mut right] = inner(low, high);
    let [mut of_left, mut of_right] = [value(left), value(right)];
    for _ in 0..STEPS {
        if of_left <= of_right {
            (high, right, of_right) = (right, left, of_left);
            left = inner(low, high)[0];
            of_left = value(left);
        } else {
            (low, left, of_left) = (left, right, of_right);
            right = inner(low, high)[1];
            of_right = value(right);
        }
    }
    of_left.min(of_right)
}
