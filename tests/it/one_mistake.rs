//! One mistake is told once, and what would go wrong later is told at once.

use shotdamp::experiment::{Assumptions, parse_assumptions, parse_experiment};

const BEAM: &str = "
title: t
about: a
scene:
  structure: {cantilever_beam: {length: 1 m, width: 30 mm, thickness: 5 mm, youngs_modulus: 70 GPa, density: 2700 kg/m^3, rayleigh: 5e-5, modes: 4}}
  dampers: [{at: 1, mass_ratio: 0.05, particle_share: 0.5, gap_ratio: 50, floor: {rigid: {restitution: 0.6}}}]
  excitation: {impulse_train: {at: 1, force_ratio: swept, frequency_ratio: 1}}
sweep: {force_ratio: [1, 2]}
run: {skip: 2 cycles, average: 5 cycles}
measure: velocity_ratio
figure: {x: force_ratio, y: velocity_ratio, caption: c}
";

/// What is said of the beam with one thing changed.
fn said(from: &str, to: &str) -> Vec<String> {
    assert!(BEAM.contains(from), "{from}");
    let text = BEAM.replacen(from, to, 1);
    let read = parse_experiment(&"x".parse().unwrap(), "mine.yaml", &text, &Assumptions::default());
    read.map_or_else(|problems| problems.list.iter().map(|one| one.message.clone()).collect(), |_| Vec::new())
}

#[test]
fn a_mistake_in_a_structure_is_the_only_one() {
    assert_eq!(said("cantilever_beam", "cantilever_beam"), [""; 0]);
    for (from, to, what) in [
        ("70 GPa", "70", "`70` has no unit"),
        ("rayleigh: 5e-5", "rayleigh: -5e-5", "cannot be negative"),
        ("cantilever_beam", "cantilver_beam", "`cantilver_beam`"),
        ("density", "densty", "densty"),
    ] {
        let said = said(from, to);
        assert!(said.iter().any(|one| one.contains(what)), "{said:?}");
        assert!(!said.iter().any(|one| one.contains("`at`")), "{said:?}");
    }
    assert_eq!(said("70 GPa", "70").len(), 1);
    assert_eq!(said("rayleigh: 5e-5", "rayleigh: -5e-5").len(), 1);
    // Mistakes beside it are still told.
    let text = BEAM.replace("70 GPa", "70").replace("gap_ratio: 50", "gap_ratio: -1");
    let problems = parse_experiment(&"x".parse().unwrap(), "mine.yaml", &text, &Assumptions::default()).unwrap_err();
    assert_eq!(problems.list.len(), 2, "{problems}");
}

#[test]
fn no_figure_takes_the_name_of_the_drawing_of_the_scene() {
    let named = |name: &str| said("figure: {x", &format!("figure: {{name: {name}, x"));
    assert_eq!(named("scene"), ["`scene` names the drawing of the scene"]);
    assert_eq!(named("gaps"), [""; 0]);
}

/// The beam with one thing changed, from where the only mistake is marked to the end of that line.
fn marked(from: &str, to: &str) -> String {
    assert!(BEAM.contains(from), "{from}");
    marked_in(&BEAM.replacen(from, to, 1))
}

fn marked_in(text: &str) -> String {
    let problems = parse_experiment(&"x".parse().unwrap(), "mine.yaml", text, &Assumptions::default()).unwrap_err();
    assert_eq!(problems.list.len(), 1, "{problems}");
    let place = problems.list[0].place.unwrap();
    text.lines().nth(place.line - 1).unwrap().chars().skip(place.column - 1).collect()
}

#[test]
fn a_value_that_physics_refuses_is_marked_itself() {
    for (from, to, wrong) in [
        ("frequency_ratio: 1", "frequency_ratio: 0.0", "0.0"),
        ("impulse_train: {at: 1", "impulse_train: {at: 0.000", "0.000"),
        ("modes: 4", "modes: 500", "500"),
        ("modes: 4", "modes: 00", "00"),
        ("particle_share: 0.5", "particle_share: 1.5", "1.5"),
        ("gap_ratio: 50", "gap: -5 mm", "-5 mm"),
        ("dampers: [{at: 1", "dampers: [{at: 2 m", "2 m"),
    ] {
        assert!(marked(from, to).starts_with(wrong), "{to}");
    }
    let massless = "mass_ratio: 0.00, particle_share: 0.5, gap_ratio: 50, floor: {resilient: {stiffness: tuned, damping_ratio: 0.1}}}]";
    let damper = "mass_ratio: 0.05, particle_share: 0.5, gap_ratio: 50, floor: {rigid: {restitution: 0.6}}}]";
    assert!(marked(damper, massless).starts_with("0.00"));
}

#[test]
fn of_a_surface_or_a_stop_the_value_that_is_refused_is_marked_and_no_other_though_that_is_swept() {
    let damper = "[{at: 1, mass_ratio: 0.05, particle_share: 0.5, gap_ratio: 50, floor: {rigid: {restitution: 0.6}}}]";
    let sweep = "sweep: {force_ratio: [1, 2]}";
    let marked = |dampers: &str, swept: &str| {
        let swept = format!("sweep: {{force_ratio: [1, 2]{swept}}}");
        marked_in(&BEAM.replacen(damper, dampers, 1).replacen(sweep, &swept, 1))
    };
    let one = "at: 1, mass_ratio: 0.05, particle_share: 0.5";
    // The damping of a floor whose tuning is swept.
    let floor = "floor: {resilient: {stiffness: tuned, damping: -1 N s/m, untuned_frequency_ratio: 2}}";
    assert!(
        marked(&format!("[{{{one}, gap_ratio: 50, {floor}}}]"), ", floor_tuning: [tuned, untuned]")
            .starts_with("-1 N s/m")
    );
    // That of the ceiling, not of the floor.
    let faces = "floor: {resilient: {stiffness: tuned, damping_ratio: 0.1}}, ceiling: {resilient: {stiffness: tuned, damping_ratio: -0.2}}";
    assert!(marked(&format!("[{{{one}, gap_ratio: 50, {faces}}}]"), "").starts_with("-0.2"));
    // The gap of the second damper, where that of the first is swept.
    let rigid = "floor: {rigid: {restitution: 0.6}}";
    let two = format!("[{{{one}, gap_ratio: swept, {rigid}}}, {{{one}, gap_ratio: -3, {rigid}}}]");
    assert!(marked(&two, ", gap_ratio: [10, 20]").starts_with("-3"));
    let stopped = |stop: &str| {
        format!(
            "[{{{one}, gap_ratio: 50, floor: {{resilient: {{stiffness: tuned, damping_ratio: 0.1}}}}, stop: {stop}}}]"
        )
    };
    assert!(marked(&stopped("{length: 0 mm}"), "").starts_with("0 mm"));
    assert!(
        marked(&stopped("{length: swept, restitution: 0.5}"), ", stop_length: [1 mm, 0 mm]").starts_with("stop_length")
    );
}

#[test]
fn a_swept_value_that_physics_refuses_is_marked_in_the_sweep_under_its_own_name() {
    let train = "force_ratio: swept, frequency_ratio: 1}}\nsweep: {force_ratio: [1, 2]}";
    let swept = "force_ratio: swept, frequency_ratio: swept}}\nsweep: {force_ratio: [1, 2], frequency_ratio: [0, 1]}";
    assert!(marked(train, swept).starts_with("frequency_ratio"));
    // One case of a union puts another value in the place of what is stated.
    let union = "force_ratio: swept, frequency_ratio: 1}}\nsweep: {union: {a: {force_ratio: [1, 2]}, b: {force_ratio: [3], frequency_ratio: [0, 1]}}}";
    assert!(marked(train, union).starts_with("frequency_ratio: [0"));
}

#[test]
fn plain_assumed_where_no_assumption_can_stand_by_default_says_what_to_write() {
    for key in ["mass_ratio: 0.05", "gap_ratio: 50", "frequency_ratio: 1", "rayleigh: 5e-5", "restitution: 0.6"] {
        let (name, _) = key.split_once(':').unwrap();
        let said = said(key, &format!("{name}: assumed"));
        assert_eq!(said, ["no assumption stands for this key"], "{key}");
    }
}

#[test]
fn the_value_of_an_assumption_is_no_other_assumption() {
    let text = "a: {quantity: ratio, value: {assumed: b}, reason: r}\nb: {quantity: ratio, value: 1, reason: r}\n";
    let problems = parse_assumptions("assumptions.yaml", text).unwrap_err();
    assert_eq!(problems.list.len(), 1, "{problems}");
    assert_eq!(problems.list[0].message, "the value of an assumption cannot be another assumption");
}

#[test]
fn an_anchor_is_marked_itself_and_its_alias_once() {
    assert!(marked("about: a", "about: &x a").starts_with("&x"));
    let text = BEAM.replace("title: t", "title: &x t").replace("about: a", "about: *x");
    let problems = parse_experiment(&"x".parse().unwrap(), "mine.yaml", &text, &Assumptions::default()).unwrap_err();
    let said: Vec<&str> = problems.list.iter().map(|one| one.message.as_str()).collect();
    assert_eq!(said, ["anchors (`&name`) are not accepted", "aliases (`*name`) are not accepted"]);
}

#[test]
fn a_range_of_an_axis_that_holds_nothing_of_the_sweep_is_told_before_anything_runs() {
    let of =
        |range: &str| said("figure: {x: force_ratio", &format!("figure: {{x: {{column: force_ratio, range: {range}}}"));
    assert_eq!(of("[1000, 2000]"), ["nothing of `force_ratio` lies in this range"]);
    assert_eq!(of("[0.5, 1.5]"), [""; 0]);
    // A gap that is infinite has no place on any axis.
    let text = BEAM
        .replace("gap_ratio: 50", "gap_ratio: swept")
        .replace("sweep: {force_ratio: [1, 2]}", "sweep: {force_ratio: [1, 2], gap_ratio: [10, 20, infinite]}")
        .replace("figure: {x: force_ratio", "figure: {by: force_ratio, x: {column: gap_ratio, range: [30, 40]}");
    let problems = parse_experiment(&"x".parse().unwrap(), "mine.yaml", &text, &Assumptions::default()).unwrap_err();
    assert_eq!(problems.list[0].message, "nothing of `gap_ratio` lies in this range", "{problems}");
    assert_eq!(problems.list[0].help.as_deref(), Some("`gap_ratio` goes from 10 to 20 here"));
}
