//! Where a period begins is a matter of convention: a motion, its multipliers and its branch are the same from any instant of a cycle.

use std::convert::Infallible;
use std::f64::consts::PI;

use shotdamp::dynamics::{
    Along, Branch, BranchEnd, Drive, HybridSystem, Options, Orbit, Special, StartState, event_driven,
};
use shotdamp::scene::Excitation;

use super::bench::{base, close, damper, resilient, scene, system, within};
use super::orbits::{Masri, STIFFNESS, Stopped, floor_contact};

/// The system whose cycles begin later by a share of a cycle.
fn later(system: &HybridSystem, share: f64) -> HybridSystem {
    let mut system = system.clone();
    let period = system.drive.period;
    let harmonic = system.drive.harmonic.as_mut().expect("the force is harmonic");
    harmonic.phase += share * period * harmonic.angular_frequency;
    system
}

/// Where a motion is after a share of a cycle.
fn after(system: &HybridSystem, start: &StartState, share: f64) -> StartState {
    let drive = Drive { period: share * system.drive.period, ..system.drive.clone() };
    let options = Options { skip: 0, average: 1, start: start.clone(), final_state: true, ..Options::default() };
    let run = event_driven(&HybridSystem { drive, ..system.clone() }, &options).expect("it is simulated");
    run.final_state.expect("it is asked for")
}

#[test]
fn an_orbit_is_the_same_from_any_instant_of_its_cycle() {
    let masri = Masri::at(1.1);
    let rigid = masri.system(10.0);
    let between = damper(0.1, 0.1, resilient(3000.0, 2.0));
    let drive = Excitation::Harmonic { force: 20.0, angular_frequency: masri.omega() };
    let soft = system(&scene(base(1.0, STIFFNESS, Stopped::damping()), 9.81, between, drive));
    for (system, start) in [(rigid, masri.start(masri.greater_speed(10.0))), (soft, StartState::StaticEquilibrium)] {
        let run = Options { skip: 300, average: 50, start, ..Options::default() };
        let orbit = Orbit::after(&system, &run).expect("it settles");
        for share in [0.15, 0.4, 0.83] {
            let from = after(&system, &orbit.start, share);
            let same = Orbit::near(&later(&system, share), &from, orbit.cycles).expect("it is the same motion");
            assert_eq!((same.contacts, same.cycles, same.kind), (orbit.contacts, orbit.cycles, orbit.kind));
            let velocity = |orbit: &Orbit| orbit.response.window().rms_velocity();
            close("RMS velocity", velocity(&same), velocity(&orbit), 1e-12);
            for (one, other) in same.multipliers.iter().zip(&orbit.multipliers) {
                within("multiplier", one.modulus, other.modulus, 1e-9);
            }
        }
    }
}

#[test]
fn a_branch_goes_on_where_an_impact_passes_the_beginning_of_a_cycle() {
    // Down to the fold, and up again with the smaller speed; the closed form knows the force at each.
    let masri = Masri { restitution: 0.5, particle: 0.1, ..Masri::at(1.03) };
    let least = masri.least_force();
    let force = 1.5 * least;
    let orbit = Orbit::near(&masri.system(force), &masri.start(masri.greater_speed(force)), 1).expect("it is one");
    let along = Along { from: force, to: 0.1 * least, step: 0.02, points: 2000 };
    let branch: Branch<Infallible> =
        Branch::follow(|force| Ok(masri.system(force)), &orbit, force, along).expect("it is followed");
    let motions = branch.points.iter().filter(|point| point.orbit.contacts == 2);
    let mut phases = Vec::new();
    for point in motions.filter(|point| point.special != Some(Special::Graze)) {
        let [phase, approach] = floor_contact(&point.orbit, masri.omega());
        let speed = -approach * (1.0 + masri.restitution) / (2.0 * (1.0 + masri.particle));
        close("force", point.parameter, masri.force(speed), 1e-10);
        phases.push(phase);
    }
    let fold = branch.points.iter().position(|point| point.special == Some(Special::Fold)).expect("it folds");
    close("fold", branch.points[fold].parameter, least, 1e-10);
    // Half a cycle after the floor the particle meets the ceiling.
    let [early, late] = [phases[0], phases[phases.len() - 1]];
    assert!(early < PI && late > 1.1 * PI && branch.end == BranchEnd::Range, "from {early} to {late}");
}
