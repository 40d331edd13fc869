//! Averages of motion that hardly moves: impulses that follow each other so closely that the displacement is all mean.
//!
//! Between impulses J every T seconds, with ω T small, the velocity is a sawtooth of J/m and the displacement a parabola on
//! top of its mean: RMS J/(m √12) and deviation J T/(m √720), to O(ω T). And averages and ranges of any motion, which its time history
//! shows too.

use shotdamp::dynamics::{HybridSystem, Options, Sample, Tick, TraceRequest, event_driven, steady_state};
use shotdamp::scene::compile;

use super::arrays::{blows, chain, cycles};
use super::bench::{close, note, within};
use super::drawn_scenes::any_drawn_scene;
use super::random_scenes::{go_on, scenes};

/// 1 kg on 1000 N/m.
fn oscillator(damping_ratio: f64) -> HybridSystem {
    chain(&[1.0], 500.0, damping_ratio * 1000.0_f64.sqrt())
}

#[test]
pub(super) fn impulses_without_pause_leave_a_sawtooth_and_a_parabola() {
    for period in [1e-5, 1e-4, 1e-3] {
        let mut system = oscillator(0.05);
        let impulse = 1e-4;
        system.drive = blows(period, impulse);
        let [rms, deviation] = [impulse / 12.0_f64.sqrt(), impulse * period / 720.0_f64.sqrt()];
        // Of the next order: (ω T)² and ζ ω T.
        let order = 1000.0 * period * period + 0.05 * 1000.0_f64.sqrt() * period;
        let steady = steady_state(&system).expect("it is linear").expect("it settles").observed[0].cycle;
        close(&format!("T = {period}, RMS"), steady.rms_velocity(), rms, 1e-10 + order);
        close(&format!("T = {period}, deviation"), steady.std_displacement(), deviation, 1e-6 + order);
        close(&format!("T = {period}, mean"), steady.mean_displacement(), impulse / period / 1000.0, 1e-12);
        // From cycle to cycle the same, as far as a place is known in doubles.
        let skip = (25.0 / period) as u32;
        let run =
            event_driven(&system, &Options { skip, average: 40, ..Options::default() }).expect("it runs").window();
        close(&format!("T = {period}, RMS of a run"), run.rms_velocity(), steady.rms_velocity(), 1e-8);
        close(&format!("T = {period}, deviation of a run"), run.std_displacement(), steady.std_displacement(), 1e-4);
    }
    // The march sums up the same.
    let mut system = oscillator(0.05);
    system.drive = blows(1e-4, 1e-4);
    let trace = Some(TraceRequest { from_cycle: 0, to_cycle: 1, samples: 1 });
    let options = Options { skip: 1000, average: 1000, ..Options::default() };
    let solved = event_driven(&system, &options).expect("it runs").window();
    let marched = event_driven(&system, &Options { trace, ..options }).expect("it runs").window();
    close("RMS", marched.rms_velocity(), solved.rms_velocity(), 1e-11);
    close("deviation", marched.std_displacement(), solved.std_displacement(), 1e-11);
}

#[test]
pub(super) fn the_audit_of_a_pulse_from_rest_closes_whatever_the_damping() {
    for damping_ratio in [0.05, 0.5, 1.0, 2.0, 5.0] {
        for duration in [0.01, 0.05, 0.1, 0.15] {
            let mut system = oscillator(damping_ratio);
            let tick = |time: f64, level: f64| Tick { time, impulse: 0.0, level };
            system.drive = blows(0.199, 0.0);
            system.drive.ticks = vec![tick(0.0, 1.0 / duration), tick(duration, 0.0)];
            let options = Options { skip: 0, average: 20, audit: true, ..Options::default() };
            let proof = event_driven(&system, &options).expect("it runs").proof;
            let what = format!("ζ = {damping_ratio}, {duration} s");
            within(&format!("{what}, energy residual"), proof.energy_residual, 0.0, 1e-13);
            within(&format!("{what}, momentum residual"), proof.momentum_residual, 0.0, 1e-13);
        }
    }
}

#[test]
pub(super) fn what_is_measured_of_a_drawn_scene_is_what_its_time_history_shows() {
    // Behind the first ones: contact states that last a moment, whose own mean is all rounding; motion from rest, whose first crest
    // has no slope before it.
    let known = [1656, 1153, 2961];
    let mut found = Vec::new();
    for seed in (0..scenes(60)).chain(known) {
        let scene = any_drawn_scene(seed);
        let system = compile(&scene).unwrap_or_else(|error| panic!("seed {seed}: {error}"));
        let trace = Some(TraceRequest { from_cycle: 0, to_cycle: 4, samples: 2003 });
        let options = Options { start: scene.start_state(), record_events: 0, extremes: true, trace, ..cycles(4) };
        let Ok(response) = go_on(&system, &options) else { continue };
        let (sums, extremes) = (response.window(), response.observed[0].extremes);
        let mean =
            |of: &dyn Fn(&Sample) -> f64| response.trace.iter().map(of).sum::<f64>() / response.trace.len() as f64;
        let place = mean(&|at| at.displacement);
        let deviation = mean(&|at| (at.displacement - place).powi(2)).sqrt();
        let speed = mean(&|at| at.velocity * at.velocity).sqrt();
        // Samples see of the shortest motions what they see; of what is wrong much.
        let shares = [sums.std_displacement() / deviation, sums.rms_velocity() / speed];
        let off = (sums.mean_displacement() - place).abs() / deviation;
        if speed > 0.0 && (off > 0.1 || shares.iter().any(|share| !(0.6..1.6).contains(share))) {
            found.push(format!("seed {seed}: {shares:?} of the deviation and of the speed, {off} off"));
        }
        let ranges = [extremes.displacement, extremes.velocity];
        for (order, of) in [|at: &Sample| at.displacement, |at: &Sample| at.velocity].into_iter().enumerate() {
            let [low, high] = ranges[order];
            let size = low.abs().max(high.abs());
            let beyond = response.trace.iter().fold(0.0_f64, |most, at| most.max(low - of(at)).max(of(at) - high));
            note("beyond the largest or smallest value", beyond, 1e-9 * size);
            if beyond > 1e-9 * size {
                found.push(format!("seed {seed}, derivative {order}: {beyond:e} beyond {low} to {high}"));
            }
        }
    }
    assert!(found.is_empty(), "{found:#?}");
}
