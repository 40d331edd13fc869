//! Runs so long that what rounding does in each cycle would show.

use shotdamp::dynamics::{
    Contact, Event, HybridSystem, Law, Matrix, Options, Placed, Response, StartState, dot, event_driven,
};
use shotdamp::scene::{Excitation, Scene, Surface};

use super::bench::{
    GRAVITY, base, close, damper, nothing, resilient, resilient_without_tension, rigid, scene, system, within,
};

/// ½ q′·M q′ + ½ q·K q, with kinetic energy, weight and spring of each particle.
fn energy(system: &HybridSystem, state: &StartState) -> f64 {
    let StartState::Given { q, rate, particles } = state else { panic!("a state") };
    let structure = 0.5 * (system.mass.form(rate, rate) + system.stiffness.form(q, q));
    system.particles.iter().zip(particles).fold(structure, |sum, (particle, &Placed { contact, gap, rate: speed })| {
        let face = if contact == Contact::Ceiling { particle.ceiling.as_ref() } else { None };
        let (face, height) = face.map_or((&particle.floor, 0.0), |ceiling| (ceiling, particle.gap));
        let (y, w) = (dot(&face.row, q) + height + gap, dot(&face.row, rate) + speed);
        let spring = match face.law {
            Law::Resilient { stiffness, .. } if contact != Contact::Flight => stiffness * gap * gap,
            _ => 0.0,
        };
        sum + 0.5 * (particle.mass * w * w + spring) + particle.mass * system.gravity * y
    })
}

/// A swing without loss: a mass of 1 kg on a spring of 1000 N/m, with dampers (mass, gap, surface).
fn swing(gravity: f64, dampers: &[(f64, f64, Surface)]) -> (HybridSystem, StartState) {
    let all = dampers.iter().map(|(mass, gap, surface)| damper(*mass, *gap, surface.clone())).collect();
    let swing = Scene::on_one_mass(base(1.0, 1000.0, 0.0), gravity, all, nothing(0.198_691_765_315_922));
    let particles = dampers.iter().map(|(_, gap, _)| Placed::new(Contact::Flight, 0.6 * gap, -0.4)).collect();
    (system(&swing), StartState::Given { q: vec![0.02], rate: vec![0.7], particles })
}

/// The same on a structure of more modes, of 1 kg each.
fn on_modes(
    stiffness: &[f64],
    row: &[f64],
    (mut system, start): (HybridSystem, StartState),
) -> (HybridSystem, StartState) {
    let modes = stiffness.len();
    system.mass = Matrix::diagonal(&vec![1.0; modes]);
    system.damping = Matrix::diagonal(&vec![0.0; modes]);
    system.stiffness = Matrix::diagonal(stiffness);
    for particle in &mut system.particles {
        particle.floor.row = row.to_vec();
        particle.ceiling.iter_mut().for_each(|ceiling| ceiling.row = row.to_vec());
    }
    system.force_row = row.to_vec();
    system.observed_rows = vec![row.to_vec()];
    system.momentum_rows = vec![row.to_vec()];
    let StartState::Given { mut q, mut rate, particles } = start else { panic!("a state") };
    q.resize(modes, 0.0);
    rate.resize(modes, 0.1);
    (system, StartState::Given { q, rate, particles })
}

fn keeps_its_energy(name: &str, (system, start): &(HybridSystem, StartState), cycles: u32, bound: f64) {
    let options = Options {
        skip: 0,
        average: cycles,
        start: start.clone(),
        displacement: false,
        final_state: true,
        ..Options::default()
    };
    let end: Response = event_driven(system, &options).expect("it runs");
    assert!(end.proof.events > u64::from(cycles), "{name}: {} events", end.proof.events);
    let after = energy(system, &end.final_state.expect("it was asked for"));
    close(&format!("{name}, energy after {cycles} cycles"), after, energy(system, start), bound);
}

#[test]
pub(super) fn what_nothing_takes_stays_for_a_hundred_thousand_cycles() {
    // Some 5·10⁵ events and cycles round the state. Rounded to the same side each time it would be off by 10⁻¹⁰, by chance alone
    // by 10⁻¹³.
    let springs = |stiffness: f64| resilient(stiffness, 0.0);
    for (name, light, surface) in [
        ("rigid, ε = 1", 0.1, rigid(1.0)),
        ("springs of 5e4 N/m", 0.1, springs(5e4)),
        ("springs of 3000 N/m", 0.03, springs(3000.0)),
    ] {
        keeps_its_energy(name, &swing(GRAVITY, &[(light, 0.05, surface)]), 100_000, 1e-12);
    }
}

#[test]
pub(super) fn what_nothing_takes_does_not_drift() {
    // What is off by more than 10⁻¹³ after 10⁴ cycles to the same side would be off by 10⁻¹² after 10⁵.
    let springs = |stiffness: f64| resilient(stiffness, 0.0);
    let one = |gravity: f64, mass: f64, gap: f64, surface: Surface| swing(gravity, &[(mass, gap, surface)]);
    let unable_to_pull = resilient_without_tension(1000.0, 0.0);
    for (name, swing) in [
        ("springs of 100 N/m", one(GRAVITY, 0.1, 0.05, springs(100.0))),
        ("springs of 1e4 N/m", one(GRAVITY, 0.1, 0.05, springs(1e4))),
        ("springs of 1e6 N/m", one(GRAVITY, 0.1, 0.05, springs(1e6))),
        ("springs without gravity", one(0.0, 0.1, 0.05, springs(3000.0))),
        ("springs that cannot pull", one(GRAVITY, 0.3, 0.05, unable_to_pull)),
        ("springs, a heavy particle", one(GRAVITY, 1.0, 0.05, springs(3000.0))),
        ("springs across a small gap", one(GRAVITY, 0.1, 0.005, springs(3000.0))),
        ("rigid, a heavy particle", one(GRAVITY, 1.0, 0.05, rigid(1.0))),
        ("rigid without gravity", one(0.0, 0.1, 0.05, rigid(1.0))),
        ("two dampers", swing(GRAVITY, &[(0.1, 0.05, springs(3000.0)), (0.05, 0.04, springs(3000.0))])),
        ("two modes", on_modes(&[1e3, 4e4], &[1.3, -0.7], one(GRAVITY, 0.1, 0.05, springs(3000.0)))),
        ("two modes, rigid", on_modes(&[1e3, 4e4], &[1.3, -0.7], one(GRAVITY, 0.1, 0.05, rigid(1.0)))),
        ("a floating mode", on_modes(&[0.0, 3e3], &[1.0, 1.4], one(0.0, 0.1, 0.05, springs(3000.0)))),
    ] {
        keeps_its_energy(name, &swing, 10_000, 1e-13);
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
