//! What holds in every scene, tried on random ones: any structure, any number of dampers, faces of any kind.

use proptest::prelude::*;
use shotdamp::accuracy::precise::PreciseError;
use shotdamp::dynamics::{Face, HybridSystem, Law, Matrix, Options, Response, event_driven};

use super::arrays::{Dice, any_scene, any_structure, apart, cycles, particle, quiet, spring, structure_after};
use super::bench::{note, within};
use super::critical_damping::twins;

fn tries(count: u32) -> ProptestConfig {
    // The same scenes in every run: a test that fails by chance proves nothing.
    ProptestConfig {
        cases: count,
        failure_persistence: None,
        // A seed that is smaller makes no simpler scene.
        max_shrink_iters: 0,
        rng_seed: proptest::test_runner::RngSeed::Fixed(20_241_121),
        ..ProptestConfig::default()
    }
}

fn tried(count: u32, test: impl Fn(u64)) {
    let mut runner = proptest::test_runner::TestRunner::new(tries(count));
    let outcome = runner.run(&(0..u64::MAX), |seed| {
        test(seed);
        Ok(())
    });
    outcome.unwrap_or_else(|error| panic!("{error}"));
}

fn kicked(system: &HybridSystem, options: &Options) -> Response {
    event_driven(system, &Options { kick: 1e-12, ..options.clone() }).expect("it runs kicked")
}

/// Kinetic, gravitational and elastic energy at the end of a run.
fn energy(system: &HybridSystem, end: &Response, [q, rate]: &[Vec<f64>; 2]) -> f64 {
    let mut energy = 0.5 * system.mass.form(rate, rate) + 0.5 * system.stiffness.form(q, q);
    for (particle, [y, w]) in system.particles.iter().zip(&end.final_particles) {
        let u = y - shotdamp::dynamics::dot(&particle.floor.row, q);
        let pressed = |law: Law, depth: f64| match law {
            Law::Resilient { stiffness, .. } if depth > 0.0 => 0.5 * stiffness * depth * depth,
            _ => 0.0,
        };
        energy += particle.mass * (0.5 * w * w + system.gravity * y) + pressed(particle.floor.law, -u);
        energy += particle.ceiling.as_ref().map_or(0.0, |ceiling| pressed(ceiling.law, u - particle.gap));
    }
    energy
}

#[test]
pub(super) fn left_alone_no_scene_gains_energy() {
    tried(24, |seed| {
        let mut system = any_scene(seed);
        // A face that cannot pull lets its spring go while it is compressed, and the energy in it with it.
        for particle in &mut system.particles {
            let faces = [Some(&mut particle.floor), particle.ceiling.as_mut()];
            for Face { law, .. } in faces.into_iter().flatten() {
                if let Law::Resilient { no_tension, .. } = law {
                    *no_tension = false;
                }
            }
        }
        // One blow, and then nothing.
        system.drive.repeats = false;
        let mut before: Option<f64> = None;
        let mut largest = 0.0_f64;
        for count in 1..=5 {
            let options = cycles(count);
            let end = super::arrays::go(&system, &options);
            let now = energy(&system, &end, &structure_after(&system, &options));
            largest = largest.max(now.abs());
            if let Some(before) = before {
                within(&format!("seed {seed}, gained"), (now - before).max(0.0), 0.0, 1e-12 * largest);
            }
            before = Some(now);
        }
    });
}

/// The same scene in other units: masses in `mass` kg, lengths in `length` m, times in `time` s.
fn in_units(system: &HybridSystem, mass: f64, length: f64, time: f64) -> HybridSystem {
    let scaled = |matrix: &Matrix, by: f64| Matrix {
        order: matrix.order,
        entries: matrix.entries.iter().map(|x| by * x).collect(),
    };
    let (rate, square) = (mass / time, mass / (time * time));
    let law = |law: Law| match law {
        Law::Resilient { stiffness, damping, no_tension, stop } => Law::Resilient {
            stiffness: square * stiffness,
            damping: rate * damping,
            no_tension,
            stop: stop.map(|stop| shotdamp::dynamics::Stop { length: length * stop.length, ..stop }),
        },
        rigid => rigid,
    };
    let mut other = system.clone();
    (other.mass, other.damping, other.stiffness) =
        (scaled(&system.mass, mass), scaled(&system.damping, rate), scaled(&system.stiffness, square));
    other.gravity *= length / (time * time);
    for particle in &mut other.particles {
        particle.mass *= mass;
        particle.gap *= length;
        particle.floor.law = law(particle.floor.law);
        if let Some(ceiling) = &mut particle.ceiling {
            ceiling.law = law(ceiling.law);
        }
    }
    other.drive.period *= time;
    for tick in &mut other.drive.ticks {
        tick.time *= time;
        tick.impulse *= mass * length / time;
        tick.level *= mass * length / (time * time);
    }
    other
}

#[test]
pub(super) fn units_are_a_matter_of_taste() {
    tried(24, |seed| {
        let mut system = any_scene(seed);
        // Chatter ends at a speed in m/s, which other units turn into another one.
        for particle in &mut system.particles {
            let faces = [Some(&mut particle.floor), particle.ceiling.as_mut()];
            for Face { law, .. } in faces.into_iter().flatten() {
                if let Law::Rigid { restitution } = law {
                    *restitution = 0.0;
                }
            }
        }
        // g, mm, ms.
        let (mass, length, time) = (1e3, 1e3, 1e3);
        let own = super::arrays::go(&system, &cycles(2));
        let moved = apart(&own, &kicked(&system, &cycles(2)));
        let mut other =
            event_driven(&in_units(&system, mass, length, time), &cycles(2)).expect("it runs in other units");
        other.final_displacement /= length;
        other.final_velocity /= length / time;
        for end in &mut other.final_particles {
            *end = [end[0] / length, end[1] / (length / time)];
        }
        within(&format!("seed {seed}"), apart(&own, &other), 0.0, 1e-11 + 3.0 * moved);
    });
}

#[test]
pub(super) fn the_unit_of_mass_changes_no_bit() {
    // Powers of four, whose roots are powers of two.
    for seed in 0..60 {
        let system = if seed % 3 == 0 { twins(seed, 0.0) } else { any_scene(seed) };
        let own = super::arrays::go(&system, &cycles(2));
        for mass in [2.0_f64.powi(40), 2.0_f64.powi(-40)] {
            let other = event_driven(&in_units(&system, mass, 1.0, 1.0), &cycles(2)).expect("it runs in other units");
            within(&format!("seed {seed}, a mass unit of {mass:e} kg"), apart(&own, &other), 0.0, 0.0);
        }
    }
}

#[test]
pub(super) fn shorter_search_windows_find_the_same_events() {
    tried(32, |seed| {
        let system = any_scene(seed);
        let own = super::arrays::go(&system, &cycles(3));
        // Where the motion is chaotic beyond all digits, how far one kick moves its end is chance.
        let kicks = [1e-12, -1e-12, 2e-12, 3e-12].map(|kick| Options { kick, ..cycles(3) });
        let moved = kicks.iter().map(|kicked| apart(&own, &super::arrays::go(&system, kicked))).fold(0.0, f64::max);
        let other = super::arrays::go(&system, &Options { window_factor: 0.5, ..cycles(3) });
        within(&format!("seed {seed}"), apart(&own, &other), 0.0, 1e-12 + 3.0 * moved);
    });
}

/// A random scene that the solver of many digits knows.
pub(super) fn known_to_both(seed: u64) -> HybridSystem {
    let mut dice = Dice(seed);
    let mut system = any_structure(&mut dice);
    let n = system.mass.order;
    let count = 1 + dice.between(0.0, 2.99) as usize;
    for _ in 0..count {
        let row: Vec<f64> = (0..n).map(|_| dice.between(-1.0, 1.0)).collect();
        let mut law = || spring(dice.ratio(1e2, 1e6), dice.between(0.0, 6.0));
        let laws = [law(), law()];
        system.particles.push(particle(dice.ratio(1e-2, 0.5), dice.ratio(1e-4, 0.3), row, laws));
    }
    if count == 1 && dice.chance(0.5) {
        // Plastic faces, or stops.
        let law = if dice.chance(0.5) {
            Law::Rigid { restitution: 0.0 }
        } else {
            let stop = Some(shotdamp::dynamics::Stop { length: dice.ratio(1e-3, 1e-1), restitution: 0.0 });
            Law::Resilient { stiffness: dice.ratio(1e2, 1e4), damping: dice.between(0.0, 6.0), no_tension: false, stop }
        };
        system.particles[0].floor.law = law;
        if let Some(ceiling) = &mut system.particles[0].ceiling {
            ceiling.law = law;
        }
    }
    system.drive = quiet(0.2);
    system.drive.period = dice.between(0.05, 0.4);
    system.drive.ticks[0].impulse = dice.ratio(0.03, 3.0);
    system
}

/// How far both are apart, over what a drive known to twelve digits moves the end by.
pub(super) fn disagreement(system: &HybridSystem, options: &Options) -> Option<[f64; 2]> {
    let own = event_driven(system, options).unwrap_or_else(|error| panic!("{error}: {system:?}"));
    let moved = apart(&own, &kicked(system, options));
    let many = match shotdamp::accuracy::precise::precise(system, options, std::time::Duration::from_secs(20)) {
        Ok(many) => many,
        Err(PreciseError::Unknown(_) | PreciseError::TooLong(_)) => return None,
        Err(error) => panic!("{error}: {system:?}"),
    };
    Some([apart(&own, &many), 1e-11 + 3.0 * moved])
}

#[test]
pub(super) fn random_scenes_end_where_many_digits_say() {
    tried(40, |seed| {
        let Some([error, bound]) = disagreement(&known_to_both(seed), &cycles(4)) else { return };
        note(&format!("seed {seed}, end"), error, bound);
        assert!(error <= bound, "seed {seed}: {error:e} of {bound:e}");
    });
}
