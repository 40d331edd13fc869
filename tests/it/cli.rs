//! The command: what it says, what it leaves on disk, and how it ends.

use std::collections::BTreeMap;
use std::fs;
use std::path::Path;
use std::process::{Command, Stdio};

use assert_cmd::cargo::CommandCargoExt;

use crate::desk::{ASSUMPTIONS, Desk, GAP, GAP_REFERENCE, STOP, STOP_REFERENCE, THREE_GAPS, said, shotdamp, simulated};

/// Every file below the folder with its bytes, except the times that runs have taken and the snapshot, which holds times of files.
pub fn files(folder: &Path) -> BTreeMap<String, Vec<u8>> {
    let mut found = BTreeMap::new();
    for entry in fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.ends_with("results/times") || path.ends_with("results/snapshot.bin") {
            continue;
        }
        if path.is_dir() {
            found.extend(files(&path));
        } else {
            found.insert(path.display().to_string(), fs::read(&path).unwrap());
        }
    }
    found
}

/// The same with names that do not depend on where the study lies.
pub fn relative_files(desk: &Desk) -> BTreeMap<String, Vec<u8>> {
    let root = desk.folder.path().display().to_string();
    files(desk.folder.path()).into_iter().map(|(name, bytes)| (name.replace(&root, ""), bytes)).collect()
}

#[test]
fn the_first_run_publishes_and_the_second_has_nothing_to_do() {
    let desk = simulated();
    let first = shotdamp(&desk, &[]);
    assert_eq!((first.code, first.err.as_str()), (0, ""), "{}", first.out);
    for name in ["README.md", "ch3/ch3-stop.md", "ch3/ch3-stop.png", "ch3/ch3-gap.md", "ch3/ch3-gap.png"] {
        assert!(desk.folder.path().join("reports").join(name).is_file(), "{name}");
    }
    let before = files(desk.folder.path());
    let second = shotdamp(&desk, &[]);
    assert_eq!((second.code, second.err.as_str()), (0, ""));
    assert!(second.out.ends_with(&first.out[first.out.find('\n').unwrap()..]), "the same summary");
    assert!(second.out.starts_with("Nothing to do"));
    assert_eq!(shotdamp(&desk, &["status", "--exit-code"]).code, 0);
    assert!(before == files(desk.folder.path()), "nothing was written");

    // Its last line names the page to open.
    for (arguments, page) in [(&["run"][..], "README.md"), (&["run", "ch3-gap"], "ch3/ch3-gap.md")] {
        let last = shotdamp(&desk, arguments).out.lines().last().unwrap_or_default().to_owned();
        let named = last.strip_prefix("Result: ").unwrap_or_else(|| panic!("{last}"));
        assert!(named.ends_with(&format!("reports/{page}")) && desk.folder.path().join(named).is_file(), "{last}");
    }

    // No time, host or folder in anything that was written: another folder gives the same bytes.
    let other = simulated();
    shotdamp(&other, &["run", "--jobs", "1"]);
    assert!(relative_files(&desk) == relative_files(&other));
}

#[test]
fn a_lost_figure_or_an_edited_report_is_renewed_without_simulating() {
    let desk = simulated();
    shotdamp(&desk, &[]);
    let whole = files(desk.folder.path());
    fs::remove_file(desk.layout.path("reports/ch3/ch3-gap.png")).unwrap();
    desk.put("reports/ch3/ch3-stop.md", "edited");
    let status = shotdamp(&desk, &["status", "--why", "--exit-code"]);
    assert_eq!(status.code, 1);
    assert!(status.out.contains("reports/ch3/ch3-gap.png is missing"), "{}", status.out);
    assert!(status.out.contains("reports/ch3/ch3-stop.md is not what was written"));
    assert!(status.out.contains("0 to simulate, 2 reports to renew"));
    assert_eq!(shotdamp(&desk, &[]).code, 0);
    assert!(whole == files(desk.folder.path()));
}

#[test]
fn a_figure_that_is_taken_out_does_not_stay_behind() {
    let desk = simulated();
    shotdamp(&desk, &[]);
    desk.put("experiments/ch3/ch3-gap.yaml", &GAP.replace("figure: {", "figure: {name: by-gap, "));
    let why = shotdamp(&desk, &["status", "--why", "ch3-gap"]).out;
    assert!(why.contains("report stale") && why.contains("figures.0.name:  -> by-gap"), "{why}");
    assert_eq!(shotdamp(&desk, &["run", "ch3-gap"]).code, 0);
    assert!(desk.layout.path("reports/ch3/ch3-gap-by-gap.png").is_file());
    assert!(!desk.layout.path("reports/ch3/ch3-gap.png").exists());
}

#[test]
fn the_exit_code_tells_unexpected_from_missing() {
    let desk = simulated();
    assert_eq!(shotdamp(&desk, &["check"]).code, 0);
    let tested = shotdamp(&desk, &["check", "--self-test"]);
    assert_eq!((tested.code, tested.err.as_str()), (0, ""));
    assert!(tested.out.ends_with("self-test: 2 of 2 entries can fail\n"), "{}", tested.out);

    desk.put("reference/ch3/ch3-gap.yaml", &GAP_REFERENCE.replace("increasing", "decreasing"));
    let unexpected = shotdamp(&desk, &["check"]);
    assert_eq!(unexpected.code, 1);
    assert!(unexpected.out.contains("ch3-gap/grows"), "{}", unexpected.out);
    assert_eq!(shotdamp(&desk, &["check", "ch3-stop"]).code, 0, "the other experiment is as expected");
    assert_eq!(shotdamp(&desk, &[]).code, 1);
    assert_eq!(shotdamp(&desk, &[]).code, 1, "also when there is nothing to do");

    // A stale table is no table: its numbers answer another question.
    desk.put("experiments/assumptions.yaml", &ASSUMPTIONS.replace("60 mm", "55 mm"));
    let before = files(desk.folder.path());
    assert_eq!(shotdamp(&desk, &["check", "ch3-stop"]).code, 2);
    assert!(before == files(desk.folder.path()), "check writes nothing");

    // Entries of an experiment that is not there are missing, not forgotten.
    let orphan = simulated();
    orphan.put("reference/ch3/ch3-lost.yaml", STOP_REFERENCE);
    assert_eq!(shotdamp(&orphan, &["check"]).code, 2);
    assert_eq!(shotdamp(&orphan, &["check", "ch3-gap"]).code, 0);
}

#[test]
fn status_names_the_input_that_changed() {
    let desk = simulated();
    shotdamp(&desk, &[]);
    desk.put("experiments/assumptions.yaml", &ASSUMPTIONS.replace("60 mm", "55 mm"));
    let status = shotdamp(&desk, &["status", "--why"]);
    assert_eq!(
        status.out,
        "\
         ch3-stop  stale\n    \
             experiments/assumptions.yaml:9: stop_length: 0.06 -> 0.055\n    \
             12 of 30 rows to simulate\n\
         2 experiments: 1 to simulate, 0 reports to renew, 1 up to date\n"
    );
    assert_eq!((status.code, shotdamp(&desk, &["status", "--exit-code"]).code), (0, 1));
    let before = files(desk.folder.path());
    let dry = shotdamp(&desk, &["run", "--dry-run", "--jobs", "2"]);
    assert!(before == files(desk.folder.path()), "it writes nothing");
    assert_eq!(
        dry.out,
        "ch3-stop: 12 of 30 rows to simulate, 12 simulations at most, less than 0.1 s\n\
         1 of 2 experiments would be simulated\n\
         Less than 0.1 s on 2 threads\n"
    );
}

#[test]
fn what_nothing_answers_to_is_an_error() {
    let desk = Desk::new();
    for arguments in
        [&["run", "ch3-elsewhere"][..], &["check", "ch4-*"], &["show", "gaps-of-all"], &["status", "ch3-gap", "x*"]]
    {
        let said = shotdamp(&desk, arguments);
        assert_eq!(said.code, 2, "{arguments:?}");
        assert!(said.err.contains("no experiment matches") && said.err.contains("ch3-gap, ch3-stop"), "{}", said.err);
    }
    assert_eq!(shotdamp(&desk, &["run", "--folder", "ch7"]).code, 2);
    assert_eq!(shotdamp(&desk, &["run", "--jobs", "0"]).code, 2);
    assert!(!desk.layout.path("results/ch3-gap.parquet").exists());
    let nowhere = tempfile::tempdir().unwrap();
    let said = Command::cargo_bin("shotdamp").unwrap().current_dir(nowhere.path()).output().unwrap();
    assert_eq!(said.status.code(), Some(2));
    assert!(String::from_utf8_lossy(&said.stderr).contains("--root"));
}

#[test]
fn patterns_and_folders_choose() {
    let desk = Desk::new();
    desk.put("experiments/ch4/ch4-gap.yaml", &GAP.replace("chapter: 3", "chapter: 4"));
    for (arguments, expected) in [
        (&["status", "*-gap"][..], &["ch3-gap", "ch4-gap"][..]),
        (&["status", "ch?-stop", "ch4-gap"], &["ch3-stop", "ch4-gap"]),
        (&["status", "--folder", "ch3"], &["ch3-gap", "ch3-stop"]),
        (&["status", "*gap", "--folder", "ch4/"], &["ch4-gap"]),
    ] {
        let out = shotdamp(&desk, arguments).out;
        let chosen: Vec<&str> = out.lines().filter_map(|line| line.split("  ").next()).collect();
        assert_eq!(chosen[..chosen.len() - 1], *expected, "{arguments:?}");
    }
}

/// A warning stands beside the work, once, with its place, and changes no exit code.
#[test]
fn an_assumption_that_nothing_uses_is_a_warning() {
    let desk = simulated();
    let silent = shotdamp(&desk, &[]);
    assert_eq!((silent.code, silent.err.as_str()), (0, ""), "all are used");
    desk.put(
        "experiments/assumptions.yaml",
        &format!("{ASSUMPTIONS}spare: {{quantity: ratio, value: 1, reason: none}}\n"),
    );
    let line = ASSUMPTIONS.lines().count() + 1;
    for arguments in [&["status"][..], &["check"], &["run"], &["run"], &["status"]] {
        let said = shotdamp(&desk, arguments);
        assert_eq!(said.code, 0, "{arguments:?}: {}", said.err);
        assert!(
            said.err.starts_with("warning: no experiment uses the assumption `spare`\n"),
            "{arguments:?}: {}",
            said.err
        );
        assert!(said.err.contains(&format!("--> experiments/assumptions.yaml:{line}:1\n")), "{}", said.err);
        assert_eq!(said.err.matches("warning").count(), 1, "{arguments:?}: {}", said.err);
    }
    assert_eq!(shotdamp(&desk, &["run", "--quiet"]).err, "");
    // What cannot be read may use it.
    desk.put("experiments/ch3/ch3-bad.yaml", "title: x");
    assert!(!shotdamp(&desk, &["status"]).err.contains("warning"));
}

/// A mistake in one file: told with its place, nothing written for it, all others done, and the exit code says so.
#[test]
fn a_bad_experiment_does_not_stop_the_others() {
    let desk = simulated();
    desk.put("experiments/ch3/ch3-bad.yaml", &STOP.replace("gap_ratio: 50", "gap: 5 s"));
    let said = shotdamp(&desk, &[]);
    assert_eq!(said.code, 2);
    assert!(said.err.contains("experiments/ch3/ch3-bad.yaml:9:"), "{}", said.err);
    assert!(desk.layout.path("reports/ch3/ch3-gap.png").is_file());
    assert!(files(desk.folder.path()).keys().filter(|name| name.contains("bad")).all(|name| name.ends_with(".yaml")));
    assert_eq!(shotdamp(&desk, &[]).code, 2, "it does not pass for done the second time");
    assert_eq!(shotdamp(&desk, &["run", "ch3-gap"]).code, 0, "who asks for another one is not bothered");
    assert_eq!(shotdamp(&desk, &["run", "ch3-bad"]).code, 2);

    desk.put("experiments/ch3/ch3-bad.yaml", STOP);
    desk.put("reference/ch3/ch3-bad.yaml", "entries: [{id: x}]\n");
    let said = shotdamp(&desk, &["check"]);
    assert_eq!(said.code, 2);
    assert!(
        said.err.contains("an entry lacks `place`\n  --> reference/ch3/ch3-bad.yaml:1:11\n  |\n1 | entries: [{id: x}]\n  |           ^\n"),
        "{}",
        said.err
    );

    desk.put("experiments/assumptions.yaml", "gravity: {quantity: acceleration, value: 9.81 s, reason: wrong unit}\n");
    let said = shotdamp(&desk, &["run", "ch3-gap"]);
    assert_eq!(said.code, 2);
    assert!(said.err.contains("experiments/assumptions.yaml:1:"), "{}", said.err);
}

/// What cannot be opened is one more broken file: named with what to do, and all others done.
#[cfg(unix)]
#[test]
fn an_unreadable_file_does_not_stop_the_others() {
    let desk = simulated();
    let path = |name: &str| desk.layout.path(&format!("experiments/ch3/ch3-{name}.yaml"));
    std::os::unix::fs::symlink("elsewhere.yaml", path("link")).unwrap();
    fs::create_dir(path("folder")).unwrap();
    assert!(std::process::Command::new("mkfifo").arg(path("pipe")).status().unwrap().success());
    for turn in ["first", "second"] {
        let said = shotdamp(&desk, &[]);
        assert_eq!(said.code, 2, "{turn}");
        for words in [
            "error: experiments/ch3/ch3-link.yaml cannot be read: it is a link to a file that does not exist; restore",
            "error: experiments/ch3/ch3-folder.yaml cannot be read: it is a folder; rename it",
            "error: experiments/ch3/ch3-pipe.yaml cannot be read: it is a pipe or a device; put a file in its place",
        ] {
            assert!(said.err.contains(words), "{turn}: {}", said.err);
        }
        assert!(said.out.contains("2 experiments"), "{turn}: {}", said.out);
    }
    assert!(desk.layout.path("reports/ch3/ch3-gap.png").is_file());
    assert_eq!(shotdamp(&desk, &["run", "ch3-gap"]).code, 0, "who asks for another one is not bothered");
    assert_eq!(shotdamp(&desk, &["run", "ch3-link"]).code, 2);
}

/// Of an experiment that lost its file nothing is taken away: it may be mended.
#[cfg(unix)]
#[test]
fn results_of_an_unreadable_experiment_stay() {
    let desk = simulated();
    assert_eq!(shotdamp(&desk, &[]).code, 0);
    let file = desk.layout.path("experiments/ch3/ch3-gap.yaml");
    let kept = desk.folder.path().join("kept");
    fs::rename(&file, &kept).unwrap();
    std::os::unix::fs::symlink("nowhere", &file).unwrap();
    assert_eq!(shotdamp(&desk, &[]).code, 2);
    assert_eq!(shotdamp(&desk, &["clean", "--orphans"]).out, "0 files removed\n");
    fs::rename(&kept, &file).unwrap();
    let said = shotdamp(&desk, &[]);
    assert!(said.code == 0 && said.out.contains("2 experiments: 0 simulated"), "{}{}", said.out, said.err);
}

#[cfg(unix)]
#[test]
fn a_link_that_leads_back_is_one_error_and_all_other_experiments_are_read() {
    let desk = simulated();
    let link = |to: &str, name: &str| std::os::unix::fs::symlink(to, desk.layout.path(name)).unwrap();
    link("../../experiments", "experiments/ch3/again");
    link("self.yaml", "experiments/ch3/self.yaml");
    let said = shotdamp(&desk, &[]);
    for name in ["experiments/ch3/again", "experiments/ch3/self.yaml"] {
        let told = format!("error: {name} cannot be read: it is a link that leads back to itself; remove it");
        assert_eq!(said.err.matches(&told).count(), 1, "{}", said.err);
    }
    assert!(said.code == 2 && !said.err.contains("has the same id"), "{}", said.err);
    assert!(said.out.contains("2 experiments: 0 simulated"), "{}", said.out);
}

/// Folders that hold links to each other: each file is read once, by the name that it has without a link.
#[cfg(unix)]
#[test]
fn links_to_and_fro_between_folders_are_followed_once() {
    let desk = simulated();
    desk.put("experiments/ch4/ch4-long.yaml", THREE_GAPS);
    let link = |to: &str, name: &str| std::os::unix::fs::symlink(to, desk.layout.path(name)).unwrap();
    link("../ch4", "experiments/ch3/across");
    link("../ch3", "experiments/ch4/back");
    let elsewhere = tempfile::tempdir().unwrap();
    fs::write(elsewhere.path().join("ch5-long.yaml"), THREE_GAPS).unwrap();
    link(elsewhere.path().to_str().unwrap(), "experiments/ch5");
    link("../ch5", "experiments/ch4/far");
    let said = shotdamp(&desk, &["list"]);
    assert!(said.code == 0 && said.err.is_empty(), "{}", said.err);
    for id in ["ch3-gap", "ch3-stop", "ch4-long", "ch5-long"] {
        assert_eq!(said.out.matches(id).count(), 1, "{id}:\n{}", said.out);
    }
    let shown = shotdamp(&desk, &["show", "ch5-long"]).out;
    assert!(shown.contains("experiments/ch5/ch5-long.yaml"), "{shown}");
}

/// What all experiments share is named as well, each time anew.
#[test]
fn an_unreadable_file_of_the_whole_study_is_an_error_each_time() {
    let desk = simulated();
    fs::create_dir(desk.layout.path("study.yaml")).unwrap();
    for _ in 0..2 {
        let said = shotdamp(&desk, &[]);
        assert!(
            said.code == 2 && said.err.contains("error: study.yaml cannot be read: it is a folder"),
            "{}",
            said.err
        );
    }
    fs::remove_dir(desk.layout.path("study.yaml")).unwrap();
    fs::create_dir(desk.layout.path("reference/ch3/ch3-new.yaml")).unwrap();
    let said = shotdamp(&desk, &["check"]);
    assert!(said.code == 2 && said.err.contains("reference/ch3/ch3-new.yaml cannot be read"), "{}", said.err);
}

#[test]
fn a_damaged_table_is_simulated_again() {
    let desk = simulated();
    shotdamp(&desk, &[]);
    let table = desk.layout.path("results/ch3-gap.parquet");
    let bytes = fs::read(&table).unwrap();
    fs::write(&table, &bytes[..bytes.len() - 1]).unwrap();
    assert_eq!(shotdamp(&desk, &["check", "ch3-gap"]).code, 2);
    let status = shotdamp(&desk, &["status", "--why", "ch3-gap"]);
    assert!(status.out.contains("results/ch3-gap.parquet is not what was written"), "{}", status.out);
}

/// A start is the structure's alone in the run without dampers, and energies of one mode are those of one mode.
#[test]
fn effects_of_a_given_start_and_of_energy_measures_are_switched() {
    for (root, id, effect) in
        [("examples/classics", "dropped-ball", "gravity"), (".", "ch5-measures-centre", "further modes")]
    {
        let root = Path::new(env!("CARGO_MANIFEST_DIR")).join(root);
        let mut command = Command::cargo_bin("shotdamp").unwrap();
        command.arg("--root").arg(root).args(["effects", id]);
        let done = said(command);
        assert_eq!(done.code, 0, "{id}: {}", done.err);
        assert!(done.out.contains(&format!("| {effect} | in force | off |")), "{}", done.out);
    }
}

#[test]
fn show_tells_the_scene_the_effects_and_the_assumptions() {
    let out = shotdamp(&Desk::new(), &["show", "ch3-stop"]).out;
    for line in [
        "limit stop at 60 mm with restitution 0",
        "in force in 3 of 6 cases",
        "left out: the walls are rigid",
        "stop_length = 60 mm",
        "stop_length=0.05",
        "fixed_step_1e-4s",
        "30 rows, 27 simulations at most",
        "Fingerprint ",
    ] {
        assert!(out.contains(line), "{line}\n{out}");
    }
    assert!(!out.contains("harmonic_reference"), "an assumption it does not use");
    let list = shotdamp(&Desk::new(), &["list"]).out;
    assert_eq!(list.lines().next().unwrap(), "ch3-gap   s. 3.6.1  Fig. 16  Gap");
}

#[test]
fn whoever_closes_the_pipe_has_read_enough() {
    let desk = Desk::new();
    // What the command has found out stands whether it was read or not: nothing has been run.
    for (name, code) in [("list", 0), ("check", 2)] {
        let mut command = Command::cargo_bin("shotdamp").unwrap();
        command.arg("--root").arg(desk.folder.path()).arg(name).stdout(Stdio::piped()).stderr(Stdio::piped());
        let mut child = command.spawn().unwrap();
        drop(child.stdout.take());
        let output = child.wait_with_output().unwrap();
        assert_eq!((output.status.code(), output.stderr.as_slice()), (Some(code), &b""[..]), "{name}");
    }
}

#[test]
fn a_name_that_means_something_else_is_told_from_one_that_is_unknown() {
    let desk = Desk::new();
    let fails = |args: &[&str], words: &[&str]| {
        let said = shotdamp(&desk, args);
        assert_eq!(said.code, 2, "{args:?}: {}", said.out);
        assert!(words.iter().all(|word| said.err.contains(word)), "{args:?}: {}", said.err);
    };
    fails(&["new", "assumptions"], &["holds the assumptions of all experiments"]);
    desk.put("experiments/ch4/ch4-other.yaml", STOP);
    fails(&["run", "--folder", "ch4", "ch3-gap"], &["no experiment in experiments/ch4", "leave out --folder"]);
    // A reference whose experiment was renamed.
    fs::rename(desk.layout.path("experiments/ch3/ch3-gap.yaml"), desk.layout.path("experiments/ch3/gap.yaml")).unwrap();
    fails(&["show", "ch3-gap"], &["no experiment matches `ch3-gap`"]);
    let said = shotdamp(&desk, &["check"]);
    assert!(said.out.contains("there is no experiment `ch3-gap`"), "{}", said.out);
    assert!(!said.out.contains("run --force ch3-gap"), "no run makes up for it: {}", said.out);
}

#[test]
fn assumptions_are_called_unused_when_all_experiments_are_known_not_to_use_them() {
    let desk = Desk::new();
    for command in [&["run", "ch3-gap"][..], &["run", "ch3-gap"], &["status", "ch3-gap"]] {
        let said = shotdamp(&desk, command);
        assert!(!said.err.contains("no experiment uses"), "{command:?}: {}", said.err);
    }
}

#[test]
fn explain_tells_what_an_entry_hangs_on_and_simulates_nothing() {
    let desk = simulated();
    let before = files(desk.folder.path());
    let said = shotdamp(&desk, &["explain", "ch3-stop/at-two"]);
    assert_eq!((said.code, said.err.as_str()), (0, ""));
    for part in [
        "ch3-stop/at-two: ",
        "how far off it is, in % of the published 1.75)",
        "stop_length: 60 mm → 50 mm",
        "impulse_factor: 2 → 1.8",
        "% off",
        "contact_damping_ratio",
    ] {
        assert!(said.out.contains(part), "{part}: {}", said.out);
    }
    assert!(before == files(desk.folder.path()), "nothing was written");
    desk.put(
        "experiments/assumptions.yaml",
        &ASSUMPTIONS.replace("stop_restitution: {value: 0,", "stop_restitution: {value: 0, range: [0.5],"),
    );
    desk.put("reference/ch3/ch3-stop.yaml", &STOP_REFERENCE.replace("at-two", "at-2"));
    let unmoved = shotdamp(&desk, &["explain", "ch3-stop/at-2"]);
    assert!(unmoved.out.contains("`shotdamp explain --run ch3-stop/at-2`"), "{}", unmoved.out);
    let tried = shotdamp(&desk, &["explain", "--run", "--quiet", "ch3-stop/at-2"]);
    assert_eq!((tried.code, tried.out.as_str(), tried.err.as_str()), (0, "", ""), "quiet");
    let tried = shotdamp(&desk, &["explain", "--run", "ch3-stop/at-2"]);
    assert!(tried.out.contains("stop_restitution: 0 → 0.5"), "{}", tried.out);
    let unknown = shotdamp(&desk, &["explain", "ch3-stop/at-three"]);
    assert!(unknown.code == 2 && unknown.err.contains("there is no entry `ch3-stop/at-three`"), "{}", unknown.err);
}

#[test]
fn entries_that_chose_an_assumption_and_are_none_are_told_at_their_places_and_leave_nothing_out() {
    let desk = simulated();
    let fitted = "reason: plastic, fitted_to: [ch3-gap/grows, ch3-gap/lost,\n  ch3-gap/gone]";
    let text = ASSUMPTIONS.replacen("reason: plastic", fitted, 1);
    desk.put("experiments/assumptions.yaml", &text);
    let line = 1 + text.lines().position(|line| line.contains("ch3-gap/lost")).unwrap();
    let column = 1 + text.lines().nth(line - 1).unwrap().find("ch3-gap/lost").unwrap();
    let said = shotdamp(&desk, &["run", "--dry-run"]);
    for place in [format!("assumptions.yaml:{line}:{column}\n"), format!("assumptions.yaml:{}:3\n", line + 1)] {
        assert!(said.err.contains(&place), "{place}: {}", said.err);
    }
    assert!(!(said.out + &said.err).contains("Left out"), "the experiments are planned");
}

#[test]
fn a_study_without_experiments_is_answered_with_the_command_that_begins_one() {
    let folder = tempfile::TempDir::new().unwrap();
    fs::create_dir(folder.path().join("experiments")).unwrap();
    let list = Command::cargo_bin("shotdamp").unwrap().current_dir(&folder).arg("list").output().unwrap();
    let said = String::from_utf8_lossy(&list.stderr).into_owned();
    assert!(said.contains("there are no experiments yet: `shotdamp new ID` begins one"), "{said}");
}
