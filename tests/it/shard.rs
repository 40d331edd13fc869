//! A study in n parts: the joined results are those of a single run, byte for byte, or there are none.

use std::fs;
use std::path::Path;

use shotdamp::study::{Shard, ShardError};
use shotdamp::table::{Data, parquet};

use crate::cli::files;
use crate::desk::{Desk, GAP, STOP, shotdamp};

/// Points are added where the curve bends: rows that depend on each other.
const RESPONSE: &str = "
title: Frequency response
source: {chapter: 4, section: '4.3.1'}
about: A curve.
scene:
  structure: {single_mass: {mass: 1 kg, stiffness: 1000 N/m, damping_ratio: 0.05}}
  dampers: [{mass_ratio: 0.05, gap_ratio: 50, floor: {rigid: {restitution: 0}}}]
  excitation: {harmonic: {base_amplitude_ratio: 1, frequency_ratio: swept}}
sweep: {frequency_ratio: {refined: {from: 0.5, to: 2, start: 8 points, tolerance: 5 %}}}
run: {solver: event_driven, skip: 5 cycles, average: 10 cycles}
measure: [rms_velocity]
figure: {x: frequency_ratio, y: rms_velocity, caption: A curve.}
";

pub const OPTIMISED: &str = "
title: Gap of one damper
source: {chapter: 6, section: '6.3.1'}
about: A search.
scene:
  structure: {single_mass: {mass: 1 kg, stiffness: 1000 N/m, damping_ratio: 0.05}}
  dampers: [{mass_ratio: 0.05, gap: optimised, floor: {rigid: {restitution: 0}}}]
  excitation: {harmonic: {base_amplitude_ratio: 1, frequency_ratio: 1}}
optimise:
  minimise: rms_velocity
  gaps: {from: 0 mm, to: 100 mm}
  candidates: {uniform: 50 mm}
  dense: {points: 3, refine: 1}
run: {skip: 5 cycles, average: 10 cycles}
measure: [rms_velocity]
figures: [{x: evaluation, y: best_so_far, by: candidate, caption: Convergence.}]
";

/// One of each kind: plain with variants and two solvers, maximised, with time histories, refined, optimised.
fn study() -> Desk {
    let desk = Desk::new();
    let traced = STOP.replace("measure:", "trace: {from: 100 cycles, to: 101 cycles, samples_per_cycle: 20}\nmeasure:");
    desk.put("experiments/ch3/ch3-traced.yaml", &traced);
    // Some rows have undefined numbers, and a shard without such rows no column of the reasons.
    desk.put("experiments/ch3/ch3-still.yaml", &STOP.replace("[1, 2, 4]", "[4, 2, 1, 0]"));
    desk.put("experiments/ch4/ch4-response.yaml", RESPONSE);
    desk.put("experiments/ch6/ch6-gap.yaml", OPTIMISED);
    desk
}

/// Every file of a study but those of the shards.
fn joined(desk: &Desk) -> Vec<(String, Vec<u8>)> {
    let root = desk.folder.path().display().to_string();
    let all = files(desk.folder.path()).into_iter().map(|(name, bytes)| (name.replace(&root, ""), bytes));
    all.filter(|(name, _)| !name.contains("/shards/")).collect()
}

fn run_shard(desk: &Desk, shard: &str) {
    let said = shotdamp(desk, &["run", "--quiet", "--shard", shard]);
    assert_eq!((said.code, said.out.as_str(), said.err.as_str()), (0, "", ""));
}

#[test]
fn shards_of_any_number_join_to_the_bytes_of_a_single_run() {
    let local = study();
    let alone = shotdamp(&local, &["run"]);
    for of in [1, 3, 64] {
        let desk = study();
        let mut shards: Vec<Shard> = Shard::all(of).collect();
        shards.reverse();
        shards.iter().for_each(|shard| run_shard(&desk, &shard.to_string()));
        let gathered = shotdamp(&desk, &["gather"]);
        assert_eq!((gathered.code, gathered.err.as_str()), (alone.code, ""), "{}", gathered.out);
        let said = gathered.out.replace("gathered", "simulated");
        let folder = |desk: &Desk| desk.folder.path().display().to_string();
        assert_eq!(said.replace(&folder(&desk), &folder(&local)), alone.out);
        assert!(joined(&desk) == joined(&local), "{of} shards");
    }
}

#[test]
fn every_shard_of_a_divided_experiment_has_about_as_much_to_do() {
    let desk = study();
    for shard in Shard::all(3) {
        run_shard(&desk, &shard.to_string());
    }
    let rows = |shard: usize| {
        let table = parquet::read(&desk.layout.path(&format!("results/shards/{shard}-of-3/ch3-stop.parquet"))).unwrap();
        let slow = table.rows_where("solver", "fixed_step_1e-4s").len();
        let Data::Int(places) = table.columns[0].data.clone() else { panic!("places") };
        assert!(places.is_sorted() && table.columns[0].name == "row");
        (places.len(), slow)
    };
    // 6 cases under 2 solvers, and 6 cases under 3 ends of the assumptions, of which 3 share the numbers of others.
    let rows = [rows(1), rows(2), rows(3)];
    assert_eq!(rows.iter().map(|(all, _)| all).sum::<usize>(), 30);
    assert_eq!(rows.map(|(_, slow)| slow), [2, 2, 2], "the fixed step is slow, and dealt out evenly");
}

#[test]
fn what_is_missing_comes_twice_or_is_damaged_is_told_with_what_to_do() {
    let desk = study();
    assert!(shotdamp(&desk, &["gather"]).err.contains("there are no tables of shards"));
    run_shard(&desk, "1/3");
    run_shard(&desk, "3/3");
    let part = |shard: &str| desk.layout.path(&format!("results/shards/{shard}/ch3-stop.parquet"));
    let gather = || {
        let said = shotdamp(&desk, &["gather", "ch3-stop"]);
        assert_eq!(said.code, 2);
        assert!(!desk.layout.path("results/ch3-stop.parquet").exists(), "nothing in part passes for a result");
        said.err.lines().next().unwrap_or_default().to_owned()
    };
    let said = gather();
    assert!(said.contains("rows are missing") && said.ends_with("first do `shotdamp run --shard 2/3`"), "{said}");
    run_shard(&desk, "2/3");

    let whole = fs::read(part("2-of-3")).unwrap();
    fs::write(part("2-of-3"), &whole[..whole.len() / 2]).unwrap();
    let said = gather();
    assert!(
        said.contains("results/shards/2-of-3/ch3-stop.parquet") && said.contains("`shotdamp run --shard 2/3`"),
        "{said}"
    );
    fs::copy(part("1-of-3"), part("2-of-3")).unwrap();
    assert!(gather().contains("it is the table of shard 1/3"));
    // A table that claims rows of another: made by hand, seal and all.
    let mut twice = parquet::from_bytes(whole.clone(), "whole").unwrap();
    let first = parquet::read(&part("1-of-3")).unwrap();
    twice.columns[0].data = match (&twice.columns[0].data, &first.columns[0].data) {
        (Data::Int(own), Data::Int(others)) => Data::Int([&others[..1], &own[1..]].concat()),
        _ => panic!("places"),
    };
    parquet::write(&twice, &part("2-of-3")).unwrap();
    let said = gather();
    assert!(said.contains("comes from shard 1/3 and again from 2/3"), "{said}");
    // The shard itself cannot know; what it finds damaged it makes again.
    fs::write(part("2-of-3"), &whole[1..]).unwrap();
    run_shard(&desk, "2/3");
    assert!(fs::read(part("2-of-3")).unwrap() == whole);

    desk.put("experiments/ch3/ch3-stop.yaml", &STOP.replace("mass: 1 kg", "mass: 2 kg"));
    assert!(gather().contains("computed from other inputs than the current ones"));
    run_shard(&desk, "1/2");
    assert!(gather().contains("tables of 2 and of 3 shards; say which with --of"));
    run_shard(&desk, "2/2");
    let said = shotdamp(&desk, &["gather", "--of", "2", "ch3-stop"]);
    assert!(desk.layout.path("results/ch3-stop.parquet").is_file(), "{}", said.err);
    assert_eq!(shotdamp(&desk, &["status", "ch3-stop"]).out, "1 experiment, all up to date\n");
}

#[test]
fn a_shard_does_what_is_left_of_its_part() {
    let desk = study();
    run_shard(&desk, "1/2");
    let stamp = |path: &Path| fs::metadata(path).unwrap().modified().unwrap();
    let path = desk.layout.path("results/shards/1-of-2/ch3-stop.parquet");
    let (before, bytes) = (stamp(&path), fs::read(&path).unwrap());
    desk.put("experiments/ch3/ch3-gap.yaml", &GAP.replace("mass: 1 kg", "mass: 2 kg"));
    let said = shotdamp(&desk, &["run", "--shard", "1/2"]);
    assert!(said.out.contains("; 1 simulated."), "{}", said.out);
    assert_eq!(stamp(&path), before);
    shotdamp(&desk, &["run", "--shard", "1/2", "--force", "--jobs", "1"]);
    assert!(stamp(&path) != before && fs::read(&path).unwrap() == bytes);
}

#[test]
fn a_shard_is_one_of_those_there_are() {
    for wrong in ["0/3", "4/3", "3", "/", "1/0", "-1/3", "1/3/5", ""] {
        assert_eq!(wrong.parse::<Shard>(), Err(ShardError), "{wrong}");
    }
    assert_eq!("3/3".parse::<Shard>().unwrap().to_string(), "3/3");
    assert_eq!(Shard::all(3).map(|shard| shard.to_string()).collect::<Vec<_>>(), ["1/3", "2/3", "3/3"]);
}
