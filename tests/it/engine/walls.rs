//! Model 3: a ceiling on walls of its own, soft or stiff, with and without dashpots; faces rigid, springy, with stops.
//!
//! Floor and ceiling do not move as one, so that the distance between them changes while the particle is on its way, and
//! a particle held by one of them may be met by the other.

use shotdamp::dynamics::{
    Contact, EngineError, EventKind, Face, HybridSystem, Law, Matrix, Options, Particle, Placed, Response, StartState,
    event_driven,
};

use super::arrays::{Dice, Plain, any_law, blows, chain, cycles, quiet, unit};
use super::bench::{GRAVITY, within};

/// One base, a ceiling on walls, a particle between them.
fn model_3(walls: [f64; 3], particle: f64, gap: f64, laws: [Law; 2]) -> HybridSystem {
    let [ceiling_mass, stiffness, damping] = walls;
    let between = |own: f64, wall: f64| Matrix { order: 2, entries: vec![own + wall, -wall, -wall, wall] };
    let mut system = chain(&[1.0, ceiling_mass], 0.0, 0.0);
    system.stiffness = between(1000.0, stiffness);
    system.damping = between(3.0, damping);
    system.gravity = GRAVITY;
    let [floor, ceiling] = laws;
    system.particles = vec![Particle {
        mass: particle,
        floor: Face { row: unit(2, 0), law: floor },
        ceiling: Some(Face { row: unit(2, 1), law: ceiling }),
        gap,
    }];
    system.force_row = unit(2, 0);
    system
}

fn any_model_3(seed: u64) -> HybridSystem {
    let mut dice = Dice(seed);
    let damping = if dice.chance(0.3) { 0.0 } else { dice.ratio(1e-2, 1e2) };
    let walls = [dice.ratio(1e-3, 1.0), dice.ratio(10.0, 1e8), damping];
    let laws = [any_law(&mut dice), any_law(&mut dice)];
    let gap = if dice.chance(0.1) { 0.0 } else { dice.ratio(1e-5, 0.5) };
    let mut system = model_3(walls, dice.ratio(1e-3, 0.5), gap, laws);
    system.drive = blows(dice.between(0.05, 0.4), dice.ratio(0.03, 3.0));
    system
}

/// Neither face yields: a particle between both is a rod between two bodies.
fn is_rod(system: &HybridSystem) -> bool {
    let particle = &system.particles[0];
    let yields = |law: Law| matches!(law, Law::Resilient { stop: None, .. });
    !yields(particle.floor.law) && particle.ceiling.as_ref().is_some_and(|ceiling| !yields(ceiling.law))
}

#[test]
pub(super) fn between_walls_of_any_kind_momentum_and_energy_close_unless_both_faces_are_rigid() {
    let (mut events, mut squeezed) = (0, 0);
    // The last four lay at a rigid ceiling on stiff walls, and did not settle there; before them chatter at one face while the other
    // presses, and faces that let go where they have just met.
    for seed in (0..60).chain([66, 128, 157, 237, 278, 280, 309, 373, 545, 566, 951]).chain([148, 242, 331, 747]) {
        let system = any_model_3(seed);
        match event_driven(&system, &Options { record_events: 0, ..cycles(5) }) {
            Err(EngineError::Squeezed { .. }) if is_rod(&system) => squeezed += 1,
            Err(error) => panic!("seed {seed}: {error}"),
            Ok(response) => {
                let proof = response.proof;
                // A wall of 1e8 N/m makes forces of rounding.
                assert!(proof.momentum_residual < 1e-10 && proof.energy_residual < 1e-10, "seed {seed}: {proof:?}");
                events += proof.events;
            }
        }
    }
    assert!(events > 10_000 && squeezed < 12, "{events} events, {squeezed} squeezed");
}

#[test]
pub(super) fn a_rigid_ceiling_that_takes_nothing_gives_a_particle_back_that_the_floor_presses() {
    // Next to no loss, and none: the same motion. One that sticks there loses its energy, and the balances close all the same.
    let law = |restitution| {
        [Law::Resilient { stiffness: 1000.0, damping: 0.0, no_tension: false, stop: None }, Law::Rigid { restitution }]
    };
    let run = |restitution| {
        let mut system = model_3([0.1, 100.0, 0.0], 0.1, 0.002, law(restitution));
        system.damping = Matrix::diagonal(&[0.0, 0.0]);
        (system.gravity, system.drive) = (0.0, blows(0.02, 0.5));
        system.drive.repeats = false;
        event_driven(&system, &cycles(40)).expect("one face yields")
    };
    let [own, nearly] = [1.0, 1.0 - 1e-5].map(run);
    assert!(own.proof.events > 10 && own.proof.energy_residual < 1e-12, "{:?}", own.proof);
    let rms = |response: &Response| response.window().rms_velocity();
    within("RMS velocity", rms(&own) / rms(&nearly), 1.0, 1e-3);
}

#[test]
pub(super) fn rigid_faces_that_would_both_hold_a_particle_are_refused_by_name() {
    // The ceiling comes down on the particle that lies on the floor.
    let soft = Law::Resilient { stiffness: 1e4, damping: 1.0, no_tension: false, stop: None };
    let rigid = [0.0, 0.5].map(|restitution| Law::Rigid { restitution });
    let run = |laws| {
        let mut system = model_3([0.2, 100.0, 0.0], 0.05, 0.01, laws);
        system.drive = quiet(0.4);
        let start = StartState::Given { q: vec![0.0, 0.0], rate: vec![0.0, -3.0], particles: vec![Placed::ON_FLOOR] };
        event_driven(&system, &Options { start, ..cycles(1) })
    };
    let refused = run(rigid);
    let Err(EngineError::Squeezed { particle: 0, cycle: 0, time }) = refused else { panic!("{refused:?}") };
    // 10 mm at 3 m/s, a little slowed down by the walls.
    assert!((0.003_2..0.003_4).contains(&time), "{time} s");
    for laws in [[soft, soft], [rigid[0], soft], [soft, rigid[1]]] {
        let proof = run(laws).unwrap().proof;
        assert!(proof.events > 1 && proof.energy_residual < 1e-12 && proof.momentum_residual < 1e-12, "{proof:?}");
    }
}

/// A base whose floor rises by q where its ceiling sinks by q, both pressed into the particle from the start: what squeezes the
/// particle does not move it, so that particle and base are an oscillator each.
#[test]
pub(super) fn a_mass_between_two_springs_and_dashpots_is_an_oscillator_of_both() {
    for [base, stiffness, damping, particle, spring, dashpot] in [
        [1.0, 1000.0, 3.0, 0.05, 4e3, 0.0],
        [1.0, 1000.0, 0.0, 0.05, 4e3, 2.0],
        [2.0, 1e5, 1.0, 0.5, 1e5, 40.0],
        [0.3, 500.0, 0.2, 0.01, 1e3, 6.0],
    ] {
        for no_tension in [false, true] {
            let law = Law::Resilient { stiffness: spring, damping: dashpot, no_tension, stop: None };
            let gap = -0.5;
            let mut system = chain(&[base], 0.5 * stiffness, 0.5 * damping);
            system.gravity = 0.0;
            system.particles = vec![Particle {
                mass: particle,
                floor: Face { row: vec![1.0], law },
                ceiling: Some(Face { row: vec![-1.0], law }),
                gap,
            }];
            system.drive = quiet(0.2);
            system.momentum_rows = Vec::new();
            // Where the springs balance, but for a little.
            let rest = [spring * gap / (stiffness + 2.0 * spring), 0.5 * gap];
            let (moved, rates) = ([0.002, 0.003], [0.05, -0.1]);
            let [q, y] = [0, 1].map(|i| rest[i] + moved[i]);
            let start = StartState::Given {
                q: vec![q],
                rate: vec![rates[0]],
                particles: vec![Placed::new(Contact::Both, y - q, rates[1] - rates[0])],
            };
            let response = event_driven(&system, &Options { start, ..cycles(5) }).unwrap();
            let ends = [[response.final_displacement, response.final_velocity], response.final_particles[0]];
            let masses = [base, particle];
            let springs = [stiffness + 2.0 * spring, 2.0 * spring];
            let dashpots = [damping + 2.0 * dashpot, 2.0 * dashpot];
            for i in 0..2 {
                let there = oscillator(masses[i], springs[i], dashpots[i], [moved[i], rates[i]], 1.0);
                let speed = (springs[i] / masses[i]).sqrt() * moved[i] + rates[i].abs();
                within("place between two springs", ends[i][0], rest[i] + there[0], 1e-12 * gap.abs());
                within("speed between two springs", ends[i][1], there[1], 1e-12 * speed);
            }
            let proof = response.proof;
            assert!(proof.events == 0 && proof.energy_residual < 1e-12, "{proof:?}");
        }
    }
}

/// x and x′ of m x″ + c x′ + k x = 0 after a time, below critical damping or above it.
fn oscillator(mass: f64, stiffness: f64, damping: f64, [x, v]: [f64; 2], time: f64) -> [f64; 2] {
    let (decay, square) = (0.5 * damping / mass, stiffness / mass);
    let root = (square - decay * decay).abs().sqrt();
    let (c, s) = if square > decay * decay {
        ((root * time).cos(), (root * time).sin() / root)
    } else {
        ((root * time).cosh(), (root * time).sinh() / root)
    };
    let fades = (-decay * time).exp();
    [fades * (c * x + s * (v + decay * x)), fades * (c * v - s * (decay * v + square * x))]
}

#[test]
pub(super) fn springs_of_faces_that_meet_a_particle_at_once_push_as_a_runge_kutta_integration_says() {
    let (mut both, mut compared) = (0, 0);
    for seed in 0..24 {
        let mut dice = Dice(seed);
        let damping = if dice.chance(0.3) { 0.0 } else { dice.ratio(1e-2, 1e2) };
        let walls = [dice.ratio(1e-2, 1.0), dice.ratio(10.0, 1e4), damping];
        let mut law = || Law::Resilient {
            stiffness: dice.ratio(1e2, 1e4),
            damping: dice.between(0.0, 3.0),
            no_tension: seed % 2 == 1,
            stop: None,
        };
        let laws = [law(), law()];
        let mut system = model_3(walls, dice.ratio(1e-2, 0.5), dice.ratio(1e-5, 0.02), laws);
        let (period, impulse) = (0.1, dice.ratio(0.3, 3.0));
        system.drive = blows(period, impulse);
        let response = event_driven(&system, &cycles(1)).unwrap();
        let proof = response.proof;
        assert!(proof.momentum_residual < 1e-12 && proof.energy_residual < 1e-12, "seed {seed}: {proof:?}");
        let mut on_floor = true;
        for event in &response.events {
            both += u32::from(on_floor && event.kind == EventKind::CeilingContact);
            on_floor = match event.kind {
                EventKind::FloorContact => true,
                EventKind::FloorRelease => false,
                _ => on_floor,
            };
        }
        let plain = Plain::new(&system);
        let Law::Resilient { stiffness, .. } = system.particles[0].floor.law else { continue };
        let weight = system.particles[0].mass * GRAVITY;
        let sunk = -weight / 1000.0;
        let mut z = vec![sunk, sunk, sunk - weight / stiffness, impulse, 0.0, 0.0];
        let steps = 8000;
        for _ in 0..steps {
            z = plain.advance(&z, period / f64::from(steps));
        }
        let [y, w] = response.final_particles[0];
        within(&format!("seed {seed}, x"), response.final_displacement, z[0], 1e-8);
        within(&format!("seed {seed}, x′"), response.final_velocity, z[3], 1e-6);
        within(&format!("seed {seed}, y"), y, z[2], 1e-8);
        within(&format!("seed {seed}, y′"), w, z[5], 1e-5);
        compared += 1;
    }
    assert!(both > 8 && compared == 24, "{both} ceilings met by a particle on the floor");
}

#[test]
pub(super) fn a_gap_that_vanishes_is_no_gap() {
    let law = Law::Resilient { stiffness: 3e3, damping: 2.0, no_tension: false, stop: None };
    let end = |gap: f64| {
        let mut system = model_3([0.3, 800.0, 1.0], 0.1, gap, [law, law]);
        system.drive = blows(0.15, 1.0);
        let response = event_driven(&system, &cycles(2)).unwrap();
        assert!(response.proof.energy_residual < 1e-12, "{:?}", response.proof);
        let [y, w] = response.final_particles[0];
        [response.final_displacement, response.final_velocity, y, w]
    };
    let none = end(0.0);
    for gap in [1e-4, 1e-6, 1e-8, 1e-10] {
        let off = end(gap).iter().zip(none).fold(0.0_f64, |most, (x, y)| most.max((x - y).abs()));
        assert!(off < 500.0 * gap + 1e-11, "a gap of {gap} m: {off:e}");
    }
}
