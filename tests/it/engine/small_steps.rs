//! The fixed step against exact events, over drawn scenes of any kind: what small steps tend to is what the events say.

use shotdamp::dynamics::{Allowance, EngineError, HybridSystem, Limit, Options, fixed_step};
use shotdamp::scene::compile;

use super::arrays::cycles;
use super::bench::note;
use super::drawn_scenes::any_drawn_scene;
use super::random_scenes::{go_on, scenes};

/// RMS velocity by so many steps a cycle.
fn stepped(system: &HybridSystem, options: &Options, steps: f64) -> Result<f64, EngineError> {
    let limit = Limit { events: 1_000_000, ..Limit::default() };
    let run = || fixed_step(system, options, system.drive.period / steps);
    Ok(Allowance::new(limit).simulate(run)?.window().rms_velocity())
}

#[test]
fn small_steps_tend_to_what_exact_events_say_in_drawn_scenes() {
    // Behind the first ones: several particles that strike rigid faces at once, or one that strikes beside those that lie there; no gap
    // between rigid faces; stops that weight alone presses floors to, and stops that hold nothing; half cycles that begin too weak to
    // leave the curve's lower end; faces on walls, at which a particle is at both.
    let known = [427, 889, 987, 1208, 1737, 1857, 1887, 1997, 2154, 2160, 1598, 6219];
    let (mut compared, mut found) = (0, Vec::new());
    for seed in (0..scenes(150)).chain(known) {
        let scene = any_drawn_scene(seed);
        let system = compile(&scene).unwrap_or_else(|error| panic!("seed {seed}: {error}"));
        let options = Options { start: scene.start_state(), record_events: 0, audit: false, ..cycles(2) };
        let Ok(own) = go_on(&system, &options) else { continue };
        let coarse = (system.drive.period * own.highest_frequency / 0.01).ceil().max(400.0);
        // Where there is very much to follow, steps that small do not follow it.
        if own.proof.events == 0 || own.proof.events > 40 || coarse > 1e5 {
            continue;
        }
        let exact = own.window().rms_velocity();
        let error = |rms: f64| (rms / exact - 1.0).abs();
        // One bounce a step, for ever, ends at the limit.
        let by_steps = [1.0, 3.0, 9.0].map(|finer| stepped(&system, &options, coarse * finer));
        let [Ok(first), Ok(second), Ok(mut fine)] = by_steps else { continue };
        let scatter = (error(first) - error(second)).abs().max(((second - fine) / exact).abs());
        // What differs as little as steps differ may end elsewhere: then neither says anything.
        let kicked = [1e-4, -1e-4].map(|kick| go_on(&system, &Options { kick, ..options.clone() }));
        let moved = kicked.iter().flatten().fold(0.0_f64, |most, run| most.max(error(run.window().rms_velocity())));
        compared += 1;
        let bound = 1e-3 + scatter + 3.0 * moved;
        if error(fine) > bound
            && let Ok(finer) = stepped(&system, &options, 81.0 * coarse)
        {
            fine = finer;
        }
        note(&format!("steps, seed {seed}"), error(fine), bound);
        if error(fine) > bound {
            found.push(format!("seed {seed}: {:e} of {bound:e}, {} events", error(fine), own.proof.events));
        }
    }
    assert!(compared > 50, "{compared}");
    assert!(found.is_empty(), "of {compared}: {found:#?}");
}
