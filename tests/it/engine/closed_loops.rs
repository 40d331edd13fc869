//! Branches that close: a family of motions that exists within a range of frequencies alone (an isola), against its closed form.

use std::convert::Infallible;
use std::f64::consts::{PI, TAU};

use nalgebra::Vector2;
use shotdamp::dynamics::{Along, Branch, BranchEnd, EventKind, HybridSystem, Orbit, Special, StartState};

use super::bench::{close, in_flight, within};
use super::orbits::{Masri, STIFFNESS, Stopped, oscillator};

impl Masri {
    const MASS_RATIO: f64 = 0.02;

    pub(super) fn at(ratio: f64) -> Self {
        Self { ratio, gap: 0.1, restitution: 0.6, particle: Self::MASS_RATIO }
    }

    /// Force over displacement of the structure alone.
    pub(super) fn dynamic_stiffness(&self) -> f64 {
        (STIFFNESS - self.omega().powi(2)).hypot(Stopped::damping() * self.omega())
    }

    /// Place and velocity over ω of the harmonic part at the impact on the floor, a + b V.
    fn forced(&self) -> [Vector2<f64>; 2] {
        let at = |speed: f64| {
            let [before, train] = self.impact(speed);
            (before - train).component_mul(&Vector2::new(1.0, 1.0 / self.omega()))
        };
        [at(0.0), at(1.0) - at(0.0)]
    }

    /// The smallest force with a motion of two impacts: |a + b V| is the amplitude, a parabola in V under the root.
    pub(super) fn least_force(&self) -> f64 {
        let [a, b] = self.forced();
        (a - b * (a.dot(&b) / b.norm_squared())).norm() * self.dynamic_stiffness()
    }

    /// The greater of the speeds that a force belongs to.
    pub(super) fn greater_speed(&self, force: f64) -> f64 {
        let [a, b] = self.forced();
        let (half, square) = (a.dot(&b), b.norm_squared());
        let rest = a.norm_squared() - (force / self.dynamic_stiffness()).powi(2);
        (-half + (half * half - square * rest).sqrt()) / square
    }

    /// The motion with a speed, at the start of a cycle.
    pub(super) fn start(&self, speed: f64) -> StartState {
        let omega = self.omega();
        let (half, period) = (PI / omega, TAU / omega);
        let [before, train] = self.impact(speed);
        let forced = before - train;
        let (amplitude, theta) = (forced[0].hypot(forced[1] / omega), forced[0].atan2(forced[1] / omega));
        let lag = (Stopped::damping() * omega).atan2(STIFFNESS - omega * omega);
        let since = period - (theta + lag).rem_euclid(TAU) / omega;
        let after = train + Vector2::new(0.0, -2.0 * self.particle * speed);
        let (free, place, velocity) = if since < half {
            (oscillator(since) * after, before[0] + speed * since, speed)
        } else {
            (-oscillator(since - half) * after, self.gap - before[0] - speed * (since - half), -speed)
        };
        let (x, v) = (free[0] - amplitude * lag.sin(), free[1] + amplitude * omega * lag.cos());
        in_flight([x, v], [place - x, velocity - v])
    }
}

/// The frequency ratio between two at which a force is the least one.
fn end_of_the_loop(force: f64, [mut outside, mut inside]: [f64; 2]) -> f64 {
    for _ in 0..200 {
        let middle = 0.5 * (outside + inside);
        if Masri::at(middle).least_force() > force { outside = middle } else { inside = middle }
    }
    inside
}

#[test]
fn a_family_of_two_impacts_under_a_small_force_is_followed_once_around() {
    let (force, inside) = (0.86, 1.019);
    let ends = [1.0, 1.04].map(|outside| end_of_the_loop(force, [outside, inside]));
    let systems = |ratio: f64| Ok::<HybridSystem, Infallible>(Masri::at(ratio).system(force));
    let first = Masri::at(inside);
    let speed = first.greater_speed(force);
    let orbit = Orbit::near(&first.system(force), &first.start(speed), 1).expect("it is near");
    assert_eq!((orbit.cycles, orbit.contacts), (1, 2));
    let along = Along { from: 1.0, to: 1.04, step: 0.02, points: 500 };
    let branch = Branch::follow(systems, &orbit, inside, along).expect("it has a first orbit");
    assert_eq!(branch.end, BranchEnd::Closed);
    let folds: Vec<f64> =
        branch.points.iter().filter(|it| it.special == Some(Special::Fold)).map(|it| it.parameter).collect();
    let [up, down] = folds[..] else { panic!("a loop turns twice: {folds:?}") };
    close("upper end of the loop", up, ends[1], 1e-10);
    close("lower end of the loop", down, ends[0], 1e-10);
    let speed_of = |orbit: &Orbit| {
        let floor = orbit.response.events.iter().find(|event| event.kind == EventKind::FloorContact);
        let approach = floor.expect("it meets the floor").approach;
        -approach * (1.0 + first.restitution) / (2.0 * (1.0 + first.particle))
    };
    for point in &branch.points {
        close("force", Masri::at(point.parameter).force(speed_of(&point.orbit)), force, 1e-10);
    }
    // Once around: the frequency rises, falls and rises again; the last point is the first.
    let ratios: Vec<f64> = branch.points.iter().map(|point| point.parameter).collect();
    let turns = ratios.windows(3).filter(|it| (it[1] - it[0]) * (it[2] - it[1]) < 0.0).count();
    assert_eq!(turns, 2);
    let last = branch.points.last().expect("it has points");
    assert_eq!(last.parameter, inside);
    within("speed", speed_of(&last.orbit), speed_of(&branch.points[0].orbit), 0.0);

    // Downwards it is the same loop, the other way around.
    let down = Along { from: along.to, to: along.from, ..along };
    let back = Branch::follow(systems, &orbit, inside, down).expect("it has a first orbit");
    assert_eq!(back.end, BranchEnd::Closed);
}
