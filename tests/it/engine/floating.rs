//! Structures that nothing brings back: bases and walls without a spring, with and without a dashpot.
//!
//! A coordinate without spring has an eigenvalue zero, twice if no dashpot holds it either. A constant load then moves it
//! for ever, so that "static answer" means a terminal velocity or a fall.

use std::time::Duration;

use shotdamp::accuracy::precise::precise;
use shotdamp::dynamics::{
    Contact, Drive, EventKind, HybridSystem, Law, Matrix, Options, Placed, Response, StartState, Tick, event_driven,
};
use shotdamp::scene::{Excitation, PulseShape, Scene, Walls};

use super::arrays::{Dice, chain, particle, quiet, spring, unit};
use super::bench::{GRAVITY, base, close, damper, nothing, once, only, resilient, rigid, run, scene, within};

#[test]
pub(super) fn a_base_on_a_dashpot_stops_where_its_impulse_is_used_up() {
    let (mass, damping, impulse, cycle) = (2.0, 3.0, 5.0, 0.7);
    let slide =
        Scene::on_one_mass(base(mass, 0.0, damping), GRAVITY, Vec::new(), Excitation::SingleImpulse { impulse, cycle });
    let response = run(&slide, &once(StartState::StaticEquilibrium));
    let decay = f64::exp(-damping / mass * cycle);
    close("velocity", response.final_velocity, impulse / mass * decay, 1e-14);
    close("displacement", response.final_displacement, impulse / damping * (1.0 - decay), 1e-14);
    let square = (impulse / mass).powi(2) * mass / (2.0 * damping) * (1.0 - decay * decay);
    close("RMS velocity", response.window().rms_velocity(), (square / cycle).sqrt(), 1e-13);
}

#[test]
pub(super) fn under_a_constant_force_it_creeps_at_its_terminal_velocity() {
    let (mass, damping, force) = (2.0, 40.0, 7.0);
    let slide = Scene::on_one_mass(
        base(mass, 0.0, damping),
        GRAVITY,
        Vec::new(),
        Excitation::PulseTrain { impulse: force, period: 1.0, duration: 1.0, shape: PulseShape::Rectangular },
    );
    let response = run(&slide, &Options { skip: 10, average: 10, audit: true, ..Options::default() });
    let terminal = force / damping;
    close("RMS velocity", response.window().rms_velocity(), terminal, 1e-13);
    close("displacement", response.final_displacement, terminal * (20.0 - mass / damping), 1e-13);
}

/// Gives the last coordinate a particle, and the gravity that holds it, if there is a floor for it.
fn carry(system: &mut HybridSystem, floor: Option<Law>, gap: f64) {
    let n = system.mass.order;
    system.particles = floor.iter().map(|&law| particle(0.1, gap, unit(n, n - 1), [law, law])).collect();
    system.gravity = if floor.is_some() { GRAVITY } else { 0.0 };
}

/// So many cycles of a structure that starts at zero with these rates, its particle on the floor: by events, and in many digits.
fn in_both_accuracies(what: &str, system: &HybridSystem, rate: Vec<f64>, cycles: u32) -> [Response; 2] {
    let particles = vec![Placed::ON_FLOOR; system.particles.len()];
    let start = StartState::Given { q: vec![0.0; rate.len()], rate, particles };
    let options = Options { skip: 0, average: cycles, audit: true, start, ..Options::default() };
    let own = event_driven(system, &options).unwrap_or_else(|error| panic!("{what}: {error}"));
    let exact = precise(system, &options, Duration::from_secs(60)).unwrap_or_else(|error| panic!("{what}: {error}"));
    [own, exact]
}

#[test]
pub(super) fn chains_that_float_as_a_whole_move_as_they_do_in_many_digits() {
    // Springs between neighbours alone: the motion of all together is along no coordinate. It is damped not at all, by dashpots beside
    // the springs, by one at one end, or by one at each mass.
    for seed in 0..90 {
        let mut dice = Dice(seed);
        let n = [2, 3, 5][(seed % 3) as usize];
        let kind = seed / 3 % 5;
        let mut system = chain(&(0..n).map(|_| dice.between(0.5, 2.0)).collect::<Vec<_>>(), 0.0, 0.0);
        let between = |matrix: &mut Matrix, i: usize, by: f64| {
            let row: Vec<f64> = unit(n, i).iter().zip(unit(n, i + 1)).map(|(a, b)| a - b).collect();
            let entries = matrix.entries.chunks_exact_mut(n).zip(&row);
            entries.for_each(|(entries, a)| entries.iter_mut().zip(&row).for_each(|(entry, b)| *entry += by * a * b));
        };
        for i in 0..n - 1 {
            let stiffness = dice.between(0.3, 100.0);
            between(&mut system.stiffness, i, stiffness);
            between(&mut system.damping, i, [0.0, 0.01 * stiffness, dice.between(0.0, 0.5), 0.0, 0.0][kind as usize]);
        }
        for i in 0..n {
            let own = [0.0, 0.0, 0.0, if i == 0 { 0.4 } else { 0.0 }, 0.1 * system.mass.at(i, i)];
            system.damping.entries[i * n + i] += own[kind as usize];
        }
        let floor = [None, Some(Law::Rigid { restitution: 0.0 }), Some(spring(200.0, 0.5))][(seed / 15 % 3) as usize];
        carry(&mut system, floor, 0.5);
        system.drive = quiet(1.3);
        system.drive.ticks =
            vec![Tick { time: 0.0, impulse: 0.3, level: 1.0 }, Tick { time: 0.6, impulse: 0.0, level: -0.5 }];
        let rate = (0..n).map(|_| dice.between(-1.0, 1.0)).collect();
        let [own, exact] = in_both_accuracies(&format!("{seed}"), &system, rate, 2);
        assert!(own.proof.energy_residual < 1e-11, "{seed}: {:e}", own.proof.energy_residual);
        within(&format!("{seed}, x"), own.final_displacement, exact.final_displacement, 1e-11);
        within(&format!("{seed}, x′"), own.final_velocity, exact.final_velocity, 1e-11);
        within(&format!("{seed}, RMS"), own.window().rms_velocity() / exact.window().rms_velocity(), 1.0, 1e-11);
    }
}

/// Σ factor·row rowᵀ.
fn squares(n: usize, of: &[(f64, &[f64])]) -> Matrix {
    let entry = |i: usize, j: usize| of.iter().map(|(factor, row)| factor * row[i] * row[j]).sum();
    Matrix { order: n, entries: (0..n * n).map(|at| entry(at / n, at % n)).collect() }
}

#[test]
pub(super) fn several_motions_that_nothing_brings_back_move_as_they_do_in_many_digits() {
    let uneven = Matrix::diagonal(&[0.3, 0.2, 0.7]);
    let chains: [(f64, &[f64]); 2] = [(3.0, &[1.0, -1.0, 0.0, 0.0]), (5.0, &[0.0, 0.0, 1.0, -1.0])];
    for (name, stiffness, damping) in [
        ("two masses on a dashpot between them", squares(2, &[]), squares(2, &[(0.3, &[1.0, -1.0])])),
        ("three", squares(3, &[]), squares(3, &[(0.3, &[1.0, -1.0, 0.0]), (0.7, &[0.0, 1.0, -1.0])])),
        ("two chains on one", squares(4, &chains), squares(4, &[(0.4, &[0.0, 1.0, -1.0, 0.0])])),
        ("two chains", squares(4, &chains), squares(4, &[])),
        ("one spring, one dashpot", squares(3, &[(2.0, &[1.0, -1.0, 0.5])]), squares(3, &[(0.4, &[1.0, 1.0, 0.0])])),
        ("one spring, three dashpots", squares(3, &[(2.0, &[1.0, -1.0, 0.5])]), uneven),
        // Springs that give energy hold nothing, and are no motion that springs do not feel.
        ("a motion that grows", squares(2, &[(1.5, &[1.0, -1.0]), (-0.5, &[1.0, 1.0])]), squares(2, &[])),
        ("one that grows slowly", squares(2, &[(1.005, &[1.0, -1.0]), (-0.005, &[1.0, 1.0])]), squares(2, &[])),
    ] {
        let n = stiffness.order;
        for floor in [None, Some(Law::Rigid { restitution: 0.0 }), Some(spring(200.0, 0.5))] {
            let mut system = chain(&(0..n).map(|i| 1.0 + 0.3 * i as f64).collect::<Vec<_>>(), 0.0, 0.0);
            (system.stiffness, system.damping) = (stiffness.clone(), damping.clone());
            carry(&mut system, floor, 9.0);
            system.drive = Drive { ticks: vec![Tick { time: 0.0, impulse: 0.3, level: 1.0 }], ..quiet(1.3) };
            let rate = (0..n).map(|i| 0.3 - 0.4 * i as f64).collect();
            let [own, exact] = in_both_accuracies(name, &system, rate, 3);
            assert!(own.proof.energy_residual < 1e-12, "{name}: {:e}", own.proof.energy_residual);
            within(&format!("{name}, x"), own.final_displacement / exact.final_displacement, 1.0, 1e-12);
            within(&format!("{name}, RMS"), own.window().rms_velocity() / exact.window().rms_velocity(), 1.0, 1e-12);
        }
    }
}

#[test]
pub(super) fn a_particle_on_it_makes_it_sink() {
    let (mass, particle, damping) = (1.0, 0.25, 2.0);
    let terminal = -particle * GRAVITY / damping;
    let rest = StartState::Given { q: vec![0.0], rate: vec![0.0], particles: vec![Placed::ON_FLOOR] };
    let held = scene(base(mass, 0.0, damping), GRAVITY, damper(particle, f64::INFINITY, rigid(0.0)), nothing(0.9));
    let response = run(&held, &once(rest.clone()));
    let rate = damping / (mass + particle);
    let decay = f64::exp(-rate * 0.9);
    close("velocity", response.final_velocity, terminal * (1.0 - decay), 1e-14);
    close("displacement", response.final_displacement, terminal * (0.9 - (1.0 - decay) / rate), 1e-14);
    assert_eq!(response.proof.events, 0);

    // On a spring too, once its swing has died out; the spring then carries the weight.
    let soft = damper(particle, f64::INFINITY, resilient(500.0, 4.0));
    let response = run(&scene(base(mass, 0.0, damping), GRAVITY, soft, nothing(60.0)), &once(rest));
    close("terminal velocity", response.final_velocity, terminal, 1e-13);
    let compression = response.final_particles[0][0] - response.final_displacement;
    within("compression", compression, -particle * GRAVITY / 500.0, 1e-13);
}

#[test]
pub(super) fn bounces_on_a_sliding_base_lose_nothing_but_to_its_dashpot() {
    // No reference but the balances, which `run` asks for, and the second accuracy. A weaker dashpot costs digits: its
    // terminal velocity, which the flow is written from, grows beyond anything that is reached.
    for stiffness in [300.0, 1e3, 1e6] {
        for damping in [0.01, 0.3, 100.0] {
            let bounce = scene(
                base(1.0, 0.0, damping),
                GRAVITY,
                damper(0.3, 0.4, resilient(stiffness, 0.01 * stiffness.sqrt())),
                Excitation::ImpulseTrain { impulse: 0.9, period: 0.21 },
            );
            let options = Options { skip: 0, average: 20, audit: true, start: on_floor(), ..Options::default() };
            let response = run(&bounce, &options);
            assert!(response.proof.events > 5);
            let again = run(&bounce, &Options { window_factor: 0.4, ..options });
            close("second accuracy", again.window().rms_velocity(), response.window().rms_velocity(), 1e-10);
        }
    }
}

fn on_floor() -> StartState {
    StartState::Given { q: vec![0.0], rate: vec![0.0], particles: vec![Placed::ON_FLOOR] }
}

#[test]
pub(super) fn walls_of_a_dashpot_alone_bring_the_ceiling_to_rest_where_they_hold_it() {
    // A blow to the base: its spring brings it back, the dashpot of the walls drags the ceiling along.
    let mut enclosure = damper(0.05, f64::INFINITY, rigid(0.0));
    enclosure.walls = Some(Walls { stiffness: 0.0, damping: 5.0, ceiling_mass: 0.2 });
    let swing = scene(base(1.0, 1000.0, 3.0), 0.0, enclosure.clone(), nothing(40.0));
    let start = StartState::Given {
        q: vec![0.0, 0.0],
        rate: vec![1.0, 0.0],
        particles: vec![Placed::new(Contact::Flight, 10.0, 0.0)],
    };
    let response = run(&swing, &once(start));
    within("base at rest", response.final_displacement, 0.0, 1e-13);
    within("and still", response.final_velocity, 0.0, 1e-13);

    // And with a particle between them the balances close.
    enclosure.gap = 0.3;
    enclosure.floor = resilient(1000.0, 2.0);
    enclosure.ceiling = resilient(2000.0, 2.0);
    let drive = Excitation::Harmonic { force: 30.0, angular_frequency: 30.0 };
    let shaken = scene(base(1.0, 1000.0, 3.0), GRAVITY, enclosure, drive);
    let start = StartState::Given {
        q: vec![0.0, 0.0],
        rate: vec![0.0, 0.0],
        particles: vec![Placed::new(Contact::Flight, 0.1, 0.0)],
    };
    let response =
        run(&shaken, &Options { skip: 5, average: 50, start, audit: true, record_events: 1000, ..Options::default() });
    assert!(!only(&response, EventKind::CeilingContact).is_empty());
}
