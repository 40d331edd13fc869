//! How long particles touch their faces, where events alone leave it open: impacts that take all speed and hold nothing, runs that
//! begin in contact, chatter under a second face, a push that sets in again. The numbers are those of a simulator of its own, which
//! looks at what each face does and at no event; only the scenes are shared with it.

use std::f64::consts::TAU;

use shotdamp::dynamics::{EventKind, HybridSystem, Options, Until};
use shotdamp::measure::{Measure, NamedRows, Request, Settings, SolverChoice, Subject, evaluate};
use shotdamp::scene::{
    ContactDamping, ContactEnd, Damper, Excitation, LimitStop, ParticleStart, PulseShape, Scene, Start, Surface, Walls,
};

use super::arrays::{blows, chain, cycles, go, particle, rigid};
use super::bench::{GRAVITY, base, within};

const MEASURES: [Measure; 5] = [
    Measure::ContactShare,
    Measure::FloorContactTime,
    Measure::FloorReboundSpeed,
    Measure::FloorRestitution,
    Measure::Separations,
];

fn measured(scene: Scene, skip: u32, average: u32) -> [f64; 5] {
    let subject = Subject { scene, undamped: None, comparison: None, mode: 1 };
    let settings = Settings {
        skip,
        average,
        until: Until::Cycles,
        round_period_to: None,
        ensemble: 0,
        named: NamedRows::Results,
        mean_of: 0,
    };
    let request = Request { measures: &MEASURES, ..Request::default() };
    let evaluated = evaluate(subject, SolverChoice::EventDriven, &settings, &request).expect("the scene has an answer");
    std::array::from_fn(|i| evaluated.measured[i].value)
}

/// 1 kg on 1000 N/m with a damping ratio of 0.05.
fn on_base(damper: Damper, excitation: Excitation) -> Scene {
    Scene::on_one_mass(base(1.0, 1000.0, 0.1 * 1000.0_f64.sqrt()), GRAVITY, vec![damper], excitation)
}

fn plastic(gap: f64) -> Damper {
    Damper::between(Surface::Rigid { restitution: 0.0 }, 0.1, gap)
}

fn spring(stiffness: f64, damping: f64, ends: ContactEnd) -> Surface {
    Surface::Resilient { stiffness, damping: ContactDamping::Constant(damping), ends }
}

fn harmonic(force: f64, period: f64) -> Excitation {
    Excitation::Harmonic { force, angular_frequency: TAU / period }
}

fn silent(period: f64) -> Excitation {
    Excitation::ImpulseTrain { impulse: 0.0, period }
}

#[test]
fn a_particle_that_loses_all_its_speed_is_held_only_where_its_face_pushes_it() {
    let train = Excitation::ImpulseTrain { impulse: 0.3, period: TAU / 1000.0_f64.sqrt() };
    let [share, ..] = measured(on_base(plastic(0.01), train), 0, 5);
    within("under impulses", share, 0.573_631, 1e-6);

    // Without weight the base falls away from what it has met.
    let drifting = Scene {
        gravity: 0.0,
        start: Some(Start {
            displacement: 0.01,
            velocity: 0.1,
            particles: vec![ParticleStart::InFlight { height: 0.001, velocity: -0.5 }],
        }),
        ..on_base(plastic(f64::INFINITY), silent(0.05))
    };
    let [share, time, rebound, ..] = measured(drifting, 0, 1);
    assert_eq!([share, time, rebound], [0.0; 3]);
}

#[test]
fn a_particle_that_begins_on_its_floor_is_in_contact_from_the_start() {
    for floor in [Surface::Rigid { restitution: 0.0 }, spring(1000.0, 3.0, ContactEnd::ZeroGap)] {
        let damper = Damper::between(floor, 0.1, 0.02);
        let start = Start {
            displacement: 0.0,
            velocity: 0.1,
            particles: vec![ParticleStart::InFlight { height: 0.0, velocity: 0.0 }],
        };
        let scene = Scene { start: Some(start), ..on_base(damper, silent(0.1)) };
        assert_eq!(measured(scene, 0, 2)[0], 1.0);
    }
}

#[test]
fn a_floor_that_is_pulled_away_from_a_particle_at_rest_on_it_has_lost_it() {
    // Without a spring the base sinks at 2 m/s², and the particle falls at 1 m/s².
    for floor in [
        Surface::Rigid { restitution: 0.0 },
        spring(1000.0, 0.0, ContactEnd::ZeroGap),
        spring(1000.0, 3.0, ContactEnd::ZeroForce),
    ] {
        let what = format!("{floor:?}");
        let shape = PulseShape::Rectangular;
        let excitation = Excitation::PulseTrain { impulse: -0.2, period: 0.1, duration: 0.1, shape };
        let start = Start { displacement: 0.0, velocity: 0.0, particles: vec![ParticleStart::OnFloor] };
        let scene =
            Scene::on_one_mass(base(1.0, 0.0, 0.0), 1.0, vec![Damper::between(floor, 0.1, f64::INFINITY)], excitation);
        let scene = Scene { start: Some(start), ..scene };
        let [share, .., separations] = measured(scene, 0, 1);
        assert_eq!([share, separations], [0.0, 1.0], "{what}");
    }
}

#[test]
fn chatter_on_the_floor_ends_no_contact_with_a_ceiling_that_presses() {
    let ceiling = spring(300.0, 5.0, ContactEnd::ZeroGap);
    let walls = Walls { stiffness: 500.0, damping: 1.0, ceiling_mass: 0.1 };
    let damper =
        Damper { ceiling, walls: Some(walls), ..Damper::between(Surface::Rigid { restitution: 0.3 }, 0.05, 0.001) };
    let [share, ..] = measured(on_base(damper, harmonic(20.0, 0.1)), 1, 4);
    within("between a rigid floor and a soft ceiling", share, 0.742_652, 1e-5);
}

#[test]
fn a_floor_that_pushes_again_is_in_contact_until_it_lets_go() {
    let damper = Damper {
        stop: Some(LimitStop { length: 0.003, restitution: 0.5 }),
        ..Damper::between(spring(300.0, 20.0, ContactEnd::ZeroForce), 0.05, 0.006)
    };
    let [share, time, rebound, restitution, _] = measured(on_base(damper, harmonic(60.0, 0.08)), 1, 4);
    within("share", share, 0.488_431, 1e-6);
    within("last contact", time, 0.020_366_5, 1e-7);
    within("rebound", rebound, 0.043_579_1, 1e-7);
    within("restitution", restitution, -0.969_7, 1e-4);
}

#[test]
fn a_landing_lasts_beside_one_that_ends_its_bounces_at_the_same_instant() {
    // Thrown together, both land together: one gives back next to nothing, the other nothing.
    let lands = |restitutions: [f64; 2]| {
        let particle = |e: f64| particle(0.05, 0.5, vec![1.0], [rigid(e), rigid(0.0)]);
        let particles = restitutions.map(particle).to_vec();
        let system = HybridSystem { particles, gravity: GRAVITY, drive: blows(0.6, 1.0), ..chain(&[1.0], 500.0, 2.0) };
        let events = go(&system, &Options { record_events: usize::MAX, ..cycles(1) }).events;
        assert!(events.iter().any(|event| event.kind == EventKind::ChatterEnd), "{events:?}");
        events.into_iter().filter(|event| event.kind == EventKind::FloorContact).map(|event| event.lasts).collect()
    };
    let (ahead, behind): (Vec<bool>, Vec<bool>) = (lands([1e-10, 0.0]), lands([0.0, 1e-10]));
    assert!(ahead.iter().any(|lasts| *lasts), "{ahead:?}");
    assert_eq!(ahead.iter().filter(|lasts| **lasts).count(), behind.iter().filter(|lasts| **lasts).count());
}
