//! Thresholds of motions with one impact on a face a period, against Masri and Caughey's closed form and against the folds and grazes at
//! which branches of these motions end.

use std::convert::Infallible;

use shotdamp::dynamics::{
    Along, Branch, BranchEnd, HybridSystem, Options, Orbit, Special, ceiling_graze, event_driven, two_impacts,
};
use shotdamp::scene::Excitation;

use super::bench::{GRAVITY, base, close, damper, rigid, scene, system};
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

#[test]
fn under_gravity_it_is_where_the_branch_of_the_motion_turns_back() {
    for (ratio, gravity) in [(1.1, 0.01), (1.1, 1.0), (1.1, 9.81), (0.97, 3.0)] {
        let masri = Masri { restitution: 0.5, particle: 0.1, ..Masri::at(ratio) };
        let weighed = |gravity: f64, force: f64| {
            let drive = Excitation::Harmonic { force, angular_frequency: masri.omega() };
            let between = damper(masri.particle, masri.gap, rigid(masri.restitution));
            system(&scene(base(1.0, STIFFNESS, Stopped::damping()), gravity, between, drive))
        };
        let force = 2.0 * masri.least_force();
        let free = Orbit::near(&weighed(0.0, force), &masri.start(masri.greater_speed(force)), 1).expect("it is near");
        let heavier = |gravity: f64| Ok::<HybridSystem, Infallible>(weighed(gravity, force));
        let along = Along { from: 0.0, to: gravity, step: 0.05, points: 2000 };
        let up = Branch::follow(heavier, &free, 0.0, along).expect("it has a first orbit");
        assert_eq!(up.end, BranchEnd::Range, "{ratio} {gravity}");
        let weaker = |force: f64| Ok::<HybridSystem, Infallible>(weighed(gravity, force));
        let last = &up.points.last().expect("it has points").orbit;
        assert_eq!((last.cycles, last.contacts), (1, 2));
        let along = Along { from: force, to: 0.01 * force, step: 0.02, points: 2000 };
        let down = Branch::follow(weaker, last, force, along).expect("it has a first orbit");
        let fold = down.points.iter().find(|point| point.special == Some(Special::Fold));
        let last = down.points.last().map(|point| (point.parameter, point.special));
        let fold = fold.unwrap_or_else(|| panic!("{ratio} {gravity}: {last:?}, {:?}", down.end));
        close(&format!("{ratio} {gravity}"), least_force(&weighed(gravity, force)), fold.parameter, 1e-10);
    }
}

#[test]
fn a_bouncing_particle_touches_the_ceiling_where_its_branch_ends_in_a_graze() {
    for (ratio, restitution, gap) in [(1.1, 0.3, 0.05), (1.4, 0.3, 0.03), (1.1, 0.0, 0.05)] {
        let masri = Masri { restitution, particle: 0.1, gap, ..Masri::at(ratio) };
        let at = |force: f64| {
            let drive = Excitation::Harmonic { force, angular_frequency: masri.omega() };
            let between = damper(masri.particle, masri.gap, rigid(masri.restitution));
            system(&scene(base(1.0, STIFFNESS, Stopped::damping()), GRAVITY, between, drive))
        };
        let threshold = ceiling_graze(&at(1.0)).expect("it is solved").expect("there is one");
        let below = 0.9 * threshold;
        let options = Options { skip: 400, average: 1, final_state: true, ..Options::default() };
        let last = event_driven(&at(below), &options).expect("it runs").final_state.expect("it was asked for");
        let orbit = Orbit::near(&at(below), &last, 1).expect("it bounces");
        assert_eq!((orbit.cycles, orbit.contacts), (1, 1), "{ratio} {restitution}");
        let along = Along { from: below, to: 1.2 * threshold, step: 0.02, points: 2000 };
        let systems = |force: f64| Ok::<HybridSystem, Infallible>(at(force));
        let branch = Branch::follow(systems, &orbit, below, along).expect("it has a first orbit");
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
