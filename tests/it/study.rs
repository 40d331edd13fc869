//! A study runs what is stale, tells why, and leaves the same bytes whoever computes them.

use std::collections::BTreeMap;
use std::fs;
use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};

use shotdamp::dynamics::Proof;
use shotdamp::measure::{Evaluated, Measured, TraceColumn};
use shotdamp::scene::{Excitation, Structure};
use shotdamp::spec::SolverChoice;
use shotdamp::study::{
    self, Evaluate, Event, Item, Layout, Listen, Loaded, Lock, Reason, Sensitivity, Silence, Simulation, Snapshot,
    Task, Texts,
};
use shotdamp::table::{Table, parquet};

const ASSUMPTIONS: &str = "
gravity: {value: 9.81 m/s^2, reason: usual}
impulse_factor: {value: 2, range: [1.8, 2.2], reason: half sine}
impulse_frequency: {value: natural, reason: fixed}
impulse_reference: {value: base, reason: plain}
harmonic_reference: {value: base, reason: plain}
undamped_mass: {value: base, reason: plain}
contact_damping_ratio: {value: 0.15, reason: fits}
stop_length: {value: 60 mm, range: [50 mm], reason: fits}
stop_restitution: {value: 0, reason: plastic}
";

const STOP: &str = "
title: Limit stop
source: {chapter: 3, section: '3.6.3', shown_in: [Fig. 18]}
about: With and without.
scene:
  structure: {single_mass: {mass: 1 kg, stiffness: 1000 N/m, damping_ratio: 0.05}}
  dampers:
    - mass_ratio: 0.05
      gap_ratio: 50
      floor: {resilient: {stiffness_ratio: 1, damping_ratio: assumed}}
      stop: {length: assumed, restitution: assumed}
  excitation: {impulse_train: {force_ratio: swept, frequency_ratio: 1}}
sweep: {force_ratio: [1, 2, 4], stop: [with, without]}
run: {solver: [event_driven, {fixed_step: {time_step: 0.1 ms}}], skip: 25 cycles, average: 100 cycles}
measure: [velocity_ratio]
figure: {x: force_ratio, y: velocity_ratio, by: [stop, solver], caption: Two curves.}
";

const GAP: &str = "
title: Gap
source: {chapter: 3, section: '3.6.1', shown_in: [Fig. 16]}
about: Largest ratio.
scene:
  structure: {single_mass: {mass: 1 kg, stiffness: 1000 N/m, damping_ratio: 0.05}}
  dampers: [{mass_ratio: 0.05, gap_ratio: swept, floor: {rigid: {restitution: 0}}}]
  excitation: {harmonic: {base_amplitude_ratio: swept, frequency_ratio: 1}}
sweep: {gap_ratio: [10, 50, infinite]}
maximise:
  velocity_ratio: {over: base_amplitude_ratio, in: {log: {from: 0.1, to: 10, points: 5}}, refine: 3}
run: {solver: event_driven, skip: 25 cycles, average: 100 cycles}
measure: [velocity_ratio, displacement_ratio]
figure: {x: gap_ratio, y: velocity_ratio, caption: One curve.}
";

/// A study in a folder of its own.
struct Desk {
    folder: tempfile::TempDir,
    layout: Layout,
}

impl Desk {
    fn new() -> Self {
        let folder = tempfile::tempdir().unwrap();
        let layout = Layout::new(folder.path());
        let desk = Self { folder, layout };
        desk.put("experiments/assumptions.yaml", ASSUMPTIONS);
        desk.put("experiments/ch3/ch3-stop.yaml", STOP);
        desk.put("experiments/ch3/ch3-gap.yaml", GAP);
        desk
    }

    fn put(&self, name: &str, text: &str) {
        let path = self.folder.path().join(name);
        fs::create_dir_all(path.parent().unwrap()).unwrap();
        fs::write(path, text).unwrap();
    }

    fn bytes(&self, name: &str) -> Vec<u8> {
        fs::read(self.folder.path().join(name)).unwrap()
    }

    fn texts(&self) -> Texts {
        Texts::read(&self.layout).unwrap()
    }

    /// The plan by id; `ch3-stop` has values to be held against, `ch3-gap` has none.
    fn plan(&self) -> BTreeMap<String, Item> {
        let loaded = Loaded::from_texts(&self.texts());
        assert_eq!(loaded.refused, []);
        let plan = |source: study::Source| {
            let id = source.experiment.id.to_string();
            let wanted = if id == "ch3-stop" { Sensitivity::Wanted } else { Sensitivity::NotWanted };
            (id, Item::new(&self.layout, source, &loaded.sheet, wanted))
        };
        loaded.sources.into_iter().map(plan).collect()
    }

    /// Runs what is stale and returns the ids.
    fn run(&self, threads: usize, evaluate: &impl Evaluate, listener: &dyn Listen) -> Vec<String> {
        let plan = self.plan();
        let stale: Vec<&Item> = plan.values().filter(|item| !item.reasons().is_empty()).collect();
        let provenance: Vec<_> = stale.iter().map(|item| item.provenance()).collect();
        let tasks: Vec<Task<'_>> = stale
            .iter()
            .zip(&provenance)
            .map(|(item, metadata)| Task { experiment: &item.source.experiment, variants: &item.variants, metadata })
            .collect();
        let save = |index: usize, finished| study::save(&self.layout, stale[index], &finished).unwrap();
        study::run(&tasks, threads, evaluate, listener, save).unwrap();
        stale.iter().map(|item| item.source.experiment.id.to_string()).collect()
    }

    fn table(&self, id: &str) -> Table {
        parquet::read(&self.layout.path(&format!("results/{id}.parquet"))).unwrap()
    }

    fn why(&self, id: &str) -> Vec<String> {
        self.plan()[id].reasons().iter().map(Reason::to_string).collect()
    }
}

/// Stands in for the engine: smooth made-up numbers of the resolved scene, with a maximum over the strength of the forcing.
#[derive(Default)]
struct MadeUp {
    simulations: AtomicUsize,
}

impl Evaluate for MadeUp {
    fn evaluate(&self, it: &Simulation<'_>) -> Result<Evaluated, String> {
        self.simulations.fetch_add(1, Ordering::Relaxed);
        let scene = it.recipe.resolve(it.assumptions).map_err(|error| error.to_string())?;
        let strength = match scene.excitation {
            Excitation::Harmonic { force, .. } => force.abs() / 9.81,
            Excitation::ImpulseTrain { impulse, .. } => impulse,
            _ => return Err("not in this test".into()),
        };
        let Structure::SingleMass { mass, .. } = scene.structure;
        let damper = &scene.dampers[0];
        let stop = damper.stop.map_or(0.0, |stop| stop.length);
        let coarse = if it.solver == SolverChoice::EventDriven { 0.0 } else { 0.01 };
        let peak = damper.gap.min(1.0).sqrt();
        let value = mass + peak / (1.0 + (strength / (2.0 * peak)).ln().powi(2)) + stop + coarse;
        Ok(Evaluated {
            measured: it.measures.iter().map(|_| Measured { value, numerical: 1e-12, spread: 0.0 }).collect(),
            proof: Proof { events: 490, smallest_margin: 1e-3, ..Proof::default() },
            chaotic: false,
            members: 1,
            trace: it
                .trace
                .map(|_| vec![TraceColumn { name: "time", unit: "s", samples: vec![0.0, 1.0] }])
                .unwrap_or_default(),
        })
    }
}

#[test]
fn the_bytes_do_not_depend_on_the_number_of_threads() {
    let tables = [1, 2, 8].map(|threads| {
        let desk = Desk::new();
        desk.run(threads, &MadeUp::default(), &Silence);
        ["ch3-stop", "ch3-gap"]
            .map(|id| (desk.bytes(&format!("results/{id}.parquet")), desk.bytes(&format!("results/{id}.json"))))
    });
    assert!(tables[0] == tables[1] && tables[0] == tables[2]);
}

#[test]
fn a_row_is_a_case_under_a_solver_in_a_variant() {
    let desk = Desk::new();
    let engine = MadeUp::default();
    desk.run(2, &engine, &Silence);
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
    let grid_and_rounds = 3 * (5 + 3 * 2);
    assert_eq!(engine.simulations.into_inner(), 12 + 2 * 6 + 3 + grid_and_rounds);
}

#[test]
fn a_maximum_is_found_between_the_points_of_the_grid() {
    let desk = Desk::new();
    desk.run(2, &MadeUp::default(), &Silence);
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
        fn evaluate(&self, it: &Simulation<'_>) -> Result<Evaluated, String> {
            let Excitation::ImpulseTrain { impulse, .. } = it.recipe.resolve(it.assumptions).unwrap().excitation else {
                return MadeUp::default().evaluate(it);
            };
            if it.recipe.dampers[0].stop.is_none() {
                assert!(impulse > 1.0, "made to fail");
                return Err("too hard".into());
            }
            MadeUp::default().evaluate(it)
        }
    }
    let desk = Desk::new();
    desk.run(2, &Bad, &Silence);
    let table = desk.table("ch3-stop");
    let failure = table.texts("failure").unwrap();
    assert_eq!(failure[0], "");
    assert!(failure[2].contains("made to fail"), "{}", failure[2]);
    assert!(failure.contains(&"too hard".to_owned()));
    assert!(table.floats("velocity_ratio").unwrap()[2].is_nan());
    assert!(desk.table("ch3-gap").texts("failure").unwrap().iter().all(String::is_empty));
    // Failed rows are tried again, and the others are not.
    assert!(desk.why("ch3-stop")[0].contains("rows failed"));
    assert_eq!(desk.run(1, &MadeUp::default(), &Silence), ["ch3-stop"]);
    assert_eq!(desk.why("ch3-stop"), [""; 0]);
}

#[test]
fn a_maximum_over_a_range_with_a_hole_is_none() {
    struct Hole;
    impl Evaluate for Hole {
        fn evaluate(&self, it: &Simulation<'_>) -> Result<Evaluated, String> {
            match it.recipe.resolve(it.assumptions).unwrap().excitation {
                Excitation::Harmonic { force, .. } if force.abs() > 50.0 => Err("did not settle".into()),
                _ => MadeUp::default().evaluate(it),
            }
        }
    }
    let desk = Desk::new();
    desk.run(4, &Hole, &Silence);
    assert_eq!(desk.table("ch3-gap").texts("failure").unwrap()[0], "at base_amplitude_ratio = 10: did not settle");
}

#[test]
fn what_is_up_to_date_does_not_run_and_a_comment_changes_nothing() {
    let desk = Desk::new();
    assert_eq!(desk.run(2, &MadeUp::default(), &Silence), ["ch3-gap", "ch3-stop"]);
    assert_eq!(desk.run(2, &MadeUp::default(), &Silence), [""; 0]);
    let same_meaning = STOP
        .replace("mass: 1 kg", "mass: 1000 g")
        .replace("title: Limit stop", "title: Another title")
        .replace("by: [stop, solver]", "by: [solver, stop]");
    desk.put("experiments/ch3/ch3-stop.yaml", &format!("# a comment\n{same_meaning}"));
    desk.put("experiments/assumptions.yaml", &ASSUMPTIONS.replace("60 mm", "6 cm").replace("fits", "said better"));
    assert_eq!(desk.run(2, &MadeUp::default(), &Silence), [""; 0]);
}

#[test]
fn a_changed_input_is_named_with_file_key_and_values() {
    let desk = Desk::new();
    desk.run(2, &MadeUp::default(), &Silence);
    desk.put("experiments/assumptions.yaml", &ASSUMPTIONS.replace("60 mm", "55 mm"));
    assert_eq!(desk.why("ch3-gap"), [""; 0], "it has no limit stop");
    assert_eq!(desk.why("ch3-stop"), ["experiments/assumptions.yaml: stop_length: 0.06 -> 0.055"]);
    desk.put("experiments/assumptions.yaml", ASSUMPTIONS);
    assert_eq!(desk.why("ch3-stop"), [""; 0], "back to what it was");

    desk.put("experiments/ch3/ch3-gap.yaml", &GAP.replace("mass: 1 kg", "mass: 2 kg"));
    assert_eq!(desk.why("ch3-gap"), ["experiments/ch3/ch3-gap.yaml: scene.structure.single_mass.mass: 1.0 -> 2.0"]);
    assert_eq!(desk.run(2, &MadeUp::default(), &Silence), ["ch3-gap"]);

    let longer =
        GAP.replace("mass: 1 kg", "mass: 2 kg").replace("[10, 50, infinite]", "[20, 60, 90, 95, 99, infinite]");
    desk.put("experiments/ch3/ch3-gap.yaml", &longer);
    let why = desk.why("ch3-gap");
    assert!(why.len() == 4 && why[3].ends_with("more"), "a long sweep is not told leaf by leaf: {why:?}");
}

#[test]
fn damaged_results_are_noticed_and_made_again() {
    let desk = Desk::new();
    desk.run(2, &MadeUp::default(), &Silence);
    let name = desk.layout.path("results/ch3-gap.parquet");
    let whole = fs::read(&name).unwrap();
    for damage in [whole[..whole.len() / 2].to_vec(), [&whole[1..], b"!"].concat(), Vec::new()] {
        fs::write(&name, damage).unwrap();
        assert_eq!(desk.why("ch3-gap"), ["results/ch3-gap.parquet is not what was written"]);
        assert_eq!(desk.run(2, &MadeUp::default(), &Silence), ["ch3-gap"]);
        assert_eq!(fs::read(&name).unwrap(), whole, "the same bytes again");
    }
    fs::remove_file(&name).unwrap();
    assert_eq!(desk.why("ch3-gap"), ["results/ch3-gap.parquet is missing"]);
    desk.put("results/ch3-stop.json", "{\"format\": 0}");
    assert!(desk.why("ch3-stop")[0].starts_with("its record does not count"));
    // A record that was renamed speaks of another experiment.
    fs::copy(desk.layout.path("results/ch3-gap.json"), desk.layout.path("results/ch3-stop.json")).unwrap();
    assert!(desk.why("ch3-stop")[0].contains("belongs to ch3-gap"));
}

/// Between table and record a kill leaves a new table with the record of the old one: that must not pass for done.
#[test]
fn a_table_counts_only_with_its_record() {
    let desk = Desk::new();
    desk.run(2, &MadeUp::default(), &Silence);
    let old = desk.bytes("results/ch3-gap.json");
    desk.put("experiments/ch3/ch3-gap.yaml", &GAP.replace("mass: 1 kg", "mass: 2 kg"));
    desk.run(2, &MadeUp::default(), &Silence);
    fs::write(desk.layout.path("results/ch3-gap.json"), old).unwrap();
    desk.put("experiments/ch3/ch3-gap.yaml", GAP);
    assert_eq!(desk.why("ch3-gap"), ["results/ch3-gap.parquet is not what was written"]);
}

#[test]
fn an_input_edited_during_the_run_is_stale_afterwards() {
    struct Editor<'a>(&'a Desk, MadeUp);
    impl Evaluate for Editor<'_> {
        fn evaluate(&self, it: &Simulation<'_>) -> Result<Evaluated, String> {
            self.0.put("experiments/ch3/ch3-gap.yaml", &GAP.replace("mass: 1 kg", "mass: 3 kg"));
            self.1.evaluate(it)
        }
    }
    let desk = Desk::new();
    let before = desk.texts();
    desk.run(1, &Editor(&desk, MadeUp::default()), &Silence);
    assert!(desk.why("ch3-gap")[0].contains("1.0 -> 3.0"));
    Snapshot::take(&desk.layout, &before, ["results/ch3-gap.parquet".to_owned()], "done", 0).unwrap();
    assert_eq!(Snapshot::current(&desk.layout, &desk.texts()), None);
}

#[test]
fn the_snapshot_holds_until_any_input_or_output_changes() {
    let desk = Desk::new();
    desk.run(2, &MadeUp::default(), &Silence);
    let outputs = || ["results/ch3-gap.parquet", "results/ch3-stop.parquet"].map(str::to_owned);
    let take = || Snapshot::take(&desk.layout, &desk.texts(), outputs(), "all done", 1).unwrap();
    let holds = || Snapshot::current(&desk.layout, &desk.texts()).is_some();
    assert!(!holds(), "none taken");
    take();
    let snapshot = Snapshot::current(&desk.layout, &desk.texts()).unwrap();
    assert_eq!((snapshot.summary.as_str(), snapshot.exit_code), ("all done", 1));

    desk.put("experiments/ch3/ch3-gap.yaml", &format!("{GAP}# comment\n"));
    assert!(!holds(), "a comment is for the plan to judge");
    desk.put("experiments/ch3/ch3-gap.yaml", GAP);
    assert!(holds());
    desk.put("reference/ch3/ch3-gap.yaml", "entries: []\n");
    assert!(!holds(), "a new file");
    fs::remove_dir_all(desk.layout.path("reference")).unwrap();
    assert!(holds());
    let name = "results/ch3-gap.parquet";
    let mut bytes = desk.bytes(name);
    bytes[100] ^= 1;
    fs::write(desk.layout.path(name), &bytes).unwrap();
    assert!(!holds(), "a flipped bit");
}

#[test]
fn listeners_hear_every_simulation_once() {
    #[derive(Default)]
    struct Ear(Mutex<Vec<String>>, AtomicUsize);
    impl Listen for Ear {
        fn hear(&self, event: &Event<'_>) {
            match event {
                Event::Begun { simulations, .. } => self.0.lock().unwrap().push(format!("{simulations} to do")),
                Event::Simulated { count, .. } => {
                    self.1.fetch_add(usize::try_from(*count).unwrap(), Ordering::Relaxed);
                }
                Event::Finished { experiment, rows, .. } => {
                    self.0.lock().unwrap().push(format!("{experiment}: {rows} rows"));
                }
                Event::Ended => self.0.lock().unwrap().push("ended".into()),
            }
        }
    }
    let ear = Ear::default();
    Desk::new().run(2, &MadeUp::default(), &ear);
    let mut heard = ear.0.into_inner().unwrap();
    assert_eq!((heard.remove(0).as_str(), heard.pop().unwrap().as_str()), ("60 to do", "ended"));
    heard.sort();
    assert_eq!(heard, ["ch3-gap: 3 rows", "ch3-stop: 30 rows"]);
    assert_eq!(ear.1.into_inner(), 60);
}

#[test]
fn files_that_are_no_experiments_are_told_and_the_others_load() {
    let desk = Desk::new();
    desk.put("experiments/ch3/ch3-later.yml", STOP);
    desk.put("experiments/ch4/ch3-stop.yaml", STOP);
    desk.put("experiments/ch3/not an id.yaml", STOP);
    desk.put("experiments/ch3/ch3-wrong.yaml", &STOP.replace("1 kg", "1 s"));
    fs::write(desk.layout.path("experiments/ch3/ch3-latin.yaml"), b"title: \xe9\n").unwrap();
    let loaded = Loaded::from_texts(&desk.texts());
    assert_eq!(loaded.sources.len(), 2);
    let told: Vec<String> = loaded.refused.iter().map(ToString::to_string).collect();
    assert_eq!(told.len(), 5, "{told:#?}");
    let says = |words: &[&str]| told.iter().any(|line| words.iter().all(|word| line.contains(word)));
    assert!(says(&["ch3-later.yml", "rename it"]));
    assert!(says(&["ch4/ch3-stop.yaml", "same id", "ch3/ch3-stop.yaml"]));
    assert!(says(&["not an id.yaml"]) && says(&["ch3-latin.yaml", "UTF-8"]));
    assert!(says(&["ch3-wrong.yaml:6:"]));
}

#[test]
fn two_runs_at_once_take_turns() {
    let desk = Desk::new();
    let first = Lock::take(&desk.layout, || panic!("nobody else is there")).unwrap();
    let (tell, told) = std::sync::mpsc::channel();
    std::thread::scope(|scope| {
        let layout = &desk.layout;
        let second = scope.spawn(move || Lock::take(layout, || tell.send(()).unwrap()).unwrap());
        told.recv().unwrap();
        assert!(!second.is_finished());
        drop(first);
        second.join().unwrap();
    });
}
