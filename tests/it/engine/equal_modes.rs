//! Frequencies that are equal, or equal to rounding: plates that are square, masses that are alike.

use shotdamp::dynamics::{HybridSystem, Matrix, Options, Particle, Placed, StartState, event_driven};

use super::arrays::{Dice, chain, cycles, particle, quiet, spring, unit};
use super::bench::within;

/// A product of plane rotations, row by row.
fn rotation(dice: &mut Dice, n: usize) -> Vec<Vec<f64>> {
    let mut turned: Vec<Vec<f64>> = (0..n).map(|i| unit(n, i)).collect();
    for i in 0..n {
        for j in 0..i {
            let (sine, cosine) = dice.between(-3.0, 3.0).sin_cos();
            for row in &mut turned {
                (row[i], row[j]) = (cosine * row[i] - sine * row[j], sine * row[i] + cosine * row[j]);
            }
        }
    }
    turned
}

/// Q diag(values) Qᵀ.
fn with_values(turned: &[Vec<f64>], values: &[f64]) -> Matrix {
    let n = values.len();
    let entry = |i: usize, j: usize| (0..n).map(|k| turned[i][k] * values[k] * turned[j][k]).sum();
    Matrix { order: n, entries: (0..n * n).map(|at| entry(at / n, at % n)).collect() }
}

#[test]
pub(super) fn modes_of_equal_frequency_swing_as_if_they_were_alone() {
    let mut dice = Dice(5);
    for frequencies in [vec![30.0; 2], vec![30.0, 30.0, 70.0], vec![30.0, 50.0, 50.0, 50.0], vec![20.0; 5]] {
        let n = frequencies.len();
        for turn in [false, true] {
            let axes: Vec<Vec<f64>> = if turn { rotation(&mut dice, n) } else { (0..n).map(|i| unit(n, i)).collect() };
            let mut system = chain(&vec![1.0; n], 0.0, 0.0);
            system.stiffness = with_values(&axes, &frequencies.iter().map(|w| w * w).collect::<Vec<_>>());
            system.damping = with_values(&axes, &frequencies.iter().map(|w| 0.1 * w).collect::<Vec<_>>());
            system.drive = quiet(0.13);
            let rate: Vec<f64> = (0..n).map(|_| dice.between(-1.0, 1.0)).collect();
            let start = StartState::Given { q: vec![0.0; n], rate: rate.clone(), particles: Vec::new() };
            let seen = |i: usize| HybridSystem { observed_rows: vec![unit(n, i)], ..system.clone() };
            for i in 0..n {
                let end = event_driven(&seen(i), &Options { start: start.clone(), ..cycles(1) })
                    .unwrap_or_else(|error| panic!("{frequencies:?}, turned {turn}: {error}"));
                let swing = |k: usize| {
                    let (w, along) = (frequencies[k], (0..n).map(|j| axes[j][k] * rate[j]).sum::<f64>());
                    let damped = w * (1.0_f64 - 0.05 * 0.05).sqrt();
                    axes[i][k] * along * (-0.05 * w * 0.13).exp() * (damped * 0.13).sin() / damped
                };
                within("x", end.final_displacement, (0..n).map(swing).sum(), 1e-15);
            }
        }
    }
}

#[test]
pub(super) fn dampers_that_are_alike_on_masses_that_are_alike_do_not_disturb_each_other() {
    // Two scenes side by side in one system, each as it is by itself.
    let one = |count: usize| {
        let mut system = chain(&vec![1.0; count], 0.0, 0.0);
        system.stiffness = Matrix::diagonal(&vec![1000.0; count]);
        system.damping = Matrix::diagonal(&vec![3.0; count]);
        let on =
            |i: usize| -> Particle { particle(0.05, 0.03, unit(count, i), [spring(800.0, 0.4), spring(3000.0, 8.0)]) };
        system.particles = (0..count).map(on).collect();
        system.drive = quiet(0.5);
        let start =
            StartState::Given { q: vec![0.0; count], rate: vec![1.2; count], particles: vec![Placed::ON_FLOOR; count] };
        let options = Options { start, ..cycles(1) };
        event_driven(&system, &options).unwrap_or_else(|error| panic!("{count}: {error}"))
    };
    let (alone, three) = (one(1), one(3));
    assert!(alone.proof.events > 8);
    assert_eq!(three.proof.events, 3 * alone.proof.events);
    within("x", three.final_displacement, alone.final_displacement, 1e-13);
    for [y, rate] in &three.final_particles {
        within("y", *y, alone.final_particles[0][0], 1e-12);
        within("y′", *rate, alone.final_particles[0][1], 1e-11);
    }
}
