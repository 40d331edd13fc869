//! Well-formed scenes at the ends of what numbers can be: each ends in an answer, in a reason, or at a limit that is told, and
//! `edge_scenes.txt` says in which.

use std::collections::BTreeMap;
use std::fmt::Write;
use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::time::{Duration, Instant};

use shotdamp::dynamics::{Limit, Proof};
use shotdamp::experiment::Assumptions;
use shotdamp::experiment::{load_assumptions, parse_experiment};
use shotdamp::measure::Evaluated;
use shotdamp::study::{Engine, Evaluate, Finished, IgnoreEvents, RowFailure, Simulation, Task, Variant, run};
use shotdamp::table::{UNDEFINED, UNKNOWN};

use crate::mutations::memory;

/// Scenes by name, with a place for each value.
const BASES: &str = include_str!("edge_scenes/bases.txt");
/// `base | changes | answer`.
const SCENES: &str = include_str!("edge_scenes/scenes.txt");

/// What a row may take here; a scene without an answer has none in an hour either.
const LIMIT: Limit = Limit { events: 30_000, time: Duration::from_millis(400) };

/// A base: its text with `«name»` in the place of each value, and the usual values.
struct Base<'a> {
    text: String,
    usual: BTreeMap<&'a str, &'a str>,
}

fn bases() -> BTreeMap<&'static str, Base<'static>> {
    let of = |part: &'static str| {
        let (head, text) = part.split_once('\n').unwrap();
        let (name, values) = head.split_once('|').unwrap();
        let text = format!("title: Edge\nsource: {{chapter: 3, section: '3'}}\nabout: At the edge.\n{text}");
        (name.trim(), Base { text, usual: changes(values).collect() })
    };
    BASES.split("\n== ").filter(|part| part.contains('|')).map(|part| of(part.trim_start_matches("== "))).collect()
}

fn changes(text: &str) -> impl Iterator<Item = (&str, &str)> {
    text.split(';').map(|change| {
        let (name, value) = change.split_once('=').unwrap_or_else(|| panic!("{change}"));
        (name.trim(), value.trim())
    })
}

impl Base<'_> {
    fn text(&self, changed: &str) -> String {
        let mut values = self.usual.clone();
        for (name, value) in changes(changed) {
            assert!(values.insert(name, value).is_some(), "no `{name}` in this base");
        }
        values.iter().fold(self.text.clone(), |text, (name, value)| text.replace(&format!("«{name}»"), value))
    }
}

fn assumptions() -> Assumptions {
    let folder = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("experiments");
    load_assumptions(&folder.join("assumptions.yaml")).unwrap_or_else(|problems| panic!("{problems}")).assumptions()
}

/// How a scene ends.
struct Answer {
    /// In which of its ways.
    got: String,
    took: Duration,
    /// What proves its run, if it has one.
    proof: Option<Proof>,
}

impl Answer {
    /// Residual and bound of an audited run.
    fn balance(&self) -> Option<[f64; 2]> {
        let proof = self.proof.filter(|proof| proof.residual_bound.is_finite())?;
        Some([proof.residual(), proof.residual_bound])
    }
}

/// The engine, and the proof of its last simulation.
#[derive(Default)]
struct Noting(Mutex<Option<Proof>>);

impl Evaluate for Noting {
    fn evaluate(&self, simulation: &Simulation<'_>) -> Result<Evaluated, RowFailure> {
        let evaluated = Engine.evaluate(simulation)?;
        *self.0.lock().unwrap() = Some(evaluated.proof);
        Ok(evaluated)
    }
}

fn answer(text: &str, assumptions: &Assumptions) -> Answer {
    let begun = Instant::now();
    let experiment = match parse_experiment(&"ch3-edge".parse().unwrap(), "ch3-edge.yaml", text, assumptions) {
        Ok(experiment) => experiment,
        Err(problems) => {
            let got = format!("refused: {}", problems.list[0].message);
            return Answer { got, took: begun.elapsed(), proof: None };
        }
    };
    let variants = [Variant { label: "baseline".into(), moved: None, assumptions: assumptions.clone() }];
    let metadata = BTreeMap::new();
    let task = Task { limit: LIMIT, ..Task::new(&experiment, &variants, &metadata) };
    let engine = Noting::default();
    let Finished { table, failures, .. } =
        run(&[task], 1, &engine, &IgnoreEvents, |_, finished| finished).unwrap().remove(0);
    let got = if failures.rows > 0 {
        failures.first
    } else if table.is_unbalanced(0) {
        "unbalanced".into()
    } else if let Some(reasons) = table.texts(UNDEFINED).or_else(|| table.texts(UNKNOWN)) {
        reasons[0].clone()
    } else {
        let measures = ["velocity_ratio", "displacement_ratio", "rms_velocity"];
        let values: Vec<f64> = measures.iter().filter_map(|name| Some(table.floats(name)?[0])).collect();
        assert!(values.len() == 3 && values.iter().all(|value| value.is_finite()), "{values:?}");
        "numbers".into()
    };
    Answer { got, took: begun.elapsed(), proof: engine.0.into_inner().unwrap() }
}

/// With `SHOTDAMP_EDGE_SCENES=all` it prints every answer, how long it took, and the residual of its balances with their bound.
#[test]
fn every_scene_ends_in_an_answer_a_reason_or_a_limit() {
    let assumptions = assumptions();
    let bases = bases();
    let scenes: Vec<Vec<&str>> = SCENES
        .lines()
        .filter(|line| !line.is_empty() && !line.starts_with('#'))
        .map(|line| line.splitn(3, '|').map(str::trim).collect())
        .collect();
    // On threads of their own: one that waits in a pool would work on another scene meanwhile, and count its time.
    let next = AtomicUsize::new(0);
    let worker = || {
        let own =
            std::iter::from_fn(|| Some(next.fetch_add(1, Ordering::Relaxed)).filter(|index| *index < scenes.len()));
        own.map(|index| (index, answer(&bases[scenes[index][0]].text(scenes[index][1]), &assumptions)))
            .collect::<Vec<_>>()
    };
    let answers: BTreeMap<usize, Answer> = std::thread::scope(|scope| {
        let workers = [(); 2].map(|()| scope.spawn(worker));
        workers.into_iter().flat_map(|worker| worker.join().unwrap()).collect()
    });
    let answers: Vec<Answer> = answers.into_values().collect();
    let (mut wrong, mut kinds, mut stopped) = (String::new(), BTreeMap::<&str, u32>::new(), 0);
    for (scene, answer) in scenes.iter().zip(&answers) {
        let Answer { got, took, .. } = answer;
        let expected = scene.get(2).copied().unwrap_or("nothing");
        if std::env::var_os("SHOTDAMP_EDGE_SCENES").is_some() {
            let balance =
                answer.balance().map_or_else(String::new, |[residual, bound]| format!("{residual:.1e} | {bound:.1e}"));
            println!("{} | {} | {got} | {took:.2?} | {balance}", scene[0], scene[1]);
        }
        *kinds.entry(expected.split([':', ' ']).next().unwrap()).or_default() += 1;
        // How far a scene gets in its time is the machine's business; that the limit is told is not.
        let ran_out_of_time = got.starts_with("stopped at the limit of") && got.contains("processor time");
        stopped += usize::from(ran_out_of_time);
        // A row may leave the range of numbers.
        let fits = if expected == "numbers" { got == expected } else { got.contains(expected) };
        if !fits && !ran_out_of_time {
            writeln!(wrong, "{} | {}: {got}, expected {expected}", scene[0], scene[1]).unwrap();
        }
    }
    let longest = answers.iter().map(|answer| answer.took).max().unwrap();
    let shares = answers.iter().filter(|answer| answer.got == "numbers").filter_map(Answer::balance);
    let nearest = shares.map(|[residual, bound]| residual / bound).fold(0.0, f64::max);
    println!("largest residual of a scene with numbers, over its bound: {nearest:.2}; {}", memory());
    println!("{} scenes, {kinds:?}; the longest took {longest:.2?}", scenes.len());
    assert!(wrong.is_empty(), "{wrong}");
    assert!(stopped < scenes.len() / 3, "{stopped} scenes ran out of time");
}
