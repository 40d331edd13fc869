//! Files that an accident has changed: a byte flipped, a line lost, a unit swapped, a bomb planted. Every one is understood or
//! refused with its place, never a panic, and what it makes of a scene ends within its limit.
//!
//! Seeded, so that each run tries the same; `SHOTDAMP_MUTATIONS=100000` tries more, `SHOTDAMP_MUTATION_SEED` others.

use std::collections::BTreeMap;
use std::fs::{self, File, FileTimes};
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicU64, Ordering};
use std::time::{Duration, Instant};

use shotdamp::dynamics::Limit;
use shotdamp::experiment::Experiment;
use shotdamp::measure::Settings;
use shotdamp::study::{Engine, IgnoreEvents, Layout, Study, Task, Texts, Variant, run};
use shotdamp::table::parquet;

use crate::cli::relative_files;
use crate::desk::{Desk, MadeUp, shotdamp};

/// What a row may take here.
const LIMIT: Limit = Limit { events: 1000, time: Duration::from_millis(100) };

/// A generator of whole numbers (SplitMix64).
struct Dice(u64);

impl Dice {
    fn below(&mut self, end: usize) -> usize {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((z ^ (z >> 31)) % end.max(1) as u64) as usize
    }

    fn of<'a, T>(&mut self, list: &'a [T]) -> &'a T {
        &list[self.below(list.len())]
    }
}

fn setting(name: &str, usual: u64) -> u64 {
    std::env::var(name).ok().and_then(|text| text.parse().ok()).unwrap_or(usual)
}

/// The files of each kind that are changed: short ones, since all of them are read thousands of times.
const ORIGINALS: [&str; 8] = [
    "experiments/assumptions.yaml",
    "experiments/ch3/ch3-damped-decay.yaml",
    "experiments/ch3/ch3-favourable-impact.yaml",
    "experiments/ch4/ch4-mode-shapes.yaml",
    "experiments/ch5/ch5-mode-shapes.yaml",
    "reference/ch3/ch3-limit-stop.yaml",
    "reference/ch4/ch4-mode-shapes.yaml",
    "calibrations/beam-arrays.yaml",
];

/// Scenes that run in a moment, with most of what a scene can have.
const SCENES: [(&str, &str); 2] = [
    (
        "experiments/ch3/ch3-mass.yaml",
        "title: Mass
source: {chapter: 3, section: '3'}
about: One mass.
scene:
  structure: {single_mass: {mass: 1 kg, stiffness: 1000 N/m, damping_ratio: 0.05}}
  dampers:
    - mass_ratio: swept
      gap: 40 mm
      floor: {resilient: {stiffness_ratio: 1, damping_ratio: 0.15, no_tension: true}}
      ceiling: {rigid: {restitution: 0.5}}
      stop: {length: 50 mm, restitution: 0.3}
  excitation: {pulse_train: {shape: rectangular, duration: 10 ms, force_ratio: swept, frequency_ratio: 1}}
sweep: {mass_ratio: [0.05, 0.1], force_ratio: {log: {from: 1, to: 10, points: 2}}}
run: {solver: [event_driven, {fixed_step: {time_step: 1 ms}}], skip: 2 cycles, average: 4 cycles, ensemble: none, limit: {events: 1e6, time: 1 min}}
measure: [velocity_ratio, displacement_ratio, rms_velocity]
figure: {x: {column: force_ratio, scale: log}, y: velocity_ratio, by: [mass_ratio, solver], caption: Curves.}
",
    ),
    (
        "experiments/ch4/ch4-beam.yaml",
        "title: Beam
source: {chapter: 4, section: '4'}
about: A beam.
scene:
  structure: {cantilever_beam: {length: 1 m, width: 30 mm, thickness: 5 mm, youngs_modulus: 200 GPa, density: 7800 kg/m^3, rayleigh: 5e-5, modes: 2}}
  dampers:
    - at: 1
      mass_ratio: 0.1
      particle_share: 0.5
      gap_ratio: 2
      floor: {resilient: {stiffness: 1000 N/m, damping_ratio: 0.15}}
      array: {count: 2, spacing: -4 cm}
  excitation: {harmonic: {at: 0.5, force: 1 N, frequency_ratio: 1}}
run: {skip: 2 cycles, average: 4 cycles, ensemble: none}
trace: {from: 0 cycles, to: 1 cycles, samples_per_cycle: 10}
measure: [velocity_ratio, displacement_amplitude]
",
    ),
];

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).into()
}

/// All files by name: the scenes, and one that is changed beside the assumptions that it needs.
fn originals() -> BTreeMap<String, Vec<u8>> {
    let files = ORIGINALS.iter().map(|name| ((*name).to_owned(), fs::read(root().join(name)).unwrap()));
    let scenes = SCENES.iter().map(|(name, text)| ((*name).to_owned(), text.as_bytes().to_vec()));
    files.chain(scenes).collect()
}

const NUMBERS: &[&str] = &[
    "0",
    "-1",
    "1e300",
    "1e-300",
    "1e12",
    "1e-12",
    "1e400",
    ".nan",
    "-.inf",
    "infinite",
    "0x10",
    "1_000",
    "99999999999999999999",
    "''",
];
const UNITS: &[&str] = &["m", "mm", "kg", "s", "N/m", "N s", "Hz", "GPa", "°", "m^999"];
const BOMBS: &[&str] = &[
    "[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[",
    "{a: {a: {a: {a: {a: {a: {a: {a: {a: {a: {a: {a: 1}}}}}}}}}}}}",
    "&a [*a, *a]",
    "<<: *a",
    "!!binary AAAA",
    "\u{0}",
    "\u{feff}",
    "\n---\na: 1\n",
];

/// One accident.
fn changed(bytes: &[u8], dice: &mut Dice) -> Vec<u8> {
    let mut bytes = bytes.to_vec();
    let text = String::from_utf8_lossy(&bytes).into_owned();
    let mut lines: Vec<&str> = text.split_inclusive('\n').collect();
    let at = dice.below(bytes.len());
    let (one, other) = (dice.below(lines.len()), dice.below(lines.len()));
    // Places of words and numbers: what stands between separators.
    let is_word = |c: char| c.is_alphanumeric() || ".-_^/+".contains(c);
    let words: Vec<(usize, usize)> = text
        .char_indices()
        .filter(|&(i, c)| is_word(c) && !text[..i].chars().next_back().is_some_and(is_word))
        .map(|(i, _)| (i, i + text[i..].find(|c| !is_word(c)).unwrap_or(text.len() - i)))
        .collect();
    let number = |&&(from, to): &&(usize, usize)| text[from..to].starts_with(|c: char| c.is_ascii_digit());
    let numbers: Vec<(usize, usize)> = words.iter().filter(number).copied().collect();
    let put = |(from, to): (usize, usize), new: &str| [&text[..from], new, &text[to..]].concat().into_bytes();
    match dice.below(14) {
        0 => bytes[at] ^= 1 << dice.below(8),
        1 => bytes.truncate(at),
        2 => drop(bytes.splice(at..at, [dice.below(256) as u8])),
        3 => drop(bytes.drain(at..(at + 1 + dice.below(40)).min(bytes.len()))),
        4 => drop(lines.remove(one)),
        5 => lines.insert(one, lines[other]),
        6 => lines.swap(one, other),
        7 if !numbers.is_empty() => bytes = put(*dice.of(&numbers), dice.of::<&str>(NUMBERS)),
        8 if !words.is_empty() => bytes = put(*dice.of(&words), dice.of::<&str>(UNITS)),
        9 if !words.is_empty() => {
            let (from, to) = *dice.of(&words);
            bytes = put(*dice.of(&words), &text[from..to]);
        }
        10 => drop(bytes.splice(at..at, dice.of(BOMBS).bytes())),
        11 => bytes = text.encode_utf16().flat_map(u16::to_le_bytes).collect(),
        12 => bytes = text.chars().map(|c| u8::try_from(c).unwrap_or(b'?')).collect(),
        _ => {
            let long = dice.of(&["#", " ", "\n", "- ", "["]).repeat(1 << dice.below(18));
            drop(bytes.splice(at..at, long.bytes()));
        }
    }
    // Of those that work on lines something came, of all others their bytes.
    let joined = lines.concat();
    if joined == text { bytes } else { joined.into_bytes() }
}

/// What became of a changed file.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
enum Outcome {
    Refused,
    Understood,
    Computed,
    Failed,
}

/// Reads a study with one changed file, and runs the first case of the experiment that it makes.
fn read_and_run(layout: &Layout, originals: &BTreeMap<String, Vec<u8>>, name: &str, bytes: Vec<u8>) -> Outcome {
    let mut files: BTreeMap<String, Vec<u8>> = BTreeMap::new();
    let assumptions = "experiments/assumptions.yaml";
    files.insert(assumptions.into(), originals[assumptions].clone());
    files.insert(name.into(), bytes);
    let study =
        Study::new(layout.clone(), Texts { files: files.into_iter().map(|(name, bytes)| (name, Ok(bytes))).collect() });
    for unread in &study.unread {
        let said = unread.to_string();
        let of_this_file = said.contains(name.rsplit('/').next().unwrap());
        // An entry that the change took away is missed where an assumption names it.
        let lost = name.starts_with("reference/") && said.contains("is no entry of the reference");
        assert!(of_this_file || lost, "{said}");
        assert!(!said.contains("the program made a mistake"), "{said}");
        assert!(unread.problems().is_none_or(|problems| problems.list.iter().all(|one| !one.message.is_empty())));
    }
    if !study.unread.is_empty() {
        return Outcome::Refused;
    }
    let Some(item) = study.items.first().filter(|item| item.source.experiment.optimise.is_none()) else {
        return Outcome::Understood;
    };
    let whole = &item.source.experiment;
    let settings =
        Settings { skip: whole.settings.skip.min(2), average: whole.settings.average.min(4), ..whole.settings };
    let cases = whole.cases.iter().take(1).cloned().collect();
    let experiment = Experiment { cases, refined: Vec::new(), settings, ..whole.clone() };
    let variants = [Variant { label: "baseline".into(), moved: None, assumptions: study.sheet.assumptions() }];
    let metadata = BTreeMap::new();
    let task = Task { limit: LIMIT, ..Task::new(&experiment, &variants, &metadata) };
    let finished = run(&[task], 1, &Engine, &IgnoreEvents, |_, finished| finished).unwrap().remove(0);
    for failure in finished.table.texts("failure").unwrap_or_default() {
        assert!(!failure.contains("the program made a mistake"), "{failure}");
    }
    if finished.failures.rows > 0 { Outcome::Failed } else { Outcome::Computed }
}

#[test]
fn a_changed_text_is_understood_or_refused_and_what_it_makes_of_a_scene_ends() {
    let count = setting("SHOTDAMP_MUTATIONS", 3000);
    let seed = setting("SHOTDAMP_MUTATION_SEED", 1);
    let originals = originals();
    let names: Vec<&String> = originals.keys().collect();
    let empty = tempfile::tempdir().unwrap();
    let layout = Layout::new(empty.path());
    let one = |index: u64| {
        let mut dice = Dice(seed.wrapping_mul(0x1_0000_0001).wrapping_add(index));
        // Half of them are scenes that run.
        let name = if index.is_multiple_of(2) { SCENES[dice.below(SCENES.len())].0 } else { dice.of(&names) };
        let bytes = changed(&originals[name], &mut dice);
        let begun = Instant::now();
        let outcome = catch_unwind(AssertUnwindSafe(|| read_and_run(&layout, &originals, name, bytes.clone())));
        let outcome = outcome.unwrap_or_else(|_| {
            let kept = std::env::temp_dir().join(format!("shotdamp-mutation-{index}.yaml"));
            fs::write(&kept, &bytes).unwrap();
            panic!("mutation {index} of {name}, kept as {}", kept.display())
        });
        (outcome, begun.elapsed(), index)
    };
    // On threads of their own: one that waits in a pool would work on another file meanwhile, and count its time.
    let next = AtomicU64::new(0);
    let worker = || {
        let indices = std::iter::from_fn(|| Some(next.fetch_add(1, Ordering::Relaxed)).filter(|index| *index < count));
        indices.map(one).collect::<Vec<_>>()
    };
    let outcomes: Vec<_> = std::thread::scope(|scope| {
        let workers = [(); 2].map(|()| scope.spawn(worker));
        workers.into_iter().flat_map(|worker| worker.join().unwrap()).collect()
    });
    let mut kinds = BTreeMap::<Outcome, u32>::new();
    outcomes.iter().for_each(|(outcome, ..)| *kinds.entry(*outcome).or_default() += 1);
    let longest = outcomes.iter().map(|(_, took, index)| (*took, *index)).max().unwrap();
    println!("{count} changed files: {kinds:?}; the longest took {longest:?}; {}", memory());
    assert!(longest.0 < Duration::from_secs(20), "{longest:?}");
    // Nothing was written.
    assert_eq!(fs::read_dir(empty.path()).unwrap().count(), 0);
}

/// The most memory that this process has had.
pub fn memory() -> String {
    let status = fs::read_to_string("/proc/self/status").unwrap_or_default();
    status.lines().find(|line| line.starts_with("VmHWM")).unwrap_or("memory not known").to_owned()
}

#[test]
fn a_table_with_one_byte_changed_is_no_table() {
    let desk = Desk::in_memory();
    desk.run(2, &MadeUp::default(), &IgnoreEvents);
    let bytes = desk.bytes("results/ch3-stop.parquet");
    let mut dice = Dice(setting("SHOTDAMP_MUTATION_SEED", 1));
    for _ in 0..setting("SHOTDAMP_MUTATIONS", 3000) / 3 {
        let mut damaged = bytes.clone();
        let at = dice.below(bytes.len());
        damaged[at] ^= 1 << dice.below(8);
        assert!(parquet::from_bytes(damaged, "ch3-stop").is_err(), "byte {at}");
    }
    for length in (0..bytes.len()).step_by(97) {
        assert!(parquet::from_bytes(bytes[..length].to_vec(), "ch3-stop").is_err(), "{length} bytes");
    }
}

/// As a disk loses a bit: size and time stay what they were.
fn flip(path: &Path, dice: &mut Dice) {
    let mut bytes = fs::read(path).unwrap();
    let at = dice.below(bytes.len());
    bytes[at] ^= 1 << dice.below(8);
    let modified = fs::metadata(path).unwrap().modified().unwrap();
    fs::write(path, bytes).unwrap();
    File::options().write(true).open(path).unwrap().set_times(FileTimes::new().set_modified(modified)).unwrap();
}

#[test]
fn a_flipped_bit_is_found_by_check_and_by_a_run_that_verifies() {
    let desk = Desk::in_memory();
    let short = |text: &str| text.replace("skip: 25 cycles, average: 100 cycles", "skip: 2 cycles, average: 4 cycles");
    desk.put("experiments/ch3/ch3-stop.yaml", &short(crate::desk::STOP));
    fs::remove_file(desk.layout.path("experiments/ch3/ch3-gap.yaml")).unwrap();
    fs::remove_dir_all(desk.layout.path("reference")).unwrap();
    desk.put(
        "reference/ch3/ch3-stop.yaml",
        "
entries:
  - {id: some, place: s. 3, says: Some., claim: {above: {of: velocity_ratio, level: 0}}}
",
    );
    let said = shotdamp(&desk, &["run", "--quiet"]);
    assert_eq!((said.code, said.err.as_str()), (0, ""));
    let whole = relative_files(&desk);
    let outputs: Vec<&String> = whole
        .keys()
        .filter(|name| {
            name.ends_with(".parquet")
                || name.ends_with(".png")
                || name.ends_with("ch3-stop.json")
                || name.ends_with(".md")
        })
        .collect();
    assert!(outputs.len() >= 4, "{outputs:?}");
    let mut dice = Dice(setting("SHOTDAMP_MUTATION_SEED", 1));
    for round in 0..setting("SHOTDAMP_MUTATIONS", 3000) / 100 {
        let name = *dice.of(&outputs);
        flip(&desk.layout.path(name.trim_start_matches('/')), &mut dice);
        if name.ends_with(".parquet") {
            assert_eq!(shotdamp(&desk, &["check"]).code, 2, "round {round}: {name}");
        }
        let said = shotdamp(&desk, &["run", "--verify", "--quiet"]);
        assert_eq!((said.code, said.err.as_str()), (0, ""), "round {round}: {name}");
        let now = relative_files(&desk);
        let other: Vec<&String> = whole.keys().filter(|name| now.get(*name) != whole.get(*name)).collect();
        assert!(
            other.iter().all(|name| name.contains("/times/") || name.contains("/earlier/")),
            "round {round}: {other:?}"
        );
    }
}
