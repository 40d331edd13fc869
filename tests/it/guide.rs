//! The guide is true: its files are accepted, its commands print what it says, and its example runs.

use std::fs;
use std::path::Path;
use std::process::Command;

use shotdamp::experiment::{BasinColumn, BranchColumn};
use shotdamp::measure::Measure;
use shotdamp::report::RELEASED;
use shotdamp::study::Study;
use shotdamp::study::{IgnoreEvents, Layout, Texts, stem};
use shotdamp::text::words;

use crate::desk::{Desk, MadeUp};

#[path = "../../examples/one_damper.rs"]
#[expect(dead_code, reason = "its main is for those who run it alone")]
mod one_damper;

fn repository() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

pub fn document(name: &str) -> String {
    fs::read_to_string(repository().join(name)).unwrap()
}

/// The fenced blocks of a kind.
fn blocks<'a>(text: &'a str, kind: &str) -> Vec<&'a str> {
    let open = format!("```{kind}\n");
    text.split(open.as_str()).skip(1).map(|rest| rest.split("```").next().unwrap()).collect()
}

/// A block's commands, each with what it is said to print.
fn commands(block: &str) -> Vec<(String, String)> {
    let mut commands: Vec<(String, String)> = Vec::new();
    for line in block.lines() {
        match (line.strip_prefix("$ "), commands.last_mut()) {
            (Some(command), _) => commands.push((command.into(), String::new())),
            (None, Some((_, output))) => *output += &format!("{line}\n"),
            (None, None) => panic!("output before a command: {line}"),
        }
    }
    commands
}

/// True if `text` is `pattern`, in which … stands for anything.
fn prints(text: &str, pattern: &str) -> bool {
    let parts: Vec<&str> = pattern.split('…').collect();
    let Some(mut rest) = text.strip_prefix(parts[0]) else { return false };
    for part in &parts[1..] {
        match if part.trim().is_empty() { Some(rest.len()) } else { rest.find(part).map(|at| at + part.len()) } {
            Some(at) => rest = &rest[at..],
            None => return false,
        }
    }
    rest.is_empty()
}

#[test]
fn the_commands_of_the_guide_print_what_it_says() {
    let folder = tempfile::tempdir().unwrap();
    for name in [
        "experiments/assumptions.yaml",
        "experiments/ch3/ch3-undamped-decay.yaml",
        "reference/ch3/ch3-undamped-decay.yaml",
    ] {
        let path = folder.path().join(name);
        fs::create_dir_all(path.parent().unwrap()).unwrap();
        fs::copy(repository().join(name), path).unwrap();
    }
    let guide = document("docs/guide.md");
    let files = blocks(&guide, "yaml");
    let names: Vec<&str> = files.iter().map(|file| file.lines().next().unwrap().trim_start_matches("# ")).collect();
    for (name, file) in names.iter().zip(&files) {
        let path = folder.path().join(name);
        fs::create_dir_all(path.parent().unwrap()).unwrap();
        fs::write(path, file).unwrap();
    }
    let binary = assert_cmd::cargo::cargo_bin("shotdamp");
    for id in names.iter().map(|name| stem(name)) {
        let shown = Command::new(&binary).args(["show", id]).current_dir(folder.path()).output().unwrap();
        assert!(shown.status.success(), "{id}: {}", String::from_utf8_lossy(&shown.stderr));
    }
    // A whole experiment that stands indented would go untested.
    let whole = guide.lines().filter(|line| line.trim_start().starts_with("scene:")).count();
    assert_eq!(whole, files.len());
    let path = format!("{}:{}", binary.parent().unwrap().display(), std::env::var("PATH").unwrap());
    let mut tried = 0;
    for (command, expected) in blocks(&guide, "console").into_iter().flat_map(commands) {
        let printed = if command == "cargo run --quiet --example one_damper" {
            one_damper::describe().unwrap() + "\n"
        } else {
            let mut shell = Command::new("sh");
            let output = shell.args(["-c", &command]).env("PATH", &path).current_dir(folder.path()).output().unwrap();
            String::from_utf8([output.stdout, output.stderr].concat()).unwrap()
        };
        assert!(prints(&printed, &expected), "$ {command}\n{printed}\ninstead of\n{expected}");
        tried += 1;
    }
    assert!(tried >= 6);
}

#[test]
fn every_column_of_every_experiment_is_explained() {
    let text = document("docs/tables.md");
    let layout = Layout::new(repository());
    let study = Study::new(layout.clone(), Texts::read(&layout).unwrap());
    let mut columns: Vec<String> = Vec::new();
    for item in &study.items {
        let experiment = &item.source.experiment;
        columns.extend(experiment.measures.iter().map(words::of_key));
        columns.extend(experiment.swept.iter().map(words::of_key));
    }
    let desk = Desk::new();
    desk.run(2, &MadeUp::default(), &IgnoreEvents);
    let made_of = |name: &str| ["_num", "_spread", "_at_maximum", "_at_onset"].iter().any(|end| name.ends_with(end));
    for id in ["ch3-stop", "ch3-gap"] {
        columns.extend(desk.table(id).columns.into_iter().map(|column| column.name).filter(|name| !made_of(name)));
    }
    for column in columns {
        assert!(text.contains(&format!("`{column}`")), "docs/tables.md does not explain `{column}`");
    }
}

#[test]
fn the_table_of_measures_is_that_of_the_program() {
    let mut expected = String::from("| Column | Unit | Meaning |\n| --- | --- | --- |\n");
    for measure in Measure::ALL {
        let facts = measure.facts();
        let symbol = if facts.symbol.is_empty() { String::new() } else { format!(", {}", facts.symbol) };
        expected += &format!("| `{}` | {} | {}{symbol} |\n", words::of_key(measure), facts.unit, facts.about)
            .replace("|  |", "| |");
    }
    let text = document("docs/tables.md");
    assert!(text.contains(&expected), "docs/tables.md should hold\n{expected}");
}

#[test]
fn the_columns_of_branches_are_those_of_the_program() {
    let rows: String =
        BranchColumn::ALL.iter().map(|column| format!("| `{}` | {} |\n", column.name(), column.about())).collect();
    assert!(document("docs/tables.md").contains(&rows), "docs/tables.md should hold\n{rows}");
}

#[test]
fn the_columns_of_random_starts_are_those_of_the_program() {
    let rows: String =
        BasinColumn::ALL.iter().map(|column| format!("| `{}` | {} |\n", column.name(), column.about())).collect();
    assert!(document("docs/tables.md").contains(&rows), "docs/tables.md should hold\n{rows}");
}

#[test]
fn the_citation_is_of_this_version() {
    let citation = document("CITATION.cff");
    assert!(citation.contains(&format!("\nversion: {}\n", env!("CARGO_PKG_VERSION"))));
    assert!(citation.contains(&format!("\ndate-released: \"{RELEASED}\"\n")));
}
