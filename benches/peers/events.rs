//! Sequences of events that general integrators lose, double or never finish: is each right to its last event?

use std::fmt::Write as _;
use std::path::Path;

use serde_json::Value;
use shotdamp::dynamics::{Options, event_driven};
use shotdamp::scene::{
    ContactDamping, ContactEnd, Damper, Excitation, Scene as Described, SingleMass, Surface, compile,
};

use crate::peer::{Answer, Peer};
use crate::scene::{Scene, Told, describe};

/// m/s².
const GRAVITY: f64 = 9.81;
/// The engine's tests read the same cases.
const CASES: &str = include_str!("../../tests/it/data/event-cases.json");

struct Case {
    family: String,
    scene: Scene,
}

/// A column of the table: what one method says of every case.
struct Column {
    name: String,
    cells: Vec<Cell>,
}

enum Cell {
    /// Events in the right order, how many were told, and the largest error of the times of the right ones over the period.
    Answered {
        right: usize,
        description: usize,
        error: f64,
    },
    Failed(String),
}

/// The page.
pub fn page(peers: &[Peer], scratch: &Path) -> String {
    let cases = cases();
    let files: Vec<_> = cases
        .iter()
        .enumerate()
        .map(|(i, case)| case.scene.describe(&scratch.join(format!("events/{:02}", i + 1))))
        .collect();
    let mut columns = vec![ours(&cases)];
    let mut not_run = Vec::new();
    for peer in peers {
        let answers = peer.tightest(&files);
        match answers.as_slice() {
            [Answer { file, outcome: Err(why), .. }] if file.is_empty() => {
                not_run.push(format!("{}: {why}", peer.name))
            }
            _ => columns.extend(of_peer(&cases, &answers)),
        }
    }
    written(&cases, &columns, &not_run)
}

fn cases() -> Vec<Case> {
    let data: Value = serde_json::from_str(CASES).expect("the data file is JSON");
    data["cases"].as_array().expect("it has cases").iter().map(Case::read).collect()
}

impl Case {
    fn read(case: &Value) -> Self {
        let number = |key: &str| case["scene"][key].as_f64().expect("the data file has every parameter");
        let mass = SingleMass {
            mass: number("m"),
            stiffness: number("ks"),
            damping: 2.0 * number("zeta") * (number("ks") * number("m")).sqrt(),
        };
        let surface = Surface::Resilient {
            stiffness: number("kf"),
            damping: ContactDamping::Constant(number("cf")),
            ends: ContactEnd::ZeroGap,
        };
        let damper = Damper::between(surface, number("mp"), number("h"));
        let excitation = Excitation::ImpulseTrain { impulse: number("J"), period: number("T") };
        let system =
            compile(&Described::on_one_mass(mass, GRAVITY, vec![damper], excitation)).expect("the cases compile");
        let options = Options {
            skip: 0,
            average: number("cycles") as u32,
            displacement: false,
            record_events: usize::MAX,
            ..Options::default()
        };
        let event = |event: &Value| Told {
            time: event[0].as_f64().expect("an event has a time"),
            particle: 0,
            word: word(event[1].as_str().expect("an event has a kind")).into(),
        };
        let events = case["first_events"].as_array().expect("a case has events").iter().map(event).collect();
        let family = case["family"].as_str().expect("a case has a family").to_owned();
        Self { family, scene: Scene { system, options, rms: None, events } }
    }

    fn cell(&self, events: &[Told]) -> Cell {
        let (right, error) = self.scene.in_order(events);
        Cell::Answered { right, description: events.len(), error }
    }
}

fn word(kind: &str) -> &'static str {
    match kind {
        "leave1" => "floor_release",
        "land" => "floor_contact",
        "ceil" => "ceiling_contact",
        "leave2" => "ceiling_release",
        other => panic!("an event of another kind: {other}"),
    }
}

fn ours(cases: &[Case]) -> Column {
    let cell = |case: &Case| match event_driven(&case.scene.system, &case.scene.options) {
        Ok(response) => case.cell(&describe(&response, case.scene.system.drive.period)),
        Err(error) => Cell::Failed(error.to_string()),
    };
    Column { name: "shotdamp event-driven".into(), cells: cases.iter().map(cell).collect() }
}

/// A column a method; answers come scene by scene.
fn of_peer(cases: &[Case], answers: &[Answer]) -> Vec<Column> {
    let mut columns: Vec<(String, Vec<Option<Cell>>)> = Vec::new();
    for answer in answers {
        let stem = Path::new(&answer.file).file_stem().and_then(|stem| stem.to_str());
        let Some(number) = stem.and_then(|stem| stem.parse::<usize>().ok()) else { continue };
        let at = columns.iter().position(|(name, _)| *name == answer.setting).unwrap_or_else(|| {
            columns.push((answer.setting.clone(), cases.iter().map(|_| None).collect()));
            columns.len() - 1
        });
        columns[at].1[number - 1] = Some(match &answer.outcome {
            Ok(run) => cases[number - 1].cell(&run.events),
            Err(why) => Cell::Failed(why.clone()),
        });
    }
    let whole = |cells: Vec<Option<Cell>>| {
        cells.into_iter().map(|cell| cell.unwrap_or_else(|| Cell::Failed("no answer".into()))).collect()
    };
    columns.into_iter().map(|(name, cells)| Column { name, cells: whole(cells) }).collect()
}

fn written(cases: &[Case], columns: &[Column], not_run: &[String]) -> String {
    let mut text = format!(
        "# Hard sequences of events\n\n[Peers](peers.md) · [hard cases](../hard-cases.md) · written by `cargo bench --bench peers -- \
         events`\n\nEvery solver in its tightest setting on {} scenes of one mass and one damper, which the engine’s tests check \
         too. The reference is arithmetic of 128 bits. A cell has ✓ where the sequence of events is right to the last one, with \
         the largest error of their times over the forcing period; otherwise how many are right from the first on, of how \
         many, and how many there were. Solvers that look for roots between their steps step over a contact that is shorter \
         than a step; a bound on the step would help who knows how short, and none is set.\n\n",
        cases.len()
    );
    let names: Vec<&str> = columns.iter().map(|column| column.name.as_str()).collect();
    let _ = writeln!(text, "| Case | Events | {} |", names.join(" | "));
    let _ = writeln!(text, "| --- | ---: |{}", " ---: |".repeat(columns.len()));
    let mut failures: Vec<String> = Vec::new();
    for (i, case) in cases.iter().enumerate() {
        let want = case.scene.events.len();
        let cells: Vec<String> = columns.iter().map(|column| column.cells[i].describe(want)).collect();
        let _ = writeln!(text, "| {}, {} | {want} | {} |", i + 1, case.family, cells.join(" | "));
        failures.extend(columns.iter().filter_map(|column| match &column.cells[i] {
            Cell::Failed(why) => Some(format!("Case {}, {}: {why}", i + 1, column.name)),
            Cell::Answered { .. } => None,
        }));
    }
    let all: Vec<String> = columns
        .iter()
        .map(|column| {
            let right = column.cells.iter().zip(cases).filter(|(cell, case)| cell.is_right(case.scene.events.len()));
            format!("**{} of {}**", right.count(), cases.len())
        })
        .collect();
    let _ = writeln!(text, "| **Right to the last event** | | {} |\n", all.join(" | "));
    for line in not_run.iter().map(|why| format!("Not run: {why}")).chain(failures) {
        let _ = writeln!(text, "- {line}.");
    }
    text
}

impl Cell {
    fn is_right(&self, want: usize) -> bool {
        matches!(self, Self::Answered { right, description, .. } if *right == want && *description == want)
    }

    fn describe(&self, want: usize) -> String {
        match self {
            Self::Answered { error, .. } if self.is_right(want) => format!("✓ {error:.0e}"),
            Self::Answered { right, description, .. } => format!("{right} of {want}; {description}"),
            Self::Failed(_) => "failed".into(),
        }
    }
}
