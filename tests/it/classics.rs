//! The verification study in `examples/classics`: a study in YAML alone, without assumptions, whose answers are known.

use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

use shotdamp::experiment::{Assumptions, ExperimentId, parse_experiment};
use shotdamp::reference::{Check, Verdict, load_reference};
use shotdamp::table::parquet;

fn study() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("examples/classics")
}

/// A file of an experiment with one piece of text exchanged, and what is said about it.
fn complaint(id: &str, from: &str, to: &str) -> String {
    complaint_of(id, &[(from, to)])
}

fn complaint_of(id: &str, exchanged: &[(&str, &str)]) -> String {
    let path = study().join(format!("experiments/{id}.yaml"));
    let mut text = fs::read_to_string(path).unwrap();
    for (from, to) in exchanged {
        assert!(text.contains(from), "{id} has no `{from}`");
        text = text.replacen(from, to, 1);
    }
    let id: ExperimentId = id.parse().unwrap();
    let problems = parse_experiment(&id, "mine.yaml", &text, &Assumptions::default());
    problems.expect_err("it is refused").to_string()
}

#[test]
fn every_classic_is_reproduced_to_its_printed_digits() {
    let folder = tempfile::tempdir().unwrap();
    fs::copy(study().join("study.yaml"), folder.path().join("study.yaml")).unwrap();
    for part in ["experiments", "reference", "reports"] {
        fs::create_dir(folder.path().join(part)).unwrap();
        for file in fs::read_dir(study().join(part)).unwrap() {
            let file = file.unwrap();
            fs::copy(file.path(), folder.path().join(part).join(file.file_name())).unwrap();
        }
    }
    let mut entries = 0;
    for file in fs::read_dir(folder.path().join("reference")).unwrap() {
        for entry in load_reference(&file.unwrap().path()).unwrap().entries {
            assert_eq!(entry.expected, Verdict::Reproduced, "{}", entry.id);
            entries += 1;
        }
    }
    assert!(entries >= 70, "{entries} entries");
    for command in [&["run"][..], &["check"], &["check", "--self-test"], &["check", "--reports"]] {
        let mut shotdamp = Command::new(env!("CARGO_BIN_EXE_shotdamp"));
        let output = shotdamp.arg("--root").arg(folder.path()).args(command).output().unwrap();
        let said = String::from_utf8([output.stdout, output.stderr].concat()).unwrap();
        assert!(output.status.success(), "{command:?}\n{said}");
    }
}

/// Significant digits of a number as printed; none of a count, which has no decimals.
fn digits(printed: &str) -> Option<usize> {
    let number = printed.split(' ').next()?;
    let figures: String = number.chars().filter(char::is_ascii_digit).collect();
    number.contains('.').then(|| figures.trim_start_matches('0').len())
}

#[test]
fn the_readme_lists_every_experiment_with_the_digits_it_is_compared_to() {
    let readme = fs::read_to_string(study().join("README.md")).unwrap();
    for file in fs::read_dir(study().join("reference")).unwrap() {
        let reference = load_reference(&file.unwrap().path()).unwrap();
        let printed = reference.entries.iter().filter_map(|entry| match &entry.check {
            Check::Value { published, .. } => digits(published.text()),
            _ => None,
        });
        let printed: BTreeSet<usize> = printed.collect();
        let (fewest, most) = (printed.first().unwrap(), printed.last().unwrap());
        let range = if fewest == most { most.to_string() } else { format!("{fewest} to {most}") };
        let page = format!("(reports/{}.md)", reference.experiment);
        let row = readme.lines().find(|line| line.contains(&page)).unwrap_or_else(|| panic!("no row for {page}"));
        assert!(row.ends_with(&format!("| {range} |")), "{range} digits: {row}");
    }
}

#[test]
fn a_start_that_does_not_fit_is_refused_where_it_stands() {
    let particle = "{height: 0 m, velocity: 1 m/s}";
    for (to, what) in [
        ("{height: -1 m, velocity: 1 m/s}", "no lower than its floor"),
        ("{hieght: 0 m, velocity: 1 m/s}", "did you mean `height`?"),
        ("{height: 0, velocity: 1 m/s}", "a length is wanted"),
        ("{height: 0 m}", "velocity"),
        ("on_flor", "did you mean `on_floor`?"),
        ("on_floor, on_floor", "places 2 particles, and the scene has 1"),
    ] {
        let said = complaint("complete-chatter", particle, to);
        assert!(said.contains(what) && said.contains("mine.yaml:15:"), "{to}: {said}");
    }
    let said = complaint("cantilever-harmonic", "  gravity:", "  start: {velocity: 1 m/s}\n  gravity:");
    assert!(said.contains("those of a single mass"), "{said}");
}

#[test]
fn a_mass_without_spring_says_what_to_write_in_place_of_its_natural_frequency() {
    for (from, to, what) in [
        ("{none: {period: 1 s}}", "none", "{none: {period: 1 s}}"),
        ("gap: infinite", "gap_ratio: 5", "write `gap`"),
        ("{none: {period: 1 s}}", "{harmonic: {force: 1 N, frequency_ratio: 1}}", "write `angular_frequency`"),
        ("stiffness: 0 N/m", "stiffness: -1 N/m", "cannot be negative"),
    ] {
        let said = complaint("complete-chatter", from, to);
        assert!(said.contains(what) && said.contains("mine.yaml:"), "{to}: {said}");
    }
}

#[test]
fn a_motion_is_named_in_its_table_and_known_again() {
    let folder = tempfile::tempdir().unwrap();
    for part in ["experiments", "reference"] {
        fs::create_dir(folder.path().join(part)).unwrap();
    }
    let file = "experiments/two-impacts-above-resonance.yaml";
    let text = fs::read_to_string(study().join(file)).unwrap();
    // The figure's histories are not what this is about.
    let text = text.split("measure:").next().unwrap().to_owned()
        + "measure: [motion, rms_velocity]\nfigure: {x: rms_velocity, y: largest_multiplier, by: motion, caption: One motion.}\n";
    fs::write(folder.path().join(file), &text).unwrap();
    let shotdamp = |command: &[&str]| {
        let run = Command::new(env!("CARGO_BIN_EXE_shotdamp")).arg("--root").arg(folder.path()).args(command).output();
        let output = run.unwrap();
        let said = String::from_utf8([output.stdout, output.stderr].concat()).unwrap();
        assert!(output.status.success(), "{command:?}\n{said}");
    };
    let table = || parquet::read(&folder.path().join("results/two-impacts-above-resonance.parquet")).unwrap();
    shotdamp(&["run"]);
    let first = table();
    assert_eq!(first.texts("motion").unwrap(), ["periodic 1:2"]);
    // The closed form of the multipliers, as in the engine's own tests.
    let largest = first.floats("largest_multiplier").unwrap()[0];
    assert!((largest / 0.846_322_967_149_735_1 - 1.0).abs() < 1e-9, "{largest}");
    assert!(first.floats("multiplier_residual").unwrap()[0] < 1e-12);
    assert!(first.column("motion_num").is_none() && first.column("undefined").is_none());
    // Rows are taken from the table before where only a measure's place has changed, its text among them.
    shotdamp(&["run", "--force"]);
    assert_eq!(table(), first);
    // Beside an exact row one of a fixed step has no name, and says nothing about multipliers.
    let both = text
        .replace("by: motion", "by: solver")
        .replace("run: {", "run: {solver: [event_driven, {fixed_step: {time_step: 1e-3 s}}], ");
    fs::write(folder.path().join(file), &both).unwrap();
    shotdamp(&["run"]);
    let second = table();
    assert_eq!(second.texts("motion").unwrap(), ["periodic 1:2", ""]);
    assert!(second.floats("largest_multiplier").unwrap()[1].is_nan() && second.column("undefined").is_none());
    let bytes = || fs::read(folder.path().join("results/two-impacts-above-resonance.parquet")).unwrap();
    let before = bytes();
    shotdamp(&["run", "--force"]);
    assert!(bytes() == before, "the rows that are known again have other bytes");
}

#[test]
fn what_a_run_cannot_tell_of_a_motion_is_refused_where_it_is_asked_for() {
    for (from, to, what) in [
        ("measure: [", "measure: [motion, ", "measured twice"),
        ("run: {", "run: {solver: {fixed_step: {time_step: 1e-4 s}}, ", "the event-driven solver alone"),
        ("measure: [", "measure: [velocity_ratio_input, ", "add `tolerances: {gap: 1 %}`"),
        ("measure: [", "tolerances: {}\nmeasure: [", "there is no tolerance here"),
        ("measure: [", "tolerances: {gap: 120 %}\nmeasure: [", "between nothing and the whole"),
    ] {
        let with_motion = complaint_of("two-impacts-above-resonance", &[(from, to)]);
        assert!(with_motion.contains(what) && with_motion.contains("mine.yaml:"), "{to}: {with_motion}");
    }
}
