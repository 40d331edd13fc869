//! What a user would otherwise pick, on the same scenes in the same run: `cargo bench --bench peers` writes
//! `reports/accuracy/peers.md` and its diagrams. `benches/peers/README.md` says what the peers need.
//!
//! Errors are against the solver of 32 digits. Every answer counts only by its numbers: RMS velocity, the sequence of events and
//! their times.

use std::fmt::Write as _;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::time::Duration;

use serde_json::{Value, json};
use shotdamp::dynamics::{EventKind, HybridSystem, Law, Options, Response, event_driven, fixed_step};
use shotdamp::figure::{draw, work_precision};
use shotdamp::precise::precise;
use shotdamp::scene::{Assumptions, compile};
use shotdamp::spec::{Experiment, load_assumptions, parse_experiment};
use shotdamp::study::{Machine, Times};
use shotdamp::table::{BASELINE, Column, Data, Table};

const SINGLE: &str = "structure: {single_mass: {mass: 1 kg, stiffness: 1000 N/m, damping_ratio: 0.05}}
  dampers: [{mass_ratio: 0.05, gap_ratio: 50, floor: {resilient: {stiffness_ratio: 1, damping_ratio: 0.3}}}]
  excitation: {impulse_train: {impulse: 2.171536069237626 N s, period: 0.199 s}}";

const BEAM: &str = "structure: {cantilever_beam: {length: 1 m, width: 30 mm, thickness: 5 mm, youngs_modulus: 200 GPa, density: 7800 kg/m^3, rayleigh: 5e-5, basis: exact, modes: 4}}
  dampers:
    - at: 0.96
      mass_ratio: 0.1
      particle_share: 0.5
      gap: 42 mm
      floor: {resilient: {stiffness: assumed, damping_ratio: 0.4}}
      array: {count: 4, spacing: -4 cm}
  excitation: {impulse_train: {at: 1, impulse: 0.244 N s, frequency_ratio: 1}}";

/// Scripts, each a peer or a few of one kind.
const SCRIPTS: [&str; 3] = ["scipy_events.py", "cvode_events.py", "numba_fixed.py"];
/// Digits below those of a double.
const LEAST: f64 = 1e-16;

/// A scene with its reference.
struct Scene {
    name: &'static str,
    system: HybridSystem,
    options: Options,
    reference: Response,
}

/// One answer.
struct Answer {
    solver: String,
    setting: String,
    outcome: Result<Found, String>,
}

struct Found {
    error: f64,
    /// Events in the right order, of how many, and the largest error of their times over the period.
    right: usize,
    of: usize,
    event_error: f64,
    least: f64,
    median: f64,
}

fn main() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let machine = Machine::here();
    let mut page = format!(
        "# Peers\n\n[What accuracy costs](../accuracy.md) · written by `cargo bench --bench peers`; `benches/peers` has the \
         scripts and says how they are used.\n\n{}, {} threads, {}; {}; every run on one thread.\n\nErrors are against \
         arithmetic of 32 digits. Interpreted peers pay for every call of the equations; their times say what a user of \
         them waits for, not what their methods could do in another language.\n\n",
        machine.processor, machine.threads, machine.system, machine.build
    );
    for (file, scene) in [
        ("single", Scene::new("One mass, one damper, 125 impulses", SINGLE, 25, 100)),
        ("beam", Scene::new("Beam of four modes, four dampers, 5 impulses", BEAM, 0, 5)),
    ] {
        let mut answers = scene.ours();
        let described = root.join(format!("target/peers/{file}.json"));
        std::fs::create_dir_all(described.parent().expect("it has a folder")).expect("target can be written");
        std::fs::write(&described, scene.json().to_string()).expect("target can be written");
        for script in SCRIPTS {
            answers.extend(scene.of_script(&root.join("benches/peers").join(script), &described));
        }
        let folder = root.join("reports/accuracy");
        std::fs::create_dir_all(&folder).expect("reports can be written");
        let picture = scene.picture(&answers);
        std::fs::write(folder.join(format!("peers-{file}.png")), picture).expect("reports can be written");
        let _ = writeln!(page, "## {}\n\n![Error against wall time](peers-{file}.png)\n", scene.name);
        page += &scene.table(&answers);
        page += &ratios(&answers);
    }
    std::fs::write(root.join("reports/accuracy/peers.md"), &page).expect("reports can be written");
    print!("{page}");
}

fn assumptions() -> Assumptions {
    let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("experiments/assumptions.yaml");
    load_assumptions(&file).unwrap_or_else(|problems| panic!("{problems}")).assumptions()
}

fn experiment(scene: &str) -> Experiment {
    let text = format!(
        "title: Peers\nsource: {{chapter: 3, section: '3.1'}}\nabout: Peers.\nscene:\n  {scene}\nmeasure: [rms_velocity]\n\
         figure: {{x: momentum_residual, y: energy_residual, caption: Peers.}}\n"
    );
    let id = "peers".parse().expect("an id");
    parse_experiment(&id, "peers.yaml", &text, &assumptions()).unwrap_or_else(|problems| panic!("{problems}"))
}

impl Scene {
    fn new(name: &'static str, text: &str, skip: u32, average: u32) -> Self {
        let scene = experiment(text).recipe.resolve(&assumptions()).expect("the scenes above resolve");
        let system = compile(&scene).expect("the scenes above compile");
        let options = Options { skip, average, displacement: false, record_events: usize::MAX, ..Options::default() };
        let reference =
            precise(&system, &options, Duration::from_secs(600)).expect("the scenes above have a reference");
        Self { name, system, options, reference }
    }

    /// What a peer is told: matrices, faces, drive, and the static equilibrium that it starts from.
    fn json(&self) -> Value {
        let system = &self.system;
        let face = |law: Law| match law {
            Law::Resilient { stiffness, damping, .. } => json!({"stiffness": stiffness, "damping": damping}),
            Law::Rigid { .. } => Value::Null,
        };
        let particles: Vec<Value> = system
            .particles
            .iter()
            .map(|particle| {
                let ceiling = particle.ceiling.as_ref().map(|ceiling| face(ceiling.law));
                json!({"mass": particle.mass, "gap": particle.gap, "row": particle.floor.row,
                       "floor": face(particle.floor.law), "ceiling": ceiling})
            })
            .collect();
        json!({
            "mass": system.mass.entries, "damping": system.damping.entries, "stiffness": system.stiffness.entries,
            "gravity": system.gravity, "force_row": system.force_row, "observed_row": system.observed_rows[0],
            "impulse": system.drive.ticks[0].impulse, "period": system.drive.period,
            "skip": self.options.skip, "cycles": self.options.skip + self.options.average,
            "particles": particles, "start": self.start(),
        })
    }

    /// q, y and their rates at rest.
    fn start(&self) -> Vec<f64> {
        let n = self.system.mass.order;
        // Without an impulse nothing moves: the end of a cycle is the equilibrium.
        let mut still = self.system.clone();
        still.drive.ticks[0].impulse = 0.0;
        let options = Options { skip: 0, average: 1, ..Options::default() };
        let end = |row: Vec<f64>| {
            let seen = HybridSystem { observed_rows: vec![row], ..still.clone() };
            precise(&seen, &options, Duration::from_secs(60)).expect("it rests")
        };
        let unit = |i: usize| (0..n).map(|k| if k == i { 1.0 } else { 0.0 }).collect::<Vec<f64>>();
        let mut start: Vec<f64> = (0..n).map(|i| end(unit(i)).final_displacement).collect();
        start.extend(end(unit(0)).final_particles.iter().map(|[y, _]| *y));
        start.resize(2 * start.len(), 0.0);
        start
    }

    fn ours(&self) -> Vec<Answer> {
        let mut answers = Vec::new();
        let plain = Options { record_events: 0, ..self.options.clone() };
        for window_factor in [1.0, 0.5] {
            let settings = |options: &Options| Options { window_factor, ..options.clone() };
            let run = |options: &Options| event_driven(&self.system, &settings(options)).map_err(|e| e.to_string());
            answers.push(self.own(
                "event_driven",
                format!("shotdamp event-driven, windows × {window_factor}"),
                &run,
                &plain,
            ));
        }
        for time_step in [1e-3, 1e-4, 1e-5, 1e-6] {
            let run = |options: &Options| fixed_step(&self.system, options, time_step).map_err(|e| e.to_string());
            answers.push(self.own("fixed_step", format!("shotdamp fixed step, {time_step:e} s"), &run, &plain));
        }
        answers
    }

    fn own(
        &self,
        solver: &str,
        setting: String,
        run: &dyn Fn(&Options) -> Result<Response, String>,
        plain: &Options,
    ) -> Answer {
        let outcome = run(&self.options).map(|response| {
            let period = self.system.drive.period;
            let events: Vec<(f64, usize, String)> = response
                .events
                .iter()
                .map(|event| (event.cycle as f64 * period + event.time, event.particle, word(event.kind).into()))
                .collect();
            let times = Times::of(|| drop(std::hint::black_box(run(plain))), Duration::from_secs(1));
            self.compared(response.window().rms_velocity(), &events, times.least, times.median)
        });
        Answer { solver: solver.into(), setting, outcome }
    }

    fn compared(&self, rms: f64, events: &[(f64, usize, String)], least: f64, median: f64) -> Found {
        let period = self.system.drive.period;
        let mut right = 0;
        let mut event_error = 0.0_f64;
        for ((time, particle, kind), want) in events.iter().zip(&self.reference.events) {
            if *particle != want.particle || kind != word(want.kind) {
                break;
            }
            right += 1;
            event_error = event_error.max((time / period - want.cycle as f64 - want.time / period).abs());
        }
        // One event too many is as wrong as one too few.
        let of = self.reference.events.len().max(events.len());
        let error = (rms / self.reference.window().rms_velocity() - 1.0).abs();
        Found { error, right, of, event_error, least, median }
    }

    /// All answers of a script; one that says why where it cannot be run.
    fn of_script(&self, script: &Path, described: &Path) -> Vec<Answer> {
        let python = std::env::var_os("SHOTDAMP_PEERS_PYTHON").map_or_else(|| PathBuf::from("python3"), PathBuf::from);
        let name = script.file_stem().map_or_else(String::new, |name| name.to_string_lossy().into_owned());
        let failed = |why: String| vec![Answer { solver: name.clone(), setting: name.clone(), outcome: Err(why) }];
        // One thread, as the others.
        let threads = ["OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS"].map(|name| (name, "1"));
        let output = match Command::new(python).arg("-B").arg(script).arg(described).envs(threads).output() {
            Err(error) => return failed(error.to_string()),
            Ok(output) => output,
        };
        let text = String::from_utf8_lossy(&output.stdout).into_owned();
        let answers: Vec<Answer> = text
            .lines()
            .filter_map(|line| serde_json::from_str(line).ok())
            .map(|line: Value| self.read(&line))
            .collect();
        if answers.is_empty() {
            let why = String::from_utf8_lossy(&output.stderr).lines().last().unwrap_or("no answer").to_owned();
            return failed(why);
        }
        answers
    }

    fn read(&self, line: &Value) -> Answer {
        let setting = line["setting"].as_str().unwrap_or_default().to_owned();
        let solver = setting.split(',').next().unwrap_or_default().to_owned();
        let outcome = match line["failure"].as_str() {
            Some(why) => Err(why.to_owned()),
            None => {
                let empty = Vec::new();
                let list = |value: &Value| value.as_array().unwrap_or(&empty).clone();
                let event = |event: Value| {
                    let particle = usize::try_from(event[1].as_u64()?).ok()?;
                    Some((event[0].as_f64()?, particle, event[2].as_str()?.to_owned()))
                };
                let events: Vec<_> = list(&line["events"]).into_iter().filter_map(event).collect();
                let mut times: Vec<f64> = list(&line["times"]).iter().filter_map(Value::as_f64).collect();
                times.sort_by(f64::total_cmp);
                match (times.first(), line["rms"].as_f64()) {
                    (Some(least), Some(rms)) => Ok(self.compared(rms, &events, *least, times[times.len() / 2])),
                    _ => Err("no number".into()),
                }
            }
        };
        Answer { solver, setting, outcome }
    }

    fn table(&self, answers: &[Answer]) -> String {
        let mut text = String::from(
            "| Solver | Error of the RMS velocity | Events in the right order | Error of their times / T | Median | Shortest |\n\
             | --- | ---: | ---: | ---: | ---: | ---: |\n",
        );
        for Answer { setting, outcome, .. } in answers {
            let _ = match outcome {
                Ok(found) => writeln!(
                    text,
                    "| {setting} | {:.0e} | {} of {} | {:.0e} | {} | {} |",
                    found.error,
                    found.right,
                    found.of,
                    found.event_error,
                    seconds(found.median),
                    seconds(found.least)
                ),
                Err(why) => writeln!(text, "| {setting} | not run: {} | | | | |", why.replace('|', "/")),
            };
        }
        text + "\n"
    }

    fn picture(&self, answers: &[Answer]) -> Vec<u8> {
        let found: Vec<(&str, &Found)> =
            answers.iter().filter_map(|answer| Some((answer.solver.as_str(), answer.outcome.as_ref().ok()?))).collect();
        let floats = |name: &str, unit: &str, of: &dyn Fn(&Found) -> f64| Column {
            name: name.into(),
            unit: unit.into(),
            symbol: String::new(),
            data: Data::Float(found.iter().map(|(_, found)| of(found)).collect()),
        };
        let texts = |name: &str, of: &dyn Fn(&str) -> String| {
            Column::new(name, Data::Text(found.iter().map(|(solver, _)| of(solver)).collect()))
        };
        let table = Table {
            columns: vec![
                texts("variant", &|_| BASELINE.into()),
                texts("solver", &|solver| solver.into()),
                texts("case", &|_| String::new()),
                floats("time", "s", &|found| found.median),
                floats("error", "", &|found| found.error.max(LEAST)),
                floats("event_error", "", &|found| found.event_error.max(LEAST)),
            ],
            ..Table::default()
        };
        let times = found.iter().map(|(_, found)| found.median);
        let times = times.fold([f64::INFINITY, 0.0], |[low, high], time: f64| [time.min(low), time.max(high)]);
        draw(&experiment(SINGLE), &work_precision(times, None, true), &table, &[]).expect("there is something to draw")
    }
}

/// How much longer each peer takes than the event-driven solver, which has all digits, for an error.
fn ratios(answers: &[Answer]) -> String {
    let found = || answers.iter().filter_map(|answer| Some((&answer.solver, answer.outcome.as_ref().ok()?)));
    let Some(own) = found().find(|(solver, _)| *solver == "event_driven").map(|(_, own)| own.median) else {
        return String::new();
    };
    let mut solvers: Vec<&String> = Vec::new();
    for (solver, _) in found() {
        if solver != "event_driven" && !solvers.contains(&solver) {
            solvers.push(solver);
        }
    }
    let mut text = String::from(
        "Time over that of the event-driven solver, for errors no larger than:\n\n| Solver | 1 % | 1e-4 | 1e-8 | 1e-12 |\n\
         | --- | ---: | ---: | ---: | ---: |\n",
    );
    for solver in solvers {
        let _ = write!(text, "| {} ", solver.replace('_', " "));
        for goal in [1e-2, 1e-4, 1e-8, 1e-12] {
            let reached =
                found().filter(|(of, found)| *of == solver && found.error <= goal).map(|(_, found)| found.median);
            let _ = match reached.reduce(f64::min) {
                Some(time) => write!(text, "| × {} ", shotdamp::text::number::significant(time / own, 2)),
                None => write!(text, "| ✗ "),
            };
        }
        text += "|\n";
    }
    text + "\n"
}

fn word(kind: EventKind) -> &'static str {
    match kind {
        EventKind::FloorContact => "floor_contact",
        EventKind::FloorRelease => "floor_release",
        EventKind::CeilingContact => "ceiling_contact",
        EventKind::CeilingRelease => "ceiling_release",
        _ => "other",
    }
}

fn seconds(value: f64) -> String {
    shotdamp::text::number::quantity(value, "s", 3)
}
