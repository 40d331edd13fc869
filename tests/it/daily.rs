//! The command from day to day: a new experiment, completions, help, colours, quiet.

use std::fs;

use crate::desk::{Desk, GAP_REFERENCE, STOP, THREE_GAPS, command, said, shotdamp, simulated};

#[test]
fn a_new_experiment_runs_as_it_is() {
    let desk = Desk::new();
    let new = shotdamp(&desk, &["new", "ch3-my-idea"]);
    assert_eq!(
        (new.code, new.out.as_str()),
        (0, "experiments/ch3/ch3-my-idea.yaml\nNext: shotdamp show ch3-my-idea; shotdamp run ch3-my-idea\n"),
        "{}",
        new.err
    );
    let text = fs::read_to_string(desk.layout.path("experiments/ch3/ch3-my-idea.yaml")).unwrap();
    let line = text.lines().next().unwrap();
    let schema = line.strip_prefix("# yaml-language-server: $schema=").unwrap();
    assert!(desk.layout.path("experiments/ch3").join(schema).is_file(), "the schema line leads to the schema");
    let shown = shotdamp(&desk, &["show", "ch3-my-idea"]);
    assert!(shown.code == 0 && shown.out.contains("31 cases"), "{}{}", shown.out, shown.err);

    assert_eq!(shotdamp(&desk, &["new", "ch3-my-idea"]).code, 2, "it would overwrite");
    assert_eq!(shotdamp(&desk, &["new", "ch3-gap", "--folder", "ch4"]).code, 2, "an id is taken once");
    assert_eq!(shotdamp(&desk, &["new", "My idea"]).code, 2);
    assert_eq!(shotdamp(&desk, &["new", "away", "--folder", "../elsewhere"]).code, 2);
    for (arguments, file) in [
        (&["new", "an-idea"][..], "experiments/an-idea.yaml"),
        (&["new", "ch4-an-idea", "--folder", "beams/short"], "experiments/beams/short/ch4-an-idea.yaml"),
    ] {
        assert!(shotdamp(&desk, arguments).out.starts_with(&format!("{file}\n")), "{arguments:?}");
        let text = fs::read_to_string(desk.layout.path(file)).unwrap();
        let schema =
            text.lines().next().and_then(|line| line.strip_prefix("# yaml-language-server: $schema=")).unwrap();
        assert!(desk.layout.path(file).parent().unwrap().join(schema).is_file(), "{schema}");
    }
    let typo = shotdamp(&desk, &["new", "ch4-x", "--structure", "beam"]);
    assert!(typo.code == 2 && typo.err.contains("cantilever_beam"), "{}", typo.err);
    assert_eq!(fs::read_to_string(desk.layout.path("experiments/ch3/ch3-my-idea.yaml")).unwrap(), text);
}

#[test]
fn help_has_examples_for_every_command() {
    let desk = Desk::new();
    let help = shotdamp(&desk, &["--help"]).out;
    let commands = help.split("Commands:\n").nth(1).unwrap().split("\n\n").next().unwrap();
    let names = commands.lines().filter(|line| line.starts_with("  ") && !line.starts_with("   "));
    let names: Vec<&str> = names.filter_map(|line| line.split_whitespace().next()).filter(|n| *n != "help").collect();
    assert!(names.len() >= 9, "{commands}");
    for name in names {
        let help = shotdamp(&desk, &[name, "--help"]);
        assert!(help.code == 0 && help.out.contains(&format!("\n  shotdamp {name}")), "{name}:\n{}", help.out);
    }
}

#[test]
fn shells_complete_commands_and_options() {
    let desk = Desk::new();
    for shell in ["bash", "zsh", "fish", "elvish", "powershell"] {
        let script = shotdamp(&desk, &["completions", shell]);
        assert_eq!(script.code, 0);
        for word in ["status", "junit", "self-test"] {
            assert!(script.out.contains(word), "{shell}: {word}");
        }
    }
}

#[test]
fn quiet_leaves_the_errors() {
    let desk = simulated();
    for arguments in [&["run", "-q"][..], &["--quiet"], &["check", "--quiet"], &["status", "--quiet"]] {
        let quiet = shotdamp(&desk, arguments);
        assert_eq!((quiet.code, quiet.out.as_str(), quiet.err.as_str()), (0, "", ""), "{arguments:?}");
    }
    desk.put("experiments/ch3/ch3-bad.yaml", &STOP.replace("gap_ratio: 50", "gap: 5 s"));
    let quiet = shotdamp(&desk, &["--quiet"]);
    assert_eq!((quiet.code, quiet.out.as_str()), (2, ""));
    assert!(quiet.err.contains("ch3-bad.yaml:9:"), "{}", quiet.err);
    assert!(shotdamp(&desk, &["check", "--quiet", "--json"]).out.starts_with('{'), "a document is what was asked for");
}

#[test]
fn colours_are_for_terminals_and_for_who_asks() {
    let desk = Desk::new();
    desk.put("experiments/ch3/ch3-bad.yaml", &STOP.replace("gap_ratio: 50", "gap: 5 s"));
    let err = |arguments: &[&str], variables: &[(&str, &str)]| {
        let mut command = command(&desk, arguments);
        command.env_remove("NO_COLOR").env_remove("CLICOLOR_FORCE").envs(variables.iter().copied());
        said(command).err
    };
    assert!(!err(&["status"], &[]).contains('\u{1b}'), "not a terminal");
    assert!(err(&["status", "--color", "always"], &[]).contains("\u{1b}["));
    assert!(err(&["status", "--color", "always"], &[("NO_COLOR", "1")]).contains("\u{1b}["), "asked for by name");
    assert!(!err(&["status", "--color", "never"], &[]).contains('\u{1b}'));
    assert!(
        err(&["status", "nothing", "--color", "always"], &[]).contains("\u{1b}[1;31merror:\u{1b}[0m no experiment")
    );
    assert!(!err(&["run", "--color", "auto", "ch3-gap"], &[]).contains('\u{1b}'), "and no bars");
}

/// One mistake in every part of a file.
const MISTAKEN: &str = "
title: ''
source: {chapter: x, section: '3', shown: Fig. 18}
about: Many mistakes.
scene:
  structure: {single_mass: {mass: 1 m, stiffness: soft, damping_ratio: -1}}
  dampers:
    - mass_ratio: heavy
      gap_ratio: 50
      gap: 5 mm
      floor: {resilient: {stiffness_ratio: x, damping: 1 N}}
      ceiling: {rigid: {restitution: 2}}
      stop: {length: 60, restitution: -1}
      walls: {stiffness_ratio: 1, damping: 1}
  excitation: {impulse_train: {force_ratio: big, frequency_ratio: 1, period: 1 s}}
  gravitation: 9.81 m/s^2
sweep: {force_ratio: [1, two, 4], stop: [with, perhaps], speed: [1], gap_ratio: {log: {from: 0, to: 1, points: 1}}}
maximise: {velocity: {over: strength, in: [1, 2], refine: many}}
run: {solver: [exact, {fixed_step: {time_step: 1}}], skip: some, average: 0, ensemble: all, speed: high}
measure: [velocity_ratio, velocity]
trace: {from: 3 cycles, to: x, samples_per_cycle: 1 m}
shape: {of: something, points: 1}
figure: {x: force_ratio, y: velocity_ratio, band: wide, guides: [{at: x}], peaks: {prominence: 2}, markers: maybe}
";

#[test]
fn all_mistakes_of_a_file_are_told_at_once() {
    let desk = Desk::new();
    desk.put("experiments/ch3/ch3-bad.yaml", MISTAKEN);
    let description = shotdamp(&desk, &["status"]).err;
    let places: Vec<&str> = description.lines().filter(|line| line.contains("ch3-bad.yaml:")).collect();
    for (line, mistakes) in [
        (2, 1),
        (3, 2),
        (6, 3),
        (8, 1),
        (10, 1),
        (11, 2),
        (12, 1),
        (13, 2),
        (14, 1),
        (15, 2),
        (16, 1),
        (17, 4),
        (18, 3),
        (19, 6),
        (20, 1),
        (21, 2),
        (22, 3),
        (23, 5),
    ] {
        let found = places.iter().filter(|place| place.contains(&format!("ch3-bad.yaml:{line}:"))).count();
        assert_eq!(found, mistakes, "line {line}:\n{description}");
    }
}

/// The files below a folder.
fn names(desk: &Desk, folder: &str) -> Vec<String> {
    let mut names: Vec<String> = fs::read_dir(desk.layout.path(folder))
        .unwrap()
        .map(|entry| entry.unwrap().file_name().into_string().unwrap())
        .filter(|name| !name.starts_with('.'))
        .collect();
    names.sort();
    names
}

#[test]
fn what_a_deleted_experiment_left_is_removed() {
    let desk = simulated();
    assert_eq!(shotdamp(&desk, &[]).code, 0);
    for id in ["ch3-gap", "ch3-stop"] {
        desk.put(&format!("results/earlier/{id}/0.parquet"), "of another meaning");
    }
    let before = (names(&desk, "results"), names(&desk, "reports/ch3"));
    assert_eq!(shotdamp(&desk, &["clean", "--orphans"]).out, "0 files removed\n");
    for name in ["results/calibrations/gone.journal", "reports/calibrations/gone.md", "reports/calibrations/NOTES.md"] {
        desk.put(name, "of a calibration");
    }
    let gone = "reports/calibrations/gone.md\nresults/calibrations/gone.journal\n2 files removed\n";
    assert_eq!(shotdamp(&desk, &["clean", "--orphans"]).out, gone);
    fs::remove_dir_all(desk.layout.path("results/calibrations")).unwrap();
    fs::remove_file(desk.layout.path("experiments/ch3/ch3-gap.yaml")).unwrap();
    fs::remove_file(desk.layout.path("reference/ch3/ch3-gap.yaml")).unwrap();
    // One that cannot be read just now is not gone.
    desk.put("experiments/ch3/ch3-stop.yaml", "title: half wri");
    let dry = shotdamp(&desk, &["clean", "--orphans", "--dry-run"]);
    assert_eq!(
        dry.out,
        "reports/ch3/ch3-gap-scene.svg\nreports/ch3/ch3-gap.md\nreports/ch3/ch3-gap.png\nreports/ch3/ch3-gap.svg\nresults/ch3-gap.json\nresults/ch3-gap.parquet\n\
         results/earlier/ch3-gap/0.parquet\nresults/times/ch3-gap.json\n8 files would be removed\n"
    );
    assert_eq!((names(&desk, "results"), names(&desk, "reports/ch3")), before);
    assert_eq!(shotdamp(&desk, &["clean", "--orphans"]).code, 0);
    assert_eq!(names(&desk, "results"), ["ch3-stop.json", "ch3-stop.parquet", "earlier", "snapshot.bin", "times"]);
    assert_eq!(
        (names(&desk, "results/earlier"), names(&desk, "results/times")),
        (vec!["ch3-stop".into()], vec!["ch3-stop.json".into()])
    );
    assert_eq!(names(&desk, "reports/ch3"), ["ch3-stop-scene.svg", "ch3-stop.md", "ch3-stop.png", "ch3-stop.svg"]);
}

#[cfg(unix)]
#[test]
fn what_a_link_leads_to_is_nobody_elses_to_remove() {
    let desk = simulated();
    assert_eq!(shotdamp(&desk, &[]).code, 0);
    let elsewhere = tempfile::tempdir().unwrap();
    fs::write(elsewhere.path().join("notes.md"), "of a person").unwrap();
    for (to, name) in [(elsewhere.path(), "notes"), (std::path::Path::new("ch3"), "latest"), (".".as_ref(), "self")] {
        std::os::unix::fs::symlink(to, desk.layout.path(&format!("reports/{name}"))).unwrap();
    }
    let before = names(&desk, "reports/ch3");
    assert_eq!(shotdamp(&desk, &["clean", "--orphans"]).out, "0 files removed\n");
    assert!(elsewhere.path().join("notes.md").exists());
    assert_eq!(names(&desk, "reports/ch3"), before);
    assert_eq!(shotdamp(&desk, &["check", "--reports"]).code, 0);
}

/// There is no `results/`, so that no record names the files.
#[test]
fn what_a_deleted_experiment_left_is_found_in_a_fresh_clone_too() {
    let desk = simulated();
    assert_eq!(shotdamp(&desk, &[]).code, 0);
    fs::remove_dir_all(desk.layout.path("results")).unwrap();
    for name in ["experiments/ch3/ch3-gap.yaml", "reference/ch3/ch3-gap.yaml"] {
        fs::remove_file(desk.layout.path(name)).unwrap();
    }
    // Nobody but its owner knows what this is.
    desk.put("reports/ch3/talk.pdf", "of a person");
    let left =
        ["ch3-gap-scene.svg", "ch3-gap.md", "ch3-gap.png", "ch3-gap.svg"].map(|name| format!("reports/ch3/{name}\n"));
    let check = shotdamp(&desk, &["check", "--reports"]).err;
    for file in &left {
        assert!(check.contains(&format!("{}: nothing writes it; remove it", file.trim_end())), "{check}");
    }
    let clean = shotdamp(&desk, &["clean", "--orphans"]);
    assert_eq!(clean.out, format!("{}4 files removed\n", left.concat()), "{}", clean.err);
    let check = shotdamp(&desk, &["check", "--reports"]).err;
    assert_eq!(check.matches("nothing writes it").count(), 1, "{check}");
    let rest = ["ch3-stop-scene.svg", "ch3-stop.md", "ch3-stop.png", "ch3-stop.svg", "talk.pdf"];
    assert_eq!(names(&desk, "reports/ch3"), rest);
}

#[test]
fn an_experiment_may_be_named_by_its_file_as_a_shell_completes_it() {
    let desk = simulated();
    let file = desk.layout.path("experiments/ch3/ch3-gap.yaml");
    let absolute = file.to_str().unwrap();
    for path in [absolute, "experiments/ch3/ch3-gap.yaml"] {
        for arguments in [&["status"][..], &["check"], &["show"], &["run", "--dry-run"], &["run", "--tables"]] {
            let said = shotdamp(&desk, &[arguments, &[path]].concat());
            assert_eq!((said.code, said.err.as_str()), (0, ""), "{arguments:?} {path}");
            assert!(!said.out.contains("2 experiments") && !said.out.contains("ch3-stop"), "{}", said.out);
        }
    }
    let mut below = command(&desk, &["status", "../ch3/ch3-gap.yaml", "ch3-stop.yaml"]);
    let both = said_in(&mut below, file.parent().unwrap());
    assert!(both.lines().last().is_some_and(|line| line.starts_with("2 experiments")), "{both}");
    // A file of that name elsewhere is not meant.
    let elsewhere = tempfile::tempdir().unwrap();
    let other = elsewhere.path().join("ch3-gap.yaml");
    fs::copy(&file, &other).unwrap();
    for path in [other.to_str().unwrap(), "experiments/ch3/ch3-gone.yaml"] {
        let said = shotdamp(&desk, &["status", path]);
        assert!(said.code == 2 && said.err.contains("no experiment matches"), "{}", said.err);
    }
}

fn said_in(command: &mut std::process::Command, folder: &std::path::Path) -> String {
    String::from_utf8(command.current_dir(folder).output().unwrap().stdout).unwrap()
}

#[test]
fn a_name_that_is_almost_right_gets_the_right_one() {
    let desk = simulated();
    for arguments in [&["run", "ch3-stpo"][..], &["show", "ch3-sto"], &["check", "ch-stop"], &["status", "Ch3-Stop"]] {
        let said = shotdamp(&desk, arguments);
        assert_eq!(said.code, 2);
        assert!(said.err.ends_with("`; did you mean `ch3-stop`?\n"), "{arguments:?}: {}", said.err);
    }
    for (arguments, told) in [
        (&["run", "gap"][..], "no experiment matches `gap`; it is part of ch3-gap"),
        (
            &["show", "ch3-gap/grows"],
            "ids have no `/`: a folder is named with --folder, an entry with `shotdamp explain`",
        ),
        (&["explain", "ch3-gap"], "there is no entry `ch3-gap`; it is part of ch3-gap/grows"),
        (&["explain", "ch3-gap/grow"], "there is no entry `ch3-gap/grow`; did you mean `ch3-gap/grows`?"),
        (&["ch3-gap"], "tip: to simulate an experiment, write `shotdamp run ch3-gap`"),
    ] {
        let said = shotdamp(&desk, arguments);
        assert!(said.code == 2 && said.err.contains(told), "{arguments:?}: {}", said.err);
    }
    let none = shotdamp(&desk, &["calibrate", "nope"]);
    assert_eq!(
        (none.code, none.err.as_str()),
        (2, "error: there is no calibration `nope`; there are none that can be read\n")
    );
    desk.put("calibrations/floors.yaml", "title: T\n");
    let near = shotdamp(&desk, &["calibrate", "floor"]);
    assert_eq!(near.err, "error: there is no calibration `floor`; did you mean `floors`?\n");
    let wrong = shotdamp(&desk, &["calibrate", "calibrations/floors.yaml"]);
    assert!(wrong.code == 2 && wrong.err.starts_with("error: a calibration lacks"), "{}", wrong.err);
}

#[test]
fn a_table_that_cannot_be_read_is_not_called_another() {
    let desk = simulated();
    let table = desk.layout.path("results/ch3-gap.parquet");
    fs::remove_file(&table).unwrap();
    // A folder in its place can be read by nobody, not even by who may read every file.
    fs::create_dir(&table).unwrap();
    let status = shotdamp(&desk, &["status", "--why", "ch3-gap"]).out;
    assert!(status.contains("    results/ch3-gap.parquet cannot be read: "), "{status}");
}

#[test]
fn status_points_at_the_line_that_changed_and_counts_the_rows() {
    let desk = simulated();
    for (right, wrong, description) in [
        ("mass: 1 kg", "mass: 2 kg", "experiments/ch3/ch3-stop.yaml:6: scene.structure.single_mass.mass: 1.0 -> 2.0"),
        ("gap_ratio: 50", "gap_ratio: 60", "experiments/ch3/ch3-stop.yaml:9: scene.dampers.0.gap.ratio: 50.0 -> 60.0"),
        ("skip: 25", "skip: 30", "experiments/ch3/ch3-stop.yaml:14: settings.skip: 25 -> 30"),
        ("force_ratio: [1, 2, 4]", "force_ratio: [1, 2, 8]", "experiments/ch3/ch3-stop.yaml:13: cases."),
    ] {
        desk.put("experiments/ch3/ch3-stop.yaml", &STOP.replace(right, wrong));
        let status = shotdamp(&desk, &["status", "--why", "ch3-stop"]).out;
        assert!(status.contains(&format!("    {description}")), "{description}\n{status}");
        // Without a stop its length means nothing: three rows share the numbers of others.
        let to_do = if right.starts_with("force") { 9 } else { 27 };
        assert!(status.contains(&format!("\n    {to_do} of 30 rows to simulate\n")), "{status}");
    }
}

#[test]
fn status_says_which_value_was_put_into_a_list() {
    let desk = Desk::of_one("experiments/ch3/ch3-long.yaml", THREE_GAPS);
    assert_eq!(shotdamp(&desk, &["run", "--tables"]).code, 0);
    desk.put("experiments/ch3/ch3-long.yaml", &THREE_GAPS.replace("[10, 50, 90]", "[10, 30, 50, 90]"));
    let status = shotdamp(&desk, &["status", "--why", "ch3-long"]).out;
    assert!(status.contains(": cases.1: (absent) -> gap_ratio = 30.0\n") && !status.contains("50.0"), "{status}");
    desk.put("experiments/ch3/ch3-long.yaml", &THREE_GAPS.replace("[10, 50, 90]", "[50, 90]"));
    let status = shotdamp(&desk, &["status", "--why", "ch3-long"]).out;
    assert!(status.contains(": cases.0: gap_ratio = 10.0 -> (absent)\n"), "{status}");
}

#[test]
fn a_printed_schema_is_the_one_that_is_written() {
    let desk = Desk::new();
    assert_eq!(shotdamp(&desk, &["schema"]).code, 0);
    for of in ["study", "experiment", "assumptions", "reference", "calibration"] {
        let printed = shotdamp(&desk, &["schema", of]).out;
        assert!(printed.as_bytes() == desk.bytes(&format!("schema/{of}.json")), "{of}");
    }
    let elsewhere = tempfile::tempdir().unwrap();
    let mut outside = std::process::Command::new(command(&desk, &[]).get_program());
    let outside = said({
        outside.args(["schema", "experiment"]).current_dir(&elsewhere);
        outside
    });
    assert!(outside.code == 0 && !outside.out.contains("stop_restitution\""), "{}", outside.err);
}

#[test]
fn options_that_have_to_be_chosen_from_are_named() {
    let desk = Desk::new();
    let clean = shotdamp(&desk, &["clean"]);
    assert!(clean.code == 2 && clean.err.contains("--orphans") && clean.err.contains("--earlier"), "{}", clean.err);
    assert!(shotdamp(&desk, &["new", "--help"]).out.contains("clamped_beam"));
    let wrong = shotdamp(&desk, &["new", "ch3-mine", "--structure", "clamped_bean"]);
    assert!(wrong.code == 2 && wrong.err.contains("clamped_beam"), "{}", wrong.err);
    assert!(shotdamp(&desk, &["list", "--help"]).out.contains("grep 'Fig. 18'"));
}

fn texts<const N: usize>(desk: &Desk, pages: [&str; N]) -> [String; N] {
    pages.map(|page| fs::read_to_string(desk.layout.path(&format!("reports/{page}"))).unwrap())
}

#[test]
fn a_mistake_in_a_reference_leaves_its_verdicts_on_the_pages() {
    let desk = simulated();
    assert_eq!(shotdamp(&desk, &["run", "-q"]).code, 0);
    let read = || texts(&desk, ["README.md", "verdicts.json", "ch3/ch3-gap.md"]);
    let judged = read();
    desk.put("reference/ch3/ch3-gap.yaml", &GAP_REFERENCE.replace("says:", "sais:"));
    let run = shotdamp(&desk, &["run"]);
    assert!(run.code == 2 && run.out.contains("whose reference cannot be read"), "{}{}", run.out, run.err);
    assert_eq!(read(), judged);
    let check = shotdamp(&desk, &["check", "--reports"]);
    let unchecked = "error: reports cannot be checked while reference/ch3/ch3-gap.yaml cannot be read\n";
    assert!(check.code == 2 && check.err.contains(unchecked) && !check.err.contains("differs"), "{}", check.err);
    desk.put("reference/ch3/ch3-gap.yaml", GAP_REFERENCE);
    assert_eq!(shotdamp(&desk, &["run", "-q"]).code, 0);
    assert_eq!(read(), judged);
}

#[test]
fn a_run_of_one_experiment_says_that_its_averages_begin_too_early() {
    let desk = Desk::of_one("experiments/ch3/ch3-long.yaml", crate::desk::THREE_GAPS);
    let said = shotdamp(&desk, &["run", "ch3-long"]);
    let warning = "warning: ch3-long: after 2 cycles, 53 % of the free vibration remains in the run without dampers";
    assert!(said.err.contains(warning) && said.err.matches("free vibration").count() == 1, "{}", said.err);
    // Nothing is simulated, so nothing is to be warned of.
    assert!(!shotdamp(&desk, &["run", "ch3-long"]).err.contains("free vibration"));
    assert_eq!(shotdamp(&desk, &["run", "ch3-long", "--force", "--quiet"]).err, "");
}

#[test]
fn the_bare_command_says_what_it_is_about_to_do() {
    let desk = Desk::of_one("experiments/ch3/ch3-long.yaml", crate::desk::THREE_GAPS);
    desk.put("study.yaml", "title: Impact dampers\n");
    let said = shotdamp(&desk, &[]);
    let line = format!(
        "Bringing the study Impact dampers in {} up to date: 1 experiment to simulate; Ctrl-C is safe, finished rows are kept.",
        desk.folder.path().display()
    );
    assert!(said.err.lines().any(|said| said == line), "{}", said.err);
    assert!(!shotdamp(&desk, &[]).err.contains("Bringing"), "there is nothing to do");
    fs::remove_dir_all(desk.layout.path("results")).unwrap();
    assert_eq!(shotdamp(&desk, &["--quiet"]).err, "");
}

#[test]
fn a_run_of_some_experiments_names_the_pages_that_it_wrote() {
    let desk = simulated();
    desk.put("experiments/ch3/ch3-long.yaml", crate::desk::THREE_GAPS);
    assert_eq!(shotdamp(&desk, &["run", "-q"]).code, 0);
    // Reports are committed, tables are not.
    fs::remove_dir_all(desk.layout.path("results")).unwrap();
    let said = shotdamp(&desk, &["run", "ch3-gap", "ch3-long"]);
    let line =
        "The pages of the whole study are not updated: 1 experiment has no table here; `shotdamp run` makes them.";
    assert!(said.out.lines().any(|said| said == line), "{}", said.out);
    let named: Vec<&str> = said.out.lines().filter(|line| line.starts_with("Result: ")).collect();
    assert!(named.len() == 2 && named[0].ends_with("ch3-gap.md") && named[1].ends_with("ch3-long.md"), "{named:?}");
}

#[test]
fn one_experiment_run_in_a_fresh_clone_leaves_the_pages_of_the_whole_study() {
    let desk = simulated();
    assert_eq!(shotdamp(&desk, &["run", "-q"]).code, 0);
    let read = || texts(&desk, ["README.md", "what-stands.md", "verdicts.json"]);
    let committed = read();
    // Reports are committed, tables are not.
    fs::remove_dir_all(desk.layout.path("results")).unwrap();
    let run = shotdamp(&desk, &["run", "ch3-gap"]);
    assert!(run.out.contains("are not updated: 1 experiment has no table here"), "{}{}", run.out, run.err);
    assert_eq!(read(), committed);
    let whole = shotdamp(&desk, &["run"]);
    assert!(!whole.out.contains("are not updated"), "{}", whole.out);
    assert_ne!(read(), committed, "the tables were made up before");
}
