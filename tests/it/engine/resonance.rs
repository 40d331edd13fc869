//! A structure without damping, driven at its own frequency or next to it: the answer grows with time.

use std::f64::consts::TAU;
use std::time::Duration;

use shotdamp::accuracy::precise::precise;
use shotdamp::dynamics::{Drive, Harmonic, HybridSystem, Method, Options, TraceRequest, event_driven};

use super::arrays::{Dice, any_structure, beam, chain, cycles, particle, quiet, shape, spring};
use super::bench::within;
use super::properties::disagreement;

fn driven(system: HybridSystem, force: f64, angular_frequency: f64) -> HybridSystem {
    let drive = Drive {
        period: TAU / angular_frequency,
        ticks: Vec::new(),
        harmonic: Some(Harmonic { force, angular_frequency, phase: 0.0 }),
        ..quiet(1.0)
    };
    HybridSystem { drive, ..system }
}

/// sin x/x.
fn sinc(x: f64) -> f64 {
    if x.abs() < 1e-4 { 1.0 - x * x / 6.0 } else { x.sin() / x }
}

#[test]
pub(super) fn at_resonance_and_next_to_it_the_motion_grows_as_its_closed_form() {
    // Ω = 32 1/s to the bit.
    let (natural, force) = (32.0, 3.0);
    let apart = (-15..=-3).flat_map(|power| [1.0, -1.0].map(|sign| sign * 10.0_f64.powi(power)));
    for apart in apart.chain([0.0, 2e-3, 5e-3]) {
        let omega = natural * (1.0 + apart);
        let mut system = driven(chain(&[1.0], 0.5 * natural * natural, 0.0), force, omega);
        system.gravity = 0.0;
        for count in [1, 7, 100, 1000] {
            let response = event_driven(&system, &Options { record_events: 0, ..cycles(count) }).unwrap();
            assert!(apart.abs() > 2e-5 || response.method == Method::Simulated);
            // F (Ω sin ωt − ω sin Ωt)/(Ω (Ω² − ω²)) and F ω (cos ωt − cos Ωt)/(Ω² − ω²) at whole periods, by half sum and half
            // difference of both frequencies.
            let t = TAU / omega * f64::from(count);
            let (sum, half) = (0.5 * (natural + omega), 0.5 * (natural - omega));
            let x = -force * omega * t * sinc(2.0 * half * t) / (2.0 * natural * sum);
            let v = force * omega * half * t * t * sinc(half * t).powi(2) / (2.0 * sum);
            // What the motion has reached so far.
            let reached = force / (2.0 * natural) * t.min(1.0 / half.abs());
            let bound = 2e-12 * reached;
            within(&format!("{count} cycles, {apart:e} apart, x"), response.final_displacement, x, bound);
            within(&format!("{count} cycles, {apart:e} apart, x′"), response.final_velocity, v, bound * natural);
            let proof = response.proof;
            assert!(proof.energy_residual < 4e-12 && proof.momentum_residual < 4e-12, "{apart:e}: {proof:?}");
        }
    }
}

/// There the motion is far below the steady answer, and its square is not the difference of squares.
#[test]
pub(super) fn averages_of_the_first_cycles_next_to_resonance_keep_their_digits() {
    for damping in [0.0, 1e-5, 1e-4, 1e-3, 1e-2, 0.05] {
        for apart in [0.0, 1e-6, -1e-4, 1e-3, -5e-3, 2e-2, -0.06] {
            let mut system = driven(chain(&[1.0], 0.5, 0.5 * damping), 1.0, 1.0 + apart);
            system.gravity = 0.0;
            system.drive.harmonic.as_mut().expect("it is driven").phase = 0.7;
            for count in [1, 3] {
                let options = cycles(count);
                let exact = precise(&system, &options, Duration::from_secs(60)).unwrap().window();
                let simulated = Options { trace: Some(samples(count)), ..options.clone() };
                for options in [options, simulated] {
                    let own = event_driven(&system, &options).unwrap();
                    let what = format!("damping {damping:e}, {apart:e} apart, {count} cycles, {:?}", own.method);
                    let own = own.window();
                    within(&format!("{what}, ∫v²"), own.velocity_square / exact.velocity_square, 1.0, 3e-12);
                    within(&format!("{what}, deviation"), own.deviation_square / exact.deviation_square, 1.0, 3e-12);
                }
            }
        }
    }
}

/// A history, which only a simulation has.
fn samples(cycles: u32) -> TraceRequest {
    TraceRequest { from_cycle: 0, to_cycle: u64::from(cycles), samples: 4 }
}

#[test]
pub(super) fn each_mode_of_a_structure_has_its_resonance() {
    // A beam, and particles that press into their floors, driven at a natural frequency and next to it.
    let mut compared = 0;
    for (seed, apart) in [0.0, 1e-14, -1e-9, 1e-5, -4e-4].into_iter().enumerate() {
        for mode in 1..=3_u32 {
            let first = 20.0;
            let omega = first * f64::from(mode * mode) * (1.0 + apart);
            let mut system = driven(beam(3, first, 0.0), 2.0, omega);
            let mut dice = Dice(seed as u64);
            if mode > 1 {
                let laws = [spring(dice.ratio(300.0, 3e3), 0.5), spring(dice.ratio(300.0, 3e3), 0.5)];
                system.particles.push(particle(0.02, 0.02, shape(3, 0.3), laws));
            }
            let options = cycles(6);
            let proof = event_driven(&system, &options).unwrap().proof;
            assert!(proof.energy_residual < 1e-12 && proof.momentum_residual < 1e-12, "{apart:e}, {mode}: {proof:?}");
            let Some([error, bound]) = disagreement(&system, &options) else { continue };
            assert!(error <= bound, "{apart:e} apart from mode {mode}: {error:e} of {bound:e}");
            compared += 1;
        }
    }
    assert!(compared > 10, "{compared}");
}

#[test]
pub(super) fn no_structure_is_refused_at_its_own_frequency() {
    for seed in 0..40 {
        let mut dice = Dice(seed);
        let mut system = any_structure(&mut dice);
        system.damping.entries.fill(0.0);
        let n = system.mass.order;
        let rates = nalgebra::DMatrix::from_fn(n, n, |i, j| {
            system.stiffness.at(i, j) / (system.mass.at(i, i) * system.mass.at(j, j)).sqrt()
        });
        let natural = rates.symmetric_eigenvalues()[dice.between(0.0, n as f64 - 1e-9) as usize].sqrt();
        let system = driven(system, dice.ratio(0.1, 10.0), natural * (1.0 + dice.between(-1e-12, 1e-12)));
        let proof = event_driven(&system, &cycles(20)).unwrap_or_else(|error| panic!("seed {seed}: {error}")).proof;
        assert!(proof.energy_residual < 1e-11 && proof.momentum_residual < 1e-11, "seed {seed}: {proof:?}");
    }
}
