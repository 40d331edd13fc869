//! Model 3: a ceiling on walls of its own, soft or stiff, with and without dashpots; faces rigid, springy, with stops.
//!
//! Floor and ceiling do not move as one, so that the distance between them changes while the particle is on its way, and
//! a particle held by one of them may be met by the other.

use shotdamp::dynamics::{
    Contact, EngineError, Face, HybridSystem, Law, Matrix, Options, Particle, StartState, event_driven,
};

use super::arrays::{Dice, any_law, blows, chain, cycles, quiet, unit};
use super::bench::GRAVITY;

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

#[test]
pub(super) fn between_walls_of_any_kind_momentum_and_energy_close_or_the_squeeze_is_named() {
    let (mut events, mut squeezed) = (0, 0);
    // The last four lay at a rigid ceiling on stiff walls, and did not settle there.
    for seed in (0..60).chain([148, 242, 331, 747]) {
        let system = any_model_3(seed);
        match event_driven(&system, &cycles(5)) {
            Err(EngineError::Squeezed { .. }) => squeezed += 1,
            Err(error) => panic!("seed {seed}: {error}"),
            Ok(response) => {
                let proof = response.proof;
                // A wall of 1e8 N/m makes forces of rounding.
                assert!(proof.momentum_residual < 1e-10 && proof.energy_residual < 1e-10, "seed {seed}: {proof:?}");
                events += proof.events;
            }
        }
    }
    assert!(events > 10_000 && squeezed > 5 && squeezed < 32, "{events} events, {squeezed} squeezed");
}

#[test]
pub(super) fn a_particle_that_both_faces_meet_is_refused_by_name() {
    // The ceiling comes down on the particle that lies on the floor.
    let soft = Law::Resilient { stiffness: 1e4, damping: 1.0, no_tension: false, stop: None };
    for laws in [[soft, soft], [Law::Rigid { restitution: 0.0 }, soft], [soft, Law::Rigid { restitution: 0.5 }]] {
        let mut system = model_3([0.2, 100.0, 0.0], 0.05, 0.01, laws);
        system.drive = quiet(0.4);
        let start =
            StartState::Given { q: vec![0.0, 0.0], rate: vec![0.0, -3.0], particles: vec![(Contact::Floor, 0.0, 0.0)] };
        let refused = event_driven(&system, &Options { start, ..cycles(1) });
        let Err(EngineError::Squeezed { particle: 0, cycle: 0, time }) = refused else { panic!("{refused:?}") };
        // 10 mm at 3 m/s, a little slowed down by the walls.
        assert!((0.003_2..0.003_4).contains(&time), "{time} s");
    }
}
