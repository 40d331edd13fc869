//! Forces that stay on for a part of the cycle: what is counted by stretches, whichever of them is the short one; and what is refused for
//! want of a cycle or of an observed row.

use shotdamp::dynamics::{
    Drive, EngineError, HybridSystem, Options, Orbit, OrbitError, StartState, Tick, TraceRequest, event_driven,
    fundamental_matrix,
};

use super::arrays::{blows, chain, cycles, quiet};
use super::bench::{close, within};

/// Forces in newtons from instants on, in seconds.
fn force(period: f64, levels: &[(f64, f64)]) -> Drive {
    let ticks = levels.iter().map(|&(time, level)| Tick { time, impulse: 0.0, level }).collect();
    Drive { ticks, ..quiet(period) }
}

/// 1 kg on 1000 N/m, with so many N s/m.
fn oscillator(damping: f64, drive: Drive) -> HybridSystem {
    HybridSystem { drive, ..chain(&[1.0], 500.0, 0.5 * damping) }
}

#[test]
fn a_kick_is_a_share_of_the_impulse_that_the_force_gives() {
    within("10 N for 10 ms", force(0.2, &[(0.0, 10.0), (0.01, 0.0)]).scale(), 0.1, 1e-15);
    within("the same in two parts", force(0.2, &[(0.0, 10.0), (0.004, 10.0), (0.01, 0.0)]).scale(), 0.1, 1e-15);
    within("at the end of the cycle", force(0.2, &[(0.0, 0.0), (0.19, -10.0)]).scale(), 0.1, 1e-15);
}

#[test]
fn a_time_history_has_each_instant_once_and_shows_a_jump_of_the_force_from_its_right() {
    let system = oscillator(0.5, force(0.2, &[(0.0, 10.0), (0.05, 0.0), (0.1, -10.0), (0.15, 0.0)]));
    let request = TraceRequest { from_cycle: 1, to_cycle: 3, samples: 8 };
    let history = event_driven(&system, &Options { trace: Some(request), ..cycles(3) }).expect("it runs").trace;
    assert_eq!(history.len(), 16);
    for (i, at) in history.iter().enumerate() {
        close("instant", at.time, 0.2 + 0.025 * i as f64, 1e-15);
        let level = [10.0, 10.0, 0.0, 0.0, -10.0, -10.0, 0.0, 0.0][i % 8];
        let free = -1000.0 * at.displacement - 0.5 * at.velocity;
        within("acceleration", at.acceleration, level + free, 1e-9);
    }
}

#[test]
fn a_short_stretch_of_the_force_loosens_the_bound_of_residuals_wherever_it_lies() {
    let bound = |levels: &[(f64, f64)]| {
        let options = Options { audit: true, ..cycles(3) };
        event_driven(&oscillator(0.5, force(0.2, levels)), &options).expect("it runs").proof.residual_bound
    };
    close("last or first", bound(&[(0.0, 10.0), (0.19, 0.0)]), bound(&[(0.0, 10.0), (0.01, 0.0)]), 1e-9);
}

#[test]
fn the_fundamental_matrix_of_many_cycles_is_that_of_all_of_them() {
    // Its determinant is exp(−c t/m).
    let system = oscillator(1e-3, blows(0.2, 0.1));
    let many = fundamental_matrix(&system, &Options { skip: 0, average: 6000, ..Options::default() }).expect("it runs");
    let determinant = many.matrix[0][0] * many.matrix[1][1] - many.matrix[0][1] * many.matrix[1][0];
    close("determinant", determinant, (-1e-3_f64 * 6000.0 * 0.2).exp(), 1e-9);
}

#[test]
fn what_has_no_cycle_or_nothing_to_measure_is_refused_with_the_reason() {
    let system = oscillator(0.5, blows(0.2, 0.1));
    let none = Options { skip: 0, average: 0, ..Options::default() };
    assert_eq!(Orbit::near(&system, &StartState::StaticEquilibrium, 0), Err(OrbitError::NoCycle));
    assert_eq!(Orbit::beside(&system, &none, 1), Err(OrbitError::NoCycle));
    let request = TraceRequest { from_cycle: 0, to_cycle: 1, samples: 4 };
    let unseen = HybridSystem { observed_rows: Vec::new(), ..system };
    let traced = Options { trace: Some(request), ..cycles(1) };
    assert_eq!(event_driven(&unseen, &traced).err(), Some(EngineError::NothingObserved));
}
