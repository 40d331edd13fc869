//! The solver's version stands for its bits: a table of another version is stale. So the bits of a few small experiments are
//! held beside the version that gave them, and bits that change without it are found here and not in somebody's results.
//!
//! The experiments lie in `tests/it/data/solver`, as a study of its own, and pass through all that makes a table: scene,
//! both solvers, ensembles, maxima, measures, time histories.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::sync::Mutex;

use serde::{Deserialize, Serialize};
use shotdamp::dynamics::SOLVER_VERSION;
use shotdamp::study::Study;
use shotdamp::study::{self, Engine, IgnoreEvents, Layout, Task, Texts};
use shotdamp::table::{Data, Table};

/// Set it to write the bits down instead of comparing them.
const WRITE: &str = "SHOTDAMP_WRITE_BITS";
/// A column of so many numbers is written out; of a longer one, a hash.
const WRITTEN_OUT: usize = 12;

/// Of each experiment, the bits of each column of numbers, in hexadecimal.
type Bits = BTreeMap<String, BTreeMap<String, String>>;

#[derive(Debug, PartialEq, Serialize, Deserialize)]
struct Held {
    solver_version: u32,
    bits: Bits,
}

fn folder() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/it/data/solver")
}

#[test]
fn no_bit_of_a_result_changes_without_the_solvers_version() {
    let file = folder().join("bits.json");
    let held: Option<Held> = std::fs::read(&file).ok().map(|text| serde_json::from_slice(&text).unwrap());
    let now = Held { solver_version: SOLVER_VERSION, bits: bits() };
    let changes = held.as_ref().map_or_else(Vec::new, |held| changes(&held.bits, &now.bits));
    assert!(
        changes.is_empty() || held.as_ref().is_some_and(|held| held.solver_version != SOLVER_VERSION),
        "the solver gives other bits than version {SOLVER_VERSION} did:\n  {}\n\
         If that is not meant, something broke. If it is, raise SOLVER_VERSION in dynamics/src/lib.rs, so that tables of \
         the old solver count as stale, and write the new bits down:\n  \
         {WRITE}=1 cargo test --test it solver_version",
        changes.join("\n  ")
    );
    if std::env::var_os(WRITE).is_some() {
        let text = serde_json::to_string_pretty(&now).unwrap() + "\n";
        std::fs::write(&file, text).unwrap();
    } else {
        assert!(
            held.as_ref() == Some(&now),
            "the bits of version {SOLVER_VERSION} are not written down yet:\n  \
             {WRITE}=1 cargo test --test it solver_version"
        );
    }
}

/// Runs the experiments and takes the bits of their tables.
fn bits() -> Bits {
    let layout = Layout::new(folder());
    let texts = Texts::read(&layout).unwrap();
    let study = Study::new(layout, texts);
    assert_eq!(study.unread, []);
    let metadata = BTreeMap::new();
    let task = |item: &study::Item| (item.source.experiment.clone(), item.variants.clone());
    let planned: Vec<_> = study.items.iter().map(task).collect();
    let tasks: Vec<Task<'_>> =
        planned.iter().map(|(experiment, variants)| Task::new(experiment, variants, &metadata)).collect();
    let bits = Mutex::new(Bits::new());
    study::run(&tasks, 2, &Engine, &IgnoreEvents, |index, finished| {
        assert_eq!(finished.failures.rows, 0, "{}", finished.failures.first);
        bits.lock().unwrap().insert(planned[index].0.id.to_string(), of_table(&finished.table));
    })
    .unwrap();
    bits.into_inner().unwrap()
}

fn of_table(table: &Table) -> BTreeMap<String, String> {
    let column = |data: &Data| -> Option<String> {
        let all: Vec<String> = match data {
            Data::Float(cells) => cells.iter().copied().map(hexadecimal).collect(),
            Data::Int(cells) => cells.iter().map(i64::to_string).collect(),
            Data::FloatList(lists) => lists.iter().flatten().copied().map(hexadecimal).collect(),
            Data::Text(_) => return None,
        };
        let text = all.join(" ");
        let short = all.len() <= WRITTEN_OUT;
        Some(if short { text } else { format!("blake3 {}", blake3::hash(text.as_bytes()).to_hex()) })
    };
    table.columns.iter().filter_map(|it| Some((it.name.clone(), column(&it.data)?))).collect()
}

/// One NaN is as good as another: processors differ in its bits, and nothing is read off them.
fn hexadecimal(x: f64) -> String {
    if x.is_nan() { "NaN".into() } else { format!("{:016x}", x.to_bits()) }
}

/// What changed, in words, one line a column.
fn changes(before: &Bits, now: &Bits) -> Vec<String> {
    let all = |bits: &Bits| -> BTreeMap<String, String> {
        let columns = bits.iter().flat_map(|(id, columns)| columns.iter().map(move |(name, bits)| (id, name, bits)));
        columns.map(|(id, name, bits)| (format!("{id}: {name}"), bits.clone())).collect()
    };
    let (before, now) = (all(before), all(now));
    let gone = before.keys().filter(|column| !now.contains_key(*column)).map(|column| format!("{column} is gone"));
    let altered = now.iter().filter_map(|(column, new)| match before.get(column) {
        Some(old) if old == new => None,
        Some(old) => Some(format!("{column}{}", by_how_much(old, new))),
        None => Some(format!("{column} is new")),
    });
    gone.chain(altered).collect()
}

/// The largest relative change, if the numbers are written out.
fn by_how_much(old: &str, new: &str) -> String {
    let numbers = |text: &str| -> Option<Vec<f64>> {
        let number = |word: &str| u64::from_str_radix(word, 16).ok().filter(|_| word.len() == 16).map(f64::from_bits);
        text.split(' ').map(number).collect()
    };
    let (Some(old), Some(new)) = (numbers(old), numbers(new)) else { return String::new() };
    let change = |(old, new): (&f64, &f64)| (new - old).abs() / old.abs().max(f64::MIN_POSITIVE);
    let largest = old.iter().zip(&new).map(change).fold(0.0, f64::max);
    format!(", by up to {largest:.1e} of it")
}
