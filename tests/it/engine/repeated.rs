//! Runs that are kept for whoever asks for the same again.

use std::time::Duration;

use shotdamp::dynamics::{Allowance, EngineError, Limit, Options, Response, event_driven, keeping_runs};
use shotdamp::scene::Excitation;

use super::bench::{GRAVITY, base, damper, resilient, scene, system};

#[test]
fn a_run_that_is_kept_is_as_if_it_were_made_again() {
    let excitation = Excitation::ImpulseTrain { impulse: 0.5, period: 0.2 };
    let one = system(&scene(base(1.0, 1000.0, 3.0), GRAVITY, damper(0.05, 0.03, resilient(1000.0, 1.0)), excitation));
    let mut other = one.clone();
    other.particles[0].gap = 0.02;
    let plain = Options { skip: 2, average: 8, ..Options::default() };
    let kicked = Options { kick: 1e-6, ..plain.clone() };
    let audited = Options { audit: true, ..plain.clone() };
    let settling = Options { settling: true, ..plain.clone() };
    let asked = [
        (&one, &plain),
        (&one, &kicked),
        (&other, &audited),
        (&one, &plain),
        (&one, &audited),
        (&other, &plain),
        (&one, &settling),
        (&other, &settling),
    ];
    // In words: what was not asked for is no number, and equals nothing.
    let describe = |outcome: Result<Response, EngineError>| match outcome {
        Ok(response) => format!("{response:?}"),
        Err(error) => error.to_string(),
    };
    let all = |events| -> Vec<String> {
        let allowance = Allowance::new(Limit { events, time: Duration::from_secs(600) });
        allowance.simulate(|| asked.iter().map(|(system, options)| describe(event_driven(system, options))).collect())
    };
    let enough = all(u64::MAX);
    assert!(enough[0] == enough[3] && enough[0] != enough[1] && enough[0] != enough[2] && enough[0] != enough[4]);
    // The limit falls on the same event of the same run, too.
    let [mut ended, mut complete] = [0, 0];
    for events in (0..600).step_by(7).chain([u64::MAX]) {
        let kept = keeping_runs(|| all(events));
        assert_eq!(all(events), kept, "{events} events");
        *if kept == enough { &mut complete } else { &mut ended } += 1;
    }
    assert!(ended > 10 && complete > 1, "{ended} ended, {complete} complete");
}
