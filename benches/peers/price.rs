//! Error against time: ours and the peers', as a table, a diagram and ratios.

use std::fmt::Write as _;
use std::time::Duration;

use shotdamp::accuracy::Times;
use shotdamp::dynamics::{Options, Orbit, Response, StartState, event_driven, fixed_step};
use shotdamp::figure::{Beside, draw, work_precision};
use shotdamp::table::{BASELINE, Column, Data, Table};
use shotdamp::text::number::{quantity, significant};

use crate::common;
use crate::peer::Answer;
use crate::scene::{Scene, Told, describe};

/// Digits below those of a double.
const LEAST: f64 = 1e-16;
/// How long the median of a run may take to settle.
const PATIENCE: Duration = Duration::from_secs(1);
const OWN: &str = "shotdamp event-driven";

/// One point of the diagram.
pub struct Priced {
    program: String,
    method: String,
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

/// Both solvers in several settings.
pub fn ours(scene: &Scene) -> Vec<Priced> {
    let mut answers = Vec::new();
    for window_factor in [1.0, 0.5] {
        let settings = |options: &Options| Options { window_factor, ..options.clone() };
        let run = |options: &Options| event_driven(&scene.system, &settings(options)).map_err(|e| e.to_string());
        answers.push(own(scene, OWN, format!("{OWN}, windows × {window_factor}"), &run));
    }
    for time_step in [1e-3, 1e-4, 1e-5, 1e-6] {
        let run = |options: &Options| fixed_step(&scene.system, options, time_step).map_err(|e| e.to_string());
        answers.push(own(scene, "shotdamp fixed step", format!("shotdamp fixed step, {time_step:e} s"), &run));
    }
    answers
}

/// The periodic motion next to the end of a run, by Newton on its events.
pub fn our_orbit(scene: &Scene, near: &StartState) -> Priced {
    let orbit = || Orbit::near(std::hint::black_box(&scene.system), near, 1).map_err(|error| error.to_string());
    let outcome = orbit().map(|found| {
        let times = Times::of(|| drop(std::hint::black_box(orbit())), PATIENCE);
        compared(scene, found.response.window().rms_velocity(), &[], times.least, times.median)
    });
    Priced { program: OWN.into(), method: String::new(), setting: format!("{OWN}, with multipliers"), outcome }
}

fn own(scene: &Scene, name: &str, setting: String, run: &dyn Fn(&Options) -> Result<Response, String>) -> Priced {
    let plain = Options { record_events: 0, ..scene.options.clone() };
    let outcome = run(&scene.options).map(|response| {
        let events = describe(&response, scene.system.drive.period);
        let times = Times::of(|| drop(std::hint::black_box(run(&plain))), PATIENCE);
        compared(scene, response.window().rms_velocity(), &events, times.least, times.median)
    });
    Priced { program: name.into(), method: String::new(), setting, outcome }
}

/// A peer's answer against the reference.
pub fn of_peer(scene: &Scene, answer: Answer) -> Priced {
    let outcome = answer.outcome.and_then(|run| {
        let least = run.times.first().ok_or("no time")?;
        Ok(compared(scene, run.rms, &run.events, *least, run.times[run.times.len() / 2]))
    });
    Priced { program: answer.peer.into(), method: answer.method, setting: answer.setting, outcome }
}

fn compared(scene: &Scene, rms: f64, events: &[Told], least: f64, median: f64) -> Found {
    let (right, event_error) = scene.in_order(events);
    // One event too many is as wrong as one too few.
    let of = scene.events.len().max(events.len());
    let error = scene.rms.map_or(f64::NAN, |want| (rms / want - 1.0).abs());
    Found { error, right, of, event_error, least, median }
}

/// All of them.
pub fn table(answers: &[Priced]) -> String {
    let has_events = answers.iter().any(|answer| answer.outcome.as_ref().is_ok_and(|found| found.of > 0));
    let (names, dashes) = match has_events {
        true => ("Events in the right order | Error of their times / T | ", "---: | ---: | "),
        false => ("", ""),
    };
    let mut text = format!(
        "| Solver | Error of the RMS velocity | {names}Median | Shortest |\n| --- | ---: | {dashes}---: | ---: |\n"
    );
    for Priced { setting, outcome, .. } in answers {
        let _ = match outcome {
            Ok(found) => {
                let (right, of, off) = (found.right, found.of, found.event_error);
                let events = if has_events { format!("{right} of {of} | {off:.0e} | ") } else { String::new() };
                let (median, least) = (seconds(found.median), seconds(found.least));
                writeln!(text, "| {setting} | {:.0e} | {events}{median} | {least} |", found.error)
            }
            Err(why) => {
                writeln!(text, "| {setting} | not run: {} |{}", why.replace('|', "/"), dashes.replace("---:", ""))
            }
        };
    }
    text + "\n"
}

/// The diagram: colours tell programs, dashes and markers their methods.
pub fn picture(scene: &str, answers: &[Priced]) -> Vec<u8> {
    let found: Vec<(&Priced, &Found)> =
        answers.iter().filter_map(|answer| Some((answer, answer.outcome.as_ref().ok()?))).collect();
    let floats = |name: &str, unit: &str, of: &dyn Fn(&Found) -> f64| Column {
        name: name.into(),
        unit: unit.into(),
        symbol: String::new(),
        data: Data::Float(found.iter().map(|(_, found)| of(found)).collect()),
    };
    let texts = |name: &str, of: &dyn Fn(&Priced) -> String| {
        Column::new(name, Data::Text(found.iter().map(|(answer, _)| of(answer)).collect()))
    };
    let table = Table {
        columns: vec![
            texts("variant", &|_| BASELINE.into()),
            texts("solver", &|answer| answer.program.clone()),
            texts("case", &|answer| answer.method.clone()),
            floats("time", "s", &|found| found.median),
            floats("error", "", &|found| found.error.max(LEAST)),
        ],
        ..Table::default()
    };
    let times = found.iter().map(|(_, found)| found.median);
    let times = times.fold([f64::INFINITY, 0.0], |[low, high], time: f64| [time.min(low), time.max(high)]);
    draw(&common::experiment(scene), &work_precision(times, None, false), &table, Beside::default())
        .expect("there is something to draw")
        .png
}

/// How much longer each peer takes than the event-driven solver, which has all digits, for an error.
pub fn ratios(answers: &[Priced]) -> String {
    let found = || answers.iter().filter_map(|answer| Some((answer.name(), answer.outcome.as_ref().ok()?)));
    let Some(own) = found().find(|(solver, _)| solver == OWN).map(|(_, own)| own.median) else {
        return String::new();
    };
    let mut solvers: Vec<String> = Vec::new();
    for (solver, _) in found() {
        if solver != OWN && !solvers.contains(&solver) {
            solvers.push(solver);
        }
    }
    let mut text = String::from(
        "Time over that of the event-driven solver, for errors no larger than:\n\n| Solver | 1 % | 1e-4 | 1e-8 | 1e-12 |\n\
         | --- | ---: | ---: | ---: | ---: |\n",
    );
    for solver in solvers {
        let _ = write!(text, "| {solver} ");
        for goal in [1e-2, 1e-4, 1e-8, 1e-12] {
            let reached =
                found().filter(|(of, found)| *of == solver && found.error <= goal).map(|(_, found)| found.median);
            let _ = match reached.reduce(f64::min) {
                Some(time) => write!(text, "| × {} ", significant(time / own, 2)),
                None => write!(text, "| ✗ "),
            };
        }
        text += "|\n";
    }
    text + "\n"
}

impl Priced {
    fn name(&self) -> String {
        if self.method.is_empty() { self.program.clone() } else { format!("{}, {}", self.program, self.method) }
    }
}

fn seconds(value: f64) -> String {
    quantity(value, "s", 3)
}
