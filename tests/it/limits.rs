//! What a person sees of a row that would not end, and of one that says nothing.

use std::io::Read;
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

use crate::desk::{Desk, THREE_GAPS, command, shotdamp};

fn study(text: &str) -> Desk {
    Desk::of_one("experiments/ch3/ch3-long.yaml", text)
}

/// One row, of ten million cycles.
fn endless() -> String {
    let swept = THREE_GAPS.replace("average: 8 cycles", "average: 10000000 cycles");
    swept.replace("[10, 50, 90]", "[50]")
}

#[test]
fn a_row_at_its_limit_fails_with_the_reason_and_a_higher_limit_resumes_there() {
    let desk = study(THREE_GAPS);
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
        &THREE_GAPS.replace("ensemble: none", "ensemble: none, limit: {events: 1e6, time: 2 h}"),
    );
    assert!(shotdamp(&desk, &["run", "--dry-run"]).out.contains("0 of 1 experiment would be simulated"));
    assert_eq!(shotdamp(&desk, &["run", "--force"]).code, 0);
    assert!(desk.bytes("results/ch3-long.parquet") == whole);
    assert_eq!(shotdamp(&desk, &["run", "--row-limit", "for ever"]).code, 2);
}

/// A particle that a slow drive does not lift off an elastic floor; with gaps. A kick of a billionth sets it hopping, and it loses nothing at
/// any impact.
fn pressed(gaps: &str) -> String {
    let slow = THREE_GAPS.replace("1000 N/m", "0.1 N/m").replace("force_ratio: 5", "force_ratio: 0.08");
    let elastic = slow.replace("restitution: 0.5", "restitution: 1").replace("[10, 50, 90]", gaps);
    elastic + "trace: {from: 0 cycles, to: 2 cycles, samples_per_cycle: 20}\n"
}

#[test]
fn a_row_keeps_its_numbers_where_a_slightly_perturbed_start_has_no_end() {
    let desk = study(&pressed("[10]").replace("ensemble: none, ", ""));
    desk.put(
        "reference/ch3/ch3-long.yaml",
        "
entries:
  - {id: speed, place: s. 3, says: It is slow., value: 175 mm/s, from: {cell: {of: rms_velocity}}}
",
    );
    let said = shotdamp(&desk, &["run"]);
    let table = desk.table("ch3-long");
    assert_eq!(table.texts("failure").unwrap(), [""], "{}", said.err);
    let why = "sensitivity to initial conditions unknown: the run from a slightly perturbed start was stopped after ";
    let unknown = &table.texts("unknown").unwrap()[0];
    assert!(
        unknown.starts_with(why) && unknown.ends_with(" events in cycle 0 of 10; this one has 0 in all"),
        "{unknown}"
    );
    // The numbers are those of the run itself, as certain as a run in other search windows finds them; the spread is not known.
    let cell = |column: &str| table.floats(column).unwrap()[0];
    assert!(cell("rms_velocity") > 0.0 && cell("rms_velocity_num") < 1e-9 * cell("rms_velocity"), "{}", said.out);
    assert!(cell("rms_velocity_spread").is_nan() && [cell("chaotic"), cell("members")] == [0.0, 1.0]);
    // A person reads the reason after the run, on the page, and at the entry that the number is for.
    assert!(said.out.contains(&format!("ch3-long: 1 row has something unknown; the first: {why}")), "{}", said.out);
    let page = String::from_utf8(desk.bytes("reports/ch3/ch3-long.md")).unwrap();
    assert!(page.contains(&format!("**Unknown**\n\n- 1 row: {why}")), "{page}");
    let entry = format!("the error of `rms_velocity` is not known in row 1: {why}");
    assert!(shotdamp(&desk, &["check"]).out.contains(&entry), "{}", shotdamp(&desk, &["check"]).out);
    // It is a result like any other, and read again to the same bits.
    assert!(shotdamp(&desk, &["run"]).out.starts_with("Nothing to do"));
    let bytes = desk.bytes("results/ch3-long.parquet");
    assert_eq!(shotdamp(&desk, &["run", "--force"]).code, said.code);
    assert!(desk.bytes("results/ch3-long.parquet") == bytes);
    // Where the limit of the row comes first, it is an error: with a higher one the row is tried again.
    let limited = shotdamp(&desk, &["run", "--force", "--row-limit", "1000 events"]);
    assert!(limited.code == 2 && limited.err.contains("stopped at the limit of 1000 events"), "{}", limited.err);
}

/// Such rows are interrupted while their perturbed starts hop, as nearly always.
#[test]
fn an_interrupt_of_a_perturbed_start_is_an_interrupt() {
    let desk = study(&pressed("{log: {from: 1, to: 100, points: 1000}}"));
    let (code, said, took) = interrupted(&desk, &["run"], A_MOMENT);
    assert_eq!(code, Some(130), "{said}");
    assert!(!said.contains("failed") && took < Duration::from_secs(1), "{took:?}: {said}");
    let ahead = shotdamp(&desk, &["run", "--dry-run"]).out;
    assert!(!ahead.contains("0 of 1 experiment"), "{ahead}");
}

#[test]
fn a_limit_that_was_set_too_low_costs_no_result_that_was_there() {
    let desk = study(THREE_GAPS);
    assert_eq!(shotdamp(&desk, &["run"]).code, 0);
    let whole = desk.bytes("results/ch3-long.parquet");
    assert_eq!(shotdamp(&desk, &["run", "--force", "--row-limit", "5 events"]).code, 2);
    assert!(desk.bytes("results/ch3-long.parquet") != whole);
    // Within one event no row can be simulated: all of them come from the table that was put aside.
    assert_eq!(shotdamp(&desk, &["run", "--row-limit", "1 events"]).code, 0);
    assert!(desk.bytes("results/ch3-long.parquet") == whole);
    let said = shotdamp(&desk, &["run", "--force", "--row-limit", "5"]);
    assert!(said.code == 2 && said.err.contains("write for example `1e8 events`"), "{}", said.err);
    assert!(desk.bytes("results/ch3-long.parquet") == whole);
}

#[test]
fn the_limit_of_time_ends_a_row() {
    let desk = study(&endless());
    let begun = Instant::now();
    let said = shotdamp(&desk, &["run", "--row-limit", "200 ms"]);
    assert_eq!(said.code, 2);
    assert!(said.err.contains("stopped at the limit of 0.2 s of processor time in cycle "), "{}", said.err);
    assert!(begun.elapsed() < Duration::from_secs(20));
}

/// What came of a command that was interrupted while it was at work: its exit code, what it said, and how long it took to.
fn interrupted(desk: &Desk, arguments: &[&str], after: Duration) -> (Option<i32>, String, Duration) {
    ended_by("INT", command(desk, arguments), arguments, after)
}

fn ended_by(
    signal: &str,
    mut running: Command,
    arguments: &[&str],
    after: Duration,
) -> (Option<i32>, String, Duration) {
    let mut child = running.stdout(Stdio::null()).stderr(Stdio::piped()).spawn().unwrap();
    std::thread::sleep(after);
    assert!(child.try_wait().unwrap().is_none(), "{arguments:?} is at work");
    let begun = Instant::now();
    Command::new("sh").args(["-c", &format!("kill -{signal} {}", child.id())]).status().unwrap();
    let mut said = String::new();
    child.stderr.take().unwrap().read_to_string(&mut said).unwrap();
    let code = child.wait().unwrap().code();
    (code, said, begun.elapsed())
}

const A_MOMENT: Duration = Duration::from_millis(1500);

/// Two rows: the first is over in a moment, the second never.
fn half_endless() -> String {
    let rest =
        endless().replace("gap_ratio: swept", "gap_ratio: 50").replace("gap_ratio: [50]", "force_ratio: [1e-3, 5]");
    rest.replace("force_ratio: 5,", "force_ratio: swept,")
}

#[test]
fn an_interrupted_run_keeps_the_rows_it_has() {
    let desk = study(&half_endless());
    let (code, said, took) = interrupted(&desk, &["run"], A_MOMENT);
    assert_eq!(code, Some(130), "{said}");
    assert!(said.lines().last().unwrap().starts_with("interrupted: finished rows are kept"), "{said}");
    assert!(took < Duration::from_secs(1), "{took:?}");
    // No table is in force, and the next run has one row to do.
    assert!(!desk.layout.path("results/ch3-long.parquet").exists());
    let ahead = shotdamp(&desk, &["run", "--dry-run"]).out;
    assert!(ahead.contains("1 of 2 rows to simulate") && !ahead.contains("time not known"), "{ahead}");
    let checked = shotdamp(&desk, &["check"]).out;
    assert!(checked.contains("ch3-long (unfinished)"), "{checked}");
}

#[test]
fn an_experiment_of_which_other_tables_were_kept_is_not_begun() {
    let desk = study(THREE_GAPS);
    assert_eq!(shotdamp(&desk, &["run"]).code, 0);
    desk.put("experiments/ch3/ch3-long.yaml", &THREE_GAPS.replace("mass_ratio: 0.05", "mass_ratio: 0.06"));
    assert_eq!(shotdamp(&desk, &["run"]).code, 0);
    // With the table in force goes all that there is of this plan.
    std::fs::remove_file(desk.layout.path("results/ch3-long.parquet")).unwrap();
    let checked = shotdamp(&desk, &["check"]).out;
    assert!(checked.contains("ch3-long (not run)"), "{checked}");
}

#[test]
fn an_interrupted_run_keeps_its_rows_however_long_they_take_to_write() {
    let many = "gap_ratio: {log: {from: 1, to: 100, points: 60000}}";
    let desk = study(&THREE_GAPS.replace("gap_ratio: [10, 50, 90]", many));
    let (code, said, _) = interrupted(&desk, &["run"], 6 * A_MOMENT);
    assert_eq!(code, Some(130), "{said}");
    assert!(said.contains(" rows done, kept; the next run goes on there"), "{said}");
    let ahead = shotdamp(&desk, &["run", "--dry-run"]).out;
    let (open, of_all) =
        ahead.split_once(" rows to simulate").and_then(|(before, _)| before.rsplit_once(" of ")).unwrap();
    assert!(!open.ends_with(of_all), "{ahead}");
}

/// Not under `nohup`, which children inherit.
fn hears_hangups() -> bool {
    let status = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
    let ignored = status.lines().find_map(|line| u64::from_str_radix(line.strip_prefix("SigIgn:")?.trim(), 16).ok());
    ignored.is_none_or(|ignored| ignored & 1 == 0)
}

#[test]
fn a_scheduler_that_ends_a_run_and_a_terminal_that_closes_are_heard_as_ctrl_c_is() {
    for signal in ["TERM", "HUP"].into_iter().filter(|signal| *signal != "HUP" || hears_hangups()) {
        let desk = study(&half_endless());
        let (code, said, took) = ended_by(signal, command(&desk, &["run"]), &["run"], A_MOMENT);
        assert_eq!(code, Some(130), "{signal}: {said}");
        assert!(said.lines().last().unwrap().starts_with("interrupted: finished rows are kept"), "{signal}: {said}");
        assert!(took < Duration::from_secs(1), "{signal}: {took:?}");
        let ahead = shotdamp(&desk, &["run", "--dry-run"]).out;
        assert!(ahead.contains("1 of 2 rows to simulate"), "{signal}: {ahead}");
    }
}

#[test]
fn nohup_keeps_a_run_going_when_the_terminal_closes() {
    let desk = study(&endless());
    let run = command(&desk, &["run"]);
    let mut nohup = Command::new("nohup");
    nohup.arg(run.get_program()).args(run.get_args());
    let mut child = nohup.stdout(Stdio::null()).stderr(Stdio::null()).spawn().unwrap();
    std::thread::sleep(A_MOMENT);
    Command::new("sh").args(["-c", &format!("kill -HUP {}", child.id())]).status().unwrap();
    std::thread::sleep(A_MOMENT);
    assert!(child.try_wait().unwrap().is_none(), "it goes on");
    child.kill().unwrap();
    child.wait().unwrap();
}

/// One thread has one experiment under way, and never comes to the others.
#[test]
fn an_interrupted_run_says_what_is_kept_of_each_experiment_and_calls_no_row_failed() {
    let desk = study(&half_endless());
    for id in ["ch3-more", "ch3-most"] {
        desk.put(&format!("experiments/ch3/{id}.yaml"), &endless());
    }
    let (_, said, _) = interrupted(&desk, &["run", "--jobs", "1"], A_MOMENT);
    assert!(!said.contains("failed") && !said.contains("restored") && !said.contains("left"), "{said}");
    assert!(said.matches(": not begun\n").count() == 2, "{said}");
    assert!(said.contains("ch3-long: interrupted: 1 of 2 rows done, kept; the next run goes on there\n"), "{said}");
}

#[test]
fn an_interrupt_ends_every_command_that_simulates_and_a_limit_its_rows() {
    let desk = study(&endless());
    desk.put(
        "reference/ch3/ch3-long.yaml",
        "
entries:
  - {id: some, place: s. 3, says: Some., value: 1.75 m/s, from: {cell: {of: rms_velocity, where: {gap_ratio: 50}}}}
",
    );
    let calibration = "title: T\nabout: A.\ncalibrate: {harmonic_reference: [base, loaded]}\nfit: [ch3-long/some]\n";
    desk.put("calibrations/it.yaml", calibration);
    for arguments in [
        &["accuracy", "ch3-long"][..],
        &["effects", "ch3-long"],
        &["calibrate", "it"],
        &["explain", "--run", "ch3-long/some"],
    ] {
        let (code, said, took) = interrupted(&desk, arguments, A_MOMENT);
        assert_eq!(code, Some(130), "{arguments:?}: {said}");
        assert!(said.lines().last().unwrap().starts_with("interrupted: "), "{arguments:?}: {said}");
        assert!(took < Duration::from_secs(1), "{arguments:?}: {took:?}");
        let limited = shotdamp(&desk, &[arguments, &["--row-limit", "2000 events"]].concat());
        let told = limited.out + &limited.err;
        assert!(told.contains("stopped at the limit of 2000 events"), "{arguments:?}: {told}");
    }
}

#[test]
fn an_explanation_says_how_far_it_is_and_the_reason_of_a_failed_move_is_no_column() {
    let text = THREE_GAPS.replace("restitution: 0.5", "restitution: {assumed: stop_restitution}");
    let desk = study(&text);
    desk.put(
        "experiments/assumptions.yaml",
        &crate::desk::ASSUMPTIONS
            .replace("stop_restitution: {value: 0,", "stop_restitution: {value: 0, range: [0.2, 0.4],"),
    );
    desk.put(
        "reference/ch3/ch3-long.yaml",
        "
entries:
  - {id: some, place: s. 3, says: Some., value: 175 mm/s, from: {cell: {of: rms_velocity, where: {gap_ratio: 50}}}}
",
    );
    assert_ne!(shotdamp(&desk, &["run", "--tables"]).code, 2);
    let said = shotdamp(&desk, &["explain", "--run", "ch3-long/some", "--jobs", "1"]);
    assert!(said.err.contains("ch3-long/some: 1 of "), "how far it is: {}", said.err);
    let moved = |out: &str| out.lines().filter(|line| line.contains('→')).map(str::to_owned).collect::<Vec<_>>();
    assert!(moved(&said.out).len() > 1 && moved(&said.out).iter().all(|line| line.contains(" mm/s ")), "{}", said.out);
    let failed = shotdamp(&desk, &["explain", "--run", "ch3-long/some", "--row-limit", "20 events"]).out;
    assert!(moved(&failed).iter().any(|line| line.contains("no result")), "{failed}");
    assert!(moved(&failed).iter().all(|line| line.chars().count() < 110), "{failed}");
    assert!(
        failed.lines().any(|line| line.starts_with("    a run failed: stopped at the limit of 20 events")),
        "{failed}"
    );
}

/// A plate whose contact states are matrices of order 872.
const LARGE: &str = "
title: Large
source: {chapter: 3, section: '3'}
about: A large plate.
scene:
  structure: {supported_plate: {length: 1.3333 m, width: 1 m, thickness: 7.91 mm, youngs_modulus: 68.9 GPa, poisson_ratio: 0.33, density: 2700 kg/m^3, rayleigh: 5e-5, modes: [20, 20]}}
  dampers:
    - at: [0.5, 0.5]
      mass_ratio: 0.1
      particle_share: 0.5
      gap_ratio: 2
      floor: {resilient: {stiffness: 1000 N/m, damping_ratio: 0.15}}
      array: {count: 36, spacing: 1 cm}
  excitation: {impulse_train: {at: [0.25, 0.375], impulse: 1 N s, frequency_ratio: 1}}
run: {skip: 5, average: 20, ensemble: none, sensitivity: none}
measure: [velocity_ratio]
";

#[test]
fn an_interrupt_does_not_wait_for_a_large_matrix() {
    let desk = study(LARGE);
    let (code, said, took) = interrupted(&desk, &["run"], 4 * A_MOMENT);
    assert_eq!(
        (code, said.lines().last().map(|line| line.starts_with("interrupted: "))),
        (Some(130), Some(true)),
        "{said}"
    );
    assert!(took < Duration::from_secs(1), "{took:?}");
}

#[test]
fn show_ends_soon_and_says_what_it_left_out() {
    let many = THREE_GAPS.replace("mass_ratio: 0.05, ", "mass_ratio: swept, ").replace(
        "{gap_ratio: [10, 50, 90]}",
        "{gap_ratio: {log: {from: 1, to: 100, points: 1000}}, mass_ratio: {log: {from: 0.01, to: 0.1, points: 90}}}",
    );
    for text in [many.as_str(), LARGE] {
        let desk = study(text);
        let show = command(&desk, &["show", "ch3-long"]);
        // The shell prints what its children took: the machine may have other work, and the bound is of processor time.
        let script = r#""$0" "$@" 2>&1; times"#;
        let said =
            Command::new("sh").args(["-c", script]).arg(show.get_program()).args(show.get_args()).output().unwrap();
        let told = String::from_utf8(said.stdout).unwrap();
        let seconds = |time: &str| {
            let (minutes, seconds) = time.trim_end_matches('s').split_once('m').unwrap();
            60.0 * minutes.parse::<f64>().unwrap() + seconds.parse::<f64>().unwrap()
        };
        let took: f64 = told.lines().last().unwrap().split_whitespace().map(seconds).sum();
        assert!(took < 2.0, "{took} s\n{told}");
        assert!(told.contains("takes more than 1.5 s") || told.contains("Fingerprint"), "{told}");
        assert!(told.contains("ch3-long: ") && told.contains("\nScene"), "{told}");
    }
    let said = shotdamp(&study(THREE_GAPS), &["show", "ch3-long"]);
    assert!(!said.out.contains("Left out") && said.out.contains("Fingerprint"), "{}", said.out);
}

#[test]
fn what_will_take_long_or_say_nothing_is_told_beforehand() {
    let fixed = THREE_GAPS
        .replace("run: {", "run: {solver: {fixed_step: {time_step: 1 ns}}, ")
        .replace("average: 8", "average: 100");
    for (text, warning) in [
        (fixed.as_str(), "fixed steps take about"),
        (&THREE_GAPS.replace("restitution: 0.5", "restitution: 1"), "may bounce without end"),
        (
            &THREE_GAPS.replace("damping_ratio: 0.05", "damping_ratio: 5"),
            "the damping ratio of the structure is 5, above critical damping; 5 % is 0.05",
        ),
        (
            &THREE_GAPS.replace("force_ratio: 5", "force_ratio: 0").replace("[rms", "[velocity_ratio, rms"),
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
    let text = THREE_GAPS.replace("force_ratio: 5", "force_ratio: 0").replace("[rms", "[velocity_ratio, rms");
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
    let text = THREE_GAPS
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
