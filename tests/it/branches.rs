//! `orbit` in an experiment: periodic motions as branches, from YAML to the table and the figure.

use std::fs;
use std::path::Path;
use std::process::Command;

use shotdamp::table::{Table, parquet};
use tempfile::TempDir;

/// A ball that bounces once a cycle on a table of dimensionless acceleration `force_ratio`.
const BALL: &str = "title: Ball
about: A ball on a table.
scene:
  structure: {single_mass: {mass: 1 kg, stiffness: 3600 N/m, damping_ratio: 0.5}}
  gravity: 9.81 m/s^2
  dampers: [{mass: 0 kg, gap: infinite, floor: {rigid: {restitution: 0.5}}}]
  excitation: {harmonic: {force_ratio: swept, frequency_ratio: 1}}
  start: {displacement: -3.27 mm, velocity: 0 m/s, particles: [{height: 16.78 mm, velocity: -0.1734 m/s}]}
orbit: {along: {force_ratio: {from: 1.1, to: 1.6}}, start: 1.2, doublings: 1}
run: {skip: 100 cycles, average: 50 cycles}
measure: [floor_impact_speed]
figure: {x: force_ratio, y: largest_multiplier, by: branch, caption: Branches.}
";

/// A mass below a stop that it reaches when the force is large enough.
const STOP: &str = "title: Stop
about: A mass and a stop.
scene:
  structure: {single_mass: {mass: 1 kg, stiffness: 1000 N/m, damping_ratio: 0.02}}
  gravity: 0 m/s^2
  dampers: [{mass: 1e18 kg, gap: infinite, floor: {rigid: {restitution: 0.6}}}]
  excitation: {harmonic: {force: swept, frequency_ratio: 0.9}}
  start: {displacement: 0 mm, velocity: 0 m/s, particles: [{height: 10 mm, velocity: 0 m/s}]}
orbit: {along: {force: {from: 1 N, to: 3 N}}}
run: {skip: 500 cycles, average: 50 cycles}
measure: [rms_velocity, floor_impacts]
";

/// Two dampers that differ, under gravity: no motion has a mirror image.
const UNEVEN: &str = "title: Uneven
about: Two dampers.
scene:
  structure: {single_mass: {mass: 1 kg, stiffness: 800 N/m, damping_ratio: 0.06}}
  gravity: 5 m/s^2
  dampers:
    - {mass: 0.05 kg, gap: 100 mm, floor: {resilient: {stiffness: 900 N/m, damping: 3 N s/m}}}
    - mass: 0.08 kg
      gap: 160 mm
      floor: {resilient: {stiffness: 1500 N/m, damping: 4 N s/m}}
      ceiling: {resilient: {stiffness: 700 N/m, damping: 2 N s/m}}
  excitation: {harmonic: {force: swept, angular_frequency: 27 rad/s}}
orbit:
  along: {force: {from: 4 N, to: 40 N}}
  start: 10 N
  points: 120
  doublings: 1
run: {skip: 300 cycles, average: 300 cycles}
measure: [rms_velocity]
";

/// A study of one experiment.
struct Study(TempDir);

impl Study {
    fn new(text: &str, exchanged: &[(&str, &str)]) -> Self {
        let folder = tempfile::tempdir().unwrap();
        fs::create_dir(folder.path().join("experiments")).unwrap();
        let text = exchanged.iter().fold(text.to_owned(), |text, (from, to)| {
            assert!(text.contains(from), "there is no `{from}`");
            text.replacen(from, to, 1)
        });
        fs::write(folder.path().join("experiments/mine.yaml"), text).unwrap();
        Self(folder)
    }

    fn path(&self) -> &Path {
        self.0.path()
    }

    /// Exit code, and all that is printed.
    fn shotdamp(&self, command: &[&str]) -> (Option<i32>, String) {
        let run = Command::new(env!("CARGO_BIN_EXE_shotdamp")).arg("--root").arg(self.path()).args(command).output();
        let output = run.unwrap();
        (output.status.code(), String::from_utf8([output.stdout, output.stderr].concat()).unwrap())
    }

    fn run(&self) -> Table {
        let (code, said) = self.shotdamp(&["run"]);
        assert_eq!(code, Some(0), "{said}");
        self.table()
    }

    fn table(&self) -> Table {
        parquet::read(&self.path().join("results/mine.parquet")).unwrap()
    }
}

/// Rows of a branch.
fn rows_of(table: &Table, branch: f64) -> Vec<usize> {
    let branches = table.floats("branch").unwrap();
    (0..table.rows()).filter(|row| branches[*row] == branch).collect()
}

#[test]
fn a_table_of_branches_has_every_motion_in_its_place() {
    let study = Study::new(BALL, &[]);
    let table = study.run();
    let (at, stability) = (table.floats("force_ratio").unwrap(), table.texts("stability").unwrap());
    let (special, ends) = (table.texts("special_point").unwrap(), table.texts("branch_end").unwrap());
    let [periods, contacts] = ["periods", "contacts"].map(|column| table.floats(column).unwrap());
    let (first, second) = (rows_of(&table, 1.0), rows_of(&table, 2.0));
    assert_eq!(first.len() + second.len(), table.rows());

    // The motion of one cycle through the whole range, in order, stable up to its doubling.
    assert_eq!([at[first[0]], at[*first.last().unwrap()]], [1.1, 1.6]);
    assert!(first.windows(2).all(|pair| at[pair[0]] < at[pair[1]]) && first.iter().any(|row| at[*row] == 1.2));
    let doubles = *first.iter().find(|row| special[**row] == "period doubling").unwrap();
    for row in first.iter().filter(|row| **row != doubles) {
        assert_eq!(stability[*row], if at[*row] < at[doubles] { "stable" } else { "unstable" });
        assert_eq!((periods[*row], contacts[*row]), (1.0, 1.0));
    }
    // That of two begins there, and attracts.
    assert_eq!(at[second[0]], at[doubles]);
    assert!(second[1..].iter().all(|row| (periods[*row], contacts[*row]) == (2.0, 2.0)));
    assert!(stability[second[1]] == "stable");
    assert_eq!(ends[first[0]], "end of the range");
    assert_eq!(ends[*second.last().unwrap()], "end of the range");
    assert!(first[1..first.len() - 1].iter().all(|row| ends[*row].is_empty()));

    // Neither threads nor time move a bit, and nothing is computed twice.
    let bytes = || fs::read(study.path().join("results/mine.parquet")).unwrap();
    let before = bytes();
    assert!(study.shotdamp(&["run"]).1.contains("Nothing to do."));
    assert_eq!(study.shotdamp(&["run", "--force", "--jobs", "1"]).0, Some(0));
    assert_eq!(bytes(), before);
    let page = fs::read_to_string(study.path().join("reports/mine.md")).unwrap();
    assert!(page.contains("period doubling at 1.5268237"), "{page}");
    assert!(study.path().join("reports/mine.png").exists());
}

#[test]
fn a_branch_that_ends_early_says_where_and_keeps_its_motions() {
    // The stop is reached where the amplitude is the distance.
    let table = Study::new(STOP, &[]).run();
    let (at, special) = (table.floats("force").unwrap(), table.texts("special_point").unwrap());
    let graze = at[special.iter().position(|word| word == "graze").expect("it reaches the stop")];
    let expected = 0.01 * 1000.0 * ((1.0 - 0.81_f64).powi(2) + (0.04 * 0.9_f64).powi(2)).sqrt();
    assert!((graze / expected - 1.0).abs() < 1e-10, "{graze} instead of {expected}");
    let last = table.rows() - 1;
    println!("{:?}", table.texts("branch_end").unwrap()[last]);
    assert!(!table.texts("branch_end").unwrap()[last].is_empty());

    // No more points than asked for.
    let few = Study::new(BALL, &[("doublings: 1", "points: 3")]).run();
    assert_eq!(few.rows(), 5);
    assert!(few.texts("branch_end").unwrap()[4].contains("3 points"));
}

#[test]
fn where_a_run_leads_to_no_orbit_the_row_says_so() {
    let chaotic = [
        ("restitution: 0.5", "restitution: 0.9"),
        ("from: 1.1, to: 1.6}}, start: 1.2", "from: 7, to: 9}}, start: 8"),
        ("skip: 100", "skip: 250"),
    ];
    let study = Study::new(BALL, &chaotic);
    let (code, said) = study.shotdamp(&["run"]);
    assert_eq!(code, Some(2), "{said}");
    assert!(said.contains("at force_ratio = 8") && said.contains("chaos"), "{said}");
    assert_eq!(study.table().rows(), 1);
}

#[test]
fn what_is_wrong_with_an_orbit_is_told_where_it_stands() {
    let cases: &[(&str, &str, &str, &str)] = &[
        ("start: 1.2", "start: 2", "outside of the range from 1.1 to 1.6", "9:"),
        ("{from: 1.1, to: 1.6}", "{from: 1.1, too: 1.6}", "did you mean `to`?", "9:"),
        ("{from: 1.1, to: 1.6}", "{from: 1.6, to: 1.1}", "ends above its start", "9:"),
        ("{from: 1.1, to: 1.6}", "{from: 0, to: 1.6, spacing: log}", "starts above zero", "9:"),
        ("along: {force_ratio", "along: {force_ration", "did you mean `force_ratio`?", "9:"),
        ("along: {force_ratio", "along: {stop", "takes no values in between", "9:"),
        ("doublings: 1", "doubling: 1", "did you mean `doublings`?", "9:"),
        ("doublings: 1", "asymmetric: 2", "true", "9:"),
        ("doublings: 1", "asymetric: true", "did you mean `asymmetric`?", "9:"),
        ("run: {", "sweep: {force_ratio: [1, 2]}\nrun: {", "give one of the two an experiment of its own", "10:"),
        ("[floor_impact_speed]", "[drift]", "not read off one period", "11:"),
        ("[floor_impact_speed]", "[motion]", "every orbit has its `motion`", "11:"),
        ("run: {", "run: {until: settled, ", "Newton's method goes on", "9:"),
        ("run: {", "run: {solver: {fixed_step: {time_step: 1e-4 s}}, ", "finds no orbits", "9:"),
        ("frequency_ratio: 1}", "frequency_ratio: swept}", "nothing sweeps `frequency_ratio`", "7:"),
        ("{force_ratio: {from: 1.1, to: 1.6}}, start: 1.2", "{gap_ratio: {from: -1, to: 1.6}}", "negative", "9:"),
        ("y: largest_multiplier", "y: largest_multipler", "did you mean `largest_multiplier`?", "12:"),
    ];
    for (from, to, what, place) in cases {
        let study = Study::new(BALL, &[(from, to)]);
        let (code, said) = study.shotdamp(&["check"]);
        assert_eq!(code, Some(2), "{to}: {said}");
        assert!(said.contains(what) && said.contains(&format!("mine.yaml:{place}")), "{to}: {said}");
    }
}

#[test]
fn a_fold_beside_a_graze_is_no_symmetry_that_comes_back() {
    let table = Study::new(UNEVEN, &[]).run();
    let ends = table.texts("branch_end").unwrap();
    assert!(ends.iter().all(|end| !end.contains("upside down")), "{ends:?}");
}

#[test]
fn a_run_that_is_drawn_to_an_orbit_is_not_quasi_periodic() {
    let (orbit, sweep) = (UNEVEN.find("orbit:").unwrap(), "sweep: {force: [12 N]}\n");
    let text = format!(
        "{}{sweep}{}",
        &UNEVEN[..orbit],
        "run: {skip: 300 cycles, average: 300 cycles, ensemble: none}\nmeasure: [motion]\n"
    );
    let named = |exchanged: &[(&str, &str)]| Study::new(&text, exchanged).run().texts("motion").unwrap()[0].clone();
    assert_eq!(named(&[]), "not settled");
    let later = [("skip: 300 cycles, average: 300 cycles", "skip: 5000 cycles, average: 3000 cycles")];
    assert_eq!(named(&later), "periodic 8:34");
}

/// A motion with two impacts a cycle, next to where it loses its stability.
const SLOW: &str = "title: Slow
about: A damper without gravity.
scene:
  structure: {single_mass: {mass: 1 kg, stiffness: 1000 N/m, damping_ratio: 0.02}}
  gravity: 0 m/s^2
  dampers: [{mass: 0.1 kg, gap: 100 mm, floor: {rigid: {restitution: 0.6}}}]
  excitation: {harmonic: {force: swept, frequency_ratio: 1.1}}
  start: {displacement: -7.95 mm, velocity: -0.0967 m/s, particles: [{height: 68.9 mm, velocity: -0.975 m/s}]}
sweep: {force: [5.236 N, 5.24 N]}
run: {skip: 25 cycles, average: 100 cycles, ensemble: none}
measure: [motion]
";

#[test]
fn a_run_that_nears_an_orbit_more_slowly_than_it_lasts_is_not_quasi_periodic() {
    // The largest multipliers are 0.99903 and 0.99773: by another integrator, and Newton’s method on its map.
    for window in ["skip: 25 cycles, average: 100 cycles", "skip: 100 cycles, average: 200 cycles"] {
        let table = Study::new(SLOW, &[("skip: 25 cycles, average: 100 cycles", window)]).run();
        assert_eq!(table.texts("motion").unwrap(), ["not settled"; 2], "{window}");
    }
    // Below 5.234 N the orbit lets go of it, and the motion is a torus about it, the same after 60 000 cycles.
    let long = ("skip: 25 cycles, average: 100 cycles", "skip: 3000 cycles, average: 1000 cycles");
    let table = Study::new(SLOW, &[("5.236 N, 5.24 N", "5.22 N, 5.23 N"), long]).run();
    assert_eq!(table.texts("motion").unwrap(), ["quasi-periodic"; 2]);
}
