//! What `show` tells of a scene and of its assumptions.

use shotdamp::experiment::{Assumptions, parse_experiment};
use shotdamp::report::LastVerdicts;

use crate::desk::{ASSUMPTIONS, Desk, STOP, shotdamp};

fn described(structure: &str) -> Vec<String> {
    let text = format!(
        "title: t\nabout: a\nscene:\n  structure: {{{structure}}}\n  excitation: none\nmeasure: natural_frequency\n"
    );
    let read = parse_experiment(&"x".parse().unwrap(), "x.yaml", &text, &Assumptions::default());
    let experiment = read.unwrap_or_else(|problems| panic!("{problems}"));
    experiment.recipe.resolve(&Assumptions::default()).unwrap().describe()
}

/// The Rayleigh quotient of ξ² is β⁴ = 20, the first root of cos β cosh β = −1 has β⁴ = 12.3624.
#[test]
fn a_model_of_few_polynomials_says_how_far_off_its_first_frequency_is() {
    let beam = "cantilever_beam: {length: 1 m, width: 30 mm, thickness: 5 mm, youngs_modulus: 200 GPa, density: 7800 kg/m^3, rayleigh: 5e-5, basis: BASIS, modes: N}";
    let of = |basis: &str, modes: &str| described(&beam.replace("BASIS", basis).replace('N', modes));
    let one = of("polynomial", "1").into_iter().find(|line| line.starts_with("first natural frequency")).unwrap();
    let omega: f64 = one.split_whitespace().nth(3).unwrap().parse().unwrap();
    let expected = (20.0_f64 * 200e9 * 0.005_f64.powi(2) / (12.0 * 7800.0)).sqrt();
    assert!((omega / expected - 1.0).abs() < 1e-4, "{one}");
    assert!(one.contains("27 % above the continuous structure's"), "{one}");
    for lines in [
        of("polynomial", "4"),
        of("exact", "1"),
        described("single_mass: {mass: 1 kg, stiffness: 1000 N/m, damping_ratio: 0}"),
    ] {
        assert!(!lines.iter().any(|line| line.contains("continuous structure")), "{lines:?}");
    }
}

/// √(1000 N/m / 1 kg) = 31.623 rad/s = 5.0329 Hz; g/ωn² = 9.81 mm.
#[test]
fn a_scene_says_its_natural_frequency_and_what_a_dimensionless_gap_is_in_mm() {
    let shown = shotdamp(&Desk::of_one("experiments/ch3/ch3-one.yaml", STOP), &["show", "ch3-one"]).out;
    assert!(shown.contains("\n  natural frequency 31.623 rad/s (5.0329 Hz)\n"), "{shown}");
    assert!(shown.contains("\n  h′ = 1 is a gap of 9.81 mm\n"), "{shown}");
}

#[test]
fn a_case_says_the_units_of_what_is_swept() {
    let hertz = "title: t\nabout: a\nscene:\n  structure: {single_mass: {mass: 1 kg, stiffness: 1000 N/m, damping_ratio: 0.05}}\n  \
        excitation: {harmonic: {force: 1 N, angular_frequency: swept}}\nsweep: {angular_frequency: [20 rad/s, 30 rad/s]}\n\
        run: {skip: 25 cycles, average: 100 cycles}\nmeasure: rms_velocity\n";
    let shown = shotdamp(&Desk::of_one("experiments/ch3/ch3-one.yaml", hertz), &["show", "ch3-one"]).out;
    assert!(shown.contains("Scene of the first case (angular_frequency = 20 rad/s)"), "{shown}");
}

#[test]
fn reasons_of_assumptions_are_shown_with_the_numbers_of_the_last_verdicts() {
    let desk = Desk::new();
    let reason = "\"{here: ch3-gap/grows} for 1.516, {off: ch3-gap/grows}\"";
    desk.put("experiments/assumptions.yaml", &ASSUMPTIONS.replacen("reason: usual", &format!("reason: {reason}"), 1));
    let shown = || shotdamp(&desk, &["show", "ch3-stop"]).out;
    assert!(shown().contains("… for 1.516, …"), "{}", shown());
    desk.put(
        "reports/verdicts.json",
        r#"{"format": 1, "entries": [{"id": "ch3-gap/grows", "found": "1.539 ± 0.001", "moved": [{"variant": "a=1", "found": "1.6"}],
            "comparison": {"simulated": 1.65, "published": 1.5}}]}"#,
    );
    assert!(shown().contains("1.539 for 1.516, 10 % more"), "{}", shown());
    desk.put("reports/verdicts.json", "cut off {");
    assert!(shown().contains("… for 1.516, …"), "{}", shown());
}

#[test]
fn a_rounded_period_is_shown() {
    let rounded = STOP.replace("average: 100 cycles}", "average: 100 cycles, round_period_to: 1 ms}");
    let shown = |text: &str| shotdamp(&Desk::of_one("experiments/ch3/ch3-one.yaml", text), &["show", "ch3-one"]).out;
    let line = "  the forcing period is rounded to whole steps of 1 ms\n";
    assert!(shown(&rounded).contains(line), "{}", shown(&rounded));
    assert!(!shown(STOP).contains("rounded"));
}

#[test]
fn a_reason_may_quote_an_entry_with_an_assumption_moved() {
    let verdicts = LastVerdicts::read(
        r#"{"entries": [{"id": "a/b", "found": "2 m/s", "moved": [{"variant": "c=1", "found": "3 m/s"}], "comparison": null}]}"#,
    );
    assert_eq!(verdicts.reason("{here: a/b}, {here: a/b, c=1}, {here: a/b, c=2}, {off: a/b}"), "2 m/s, 3 m/s, …, …");
}
