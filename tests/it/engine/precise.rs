//! The solver of many digits, which is a reference for the others, against references that were there before it.

use std::time::Duration;

use shotdamp::accuracy::precise::{PreciseError, precise};
use shotdamp::dynamics::{Harmonic, Law, Matrix, Options, Response, Stop, event_driven};

use super::arrays::{chain, particle, quiet, rigid, unit};
use super::bench::{cases, close, instant, system, within};
use super::reference_cases::{kind, scene};

const PATIENCE: Duration = Duration::from_secs(120);

#[test]
pub(super) fn it_meets_the_reference_cases_to_all_digits_of_a_double() {
    let mut refused = Vec::new();
    let cases = cases(include_str!("../data/reference-cases.json"));
    for case in &cases {
        let name = case.text("name");
        let scene = scene(case);
        let options = Options { record_events: 50, ..Options::default() };
        let begun = std::time::Instant::now();
        let response: Response = match precise(&system(&scene), &options, PATIENCE) {
            Ok(response) => response,
            Err(PreciseError::Unknown(what)) => {
                refused.push((name, what));
                continue;
            }
            Err(error) => panic!("{name}: {error}"),
        };
        println!("{name}: {:?}", begun.elapsed());
        let expected = case.part("expect");
        let window = response.window();
        let rms = expected.number("rms_velocity_m_per_s");
        let std = expected.number("std_displacement_m");
        close(&format!("{name}, RMS velocity"), window.rms_velocity(), rms, 4e-16);
        close(&format!("{name}, deviation of the displacement"), window.std_displacement(), std, 1e-15);
        let state = expected.numbers("final_state_x_v_y_vy");
        let [place, rate] = response.final_particles[0];
        let got = [response.final_displacement, response.final_velocity, place, rate];
        // The clock of a harmonic case is set by a period rounded to a double.
        for (got, (want, scale)) in got.iter().zip(state.iter().zip([std, rms, std + case.number("gap_m"), rms])) {
            within(&format!("{name}, final state"), *got, *want, 2e-14 * scale.max(want.abs()));
        }
        for (event, want) in response.events.iter().zip(&expected.list("first_events")) {
            assert_eq!(event.kind, kind(want.text("kind")), "{name} at {} s", want.number("t_s"));
            let instant = instant(&scene, event);
            within(&format!("{name}, {:?}", event.kind), instant, want.number("t_s"), 1e-15 * instant);
        }
    }
    assert_eq!(refused, [("M1_harm_eps0.3_g10", "rigid faces that give something back")]);
}

#[test]
fn what_it_does_not_model_is_refused() {
    // With and without a stop behind it.
    for stop in [None, Some(Stop { length: 1e-3, restitution: 0.0 })] {
        let law = Law::Resilient { stiffness: 1000.0, damping: 3.0, no_tension: true, stop };
        let mut system = chain(&[1.0], 500.0, 1.0);
        system.particles.push(particle(0.05, 0.1, vec![1.0], [law, law]));
        let refused = precise(&system, &Options::default(), PATIENCE);
        assert_eq!(refused, Err(PreciseError::Unknown("faces that cannot pull")), "{stop:?}");
    }
    let law = Law::Rigid { restitution: 0.0 };
    let mut system = chain(&[1.0], 500.0, 1.0);
    system.particles.push(particle(0.05, 0.0, vec![1.0], [law, law]));
    let refused = precise(&system, &Options::default(), PATIENCE);
    assert_eq!(refused, Err(PreciseError::Unknown("rigid faces without a gap between them")));
}

/// Its gap begins with t², not with t³ as where the push vanishes by itself.
#[test]
pub(super) fn what_a_jump_of_the_force_throws_off_its_floor_leaves_at_once() {
    let mut system = chain(&[1.0], 0.5, 0.0);
    system.gravity = 0.1;
    system.particles = vec![particle(0.1, 100.0, unit(1, 0), [rigid(0.0), rigid(0.0)])];
    system.drive = quiet(std::f64::consts::TAU / 0.9);
    system.drive.ticks = Vec::new();
    system.drive.harmonic = Some(Harmonic { force: 2.0, angular_frequency: 0.9, phase: 4.6 });
    assert_eq!((&system.mass, &system.stiffness), (&Matrix::diagonal(&[1.0]), &Matrix::diagonal(&[1.0])));
    let options = Options { skip: 0, average: 1, ..Options::default() };
    // By a Taylor integration with bisected events, which shares nothing with either.
    let expected = -1.566_931_934_56;
    let exact = precise(&system, &options, Duration::from_secs(60)).unwrap();
    within("many digits", exact.final_displacement, expected, 1e-11);
    within("events", event_driven(&system, &options).unwrap().final_displacement, expected, 1e-11);
}
