//! Inputs: what the text of a study states with its place, and places that an assumption lists.

use shotdamp::experiment::{Assumptions, Experiment, parse_assumptions, parse_experiment};
use shotdamp::yaml::Problems;

const STATED: &str = "\
stated:
  5:
    Table 6: {length: 1.25 m, width: 1 m, thickness: 8 mm, youngs_modulus: 69 GPa, poisson_ratio: 0.33, density: 2700 kg/m^3}
    Table 5: {mass_ratio: 0.1, particle_share: 0.5, frequency_ratio: 1}
";

const ASSUMED: &str = "\
loss: {quantity: ratio, value: 5e-5, reason: Not stated.}
points: {quantity: places, value: [[0.25, 0.5], [0.5, 0.5]], range: [[[0.25, 0.25], [0.5, 0.25]]], reason: Shown in a figure.}
middle: {quantity: places, value: [[0.5, 0.5]], reason: Shown in a figure.}
order: {readings: [columns, rows], value: rows, reason: Shown in a figure.}
";

const PLATE: &str = "\
title: Plate
source: {chapter: 5}
about: A plate.
scene:
  structure:
    supported_plate: {length: 125 cm, width: 1 m, thickness: 8 mm, youngs_modulus: 69 GPa, poisson_ratio: 0.33, density: 2700 kg/m^3, rayleigh: {assumed: loss}, modes: 2}
  dampers:
    - {at: [0.5, 0.5], mass_ratio: 0.1, particle_share: 0.5, gap: 20 mm, floor: {resilient: {stiffness: 1000 N/m, damping: 5 N s/m}}}
  excitation: {impulse_train: {at: [0.25, 0.5], impulse: 1 N s, frequency_ratio: swept}}
  observe: [0.5, 0.5]
sweep: {frequency_ratio: [0.5, 1, {linear: {from: 1.1, to: 2, points: 5}}]}
run: {skip: 25 cycles, average: 100 cycles, ensemble: 4 members}
measure: rms_velocity
";

fn assumptions(text: &str) -> Assumptions {
    parse_assumptions("assumptions.yaml", text).unwrap_or_else(|problems| panic!("{problems}")).assumptions()
}

fn without_source(text: &str, of: &str) -> Vec<String> {
    good(text, of).without_source.iter().map(ToString::to_string).collect()
}

fn parse(text: &str, of: &str) -> Result<Experiment, Problems> {
    parse_experiment(&"ch5-test".parse().unwrap(), "ch5-test.yaml", text, &assumptions(of))
}

fn good(text: &str, of: &str) -> Experiment {
    parse(text, of).unwrap_or_else(|problems| panic!("{problems}"))
}

/// The one problem of a text.
fn problem(text: &str, of: &str) -> String {
    let problems = parse(text, of).expect_err("a mistake was expected");
    assert_eq!(problems.list.len(), 1, "{problems}");
    problems.list[0].message.clone()
}

/// `125 cm` is the `1.25 m` of Table 6, the loss is an assumption, the points between 1.1 and 2 are a grid, and the members of an
/// ensemble are no input.
#[test]
fn a_number_that_neither_the_text_nor_an_assumption_gives_is_listed() {
    let all = format!("{STATED}{ASSUMED}");
    let listed = [
        "supported_plate.modes 2",
        "dampers.at [0.5, 0.5]",
        "dampers.gap 20 mm",
        "resilient.stiffness 1000 N/m",
        "resilient.damping 5 N s/m",
        "impulse_train.at [0.25, 0.5]",
        "impulse_train.impulse 1 N s",
        "scene.observe [0.5, 0.5]",
        "frequency_ratio 0.5 (Table 5: 1)",
        "run.skip 25 cycles",
        "run.average 100 cycles",
    ];
    assert_eq!(without_source(PLATE, &all), listed);

    let own = "stated:\n  Fig. 46: {dampers.at: [0.5, 0.5], at: [0.25, 0.5], frequency_ratio: [0.5, 1]}\n  s. 3.6: {run.skip: 25 cycles}\n";
    let left = without_source(&format!("{own}{PLATE}"), &all);
    let stated = ["dampers.at", "impulse_train.at", "frequency_ratio", "run.skip"];
    assert!(left.iter().all(|input| stated.iter().all(|key| !input.starts_with(key))), "{left:?}");
    assert_eq!(left.len(), listed.len() - stated.len());
}

/// Nor under a chapter of which nothing is stated.
#[test]
fn a_study_that_states_nothing_lists_nothing() {
    assert!(without_source(PLATE, ASSUMED).is_empty());
    let elsewhere = PLATE.replace("chapter: 5", "chapter: 6");
    assert!(without_source(&elsewhere, &format!("{STATED}{ASSUMED}")).is_empty());
}

#[test]
fn a_statement_that_gives_no_input_is_refused() {
    let wrong = format!("stated:\n  Fig. 46: {{gap: 21 mm}}\n{PLATE}");
    assert_eq!(problem(&wrong, ASSUMED), "no input of this experiment is the `gap` that is stated here");
    let no_number = format!("stated:\n  Fig. 46: {{gap: wide}}\n{PLATE}");
    assert!(problem(&no_number, ASSUMED).contains("is a number"));
    assert!(parse_assumptions("assumptions.yaml", "stated: {six: {Table 6: {width: 1 m}}}").is_err());
}

/// The same scenes, whether their places are written out or listed by an assumption; force and dampers move together.
#[test]
fn places_of_a_list_are_those_written_out() {
    let listed = PLATE
        .replace("- {at: [0.5, 0.5]", "- {at: {assumed: points}")
        .replace("at: [0.25, 0.5], impulse", "at: {assumed: points}, impulse")
        + "mean_over: {place: [1, 2]}\n";
    let written = PLATE
        .replace("- {at: [0.5, 0.5]", "- {at: [swept, 0.5]")
        .replace("at: [0.25, 0.5], impulse", "at: [swept, 0.5], impulse")
        + "mean_over: {paired: {force_x: [0.25, 0.5], damper_x: [0.25, 0.5]}}\n";
    let of = assumptions(ASSUMED);
    let scenes = |text: &str| {
        let experiment = good(text, ASSUMED);
        let recipes = experiment.recipes_of(&experiment.cases[0]).unwrap();
        recipes.iter().map(|recipe| recipe.resolve(&of).unwrap()).collect::<Vec<_>>()
    };
    assert_eq!(scenes(&listed), scenes(&written));
    assert_eq!(scenes(&PLATE.replace("- {at: [0.5, 0.5]", "- {at: {assumed: middle}")), scenes(PLATE));

    let unchosen = parse(&listed.replace("mean_over: {place: [1, 2]}\n", ""), ASSUMED).unwrap_err();
    assert!(unchosen.to_string().contains("nothing sweeps `place`"), "{unchosen}");
    assert!(parse(&listed.replace("[1, 2]", "[1, 2, 3]"), ASSUMED).is_err());
    let fewer = ASSUMED.replace("range: [[[0.25, 0.25], [0.5, 0.25]]]", "range: [[[0.25, 0.25]]]");
    assert!(parse_assumptions("assumptions.yaml", &fewer).is_err());
}

/// By rows the second damper of an array is the next along the first side, by columns along the second.
#[test]
fn gaps_go_to_the_dampers_in_the_order_of_the_array() {
    let array = "array: {count: [2, 2], spacing: [3 cm, 4 cm]}, gap: [1 mm, 2 mm, 3 mm, 4 mm]";
    let by_columns = PLATE.replace("gap: 20 mm", array);
    let by_rows = by_columns.replace("4 cm]}", "4 cm], order: {assumed: order}}");
    let of = assumptions(ASSUMED);
    let gaps = |text: &str| {
        let experiment = good(text, ASSUMED);
        let scene = experiment.recipe_of(&experiment.cases[0]).unwrap().resolve(&of).unwrap();
        let mut gaps: Vec<_> = scene.dampers.iter().map(|damper| ((damper.at.x, damper.at.y), damper.gap)).collect();
        gaps.sort_by(|a, b| a.0.partial_cmp(&b.0).unwrap());
        gaps.into_iter().map(|(_, gap)| gap * 1e3).collect::<Vec<_>>()
    };
    assert_eq!(gaps(&by_columns), [1.0, 2.0, 3.0, 4.0]);
    assert_eq!(gaps(&by_rows), [1.0, 3.0, 2.0, 4.0]);
}

/// m′ as a quarter of the structure's mass is the modal reading of a plate.
#[test]
fn a_mass_ratio_may_be_of_a_share_of_the_structure() {
    let of = assumptions(ASSUMED);
    let mass = |reading: &str| {
        let experiment =
            good(&PLATE.replace("mass_ratio: 0.1", &format!("mass_ratio: 0.1, mass_reading: {reading}")), ASSUMED);
        experiment.recipe_of(&experiment.cases[0]).unwrap().resolve(&of).unwrap().dampers[0].particle_mass
    };
    assert!((mass("0.25") / mass("modal") - 1.0).abs() < 1e-12);
    assert!((mass("1") / mass("total") - 1.0).abs() < 1e-12);
}
