//! Thresholds in closed form: where `show` names them and where refined sweeps have their points, against formulas and against the search
//! of the classic `lift-off-onset`.

use std::fs;
use std::path::Path;
use std::process::Command;

use shotdamp::table::{Table, parquet};
use tempfile::TempDir;

/// A particle on a rigid floor of a mass that is driven at √(k/m).
const RESTING: &str = "title: Rest
about: A particle that lifts off.
scene:
  structure: {single_mass: {mass: 1 kg, stiffness: 1000 N/m, damping_ratio: 0.05}}
  gravity: 9.81 m/s^2
  dampers: [{mass_ratio: swept, gap: infinite, floor: {rigid: {restitution: 0}}}]
  excitation: {harmonic: {force: swept, frequency_ratio: 1}}
sweep: {mass_ratio: [0.05, 0.2], force: {refined: {from: 0.5 N, to: 3 N, start: 9 points, most: 11 points, around: lift_off}}}
run: {skip: 500 cycles, average: 20 cycles, ensemble: none}
measure: separations
figure: {x: force, y: separations, by: mass_ratio, caption: Separations.}
";

struct Study(TempDir);

impl Study {
    fn new(text: &str) -> Self {
        let folder = tempfile::tempdir().unwrap();
        fs::create_dir(folder.path().join("experiments")).unwrap();
        fs::write(folder.path().join("experiments/mine.yaml"), text).unwrap();
        Self(folder)
    }

    /// Exit code, and all that is printed.
    fn shotdamp(&self, command: &[&str]) -> (Option<i32>, String) {
        let run = Command::new(env!("CARGO_BIN_EXE_shotdamp")).arg("--root").arg(self.0.path()).args(command).output();
        let output = run.unwrap();
        (output.status.code(), String::from_utf8([output.stdout, output.stderr].concat()).unwrap())
    }

    fn run(&self) -> Table {
        let (code, said) = self.shotdamp(&["run"]);
        assert_eq!(code, Some(0), "{said}");
        parquet::read(&self.0.path().join("results/mine.parquet")).unwrap()
    }
}

/// F = (g/ω²) √((k − (m + mp) ω²)² + (c ω)²) at ω² = k/m.
fn lifts_off(mass_ratio: f64) -> f64 {
    9.81 * mass_ratio.hypot(0.1)
}

#[test]
fn a_refined_sweep_has_a_point_on_either_side_of_lift_off_and_show_names_it() {
    let study = Study::new(RESTING);
    let (_, said) = study.shotdamp(&["show", "mine"]);
    assert!(said.contains("All particles rest below force = 1.097 N to 2.194 N, by case, once"), "{said}");
    let table = study.run();
    let column = |name: &str| table.floats(name).unwrap();
    let (mass, force, separations) = (column("mass_ratio"), column("force"), column("separations"));
    assert_eq!(table.rows(), 22);
    for ratio in [0.05, 0.2] {
        let rows = || (0..table.rows()).filter(|row| mass[*row] == ratio);
        for (share, rests) in [(0.999, true), (1.001, false)] {
            let at = share * lifts_off(ratio);
            let row = rows().find(|row| (force[*row] / at - 1.0).abs() < 1e-11);
            assert_eq!(separations[row.expect("it has this point")] == 0.0, rests, "{ratio}: {share}");
        }
        assert!(rows().all(|row| (separations[row] == 0.0) == (force[row] < lifts_off(ratio))));
    }
}

/// Masri and Caughey's damper; its smallest force with two impacts is worked out from their formulas in double precision.
const BETWEEN: &str = "title: Between
about: A particle between two faces.
scene:
  structure: {single_mass: {mass: 1 kg, stiffness: 1000 N/m, damping_ratio: 0.02}}
  gravity: 0 m/s^2
  dampers: [{mass: 0.1 kg, gap: 100 mm, floor: {rigid: {restitution: 0.6}}}]
  excitation: {harmonic: {force: swept, frequency_ratio: 1.1}}
sweep: {force: {refined: {from: 1 N, to: 3 N, start: 5 points, most: 7 points, around: two_impacts}}}
run: {skip: 50 cycles, average: 20 cycles, ensemble: none}
measure: floor_impacts
figure: {x: force, y: floor_impacts, caption: Impacts.}
";

#[test]
fn the_smallest_force_with_two_impacts_is_named_before_a_run_and_gets_points() {
    let study = Study::new(BETWEEN);
    for command in [&["show", "mine"][..], &["run", "--dry-run"]] {
        let (_, said) = study.shotdamp(command);
        let wanted = "No motion has one impact on floor and ceiling a period below force = 1.938 N; 2 cases lie there.";
        assert!(said.contains(wanted), "{said}");
    }
    let table = study.run();
    let forces = table.floats("force").unwrap();
    for side in [0.999, 1.001] {
        let at = side * 1.938_425_472_849_182;
        assert!(forces.iter().any(|force| (force / at - 1.0).abs() < 1e-12), "{forces:?}");
    }
}

#[test]
fn a_refined_range_that_gets_no_points_around_its_threshold_is_told_beforehand() {
    let outside = BETWEEN.replace("from: 1 N, to: 3 N", "from: 2 N, to: 3 N");
    for (text, why) in [
        (outside.as_str(), "`around: two_impacts` adds no points: its place, force = 1.938 N, lies outside the range"),
        (
            &BETWEEN.replace("around: two_impacts", "around: lift_off"),
            "`around: lift_off` adds no points: this scene has no such",
        ),
    ] {
        let study = Study::new(text);
        for command in [&["show", "mine"][..], &["run", "--dry-run"]] {
            let (_, said) = study.shotdamp(command);
            assert!(said.contains(&format!("warning: {why}")), "{said}");
        }
    }
    let (_, said) = Study::new(BETWEEN).shotdamp(&["show", "mine"]);
    assert!(!said.contains("adds no points"), "{said}");
}

#[test]
fn the_search_of_the_classic_finds_lift_off_where_the_points_are() {
    let classic = Path::new(env!("CARGO_MANIFEST_DIR")).join("examples/classics/experiments/lift-off-onset.yaml");
    let searched = Study::new(&fs::read_to_string(classic).unwrap()).run();
    let ratios = searched.floats("mass_ratio").unwrap();
    let onsets = searched.floats("force_at_onset").unwrap();
    let list: Vec<String> = ratios.iter().map(f64::to_string).collect();
    let all = RESTING.replace("[0.05, 0.2]", &format!("[{}]", list.join(", "))).replace("to: 3 N", "to: 4 N");
    let placed = Study::new(&all).run();
    let (mass, force) = (placed.floats("mass_ratio").unwrap(), placed.floats("force").unwrap());
    for (ratio, onset) in ratios.iter().zip(&onsets) {
        let below = (0..placed.rows()).filter(|row| mass[*row] == *ratio).map(|row| force[row] / 0.999 / onset - 1.0);
        let closest = below.map(f64::abs).fold(f64::INFINITY, f64::min);
        assert!(closest < 1e-10, "{ratio}: {closest:e}");
    }
}

#[test]
fn points_around_lift_off_are_refused_along_what_is_no_strength() {
    let along_frequency = RESTING
        .replace("force: swept, frequency_ratio: 1", "force: 1 N, frequency_ratio: swept")
        .replace("force: {refined: {from: 0.5 N, to: 3 N", "frequency_ratio: {refined: {from: 0.5, to: 3")
        .replace("x: force", "x: frequency_ratio");
    for (text, said) in [
        (along_frequency, "a threshold is a strength of the drive"),
        (RESTING.replace("around: lift_off", "around: lift_of"), "did you mean `lift_off`?"),
    ] {
        let (code, found) = Study::new(&text).shotdamp(&["check"]);
        assert_eq!(code, Some(2), "{found}");
        assert!(found.contains(said) && found.contains("mine.yaml:8:"), "{found}");
    }
}
