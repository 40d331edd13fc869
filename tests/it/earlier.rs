//! Only what a change touches is made again, and going back simulates nothing: to the bytes of a run from nothing.

use std::fs;
use std::path::PathBuf;

use shotdamp::measure::Evaluated;
use shotdamp::report::{judge_all, publish};
use shotdamp::study::Study;
use shotdamp::study::{Evaluate, IgnoreEvents, KnownRows, RowFailure, Simulation};
use shotdamp::table::parquet;

use crate::desk::{ASSUMPTIONS, Desk, GAP, GAP_REFERENCE, MadeUp, STOP, STOP_REFERENCE, shotdamp};
use crate::shard::OPTIMISED;

/// Simulations that bringing the study up to date takes.
fn simulations(desk: &Desk) -> usize {
    let engine = MadeUp::default();
    desk.run(2, &engine, &IgnoreEvents);
    engine.simulations.into_inner()
}

fn table(desk: &Desk, id: &str) -> Vec<u8> {
    desk.bytes(&format!("results/{id}.parquet"))
}

/// The table that a study would have that knows nothing of before.
fn from_nothing(desk: &Desk, id: &str) -> Vec<u8> {
    let fresh = Desk::new();
    fs::remove_dir_all(fresh.layout.path("reference")).unwrap();
    fs::remove_dir_all(fresh.layout.path("experiments")).unwrap();
    for (name, text) in desk.texts().files {
        fresh.put(&name, std::str::from_utf8(&text.unwrap()).unwrap());
    }
    simulations(&fresh);
    table(&fresh, id)
}

/// Rows to simulate, as `status` and `--dry-run` tell.
fn to_do(desk: &Desk, id: &str) -> usize {
    let item = &desk.plan()[id];
    item.extent(&desk.layout, &KnownRows::of(&desk.layout, item)).to_do
}

fn earlier(desk: &Desk, id: &str) -> Vec<PathBuf> {
    let entries = fs::read_dir(desk.layout.path(&format!("results/earlier/{id}"))).into_iter().flatten();
    entries.map(|entry| entry.unwrap().path()).collect()
}

/// Figures that bringing the reports up to date draws.
fn drawn(desk: &Desk) -> usize {
    let study = Study::new(desk.layout.clone(), desk.texts());
    let ids = study.items.iter().map(|item| item.source.experiment.id.0.as_str()).collect();
    publish(&study, &judge_all(&study), &ids).unwrap().drawn
}

const STOP_FILE: &str = "experiments/ch3/ch3-stop.yaml";

#[test]
fn only_the_points_that_changed_are_simulated() {
    // Each case is with and without stop, under two solvers, and event-driven under three ends of the assumptions, of which
    // the length of the stop means nothing to the case without.
    let a_point = 2 * 2 + 5;
    for (what, text, simulated) in [
        ("another last point", STOP.replace("[1, 2, 4]", "[1, 2, 8]"), a_point),
        ("one more in the middle", STOP.replace("[1, 2, 4]", "[1, 2, 3, 4]"), a_point),
        ("one less", STOP.replace("[1, 2, 4]", "[1, 4]"), 0),
        ("another order", STOP.replace("[1, 2, 4]", "[4, 2, 1]"), 0),
        ("one solver less", STOP.replace("[event_driven, {fixed_step: {time_step: 0.1 ms}}]", "event_driven"), 0),
        (
            "one more parameter",
            STOP.replace("mass_ratio: 0.05", "mass_ratio: swept").replace("sweep: {", "sweep: {mass_ratio: [0.05], "),
            0,
        ),
        ("another step", STOP.replace("0.1 ms", "0.05 ms"), 6),
        ("longer", STOP.replace("skip: 25", "skip: 30"), 3 * a_point),
        ("another measure", STOP.replace("[velocity_ratio]", "[velocity_ratio, displacement_ratio]"), 3 * a_point),
    ] {
        let desk = Desk::new();
        simulations(&desk);
        desk.put(STOP_FILE, &text);
        assert_eq!(to_do(&desk, "ch3-stop"), simulated, "{what}");
        assert_eq!(simulations(&desk), simulated, "{what}");
        assert!(table(&desk, "ch3-stop") == from_nothing(&desk, "ch3-stop"), "{what}");
    }
}

#[test]
fn an_assumption_touches_the_rows_that_lean_on_it() {
    let desk = Desk::new();
    simulations(&desk);
    desk.put("experiments/assumptions.yaml", &ASSUMPTIONS.replace("60 mm", "55 mm"));
    // With stop, three points: two solvers, and event-driven where the impulse is moved. Moved to 50 mm it is what it was.
    assert_eq!(simulations(&desk), 3 * (2 + 2));
    assert!(table(&desk, "ch3-stop") == from_nothing(&desk, "ch3-stop"));
    // A first published number asks for the ends of the assumptions beside what is known.
    let before = GAP_REFERENCE.split_once("claim").unwrap().0;
    let number = "value: \"1.5\"\n    from: {maximum: {of: velocity_ratio, over: gap_ratio}}";
    desk.put("reference/ch3/ch3-gap.yaml", &format!("{before}{number}\n"));
    desk.put("experiments/assumptions.yaml", &ASSUMPTIONS.replace("9.81 m/s^2,", "9.81 m/s^2, range: [9.8 m/s^2],"));
    assert_eq!(to_do(&desk, "ch3-gap"), 3);
}

#[test]
fn going_back_simulates_nothing() {
    let desk = Desk::new();
    simulations(&desk);
    let heavier = |mass: u32| STOP.replace("mass: 1 kg", &format!("mass: {mass} kg"));
    let tables: Vec<Vec<u8>> = (2..12)
        .map(|mass| {
            desk.put(STOP_FILE, &heavier(mass));
            assert_eq!(simulations(&desk), 27);
            table(&desk, "ch3-stop")
        })
        .collect();
    assert_eq!(earlier(&desk, "ch3-stop").len(), 8, "the eight before are kept");
    for mass in [5, 11, 4, 5] {
        desk.put(STOP_FILE, &heavier(mass));
        assert_eq!((to_do(&desk, "ch3-stop"), simulations(&desk)), (0, 0), "{mass} kg");
        assert!(table(&desk, "ch3-stop") == tables[mass as usize - 2]);
    }
    assert_eq!(earlier(&desk, "ch3-stop").len(), 8);
    desk.put(STOP_FILE, STOP);
    assert_eq!(simulations(&desk), 27, "ten changes ago");
    // With another title, which stands in the table.
    desk.put(STOP_FILE, &heavier(4).replace("Limit stop", "A stop"));
    assert_eq!(simulations(&desk), 0);
    assert!(table(&desk, "ch3-stop") == from_nothing(&desk, "ch3-stop"));
}

#[test]
fn traces_refined_curves_and_maxima_come_back_to_the_bit() {
    const REFINED: &str =
        "sweep: {gap_ratio: [10, 50], frequency_ratio: {refined: {from: 0.2, to: 7, start: 9 points, tolerance: 1 %}}}";
    let traced = STOP.replace("measure:", "trace: {from: 100 cycles, to: 101 cycles, samples_per_cycle: 20}\nmeasure:");
    let refined = STOP
        .replace("sweep: {force_ratio: [1, 2, 4], stop: [with, without]}", REFINED)
        .replace("gap_ratio: 50", "gap_ratio: swept")
        .replace(
            "{impulse_train: {force_ratio: swept, frequency_ratio: 1}}",
            "{harmonic: {base_amplitude_ratio: 1, frequency_ratio: swept}}",
        )
        .replace(
            "x: force_ratio, y: velocity_ratio, by: [stop, solver]",
            "x: frequency_ratio, y: velocity_ratio, by: [gap_ratio, solver]",
        );
    for (id, text, other) in [
        ("ch3-stop", traced.clone(), traced.replace("[1, 2, 4]", "[2, 8]")),
        ("ch3-stop", refined.clone(), refined.replace("[10, 50]", "[50]")),
        ("ch3-gap", GAP.to_owned(), GAP.replace("[10, 50, infinite]", "[50, 60]")),
    ] {
        let desk = Desk::new();
        fs::remove_dir_all(desk.layout.path("reference")).unwrap();
        let name = format!("experiments/ch3/{id}.yaml");
        desk.put(&name, &text);
        let all = simulations(&desk);
        let first = table(&desk, id);
        desk.put(&name, &other);
        let some = simulations(&desk);
        assert!(some < all / 2, "{some} of {all}");
        assert!(table(&desk, id) == from_nothing(&desk, id));
        desk.put(&name, &text);
        assert_eq!((to_do(&desk, id), simulations(&desk)), (0, 0));
        assert!(table(&desk, id) == first);
    }
}

#[test]
fn a_damaged_earlier_table_is_simulated_anew() {
    let desk = Desk::new();
    simulations(&desk);
    let first = table(&desk, "ch3-stop");
    let heavy = STOP.replace("mass: 1 kg", "mass: 2 kg");
    desk.put(STOP_FILE, &heavy);
    simulations(&desk);
    let kept = earlier(&desk, "ch3-stop");
    let [path] = kept.as_slice() else { panic!("{kept:?}") };
    let mut edited = parquet::from_bytes(first.clone(), "first").unwrap();
    edited.metadata.insert("title".into(), "edited, and sealed again".into());
    let heavier = table(&desk, "ch3-stop");
    for damage in
        [first[..first.len() / 2].to_vec(), [&first[1..], b"!"].concat(), parquet::to_bytes(&edited).unwrap(), heavier]
    {
        fs::write(path, damage).unwrap();
        desk.put(STOP_FILE, STOP);
        assert_eq!(to_do(&desk, "ch3-stop"), 27);
        desk.put(STOP_FILE, &heavy);
    }
    desk.put(STOP_FILE, STOP);
    assert_eq!(simulations(&desk), 27);
    assert!(table(&desk, "ch3-stop") == first);
    // The one in force counts only as its record has it.
    fs::write(desk.layout.path("results/ch3-stop.parquet"), parquet::to_bytes(&edited).unwrap()).unwrap();
    fs::remove_dir_all(desk.layout.path("results/earlier")).unwrap();
    assert_eq!(simulations(&desk), 27);
}

#[test]
fn rows_that_failed_are_tried_again_and_no_others() {
    struct Breaks(MadeUp);
    impl Evaluate for Breaks {
        fn evaluate(&self, it: &Simulation<'_>) -> Result<Evaluated, RowFailure> {
            it.recipe.dampers[0].stop.as_ref().ok_or(RowFailure::NoValue("velocity_ratio".into()))?;
            self.0.evaluate(it)
        }
    }
    let desk = Desk::new();
    fs::remove_file(desk.layout.path("experiments/ch3/ch3-gap.yaml")).unwrap();
    fs::remove_file(desk.layout.path("reference/ch3/ch3-gap.yaml")).unwrap();
    desk.run(2, &Breaks(MadeUp::default()), &IgnoreEvents);
    // Three points under two solvers, and where the impulse is moved.
    assert_eq!(to_do(&desk, "ch3-stop"), 3 * (2 + 2));
    assert_eq!(simulations(&desk), 3 * (2 + 2));
    assert!(table(&desk, "ch3-stop") == from_nothing(&desk, "ch3-stop"));
}

#[test]
fn the_command_tells_what_is_to_do_and_how_long_it_will_take() {
    let desk = Desk::new();
    fs::remove_dir_all(desk.layout.path("reference")).unwrap();
    let short = |text: &str| text.replace("skip: 25 cycles, average: 100", "skip: 2 cycles, average: 4");
    desk.put(STOP_FILE, &short(STOP));
    desk.put("experiments/ch3/ch3-gap.yaml", &short(GAP));
    desk.put("experiments/ch6/ch6-gap.yaml", &short(OPTIMISED));
    let dry = || shotdamp(&desk, &["run", "--dry-run", "--jobs", "2"]).out;
    let before = dry();
    assert!(
        before.contains("ch3-stop: 12 of 12 rows to simulate, 12 simulations at most, time not known\n"),
        "{before}"
    );
    assert!(before.ends_with("3 of 3 experiments would be simulated\n"), "{before}");
    assert_eq!(shotdamp(&desk, &["--quiet"]).code, 0);
    let first = ["ch3-stop", "ch6-gap"].map(|id| table(&desk, id));

    desk.put(STOP_FILE, &short(STOP).replace("[1, 2, 4]", "[1, 2, 8]"));
    desk.put("experiments/ch6/ch6-gap.yaml", &short(OPTIMISED).replace("50 mm", "40 mm"));
    let dry_now = dry();
    assert!(
        dry_now.contains("ch3-stop: 4 of 12 rows to simulate, 4 simulations at most, less than 0.1 s\n"),
        "{dry_now}"
    );
    assert!(dry_now.contains("\n2 of 3 experiments would be simulated\n"), "{dry_now}");
    assert!(dry_now.ends_with(" on 2 threads\n"), "{dry_now}");
    assert!(shotdamp(&desk, &["status", "--why"]).out.contains("    4 of 12 rows to simulate\n"));
    let run = shotdamp(&desk, &["run"]);
    assert!(run.out.starts_with("3 experiments: 2 simulated; "));
    // Without a terminal each experiment that ends has a line.
    let lines: Vec<&str> = run.err.lines().filter(|line| !line.starts_with("warning: ")).collect();
    assert!(
        lines.len() == 2 && lines[0].contains("; 1 experiment left, ") && lines[1].ends_with("; none left"),
        "{lines:?}"
    );

    desk.put(STOP_FILE, &short(STOP));
    desk.put("experiments/ch6/ch6-gap.yaml", &short(OPTIMISED));
    let dry = dry();
    assert!(dry.contains("ch3-stop: none of 12 rows to simulate: earlier tables have them\n"), "{dry}");
    assert!(dry.ends_with("\n0 of 3 experiments would be simulated, 2 restored\n"), "{dry}");
    let run = shotdamp(&desk, &["run"]).out;
    assert!(run.starts_with("3 experiments: 0 simulated, 2 restored; "), "{run}");
    assert!(first == ["ch3-stop", "ch6-gap"].map(|id| table(&desk, id)));

    let all = shotdamp(&desk, &["run", "--force", "--dry-run", "ch3-stop"]).out;
    assert!(all.contains("ch3-stop: 12 of 12 rows"), "{all}");
    assert!(shotdamp(&desk, &["run", "--force", "ch3-stop"]).out.starts_with("1 experiment: 1 simulated; 0 figures"));
    let cleaned = shotdamp(&desk, &["clean", "--earlier"]).out;
    assert!(cleaned.ends_with("2 files removed\n") && earlier(&desk, "ch3-stop").is_empty(), "{cleaned}");
}

#[test]
fn a_tolerance_judges_again_and_a_figure_is_drawn_when_it_shows_something_else() {
    let desk = Desk::new();
    simulations(&desk);
    assert_eq!(drawn(&desk), 2);
    let picture = desk.layout.path("reports/ch3/ch3-stop.png");
    let page = || String::from_utf8(desk.bytes("reports/ch3/ch3-stop.md")).unwrap();
    let reference = |value: &str, more: &str| {
        let text = STOP_REFERENCE.replace("1.75", value);
        desk.put("reference/ch3/ch3-stop.yaml", &format!("{}    {more}\n", text.trim_start_matches('\n')));
    };
    let (before, stamp) = (page(), fs::metadata(&picture).unwrap().modified().unwrap());
    reference("1.75", "explanation: It was looked at again.");
    assert_eq!((simulations(&desk), drawn(&desk)), (0, 0));
    assert_ne!(page(), before, "another explanation");
    assert_eq!(fs::metadata(&picture).unwrap().modified().unwrap(), stamp, "the file was not touched");

    reference("1.75", "tolerance: {absolute: 5, reason: to see whether it is loose}");
    assert_eq!((simulations(&desk), drawn(&desk)), (0, 1), "the tolerance is drawn about the quoted point");
    let whole = desk.bytes("reports/ch3/ch3-stop.png");

    reference("1.85", "");
    assert_eq!((simulations(&desk), drawn(&desk)), (0, 1), "another quoted point");
    assert!(desk.bytes("reports/ch3/ch3-stop.png") != whole);
    for (wanted, text) in [
        (0, STOP.replace("Two curves.", "Two lines.")),
        (1, STOP.replace("y: velocity_ratio", "y: velocity_ratio, markers: true")),
        (1, STOP.replace("by: [stop, solver]", "by: [solver, stop]")),
        (0, STOP.replace("title: Limit stop", "title: A stop").replace("by: [stop, solver]", "by: [solver, stop]")),
        (1, STOP.replace("[1, 2, 4]", "[1, 2, 3, 4]")),
    ] {
        desk.put(STOP_FILE, &text);
        simulations(&desk);
        assert_eq!(drawn(&desk), wanted, "{text}");
    }
    fs::write(&picture, "painted over").unwrap();
    assert_eq!((drawn(&desk), drawn(&desk)), (1, 0));
}
