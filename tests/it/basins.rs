//! Random starts: what a person writes, which ends are one motion, and shares that follow from a closed form.

use std::collections::BTreeMap;
use std::sync::atomic::{AtomicUsize, Ordering};

use shotdamp::experiment::{Assumptions, Experiment, parse_experiment};
use shotdamp::measure::Evaluated;
use shotdamp::study::{Engine, Evaluate, IgnoreEvents, RowFailure, Simulation};
use shotdamp::table::{Data, Table};

use crate::desk::{Desk, refuses, shotdamp};

/// Balls without mass on a table with the acceleration Γ = 0.8 of gravity. The state of the unstable motion with one impact a cycle,
/// 9.970 mm and −0.1676 m/s at the start of a cycle, lies on the border between rest and bouncing: within 20 µm the border is straight, and a box that
/// reaches from one quarter below to three quarters above that velocity has a quarter of its area on the side that comes to rest. The table moves as
/// −a cos(ω t − π/4) from the start, with Γ = √2 f′.
const BALLS: &str = "title: Balls on a table
source: {chapter: 3, section: 3.6.3}
about: Rest or bouncing.
scene:
  structure: {single_mass: {mass: 1 kg, stiffness: 1800 N/m, damping_ratio: 0.353553390593274}}
  gravity: 9.81 m/s^2
  dampers:
    - {mass: 0 kg, gap: infinite, floor: {rigid: {restitution: 0.7}}}
    - {mass: 0 kg, gap: infinite, floor: {rigid: {restitution: 0.7}}}
  excitation: {harmonic: {force_ratio: swept, angular_frequency: 60 rad/s}}
  start: {displacement: -1.541492782987 mm, velocity: -0.092489566979 m/s}
sweep: {force_ratio: [0.565685424949, 0.35]}
starts:
  particles:
    - {height: [9.95024134066 mm, 9.99024134066 mm], velocity: [-0.177566128893 m/s, -0.137566128893 m/s]}
    - {height: [9.95024134066 mm, 9.99024134066 mm], velocity: [-0.177566128893 m/s, -0.137566128893 m/s]}
  count: 300
run: {until: settled, skip: 200 cycles, average: 100 cycles, sensitivity: none}
measure: [rms_velocity]
figures:
  - {x: force_ratio, y: share, by: basin, band: stacked, caption: Shares.}
  - {name: starts, x: start_particle_velocity, y: start_height_2, by: basin, caption: Starts.}
";

fn read(text: &str) -> Result<Experiment, String> {
    let read = parse_experiment(&"mine".parse().unwrap(), "mine.yaml", text, &Assumptions::default());
    read.map_err(|problems| problems.to_string())
}

/// The engine, with a count of what is evaluated as a result.
#[derive(Default)]
struct Counting(AtomicUsize);

impl Evaluate for Counting {
    fn evaluate(&self, simulation: &Simulation<'_>) -> Result<Evaluated, RowFailure> {
        self.0.fetch_add(1, Ordering::Relaxed);
        Engine.evaluate(simulation)
    }
}

/// A study of this experiment alone.
fn desk(text: &str) -> Desk {
    let desk = Desk::new();
    for other in
        ["experiments/ch3/ch3-stop", "experiments/ch3/ch3-gap", "reference/ch3/ch3-stop", "reference/ch3/ch3-gap"]
    {
        std::fs::remove_file(desk.layout.path(&format!("{other}.yaml"))).unwrap();
    }
    desk.put("experiments/ch3/ch3-basins.yaml", text);
    desk
}

/// Starts by basin at a force ratio.
fn starts(table: &Table, force: f64) -> BTreeMap<String, i64> {
    let (at, names) = (table.floats("force_ratio").unwrap(), table.texts("basin").unwrap());
    let Data::Int(counts) = &table.column("starts").unwrap().data else { panic!("starts are counted") };
    (0..table.rows()).filter(|&row| at[row] == force).map(|row| (names[row].clone(), counts[row])).collect()
}

#[test]
fn two_balls_that_do_not_feel_each_other_end_in_the_four_pairs_of_what_each_may_end_in() {
    let desk = desk(BALLS);
    desk.run(2, &Engine, &IgnoreEvents);
    let table = desk.table("ch3-basins");
    let found = starts(&table, 0.565685424949);
    assert_eq!(found.values().sum::<i64>(), 300, "no start is dropped: {found:?}");
    // Either ball alone may bounce: two motions of one name, which their states tell apart.
    for (name, share) in [("at rest", 1.0), ("periodic 1:1", 3.0), ("periodic 1:1 (2)", 3.0), ("periodic 1:2", 9.0)]
        .map(|(n, k)| (n, k / 16.0))
    {
        let (got, error) = (found[name] as f64 / 300.0, (share * (1.0 - share) / 300.0_f64).sqrt());
        assert!((got - share).abs() < 3.0 * error, "{name}: {got}, {share} ± {error}");
    }
    // Below Γ = π (1 − ε)/(1 + ε) = 0.554 nothing bounces for good.
    assert_eq!(starts(&table, 0.35), BTreeMap::from([("at rest".into(), 300)]));
    let (low, high) = (table.floats("share_low").unwrap(), table.floats("share_high").unwrap());
    let share = table.floats("share").unwrap();
    assert!((0..table.rows()).all(|row| low[row] <= share[row] && share[row] <= high[row] && low[row] < high[row]));
    // All starts of a motion are kept.
    let lists = table.lists("start_height_2").unwrap();
    assert_eq!(lists.iter().map(Vec::len).sum::<usize>(), 600);
}

#[test]
fn a_motion_that_is_met_some_cycles_later_is_the_same_motion() {
    // ε = 0.9, Γ = 0.45: rest, one impact a cycle, and one in two cycles, which a start may meet in either of them.
    let text = BALLS
        .replace("    - {mass: 0 kg, gap: infinite, floor: {rigid: {restitution: 0.7}}}\n  exc", "  exc")
        .replace("    - {height: [9.95024134066 mm, 9.99024134066 mm], velocity: [-0.177566128893 m/s, -0.137566128893 m/s]}\n  count", "  count")
        .replace("height: [9.95024134066 mm, 9.99024134066 mm], velocity: [-0.177566128893 m/s, -0.137566128893 m/s]", "height: [0 mm, 80 mm], velocity: [-1.5 m/s, 1.5 m/s]")
        .replace("start_height_2", "start_height")
        .replace("restitution: 0.7", "restitution: 0.9")
        .replace("[0.565685424949, 0.35]", "[0.318198]")
        .replace("skip: 200", "skip: 600");
    let desk = desk(&text);
    desk.run(2, &Engine, &IgnoreEvents);
    let table = desk.table("ch3-basins");
    let found = starts(&table, 0.318198);
    assert!(found["periodic 2:1"] > 3 && !found.contains_key("periodic 2:1 (2)"), "{found:?}");
    // Starts that meet it in different cycles go the same way from there.
    let row = table.texts("basin").unwrap().iter().position(|name| name == "periodic 2:1").unwrap();
    assert!(table.floats("rms_difference").unwrap()[row] < 1e-9);
}

#[test]
fn shares_are_the_same_for_any_number_of_threads_and_a_case_that_is_known_is_not_run_again() {
    let small = BALLS.replace("count: 300", "count: 20");
    let bytes = [1, 2, 5].map(|threads| {
        let desk = desk(&small);
        desk.run(threads, &Engine, &IgnoreEvents);
        desk.bytes("results/ch3-basins.parquet")
    });
    assert!(bytes[0] == bytes[1] && bytes[1] == bytes[2]);
    let desk = desk(&small);
    desk.run(2, &Engine, &IgnoreEvents);
    let before = desk.table("ch3-basins");
    desk.put(
        "experiments/ch3/ch3-basins.yaml",
        &small.replace("[0.565685424949, 0.35]", "[0.565685424949, 0.35, 0.3]"),
    );
    let counting = Counting::default();
    desk.run(2, &counting, &IgnoreEvents);
    let after = desk.table("ch3-basins");
    assert_eq!(counting.0.into_inner(), after.rows() - before.rows(), "only the new case is evaluated");
    let rows: Vec<usize> = (0..before.rows()).collect();
    let kept = Table { metadata: before.metadata.clone(), ..after.select(&rows) };
    assert!(kept.columns.iter().zip(&before.columns).all(|(a, b)| format!("{a:?}") == format!("{b:?}")));
}

#[test]
fn a_box_that_makes_no_sense_is_refused_where_it_stands() {
    read(BALLS).unwrap_or_else(|problems| panic!("{problems}"));
    let height =
        "height: [9.95024134066 mm, 9.99024134066 mm], velocity: [-0.177566128893 m/s, -0.137566128893 m/s]}\n  count";
    let mistakes = [
        ("count: 300", "count: 0", "17:", "one start at least"),
        ("count: 300", "counts: 300", "17:", "did you mean `count`?"),
        ("  count: 300", "  displacement: [5 mm, -5 mm]\n  count: 300", "17:", "write the smaller value first"),
        ("  count: 300", "  displacement: [5 mm, 5 mm]\n  count: 300", "17:", "this range is empty"),
        ("  count: 300", "  displacement: [5 mm]\n  count: 300", "17:", "a range has two ends"),
        ("  count: 300", "  displacement: [0 kg, 5 mm]\n  count: 300", "17:", "write for example"),
        ("  count: 300", "  speed: [0 m/s, 1 m/s]\n  count: 300", "17:", "no key `speed`"),
        (height, "height: [-1 mm, 5 mm], velocity: 0 m/s}\n  count", "16:", "no lower than its floor"),
        (height, "height_share: [0, 1.5], velocity: 0 m/s}\n  count", "16:", "no higher than its ceiling"),
        (height, "height_share: [0, 1], velocity: 0 m/s}\n  count", "14:", "this gap is infinite"),
        ("    - {height", "    - on_flor\n    - {height", "15:", "did you mean `on_floor`?"),
        ("until: settled, ", "", "13:", "add `run: {until: settled}`"),
        ("gap: infinite", "gap: 5 mm", "14:", "no higher than its ceiling, which lies at 0.005 m"),
        (
            "{force_ratio: [0.565685424949, 0.35]}",
            "{force_ratio: [0.565685424949, 0.35], from: last}",
            "12:",
            "leave `from: last` or `starts` out",
        ),
        ("{force_ratio: [0.565685424949, 0.35]}", "{force_ratio: {refined: {from: 0.35, to: 0.5}}}", "12:", "no curve"),
        (
            "measure:",
            "trace: {from: 0 cycles, to: 1 cycles, samples_per_cycle: 9}\nmeasure:",
            "19:",
            "no mean, maximum, orbit or list",
        ),
        ("y: share,", "y: shares,", "21:", "did you mean `share`?"),
        ("y: start_height_2", "y: share", "22:", "one is a list a row"),
    ];
    refuses(BALLS, read, &mistakes);
    // Without starts an experiment means what it meant before.
    let begin = BALLS.find("starts:").unwrap();
    let end = BALLS.find("run:").unwrap();
    let figures = BALLS.find("figures:").unwrap();
    let plain = format!("{}{}", &BALLS[..begin], &BALLS[end..figures]);
    assert!(!read(&plain).unwrap().simulation_json().to_string().contains("starts"));
}

#[test]
fn a_study_of_random_starts_alone_says_how_many_motions_attract() {
    let desk = desk(&BALLS.replace("count: 300", "count: 20"));
    assert_eq!(shotdamp(&desk, &["run", "--quiet"]).code, 0);
    let page = String::from_utf8(desk.bytes("reports/what-moves-how.md")).unwrap();
    assert!(page.contains("| [Balls on a table](ch3/ch3-basins.md) | 2 | 20 | 1 | 1 | 0 |"), "{page}");
    assert!(!page.contains("No experiment") && !page.contains("Rows"), "{page}");
}

#[test]
fn the_only_motion_that_attracts_is_named_in_the_figures() {
    let desk = desk(&BALLS.replace("count: 300", "count: 20").replace("[0.565685424949, 0.35]", "[0.35]"));
    assert_eq!(shotdamp(&desk, &["run", "--quiet"]).code, 0);
    for figure in ["ch3-basins", "ch3-basins-starts"] {
        let svg = String::from_utf8(desk.bytes(&format!("reports/ch3/{figure}.svg"))).unwrap();
        assert!(svg.contains(">at rest</text>"), "{figure}");
    }
}
