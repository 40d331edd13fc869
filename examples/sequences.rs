//! Two builds compared event by event: what an engine decides, in a file, and two such files held against each other.
//!
//! `cargo run --example sequences -- write FILE ROWS [EXPERIMENT...]` runs up to `ROWS` rows of each experiment of this study (all if
//! none is named) and writes every event down; `... -- compare OLD NEW` says where two files part. Chaotic runs part where rounding has
//! grown to what can be seen; others should not.

use std::collections::BTreeMap;
use std::fmt::Write as _;
use std::fs;

use shotdamp::dynamics::{Options, event_driven};
use shotdamp::measure::Trial;
use shotdamp::publish::Opened;
use shotdamp::spec::Experiment;
use shotdamp::study::{Layout, Texts};

type Failure = Box<dyn std::error::Error>;

/// Events further apart than this share of their time are not the same.
const APART: f64 = 1e-7;
/// Margins further apart than this share are listed.
const SHARP: f64 = 0.01;

fn main() -> Result<(), Failure> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let words: Vec<&str> = arguments.iter().map(String::as_str).collect();
    match words[..] {
        ["write", file, rows, ref wanted @ ..] => Ok(fs::write(file, sequences(rows.parse()?, wanted)?)?),
        ["compare", old, new] => {
            print!("{}", compared(&fs::read_to_string(old)?, &fs::read_to_string(new)?)?);
            Ok(())
        }
        _ => Err("write FILE ROWS [EXPERIMENT...], or compare OLD NEW".into()),
    }
}

/// Every event of the experiments wanted.
fn sequences(rows: usize, wanted: &[&str]) -> Result<String, Failure> {
    let layout = Layout::new(env!("CARGO_MANIFEST_DIR"));
    let texts = Texts::read(&layout)?;
    let study = Opened::new(layout, texts);
    let mut text = String::new();
    for item in &study.items {
        let experiment = &item.source.experiment;
        if wanted.is_empty() || wanted.contains(&experiment.id.to_string().as_str()) {
            write_experiment(&mut text, experiment, &study, rows)?;
        }
    }
    Ok(text)
}

fn write_experiment(text: &mut String, experiment: &Experiment, study: &Opened, rows: usize) -> Result<(), Failure> {
    let assumptions = study.sheet.assumptions();
    let step = experiment.cases.len().div_ceil(rows.max(1)).max(1);
    for (row, case) in experiment.cases.iter().enumerate().step_by(step) {
        let recipes = experiment.recipes_of(case)?;
        let Some(recipe) = recipes.get(recipes.len() / 2) else { continue };
        let trial = Trial::new(recipe, &assumptions, &experiment.settings, &experiment.measures)?;
        let options = Options { record_events: usize::MAX, ..trial.options.clone() };
        match event_driven(&trial.system, &options) {
            Err(error) => writeln!(text, "run {}:{row} refused: {error}", experiment.id)?,
            Ok(response) => {
                let (rms, proof) = (response.window().rms_velocity(), response.proof);
                writeln!(text, "run {}:{row} {rms:?} {:?}", experiment.id, proof.smallest_margin)?;
                for event in &response.events {
                    writeln!(text, "{} {:?} {} {:?}", event.cycle, event.time, event.particle, event.kind)?;
                }
            }
        }
    }
    Ok(())
}

/// One run as it is written down.
struct Run<'a> {
    /// RMS velocity and smallest margin, or why there are none.
    result: Result<[f64; 2], &'a str>,
    /// Time within the cycle, and all that must be the same.
    events: Vec<(f64, [&'a str; 3])>,
}

fn runs(text: &str) -> Result<BTreeMap<&str, Run<'_>>, Failure> {
    let mut runs = BTreeMap::new();
    for part in text.split("run ").filter(|part| !part.is_empty()) {
        let mut lines = part.lines();
        let (name, result) = lines.next().and_then(|head| head.split_once(' ')).ok_or("a run without a name")?;
        let numbers = result.split_once(' ').map(|(rms, margin)| Some([rms.parse().ok()?, margin.parse().ok()?]));
        let events: Option<Vec<_>> = lines
            .map(|line| match line.split(' ').collect::<Vec<_>>()[..] {
                [cycle, time, particle, kind] => Some((time.parse().ok()?, [cycle, particle, kind])),
                _ => None,
            })
            .collect();
        let events = events.ok_or_else(|| format!("{name}: an event that is none"))?;
        runs.insert(name, Run { result: numbers.flatten().ok_or(result), events });
    }
    Ok(runs)
}

/// Where two files part, run by run.
fn compared(old: &str, new: &str) -> Result<String, Failure> {
    let (old, new) = (runs(old)?, runs(new)?);
    let (mut text, mut same) = (String::new(), 0);
    for (name, before) in &old {
        let Some(now) = new.get(name) else {
            writeln!(text, "{name}: only in the first file")?;
            continue;
        };
        let pairs = before.events.iter().zip(&now.events);
        let far =
            |(a, b): &(&(f64, [&str; 3]), &(f64, [&str; 3]))| a.1 != b.1 || !((a.0 - b.0).abs() <= APART * a.0.abs());
        let parts = pairs.clone().position(|pair| far(&pair));
        let until = parts.unwrap_or(before.events.len().min(now.events.len()));
        let moved = pairs.take(until).fold(0.0_f64, |most, (a, b)| most.max((a.0 - b.0).abs()));
        match (&before.result, &now.result) {
            (Ok(_), Ok(_)) if parts.is_some() || before.events.len() != now.events.len() => {
                let counts = [before.events.len(), now.events.len()];
                writeln!(text, "{name}: parts at event {until} of {counts:?}, moved by {moved:.1e} s before")?;
            }
            (Ok([rms, margin]), Ok([rms_now, margin_now])) => {
                let [rms, margin] = [(rms_now, rms), (margin_now, margin)].map(|(now, old)| now / old - 1.0);
                if margin.abs() > SHARP || rms.abs() > 1e-12 {
                    writeln!(
                        text,
                        "{name}: same events, moved by {moved:.1e} s; RMS by {rms:.1e}, margin by {margin:.1e}"
                    )?;
                }
                same += 1;
            }
            (Err(before), Err(now)) if before == now => same += 1,
            (before, now) => writeln!(text, "{name}: {before:?} became {now:?}")?,
        }
    }
    writeln!(text, "{same} of {} runs have the same events", old.len())?;
    Ok(text)
}
