//! What a person meets who writes an experiment.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

use shotdamp::experiment::{
    AssumptionName, AssumptionSheet, AssumptionValue, Assumptions, Experiment, ExperimentId, GapRecipe, Given,
    Parameter, ParameterValue, load_assumptions, load_experiment, parse_assumptions, parse_experiment,
};
use shotdamp::measure::{Measure, SolverChoice};
use shotdamp::scene::{ContactDamping, Excitation, PulseShape, Surface};
use shotdamp::text::words;
use shotdamp::yaml::{Dimension, Problems, parse_number, parse_quantity};

const GOOD: &str = "\
title: Limit stop
source: {chapter: 3, section: 3.6.3, shown_in: [Fig. 18]}
about: With and without a limit stop.
scene:
  structure: {single_mass: {mass: 1 kg, stiffness: 1000 N/m, damping_ratio: 0.05}}
  dampers:
    - mass_ratio: 0.05
      gap: 490.5 mm
      floor: {resilient: {stiffness_ratio: 1, damping_ratio: assumed}}
      stop: {length: 60 mm}
  excitation: {impulse_train: {force_ratio: swept, frequency_ratio: 1}}
sweep:
  force_ratio: {log: {from: 0.1, to: 100, points: 61}}
  stop: [with, without]
run: {solver: event_driven, skip: 25 cycles, average: 100 cycles, round_period_to: 1 ms, ensemble: 32 members}
measure: [velocity_ratio, ceiling_impacts]
figure: {x: force_ratio, y: velocity_ratio, by: stop, band: spread, caption: With and without.}
";

fn folder() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("experiments")
}

fn sheet() -> AssumptionSheet {
    load_assumptions(&folder().join("assumptions.yaml")).unwrap_or_else(|problems| panic!("{problems}"))
}

fn assumptions() -> Assumptions {
    sheet().assumptions()
}

fn parse(text: &str) -> Result<Experiment, Problems> {
    parse_experiment(&"ch3-test".parse().unwrap(), "ch3-test.yaml", text, &assumptions())
}

fn good(text: &str) -> Experiment {
    parse(text).unwrap_or_else(|problems| panic!("{problems}"))
}

/// The good experiment with one thing changed.
fn with(old: &str, new: &str) -> String {
    assert!(GOOD.contains(old), "{old}");
    GOOD.replace(old, new)
}

/// The one problem of a text, as `line:column message | help`.
fn only_problem(text: &str) -> String {
    let problems = parse(text).expect_err("a mistake was expected");
    assert_eq!(problems.list.len(), 1, "{problems}");
    describe(&problems).remove(0)
}

fn describe(problems: &Problems) -> Vec<String> {
    let description = problems.list.iter().map(|problem| {
        let place = problem.place.map_or(String::new(), |place| format!("{}:{} ", place.line, place.column));
        let help = problem.help.as_ref().map_or(String::new(), |help| format!(" | {help}"));
        format!("{place}{}{help}", problem.message)
    });
    description.collect()
}

#[test]
pub(crate) fn an_experiment_says_what_its_file_says() {
    let experiment = good(GOOD);
    assert_eq!(experiment.source.section.as_deref(), Some("3.6.3"));
    assert_eq!(experiment.swept, [Parameter::ForceRatio, Parameter::Stop]);
    assert_eq!(experiment.cases.len(), 122);
    assert_eq!(experiment.cases[41].get(Parameter::ForceRatio), Some(ParameterValue::Number(1.0)), "decades are exact");
    assert_eq!(experiment.cases[41].get(Parameter::Stop), Some(ParameterValue::Without));
    assert_eq!(experiment.recipe.dampers[0].gap, GapRecipe::Gap(Given::Stated(0.4905)));
    assert_eq!(experiment.settings.round_period_to, Some(0.001));
    let used = [
        "gravity",
        "impulse_factor",
        "impulse_frequency",
        "contact_damping_ratio",
        "stop_restitution",
        "undamped_mass",
        "impulse_reference",
    ];
    assert_eq!(experiment.assumptions_used(&sheet()), BTreeSet::from(used.map(AssumptionName::from)));
}

#[test]
pub(crate) fn comments_order_and_units_do_not_change_the_meaning() {
    let meaning = |text: &str| good(text).canonical_json().to_string();
    let same = [
        with("490.5 mm", "0.4905 m"),
        with("stop: {length: 60 mm}", "stop: {length: 6e-2 m} # a comment"),
        with("mass: 1 kg, stiffness: 1000 N/m", "stiffness: 1 kN/m, mass: 1000 g"),
        with(
            "  force_ratio: {log: {from: 0.1, to: 100, points: 61}}\n  stop: [with, without]\n",
            "  stop: [with, without]\n  force_ratio: {log: {points: 61, to: 1e2, from: 0.1}}\n",
        ),
        with("run: {solver: event_driven, skip: 25 cycles, ", "run: {"),
        with("solver: event_driven", "solver: [event_driven]"),
    ];
    for text in &same {
        assert_eq!(meaning(text), meaning(GOOD), "{text}");
    }
    assert_ne!(meaning(&with("60 mm", "61 mm")), meaning(GOOD));
}

#[test]
pub(crate) fn a_new_caption_does_not_make_a_simulation_stale() {
    let (old, new) = (good(GOOD), good(&with("With and without.", "Another caption.")));
    assert_eq!(old.simulation_json(), new.simulation_json());
    assert_ne!(old.figures, new.figures);
    assert_ne!(old.simulation_json(), good(&with("skip: 25", "skip: 26")).simulation_json());
}

#[test]
pub(crate) fn a_run_until_settled_says_how_it_ended_and_is_refused_where_nothing_could_prove_it() {
    let run = "run: {solver: event_driven, skip: 25 cycles, average: 100 cycles, ";
    let settled = with(run, &format!("{run}until: settled, "));
    let experiment = good(&settled);
    assert_eq!(
        experiment.measures,
        [Measure::VelocityRatio, Measure::CeilingImpacts, Measure::Settled, Measure::AveragedCycles]
    );
    assert_ne!(experiment.simulation_json(), good(GOOD).simulation_json());
    assert_eq!(good(&with(run, &format!("{run}until: cycles, "))).simulation_json(), good(GOOD).simulation_json());
    for (old, new, problem) in [
        ("until: settled", "until: setled", "15:74 `setled` is not an end | did you mean `settled`?"),
        (
            "solver: event_driven",
            "solver: {fixed_step: {time_step: 0.1 ms}}",
            "15:95 a fixed step has no multipliers that could prove that a run has settled | `until: settled` goes with \
             `solver: event_driven`",
        ),
        (
            "ceiling_impacts",
            "drift",
            "16:27 `drift` compares cycles, and a settled run is averaged over one period | leave it or `until: settled` out",
        ),
        (
            "impulse_train: {force_ratio: swept, frequency_ratio: 1}",
            "single_impulse: {force_ratio: swept, frequency_ratio: 1}",
            "15:74 no period comes again without an excitation that repeats",
        ),
    ] {
        assert!(settled.contains(old), "{old}");
        assert_eq!(only_problem(&settled.replace(old, new)), problem);
    }
    let later = with("ceiling_impacts]", "ceiling_impacts, settled_velocity_ratio]");
    assert!(good(&later).measures.contains(&Measure::SettledVelocityRatio));
    let [stepped, struck] = [
        later.replace("solver: event_driven", "solver: {fixed_step: {time_step: 0.1 ms}}"),
        later.replace("impulse_train", "single_impulse"),
    ];
    assert_eq!(only_problem(&stepped), "16:44 `settled_velocity_ratio` is measured of the event-driven solver alone");
    assert_eq!(only_problem(&struck), "16:44 no period comes again without an excitation that repeats");
}

#[test]
pub(crate) fn quantities_are_read_into_si_to_the_last_bit() {
    let cases = [
        ("5 mm", Dimension::Length, 0.005),
        ("4.9mm", Dimension::Length, 0.0049),
        ("1000 N/m", Dimension::Stiffness, 1000.0),
        ("4.24 N s/m", Dimension::Damping, 4.24),
        ("4.24 N*s/m", Dimension::Damping, 4.24),
        ("0.199 s", Dimension::Time, 0.199),
        ("1e-5 s", Dimension::Time, 1e-5),
        ("10 µs", Dimension::Time, 1e-5),
        ("9.81 m/s^2", Dimension::Acceleration, 9.81),
        ("9.81 m/s²", Dimension::Acceleration, 9.81),
        ("31.6 rad/s", Dimension::AngularFrequency, 31.6),
        ("5.03 Hz", Dimension::AngularFrequency, 5.03 * std::f64::consts::TAU),
        ("50 g", Dimension::Mass, 0.05),
        ("2 N s", Dimension::Impulse, 2.0),
        ("2 kg m/s", Dimension::Impulse, 2.0),
        ("427.3 mm/s", Dimension::Velocity, 0.4273),
    ];
    for (text, dimension, value) in cases {
        assert_eq!(parse_quantity(text, dimension), Ok(value), "{text}");
    }
}

#[test]
pub(crate) fn a_unit_of_the_wrong_kind_is_told_in_words() {
    let cases = [
        ("5 s", Dimension::Length, "`5 s` is not a length", "write for example 5 mm"),
        ("5", Dimension::Length, "`5` has no unit, but a length is wanted", "write for example 5 mm"),
        ("5 furlongs", Dimension::Length, "`furlongs` is not a unit that is known here", "write for example 5 mm"),
        (
            "3 1/s",
            Dimension::AngularFrequency,
            "`1/s` is not a unit that is known here",
            "write for example 31.6 rad/s or 5.03 Hz",
        ),
        ("1 N/m", Dimension::Damping, "`1 N/m` is not a damping constant", "write for example 4.24 N s/m"),
        ("fast", Dimension::Velocity, "`fast` is not a number", ""),
        ("nan m", Dimension::Length, "`nan m` is not a number", ""),
        (".nan", Dimension::Length, "`.nan` is not a finite number", ""),
        ("1e999 m", Dimension::Length, "`1e999 m` is not a finite number", ""),
        ("1e99999999999 m", Dimension::Length, "`1e99999999999 m` is not a finite number", ""),
        ("1e-400 m", Dimension::Length, "`1e-400 m` is not a finite number", ""),
    ];
    for (text, dimension, message, help) in cases {
        let error = parse_quantity(text, dimension).expect_err(text);
        assert_eq!((error.to_string().as_str(), error.help().unwrap_or_default().as_str()), (message, help), "{text}");
    }
    assert_eq!(
        parse_number("5 mm").expect_err("a unit").to_string(),
        "`5 mm` has a unit, but a dimensionless number is wanted"
    );
    for text in [".inf", "-.inf", "inf", "NaN"] {
        assert!(parse_number(text).expect_err(text).to_string().ends_with("is not a finite number"), "{text}");
    }
    // Nothing has no sign.
    for zero in [parse_number("-0"), parse_quantity("-0.0 m/s^2", Dimension::Acceleration)] {
        assert_eq!(zero.map(f64::to_bits), Ok(0));
    }
}

#[test]
pub(crate) fn all_mistakes_of_a_file_come_at_once_with_their_places() {
    let text = GOOD
        .replace("gap: 490.5 mm", "gap: 5 s")
        .replace("title: Limit stop\n", "titel: Limit stop\n")
        .replace("velocity_ratio, ceiling_impacts", "velocity_ratio, ceiling_impact")
        .replace("points: 61", "points: many")
        .replace("average: 100 cycles", "average: -1 cycles")
        .replace("band: spread", "band: wide");
    let problems = parse(&text).expect_err("six mistakes");
    assert_eq!(
        describe(&problems),
        [
            "1:1 an experiment has no key `titel` | did you mean `title`?",
            "8:12 `5 s` is not a length | write for example 5 mm",
            "13:51 `many` is not a number of points | write for example 25 points",
            "15:55 `-1 cycles` is not a number of cycles | write for example 25 cycles",
            "16:27 `ceiling_impact` is not a measure | did you mean `ceiling_impacts`?",
            "17:61 a band has no form `wide` | known are `spread`, `none`, `seeds`, `stacked`",
        ]
    );
    let plain = problems.to_string();
    let block = "\
error: `5 s` is not a length
  --> ch3-test.yaml:8:12
  |
8 |       gap: 5 s
  |            ^^^
  = write for example 5 mm
";
    assert!(plain.contains(block), "{plain}");
    let fancy = problems.fancy(false);
    assert!(fancy.contains("ch3-test.yaml:8:12") && !fancy.contains('\u{1b}'), "{fancy}");
    assert!(problems.fancy(true).contains('\u{1b}'));
}

#[test]
pub(crate) fn mistakes_that_a_person_makes_are_told_where_they_stand() {
    let cases = [
        (with("mass_ratio:", "mass_ration:"), "7:7 a damper has no key `mass_ration` | did you mean `mass_ratio`?"),
        (
            with("      floor", "      cieling: {rigid: {restitution: 0}}\n      floor"),
            "9:7 a damper has no key `cieling` | did you mean `ceiling`?",
        ),
        (with("      gap: 490.5 mm\n", ""), "7:7 a damper lacks `gap_ratio` or `gap`"),
        (
            with("gap: 490.5 mm", "gap: 490.5 mm\n      gap_ratio: 50"),
            "9:7 a damper has both `gap` and `gap_ratio`, of which one is wanted | keep one of the two",
        ),
        (with("mass: 1 kg", "mass: -1 kg"), "5:35 a mass above zero is wanted"),
        (
            with("solver: event_driven", "solver: [event_driven, {fixed_step: {time_step: 1 ms}}]"),
            "17:1 a line would run through the points of several solvers | add `solver` to `by`",
        ),
        (with("mass_ratio: 0.05", "mass_ratio: .nan"), "7:19 `.nan` is not a finite number"),
        (with("mass_ratio: 0.05", "mass_ratio: -0.05"), "7:19 this ratio cannot be negative"),
        (
            with("gap: 490.5 mm", "gap: -1 mm"),
            "8:12 a gap clearance cannot be -0.001 m (at force_ratio = 0.1, stop = with)",
        ),
        (
            with("damping_ratio: assumed", "damping_ratio: 5 mm"),
            "9:62 `5 mm` has a unit, but a dimensionless number is wanted | write the number alone",
        ),
        (with("mass: 1 kg, ", "mass: 1 kg, mass: 2 kg, "), "5:41 `mass` is given twice | keep one of the two"),
        (
            with("resilient: {stiff", "resiliant: {stiff"),
            "9:15 a surface has no form `resiliant` | did you mean `resilient`?",
        ),
        (with("[with, without]", "[with, maybe]"), "14:16 `maybe` is neither `with` nor `without`"),
        (with("stop: [with", "stp: [with"), "14:3 a sweep has no parameter `stp` | did you mean `stop`?"),
        (
            with("  stop: [with, without]", "  wall_stiffness_ratio: [1, 2]").replace("by: stop", "by: solver"),
            "14:3 `wall_stiffness_ratio` is swept, but the scene has no soft walls (at force_ratio = 0.1, wall_stiffness_ratio = 1)",
        ),
        (
            with("  force_ratio: {log: {from: 0.1, to: 100, points: 61}}\n", "")
                .replace("x: force_ratio", "x: velocity_ratio"),
            "11:45 nothing sweeps `force_ratio` | add `force_ratio` to `sweep`, or give it a value here",
        ),
        (
            with("x: force_ratio", "x: force_ratios"),
            "17:13 the table of this experiment has no column `force_ratios` | did you mean `force_ratio`?",
        ),
        (
            with("y: velocity_ratio", "y: base_velocity"),
            "17:29 `base_velocity` is a time history, and this experiment keeps none | add `trace: {from: … cycles, to: … cycles, samples_per_cycle: …}`",
        ),
        (with("x: force_ratio", "x: stop"), "17:13 `stop` holds words: it cannot be an axis"),
        (
            with("measure: [velocity_ratio,", "measure: [last_peak, velocity_ratio,"),
            "16:11 `last_peak` is read off a time history, and this experiment keeps none | add `trace: {from: … cycles, to: … cycles, samples_per_cycle: …}`",
        ),
        (
            format!("{GOOD}maximise: {{velocity_ratio: {{over: force_ratio, in: [1, 2]}}}}\n"),
            "13:3 `force_ratio` is swept and maximised over at once | take it out of `sweep`",
        ),
        (
            format!("{GOOD}onset: {{velocity_ratio: {{over: force_ratio, in: [1, 2]}}}}\n"),
            "18:1 `velocity_ratio` has no onset: it is no number of events | events are counted by separations, floor_impacts, ceiling_impacts, stop_impacts",
        ),
        (
            format!("{GOOD}onset: {{separations: {{over: force_ratio, in: [2]}}}}\n"),
            "18:1 an onset lies between two values of a parameter that varies smoothly",
        ),
        (
            with("solver: event_driven", "solver: {fixed_step: {time_step: 1 s}}"),
            "15:7 a time step of 1 s is longer than the forcing period of 0.19869176531592203 s (at force_ratio = 0.1, stop = with)",
        ),
        (
            with("impulse_train: {", "pulse_train: {shape: rectangular, duration: 1 s, "),
            "11:60 a pulse of 1 s does not fit into a forcing period of 0.19869176531592203 s (at force_ratio = 0.1, stop = with)",
        ),
        (with("from: 0.1, to", "from: 0, to"), "13:29 a logarithmic range starts above zero"),
        (
            with("force_ratio: {log: {from: 0.1, to: 100, points: 61}}", "force_ratio: []"),
            "13:3 this sweep is empty: give it at least one value",
        ),
        (
            with(
                "force_ratio: {log: {from: 0.1, to: 100, points: 61}}",
                "force_ratio: [1, {linear: {from: 2, to: 4, points: 3}}, 3]",
            ),
            "13:3 a value stands here twice: two rows would be the same",
        ),
        ("title: [\n".into(), "1:8 this is no YAML: unclosed bracket '['"),
        (String::new(), "1:1 the file is empty"),
        (
            "- a list\n".into(),
            "1:1 an experiment is written as keys with values, not as a list | write `key: value` lines below it, or {key: value, key: value}",
        ),
        (
            format!("{GOOD}---\ntitle: second\n"),
            "18:1 a second document starts here | one file holds one document: remove the `---`",
        ),
    ];
    for (text, expected) in cases {
        assert_eq!(only_problem(&text), expected, "\n{text}");
    }
}

#[test]
pub(crate) fn yaml_from_strangers_is_refused_before_anything_grows() {
    let mut bomb = String::from("a: &a [x, x, x, x, x, x, x, x, x]\n");
    for (name, before) in ('b'..='z').zip('a'..) {
        bomb += &format!("{name}: &{name} [{}]\n", vec![format!("*{before}"); 9].join(", "));
    }
    let problems = parse(&bomb).expect_err("an alias bomb");
    assert!(problems.list.iter().any(|problem| problem.message == "aliases (`*name`) are not accepted"), "{problems}");
    assert_eq!(
        only_problem(&with("title: Limit stop", "title: Limit stop\n<<: {about: Elsewhere.}")),
        "2:1 merge keys (`<<`) are not accepted | write out the keys that it stands for"
    );

    for deep in
        ["[".repeat(100_000), "{a: ".repeat(100_000), (0..5_000).map(|i| format!("{}a:\n", " ".repeat(i))).collect()]
    {
        assert!(parse(&deep).is_err());
    }
    let escape = parse(&with("title: Limit stop", "title: \"\\e[2J\"\n\"\\e[2K\": 1")).expect_err("terminal commands");
    assert_eq!(escape.list.len(), 2);
    assert!(!format!("{escape}{}", escape.fancy(false)).contains('\u{1b}'));
    let many_mistakes = with("[velocity_ratio, ceiling_impacts]", &format!("[{}]", "velocity, ".repeat(100_000)));
    assert_eq!(parse(&many_mistakes).expect_err("no measure of that name").list.len(), 100);
    let keys: String = (0..100_000).map(|i| format!("a{i}: 1\n")).collect();
    assert_eq!(only_problem(&keys), "1001:1 more than 1000 keys in one place");
    assert_eq!(only_problem(&"#\n".repeat(1 << 20)), "1:1 the file has 2048 KiB; at most 1024 KiB are read");
    let sweep = |range: &str| only_problem(&with("{log: {from: 0.1, to: 100, points: 61}}", range));
    assert_eq!(
        sweep("{log: {from: 0.1, to: 100, points: 1000000000}}"),
        "13:51 1000000000 is too many: 100000 at most"
    );
    assert_eq!(
        sweep("{step: {from: 0, to: 1, step: 1e-9}}"),
        "13:46 1.0e9 points are too many: 100000 at most | widen the step, or split the experiment"
    );
    let many = "{linear: {from: 1, to: 2, points: 90000}}";
    assert_eq!(
        sweep(many),
        "12:1 180000 points are too many: 100000 at most | widen the step, or split the experiment"
    );
    assert!(sweep(&format!("[{}]", [many; 50].join(", "))).contains("points are too many"));

    for id in ["../etc/passwd", "..", "", "a/b", "a\\b", "Ch3", "a b", "-x", "ch3.yaml", "ä"] {
        assert!(id.parse::<ExperimentId>().is_err(), "{id}");
    }
    let id = |length: usize| "a".repeat(length).parse::<ExperimentId>();
    assert!(id(64).is_ok() && id(65).unwrap_err().to_string().contains("65 characters, 64 are the most"));
    let folder = tempfile::tempdir().unwrap();
    let place = |name: &str| folder.path().join(name);
    std::fs::write(place("not an id.yaml"), GOOD).unwrap();
    std::fs::write(place("long.yaml"), "#".repeat(2 << 20)).unwrap();
    std::fs::write(place("binary.yaml"), b"title: \xff\n").unwrap();
    for (name, expected) in [
        (
            "not an id.yaml",
            "`not an id` is not an id: lower-case letters, digits and hyphens, such as `ch3-limit-stop` | rename the file",
        ),
        ("long.yaml", "has 2048 KiB; at most 1024 KiB are read"),
        ("binary.yaml", "is not UTF-8 text: line 1, column 8 holds the byte 0xff; save the file as UTF-8"),
    ] {
        assert_eq!(describe(&load_experiment(&place(name), &assumptions()).expect_err(name)), [expected]);
    }
    assert!(load_experiment(&place("absent.yaml"), &assumptions()).is_err());
}

#[test]
pub(crate) fn a_damaged_file_is_told_and_never_a_crash() {
    let ends: Vec<usize> = GOOD.char_indices().map(|(index, _)| index).collect();
    let mut description = 0;
    for end in ends.into_iter().step_by(5) {
        for damage in ["", "{", "é", "\n", "\u{0}"] {
            let whole = &GOOD[end + 1..];
            for rest in [whole, ""] {
                if let Err(problems) = parse(&format!("{}{damage}{rest}", &GOOD[..end])) {
                    description += usize::from(!problems.to_string().is_empty() && !problems.fancy(false).is_empty());
                }
            }
        }
    }
    assert!(description > 1_000, "{description}");
}

#[test]
pub(crate) fn a_refined_range_starts_evenly_and_says_what_it_lacks() {
    let range = "{log: {from: 0.1, to: 100, points: 61}}";
    let refined = |inside: &str| with(range, &format!("{{refined: {{from: 0.1, to: 100{inside}}}}}"));
    let experiment = good(&refined(", start: 31 points, spacing: log, tolerance: 0.5 %, of: velocity_ratio"));
    assert_eq!(experiment.cases.len(), 62);
    let [rule] = experiment.refined.as_slice() else { panic!("{:?}", experiment.refined) };
    assert_eq!((rule.over, rule.tolerance, rule.most), (Parameter::ForceRatio, 0.005, 600));
    assert_eq!(experiment.cases[20].get(Parameter::ForceRatio), Some(ParameterValue::Number(1.0)));
    for (inside, message) in [
        (", tolerance: 0 %", "a share between nothing and the whole is wanted here | write for example 1 %"),
        (", start: 3", "five points at least show where a curve bends"),
        (", of: separations", "`separations` is refined, but not measured | add `separations` to `measure`"),
        (", most: 1000000", "1000000 is too many: 20000 at most"),
    ] {
        let description = only_problem(&refined(inside));
        assert!(description.ends_with(message) && description.starts_with("13:"), "{description}");
    }
    let two = with("  stop: [with, without]\n", "  gap_ratio: {refined: {from: 1, to: 9}}\n")
        .replace("by: stop", "by: gap_ratio");
    let two = two.replace(range, "{refined: {from: 1, to: 2}}");
    assert!(only_problem(&two).ends_with("one parameter of a sweep is refined, not two"));
}

#[test]
pub(crate) fn sweeps_are_products_pairs_points_and_unions() {
    let sweep = "  force_ratio: {log: {from: 0.1, to: 100, points: 61}}\n  stop: [with, without]\n";
    let cases = |text: &str, by: &str| {
        let mut experiment = with(sweep, text).replace("by: stop", by);
        for (key, stated) in [("mass_ratio", "mass_ratio: 0.05"), ("gap_ratio", "gap: 490.5 mm")] {
            if text.contains(key) {
                experiment = experiment.replace(stated, &format!("{key}: swept"));
            }
        }
        let experiment = good(&experiment);
        let description: Vec<_> =
            experiment.cases.iter().map(|case| format!("{}:{}", case.sweep, case.describe())).collect();
        (experiment, description)
    };
    let (_, description) =
        cases("  paired: {force_ratio: [1, 2], mass_ratio: [0.1, 0.2]}\n  stop: [with, without]\n", "by: stop");
    assert_eq!(
        description,
        [
            ":force_ratio = 1, mass_ratio = 0.1, stop = with",
            ":force_ratio = 1, mass_ratio = 0.1, stop = without",
            ":force_ratio = 2, mass_ratio = 0.2, stop = with",
            ":force_ratio = 2, mass_ratio = 0.2, stop = without",
        ]
    );
    let (_, description) =
        cases("  points: [{force_ratio: 1, gap_ratio: infinite}, {force_ratio: 3, gap_ratio: 5}]\n", "by: gap_ratio");
    assert_eq!(description, [":force_ratio = 1, gap_ratio = infinite", ":force_ratio = 3, gap_ratio = 5"]);
    let (experiment, description) = cases(
        "  union:
    low: {force_ratio: [{linear: {from: 0.1, to: 0.3, points: 3}}, {step: {from: 0.3, to: 0.5, step: 0.1}}]}
    high: {force_ratio: [7], stop_length: [5 mm], solver: {fixed_step: {time_step: 0.1 ms}}}
",
        "by: [sweep, solver]",
    );
    let low = ["0.1", "0.2", "0.3", "0.4", "0.5"].map(|x| format!("low:force_ratio = {x}"));
    assert_eq!(description[0], "high:force_ratio = 7, stop_length = 0.005 m");
    assert_eq!(description[1..], low);
    let labels: Vec<_> = experiment.runs().map(|(_, solver)| solver.label()).collect();
    assert_eq!(labels[..2], ["fixed_step_1e-4s", "event_driven"]);
    assert_eq!(experiment.solvers, [SolverChoice::FixedStep { time_step: 1e-4 }, SolverChoice::EventDriven]);

    let union =
        with(sweep, "  union:\n    a: {force_ratio: [1]}\n    b: {stop: [with]}\n").replace("by: stop", "by: sweep");
    assert_eq!(
        only_problem(&union),
        "11:45 the sweep `b` leaves `force_ratio` out | give the value here that those cases shall have"
    );
    let paired = with(sweep, "  paired: {force_ratio: [1, 2], mass_ratio: [1]}\n").replace("by: stop", "by: solver");
    assert_eq!(only_problem(&paired), "13:33 paired ranges are of equal length: 1 values here, 2 in the first");
}

#[test]
fn a_percentage_is_the_decimal_that_it_says() {
    for (percent, decimal) in [("0.7 %", "0.007"), ("1 %", "0.01"), ("55.6%", "0.556"), ("1e1 %", "0.1")] {
        let [a, b] = [percent, decimal]
            .map(|share| good(&with("measure: [", &format!("tolerances: {{gap: {share}}}\nmeasure: ["))).tolerances);
        assert_eq!(a, b, "{percent}");
    }
}

#[test]
fn a_binomial_pulse_lasts_whole_milliseconds() {
    let train = "impulse_train: {force_ratio: swept, frequency_ratio: 1}";
    let pulses = |shape: &str, duration: &str| {
        let pulses =
            format!("pulse_train: {{shape: {shape}, duration: {duration}, force_ratio: swept, frequency_ratio: 1}}");
        with(train, &pulses)
    };
    for (duration, impulses) in [("1 ms", 1), ("10 ms", 10), ("0.1 s", 100), ("29 ms", 29)] {
        let read = good(&pulses("binomial", duration));
        let scene = read.recipe_of(&read.cases[0]).unwrap().resolve(&assumptions()).unwrap();
        let Excitation::PulseTrain { shape, .. } = scene.excitation else { panic!("{duration}") };
        assert_eq!(shape, PulseShape::Binomial { impulses }, "{duration}");
    }
    let refused = "a binomial pulse has impulses at 0, 1 ms, 2 ms, …: its duration is a whole number of milliseconds";
    for duration in ["0.4 ms", "2.5 ms", "1.000001 ms"] {
        let problem = only_problem(&pulses("binomial", duration));
        assert!(problem.starts_with("11:") && problem.contains(refused), "{duration}: {problem}");
        good(&pulses("rectangular", duration));
    }
    let swept = pulses("binomial", "swept").replace("  stop: [", "  pulse_duration: [2 ms, 2.5 ms]\n  stop: [");
    let problem = only_problem(&swept.replace("by: stop", "by: [stop, pulse_duration]"));
    assert!(problem.contains(refused) && problem.contains("pulse_duration = 0.0025"), "{problem}");
}

#[test]
pub(crate) fn what_is_read_off_a_time_history_or_a_shape_is_refused_without_one() {
    for measure in Measure::ALL.iter().filter(|measure| measure.needs_trace()) {
        let name = words::of_key(measure);
        let problem = only_problem(&with("ceiling_impacts]", &format!("{name}]")));
        assert!(problem.starts_with(&format!("16:27 `{name}` is read off a time history")), "{problem}");
    }
    let problem = only_problem(&with("ceiling_impacts]", "mac]"));
    assert!(problem.starts_with("16:27 `mac` is read off a shape"), "{problem}");
    let problem = only_problem(&with("ceiling_impacts]", "displacement_per_force]"));
    assert_eq!(problem, "16:27 `displacement_per_force` is measured under a harmonic force, not under this excitation");
}

#[test]
pub(crate) fn each_assumption_has_a_reason_and_moves_alone() {
    let sheet = load_assumptions(&folder().join("assumptions.yaml")).unwrap_or_else(|problems| panic!("{problems}"));
    for (name, entry) in sheet.iter() {
        assert!(entry.reason.len() > 20, "{name:?}");
    }
    let variants = sheet.variants(&BTreeSet::from(["stop_length", "undamped_mass"].map(AssumptionName::from)));
    let labels: Vec<_> = variants.iter().map(|moved| moved.label.as_str()).collect();
    assert_eq!(labels, ["stop_length=0.045", "stop_length=0.054", "undamped_mass=base"]);
    let baseline = sheet.assumptions();
    for moved in &variants {
        let values = &moved.assumptions.values;
        let differing = baseline.values.iter().filter(|(name, value)| values[*name] != **value).count();
        assert_eq!((differing, values.len()), (1, baseline.values.len()));
    }
    assert_eq!(variants[0].assumptions.values[&AssumptionName::from("stop_length")], AssumptionValue::Number(0.045));
}

#[test]
pub(crate) fn an_assumption_is_declared_with_its_kind_and_stands_only_where_that_fits() {
    let text = "\
stop: {quantity: length, value: 5 s, reason: none}
mass: {readings: [base, loaded], value: heavy, reason: none}
share: {value: 1, reason: none}
gap: {quantity: lenght, value: 1 mm, reason: none}
";
    let problems = parse_assumptions("assumptions.yaml", text).expect_err("mistakes");
    assert_eq!(
        describe(&problems),
        [
            "1:33 `5 s` is not a length | write for example 5 mm",
            "2:41 this assumption has no reading `heavy` | known are `base`, `loaded`",
            "3:1 this assumption has no kind | add `quantity: …`, one of ratio, count, damping_curve, places, length, mass, time, force, impulse, stiffness, damping, velocity, \
             acceleration, angular_frequency, stress, density, or `readings: [one, other]`",
            "4:17 `lenght` is not a kind of quantity | did you mean `length`?",
        ]
    );
    let text = "\
stop: {quantity: length, value: 5 mm, reason: none}
defaults: {gravty: stop, stop_restitution: sotp, stop_length: {single_mas: stop}, take: stop}
";
    let problems = parse_assumptions("assumptions.yaml", text).expect_err("mistakes");
    assert_eq!(
        describe(&problems),
        [
            "2:12 `gravty` is not a slot of a scene | did you mean `gravity`?",
            "2:44 `sotp` is not an assumption | did you mean `stop`?",
            "2:64 `single_mas` is not a structure | did you mean `single_mass`?",
            "2:89 `take` takes one of largest, mean, but the assumption `stop` (experiments/assumptions.yaml, line 1) is a \
             length",
        ]
    );

    let sheet = parse_assumptions(
        "assumptions.yaml",
        "\
# The first line says nothing.
length: {quantity: length, value: 60 mm, range: [50 mm], reason: none}
zeta: {quantity: ratio, readings: [equivalent_viscous], value: 0.1, reason: none}
",
    )
    .unwrap_or_else(|problems| panic!("{problems}"));
    let read = |text: &str| parse_experiment(&"ch3-test".parse().unwrap(), "ch3-test.yaml", text, &sheet.assumptions());
    let stated = with("damping_ratio: assumed", "damping_ratio: {assumed: zeta}").replace("60 mm", "{assumed: length}");
    let experiment = read(&stated).unwrap_or_else(|problems| panic!("{problems}"));
    let used = experiment.assumptions_used(&sheet);
    assert_eq!(used, BTreeSet::from(["length", "zeta"].map(AssumptionName::from)), "whatever they are called");

    let one = |text: &str| describe(&read(text).expect_err("a mistake")).remove(0);
    assert_eq!(
        one(&stated.replace("assumed: length", "assumed: lenght")),
        "10:32 `lenght` is not an assumption | did you mean `length`?"
    );
    assert_eq!(
        one(&stated.replace("assumed: length", "assumed: zeta")),
        "10:32 `stop_length` takes a length, but the assumption `zeta` (experiments/assumptions.yaml, line 3) is a \
         dimensionless number or one of equivalent_viscous"
    );
    assert_eq!(
        one(&GOOD.replace("60 mm", "{assumed: length}")),
        "9:62 no assumption stands for `damping_ratio` on a single mass | write a value, or `{assumed: NAME}`, or declare an \
         assumption under `defaults: damping_ratio` in experiments/assumptions.yaml"
    );
    assert_eq!(
        one(&stated.replace("assumed: length", "assumed: clearance")),
        "10:32 `clearance` is not an assumption | declare it in experiments/assumptions.yaml: `clearance: {quantity: …, \
         value: …, reason: …}`"
    );
    let words = "word: {readings: [equivalent_viscous], value: equivalent_viscous, reason: none}\n";
    let sheet = parse_assumptions("assumptions.yaml", words).unwrap_or_else(|problems| panic!("{problems}"));
    let needed = with("damping_ratio: assumed", "damping_ratio: {assumed: word}");
    let one = |text: &str| {
        let read = parse_experiment(&"ch3-test".parse().unwrap(), "ch3-test.yaml", text, &sheet.assumptions());
        describe(&read.expect_err("a mistake")).remove(0)
    };
    let said = one(&needed);
    assert!(
        said.contains(" equivalent viscous damping needs `damping_curve`")
            && said.starts_with("9:")
            && said.contains(
                "declare an assumption for it under `defaults: damping_curve` in experiments/assumptions.yaml"
            ),
        "{said}"
    );
    // A damping in N s/m takes the word as a damping ratio does, and asks for the curve.
    let curve = "{acceleration_ratio: [0.5, 5], damping: [1 N s/m, 2 N s/m]}";
    let words = format!(
        "dashpot: {{quantity: damping, readings: [equivalent_viscous], value: 3 N s/m, range: [equivalent_viscous], reason: a}}\n\
         curve: {{quantity: damping_curve, value: {curve}, reason: b}}\n\
         half: {{quantity: damping, readings: [by_half_cycles], value: 1 N s/m, reason: c}}\n"
    );
    let assumed = with("damping_ratio: assumed", "damping: {assumed: dashpot}");
    let damping = |defaults: &str, value: &str| {
        let text = format!("{}{defaults}", words.replace("value: 3 N s/m", &format!("value: {value}")));
        let sheet = parse_assumptions("assumptions.yaml", &text).unwrap_or_else(|problems| panic!("{problems}"));
        let assumptions = sheet.assumptions();
        let read = parse_experiment(&"a".parse().unwrap(), "a.yaml", &assumed, &assumptions)?;
        let scene = read.recipe_of(&read.cases[0]).unwrap().resolve(&assumptions).unwrap();
        let Surface::Resilient { damping, .. } = scene.dampers[0].floor.clone() else { panic!("a resilient floor") };
        Ok::<_, Problems>(damping)
    };
    let with_curve = "defaults: {damping_curve: curve}\n";
    assert_eq!(damping(with_curve, "3 N s/m").unwrap(), ContactDamping::Constant(3.0));
    let by_half_cycles = ContactDamping::EquivalentViscous(vec![[0.5, 1.0], [5.0, 2.0]]);
    assert_eq!(damping(with_curve, "equivalent_viscous").unwrap(), by_half_cycles);
    let said = describe(&damping("", "equivalent_viscous").expect_err("no curve")).remove(0);
    assert!(said.starts_with("9:") && said.contains("equivalent viscous damping needs `damping_curve`"), "{said}");
    let sheet = parse_assumptions("assumptions.yaml", &words).unwrap_or_else(|problems| panic!("{problems}"));
    let other = assumed.replace("assumed: dashpot", "assumed: half");
    let wrong = parse_experiment(&"a".parse().unwrap(), "a.yaml", &other, &sheet.assumptions()).expect_err("a mistake");
    assert_eq!(
        describe(&wrong),
        ["9:66 this key takes a damping constant or one of equivalent_viscous, but the assumption `half` \
             (experiments/assumptions.yaml, line 3) is a damping constant or one of by_half_cycles"]
    );
    // A study without assumptions has the general values: standard gravity, J = f′ m g/ω, the run without damper clean.
    let bare = with("damping_ratio: assumed", "damping_ratio: 0.15");
    // How long a run is has none.
    let open = bare.replace("skip: 25 cycles, average: 100 cycles, ", "");
    let problems = parse_experiment(&"a".parse().unwrap(), "a.yaml", &open, &Assumptions::default()).expect_err("open");
    let help = "write `run: {skip: 25 cycles, average: 100 cycles}`, here or, for all experiments, under `defaults` in the \
                assumptions file";
    let lacks = |key: &str| format!("15:1 a run lacks `{key}`, and the study has no default for it | {help}");
    assert_eq!(describe(&problems), [lacks("skip"), lacks("average")]);
    let experiment = parse_experiment(&"a".parse().unwrap(), "a.yaml", &bare, &Assumptions::default())
        .unwrap_or_else(|problems| panic!("{problems}"));
    assert!(experiment.assumptions_used(&AssumptionSheet::default()).is_empty());
    let recipe = experiment.recipe_of(&experiment.cases[41]).unwrap();
    let scene = recipe.resolve(&Assumptions::default()).unwrap();
    assert_eq!(scene.gravity, 9.80665);
    let Excitation::ImpulseTrain { impulse, .. } = scene.excitation else { panic!("{scene:?}") };
    assert!((impulse - 9.80665 / 1000_f64.sqrt()).abs() < 1e-15, "{impulse}");
}

#[test]
fn cycles_that_are_left_out_may_be_an_assumption() {
    let sheet = |value: &str| {
        let text = format!("before: {{quantity: count, value: 100, range: [{value}], reason: a}}\n");
        parse_assumptions("assumptions.yaml", &text).unwrap_or_else(|problems| panic!("{problems}"))
    };
    let bare = with("damping_ratio: assumed", "damping_ratio: 0.15");
    let run = |keys: &str| bare.replace("skip: 25 cycles, average: 100 cycles", keys);
    let read =
        |text: &str, value: &str| parse_experiment(&"a".parse().unwrap(), "a.yaml", text, &sheet(value).assumptions());

    let assumed =
        read(&run("skip: {assumed: before}, to: 125 cycles"), "25").unwrap_or_else(|problems| panic!("{problems}"));
    let stated = read(&run("skip: 100 cycles, to: 125 cycles"), "25").unwrap_or_else(|problems| panic!("{problems}"));
    assert_eq!(assumed.settings, stated.settings);
    assert_eq!((stated.settings.skip, stated.settings.average), (100, 25));
    let used = assumed.assumptions_used(&sheet("25"));
    assert_eq!(used, BTreeSet::from([AssumptionName::from("before")]));
    assert!(stated.assumptions_used(&sheet("25")).is_empty());
    let [moved] = &sheet("25").variants(&used)[..] else { panic!("one other value") };
    let settings = assumed.settings_under(&moved.assumptions);
    assert_eq!((settings.skip, settings.average), (25, 100), "up to the same cycle");
    assert_eq!(stated.settings_under(&moved.assumptions), stated.settings);

    let one = |keys: &str, value: &str| describe(&read(&run(keys), value).expect_err("a mistake")).remove(0);
    for (keys, value, message) in [
        ("skip: {assumed: before}", "25", "cycles that an assumption leaves out need `to`, the last one"),
        ("skip: {assumed: before}, to: 100 cycles", "25", "`before` may be 100: of 100 cycles no whole number is left"),
        (
            "skip: {assumed: before}, to: 125 cycles",
            "125",
            "`before` may be 125: of 125 cycles no whole number is left",
        ),
        ("skip: {assumed: befor}, to: 125 cycles", "25", "`befor` is not an assumption | did you mean `before`?"),
        ("skip: 125 cycles, to: 125 cycles", "25", "125 cycles are left out: none is left up to cycle 125"),
        ("skip: 5 cycles, average: 9 cycles, to: 14 cycles", "25", "`average` and `to` say the same thing"),
    ] {
        let said = one(keys, value);
        assert!(said.starts_with("15:") && said.contains(message), "{keys}: {said}");
    }
    let length = "before: {quantity: length, value: 1 m, reason: a}\n";
    let length = parse_assumptions("assumptions.yaml", length).unwrap_or_else(|problems| panic!("{problems}"));
    let text = run("skip: {assumed: before}, to: 125 cycles");
    let wrong = parse_experiment(&"a".parse().unwrap(), "a.yaml", &text, &length.assumptions()).expect_err("a mistake");
    assert!(describe(&wrong)[0].contains("`skip` takes a whole number"), "{:?}", describe(&wrong));
}

/// What an experiment depends on holds whichever value of its range an assumption takes.
#[test]
fn no_variant_depends_on_more_than_is_recorded() {
    let sheet = sheet();
    let mut variants = 0;
    for chapter in std::fs::read_dir(folder()).unwrap().map(|entry| entry.unwrap().path()).filter(|path| path.is_dir())
    {
        for file in std::fs::read_dir(chapter).unwrap() {
            let experiment = load_experiment(&file.unwrap().path(), &sheet.assumptions()).unwrap();
            let used = experiment.assumptions_used(&sheet);
            let in_force = sheet.assumptions();
            let each = experiment.cases.iter().map(|case| experiment.recipe_of(case).unwrap());
            let all = experiment.assumptions_of(each, &in_force);
            assert_eq!(
                experiment.assumptions_under(&in_force),
                all,
                "{}: one case of each kind reads less than all",
                experiment.id
            );
            for moved in sheet.variants(&used) {
                let under = experiment.assumptions_under(&moved.assumptions);
                assert!(under.is_subset(&used), "{} under {}: {under:?}", experiment.id, moved.label);
                variants += 1;
            }
        }
    }
    assert!(variants > 200, "{variants}");
}

#[test]
pub(crate) fn a_damping_curve_is_refused_where_its_mistake_stands() {
    const CURVE: &str = "\
curve:
  quantity: damping_curve
  value:
    acceleration_ratio: [0.7, 2, 3.5, 5]
    damping: [1 N s/m, 3 N s/m, 4 N s/m, 2 N s/m]
  reason: none
";
    let problem = |old: &str, new: &str| {
        let problems = parse_assumptions("assumptions.yaml", &CURVE.replace(old, new)).expect_err("a mistake");
        describe(&problems).remove(0)
    };
    assert!(parse_assumptions("assumptions.yaml", CURVE).is_ok());
    for (old, new, told) in [
        // A gap.
        (
            "2, 3.5, 5]",
            "2, 5]",
            "4:5 a curve has one damping for each acceleration, and two points at least; here are 3",
        ),
        ("3 N s/m, ", "~, ", "5:24 a single value is wanted here, not nothing"),
        ("3 N s/m, ", "'', ", "5:24 "),
        // Negative.
        ("3 N s/m", "-3 N s/m", "5:24 a damping constant above zero is wanted"),
        ("3 N s/m", "0 N s/m", "5:24 a damping constant above zero is wanted"),
        ("0.7", "-0.7", "4:26 this ratio cannot be negative"),
        // Unsorted, or twice.
        ("2, 3.5", "3.5, 2", "4:36 the accelerations of a curve increase, and 2 follows 3.5"),
        ("2, 3.5", "2, 2", "4:34 the accelerations of a curve increase, and 2 follows 2"),
        // Units mixed.
        ("3 N s/m", "3", "5:24 `3` has no unit, but a damping constant is wanted"),
        ("3 N s/m", "3 N/m", "5:24 `3 N/m` is not a damping constant"),
        ("2, 3.5", "2 m/s^2, 3.5", "4:31 `2 m/s^2` "),
        ("4 N s/m", "infinite", "5:33 `infinite` is not "),
        // A spline that falls below zero between points that do not.
        (
            "1 N s/m, 3 N s/m, 4 N s/m, 2 N s/m",
            "9 N s/m, 0.1 N s/m, 0.1 N s/m, 9 N s/m",
            "5:35 the spline through this curve falls to ",
        ),
    ] {
        let said = problem(old, new);
        assert!(said.starts_with(told), "{said}, expected {told}");
    }
    // The same where a scene states its own.
    let inline = "damping_ratio: 0.15, damping_curve: {acceleration_ratio: [1, 2, 3, 4], damping: [9 N s/m, \
                  0.1 N s/m, 0.1 N s/m, 9 N s/m]}";
    let said = only_problem(&with("damping_ratio: assumed", inline));
    assert!(said.starts_with("9:") && said.contains("the spline through this curve falls to"), "{said}");
}

#[test]
pub(crate) fn every_shipped_experiment_loads_and_resolves_under_every_variant() {
    let sheet = sheet();
    let mut ids = BTreeSet::new();
    let mut fixed_steps = 0.0;
    for file in std::fs::read_dir(folder().join("ch3")).unwrap() {
        let path = file.unwrap().path();
        let experiment = load_experiment(&path, &sheet.assumptions()).unwrap_or_else(|problems| panic!("{problems}"));
        assert!(!experiment.figures.is_empty() && experiment.source.chapter == Some(3), "{}", experiment.id);
        for moved in sheet.variants(&experiment.assumptions_used(&sheet)) {
            assert!(load_experiment(&path, &moved.assumptions).is_ok(), "{} under {}", experiment.id, moved.label);
        }
        let points = experiment.maximise.as_ref().map_or(1, |maximise| maximise.grid.len());
        for (case, solver) in experiment.runs() {
            if let SolverChoice::FixedStep { time_step } = solver {
                let scene = experiment.recipe_of(case).unwrap().resolve(&sheet.assumptions()).unwrap();
                let cycles = f64::from(experiment.settings.skip + experiment.settings.average);
                fixed_steps += scene.excitation.period() / time_step * cycles * points as f64;
            }
        }
        ids.insert(experiment.id.to_string());
    }
    assert_eq!(
        ids.len(),
        34,
        "26 of the study, the motion at two gap clearances, its kind, its branches, what coexists with its shares, a design, what it \
         depends on, and where the ceiling is met: {ids:?}"
    );
    // At some 15 ns a step: half a minute of one core.
    assert!(fixed_steps < 2e9, "{fixed_steps:e} fixed steps");
}

#[test]
pub(crate) fn the_studys_words_become_the_scene_they_mean() {
    let load = |id: &str| {
        let path = folder().join("ch3").join(format!("{id}.yaml"));
        load_experiment(&path, &assumptions()).unwrap_or_else(|problems| panic!("{problems}"))
    };
    let scene = |experiment: &Experiment, index: usize| {
        experiment.recipe_of(&experiment.cases[index]).unwrap().resolve(&assumptions()).unwrap()
    };
    let duncan = load("ch3-duncan-gap");
    let first = scene(&duncan, 0);
    assert!(matches!(first.dampers[0].floor, Surface::Rigid { restitution: 0.0 }));
    let Excitation::Harmonic { force, .. } = first.excitation else { panic!("{first:?}") };
    assert!((force + 0.01 * 9.81).abs() < 1e-15, "F = −m a ω²: {force}");
    assert!(duncan.cases.iter().enumerate().any(|(i, _)| scene(&duncan, i).dampers[0].gap.is_infinite()));

    let walls = load("ch3-wall-stiffness");
    let hard = walls.cases.iter().position(|case| case.sweep == "model_2").unwrap();
    assert!(scene(&walls, hard).dampers[0].walls.is_none(), "walls that do not give are Model 2");

    let favourable = scene(&load("ch3-favourable-impact"), 0);
    assert!((favourable.excitation.period() - 0.371).abs() < 5e-4, "the impulse of t = 52.31 s is the 141st");
}

/// What a mistaken experiment is answered.
fn refusal(text: &str) -> String {
    let desk = crate::desk::Desk::of_one("experiments/ch3/ch3-long.yaml", text);
    crate::desk::shotdamp(&desk, &["show", "ch3-long"]).err
}

#[test]
fn a_mistake_is_answered_with_what_to_write() {
    use crate::desk::THREE_GAPS;
    let said = refusal(&THREE_GAPS.replace("mass_ratio: 0.05,", "mass_ratio: {asumed: zeta},"));
    assert!(said.contains("did you mean `assumed`?"), "{said}");
    // Between braces the comma ends the value, unless there are quotes around it.
    for mass in ["1,5 kg", "\"1,5 kg\""] {
        let said = refusal(&THREE_GAPS.replace("mass: 1 kg", &format!("mass: {mass}")));
        assert!(said.contains("write a decimal point"), "{said}");
    }
    let said = refusal(&THREE_GAPS.replace("mass: 1 kg", "mass: -1 kg"));
    assert!(said.contains("a mass above zero is wanted"), "{said}");
    let said = refusal(&THREE_GAPS.replace("frequency_ratio: 1", "angular_frequency: 30 rpm"));
    assert!(said.contains("`rpm` is not a unit") && said.contains("write for example 31.6 rad/s or 5.03 Hz"), "{said}");
    let said = refusal(&THREE_GAPS.replace("ensemble: none", "ensemble: none, limit: {events: 1e30}"));
    assert!(said.contains("a whole number of events from 1 to 1e15"), "{said}");
    let said = refusal(&THREE_GAPS.replace("sensitivity: none", "sensitivity: [stop_length]"));
    assert!(said.contains("this experiment does not depend on `stop_length`") && said.contains("`gravity`"), "{said}");
    let plate = THREE_GAPS
        .replace(
            "{single_mass: {mass: 1 kg, stiffness: 1000 N/m, damping_ratio: 0.05}}",
            "{supported_plate: {length: 1 m, width: 1 m, thickness: 8 mm, youngs_modulus: 69 GPa, poisson_ratio: 0.33, density: 2700 kg/m^3, rayleigh: 5e-5, modes: [2, 2]}}",
        )
        .replace("[{mass_ratio: 0.05, gap_ratio: swept,", "[{at: [0.5, 0.5], mass_ratio: 0.05, particle_share: 0.5, gap_ratio: 10,")
        .replace("{harmonic: {force_ratio: 5,", "{impulse_train: {at: [0.25, 0.375], impulse: 1 N s,")
        .replace("sweep: {gap_ratio: [10, 50, 90]}", "sweep: {damper_x: [0.3, 0.5]}");
    let said = refusal(&plate);
    assert!(said.contains("write `at: [swept, 0.5]`"), "{said}");
    let said = refusal(&plate.replace("{at: [0.5, 0.5], mass", "{at: [swept, 0.5], mass"));
    assert!(!said.contains("swept"), "{said}");
}
