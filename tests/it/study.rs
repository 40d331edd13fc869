//! A study runs what is stale, tells why, and leaves the same bytes whoever computes them.

use std::collections::BTreeMap;
use std::fs;
use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};

use shotdamp::measure::Evaluated;
use shotdamp::scene::Excitation;
use shotdamp::study::{
    Engine, Evaluate, Event, EventHandler, Heading, Held, IgnoreEvents, Inputs, Item, KnownRows, Loaded, Lock,
    RowFailure, Simulation, Snapshot, Study, Summary, Texts, row_in_words,
};

use crate::desk::{ASSUMPTIONS, Desk, GAP, GAP_REFERENCE, MadeUp, STOP, THREE_GAPS, shotdamp};

#[test]
fn the_bytes_do_not_depend_on_the_number_of_threads() {
    let tables = [1, 2, 8].map(|threads| {
        let desk = Desk::new();
        desk.run(threads, &MadeUp::default(), &IgnoreEvents);
        ["ch3-stop", "ch3-gap"]
            .map(|id| (desk.bytes(&format!("results/{id}.parquet")), desk.bytes(&format!("results/{id}.json"))))
    });
    assert!(tables[0] == tables[1] && tables[0] == tables[2]);
}

#[test]
fn equal_inputs_have_one_fingerprint_in_whatever_order_they_were_written() {
    let parsed = |text: &str| serde_json::from_str::<serde_json::Value>(text).unwrap();
    let one = Inputs::of([("scene", parsed(r#"{"gap": 5.0e-3, "mass": 1}"#)), ("solver", 8.into())]);
    let other = Inputs::of([("solver", 8.into()), ("scene", parsed(r#"{ "mass": 1, "gap": 0.005 }"#))]);
    assert_eq!(one, other);
    assert_eq!(one.fingerprint(), other.fingerprint());
    let third = Inputs::of([("solver", 8.into()), ("scene", parsed(r#"{"mass": 1, "gap": 0.006}"#))]);
    assert_ne!(one.fingerprint(), third.fingerprint());
    let changes = one.changes_to(&third);
    assert_eq!(changes.iter().map(|change| change.path.join(".")).collect::<Vec<_>>(), ["scene.gap"]);
}

#[test]
fn a_row_is_a_case_under_a_solver_in_a_variant() {
    let desk = Desk::new();
    let engine = MadeUp::default();
    desk.run(2, &engine, &IgnoreEvents);
    let table = desk.table("ch3-stop");
    // 3 amplitudes x with and without x 2 solvers, then each of 3 ends of the assumptions event-driven.
    assert_eq!(table.rows(), 12 + 3 * 6);
    assert_eq!(table.texts("variant").unwrap()[12], "impulse_factor=1.8");
    assert_eq!(table.texts("solver").unwrap()[..2], ["event_driven", "fixed_step_1e-4s"]);
    assert_eq!(table.floats("force_ratio").unwrap()[..5], [1.0, 1.0, 1.0, 1.0, 2.0]);
    let order: Vec<&str> = table.columns.iter().take(7).map(|column| column.name.as_str()).collect();
    let expected = ["force_ratio", "stop", "solver", "variant"];
    assert_eq!(order[..4], expected);
    assert_eq!(order[4..], ["velocity_ratio", "velocity_ratio_num", "velocity_ratio_spread"]);

    // Without a stop its length changes nothing: the baseline's numbers stand there, and nobody simulated them again.
    let ratio = table.floats("velocity_ratio").unwrap();
    let shorter = table.rows_where("variant", "stop_length=0.05");
    assert!((ratio[0] - ratio[shorter[0]] - 0.01).abs() < 1e-12);
    assert_eq!(ratio[2], ratio[shorter[1]]);
    // The maximum itself is simulated once more, as a result; points that come near it twice.
    let grid_and_rounds = 3 * (5 + 3 * 2 + 1);
    let simulations = engine.simulations.into_inner() - (12 + 2 * 6 + 3);
    assert!((grid_and_rounds..2 * grid_and_rounds).contains(&simulations), "{simulations}");
}

/// A residual of 0 would be read as a balance that closes to the last digit.
#[test]
fn of_a_row_that_nobody_audits_the_table_has_no_residual_and_the_row_counts() {
    let stopped = THREE_GAPS
        .replace(", sensitivity: none", "")
        .replace("floor: {", "stop: {length: assumed, restitution: 0}, ceiling: {resilient: {stiffness_ratio: 1, damping_ratio: 0.1}}, floor: {");
    let desk = Desk::of_one("experiments/ch3/ch3-long.yaml", &stopped);
    // Assumptions are moved for numbers that are compared.
    let entry =
        "{id: it, place: s. 3, says: It is 7., value: 7 m/s, from: {cell: {of: rms_velocity, where: {gap_ratio: 50}}}}";
    desk.put("reference/ch3/ch3-long.yaml", &format!("entries:\n  - {entry}\n"));
    for _ in ["from nothing", "from a table"] {
        assert_eq!(shotdamp(&desk, &["run", "--tables"]).code, 0);
        let table = desk.table("ch3-long");
        let variants = table.texts("variant").unwrap();
        assert!(variants.iter().any(|variant| variant == "stop_length=0.05"));
        for column in ["momentum_residual", "energy_residual"] {
            for (variant, residual) in variants.iter().zip(table.floats(column).unwrap()) {
                assert_eq!(residual.is_nan(), variant != "baseline", "{column} of {variant}: {residual}");
            }
        }
        assert!((0..table.rows()).all(|row| !table.is_unbalanced(row)));
        // All but one row is read from the table before.
        desk.put("experiments/ch3/ch3-long.yaml", &stopped.replace("[10, 50, 90]", "[10, 50, 90, 95]"));
    }
}

/// Nor do natural frequencies have a balance, for which nothing runs.
#[test]
fn a_row_without_a_run_has_no_residual_and_its_page_speaks_of_none() {
    let text = THREE_GAPS.replace("measure: [rms_velocity]", "measure: [natural_frequency]");
    let desk = Desk::of_one("experiments/ch3/ch3-still.yaml", &text);
    let entry = "{id: it, place: s. 3, says: It is 31., value: 31 rad/s, from: {cell: {of: natural_frequency, where: {gap_ratio: 50}}}}";
    desk.put("reference/ch3/ch3-still.yaml", &format!("entries:\n  - {entry}\n"));
    let said = shotdamp(&desk, &["run"]);
    assert!(said.code != 2, "{}", said.err);
    let table = desk.table("ch3-still");
    for column in ["momentum_residual", "energy_residual"] {
        assert!(table.floats(column).unwrap().iter().all(|residual| residual.is_nan()));
    }
    assert!((0..table.rows()).all(|row| !table.is_unbalanced(row)));
    assert_eq!(table.floats("members").unwrap(), [0.0; 3]);
    let page = String::from_utf8(desk.bytes("reports/ch3/ch3-still.md")).unwrap();
    assert!(
        page.contains("- event-driven: 3 rows, computed without a run.") && !page.contains("residual of"),
        "{page}"
    );
    assert!(page.contains("| no run |"), "{page}");
}

#[test]
fn a_row_is_called_by_what_is_swept_also_where_that_is_infinite() {
    let text = THREE_GAPS.replace("[10, 50, 90]", "[10, infinite]");
    let desk = Desk::of_one("experiments/ch3/ch3-long.yaml", &text);
    assert_eq!(shotdamp(&desk, &["run", "--tables"]).code, 0);
    let (plan, table) = (desk.plan(), desk.table("ch3-long"));
    let called = |row| row_in_words(&plan["ch3-long"].source.experiment, &table, row);
    assert_eq!([0, 1].map(called), ["h′ = 10", "h′ = ∞"]);
}

/// The equation of the mass measure is lost: its readings are compared, though no scene depends on them.
#[test]
fn a_measure_that_can_be_read_in_several_ways_is_computed_for_each_of_them() {
    let desk = Desk::new();
    let repository = std::path::Path::new(env!("CARGO_MANIFEST_DIR"));
    for name in ["experiments/assumptions.yaml", "experiments/ch5/ch5-measures-centre.yaml"] {
        desk.put(name, &fs::read_to_string(repository.join(name)).unwrap());
    }
    let item = &desk.plan()["ch5-measures-centre"];
    let extent = item.extent(&desk.layout, &KnownRows::nothing());
    // Clean, light and heavy: at the baseline, with another damper mass and two other dampings (which the clean plate lacks), another
    // impulse, and under two more readings.
    assert_eq!((extent.to_do, extent.rows), (3 + 2 + 2 * 2 + 3 + 2 * 3, 21));
}

#[test]
fn the_motion_is_named_under_the_assumptions_in_force_and_elsewhere_only_on_request() {
    let mut numbers = Vec::new();
    for (measures, everywhere) in
        [("[velocity_ratio, motion]", false), ("[velocity_ratio, motion, largest_multiplier]", true)]
    {
        let desk = Desk::new();
        let text = STOP.replace("[event_driven, {fixed_step: {time_step: 0.1 ms}}]", "event_driven");
        let text = text.replace("[velocity_ratio]", measures).replace("by: [stop, solver]", "by: stop");
        desk.put("experiments/ch3/ch3-stop.yaml", &text);
        desk.run(1, &Engine, &IgnoreEvents);
        let table = desk.table("ch3-stop");
        let (motions, variants) = (table.texts("motion").unwrap(), table.texts("variant").unwrap());
        assert!(variants.iter().any(|variant| variant == "stop_length=0.05"));
        for row in table.rows_where("stop", "with") {
            let is_named = variants[row] == "baseline" || everywhere;
            assert_eq!(motions[row].is_empty(), !is_named, "{}: {}", variants[row], motions[row]);
        }
        assert!(table.column("undefined").is_none());
        numbers.push(table.floats("velocity_ratio").unwrap().to_vec());
    }
    assert_eq!(numbers[0], numbers[1]);
}

#[test]
fn a_maximum_is_found_between_the_points_of_the_grid() {
    let desk = Desk::new();
    desk.run(2, &MadeUp::default(), &IgnoreEvents);
    let table = desk.table("ch3-gap");
    let at = table.floats("base_amplitude_ratio_at_maximum").unwrap();
    let within = table.floats("base_amplitude_ratio_at_maximum_num").unwrap();
    let gap = table.floats("gap_ratio").unwrap();
    assert_eq!(gap[2], f64::INFINITY);
    for row in 0..3 {
        let exact = 2.0 * (gap[row] * 9.81 / 1000.0).min(1.0).sqrt();
        assert!((at[row] - exact).abs() <= within[row] && within[row] < 0.3 * exact, "{at:?} {within:?}");
    }
}

#[test]
fn one_bad_case_is_a_row_and_a_panic_is_one_too() {
    struct Bad;
    impl Evaluate for Bad {
        fn evaluate(&self, it: &Simulation<'_>) -> Result<Evaluated, RowFailure> {
            let Excitation::ImpulseTrain { impulse, .. } = it.recipe.resolve(it.assumptions).unwrap().excitation else {
                return MadeUp::default().evaluate(it);
            };
            if it.recipe.dampers[0].stop.is_none() {
                assert!(impulse > 1.0, "made to fail");
                return Err(RowFailure::NoValue("velocity_ratio".into()));
            }
            MadeUp::default().evaluate(it)
        }
    }
    let desk = Desk::new();
    desk.run(2, &Bad, &IgnoreEvents);
    let table = desk.table("ch3-stop");
    let failure = table.texts("failure").unwrap();
    assert_eq!(failure[0], "");
    assert!(failure[2].contains("made to fail"), "{}", failure[2]);
    assert!(failure.contains(&"velocity_ratio has no value".to_owned()));
    assert!(table.floats("velocity_ratio").unwrap()[2].is_nan());
    assert!(desk.table("ch3-gap").texts("failure").unwrap().iter().all(String::is_empty));
    // Failed rows are tried again, and the others are not.
    assert!(desk.why("ch3-stop")[0].contains("rows failed"));
    assert_eq!(desk.run(1, &MadeUp::default(), &IgnoreEvents), ["ch3-stop"]);
    assert_eq!(desk.why("ch3-stop"), [""; 0]);
}

#[test]
fn a_maximum_over_a_range_with_a_hole_is_none() {
    struct Hole;
    impl Evaluate for Hole {
        fn evaluate(&self, it: &Simulation<'_>) -> Result<Evaluated, RowFailure> {
            match it.recipe.resolve(it.assumptions).unwrap().excitation {
                Excitation::Harmonic { force, .. } if force.abs() > 50.0 => {
                    Err(RowFailure::NoValue("velocity_ratio".into()))
                }
                _ => MadeUp::default().evaluate(it),
            }
        }
    }
    let desk = Desk::new();
    desk.run(4, &Hole, &IgnoreEvents);
    assert_eq!(
        desk.table("ch3-gap").texts("failure").unwrap()[0],
        "at base_amplitude_ratio = 10: velocity_ratio has no value"
    );
}

#[test]
fn what_is_up_to_date_does_not_run_and_a_comment_changes_nothing() {
    let desk = Desk::new();
    assert_eq!(desk.run(2, &MadeUp::default(), &IgnoreEvents), ["ch3-gap", "ch3-stop"]);
    assert_eq!(desk.run(2, &MadeUp::default(), &IgnoreEvents), [""; 0]);
    let same_meaning = STOP
        .replace("mass: 1 kg", "mass: 1000 g")
        .replace("title: Limit stop", "title: Another title")
        .replace("by: [stop, solver]", "by: [solver, stop]");
    desk.put("experiments/ch3/ch3-stop.yaml", &format!("# a comment\n{same_meaning}"));
    desk.put("experiments/assumptions.yaml", &ASSUMPTIONS.replace("60 mm", "6 cm").replace("fits", "said better"));
    assert_eq!(desk.run(2, &MadeUp::default(), &IgnoreEvents), [""; 0]);
}

#[test]
fn a_changed_input_is_named_with_file_key_and_values() {
    let desk = Desk::new();
    desk.run(2, &MadeUp::default(), &IgnoreEvents);
    desk.put("experiments/assumptions.yaml", &ASSUMPTIONS.replace("60 mm", "55 mm"));
    assert_eq!(desk.why("ch3-gap"), [""; 0], "it has no limit stop");
    assert_eq!(desk.why("ch3-stop"), ["experiments/assumptions.yaml: stop_length: 0.06 -> 0.055"]);
    desk.put("experiments/assumptions.yaml", ASSUMPTIONS);
    assert_eq!(desk.why("ch3-stop"), [""; 0], "back to what it was");

    desk.put("experiments/ch3/ch3-gap.yaml", &GAP.replace("mass: 1 kg", "mass: 2 kg"));
    assert_eq!(desk.why("ch3-gap"), ["experiments/ch3/ch3-gap.yaml: scene.structure.single_mass.mass: 1.0 -> 2.0"]);
    assert_eq!(desk.run(2, &MadeUp::default(), &IgnoreEvents), ["ch3-gap"]);

    // A published number asks for the ends of the assumptions, a claim does not; where there are none it changes nothing.
    let number = "value: \"1.5\"\n    from: {maximum: {of: velocity_ratio, over: gap_ratio}}";
    let (before, _) = GAP_REFERENCE.split_once("claim").unwrap();
    desk.put("reference/ch3/ch3-gap.yaml", &format!("{before}{number}\n"));
    assert_eq!(desk.why("ch3-gap"), [""; 0]);
    desk.put("reference/ch3/ch3-stop.yaml", &GAP_REFERENCE.replace("gap_ratio", "force_ratio"));
    let why = desk.why("ch3-stop");
    assert!(why[0].starts_with("reference of ch3-stop: sensitivity: ") && why[0].ends_with(" -> null"), "{why:?}");
    assert_eq!(desk.run(2, &MadeUp::default(), &IgnoreEvents), ["ch3-stop"]);

    let longer =
        GAP.replace("mass: 1 kg", "mass: 2 kg").replace("[10, 50, infinite]", "[20, 60, 90, 95, 99, infinite]");
    desk.put("experiments/ch3/ch3-gap.yaml", &longer);
    let why = desk.why("ch3-gap");
    assert!(why.len() == 4 && why[3].ends_with("more"), "a long sweep is not listed leaf by leaf: {why:?}");
}

#[test]
fn damaged_results_are_noticed_and_made_again() {
    let desk = Desk::new();
    desk.run(2, &MadeUp::default(), &IgnoreEvents);
    let name = desk.layout.path("results/ch3-gap.parquet");
    let whole = fs::read(&name).unwrap();
    for damage in [whole[..whole.len() / 2].to_vec(), [&whole[1..], b"!"].concat(), Vec::new()] {
        fs::write(&name, damage).unwrap();
        assert_eq!(desk.why("ch3-gap"), ["results/ch3-gap.parquet is not what was written"]);
        assert_eq!(desk.run(2, &MadeUp::default(), &IgnoreEvents), ["ch3-gap"]);
        assert_eq!(fs::read(&name).unwrap(), whole, "the same bytes again");
    }
    fs::remove_file(&name).unwrap();
    assert_eq!(desk.why("ch3-gap"), ["results/ch3-gap.parquet is missing"]);
    desk.put("results/ch3-stop.json", "{\"format\": 0}");
    assert!(desk.why("ch3-stop")[0].starts_with("its record cannot be used"));
    // A renamed record is that of another experiment.
    fs::copy(desk.layout.path("results/ch3-gap.json"), desk.layout.path("results/ch3-stop.json")).unwrap();
    assert!(desk.why("ch3-stop")[0].contains("belongs to ch3-gap"));
}

/// Between table and record a kill leaves a new table with the record of the old one: that must not pass for done.
#[test]
fn a_table_counts_only_with_its_record() {
    let desk = Desk::new();
    desk.run(2, &MadeUp::default(), &IgnoreEvents);
    let old = desk.bytes("results/ch3-gap.json");
    desk.put("experiments/ch3/ch3-gap.yaml", &GAP.replace("mass: 1 kg", "mass: 2 kg"));
    desk.run(2, &MadeUp::default(), &IgnoreEvents);
    fs::write(desk.layout.path("results/ch3-gap.json"), old).unwrap();
    desk.put("experiments/ch3/ch3-gap.yaml", GAP);
    assert_eq!(desk.why("ch3-gap"), ["results/ch3-gap.parquet is not what was written"]);
}

#[test]
fn an_input_edited_during_the_run_is_stale_afterwards() {
    struct Editor<'a>(&'a Desk, MadeUp);
    impl Evaluate for Editor<'_> {
        fn evaluate(&self, it: &Simulation<'_>) -> Result<Evaluated, RowFailure> {
            self.0.put("experiments/ch3/ch3-gap.yaml", &GAP.replace("mass: 1 kg", "mass: 3 kg"));
            self.1.evaluate(it)
        }
    }
    let desk = Desk::new();
    let before = desk.texts();
    desk.run(1, &Editor(&desk, MadeUp::default()), &IgnoreEvents);
    assert!(desk.why("ch3-gap")[0].contains("1.0 -> 3.0"));
    take_snapshot(&desk, &before);
    let known = Snapshot::current(&desk.layout, &desk.texts()).experiments;
    assert_eq!(known.keys().collect::<Vec<_>>(), ["ch3-stop"], "the edited one is not known to be up to date");
}

#[test]
fn the_snapshot_knows_an_experiment_until_one_of_its_inputs_or_outputs_changes() {
    let desk = Desk::new();
    desk.run(2, &MadeUp::default(), &IgnoreEvents);
    let page = |middle| format!("{}{middle}{}", "head\n".repeat(4000), "tail\n".repeat(4000));
    let take = || take_snapshot(&desk, &desk.texts());
    let known = || {
        let current = Snapshot::current(&desk.layout, &desk.texts());
        (current.index_is_current, current.experiments.into_keys().collect::<Vec<_>>())
    };
    let both = || (true, vec!["ch3-gap".to_owned(), "ch3-stop".to_owned()]);
    let one = |id: &str| (true, vec![id.to_owned()]);
    desk.put("reports/ch3/ch3-gap.md", &page("1.52"));
    desk.put("reports/ch3/ch3-stop.md", "stop");
    desk.put("reports/README.md", "index");
    assert_eq!(known(), (false, vec![]), "none taken");
    take();
    assert_eq!(known(), both());

    desk.put("experiments/ch3/ch3-gap.yaml", &format!("{GAP}# comment\n"));
    assert_eq!(known(), one("ch3-stop"), "a comment is for the plan to judge");
    desk.put("experiments/ch3/ch3-gap.yaml", GAP);
    assert_eq!(known(), both());
    desk.put("experiments/ch4/ch3-gap.yaml", GAP);
    assert_eq!(known(), one("ch3-stop"), "a second file of the same id");
    fs::remove_file(desk.layout.path("experiments/ch4/ch3-gap.yaml")).unwrap();

    // An experiment depends on the assumptions that it uses, and every verdict on those that were fitted.
    let assume = |old: &str, new: &str| desk.put("experiments/assumptions.yaml", &ASSUMPTIONS.replace(old, new));
    assume("60 mm", "61 mm");
    assert_eq!(known(), (false, vec!["ch3-gap".to_owned()]), "only one has a stop");
    assume("stop_length: stop_length,", "");
    assert_eq!(known(), (false, vec![]), "whatever an experiment leaves out may be another thing now");
    assume("reason: plastic", "reason: plastic, fitted_to: [ch3-stop/at-two]");
    assert_eq!(known(), (false, vec![]));
    desk.put("experiments/assumptions.yaml", ASSUMPTIONS);
    desk.put("calibrations/new.yaml", "title: x\n");
    assert_eq!(known(), (false, vec![]), "a calibration says which entries are fitted");
    fs::remove_file(desk.layout.path("calibrations/new.yaml")).unwrap();
    assert_eq!(known(), both());

    desk.put("reports/ch3/ch3-gap.md", &page("1.53"));
    assert_eq!(known(), one("ch3-stop"), "one digit of a long report");
    take();
    assert_eq!(known(), both());
    let name = "results/ch3-gap.parquet";
    let mut bytes = desk.bytes(name);
    bytes[100] ^= 1;
    fs::write(desk.layout.path(name), &bytes).unwrap();
    assert_eq!(known(), one("ch3-stop"), "a flipped bit");

    let mut bytes = desk.bytes("results/snapshot.bin");
    let middle = bytes.len() / 2;
    bytes[middle] ^= 1;
    fs::write(desk.layout.path("results/snapshot.bin"), &bytes).unwrap();
    assert_eq!(known(), (false, vec![]), "a damaged snapshot counts as none");
}

/// Writes down that all of the study is up to date, over these texts.
fn take_snapshot(desk: &Desk, texts: &Texts) {
    let study = Study::new(desk.layout.clone(), texts.clone());
    let summary = |item: &Item| Summary {
        heading: Heading::of(&item.source.experiment),
        folder: "ch3".into(),
        used: item.used.clone(),
        table: item.record().unwrap().table.blake3.clone(),
        reads: BTreeMap::new(),
        judged: Vec::new(),
        lines: Vec::new(),
        motions: None,
    };
    let files = |id: &str| {
        let page = format!("reports/ch3/{id}.md");
        let page = desk.layout.path(&page).is_file().then_some(page);
        page.into_iter().chain([format!("results/{id}.parquet")]).collect()
    };
    let published = study.items.iter().map(|item| {
        let id = item.source.experiment.id.to_string();
        (id.clone(), (files(&id), summary(item)))
    });
    let index = desk.layout.path("reports/README.md").is_file().then(|| "reports/README.md".to_owned());
    let index = index.into_iter().collect();
    Snapshot::take(&desk.layout, texts, &study.sheet, &[].into(), published.collect(), &index).unwrap();
}

#[test]
fn every_simulation_is_reported_once() {
    #[derive(Default)]
    struct Ear(Mutex<Vec<String>>, AtomicUsize);
    impl EventHandler for Ear {
        fn on_event(&self, event: &Event<'_>) {
            match event {
                Event::Begun { simulations, .. } => self.0.lock().unwrap().push(format!("{simulations} to do")),
                Event::Simulated { count, .. } => {
                    self.1.fetch_add(usize::try_from(*count).unwrap(), Ordering::Relaxed);
                }
                Event::Finished { experiment, rows, .. } => {
                    self.0.lock().unwrap().push(format!("{experiment}: {rows} rows"));
                }
                Event::Searched { .. } | Event::Tried { .. } => panic!("nothing is searched for here"),
                Event::Interrupted { .. } => panic!("nothing is interrupted here"),
                Event::Ended => self.0.lock().unwrap().push("ended".into()),
            }
        }
    }
    let ear = Ear::default();
    Desk::new().run(2, &MadeUp::default(), &ear);
    let mut heard = ear.0.into_inner().unwrap();
    assert_eq!((heard.remove(0).as_str(), heard.pop().unwrap().as_str()), ("135 to do", "ended"));
    heard.sort();
    assert_eq!(heard, ["ch3-gap: 3 rows", "ch3-stop: 30 rows"]);
    assert_eq!(ear.1.into_inner(), 135);
}

#[test]
fn files_that_are_no_experiments_are_told_and_the_others_load() {
    let desk = Desk::new();
    desk.put("experiments/ch3/ch3-later.yml", STOP);
    desk.put("experiments/ch3/ch3-gap.yml", GAP);
    desk.put("experiments/ch4/ch3-stop.yaml", STOP);
    desk.put("experiments/ch3/not an id.yaml", STOP);
    desk.put("experiments/ch3/ch3-wrong.yaml", &STOP.replace("1 kg", "1 s"));
    fs::write(desk.layout.path("experiments/ch3/ch3-latin.yaml"), b"title: \xe9\n").unwrap();
    let loaded = Loaded::from_texts(&desk.texts());
    assert_eq!(loaded.sources.len(), 1);
    let description: Vec<String> = loaded.refused.iter().map(ToString::to_string).collect();
    assert_eq!(description.len(), 7, "{description:#?}");
    let says = |words: &[&str]| description.iter().any(|line| words.iter().all(|word| line.contains(word)));
    assert!(says(&["ch3-later.yml", "rename it"]));
    assert!(says(&["ch4/ch3-stop.yaml: experiments/ch3", "same id"]), "neither of two is chosen");
    assert!(says(&["ch3/ch3-stop.yaml: experiments/ch4", "same id"]));
    assert!(says(&["not an id.yaml"]) && says(&["ch3-latin.yaml", "UTF-8"]));
    assert!(says(&["ch3-wrong.yaml:6:"]));
}

#[test]
fn two_runs_at_once_take_turns() {
    let desk = Desk::new();
    let first = Lock::of_study(&desk.layout, |_| panic!("nobody else is there")).unwrap();
    let held = Lock::of_study(&desk.layout, |_| Held::GiveUp).unwrap_err().to_string();
    assert!(held.contains(&format!("process {}", std::process::id())), "{held}");
    let (tell, description) = std::sync::mpsc::channel();
    std::thread::scope(|scope| {
        let layout = &desk.layout;
        let wait = move |holder: &str| {
            tell.send(holder.to_owned()).unwrap();
            Held::Wait
        };
        let second = scope.spawn(move || Lock::of_study(layout, wait).unwrap());
        assert!(description.recv().unwrap().contains("process "));
        assert!(!second.is_finished());
        drop(first);
        second.join().unwrap();
    });
}
