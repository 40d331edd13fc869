//! Single dampers over 125 cycles, against 128-bit arithmetic: Models 1, 2 and 3, harmonic force, impulses, pulses, stop.
//!
//! None of the cases is chaotic, so that a run of some five hundred events repeats the reference to rounding: 1e-13 for
//! the averages. The final state carries the errors of all events before it, multiplied by whatever the orbit's slowest
//! multiplier has left of them; 1e-12 of the largest velocity of the run is asked for, and ten times that where the
//! force is a thousand times the weight.

use shotdamp::dynamics::{EventKind, Options, event_driven};
use shotdamp::scene::{Damper, Excitation, LimitStop, PulseShape, Scene, Surface, Walls};

use super::bench::{Case, balanced, base, cases, close, instant, resilient, rigid, run, system, within};

pub(super) fn scene(case: &Case) -> Scene {
    let surface = |side: &str| -> Surface {
        match case.optional("restitution") {
            Some(restitution) => rigid(restitution),
            None => resilient(
                case.number(&format!("{side}_stiffness_n_per_m")),
                case.number(&format!("{side}_damping_n_s_per_m")),
            ),
        }
    };
    let walls = case.optional("wall_stiffness_n_per_m").map(|stiffness| Walls {
        stiffness,
        damping: case.number("wall_damping_n_s_per_m"),
        ceiling_mass: case.number("ceiling_body_mass_kg"),
    });
    // The data add the ceiling body to the base; a scene takes it off the base.
    let mass = case.number("mass_kg") + walls.map_or(0.0, |walls| walls.ceiling_mass);
    let stop = case
        .optional("limit_stop_m")
        .map(|length| LimitStop { length, restitution: case.number("limit_stop_restitution") });
    Scene::on_one_mass(
        base(mass, case.number("stiffness_n_per_m"), case.number("damping_n_s_per_m")),
        case.number("gravity_m_per_s2"),
        vec![Damper {
            ceiling: surface("ceiling"),
            stop,
            walls,
            ..Damper::between(surface("floor"), case.number("particle_mass_kg"), case.number("gap_m"))
        }],
        excitation(case),
    )
}

fn excitation(case: &Case) -> Excitation {
    if let Some(angular_frequency) = case.optional("angular_frequency_rad_per_s") {
        assert_eq!(case.number("phase_rad"), 0.0);
        return Excitation::Harmonic { force: case.number("force_amplitude_n"), angular_frequency };
    }
    let (impulse, period) = (case.number("impulse_n_s"), case.number("period_s"));
    match case.optional("impulses_per_pulse") {
        None => Excitation::ImpulseTrain { impulse, period },
        Some(impulses) => Excitation::PulseTrain {
            impulse,
            period,
            duration: case.number("duration_s"),
            shape: PulseShape::Binomial { impulses: impulses as u32 },
        },
    }
}

pub(super) fn kind(words: &str) -> EventKind {
    match words {
        "leave floor / pulled off by impulse" | "release from floor (stuck)" => EventKind::FloorRelease,
        "floor contact" => EventKind::FloorContact,
        "ceiling contact" => EventKind::CeilingContact,
        "leave ceiling" | "release from ceiling (stuck)" => EventKind::CeilingRelease,
        "ceiling stop" => EventKind::CeilingStop,
        "floor stop" => EventKind::FloorStop,
        other => panic!("an event of another kind: {other}"),
    }
}

#[test]
pub(super) fn every_reference_case_is_met_to_rounding() {
    let cases = cases(include_str!("../data/reference-cases.json"));
    assert_eq!(cases.len(), 29);
    for case in &cases {
        let name = case.text("name");
        let scene = scene(case);
        let options = Options { record_events: 50, audit: true, ..Options::default() };
        let response = run(&scene, &options);
        let expected = case.part("expect");
        let window = response.window();
        let rms = expected.number("rms_velocity_m_per_s");
        let std = expected.number("std_displacement_m");
        close(&format!("{name}, RMS velocity"), window.rms_velocity(), rms, 1e-13);
        close(&format!("{name}, deviation of the displacement"), window.std_displacement(), std, 1e-13);
        // The mean is what is left of a motion of ±std: it can be as exact as that, not more.
        let mean = expected.number("mean_displacement_m");
        within(
            &format!("{name}, mean displacement"),
            window.mean_displacement(),
            mean,
            1e-15 * std + 1e-13 * mean.abs(),
        );

        let state = expected.numbers("final_state_x_v_y_vy");
        let [place, rate] = response.final_particles[0];
        let gap = case.number("gap_m");
        let loose = if name.ends_with("f1000") { 10.0 } else { 1.0 };
        let got = [response.final_displacement, response.final_velocity, place, rate];
        for ((what, got), (want, scale)) in
            ["x", "v", "y", "v of the particle"].iter().zip(got).zip(state.iter().zip([std, rms, std + gap, rms]))
        {
            within(&format!("{name}, final {what}"), got, *want, 1e-12 * loose * scale.max(want.abs()));
        }

        let first = expected.list("first_events");
        assert!(response.events.len() >= first.len(), "{name}: events are missing");
        for (event, want) in response.events.iter().zip(&first) {
            assert_eq!(event.kind, kind(want.text("kind")), "{name} at {} s", want.number("t_s"));
            let instant = instant(&scene, event);
            within(&format!("{name}, {:?}", event.kind), instant, want.number("t_s"), 1e-14 + 2e-13 * instant);
        }
    }
}

#[test]
pub(super) fn without_its_damper_the_base_alone_is_met() {
    for case in &cases(include_str!("../data/reference-cases.json")) {
        // The particle is taken out; in Model 3 the ceiling body stays on its walls.
        let mut system = system(&scene(case));
        system.particles.clear();
        let response = event_driven(&system, &Options { audit: true, ..Options::default() }).expect("it runs");
        balanced(&response);
        let want = case.part("expect").number("rms_velocity_without_damper_m_per_s");
        close(&format!("{}, no damper", case.text("name")), response.window().rms_velocity(), want, 1e-13);
    }
}
