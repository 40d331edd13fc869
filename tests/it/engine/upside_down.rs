//! Upside down: what a floor does, a ceiling does under gravity that pulls upwards. No contact state, no event and no bound may know
//! which of the two is called the floor.

use shotdamp::dynamics::{Contact, HybridSystem, Law, Options, Particle, Placed, Response, StartState, dot};
use shotdamp::scene::compile;

use super::arrays::cycles;
use super::bench::note;
use super::drawn_scenes::any_drawn_scene;
use super::random_scenes::{go_on, parted, scenes};

/// The same system in a mirror that lies flat; nothing where a particle has no ceiling.
fn upside_down(system: &HybridSystem) -> Option<HybridSystem> {
    let mut other = HybridSystem { gravity: -system.gravity, ..system.clone() };
    for particle in &mut other.particles {
        std::mem::swap(particle.ceiling.as_mut()?, &mut particle.floor);
    }
    for tick in &mut other.drive.ticks {
        (tick.impulse, tick.level) = (-tick.impulse, -tick.level);
    }
    if let Some(harmonic) = &mut other.drive.harmonic {
        harmonic.force = -harmonic.force;
    }
    Some(other)
}

/// Rigid faces without a gap between them: the particle is at both, and its contact state has but one name.
fn is_enclosed(particle: &Particle) -> bool {
    let rigid = |law: Law| matches!(law, Law::Rigid { .. });
    let ceiling = particle.ceiling.as_ref().is_some_and(|ceiling| rigid(ceiling.law));
    particle.gap == 0.0 && rigid(particle.floor.law) && ceiling
}

fn mirrored(contact: Contact) -> Contact {
    use Contact::{
        Both, BothReleased, Ceiling, CeilingFloorReleased, CeilingReleased, CeilingStop, Flight, Floor,
        FloorCeilingReleased, FloorReleased, FloorStop, HeldByCeiling, HeldByCeilingFloorReleased, HeldByFloor,
        HeldByFloorCeilingReleased,
    };
    match contact {
        Flight | Both | BothReleased => contact,
        Floor => Ceiling,
        Ceiling => Floor,
        FloorStop => CeilingStop,
        CeilingStop => FloorStop,
        FloorReleased => CeilingReleased,
        CeilingReleased => FloorReleased,
        FloorCeilingReleased => CeilingFloorReleased,
        CeilingFloorReleased => FloorCeilingReleased,
        HeldByFloor => HeldByCeiling,
        HeldByCeiling => HeldByFloor,
        HeldByFloorCeilingReleased => HeldByCeilingFloorReleased,
        HeldByCeilingFloorReleased => HeldByFloorCeilingReleased,
    }
}

fn state_upside_down(system: &HybridSystem, state: &StartState) -> StartState {
    let StartState::Given { q, rate, particles } = state else { panic!("a state at the end is given: {state:?}") };
    let turned = |x: &[f64]| x.iter().map(|x| -x).collect::<Vec<_>>();
    let each = system.particles.iter().zip(particles).map(|(particle, &Placed { contact, gap, rate: gap_rate })| {
        let ceiling = particle.ceiling.as_ref().expect("both faces");
        if !is_enclosed(particle) && mirrored(contact) != contact {
            return Placed::new(mirrored(contact), -gap, -gap_rate);
        }
        // Counted from the floor before and after, which are two faces.
        let apart = |x: &[f64]| dot(&particle.floor.row, x) - dot(&ceiling.row, x);
        Placed::new(contact, particle.gap - gap - apart(q), -gap_rate - apart(rate))
    });
    StartState::Given { q: turned(q), rate: turned(rate), particles: each.collect() }
}

/// Back in the coordinates of the system as it was.
fn ends_upside_down(system: &HybridSystem, response: Response) -> Response {
    let places = system.particles.iter().zip(&response.final_particles);
    Response {
        final_displacement: -response.final_displacement,
        final_velocity: -response.final_velocity,
        final_particles: places.map(|(particle, [y, rate])| [particle.gap - y, -rate]).collect(),
        ..response
    }
}

#[test]
pub(super) fn a_scene_does_the_same_upside_down() {
    // Behind the first ones: a base without force, whose acceleration is nothing, and so has no sign in which a half cycle begins.
    let known = [1691];
    let mut found = Vec::new();
    for seed in (0..scenes(200)).chain(known) {
        let scene = any_drawn_scene(seed);
        let system = compile(&scene).unwrap_or_else(|error| panic!("seed {seed}: {error}"));
        let Some(other) = upside_down(&system) else { continue };
        // From a state on the way, so that a mirrored one can be given.
        let begin = Options {
            start: scene.start_state(),
            record_events: 0,
            final_state: true,
            ..cycles(1 + (seed % 3) as u32)
        };
        let Ok(begun) = go_on(&system, &begin) else { continue };
        let start = begun.final_state.expect("it was asked for");
        let start_of_other = state_upside_down(&system, &start);
        let options = Options { start, record_events: 0, ..cycles(3) };
        let Ok(own) = go_on(&system, &options) else { continue };
        let other = match go_on(&other, &Options { start: start_of_other, ..options.clone() }) {
            Ok(other) => ends_upside_down(&system, other),
            Err(error) => {
                found.push(format!("seed {seed}: {error}"));
                continue;
            }
        };
        let residual = other.proof.momentum_residual.max(other.proof.energy_residual);
        note("residual of a balance", residual, 1e-9);
        if residual > 1e-9 {
            found.push(format!("seed {seed}: a residual of {residual:e}"));
        }
        found.extend(parted(seed, &system, &options, [&own, &other]));
    }
    assert!(found.is_empty(), "{found:#?}");
}
