//! What a person sees of a row that would not end, and of one that says nothing.

use std::fs;
use std::os::unix::process::ExitStatusExt;
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

use crate::desk::{Desk, command, shotdamp};

/// Three rows that end in a moment.
const LONG: &str = "
title: Long
source: {chapter: 3, section: '3'}
about: Three gaps.
scene:
  structure: {single_mass: {mass: 1 kg, stiffness: 1000 N/m, damping_ratio: 0.05}}
  dampers: [{mass_ratio: 0.05, gap_ratio: swept, floor: {rigid: {restitution: 0.5}}}]
  excitation: {harmonic: {force_ratio: 5, frequency_ratio: 1}}
sweep: {gap_ratio: [10, 50, 90]}
run: {skip: 2 cycles, average: 8 cycles, ensemble: none, sensitivity: none}
measure: [rms_velocity]
";

fn study(text: &str) -> Desk {
    let desk = Desk::in_memory();
    for name in ["experiments/ch3/ch3-stop.yaml", "experiments/ch3/ch3-gap.yaml"] {
        fs::remove_file(desk.layout.path(name)).unwrap();
    }
    fs::remove_dir_all(desk.layout.path("reference")).unwrap();
    desk.put("experiments/ch3/ch3-long.yaml", text);
    desk
}

/// One row, of ten million cycles.
fn endless() -> String {
    let swept = LONG.replace("average: 8 cycles", "average: 10000000 cycles");
    swept.replace("[10, 50, 90]", "[50]")
}

#[test]
fn a_row_at_its_limit_fails_with_the_reason_and_a_higher_limit_resumes_there() {
    let desk = study(LONG);
    let said = shotdamp(&desk, &["run", "--row-limit", "20 events"]);
    assert_eq!(said.code, 2);
    assert!(
        said.err.contains("stopped at the limit of 20 events in cycle ") && said.err.contains("events a cycle"),
        "{}",
        said.err
    );
    assert!(said.err.contains("--row-limit"), "{}", said.err);
    let table = desk.table("ch3-long");
    let failed = table.texts("failure").unwrap().iter().filter(|reason| !reason.is_empty()).count();
    assert!((1..=3).contains(&failed), "{failed}");
    // The same words on any number of threads.
    let again = shotdamp(&desk, &["run", "--force", "--jobs", "1", "--row-limit", "20 events"]);
    let errors = |text: &str| text.lines().filter(|line| line.starts_with("error")).collect::<Vec<_>>().join("\n");
    assert_eq!(errors(&again.err), errors(&said.err));
    assert_eq!(shotdamp(&desk, &["run"]).code, 0);
    let whole = desk.bytes("results/ch3-long.parquet");
    // A limit that is not reached leaves no trace.
    desk.put(
        "experiments/ch3/ch3-long.yaml",
        &LONG.replace("ensemble: none", "ensemble: none, limit: {events: 1e6, time: 2 h}"),
    );
    assert!(shotdamp(&desk, &["run", "--dry-run"]).out.contains("0 of 1 experiment would be simulated"));
    assert_eq!(shotdamp(&desk, &["run", "--force"]).code, 0);
    assert!(desk.bytes("results/ch3-long.parquet") == whole);
    assert_eq!(shotdamp(&desk, &["run", "--row-limit", "for ever"]).code, 2);
}

#[test]
fn the_limit_of_time_ends_a_row_and_an_interrupt_ends_the_program() {
    let desk = study(&endless());
    let begun = Instant::now();
    let said = shotdamp(&desk, &["run", "--row-limit", "200 ms"]);
    assert_eq!(said.code, 2);
    assert!(said.err.contains("stopped at the limit of 0.2 s of processor time in cycle "), "{}", said.err);
    assert!(begun.elapsed() < Duration::from_secs(20));
    let mut running = command(&desk, &["run"]);
    let mut child = running.stdout(Stdio::null()).stderr(Stdio::null()).spawn().unwrap();
    std::thread::sleep(Duration::from_millis(700));
    assert!(child.try_wait().unwrap().is_none(), "it runs");
    let begun = Instant::now();
    Command::new("sh").args(["-c", &format!("kill -INT {}", child.id())]).status().unwrap();
    assert_eq!(child.wait().unwrap().signal(), Some(2));
    assert!(begun.elapsed() < Duration::from_secs(1));
}

#[test]
fn what_will_take_long_or_say_nothing_is_told_beforehand() {
    let fixed =
        LONG.replace("run: {", "run: {solver: {fixed_step: {time_step: 1 ns}}, ").replace("average: 8", "average: 100");
    for (text, warning) in [
        (fixed.as_str(), "fixed steps take about"),
        (&LONG.replace("restitution: 0.5", "restitution: 1"), "may bounce without end"),
        (
            &LONG.replace("force_ratio: 5", "force_ratio: 0").replace("[rms", "[velocity_ratio, rms"),
            "the excitation is zero",
        ),
    ] {
        let desk = study(text);
        for arguments in [&["show", "ch3-long"][..], &["run", "--dry-run"]] {
            let begun = Instant::now();
            let said = shotdamp(&desk, arguments);
            assert!(said.out.contains("warning: ") && said.out.contains(warning), "{}\n{}", said.out, said.err);
            assert!(begun.elapsed() < Duration::from_secs(20));
        }
    }
}

#[test]
fn a_ratio_of_nothing_to_nothing_is_undefined_everywhere() {
    let text = LONG.replace("force_ratio: 5", "force_ratio: 0").replace("[rms", "[velocity_ratio, rms");
    let figure = "figure: {x: gap_ratio, y: velocity_ratio, caption: Nothing.}\n";
    let desk = study(&(text + figure));
    let said = shotdamp(&desk, &["run"]);
    let why = "velocity_ratio undefined: neither run moves";
    assert!(said.err.contains(why), "the figure says why it is not there: {}", said.err);
    assert!(said.out.contains(&format!("ch3-long: 3 rows have undefined numbers; the first: {why}")), "{}", said.out);
    assert_eq!(desk.table("ch3-long").texts("undefined").unwrap(), [why, why, why]);
    assert!(
        String::from_utf8(desk.bytes("reports/ch3/ch3-long.md"))
            .unwrap()
            .contains(&format!("3 rows: {why}").replace('_', "\\_"))
            || String::from_utf8(desk.bytes("reports/ch3/ch3-long.md")).unwrap().contains(why)
    );
}

#[test]
fn numbers_without_balance_count_for_no_entry() {
    // A damping far beyond critical leaves few digits of the energy.
    let text = LONG
        .replace("{rigid: {restitution: 0.5}}", "{resilient: {stiffness_ratio: 1, damping_ratio: 0.15}}")
        .replace("damping_ratio: 0.05}}", "damping_ratio: 1e4}}")
        .replace("harmonic", "impulse_train");
    let desk = study(&text);
    desk.put(
        "reference/ch3/ch3-long.yaml",
        "
entries:
  - {id: some, place: s. 3, says: It moves., claim: {above: {of: rms_velocity, level: 0}}}
",
    );
    let said = shotdamp(&desk, &["run", "--row-limit", "1 min"]);
    assert!(said.out.contains("not balance and count for no entry"), "{}\n{}", said.out, said.err);
    let check = shotdamp(&desk, &["check"]);
    assert_eq!(check.code, 2, "{}", check.out);
    assert!(check.out.contains("do not close"), "{}", check.out);
}
