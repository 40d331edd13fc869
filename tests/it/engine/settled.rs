//! Runs that end where they have settled: their averages against closed forms and long runs, and what becomes of those that
//! do not settle.

use shotdamp::dynamics::{Options, Response, StartState, Until, event_driven};
use shotdamp::measure::{Evaluated, Measure, NamedRows, Request, Rigour, Settings, SolverChoice, Subject, evaluate};
use shotdamp::scene::{ContactDamping, ContactEnd, Damper, Excitation, Scene, Surface, compile};

use super::bench::{GRAVITY, base, close, in_flight, run, within};
use super::closed_forms::{expected, masri_and_caughey};

fn settle(scene: &Scene, start: StartState, most: u32) -> Response {
    run(scene, &Options { skip: 0, average: most, start, until: Until::Settled, audit: true, ..Options::default() })
}

/// One mass with a resilient damper under impulses, the study's kind.
fn under_impulses(force_ratio: f64) -> Scene {
    let natural = 1000.0_f64.sqrt();
    let surface = Surface::Resilient {
        stiffness: 1000.0,
        damping: ContactDamping::Constant(0.3 * 50.0_f64.sqrt()),
        ends: ContactEnd::ZeroGap,
    };
    let train = Excitation::ImpulseTrain { impulse: force_ratio * 2.1 * GRAVITY / natural, period: 0.199 };
    Scene::on_one_mass(base(1.0, 1000.0, 0.1 * natural), GRAVITY, vec![Damper::between(surface, 0.05, 0.4905)], train)
}

#[test]
fn a_settled_run_has_the_averages_of_the_closed_form() {
    for (id, velocity) in [
        ("masri-caughey-two-impacts-a", 1.030_216_589_546_725_5),
        ("masri-caughey-two-impacts-b", 0.246_499_927_843_622_73),
    ] {
        let value = expected(id);
        let steady = masri_and_caughey(id, velocity);
        let [y, w] = steady.response.final_particles[0];
        let (x, v) = (steady.response.final_displacement + 1e-4, steady.response.final_velocity);
        let response = settle(&steady.scene, in_flight([x, v], [y - x, w - v]), 2000);
        let settled = response.settled.expect("it attracts");
        println!("{id}: settled in cycle {}", settled.first);
        assert!(settled.cycles == 1 && (20..2000).contains(&settled.first), "{settled:?}");
        let rms = response.window().rms_velocity();
        close(&format!("{id}, RMS velocity"), rms, value[4], 1e-11);
        assert_eq!([response.counts.floor_contacts, response.counts.ceiling_contacts], [1, 1]);
        assert!(response.proof.energy_residual < 1e-11 && response.proof.momentum_residual < 1e-11);

        let mut bare = steady.scene.clone();
        bare.dampers.clear();
        let alone = settle(&bare, StartState::StaticEquilibrium, 2000);
        assert!(alone.settled.is_some());
        close(&format!("{id}, velocity ratio"), alone.window().rms_velocity() / rms, value[5], 1e-11);
    }
}

#[test]
fn a_settled_run_has_the_averages_of_a_long_one() {
    let mut periods = Vec::new();
    for force_ratio in [0.05, 0.15, 0.188, 0.266, 3.162, 3.5, 10.0, 25.0, 80.0] {
        let scene = under_impulses(force_ratio);
        let response = settle(&scene, StartState::StaticEquilibrium, 1000);
        let Some(settled) = response.settled else { continue };
        let long = run(&scene, &Options { skip: 2000, average: 32, ..Options::default() });
        let [ours, theirs] = [&response, &long].map(Response::window);
        close(&format!("f′ = {force_ratio}: RMS velocity"), ours.rms_velocity(), theirs.rms_velocity(), 1e-11);
        let reach = theirs.std_displacement();
        within("mean displacement", ours.mean_displacement(), theirs.mean_displacement(), 1e-11 * reach);
        assert_eq!(response.counts.floor_contacts * (32 / settled.cycles), long.counts.floor_contacts);
        periods.push(settled.cycles);
    }
    println!("{periods:?}");
    assert!(periods.len() >= 6 && periods.contains(&1) && periods.contains(&2));
}

fn measured(scene: &Scene, until: Until, average: u32) -> Evaluated {
    let bare = Scene { dampers: Vec::new(), ..scene.clone() };
    let subject = Subject { scene: scene.clone(), undamped: Some(bare), comparison: None, mode: 1 };
    let settings = Settings {
        skip: 25,
        average,
        until,
        round_period_to: None,
        ensemble: 8,
        named: NamedRows::Results,
        mean_of: 0,
    };
    let measures = [
        Measure::VelocityRatio,
        Measure::FloorImpacts,
        Measure::Settled,
        Measure::AveragedCycles,
        Measure::Motion,
        Measure::SettledVelocityRatio,
    ];
    let request = Request { measures: &measures, rigour: Rigour::Result, ..Request::default() };
    evaluate(subject, SolverChoice::EventDriven, &settings, &request).expect("it runs")
}

#[test]
fn what_does_not_settle_is_averaged_as_if_it_had_not_been_asked_and_says_so() {
    let value = |evaluated: &Evaluated, i: usize| evaluated.measured[i].value;
    // Chaotic; and periodic, but not settled within so few cycles.
    for (force_ratio, average, chaotic) in [(0.5, 100, true), (3.5, 20, false)] {
        let scene = under_impulses(force_ratio);
        let [plain, tried] = [Until::Cycles, Until::Settled].map(|until| measured(&scene, until, average));
        assert_eq!(plain.chaotic, chaotic, "f′ = {force_ratio}");
        assert_eq!(tried.measured[..3], plain.measured[..3]);
        assert_eq!([value(&tried, 2), value(&tried, 3)], [0.0, f64::from(average)]);
        assert_eq!(tried.motion, plain.motion);
    }
    let settled = measured(&under_impulses(3.5), Until::Settled, 1000);
    assert_eq!([value(&settled, 2), value(&settled, 3)], [1.0, 1.0]);
    assert!(settled.motion.expect("it was asked for").repeats() && !settled.chaotic);
}

/// The study's cycles against what they tend to: 25 + 20 are not enough here, 2000 + 2 are.
#[test]
fn the_settled_velocity_ratio_is_the_one_that_longer_and_longer_runs_tend_to() {
    let ratio = |evaluated: &Evaluated, i: usize| evaluated.measured[i].value;
    let scene = under_impulses(3.5);
    let short = measured(&scene, Until::Cycles, 20);
    let settled = ratio(&short, 5);
    let bare = Scene { dampers: Vec::new(), ..scene.clone() };
    let late = Options { skip: 2000, average: 2, ..Options::default() };
    let long = [&bare, &scene].map(|scene| run(scene, &late).window().rms_velocity());
    close("velocity ratio", settled, long[0] / long[1], 1e-11);
    assert!((ratio(&short, 0) / settled - 1.0).abs() > 1e-9, "{} is settled already", ratio(&short, 0));
    // Of what is settled, and of what never settles.
    let at_rest = measured(&scene, Until::Settled, 1000);
    close("of a settled run", ratio(&at_rest, 5), ratio(&at_rest, 0), 1e-11);
    assert!(ratio(&measured(&under_impulses(0.5), Until::Cycles, 100), 5).is_nan());
}

/// A kicked start need not be run to its end where one orbit draws both in: the whole run would say the same.
#[test]
fn a_start_that_stays_beside_a_run_ends_where_that_does() {
    let (mut spared, mut others) = (0, 0);
    for i in 0..120 {
        let system = compile(&under_impulses(0.05 * 1.08_f64.powi(i))).expect("it compiles");
        let plain = Options { settling: true, final_state: true, ..Options::default() };
        let start = |kick: f64, beside| {
            let options = Options { kick, beside, ..plain.clone() };
            event_driven(&system, &options).expect("it runs")
        };
        let run = start(0.0, None);
        let short = start(1e-9, run.settling.clone());
        if !short.stays_beside {
            others += 1;
            continue;
        }
        spared += 1;
        let whole = start(1e-9, None);
        let [one, other] = [&run, &whole].map(|run| run.window().rms_velocity());
        close(&format!("{i}: RMS velocity of a neighbour"), one, other, 1e-9);
        assert_eq!(run.counts, whole.counts);
        assert!(4 * short.proof.events < 3 * whole.proof.events + 400, "it ends early");
        // A start that is not beside it there is run to its end.
        let far = start(1e-3, run.settling.clone());
        assert!(!far.stays_beside && far.final_state == start(1e-3, None).final_state);
    }
    println!("{spared} stay beside, of {others} it cannot be told");
    assert!(spared >= 30 && others >= 20, "{spared} and {others}");
}
