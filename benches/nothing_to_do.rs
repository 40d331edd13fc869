//! Processor time of planning: the whole process with nothing to do, for one experiment or all of them, `status`, and a run
//! after one experiment has changed; beside `make -n` and `ninja -n` over as many up-to-date steps.
//!
//! `cargo bench --bench nothing_to_do` prints a table. Times are those of the child processes as the system counts them, user
//! and system, averaged over many calls: load on the machine hardly moves them.

use std::fs;
use std::process::{Command, Stdio};

use shotdamp::study::IgnoreEvents;

#[path = "../tests/it/desk.rs"]
#[expect(dead_code, reason = "a bench needs only a part of it")]
mod desk;

use desk::{Desk, GAP, GAP_REFERENCE, MadeUp};

/// The size of the study, and of one sixteen times as large.
const SIZES: [usize; 2] = [63, 1000];
/// Calls that a time is the mean of.
const CALLS: u32 = 20;

fn main() {
    if ticks().is_none() {
        println!("skipped: the processor time of child processes is read from /proc/self/stat, which is not there");
        return;
    }
    println!("| what | {} |", SIZES.map(|size| format!("{size} experiments, ms")).join(" | "));
    println!("| --- | {} |", SIZES.map(|_| "---:").join(" | "));
    let columns = SIZES.map(times);
    for (row, (name, _)) in columns[0].iter().enumerate() {
        let cells: Vec<String> = columns.iter().map(|column| cell(column[row].1)).collect();
        println!("| {name} | {} |", cells.join(" | "));
    }
}

fn cell(milliseconds: Option<f64>) -> String {
    milliseconds.map_or_else(|| "not installed".into(), |ms| format!("{ms:.1}"))
}

/// A time for each thing measured, ms; `None` without the program.
fn times(size: usize) -> Vec<(&'static str, Option<f64>)> {
    let desk = study(size);
    let shotdamp = |arguments: &[&str]| {
        let mut command = Command::new(env!("CARGO_BIN_EXE_shotdamp"));
        command.arg("--root").arg(desk.folder.path()).args(arguments);
        command
    };
    let said = |arguments: &[&str]| {
        let output = shotdamp(arguments).output().expect("the program starts");
        assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
        String::from_utf8_lossy(&output.stdout).into_owned()
    };
    assert!(said(&["run"]).starts_with(&format!("{size} experiments: 0 simulated")), "the first run publishes");
    // Files that were written a moment ago are compared by content.
    std::thread::sleep(std::time::Duration::from_secs(4));
    assert!(said(&["run"]).starts_with("Nothing to do."), "the second has nothing to do");
    let all = mean(|| shotdamp(&["run"]), || ());
    let one = mean(|| shotdamp(&["run", "ch3-gap"]), || ());
    let forced = mean(|| shotdamp(&["run", "ch3-gap", "--force"]), || ());
    let status = mean(|| shotdamp(&["status"]), || ());
    let mut mass = 1.0;
    let edit = |mass: f64| desk.put("experiments/ch3/ch3-gap.yaml", &GAP.replace("1 kg", &format!("{mass} kg")));
    edit(1.01);
    let why = mean(|| shotdamp(&["status", "--why"]), || ());
    let changed = mean(
        || shotdamp(&["run"]),
        || {
            mass += 0.01;
            edit(mass);
        },
    );
    vec![
        ("`shotdamp run`, nothing to do", Some(all)),
        ("`shotdamp run ONE`, nothing to do", Some(one)),
        ("`shotdamp run ONE --force`", Some(forced)),
        ("`shotdamp status`, nothing to do", Some(status)),
        ("`shotdamp status --why`, one changed", Some(why)),
        ("`shotdamp run`, one changed", Some(changed)),
        ("`make -n`, nothing to do", steps(size, "make", "Makefile", makefile)),
        ("`ninja -n`, nothing to do", steps(size, "ninja", "build.ninja", ninja_file)),
    ]
}

/// A study of so many experiments with made-up tables.
fn study(size: usize) -> Desk {
    let desk = Desk::in_memory();
    // Two are there already.
    for copy in 2..size {
        desk.put(&format!("experiments/ch3/ch3-gap-{copy}.yaml"), GAP);
        desk.put(&format!("reference/ch3/ch3-gap-{copy}.yaml"), GAP_REFERENCE);
    }
    desk.run(2, &MadeUp::default(), &IgnoreEvents);
    desk
}

/// Mean processor time of a command, ms; `prepare` runs before each call.
fn mean(command: impl Fn() -> Command, mut prepare: impl FnMut()) -> f64 {
    let mut sum = 0;
    for _ in 0..CALLS {
        prepare();
        let before = ticks().expect("it was there in the beginning");
        let status = command().stdout(Stdio::null()).stderr(Stdio::null()).status().expect("the program starts");
        assert!(status.code().is_some_and(|code| code < 2), "{status}");
        sum += ticks().expect("it was there in the beginning") - before;
    }
    // A tick is a hundredth of a second.
    sum as f64 * 10.0 / f64::from(CALLS)
}

/// Processor time of all child processes so far, in ticks: `cutime` and `cstime` of proc(5).
fn ticks() -> Option<u64> {
    let text = fs::read_to_string("/proc/self/stat").ok()?;
    let fields: Vec<&str> = text.rsplit_once(')')?.1.split_whitespace().collect();
    Some(fields.get(13)?.parse::<u64>().ok()? + fields.get(14)?.parse::<u64>().ok()?)
}

/// The same of another tool, over so many steps: each makes the four outputs of an experiment from its two texts.
fn steps(size: usize, program: &str, file: &str, rules: fn(usize) -> String) -> Option<f64> {
    let folder = tempfile::tempdir().expect("a folder");
    let put = |name: &str, text: &str| fs::write(folder.path().join(name), text).expect("it can be written");
    for step in 0..size {
        for name in inputs(step) {
            put(&name, GAP);
        }
    }
    for step in 0..size {
        for name in outputs(step) {
            put(&name, "made");
        }
    }
    put(file, &rules(size));
    let command = || {
        let mut command = Command::new(program);
        command.arg("-n").current_dir(folder.path());
        command
    };
    if command().stdout(Stdio::null()).stderr(Stdio::null()).status().is_err() {
        println!("`{program}` is not installed: skipped");
        return None;
    }
    if program == "ninja" {
        // It compares commands with its own log, which a first build writes.
        let built = Command::new(program).current_dir(folder.path()).output().expect("it starts");
        assert!(built.status.success(), "{}", String::from_utf8_lossy(&built.stdout));
    }
    Some(mean(command, || ()))
}

fn inputs(step: usize) -> [String; 2] {
    ["experiment", "reference"].map(|kind| format!("{kind}-{step}.yaml"))
}

fn outputs(step: usize) -> [String; 4] {
    ["parquet", "json", "png", "md"].map(|ending| format!("{step}.{ending}"))
}

fn makefile(size: usize) -> String {
    let all: Vec<String> = (0..size).flat_map(outputs).collect();
    let rule = |step: usize| format!("{} &: {}\n\ttouch $@\n", outputs(step).join(" "), inputs(step).join(" "));
    format!("all: {}\n{}", all.join(" "), (0..size).map(rule).collect::<String>())
}

fn ninja_file(size: usize) -> String {
    let rule = |step: usize| format!("build {}: make {}\n", outputs(step).join(" "), inputs(step).join(" "));
    format!("rule make\n  command = touch $out\n{}", (0..size).map(rule).collect::<String>())
}
