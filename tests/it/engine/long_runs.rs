//! Runs so long that what rounding does in each cycle would show.

use shotdamp::dynamics::{Event, Options, Response, event_driven};
use shotdamp::scene::{Excitation, Scene};

use super::bench::{GRAVITY, base, close, damper, in_flight, nothing, resilient, rigid, scene, system, within};

#[test]
pub(super) fn what_nothing_takes_stays_for_a_hundred_thousand_cycles() {
    let (mass, stiffness, light) = (1.0, 1000.0, 0.1);
    for (name, surface, spring) in [("rigid, ε = 1", rigid(1.0), 0.0), ("springs", resilient(5e4, 0.0), 5e4)] {
        let gap = 0.05;
        let swing: Scene =
            scene(base(mass, stiffness, 0.0), GRAVITY, damper(light, gap, surface), nothing(0.198_691_765_315_922));
        let start = in_flight([0.02, 0.7], [0.03, -0.4]);
        let energy = |[x, v, y, w]: [f64; 4]| {
            let u = y - x;
            let pressed = if u < 0.0 {
                u
            } else if u > gap {
                u - gap
            } else {
                0.0
            };
            0.5 * (mass * v * v + stiffness * x * x + light * w * w + spring * pressed * pressed) + light * GRAVITY * y
        };
        let begin = energy([0.02, 0.7, 0.05, 0.3]);
        let options = Options { skip: 0, average: 100_000, start, displacement: false, ..Options::default() };
        let end: Response = event_driven(&system(&swing), &options).expect("it runs");
        let [y, w] = end.final_particles[0];
        assert!(end.proof.events > 100_000, "{} events", end.proof.events);
        // Some 5·10⁵ events and cycles round the state. Rounded to the same side each time it would be off by 10⁻¹⁰, by chance alone
        // by 10⁻¹³.
        close(&format!("{name}, energy"), energy([end.final_displacement, end.final_velocity, y, w]), begin, 1e-12);
    }
}

#[test]
pub(super) fn after_a_million_cycles_an_impulse_falls_where_the_thousandth_fell() {
    let (impulse, period) = (2.171_536_069_237_626, 0.199);
    let beaten = scene(
        base(1.0, 1000.0, 0.1 * 1000.0_f64.sqrt()),
        GRAVITY,
        damper(0.05, 0.4905, resilient(1000.0, 4.242_640_687_119_285)),
        Excitation::ImpulseTrain { impulse, period },
    );
    let at = |skip: u32| {
        let options = Options {
            skip,
            average: 8,
            displacement: false,
            trace: Some(shotdamp::dynamics::TraceRequest {
                from_cycle: u64::from(skip),
                to_cycle: u64::from(skip) + 8,
                samples: 1,
            }),
            ..Options::default()
        };
        event_driven(&system(&beaten), &options).expect("it runs")
    };
    let (early, late) = (at(1_000), at(1_000_000));
    let phases = |response: &Response, from: u64| -> Vec<(u64, f64)> {
        response
            .events
            .iter()
            .filter(|event| event.cycle >= from)
            .map(|event: &Event| (event.cycle - from, event.time))
            .collect()
    };
    let (early_phases, late_phases) = (phases(&early, 1_000), phases(&late, 1_000_000));
    assert_eq!(early_phases.len(), late_phases.len());
    assert!(early_phases.len() > 10, "{early_phases:?}");
    for ((cycle, early), (again, late)) in early_phases.iter().zip(&late_phases) {
        assert_eq!(cycle, again);
        within("time within its cycle over T", late / period, early / period, 1e-9);
    }
    close("velocity at the end", late.final_velocity, early.final_velocity, 1e-9);
}

#[test]
pub(super) fn a_chaotic_mean_is_known_to_its_standard_error() {
    // Two ensembles with other kicks: their means differ by as much as their standard errors let them.
    let beaten = scene(
        base(1.0, 1000.0, 0.1 * 1000.0_f64.sqrt()),
        GRAVITY,
        damper(0.05, 0.4905, resilient(1000.0, std::f64::consts::SQRT_2)),
        Excitation::ImpulseTrain { impulse: GRAVITY / 1000.0_f64.sqrt(), period: 0.199 },
    );
    let beaten = system(&beaten);
    let ensemble = |first: i32| -> [f64; 2] {
        let rms = |member: i32| {
            let kick = 1e-6 * f64::from(2 * (first + member) + 1) / 64.0;
            let options = Options { kick, ..Options::default() };
            event_driven(&beaten, &options).expect("it runs").window().rms_velocity()
        };
        let members: Vec<f64> = (0..32).map(rms).collect();
        let mean = members.iter().sum::<f64>() / 32.0;
        let square = members.iter().map(|rms| (rms - mean) * (rms - mean)).sum::<f64>() / 31.0;
        [mean, (square / 32.0).sqrt()]
    };
    let [[below, one], [above, other]] = [ensemble(-32), ensemble(0)];
    assert!(one / below > 1e-5, "the scene is chaotic");
    within("means of two ensembles", below, above, 3.5 * one.hypot(other));
}
