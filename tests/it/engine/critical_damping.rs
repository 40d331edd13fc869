//! Modes at critical damping beside others, where two eigenvalues are one and have one eigenvector.

use std::time::Duration;

use shotdamp::accuracy::precise::precise;
use shotdamp::dynamics::{HybridSystem, Law, Matrix, event_driven};

use super::arrays::{Dice, blows, chain, cycles, particle, spring, unit};
use super::bench::within;

/// Four cycles of 0.5 s after one impulse of 1 N s on the first mass, at 10 rad/s; `damping_ratio` of that alone.
fn after_an_impulse(mass: f64, damping_ratio: f64) -> HybridSystem {
    let mut system = chain(&[mass, 1.0], 0.0, 0.0);
    system.mass = Matrix::diagonal(&[mass, 1.0]);
    system.stiffness = Matrix::diagonal(&[100.0 * mass, 400.0]);
    system.damping = Matrix::diagonal(&[20.0 * damping_ratio * mass, 1.0]);
    system.force_row = unit(2, 0);
    system.observed_rows = vec![unit(2, 0)];
    system.drive = blows(0.5, 1.0);
    system.drive.repeats = false;
    system
}

#[test]
pub(super) fn averages_of_a_mode_at_critical_damping_are_those_of_the_formula() {
    // ∫ v² dt = (J/m)²/(4 ζ ω) in the long run; of v = (J/m) (1 − τ) e^−τ with τ = ω t there is that much left at τ.
    let (omega, tau) = (10.0, 20.0_f64);
    let left = (-2.0 * tau).exp() * (0.25 - 0.5 * tau + 0.5 * tau * tau);
    for apart in [0.0, 1e-15, -1e-15, 1e-14, -1e-13, 1e-12, -1e-10, 1e-8, -1e-6, 1e-5] {
        for mass in (0..40).map(|i| 1.0 + 0.013 * f64::from(i)) {
            let response = event_driven(&after_an_impulse(mass, 1.0 + apart), &cycles(4))
                .unwrap_or_else(|error| panic!("{mass}, {apart}: {error}"));
            let expected = (0.25 / (1.0 + apart) - left) / (omega * mass * mass);
            let found = response.observed[0].window().velocity_square;
            within(&format!("∫v² of {mass} kg at 1 + {apart:e}"), found / expected, 1.0, 1e-13);
        }
    }
}

#[test]
pub(super) fn energy_is_balanced_where_twins_press_faces_of_critical_damping() {
    // What one of them does against the other is a motion of its own: two equal eigenvalues for each face that is pressed.
    for seed in 0..60 {
        let mut dice = Dice(seed);
        let (mass, omega) = (dice.between(0.01, 0.3), dice.between(30.0, 300.0));
        let face = spring(mass * omega * omega, 2.0 * mass * omega);
        let mut system = chain(&[1.0], dice.between(100.0, 1e4), dice.between(0.1, 5.0));
        system.particles = [0.01, 0.02].map(|gap| particle(mass, gap, unit(1, 0), [face, face])).to_vec();
        system.drive = blows(0.5, dice.between(0.3, 3.0));
        let response = event_driven(&system, &cycles(4)).unwrap_or_else(|error| panic!("{seed}: {error}"));
        assert!(response.proof.energy_residual < 1e-11, "{seed}: {:e}", response.proof.energy_residual);
    }
}

/// Three to five particles alike on one mass, at 1 + `apart` of critical damping. What differs beside is the gap, and with odd seeds the
/// mass, where spring and dashpot go with it.
pub(super) fn twins(seed: u64, apart: f64) -> HybridSystem {
    let mut dice = Dice(seed);
    let omega = dice.between(30.0, 300.0);
    let mut system = chain(&[1.0], dice.between(100.0, 1e4), dice.between(0.1, 5.0));
    let mass = dice.between(0.01, 0.1);
    let one = |i: u64| {
        let mass = if seed.is_multiple_of(2) { mass } else { mass * dice.between(0.5, 2.0) };
        let face = spring(mass * omega * omega, 2.0 * (1.0 + apart) * mass * omega);
        particle(mass, 0.01 + 0.003 * i as f64, unit(1, 0), [face, face])
    };
    system.particles = (0..3 + seed % 3).map(one).collect();
    system.drive = blows(0.08, dice.between(0.8, 1.6));
    system
}

#[test]
pub(super) fn particles_that_are_alike_move_as_they_do_in_many_digits_however_near_to_critical_damping() {
    // Of n particles on one mass n − 1 shares press their faces as if that were at rest: as many equal pairs of eigenvalues, and each pair
    // nearly one at critical damping.
    for (seed, apart) in
        [0.0, 1e-15, -1e-13, 1e-11, -1e-9, 1e-8, -1e-7, 1e-6, 1e-5, -1e-4, 1e-3].into_iter().enumerate()
    {
        let system = twins(seed as u64, apart);
        let Law::Resilient { stiffness, .. } = system.particles[0].floor.law else { unreachable!("a spring") };
        let omega = (stiffness / system.particles[0].mass).sqrt();
        let options = cycles(4);
        let run = event_driven(&system, &options).unwrap_or_else(|error| panic!("{apart}: {error}"));
        let exact =
            precise(&system, &options, Duration::from_secs(120)).unwrap_or_else(|error| panic!("{apart}: {error}"));
        let rms = exact.window().rms_velocity();
        within(&format!("RMS velocity at 1 + {apart:e}"), run.window().rms_velocity() / rms, 1.0, 1e-13);
        for (own, exact) in run.final_particles.iter().zip(&exact.final_particles) {
            within(&format!("particle at 1 + {apart:e}"), own[0], exact[0], 1e-12);
            within(&format!("its rate at 1 + {apart:e}"), own[1], exact[1], 1e-12 * omega);
        }
    }
}
