//! What a scene leaves to a sweep varies, and what it states beside is kept.

use shotdamp::experiment::{Assumptions, Experiment, GapRecipe, parse_experiment};
use shotdamp::scene::{Damper, Scene, Surface};
use shotdamp::yaml::Problems;

use crate::desk::{Desk, THREE_GAPS, shotdamp};

const MASS: &str = "{single_mass: {mass: 2 kg, stiffness: 5000 N/m, damping_ratio: 0.02}}";
const BEAM: &str = "{clamped_beam: {length: 1 m, width: 30 mm, thickness: 5 mm, youngs_modulus: 200 GPa, density: 7800 kg/m^3, rayleigh: 5e-5, modes: 4}}";
const RIGID: &str = "floor: {rigid: {restitution: 0.6}}";
const HARMONIC: &str = "harmonic: {force: 10 N, frequency_ratio: 1}";

/// Two dampers, or one, and what is swept.
fn text(structure: &str, dampers: &[&str], excitation: &str, rest: &str) -> String {
    let dampers: String = dampers.iter().map(|damper| format!("    - {{{damper}}}\n")).collect();
    format!(
        "title: t\nabout: a\nrun: {{skip: 2 cycles, average: 5 cycles}}\nscene:\n  structure: {structure}\n  dampers:\n{dampers}  excitation: {{{excitation}}}\n\
         measure: velocity_ratio\n{rest}\n"
    )
}

fn parse(text: &str) -> Result<Experiment, Problems> {
    parse_experiment(&"x".parse().unwrap(), "mine.yaml", text, &Assumptions::default())
}

fn scene(experiment: &Experiment, case: usize) -> Scene {
    experiment.recipe_of(&experiment.cases[case]).unwrap().resolve(&Assumptions::default()).unwrap()
}

/// A number of both dampers in each case.
fn both(text: &str, number: impl Fn(&Damper) -> f64) -> Vec<[f64; 2]> {
    let experiment = parse(text).unwrap_or_else(|problems| panic!("{problems}"));
    let in_case = |case| {
        let scene = scene(&experiment, case);
        [0, 1].map(|damper| number(&scene.dampers[damper]))
    };
    (0..experiment.cases.len()).map(in_case).collect()
}

fn refused(text: &str) -> String {
    parse(text).expect_err(text).to_string()
}

#[test]
fn a_sweep_leaves_other_dampers_what_they_state() {
    let first = |damper: &str| format!("mass: 100 g, {damper}, {RIGID}");
    let gaps = text(
        MASS,
        &[&first("gap_ratio: swept"), &first("gap_ratio: 2")],
        HARMONIC,
        "sweep: {gap_ratio: [1, 5, infinite]}",
    );
    let unit = 9.80665 * 2.0 / 5000.0;
    for (got, want) in
        both(&gaps, |damper| damper.gap / unit).iter().zip([[1.0, 2.0], [5.0, 2.0], [f64::INFINITY, 2.0]])
    {
        assert!((got[0] == want[0] || (got[0] - want[0]).abs() < 1e-12) && (got[1] - want[1]).abs() < 1e-12, "{got:?}");
    }

    let masses = [format!("mass_ratio: swept, gap: 5 mm, {RIGID}"), format!("mass: 20 g, gap: 5 mm, {RIGID}")];
    let masses = text(MASS, &[&masses[0], &masses[1]], HARMONIC, "sweep: {mass_ratio: [0.1, 0.2]}");
    assert_eq!(both(&masses, |damper| damper.particle_mass), [[0.2, 0.02], [0.4, 0.02]]);

    let at = |at: &str| format!("at: {at}, mass_ratio: 0.05, particle_share: 0.5, gap: 5 mm, {RIGID}");
    let places = text(
        BEAM,
        &[&at("swept"), &at("0.8")],
        "harmonic: {at: 0.5, force: 1 N, frequency_ratio: 1}",
        "sweep: {damper_x: [0.25, 0.5]}",
    );
    assert_eq!(both(&places, |damper| damper.at.x), [[0.25, 0.8], [0.5, 0.8]]);
}

#[test]
fn a_sweep_of_floors_leaves_a_ceiling_what_it_states() {
    let faces = |ceiling: &str| {
        let damper = format!(
            "mass: 100 g, gap: 5 mm, floor: {{resilient: {{stiffness_ratio: swept, damping_ratio: 0.1}}}}{ceiling}"
        );
        let text = text(MASS, &[&damper], HARMONIC, "sweep: {floor_stiffness_ratio: [1, 2]}");
        let scene = scene(&parse(&text).unwrap(), 1);
        [&scene.dampers[0].floor, &scene.dampers[0].ceiling].map(|surface| match surface {
            Surface::Resilient { stiffness, .. } => stiffness / 5000.0,
            Surface::Rigid { .. } => f64::INFINITY,
        })
    };
    assert_eq!(faces(", ceiling: {resilient: {stiffness_ratio: 9, damping_ratio: 0.1}}"), [2.0, 9.0]);
    assert_eq!(faces(", ceiling: {rigid: {restitution: 0.6}}"), [2.0, f64::INFINITY]);
    assert_eq!(faces(""), [2.0, 2.0], "a ceiling that is not stated is like the floor");
}

#[test]
fn an_axis_that_nothing_is_left_to_is_refused_at_its_key() {
    let damper = format!("mass: 100 g, gap: 5 mm, {RIGID}");
    let of = |axis: &str, values: &str| text(MASS, &[&damper], HARMONIC, &format!("sweep: {{{axis}: {values}}}"));
    for (axis, values, mark) in [
        ("mass_ratio", "[0.1, 0.2]", "`mass_ratio: swept` in every damper"),
        ("gap_ratio", "[1, 5]", "`gap_ratio: swept` in every damper"),
        ("force", "[1 N, 2 N]", "`force: swept` in the excitation"),
        ("frequency_ratio", "[0.9, 1]", "`frequency_ratio: swept` in the excitation"),
        ("damping_ratio", "[0.01, 0.02]", "`damping_ratio: swept` in the structure"),
    ] {
        let said = refused(&of(axis, values));
        assert!(said.contains(&format!("`{axis}` is swept, but nothing in the scene is left to it")), "{said}");
        assert!(said.contains(mark) && said.contains("mine.yaml:10:9"), "{said}");
        assert_eq!(said.matches("error").count(), 1, "{said}");
    }
    let maximised = text(MASS, &[&damper], HARMONIC, "maximise: {velocity_ratio: {over: force, in: [1 N, 2 N]}}");
    assert!(refused(&maximised).contains("`force` is varied, but nothing in the scene is left to it"));
}

/// What switches a part on or off replaces no number; a value that only some cases set is that of the others.
#[test]
fn switches_need_no_mark_and_a_stated_value_is_that_of_cases_that_leave_it_out() {
    let damper = format!("mass: 100 g, gap_ratio: 3, {RIGID}");
    assert!(parse(&text(MASS, &[&damper], HARMONIC, "sweep: {dampers: [with, without]}")).is_ok());
    let some = "sweep: {union: {a: {gap_ratio: [1, 5]}, b: {dampers: [with]}}}";
    let experiment = parse(&text(MASS, &[&damper], HARMONIC, some)).unwrap();
    let last = experiment.recipe_of(experiment.cases.last().unwrap()).unwrap();
    assert_eq!(last.dampers[0].gap, GapRecipe::Ratio(3.0.into()));
    let two = refused(&text(MASS, &[&damper, &damper], HARMONIC, some));
    assert!(two.contains("nothing in the scene is left to it"), "which of the two is not known: {two}");
}

#[test]
fn a_gap_is_swept_in_millimetres() {
    let first = format!("mass: 100 g, gap: swept, {RIGID}");
    let second = format!("mass: 100 g, gap: 2 mm, {RIGID}");
    let sweep = "sweep: {gap: [{linear: {from: 5 mm, to: 7 mm, points: 3}}, 1 cm]}";
    let gaps = both(&text(MASS, &[&first, &second], HARMONIC, sweep), |damper| damper.gap);
    assert_eq!(gaps, [[0.005, 0.002], [0.006, 0.002], [0.007, 0.002], [0.01, 0.002]]);
    let bare = refused(&text(MASS, &[&first], HARMONIC, "sweep: {gap: [5, 6]}"));
    assert!(bare.contains("`5` has no unit, but a length is wanted"), "{bare}");
}

#[test]
fn a_page_leads_with_a_swept_gap_and_a_swept_mass_in_their_units() {
    let both = THREE_GAPS.replace("gap_ratio: swept", "gap: swept").replace("mass_ratio: 0.05", "mass: swept");
    let text = both.replace("gap_ratio: [10, 50, 90]", "gap: [5 mm, 10 mm], mass: [50 g]");
    let desk = Desk::of_one("experiments/ch3/ch3-long.yaml", &text);
    let said = shotdamp(&desk, &["run"]);
    let page = String::from_utf8(desk.bytes("reports/ch3/ch3-long.md")).unwrap();
    let lead = page
        .lines()
        .find(|line| line.starts_with("**In short.** RMS velocity "))
        .unwrap_or_else(|| panic!("{}", said.err));
    assert!(lead.contains("(mass = 0.05 kg, h = 5 mm), ") && lead.contains("(mass = 0.05 kg, h = 10 mm)"), "{lead}");
}

#[test]
fn the_mass_of_a_damper_is_swept_in_grams() {
    let first = format!("mass: swept, gap: 5 mm, {RIGID}");
    let second = format!("mass: 20 g, gap: 5 mm, {RIGID}");
    let sweep = "sweep: {mass: [{linear: {from: 100 g, to: 300 g, points: 3}}, 1 kg]}";
    let masses = both(&text(MASS, &[&first, &second], HARMONIC, sweep), |damper| damper.particle_mass);
    for (got, want) in masses.iter().zip([0.1, 0.2, 0.3, 1.0]) {
        assert!((got[0] - want).abs() < 1e-15 && got[1] == 0.02, "{masses:?}");
    }
    let bare = refused(&text(MASS, &[&first], HARMONIC, "sweep: {mass: [5, 6]}"));
    assert!(bare.contains("`5` has no unit, but a mass is wanted"), "{bare}");
    let nothing = refused(&text(MASS, &[&first], HARMONIC, "sweep: {mass_ratio: [0.1]}"));
    assert!(nothing.contains("mass"), "{nothing}");
}

#[test]
fn a_key_that_no_sweep_varies_says_what_to_sweep_instead() {
    let damper = "mass: 100 g, gap: 5 mm, floor: {rigid: {restitution: swept}}";
    let said = refused(&text(MASS, &[damper], HARMONIC, ""));
    assert!(said.contains("no sweep varies this key") && said.contains("`contact_damping_ratio`"), "{said}");
    let stiffness = MASS.replace("5000 N/m", "swept");
    let said = refused(&text(&stiffness, &[], HARMONIC, "").replace("  dampers:\n", ""));
    assert!(said.contains("no sweep varies this key") && said.contains("`frequency_ratio`"), "{said}");
    let observed = text(BEAM, &[], "harmonic: {at: 0.5, force: 1 N, frequency_ratio: 1}", "")
        .replace("  dampers:\n", "  observe: [swept]\n");
    assert!(refused(&observed).contains("observed points cannot be swept"));
}
