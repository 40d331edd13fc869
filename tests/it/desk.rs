//! A study in a folder of its own, and an engine with made-up numbers to fill it.

use std::collections::BTreeMap;
use std::fs;
use std::process::Command;
use std::sync::atomic::{AtomicUsize, Ordering};

use assert_cmd::cargo::CommandCargoExt;
use shotdamp::dynamics::Proof;
use shotdamp::measure::SolverChoice;
use shotdamp::measure::{Evaluated, Measured, TraceColumn};
use shotdamp::scene::Excitation;
use shotdamp::study::Study;
use shotdamp::study::{
    self, Evaluate, EventHandler, IgnoreEvents, Item, KnownRows, Layout, Reason, RowFailure, Simulation, Task, Texts,
};
use shotdamp::table::{Table, parquet};

/// Each exchange of a part of a text, read as `mine.yaml`, is refused on the line, and with the words, that stand beside it.
pub fn refuses<T>(text: &str, read: impl Fn(&str) -> Result<T, String>, mistakes: &[(&str, &str, &str, &str)]) {
    for (from, to, place, what) in mistakes {
        assert!(text.contains(from), "{from}");
        let said = read(&text.replacen(from, to, 1)).err().unwrap_or_else(|| panic!("{to}"));
        assert!(said.contains(what) && said.contains(&format!("mine.yaml:{place}")), "{to}:\n{said}");
    }
}

pub const ASSUMPTIONS: &str = "
gravity: {value: 9.81 m/s^2, reason: usual, quantity: acceleration}
impulse_factor: {value: 2, range: [1.8, 2.2], reason: half sine, quantity: ratio}
impulse_frequency: {value: natural, reason: fixed, readings: [forcing, natural]}
impulse_reference: {value: base, reason: plain, readings: [base, loaded]}
harmonic_reference: {value: base, reason: plain, readings: [base, loaded]}
undamped_mass: {value: base, reason: plain, readings: [base, loaded]}
contact_damping_ratio: {value: 0.15, reason: fits, quantity: ratio, readings: [equivalent_viscous]}
stop_length: {value: 60 mm, range: [50 mm], reason: fits, quantity: length}
stop_restitution: {value: 0, reason: plastic, quantity: ratio}
defaults:
  {run: {skip: 25 cycles, average: 100 cycles}, gravity: gravity, undamped_mass: undamped_mass, impulse_factor: impulse_factor, impulse_frequency: impulse_frequency,
   frequency_reference: impulse_reference, harmonic_reference: harmonic_reference, damping_ratio: contact_damping_ratio,
   stop_length: stop_length, stop_restitution: stop_restitution}
";

pub const STOP: &str = "
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

pub const GAP: &str = "
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

/// Three rows that end in a moment, without a figure.
pub const THREE_GAPS: &str = "
title: Long
source: {chapter: 3, section: '3'}
about: Three gaps.
scene:
  structure: {single_mass: {mass: 1 kg, stiffness: 1000 N/m, damping_ratio: 0.05}}
  dampers: [{mass_ratio: 0.05, gap_ratio: swept, floor: {rigid: {restitution: 0.5}}}]
  excitation: {harmonic: {force_ratio: 5, frequency_ratio: 1}}
sweep: {gap_ratio: [10, 50, 90]}
run: {skip: 2 cycles, average: 8 cycles, ensemble: none, sensitivity: none}
measure: [rms_velocity]
";

pub const STOP_REFERENCE: &str = "
entries:
  - id: at-two
    place: s. 3.6.3
    says: The velocity ratio at f′ = 2 is 1.75.
    value: \"1.75\"
    from: {cell: {of: velocity_ratio, where: {force_ratio: 2}}}
    where: {stop: with}
";

pub const GAP_REFERENCE: &str = "
entries:
  - id: grows
    place: s. 3.6.1
    says: The largest ratio grows with the gap.
    claim: {monotone: {of: velocity_ratio, over: gap_ratio, direction: increasing}}
";

/// A study in a folder of its own.
pub struct Desk {
    pub folder: tempfile::TempDir,
    pub layout: Layout,
}

impl Desk {
    pub fn new() -> Self {
        Self::in_folder(tempfile::tempdir().unwrap())
    }

    /// In memory where the system has a folder there: for tests of many runs that would wait for the disk.
    pub fn in_memory() -> Self {
        Self::in_folder(tempfile::tempdir_in("/dev/shm").or_else(|_| tempfile::tempdir()).unwrap())
    }

    /// The same with this experiment alone, and no entries.
    pub fn of_one(name: &str, text: &str) -> Self {
        let desk = Self::in_memory();
        for name in ["experiments/ch3/ch3-stop.yaml", "experiments/ch3/ch3-gap.yaml"] {
            fs::remove_file(desk.layout.path(name)).unwrap();
        }
        fs::remove_dir_all(desk.layout.path("reference")).unwrap();
        desk.put(name, text);
        desk
    }

    fn in_folder(folder: tempfile::TempDir) -> Self {
        let layout = Layout::new(folder.path());
        let desk = Self { folder, layout };
        desk.put("experiments/assumptions.yaml", ASSUMPTIONS);
        desk.put("experiments/ch3/ch3-stop.yaml", STOP);
        desk.put("experiments/ch3/ch3-gap.yaml", GAP);
        desk.put("reference/ch3/ch3-stop.yaml", STOP_REFERENCE);
        desk.put("reference/ch3/ch3-gap.yaml", GAP_REFERENCE);
        desk
    }

    pub fn put(&self, name: &str, text: &str) {
        let path = self.folder.path().join(name);
        fs::create_dir_all(path.parent().unwrap()).unwrap();
        fs::write(path, text).unwrap();
    }

    pub fn bytes(&self, name: &str) -> Vec<u8> {
        fs::read(self.folder.path().join(name)).unwrap()
    }

    pub fn texts(&self) -> Texts {
        Texts::read(&self.layout).unwrap()
    }

    /// The plan by id; `ch3-stop` has a value to be held against, `ch3-gap` has a claim.
    pub fn plan(&self) -> BTreeMap<String, Item> {
        let study = Study::new(self.layout.clone(), self.texts());
        assert_eq!(study.unread, []);
        study.items.into_iter().map(|item| (item.source.experiment.id.to_string(), item)).collect()
    }

    /// Runs what is stale, all but the rows that are known, and returns the ids.
    pub fn run(&self, threads: usize, evaluate: &impl Evaluate, handler: &dyn EventHandler) -> Vec<String> {
        let plan = self.plan();
        let stale: Vec<&Item> = plan.values().filter(|item| !item.reasons().is_empty()).collect();
        let provenance: Vec<_> = stale.iter().map(|item| item.provenance()).collect();
        let journal = |item: &&Item| self.layout.path(&study::journal_name(&item.source.experiment.id));
        let journals: Vec<_> = stale.iter().map(journal).collect();
        let known: Vec<_> = stale.iter().map(|item| KnownRows::of(&self.layout, item)).collect();
        let tasks: Vec<Task<'_>> = stale
            .iter()
            .zip(provenance.iter().zip(&journals))
            .zip(&known)
            .map(|((item, (metadata, journal)), known)| Task { known: Some(known), ..item.task(metadata, journal) })
            .collect();
        let save = |index: usize, finished| study::save(&self.layout, stale[index], &finished).unwrap();
        study::run(&tasks, threads, evaluate, handler, save).unwrap();
        stale.iter().map(|item| item.source.experiment.id.to_string()).collect()
    }

    pub fn table(&self, id: &str) -> Table {
        parquet::read(&self.layout.path(&format!("results/{id}.parquet"))).unwrap()
    }

    pub fn why(&self, id: &str) -> Vec<String> {
        self.plan()[id].reasons().iter().map(Reason::to_string).collect()
    }
}

/// A study whose tables are there, made up.
pub fn simulated() -> Desk {
    let desk = Desk::new();
    desk.run(2, &MadeUp::default(), &IgnoreEvents);
    desk
}

/// What a command left: exit code, standard output, standard error.
pub struct Said {
    pub code: i32,
    pub out: String,
    pub err: String,
}

/// The command with these arguments, in the study.
pub fn command(desk: &Desk, arguments: &[&str]) -> Command {
    let mut command = Command::cargo_bin("shotdamp").unwrap();
    command.arg("--root").arg(desk.folder.path()).args(arguments).env_remove("GITHUB_STEP_SUMMARY");
    command
}

pub fn said(mut command: Command) -> Said {
    let output = command.output().unwrap();
    Said {
        code: output.status.code().unwrap(),
        out: String::from_utf8(output.stdout).unwrap(),
        err: String::from_utf8(output.stderr).unwrap(),
    }
}

pub fn shotdamp(desk: &Desk, arguments: &[&str]) -> Said {
    said(command(desk, arguments))
}

/// Stands in for the engine: smooth made-up numbers of the resolved scene, with a maximum over the strength of the forcing.
#[derive(Default)]
pub struct MadeUp {
    pub simulations: AtomicUsize,
}

impl Evaluate for MadeUp {
    fn evaluate(&self, it: &Simulation<'_>) -> Result<Evaluated, RowFailure> {
        self.simulations.fetch_add(1, Ordering::Relaxed);
        let scene = it.recipe.resolve(it.assumptions)?;
        let strength = match scene.excitation {
            Excitation::Harmonic { force, .. } => force.abs() / 9.81,
            Excitation::ImpulseTrain { impulse, .. } => impulse,
            _ => return Err(RowFailure::NoValue("velocity_ratio".into())),
        };
        let mass = scene.structure.model().total_mass();
        let damper = &scene.dampers[0];
        let stop = damper.stop.map_or(0.0, |stop| stop.length);
        let coarse = if it.solver == SolverChoice::EventDriven { 0.0 } else { 0.01 };
        let peak = damper.gap.min(1.0).sqrt();
        let octave = libm::log(strength / (2.0 * peak));
        let value = mass + peak / (1.0 + octave * octave) + stop + coarse;
        Ok(Evaluated {
            measured: it.request.measures.iter().map(|_| Measured { value, numerical: 1e-12, spread: 0.0 }).collect(),
            proof: Proof { events: 490, smallest_margin: 1e-3, ..Proof::default() },
            chaotic: false,
            unknown: None,
            members: 1,
            motion: None,
            trace: it.request.trace.map(|_| vec![TraceColumn::new("time", "s", vec![0.0, 1.0])]).unwrap_or_default(),
            end: None,
        })
    }
}
