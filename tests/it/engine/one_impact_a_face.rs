//! Thresholds of motions with one impact on a face a period, against Masri and Caughey's closed form and against the folds and grazes at
//! which branches of these motions end.

use std::convert::Infallible;
use std::f64::consts::TAU;

use shotdamp::dynamics::{
    Along, Branch, BranchEnd, HybridSystem, Orbit, Special, StartState, ceiling_graze, two_impacts,
};
use shotdamp::scene::Excitation;

use super::bench::{GRAVITY, base, close, damper, in_flight, rigid, scene, system};
use super::orbits::{Masri, STIFFNESS, Stopped};

fn least_force(system: &HybridSystem) -> f64 {
    let drive = system.drive.harmonic.expect("it is harmonic");
    drive.force.abs() * two_impacts(system).expect("it is solved").expect("there is one")
}

#[test]
fn without_weight_the_smallest_force_is_that_of_the_symmetric_motion() {
    for ratio in [0.9, 1.0, 1.019, 1.1, 1.4] {
        let masri = Masri::at(ratio);
        close("force", least_force(&masri.system(3.0)), masri.least_force(), 1e-12);
    }
}

/// The damper with weight.
fn weighed(masri: &Masri, gravity: f64, force: f64) -> HybridSystem {
    let drive = Excitation::Harmonic { force, angular_frequency: masri.omega() };
    let between = damper(masri.particle, masri.gap, rigid(masri.restitution));
    system(&scene(base(1.0, STIFFNESS, Stopped::damping()), gravity, between, drive))
}

fn follow(systems: impl Fn(f64) -> HybridSystem, first: &Orbit, from: f64, to: f64) -> Branch<Infallible> {
    let along = Along { from, to, step: 0.02, points: 2000 };
    Branch::follow(|at| Ok(systems(at)), first, from, along).expect("it is followed")
}

#[test]
fn under_gravity_it_is_where_the_branch_of_the_motion_turns_back() {
    for (ratio, gravity, factor) in [(0.9, 0.01, 1.05), (0.97, 0.5, 1.1), (1.0, 3.0, 1.4), (1.03, 0.01, 1.05)] {
        let masri = Masri { restitution: 0.5, particle: 0.1, ..Masri::at(ratio) };
        let force = factor * masri.least_force();
        let free = Orbit::near(&weighed(&masri, 0.0, force), &masri.start(masri.greater_speed(force)), 1);
        let free = free.expect("the closed form knows it");
        let up = follow(|gravity| weighed(&masri, gravity, force), &free, 0.0, gravity);
        assert_eq!(up.end, BranchEnd::Range, "{ratio} {gravity}");
        let heavy = &up.points.last().expect("it has points").orbit;
        let down = follow(|force| weighed(&masri, gravity, force), heavy, force, 0.01 * force);
        let fold = down.points.iter().find(|point| point.special == Some(Special::Fold)).expect("it turns back");
        close("least force", least_force(&weighed(&masri, gravity, force)), fold.parameter, 1e-10);
    }
}

/// The motion that bounces once a period, a particle without mass on a table that moves as this structure does.
fn bouncing(masri: &Masri, force: f64) -> StartState {
    let (omega, period) = (masri.omega(), TAU / masri.omega());
    let lag = (Stopped::damping() * omega).atan2(STIFFNESS - omega * omega);
    let amplitude = force / masri.dynamic_stiffness();
    let velocity = 0.5 * GRAVITY * period * (1.0 - masri.restitution) / (1.0 + masri.restitution);
    let phase = (velocity / (amplitude * omega)).acos();
    let since = period - ((phase + lag) / omega).rem_euclid(period);
    let (x, v) = (-amplitude * lag.sin(), amplitude * omega * lag.cos());
    let place = amplitude * phase.sin() + 0.5 * GRAVITY * since * (period - since);
    in_flight([x, v], [place - x, GRAVITY * (0.5 * period - since) - v])
}

#[test]
fn a_bouncing_particle_touches_the_ceiling_where_its_branch_ends_in_a_graze() {
    for (ratio, restitution, gap) in [(1.1, 0.3, 0.054), (1.4, 0.3, 0.0333), (1.1, 0.5, 0.05), (1.4, 0.5, 0.031)] {
        let masri = Masri { restitution, particle: 0.002, gap, ..Masri::at(ratio) };
        let at = |force: f64| weighed(&masri, GRAVITY, force);
        let threshold = ceiling_graze(&at(1.0)).expect("it is solved").expect("there is one");
        let below = 0.98 * threshold;
        let orbit = Orbit::near(&at(below), &bouncing(&masri, below), 1).expect("it is near");
        assert_eq!((orbit.cycles, orbit.contacts), (1, 1));
        let branch = follow(at, &orbit, below, 1.2 * threshold);
        let BranchEnd::Graze { parameter } = branch.end else { panic!("{ratio} {restitution}: {:?}", branch.end) };
        close(&format!("{ratio} {restitution}"), threshold, parameter, 1e-10);
    }
}

#[test]
fn other_scenes_have_none_in_closed_form() {
    let masri = Masri::at(1.0);
    let one_face = system(&scene(
        base(1.0, STIFFNESS, Stopped::damping()),
        0.0,
        damper(0.1, f64::INFINITY, rigid(0.5)),
        Excitation::Harmonic { force: 1.0, angular_frequency: masri.omega() },
    ));
    assert_eq!(two_impacts(&one_face), Ok(None));
    assert_eq!(ceiling_graze(&masri.system(1.0)), Ok(None), "without gravity nothing comes down");
}
