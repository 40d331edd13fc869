//! A scene with its reference, and what a peer is told of it.

use std::path::{Path, PathBuf};
use std::time::Duration;

use serde_json::{Value, json};
use shotdamp::accuracy::precise::precise;
use shotdamp::dynamics::{Event, EventKind, HybridSystem, Law, Options, Response};

use crate::common;

/// Cycles after which nothing is left of a start.
pub const SETTLED_AFTER: u32 = 1000;

/// An event as peers tell it.
#[derive(Debug, Clone, PartialEq)]
pub struct Told {
    /// s, from the start.
    pub time: f64,
    pub particle: usize,
    pub word: String,
}

/// A scene with its reference.
pub struct Scene {
    pub system: HybridSystem,
    pub options: Options,
    /// RMS velocity, where there is one.
    pub rms: Option<f64>,
    pub events: Vec<Told>,
}

impl Scene {
    /// From YAML, with the reference from arithmetic of 32 digits; `cycles` are left out and averaged over.
    pub fn of_many_digits(text: &str, [skip, average]: [u32; 2]) -> Self {
        let system = common::system(text);
        let options = Options { skip, average, displacement: false, record_events: usize::MAX, ..Options::default() };
        let reference =
            precise(&system, &options, Duration::from_secs(600)).expect("the benchmarks' scenes have a reference");
        let rms = Some(reference.window().rms_velocity());
        let events = describe(&reference, system.drive.period);
        Self { system, options, rms, events }
    }

    /// The periodic motion that its run goes on to: its RMS velocity by the same arithmetic, many cycles later.
    pub fn settled(&self) -> Self {
        let options = Options { skip: SETTLED_AFTER, average: 1, ..self.options.clone() };
        let reference = precise(&self.system, &options, Duration::from_secs(600)).expect("it has a reference");
        let rms = Some(reference.window().rms_velocity());
        Self { system: self.system.clone(), options: self.options.clone(), rms, events: Vec::new() }
    }

    /// Events of `got` in the right order from the first on, and the largest error of their times over the period.
    pub fn in_order(&self, got: &[Told]) -> (usize, f64) {
        let alike = |(got, want): &(&Told, &Told)| got.particle == want.particle && got.word == want.word;
        let right: Vec<_> = got.iter().zip(&self.events).take_while(alike).collect();
        let off = |(got, want): &(&Told, &Told)| ((got.time - want.time) / self.system.drive.period).abs();
        (right.len(), right.iter().map(off).fold(0.0, f64::max))
    }

    /// Writes `stem.json`, and the same numbers as `stem.txt` for the program in C; returns the first.
    pub fn describe(&self, stem: &Path) -> PathBuf {
        std::fs::create_dir_all(stem.parent().expect("it has a folder")).expect("target can be written");
        let json = stem.with_extension("json");
        std::fs::write(&json, self.json().to_string()).expect("target can be written");
        std::fs::write(stem.with_extension("txt"), self.text()).expect("target can be written");
        json
    }

    /// Matrices, faces, drive, and the static equilibrium that it starts from.
    fn json(&self) -> Value {
        let system = &self.system;
        let face = |law| {
            let [stiffness, damping] = spring(law);
            json!({"stiffness": stiffness, "damping": damping})
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

    fn text(&self) -> String {
        let system = &self.system;
        let cycles = [self.options.skip, self.options.skip + self.options.average].map(f64::from);
        let mut numbers = vec![system.mass.order as f64, system.particles.len() as f64];
        numbers.extend(cycles);
        numbers.extend([system.gravity, system.drive.period]);
        for matrix in [&system.mass, &system.damping, &system.stiffness] {
            numbers.extend(&matrix.entries);
        }
        numbers.extend(system.force_row.iter().map(|row| row * system.drive.ticks[0].impulse));
        numbers.extend(&system.observed_rows[0]);
        for particle in &system.particles {
            numbers.extend([particle.mass, particle.gap]);
            numbers.extend(&particle.floor.row);
            numbers.extend(spring(particle.floor.law));
            numbers.extend(particle.ceiling.as_ref().map_or([0.0; 2], |ceiling| spring(ceiling.law)));
        }
        numbers.extend(self.start());
        numbers.iter().map(|number| format!("{number:e}\n")).collect()
    }

    /// q, y and their rates where gravity holds the particles on their floors.
    fn start(&self) -> Vec<f64> {
        let system = &self.system;
        let n = system.mass.order;
        let stiffness = nalgebra::DMatrix::from_row_slice(n, n, &system.stiffness.entries);
        let mut load = nalgebra::DVector::zeros(n);
        for particle in &system.particles {
            load -= nalgebra::DVector::from_column_slice(&particle.floor.row) * (particle.mass * system.gravity);
        }
        let q = stiffness.lu().solve(&load).expect("the structure has a stiffness");
        let mut start = q.as_slice().to_vec();
        start.extend(system.particles.iter().map(|particle| {
            let floor: f64 = particle.floor.row.iter().zip(q.iter()).map(|(row, q)| row * q).sum();
            floor - particle.mass * system.gravity / spring(particle.floor.law)[0]
        }));
        start.resize(2 * start.len(), 0.0);
        start
    }
}

/// The events of a run of ours.
pub fn describe(response: &Response, period: f64) -> Vec<Told> {
    let description = |event: &Event| Told {
        time: event.cycle as f64 * period + event.time,
        particle: event.particle,
        word: word(event.kind).into(),
    };
    response.events.iter().map(description).collect()
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

fn spring(law: Law) -> [f64; 2] {
    match law {
        Law::Resilient { stiffness, damping, .. } => [stiffness, damping],
        Law::Rigid { .. } => panic!("the peers know springs and dashpots only"),
    }
}
