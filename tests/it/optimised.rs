//! An optimisation as an experiment: what a file may say, what its table holds, and that neither threads nor an interruption
//! show in it.

use std::convert::Infallible;
use std::fs;
use std::path::Path;
use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};

use shotdamp::dynamics::Proof;
use shotdamp::experiment::{Experiment, ExperimentId, GapWord, load_assumptions, parse_experiment};
use shotdamp::measure::{Evaluated, Measure, Measured, Request, Rigour};
use shotdamp::optimise::{
    Batch, Bounds, Dense, Genetic, GeneticSettings, Score, Slope, Spacing, Stopping, Wanted, dense, minimise, two_opt,
};
use shotdamp::report::{judge_all, publish};
use shotdamp::scene::Excitation;
use shotdamp::study::Study;
use shotdamp::study::{Array, Engine, Evaluate, Event, EventHandler, IgnoreEvents, RowFailure, Simulation};
use shotdamp::table::{Data, Table};
use shotdamp::yaml::Problems;

use crate::desk::{Desk, shotdamp};

const GAPS: &str = "
title: Gaps of three dampers
source: {chapter: 6, section: '6.3.1', shown_in: [Table 10]}
about: A made-up optimum.
scene:
  structure: {single_mass: {mass: 1 kg, stiffness: 1000 N/m, damping_ratio: 0.05}}
  dampers:
    - {mass_ratio: 0.01, gap: optimised, floor: {rigid: {restitution: 0}}}
    - {mass_ratio: 0.02, gap: optimised, floor: {rigid: {restitution: 0}}}
    - {mass_ratio: 0.03, gap: optimised, floor: {rigid: {restitution: 0}}}
  excitation: {harmonic: {base_amplitude_ratio: swept, frequency_ratio: 1}}
mean_over: {base_amplitude_ratio: [1, 2]}
optimise:
  minimise: rms_velocity
  gaps: {from: 0 mm, to: 100 mm}
  candidates: {uniform: 50 mm, known: [10 mm, 70 mm, 30 mm]}
  genetic: {population: 20, elites: 1, start: uniform}
  stop: {generations: 12}
  seeds: [1, 2]
  two_opt: true
  cma_es: {}
  dense: {points: 3, refine: 2}
  landscape: {points: 5}
measure: [rms_velocity, velocity_ratio]
figures:
  - {x: evaluation, y: best_so_far, by: [candidate, seed], caption: Convergence.}
  - {name: landscape, x: along_gap, y: fitness_along, by: varied, caption: Landscape.}
";

/// A bowl around (10, 70, 30) mm, deeper under small forces; with errors of the size that a test asks for.
#[derive(Default)]
struct Bowl {
    error: f64,
    evaluations: AtomicUsize,
}

impl Evaluate for Bowl {
    fn evaluate(&self, it: &Simulation<'_>) -> Result<Evaluated, RowFailure> {
        self.evaluations.fetch_add(1, Ordering::Relaxed);
        let scene = it.recipe.resolve(it.assumptions)?;
        let Excitation::Harmonic { force, .. } = scene.excitation else {
            return Err(RowFailure::NoValue("velocity_ratio".into()));
        };
        let off = |(damper, best): (&shotdamp::scene::Damper, f64)| (damper.gap - best) * (damper.gap - best);
        let bowl: f64 = scene.dampers.iter().zip([0.010, 0.070, 0.030]).map(off).sum();
        let value = |measure: &Measure| match measure {
            Measure::RmsVelocity => force.abs() * (1.0 + 100.0 * bowl),
            Measure::UndampedRmsVelocity => 5.0 * force.abs(),
            _ => f64::NAN,
        };
        Ok(Evaluated {
            measured: it
                .request
                .measures
                .iter()
                .map(|measure| Measured { value: value(measure), numerical: self.error, spread: self.error })
                .collect(),
            proof: Proof::default(),
            chaotic: self.error > 0.0,
            unknown: None,
            members: 8,
            motion: None,
            trace: Vec::new(),
            end: None,
        })
    }
}

fn desk() -> Desk {
    let desk = Desk::new();
    for other in ["experiments", "reference"] {
        fs::remove_dir_all(desk.layout.path(&format!("{other}/ch3"))).unwrap();
    }
    desk.put("experiments/ch6/ch6-gaps.yaml", GAPS);
    desk
}

fn run(threads: usize) -> (Desk, Table) {
    let desk = desk();
    desk.run(threads, &Bowl::default(), &IgnoreEvents);
    let table = desk.table("ch6-gaps");
    (desk, table)
}

#[test]
fn every_candidate_is_a_row_with_gaps_fitness_and_what_it_cost() {
    let (desk, table) = run(2);
    let names: Vec<&str> = table.texts("candidate").unwrap().iter().map(String::as_str).collect();
    let searches = ["genetic", "two_opt", "genetic", "two_opt", "cma_es", "cma_es", "dense"];
    assert_eq!(names, [&["known", "uniform"][..], &searches, &["landscape"; 3]].concat());
    assert_eq!(table.floats("seed").unwrap()[2..8], [1.0, 1.0, 2.0, 2.0, 1.0, 2.0]);
    let fitness = table.floats("rms_velocity").unwrap();
    // The mean over two forces in the ratio of 1 to 2, m a ω² with a ω²/g of 1 and 2.
    assert!((fitness[0] - 1.5 * 9.81).abs() < 1e-9, "{fitness:?}");
    assert!((fitness[1] / fitness[0] - 1.0 - 100.0 * (0.04_f64.powi(2) + 2.0 * 0.02_f64.powi(2))).abs() < 1e-9);
    assert!(fitness[3..8].iter().all(|x| x / fitness[0] < 1.01), "all searches come near: {fitness:?}");
    // A velocity ratio is that of the mean velocities.
    assert!((table.floats("velocity_ratio").unwrap()[0] - 5.0).abs() < 1e-9);
    let evaluations = table.floats("evaluations").unwrap();
    assert_eq!(evaluations[2], 20.0 + 11.0 * 19.0);
    assert_eq!(evaluations[6..8], [evaluations[3], evaluations[5]], "the peer's budget is the algorithm's with 2-opt");
    assert!(evaluations[8] > 27.0 && evaluations[8] <= 27.0 + 2.0 * 27.0);
    let column = |name: &str| match &table.column(name).unwrap().data {
        shotdamp::table::Data::FloatList(lists) => lists.clone(),
        other => panic!("{other:?}"),
    };
    assert_eq!(column("evaluation")[2].len(), 12);
    assert_eq!(*column("best_so_far")[2].last().unwrap(), table.floats("fitness_in_search").unwrap()[2]);
    let (along, landscape) = (column("along_gap"), column("fitness_along"));
    assert!(along[9].len() >= 5 && along[9].len() == landscape[9].len() && along[2].is_empty());
    assert_eq!(column("fitness_along_spread")[9].len(), along[9].len(), "with what chaotic motion makes of it");
    assert_eq!(table.floats("varied").unwrap()[9..], [1.0, 2.0, 3.0]);
    assert!(!desk.layout.path("results/ch6-gaps.journal").exists(), "what is done keeps no journal");
    assert_eq!(desk.run(1, &Bowl::default(), &IgnoreEvents), [""; 0]);
}

#[test]
fn the_bytes_depend_neither_on_threads_nor_on_an_interruption() {
    /// Keeps the journal as it was in the middle of the peer's search.
    struct Copy<'a>(&'a Path, Mutex<Option<Vec<u8>>>);
    impl EventHandler for Copy<'_> {
        fn on_event(&self, event: &Event<'_>) {
            if let Event::Searched { search: "CMA-ES, seed 1", evaluations: 40.., .. } = event {
                self.1.lock().unwrap().get_or_insert_with(|| fs::read(self.0).unwrap());
            }
        }
    }
    let (one, eight) = (run(1).0, run(8).0);
    let bytes = one.bytes("results/ch6-gaps.parquet");
    assert!(bytes == eight.bytes("results/ch6-gaps.parquet"));

    let whole = desk();
    let path = whole.layout.path("results/ch6-gaps.journal");
    let copy = Copy(&path, Mutex::default());
    let engine = Bowl::default();
    whole.run(3, &engine, &copy);
    let all = engine.evaluations.into_inner();
    let journal = copy.1.into_inner().unwrap().unwrap();

    // Killed while a line was being written; then run again.
    let resumed = desk();
    fs::create_dir_all(resumed.layout.results()).unwrap();
    fs::write(resumed.layout.path("results/ch6-gaps.journal"), &journal[..journal.len() - 9]).unwrap();
    let engine = Bowl::default();
    resumed.run(2, &engine, &IgnoreEvents);
    let again = engine.evaluations.into_inner();
    assert!(again + all / 3 < all, "{again} of {all} evaluations");
    assert!(bytes == resumed.bytes("results/ch6-gaps.parquet"));

    // Of another meaning it counts for nothing.
    let other = desk();
    other.put("experiments/ch6/ch6-gaps.yaml", &GAPS.replace("mass_ratio: 0.03", "mass_ratio: 0.04"));
    fs::create_dir_all(other.layout.results()).unwrap();
    fs::write(other.layout.path("results/ch6-gaps.journal"), &journal).unwrap();
    let engine = Bowl::default();
    other.run(2, &engine, &IgnoreEvents);
    assert_eq!(engine.evaluations.into_inner(), all);
}

#[test]
fn an_improvement_within_its_standard_error_is_called_noise() {
    let page = |error: f64| {
        let desk = desk();
        desk.run(2, &Bowl { error, ..Bowl::default() }, &IgnoreEvents);
        let study = Study::new(desk.layout.clone(), desk.texts());
        let published = publish(&study, &judge_all(&study), &["ch6-gaps"].into()).unwrap();
        assert_eq!(published.problems, [""; 0]);
        String::from_utf8(desk.bytes("reports/ch6/ch6-gaps.md")).unwrap()
    };
    let (sure, noisy) = (page(0.0), page(8.0));
    assert!(sure.contains("| uniform | 50 mm, 50 mm, 50 mm |") && sure.contains("worse by 24 %"), "{sure}");
    assert!(!sure.contains("noise:") && noisy.contains("noise: 24 %, within ±54 %"), "{noisy}");
    assert!(sure.contains("![Convergence.](ch6-gaps.png)") && sure.contains("![Landscape.](ch6-gaps-landscape.png)"));
    assert!(sure.contains("seeds 1 and 2"), "{sure}");
}

#[test]
fn an_optimum_at_the_end_of_its_range_is_said_to_lie_there() {
    let page = |gaps: &str| {
        let desk = desk();
        desk.put("experiments/ch6/ch6-gaps.yaml", &GAPS.replace("{from: 0 mm, to: 100 mm}", gaps));
        desk.run(2, &Bowl::default(), &IgnoreEvents);
        let study = Study::new(desk.layout.clone(), desk.texts());
        publish(&study, &judge_all(&study), &["ch6-gaps"].into()).unwrap();
        String::from_utf8(desk.bytes("reports/ch6/ch6-gaps.md")).unwrap()
    };
    let within = page("{from: 0 mm, to: 100 mm}");
    assert!(!within.contains("at an end of") && !within.contains("most allowed"), "{within}");
    // The best second gap is 70 mm.
    let short = page("{from: 0 mm, to: 70 mm}");
    let said = "1 of its 3 gaps lies at an end of its range: a wider range may hold a better one.";
    assert!(short.contains(said) && short.contains("70 mm (most allowed)"), "{short}");
}

/// What one run shows may be luck: what goes on from the best candidate begins at the one that is best as a result.
#[test]
fn a_landscape_goes_through_the_candidate_that_is_best_after_its_ensemble() {
    /// A bowl in which a single run with equal gaps is lucky.
    struct Luck(Bowl);
    impl Evaluate for Luck {
        fn evaluate(&self, it: &Simulation<'_>) -> Result<Evaluated, RowFailure> {
            let mut evaluated = self.0.evaluate(it)?;
            let scene = it.recipe.resolve(it.assumptions)?;
            let is_uniform = scene.dampers.windows(2).all(|pair| pair[0].gap == pair[1].gap);
            if it.request.rigour == Rigour::Step && is_uniform {
                evaluated.measured.iter_mut().for_each(|measured| measured.value *= 0.1);
            }
            Ok(evaluated)
        }
    }
    let desk = desk();
    let searches = GAPS.find("  genetic:").unwrap()..GAPS.find("  landscape:").unwrap();
    let mut text = GAPS.to_owned();
    text.replace_range(searches, "");
    let text = &text[..text.find("figures:").unwrap()];
    desk.put(
        "experiments/ch6/ch6-gaps.yaml",
        &format!("{text}figure: {{x: along_gap, y: fitness_along, by: varied, caption: Landscape.}}\n"),
    );
    let engine = Luck(Bowl::default());
    desk.run(2, &engine, &IgnoreEvents);
    let table = desk.table("ch6-gaps");
    assert_eq!(table.texts("candidate").unwrap(), ["known", "uniform", "landscape", "landscape", "landscape"]);
    assert_eq!(table.floats("gap_2").unwrap(), [0.070, 0.050, 0.070, 0.070, 0.070]);
    let points = table.lists("along_gap").unwrap().iter().map(Vec::len).sum::<usize>();
    // Under two forces each; the candidate itself lies on all three sections.
    assert_eq!(engine.0.evaluations.into_inner(), 2 * (2 + points - 2), "no result is computed twice");
}

#[test]
fn a_search_that_cannot_begin_is_a_failed_row() {
    struct Broken;
    impl Evaluate for Broken {
        fn evaluate(&self, _: &Simulation<'_>) -> Result<Evaluated, RowFailure> {
            Err(RowFailure::NoValue("velocity_ratio".into()))
        }
    }
    let desk = desk();
    desk.run(2, &Broken, &IgnoreEvents);
    let table = desk.table("ch6-gaps");
    assert!(table.texts("failure").unwrap().contains(&"velocity_ratio has no value".to_owned()));
    assert_eq!(desk.run(2, &Bowl::default(), &IgnoreEvents), ["ch6-gaps"], "it is tried again");
}

fn sheet() -> shotdamp::experiment::Assumptions {
    let sheet = Path::new(env!("CARGO_MANIFEST_DIR")).join("experiments/assumptions.yaml");
    load_assumptions(&sheet).unwrap_or_else(|problems| panic!("{problems}")).assumptions()
}

fn read(text: &str) -> Result<Experiment, Problems> {
    parse_experiment(&ExperimentId("ch6-example".into()), "it.yaml", text, &sheet())
}

#[test]
fn mistakes_in_an_optimisation_are_told_where_they_stand() {
    // What is written instead of a part of the file; the mistake is told between ‹ and ›.
    for (part, written, says) in [
        ("minimise: rms_velocity", "minimise: ‹rms_velocty›", "is not a measure"),
        ("minimise: rms_velocity", "minimise: rms_velocity\n  ‹maximise›: rms_velocity", "keep one"),
        ("to: 100 mm", "to: ‹0 mm›", "ends above its start"),
        ("[10 mm, 70 mm, 30 mm]", "‹[10 mm, 70 mm]›", "2 gaps for 3 dampers"),
        ("[10 mm, 70 mm, 30 mm]", "‹[10 mm, 170 mm, 30 mm]›", "outside of the bounds"),
        ("uniform: 50 mm", "‹genetic›: 50 mm", "it names a search"),
        ("population: 20", "population: ‹3›", "four individuals"),
        ("elites: 1", "elites: ‹20›", "fewer individuals live on"),
        ("seeds: [1, 2]", "seeds: [1, ‹1›]", "twice"),
        ("stop: {generations: 12}", "stop: {generations: 12, stalled: ‹5›}", "add that"),
        ("stop: {generations: 12}", "stop: {‹generation›: 12}", "no key `generation`"),
        ("dense: {points: 3, refine: 2}", "dense: {points: ‹1›}", "two points"),
        ("measure: [rms_velocity, velocity_ratio]", "measure: ‹velocity_ratio›", "optimised, but not measured"),
        (
            "mean_over: {base_amplitude_ratio: [1, 2]}",
            "mean_over: {base_amplitude_ratio: [1, 2]}\nsweep: ‹{gap_ratio: [1]}›",
            "neither a sweep",
        ),
        ("dense: {points: 3, refine: 2}", "polish: {evaluations: ‹0›}", "one at least"),
        ("minimise: rms_velocity", "minimise: drift\n  polish: ‹{}›", "follows the derivatives of the RMS velocity"),
        ("by: varied", "by: ‹sweep›", "no column `sweep`"),
        ("two_opt: true", "compare_with: ‹unknown›", "none of the candidates"),
        ("by: varied", "by: ‹evaluation›", "holds a list a row"),
    ] {
        let text = GAPS.replace(part, written);
        assert_ne!(text, GAPS, "{part}");
        let before: Vec<&str> = text.split('‹').next().unwrap().lines().collect();
        let wanted = (before.len(), before.last().unwrap().chars().count() + 1);
        let problems = read(&text.replace(['‹', '›'], "")).expect_err(written);
        let named = |problem: &shotdamp::yaml::Problem| {
            let place = problem.place.map_or((0, 0), |place| (place.line, place.column));
            let whole = format!("{} {}", problem.message, problem.help.clone().unwrap_or_default());
            place == wanted && whole.contains(says)
        };
        // A mapping is told at its first key.
        let near = |problem: &shotdamp::yaml::Problem| {
            let place = problem.place.map_or((0, 0), |place| (place.line, place.column));
            place.0 == wanted.0 && place.1 <= wanted.1 + 1 && problem.message.contains(says)
        };
        assert!(problems.list.iter().any(|problem| named(problem) || near(problem)), "{written}: {problems}");
    }
    let unbounded = GAPS.replace("  stop: {generations: 12}\n", "");
    assert!(read(&unbounded).unwrap_err().to_string().contains("nothing bounds this search"));
    let fixed = GAPS.replacen("gap: optimised", "gap: 5 mm", 1);
    assert!(read(&fixed).unwrap_err().to_string().contains("a gap that is not optimised is not varied"));
    let cut = GAPS.find("optimise:\n").unwrap();
    let alone = format!("{}measure: rms_velocity\n", &GAPS[..cut]);
    assert_eq!(read(&alone).unwrap_err().to_string().matches("nothing optimises this gap").count(), 3);
    let twice = format!("{GAPS}run: {{solver: [event_driven, {{fixed_step: {{time_step: 1 ms}}}}]}}\n");
    assert!(read(&twice).unwrap_err().to_string().contains("under one solver"));
    let huge = GAPS.replace("dense: {points: 3, refine: 2}", "dense: {points: 1000}");
    assert!(read(&huge).unwrap_err().to_string().contains("evaluations are too many"));
    let many = GAPS.replace("to: 100 mm", "to: 0 mm").replace("seeds: [1, 2]", "seeds: [1, 1]").replace("20,", "2,");
    assert!(read(&many).unwrap_err().list.len() >= 3, "all at once");
}

const BEAM: &str = "
title: Array on a beam
source: {chapter: 6, section: '6.3.1'}
about: Two fillings.
scene:
  structure:
    cantilever_beam:
      {length: 1 m, width: 30 mm, thickness: 5 mm, youngs_modulus: 200 GPa, density: 7800 kg/m^3, rayleigh: 5e-5, modes: 4}
  dampers:
    - at: swept
      array: {count: 4, spacing: -4 cm, centred: true, margin: 4 cm}
      mass_ratio: 0.1
      mass_reading: modal
      particle_share: 0.5
      gap: {uniform: 41.9 mm, optimised: [8.3 mm, 56.8 mm, 3.0 mm, 18.8 mm]}
      floor: {resilient: {stiffness: tuned, damping_ratio: 0.02}}
  excitation: {impulse_train: {at: swept, impulse: 0.2445 N s, frequency_ratio: 1}}
mean_over: {paired: {force_x: [1, 0.5], damper_x: [1, 0.5]}}
sweep: {filling: [uniform, optimised]}
run: {skip: 2 cycles, average: 6 cycles, ensemble: none}
measure: [rms_velocity, velocity_ratio]
";

#[test]
fn an_array_keeps_its_distance_from_the_ends_and_is_filled_in_two_ways() {
    let experiment = read(BEAM).unwrap_or_else(|problems| panic!("{problems}"));
    let scenes: Vec<_> = experiment
        .cases
        .iter()
        .flat_map(|case| experiment.recipes_of(case).unwrap())
        .map(|recipe| recipe.resolve(&sheet()).unwrap())
        .collect();
    let places = |i: usize| scenes[i].dampers.iter().map(|damper| damper.at.x).collect::<Vec<_>>();
    let near = |a: Vec<f64>, b: [f64; 4]| a.iter().zip(b).all(|(a, b)| (a - b).abs() < 1e-12);
    assert!(near(places(0), [0.96, 0.92, 0.88, 0.84]), "moved inwards as a whole: {:?}", places(0));
    assert!(near(places(1), [0.56, 0.52, 0.48, 0.44]), "{:?}", places(1));
    let gaps = |i: usize| scenes[i].dampers.iter().map(|damper| damper.gap).collect::<Vec<_>>();
    assert_eq!(gaps(0), [0.0419; 4]);
    assert_eq!(gaps(2), [0.0083, 0.0568, 0.003, 0.0188]);
    let wrong = BEAM.replace("3.0 mm, 18.8 mm]", "3.0 mm]");
    assert!(read(&wrong).unwrap_err().to_string().contains("3 gaps are too few"));
}

#[test]
fn a_scene_that_is_prepared_once_gives_the_bits_of_one_that_is_built_for_its_gaps() {
    let experiment = read(BEAM).unwrap_or_else(|problems| panic!("{problems}"));
    let assumptions = sheet();
    let recipes = experiment.recipes_of(&experiment.cases[1]).unwrap();
    for recipe in &recipes {
        let step = Simulation::step(&experiment, recipe, &assumptions, &experiment.measures);
        let simulation = Simulation { request: Request { rigour: Rigour::Result, ..step.request }, ..step };
        let built = Engine.evaluate(&simulation).unwrap();
        let ready: Box<dyn Array + '_> = Engine.array(simulation, shotdamp::experiment::GapWord::Gap).unwrap();
        assert_eq!(ready.evaluate(&[0.0083, 0.0568, 0.003, 0.0188], simulation.request.rigour).unwrap(), built);
        let other = ready.evaluate(&[0.0419; 4], simulation.request.rigour).unwrap();
        assert_ne!(other.measured, built.measured);
    }
}

/// An engine that counts the runs of its arrays.
#[derive(Default)]
struct Counted(AtomicUsize);

struct CountedArray<'a>(Box<dyn Array + 'a>, &'a AtomicUsize);

impl Evaluate for Counted {
    fn evaluate(&self, it: &Simulation<'_>) -> Result<Evaluated, RowFailure> {
        Engine.evaluate(it)
    }

    fn array<'a>(&'a self, it: Simulation<'a>, word: GapWord) -> Result<Box<dyn Array + 'a>, RowFailure> {
        Ok(Box::new(CountedArray(Engine.array(it, word)?, &self.0)))
    }
}

impl Array for CountedArray<'_> {
    fn evaluate(&self, gaps: &[f64], rigour: Rigour) -> Result<Evaluated, RowFailure> {
        self.1.fetch_add(1, Ordering::Relaxed);
        self.0.evaluate(gaps, rigour)
    }

    fn slope(&self, gaps: &[f64], measure: Measure) -> Result<Option<Slope>, RowFailure> {
        self.0.slope(gaps, measure)
    }
}

/// What a search kept when it was interrupted is part of what `--force` forgets.
#[test]
fn a_forced_run_evaluates_anew_what_an_interrupted_search_kept() {
    struct Keep<'a>(&'a Path, Mutex<Option<String>>);
    impl EventHandler for Keep<'_> {
        fn on_event(&self, event: &Event<'_>) {
            if let Event::Searched { .. } = event {
                self.1.lock().unwrap().get_or_insert_with(|| fs::read_to_string(self.0).unwrap());
            }
        }
    }
    let text = optimised_beam("two_opt: true");
    let desk = Desk::new();
    desk.put("experiments/ch6/ch6-gaps.yaml", &text);
    let path = desk.layout.path("results/ch6-gaps.journal");
    let keep = Keep(&path, Mutex::default());
    desk.run(2, &Engine, &keep);
    let right = desk.bytes("results/ch6-gaps.parquet");
    // Scores that no run gives: of the best point there could be, wherever one was tried.
    let journal = keep.1.into_inner().unwrap().unwrap();
    let (head, points) = journal.split_once('\n').unwrap();
    let wrong = |line: &str| {
        let mut words: Vec<&str> = line.split(' ').collect();
        let score = words.len() - 2;
        words[score] = "0000000000000000";
        words.join(" ") + "\n"
    };
    let wrong = format!("{head}\n{}", points.lines().map(wrong).collect::<String>());
    let run = |arguments: &[&str]| {
        fs::remove_file(desk.layout.path("results/ch6-gaps.parquet")).unwrap();
        fs::write(&path, &wrong).unwrap();
        let said = shotdamp(&desk, arguments);
        assert_eq!(said.code, 0, "{}", said.err);
        desk.bytes("results/ch6-gaps.parquet")
    };
    assert!(run(&["run", "ch6-gaps"]) != right, "it goes on from what is kept");
    assert!(run(&["run", "ch6-gaps", "--force"]) == right);
}

/// A small search on a beam of four dampers.
fn optimised_beam(rest: &str) -> String {
    BEAM.replace("gap: {uniform: 41.9 mm, optimised: [8.3 mm, 56.8 mm, 3.0 mm, 18.8 mm]}", "gap: optimised")
        .replace("sweep: {filling: [uniform, optimised]}", "")
        .replace("[1, 0.5]", "[1, 0.75, 0.5]")
        + "
optimise:
  minimise: rms_velocity
  gaps: {from: 0.1 mm, to: 83.7 mm}
  candidates: {known: [8.3 mm, 56.8 mm, 3.0 mm, 18.8 mm]}
  genetic: {population: 20, elites: 2}
  stop: {generations: 2}
  seeds: [1]
" + &format!("  {rest}\n")
}

#[test]
fn stopping_what_cannot_win_leaves_the_answer_of_a_real_search_as_it_is() {
    let text = optimised_beam("two_opt: true\n  dense: {points: 3, spacing: log, refine: 1}");
    let desk = Desk::new();
    for other in ["experiments", "reference"] {
        fs::remove_dir_all(desk.layout.path(&format!("{other}/ch3"))).unwrap();
    }
    desk.put("experiments/ch6/ch6-gaps.yaml", &text);
    let engine = Counted::default();
    desk.run(2, &engine, &IgnoreEvents);
    let table = desk.table("ch6-gaps");

    // The same searches with every evaluation made in full.
    let experiment = read(&text).unwrap_or_else(|problems| panic!("{problems}"));
    let (assumptions, optimise) = (sheet(), experiment.optimise.as_ref().unwrap());
    let recipes = experiment.recipes_of(&experiment.cases[0]).unwrap();
    let array = |recipe| {
        let simulation = Simulation::step(&experiment, recipe, &assumptions, &experiment.measures);
        Engine.array(simulation, GapWord::Gap).unwrap()
    };
    let arrays: Vec<Box<dyn Array + '_>> = recipes.iter().map(array).collect();
    let mut runs = 0;
    let mut in_full = |points: &[Vec<f64>], _: Wanted| {
        let mean = |point: &Vec<f64>| {
            let each = arrays.iter().map(|array| array.evaluate(point, Rigour::Step).unwrap().measured[0].value);
            Score { value: each.sum::<f64>() / arrays.len() as f64 }
        };
        runs += points.len() * arrays.len();
        Ok::<_, Infallible>(Batch { scores: points.iter().map(mean).collect(), seconds: 0.0 })
    };
    let bounds = Bounds::new(optimise.bounds.clone()).unwrap();
    let settings = GeneticSettings { population: 20, elites: 2, crossover: 0.8 };
    let generations = Stopping { generations: Some(2), ..Stopping::default() };
    let mut genetic = Genetic::new(bounds.clone(), settings, 1, &[]);
    let genetic = minimise(&mut genetic, &generations, &mut in_full).unwrap().unwrap();
    let swapped = two_opt(&genetic.point, genetic.score, &bounds, &mut in_full).unwrap();
    let settings = Dense { points: 3, spacing: Spacing::Log, refine: 1 };
    let dense = dense(&bounds, settings, &mut in_full).unwrap().unwrap();

    let names = table.texts("candidate").unwrap();
    for (name, found) in [("genetic", &genetic), ("two_opt", &swapped), ("dense", &dense)] {
        let row = names.iter().position(|other| other == name).unwrap();
        let gaps: Vec<f64> = (1..=4).map(|gap| table.floats(&format!("gap_{gap}")).unwrap()[row]).collect();
        assert_eq!(gaps, found.point, "{name}");
        assert_eq!(table.floats("fitness_in_search").unwrap()[row], found.score.value, "{name}");
        let Data::FloatList(best) = &table.column("best_so_far").unwrap().data else { panic!("no list") };
        let steps: Vec<f64> = found.trail.iter().map(|step| step.best).collect();
        assert_eq!(best[row], steps, "{name}");
    }
    // Each of the four candidates is evaluated once more as a result.
    let made = engine.0.into_inner() - 4 * arrays.len();
    assert!(made < runs, "{made} of {runs} runs");
}
