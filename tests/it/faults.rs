//! Whatever happens to a run (it is killed, the disk is full, a folder is not to be written to, a file is damaged, another
//! run is at work), nothing half-written counts, what was finished stays, and the same command goes on.

use std::collections::BTreeMap;
use std::fs;
use std::io::{BufRead, BufReader};
use std::os::unix::process::ExitStatusExt;
use std::process::{Child, Command, Stdio};
use std::time::{Duration, Instant};

use assert_cmd::cargo::CommandCargoExt;
use shotdamp::study::{FileHash, Held, IgnoreEvents, Lock, Snapshot};
use shotdamp::table::parquet;

use crate::cli::relative_files;
use crate::desk::{ASSUMPTIONS, Desk, GAP, MadeUp, STOP, shotdamp};
use crate::shard::OPTIMISED;

/// Real simulations, as few as will do: plain with variants, maximised, and a search with its journal.
fn study() -> Desk {
    let desk = Desk::in_memory();
    let short = |text: &str| {
        let short = text.replace("skip: 25 cycles, average: 100 cycles", "skip: 2 cycles, average: 4 cycles");
        // Drawing takes most of the time of so short a run.
        if text == GAP {
            short
        } else {
            short.lines().filter(|line| !line.starts_with("figure")).map(|line| format!("{line}\n")).collect()
        }
    };
    desk.put("experiments/ch3/ch3-stop.yaml", &short(STOP));
    desk.put("experiments/ch3/ch3-gap.yaml", &short(GAP));
    desk.put("experiments/ch6/ch6-gap.yaml", &short(OPTIMISED));
    desk
}

/// The same without numbers to hold it against, so that 0 says that all is well.
fn study_without_reference() -> Desk {
    let desk = study();
    fs::remove_dir_all(desk.layout.path("reference")).unwrap();
    desk
}

/// Two meanings of the same files, so that runs find the results of another.
const MEANINGS: [&str; 2] = ["9.81 m/s^2", "9.8 m/s^2"];

fn put_meaning(desk: &Desk, meaning: usize) {
    desk.put("experiments/assumptions.yaml", &ASSUMPTIONS.replace(MEANINGS[0], MEANINGS[meaning]));
}

fn spawn(desk: &Desk, arguments: &[&str]) -> Child {
    let mut command = Command::cargo_bin("shotdamp").unwrap();
    command.arg("--root").arg(desk.folder.path()).args(arguments);
    command.stdout(Stdio::null()).stderr(Stdio::piped()).spawn().unwrap()
}

/// A generator for delays: which ones does not matter, that they differ does.
struct Delays(u64);

impl Delays {
    /// Between 0 and 1.
    fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 11) as f64 / (1_u64 << 53) as f64
    }
}

/// All files; of the lock that it is there, as a killed run's signature may still stand in it. Which earlier tables are kept
/// depends on what was there before; each is whole, and what its name says.
fn left(desk: &Desk) -> BTreeMap<String, Vec<u8>> {
    let mut files = relative_files(desk);
    files.retain(|name, bytes| {
        let earlier = name.starts_with("/results/earlier/");
        assert!(!earlier || name.contains(&FileHash::of(bytes).blake3), "{name}");
        !earlier
    });
    files.insert("/results/.lock".into(), Vec::new());
    files
}

/// Tables that count, by id; each is whole, and the one in its record.
fn counting(desk: &Desk) -> BTreeMap<String, Vec<u8>> {
    let mut counting = BTreeMap::new();
    for (id, item) in desk.plan() {
        let Some(record) = item.record() else { continue };
        let bytes = desk.bytes(&format!("results/{id}.parquet"));
        assert_eq!(FileHash::of(&bytes), record.table);
        parquet::from_bytes(bytes.clone(), &id).unwrap();
        counting.insert(id, bytes);
    }
    counting
}

/// At least 200 kills at random moments, three of four with SIGKILL and one with SIGINT, as Ctrl-C sends it. After each,
/// every table that counts is that of an undisturbed run; after a few, the next run leaves what an undisturbed one leaves,
/// file by file and byte by byte.
#[test]
fn runs_killed_at_any_moment_resume_to_the_bytes_of_an_undisturbed_one() {
    let undisturbed = [0, 1].map(|meaning| {
        let desk = study();
        put_meaning(&desk, meaning);
        let began = Instant::now();
        assert_eq!(shotdamp(&desk, &["run", "--quiet"]).err, "");
        (left(&desk), counting(&desk), began.elapsed())
    });
    assert!(undisturbed[0].1 != undisturbed[1].1, "the two meanings differ");
    let length = undisturbed.iter().map(|(_, _, took)| *took).min().unwrap();
    let mut delays = Delays(1);
    let (mut kills, mut finished, mut rounds) = (0, 0, 0);
    let mut desk = study();
    while kills < 200 {
        let meaning = rounds % 2;
        // Every third time there is nothing to begin with.
        if rounds % 3 == 0 {
            desk = study();
        }
        put_meaning(&desk, meaning);
        let (files, tables, _) = &undisturbed[meaning];
        for _ in 0..10 {
            let mut child = spawn(&desk, &["run", "--quiet", "--jobs", "2"]);
            // Mostly early, as each run has less to do than the one before.
            std::thread::sleep(length.mul_f64(delays.next() * delays.next()));
            if delays.next() < 0.75 {
                child.kill().unwrap();
            } else {
                // It may be gone already.
                let interrupt = format!("kill -INT {} 2>&1", child.id());
                Command::new("sh").args(["-c", &interrupt]).output().unwrap();
            }
            match child.wait().unwrap().signal() {
                Some(_) => kills += 1,
                None => finished += 1,
            }
            let texts = desk.texts();
            let ended = Snapshot::current(&desk.layout, &texts).is_complete(&texts);
            for (id, bytes) in counting(&desk) {
                assert!(bytes == tables[&id], "{id} counts and is not what it should be");
            }
            if ended {
                break;
            }
        }
        assert_eq!(shotdamp(&desk, &["run", "--quiet"]).err, "");
        let now = left(&desk);
        let more_or_less: Vec<&String> = now
            .keys()
            .filter(|name| !files.contains_key(*name))
            .chain(files.keys().filter(|name| !now.contains_key(*name)))
            .collect();
        assert!(more_or_less.is_empty(), "round {rounds}, no file more, none less: {more_or_less:?}");
        let other: Vec<&String> = now.keys().filter(|name| now[*name] != files[*name]).collect();
        assert!(other.is_empty(), "round {rounds}: {other:?}");
        rounds += 1;
    }
    println!("{kills} kills in {rounds} rounds, {finished} runs were done before; an undisturbed run took {length:?}");
}

/// As of a run that was killed after it had written the table, and before it could tidy up.
#[test]
fn the_journal_beside_a_complete_table_goes_with_the_next_run() {
    let desk = study();
    shotdamp(&desk, &["run", "--quiet"]);
    let whole = relative_files(&desk);
    desk.put("results/ch6-gap.journal", "points that the table already has");
    fs::remove_file(desk.layout.path("results/snapshot.bin")).unwrap();
    assert_eq!(shotdamp(&desk, &["run", "--quiet"]).err, "");
    assert!(relative_files(&desk) == whole);
}

/// A shell that lets no file grow beyond so many blocks stands in for the full disk: writing fails in the middle of a file.
#[test]
fn a_full_disk_leaves_no_half_of_a_file_and_the_same_command_goes_on() {
    let undisturbed = study();
    shotdamp(&undisturbed, &["run", "--quiet"]);
    let whole = relative_files(&undisturbed);
    for blocks in [0, 4, 24] {
        let desk = study();
        let binary = assert_cmd::cargo::cargo_bin("shotdamp");
        let script = format!("trap '' XFSZ; ulimit -f {blocks}; exec \"$0\" --root \"$1\" run");
        let full = Command::new("sh").args(["-c", &script]).arg(&binary).arg(desk.folder.path()).output().unwrap();
        let said = String::from_utf8(full.stderr).unwrap();
        assert_eq!(full.status.code(), Some(2), "{said}");
        assert!(said.contains("error: ") && said.contains("cannot write") && said.contains("too large"), "{said}");
        for (name, bytes) in relative_files(&desk) {
            // A record may stop before the figures, and is whole nevertheless.
            let record = name.ends_with(".json");
            assert!(!record || serde_json::from_slice::<serde_json::Value>(&bytes).is_ok(), "{name}");
            let unfinished = record || name.ends_with(".journal");
            assert!(unfinished || whole.get(&name) == Some(&bytes), "{name} with {blocks} blocks");
        }
        counting(&desk);
        assert_eq!(shotdamp(&desk, &["run", "--quiet"]).err, "");
        assert!(relative_files(&desk) == whole, "{blocks} blocks");
    }
}

#[test]
fn a_place_that_cannot_be_written_to_is_named_and_the_rest_is_kept() {
    let desk = study_without_reference();
    let refuse = |name: &str, is: &str, why: &str| {
        let said = shotdamp(&desk, &["run", "--quiet"]);
        assert_eq!(said.code, 2, "{name}");
        assert!(said.err.contains(is) && said.err.contains(name) && said.err.contains(why), "{}", said.err);
    };
    desk.put("results", "a file in the place of the folder");
    refuse("results/.lock", "cannot lock", "results` is not a folder: move it away");
    fs::remove_file(desk.layout.path("results")).unwrap();
    std::os::unix::fs::symlink("nowhere", desk.layout.path("results")).unwrap();
    refuse("results/.lock", "cannot lock", "results` is not a folder: move it away");
    fs::remove_file(desk.layout.path("results")).unwrap();

    fs::create_dir_all(desk.layout.path("results/ch3-gap.parquet/in-the-way")).unwrap();
    refuse("results/ch3-gap.parquet", "ch3-gap: cannot write", "directory");
    assert_eq!(counting(&desk).keys().collect::<Vec<_>>(), ["ch3-stop", "ch6-gap"], "the others are done");
    fs::remove_dir_all(desk.layout.path("results/ch3-gap.parquet")).unwrap();

    fs::remove_dir_all(desk.layout.path("reports")).unwrap();
    desk.put("reports", "a file in the place of the folder");
    refuse("reports", "cannot use", "reports` is not a folder: move it away");
    assert!(!counting(&desk).contains_key("ch3-gap"), "it is said before the work");
    fs::remove_file(desk.layout.path("reports")).unwrap();
    let said = shotdamp(&desk, &["run"]);
    assert!(said.out.contains("1 simulated"), "tables are kept: {}", said.out);
    assert_eq!(said.code, 0, "{}", said.err);
}

/// Told of itself, since who may do everything has no folder that refuses.
#[test]
fn a_missing_permission_is_told_with_what_to_do() {
    for (kind, told) in [
        (std::io::ErrorKind::PermissionDenied, "permission denied; change its permissions (chmod), or work in a"),
        (std::io::ErrorKind::ReadOnlyFilesystem, "its file system is read-only; work in a copy of the study elsewhere"),
    ] {
        let error = shotdamp::atomic::FileError { action: "lock", path: "results/.lock".into(), source: kind.into() };
        assert!(error.to_string().starts_with(&format!("cannot lock results/.lock: {told}")), "{error}");
    }
}

/// Cut, flipped, edited and saved by another program, exchanged for another table: noticed also by a run that has nothing
/// to do, and told by `check`.
#[test]
fn a_damaged_table_is_never_taken_for_a_result() {
    let desk = Desk::new();
    desk.run(2, &MadeUp::default(), &IgnoreEvents);
    shotdamp(&desk, &["run", "--quiet"]);
    let whole = relative_files(&desk);
    assert!(shotdamp(&desk, &[]).out.starts_with("Nothing to do"));
    let path = desk.layout.path("results/ch3-stop.parquet");
    let bytes = fs::read(&path).unwrap();
    let mut flipped = bytes.clone();
    flipped[bytes.len() / 2] ^= 1;
    let mut edited = desk.table("ch3-stop");
    edited.metadata.insert("title".into(), "edited".into());
    let other = desk.bytes("results/ch3-gap.parquet");
    for damage in [bytes[..bytes.len() / 3].to_vec(), flipped, parquet::to_bytes(&edited).unwrap(), other, Vec::new()] {
        fs::write(&path, damage).unwrap();
        let check = shotdamp(&desk, &["check", "ch3-stop"]);
        assert_eq!(check.code, 2, "{}", check.out);
        // The numbers of the real engine are others than the made-up ones; what counts is that they are made.
        let status = shotdamp(&desk, &["status", "--why", "ch3-stop"]).out;
        assert!(status.contains("results/ch3-stop.parquet is not what was written"), "{status}");
        assert!(!shotdamp(&desk, &["run", "--dry-run"]).out.starts_with("Nothing to do"));
        fs::write(&path, &bytes).unwrap();
    }
    // Written again in the meantime, with the same bytes: looked at once, and then there is nothing to do again.
    assert!(shotdamp(&desk, &[]).out.starts_with("2 experiments: 0 simulated; 0 figures"));
    assert!(shotdamp(&desk, &[]).out.starts_with("Nothing to do"));
    assert!(relative_files(&desk) == whole);
}

#[test]
fn the_second_run_says_who_holds_the_lock_and_waits_or_gives_up() {
    let desk = study_without_reference();
    let lock = Lock::of_study(&desk.layout, |_| Held::GiveUp).unwrap();
    let holder = format!("process {}", std::process::id());
    for command in ["run", "gather"] {
        let said = shotdamp(&desk, &[command, "--no-wait"]);
        assert_eq!(said.code, 2);
        assert!(said.err.starts_with(&format!("error: another run is working here: {holder}")), "{}", said.err);
    }
    let mut waiting = spawn(&desk, &["run", "--quiet"]);
    let mut said = String::new();
    BufReader::new(waiting.stderr.take().unwrap()).read_line(&mut said).unwrap();
    assert!(said.starts_with(&format!("waiting for another run: {holder}")), "{said}");
    std::thread::sleep(Duration::from_millis(50));
    assert!(waiting.try_wait().unwrap().is_none(), "it waits");
    // A shard writes elsewhere and need not wait.
    assert_eq!(shotdamp(&desk, &["run", "--shard", "1/2", "--no-wait"]).code, 0);
    drop(lock);
    assert_eq!(waiting.wait().unwrap().code(), Some(0));
    // A lock whose holder was killed holds nobody up, though its file is there.
    assert!(desk.layout.path("results/.lock").is_file());
    assert_eq!(shotdamp(&desk, &["run", "--quiet", "--no-wait"]).code, 0);
}
