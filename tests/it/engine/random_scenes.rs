//! Random scenes over structures, faces, stops and drives: each has an answer, whose balances close. `SHOTDAMP_SCENES=10000`
//! tries as many.

use shotdamp::dynamics::{Drive, Harmonic, HybridSystem, Tick, event_driven};

use super::arrays::{Dice, any_scene, cycles};
use super::bench::note;

/// A scene of any kind under impulses, pulses, a harmonic force, or with a dashpot that ties all modes together.
fn any_driven_scene(seed: u64) -> HybridSystem {
    let mut system = any_scene(seed);
    let mut dice = Dice(seed ^ 0x55aa);
    dice.between(0.0, 1.0);
    let period = system.drive.period;
    match dice.between(0.0, 3.99) as u32 {
        0 => {}
        1 => {
            let (force, angular_frequency) = (dice.ratio(0.1, 30.0), dice.ratio(3.0, 200.0));
            let harmonic = Some(Harmonic { force, angular_frequency });
            let period = std::f64::consts::TAU / angular_frequency;
            system.drive = Drive { period, ticks: Vec::new(), harmonic, ..system.drive };
        }
        2 => {
            let tick = |time: f64, level: f64| Tick { time, impulse: 0.0, level };
            system.drive.ticks = vec![tick(0.0, dice.ratio(0.1, 50.0)), tick(period * dice.between(0.1, 0.9), 0.0)];
        }
        _ => {
            let n = system.mass.order;
            let place = dice.between(0.0, n as f64 - 1e-9) as usize;
            system.damping.entries[place * n + place] += dice.ratio(1.0, 1e4);
        }
    }
    system
}

#[test]
pub(super) fn no_scene_is_refused() {
    let scenes = std::env::var("SHOTDAMP_SCENES").ok().and_then(|count| count.parse().ok()).unwrap_or(100);
    for seed in 0..scenes {
        let response = event_driven(&any_driven_scene(seed), &cycles(4));
        let proof = response.unwrap_or_else(|error| panic!("seed {seed}: {error}")).proof;
        note("energy residual", proof.energy_residual, 1e-9);
        note("momentum residual", proof.momentum_residual, 1e-9);
        assert!(proof.energy_residual < 1e-9 && proof.momentum_residual < 1e-9, "seed {seed}: {proof:?}");
    }
}
