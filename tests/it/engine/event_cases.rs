//! Scenes on which general integrators lose events, double them, or never finish: grazing ceilings, floors a million
//! times stiffer than the structure, gaps of 50 nm, creeping releases, micro hops, a base that runs ahead of the particle,
//! an impulse within a nanosecond of an impact. The sequence must be right to its last event.

use shotdamp::dynamics::{EventKind, Options};
use shotdamp::scene::{Excitation, Scene};

use super::bench::{Case, GRAVITY, base, cases, damper, instant, resilient, run, scene, within};

fn build(case: &Case) -> Scene {
    let number = |key: &str| case.number(key);
    let damping = 2.0 * number("zeta") * (number("ks") * number("m")).sqrt();
    scene(
        base(number("m"), number("ks"), damping),
        GRAVITY,
        damper(number("mp"), number("h"), resilient(number("kf"), number("cf"))),
        Excitation::ImpulseTrain { impulse: number("J"), period: number("T") },
    )
}

fn kind(word: &str) -> EventKind {
    match word {
        "leave1" => EventKind::FloorRelease,
        "land" => EventKind::FloorContact,
        "ceil" => EventKind::CeilingContact,
        "leave2" => EventKind::CeilingRelease,
        other => panic!("an event of another kind: {other}"),
    }
}

#[test]
pub(super) fn no_event_is_lost_or_doubled() {
    let cases = cases(include_str!("../data/event-cases.json"));
    assert_eq!(cases.len(), 25);
    for (i, case) in cases.iter().enumerate() {
        let parameters = case.part("scene");
        let scene = build(&parameters);
        let cycles = parameters.number("cycles") as u32;
        for window_factor in [1.0, 0.5] {
            let options = Options {
                skip: 0,
                average: cycles,
                record_events: usize::MAX,
                audit: true,
                window_factor,
                ..Options::default()
            };
            let response = run(&scene, &options);
            let kicked = run(&scene, &Options { kick: 1e-9, ..options.clone() });
            let want = case.list("first_events");
            assert_eq!(want.len(), case.number("true_events") as usize);
            let got: Vec<_> = response.events.iter().map(|event| event.kind).collect();
            let wanted: Vec<_> = want.iter().map(|event| kind(event.at(1).word())).collect();
            assert_eq!(got, wanted, "case {i}, {}", case.text("family"));
            assert_eq!(response.proof.events, want.len() as u64);
            for ((event, neighbour), want) in response.events.iter().zip(&kicked.events).zip(&want) {
                let what = format!("case {i}, {}, {:?}", case.text("family"), event.kind);
                // As much as an impulse known to twelve digits would move it, and the rounding of the clock.
                let moved = (instant(&scene, neighbour) - instant(&scene, event)).abs();
                within(&what, instant(&scene, event), want.at(0).value(), 1e-3 * moved + 2e-11);
            }
        }
    }
}
