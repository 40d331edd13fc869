//! Imports go one way: the table of rooms in ARCHITECTURE.md against every path in the sources.

use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};

use regex::Regex;

/// The rooms in the order of the table, the most basic first.
fn rooms() -> Vec<String> {
    let text = fs::read_to_string("ARCHITECTURE.md").unwrap();
    let row = Regex::new(r"(?m)^\| `(\w+)` \|").unwrap();
    row.captures_iter(&text).map(|found| found[1].to_owned()).collect()
}

fn sources(folder: &Path) -> Vec<PathBuf> {
    let mut files = Vec::new();
    for entry in fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.is_dir() {
            files.extend(sources(&path));
        } else if path.extension().is_some_and(|ending| ending == "rs") {
            files.push(path);
        }
    }
    files
}

/// The room of a source file: `src/study/plan.rs` and `src/study.rs` belong to `study`.
fn room_of(path: &Path) -> String {
    let below = path.strip_prefix("src").unwrap().components().next().unwrap();
    below.as_os_str().to_str().unwrap().trim_end_matches(".rs").to_owned()
}

/// The text without comments, in which a room may be named freely.
fn code(text: &str) -> String {
    text.lines().filter(|line| !line.trim_start().starts_with("//")).collect::<Vec<_>>().join("\n")
}

#[test]
fn imports_go_one_way() {
    let order: BTreeMap<String, usize> = rooms().into_iter().zip(0..).collect();
    let path = Regex::new(r"\bcrate::(\w+)").unwrap();
    let mut wrong = Vec::new();
    for file in sources(Path::new("src")) {
        let room = room_of(&file);
        if room == "lib" || room == "main" {
            continue;
        }
        let Some(own) = order.get(&room) else {
            wrong.push(format!("{}: `{room}` is not in the table of ARCHITECTURE.md", file.display()));
            continue;
        };
        for found in path.captures_iter(&code(&fs::read_to_string(&file).unwrap())) {
            match order.get(&found[1]) {
                Some(other) if other <= own => {}
                Some(_) => wrong.push(format!("{}: `{room}` uses `{}`, which is above it", file.display(), &found[1])),
                None => wrong.push(format!("{}: uses `{}`, which is no room", file.display(), &found[1])),
            }
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

#[test]
fn every_room_of_the_table_is_there() {
    for room in rooms() {
        let there = Path::new("src").join(&room).is_dir() || Path::new("src").join(format!("{room}.rs")).is_file();
        assert!(there, "ARCHITECTURE.md lists `{room}`, and there is no such folder");
    }
}
