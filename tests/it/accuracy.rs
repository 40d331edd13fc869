//! What accuracy costs: errors against a reference of many digits, and what is said of them.

use std::path::Path;
use std::time::Duration;

use shotdamp::accuracy::{
    Ablation, Accuracy, AccuracyView, Contender, Idle, Origin, Outcome, VerdictPrice, ablation, ablation_page,
    accuracy, accuracy_page, accuracy_summary,
};
use shotdamp::experiment::{Assumptions, Experiment, load_assumptions, parse_experiment};
use shotdamp::reference::{Price, Verdict};
use shotdamp::study::Machine;

use crate::desk::{Desk, THREE_GAPS, shotdamp};

fn assumptions() -> Assumptions {
    let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("experiments/assumptions.yaml");
    load_assumptions(&file).expect("the assumptions can be read").assumptions()
}

fn experiment(damper: &str, forces: &str) -> Experiment {
    let text = format!(
        "title: A damper\nsource: {{chapter: 3, section: '3.1'}}\nabout: Price.\nscene:\n  \
         structure: {{single_mass: {{mass: 1 kg, stiffness: 1000 N/m, damping_ratio: 0.05}}}}\n  \
         dampers: [{{mass_ratio: 0.05, gap_ratio: 50, {damper}}}]\n  \
         excitation: {{impulse_train: {{force_ratio: swept, frequency_ratio: 1}}}}\n\
         sweep: {{force_ratio: {forces}}}\nrun: {{skip: 5 cycles, average: 10 cycles, round_period_to: 1 ms}}\n\
         measure: [velocity_ratio, std_displacement, floor_impacts]\n\
         figure: {{x: force_ratio, y: velocity_ratio, caption: Price.}}\n"
    );
    let id = "a-damper".parse().expect("an id");
    parse_experiment(&id, "a-damper.yaml", &text, &assumptions()).unwrap_or_else(|problems| panic!("{problems}"))
}

fn measured(damper: &str, forces: &str) -> Accuracy {
    accuracy(&experiment(damper, forces), &assumptions(), Duration::from_millis(2)).expect("it can be measured")
}

#[test]
fn certified_events_cost_no_digit_and_a_step_costs_most_of_them() {
    let measured = measured("floor: {resilient: {stiffness_ratio: 1, damping_ratio: 0.3}}", "[7, 20]");
    for case in measured.cases.iter().filter(|case| case.floor.is_none()) {
        assert_eq!(case.origin, Origin::ManyDigits);
        for point in &case.points {
            let events = point.events;
            match point.contender {
                Contender::EventDriven { .. } => {
                    assert!(point.error < 1e-12, "{point:?}");
                    assert!(events.right == events.of && events.of > 20, "{point:?}");
                    assert!(events.error.is_some_and(|error| error < 1e-12), "{point:?}");
                }
                Contender::FixedStep { .. } => assert!(point.error > 1e-6, "{point:?}"),
            }
        }
        let finest = case.skipped.last().expect("steps of a microsecond take more than two milliseconds");
        assert!(finest.reason.contains("would take about"), "{}", finest.reason);
    }
}

#[test]
fn beside_a_verdict_stands_what_it_cost_and_what_a_fixed_step_would_have() {
    let entry = |name: &str, tolerance: Option<f64>| VerdictPrice {
        entry: name.into(),
        verdict: Verdict::Reproduced,
        uncertainty: tolerance,
        tolerance,
        price: Price { rows: 2, runs: 2, events: 120 },
        factor: 1,
    };
    let view = AccuracyView {
        id: "a-damper".into(),
        title: "A damper".into(),
        machine: Machine::here(),
        accuracy: measured("floor: {resilient: {stiffness_ratio: 1, damping_ratio: 0.3}}", "[7]"),
        entries: vec![
            entry("rough", Some(0.5)),
            entry("fine", Some(1e-13)),
            entry("claim", None),
            VerdictPrice { price: Price::default(), ..entry("not-run", Some(0.5)) },
        ],
    };
    let page = accuracy_page(&view, "a-damper.png");
    let line = |name: &str| page.lines().find(|line| line.starts_with(&format!("| `{name}`"))).unwrap_or_default();
    assert!(line("rough").contains("2 runs, 120 events") && line("rough").contains("s, fixed step"), "{page}");
    assert!(line("fine").ends_with("| no step tried |"), "{page}");
    assert!(line("claim").contains("a claim") && line("claim").ends_with("|  |"), "{page}");
    assert_eq!(line("not-run"), "", "{page}");
}

#[test]
fn what_nothing_moves_has_no_error() {
    let resting = experiment("floor: {resilient: {stiffness_ratio: 1, damping_ratio: 0.3}}", "[0]");
    let refused = accuracy(&resting, &assumptions(), Duration::from_millis(2)).expect_err("nothing moves");
    assert!(refused.to_string().contains("no case has a damper whose motion takes time"), "{refused}");
}

#[test]
fn a_run_that_diverged_has_no_error_worth_a_number() {
    let mut accuracy = measured("floor: {resilient: {stiffness_ratio: 1, damping_ratio: 0.3}}", "[7]");
    accuracy.cases[0].points[0].error = 5e78;
    let view = AccuracyView {
        id: "a-damper".into(),
        title: "A damper".into(),
        machine: Machine::here(),
        accuracy,
        entries: Vec::new(),
    };
    let page = accuracy_page(&view, "a-damper.png");
    assert!(page.contains("diverged") && !page.contains("e78"), "{page}");
}

#[test]
fn a_motion_that_is_chaotic_only_on_its_way_says_why_its_error_is_large() {
    let view = |accuracy: Accuracy| AccuracyView {
        id: "a-damper".into(),
        title: "A damper".into(),
        machine: Machine::here(),
        accuracy,
        entries: Vec::new(),
    };
    let mut accuracy = measured("floor: {rigid: {restitution: 0}}", "[7]");
    let told = "in another order, and what of the way falls into the averages differs";
    assert!(!accuracy_page(&view(accuracy.clone()), "a.png").contains(told));
    let point = &mut accuracy.cases[0].points[0];
    (point.error, point.events.right) = (1e-4, point.events.of - 3);
    let after = format!("after {} events the event-driven run", point.events.right);
    let page = accuracy_page(&view(accuracy), "a.png");
    assert!(page.contains(told) && page.contains(&after), "{page}");
}

#[test]
fn a_reference_that_is_none_says_so() {
    let view = AccuracyView {
        id: "a-damper".into(),
        title: "A damper".into(),
        machine: Machine::here(),
        accuracy: measured("floor: {rigid: {restitution: 0.5}}", "[7]"),
        entries: Vec::new(),
    };
    let page = accuracy_page(&view, "a-damper.png");
    assert!(page.contains("does not know rigid faces that give something back"), "{page}");
    let summary = accuracy_summary(&[view]);
    assert!(summary.contains("1 experiment without an independent reference"), "{summary}");
}

#[test]
fn each_effect_is_switched_and_what_is_idle_is_left_alone() {
    let stopped = "floor: {resilient: {stiffness_ratio: 1, damping_ratio: 0.3}}, stop: {length: 1 mm, restitution: 0}";
    let cases = ablation(&experiment(stopped, "[20]"), &assumptions()).expect("it can be switched");
    let of = |cases: &[Ablation], name: &str| -> Outcome {
        let found = cases[0].switched.iter().find(|one| one.effect == name);
        found.unwrap_or_else(|| panic!("no effect `{name}`")).outcome.clone()
    };
    for name in ["limit stop", "ceiling", "gravity", "structural damping"] {
        assert!(matches!(of(&cases, name), Outcome::Changed { change, .. } if change > 1e-6), "{name}: {cases:?}");
    }
    let text = ablation_page(&cases);
    assert!(text.contains("| limit stop | in force | off |"), "{text}");
    assert!(text.contains("| soft walls | left out | no: the walls are rigid"), "{text}");
    // Too weak to lift the particle: stop and ceiling are named, and provably idle.
    let cases = ablation(&experiment(stopped, "[0.001]"), &assumptions()).expect("it can be switched");
    assert!(cases[0].closed_form);
    for name in ["limit stop", "ceiling"] {
        assert_eq!(of(&cases, name), Outcome::Idle(Idle::OnFloors), "{name}");
    }
    // A stop that all the impulses of the run together do not press the floor to.
    let far = stopped.replace("1 mm", "500 m");
    let cases = ablation(&experiment(&far, "[20]"), &assumptions()).expect("it can be switched");
    let Outcome::Idle(Idle::OutOfReach(of_stop)) = of(&cases, "limit stop") else { panic!("{cases:?}") };
    assert!(of_stop.distance == 500.0 && of_stop.reach < 500.0, "{of_stop:?}");
    assert!(matches!(of(&cases, "ceiling"), Outcome::Changed { .. }), "{cases:?}");
    let text = ablation_page(&cases);
    assert!(
        text.contains("| limit stop | named, idle | skipped already: 500 m away, and the energy of the run"),
        "{text}"
    );
}

#[test]
fn pages_that_cannot_be_written_are_told_before_anything_is_measured() {
    let desk = Desk::of_one("experiments/ch3/ch3-long.yaml", THREE_GAPS);
    for in_the_way in ["reports/accuracy", "reports"] {
        // In the place of the folder, which nobody can write into.
        let _ = std::fs::remove_dir_all(desk.layout.path("reports"));
        desk.put(in_the_way, "");
        let said = shotdamp(&desk, &["accuracy", "ch3-long"]);
        assert!(said.code == 2 && said.err.contains("cannot write ") && said.out.is_empty(), "{}", said.err);
        assert!(!desk.layout.path("reports/accuracy.json").exists());
    }
    for longest in ["nan", "inf", "0", "2 s"] {
        let said = shotdamp(&desk, &["accuracy", "ch3-long", "--longest", longest]);
        assert!(said.code == 2 && said.err.contains("write a number of seconds above zero"), "{}", said.err);
    }
}
