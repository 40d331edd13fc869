//! Model 3: a ceiling on walls of its own, soft or stiff, with and without dashpots; faces rigid, springy, with stops.
//!
//! Floor and ceiling do not move as one, so that the distance between them changes while the particle is on its way, and
//! a particle held by one of them may be met by the other.

use shotdamp::dynamics::{Contact, Law, EngineError, Options, StartState, event_driven};

use super::arrays::{Dice, any_law, blows, chain, cycles, unit};
use super::bench::GRAVITY;
use shotdamp::dynamics::{Face, HybridSystem, Matrix, Particle};

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
fn scan() {
    let from: u64 = std::env::var("FROM").map_or(0, |x| x.parse().unwrap());
    for seed in from..from + 400 {
        let system = any_model_3(seed);
        let begin = std::time::Instant::now();
        match event_driven(&system, &cycles(5)) {
            Err(EngineError::Squeezed { .. }) => println!("SQ {seed} {}", system.particles[0].gap),
            Err(error) => println!("BAD {seed}: {error} gap {} laws {:?} {:?} walls {} {} {} mp {} {system:?}", system.particles[0].gap, system.particles[0].floor.law, system.particles[0].ceiling.as_ref().unwrap().law, system.mass.at(1,1), system.stiffness.at(1,1), system.damping.at(1,1), system.particles[0].mass),
            Ok(r) => {
                let p = r.proof;
                if !(p.momentum_residual < 1e-11 && p.energy_residual < 1e-10) || p.events > 20000 || p.ties > 1000 {
                    println!("ODD {seed}: {p:?} {system:?}");
                }
                if begin.elapsed().as_millis() > 200 { println!("SLOW {seed} {:?} {p:?} {system:?}", begin.elapsed()); }
            }
        }
    }
    let _ = (Contact::Flight, Options::default(), StartState::StaticEquilibrium);
}
