//! Imports go one way: the tables of rooms in ARCHITECTURE.md and dynamics/src/lib.rs against every path that leads from one room to
//! another.

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::{Path, PathBuf};

use regex::Regex;
use shotdamp::experiment::{AssumptionSheet, assumptions_schema, experiment_schema, load_assumptions, parse_study};

/// A package with rooms: its sources, and where the table of its rooms stands, the most basic first.
struct House {
    sources: &'static str,
    table: &'static str,
}

const HOUSES: [House; 2] = [
    House { sources: "src", table: "ARCHITECTURE.md" },
    House { sources: "dynamics/src", table: "dynamics/src/lib.rs" },
];

impl House {
    fn rooms(&self) -> Vec<String> {
        let text = fs::read_to_string(self.table).unwrap();
        let row = Regex::new(r"(?m)^(?://! )?\| `(\w+)` \|").unwrap();
        row.captures_iter(&text).map(|found| found[1].to_owned()).collect()
    }

    /// The room of a source file: `src/study/plan.rs` and `src/study.rs` belong to `study`.
    fn room_of(&self, path: &Path) -> String {
        let below = path.strip_prefix(self.sources).unwrap().components().next().unwrap();
        below.as_os_str().to_str().unwrap().trim_end_matches(".rs").to_owned()
    }

    /// Every path that leads to no room, to one that stands below its own, or out of a room without naming where to.
    fn wrong_ways(&self) -> Vec<String> {
        let Self { table, .. } = self;
        let rooms = self.rooms();
        let order: BTreeMap<&str, usize> = rooms.iter().map(String::as_str).zip(0..).collect();
        let mut wrong = Vec::new();
        if order.len() < rooms.len() {
            wrong.push(format!("{table} lists a room twice"));
        }
        // The engine is a room of `src`, and a package besides.
        let path = Regex::new(r"\bcrate::(\w+|\{|\*)|(?:^|[^:\w])(dynamics)::").unwrap();
        let upwards = Regex::new(r"(?:\bsuper::)+").unwrap();
        for file in sources(Path::new(self.sources)) {
            let room = self.room_of(&file);
            if room == "lib" || room == "main" {
                continue;
            }
            let Some(own) = order.get(&*room) else {
                wrong.push(format!("{}: `{room}` is not in the table of {table}", file.display()));
                continue;
            };
            let text = fs::read_to_string(&file).unwrap();
            let code = code(text.split("#[cfg(test)]").next().unwrap());
            for found in path.captures_iter(&code) {
                let other = found.get(1).or(found.get(2)).map_or("", |other| other.as_str());
                match order.get(other) {
                    Some(place) if place <= own => {}
                    Some(_) => wrong.push(format!("{}: `{room}` uses `{other}`, which is below it", file.display())),
                    None => wrong.push(format!("{}: uses `{other}`, which is no room", file.display())),
                }
            }
            let below = file.strip_prefix(self.sources).unwrap().components().count();
            let depth = below - usize::from(file.ends_with("mod.rs"));
            if upwards.find_iter(&code).any(|found| found.as_str().matches("super::").count() >= depth) {
                wrong.push(format!("{}: leaves its room by `super::`", file.display()));
            }
        }
        wrong
    }
}

fn sources(folder: &Path) -> Vec<PathBuf> {
    files(folder, "rs")
}

fn files(folder: &Path, ending: &str) -> Vec<PathBuf> {
    let mut found = Vec::new();
    for entry in fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.is_dir() {
            found.extend(files(&path, ending));
        } else if path.extension().is_some_and(|own| own == ending) {
            found.push(path);
        }
    }
    found
}

/// The text without comments, in which a room may be named freely.
fn code(text: &str) -> String {
    text.lines().filter(|line| !line.trim_start().starts_with("//")).collect::<Vec<_>>().join("\n")
}

#[test]
fn imports_go_one_way() {
    let wrong: Vec<String> = HOUSES.iter().flat_map(House::wrong_ways).collect();
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

/// Files and folders side by side that import each other in a ring. What stands at a place of a file has keys or is a choice, and each of
/// these leads to places again: that ring is in the matter.
const KNOTS: [&str; 1] = ["src/yaml: at choice keys"];

/// Within a folder, too.
#[test]
fn files_of_a_folder_import_each_other_one_way() {
    let mut found: Vec<String> = HOUSES.iter().flat_map(|house| knots(Path::new(house.sources))).collect();
    found.sort();
    assert_eq!(found, KNOTS);
}

/// The rings of a folder and of those below it, one line each: the folder, and who is in it.
fn knots(folder: &Path) -> Vec<String> {
    let mut found = Vec::new();
    let mut uses: BTreeMap<String, BTreeSet<String>> = BTreeMap::new();
    for entry in fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        let name = path.file_stem().unwrap().to_str().unwrap().to_owned();
        if path.is_dir() {
            found.extend(knots(&path));
            // A module of its own, seen from those beside it.
            uses.insert(name, sources(&path).iter().flat_map(|file| named(file, folder)).collect());
        } else if path.extension().is_some_and(|ending| ending == "rs") && !matches!(&*name, "mod" | "lib" | "main") {
            uses.insert(name, named(&path, folder));
        }
    }
    // Who is reached by which way.
    let reached = |from: &str| -> BTreeSet<String> {
        let (mut seen, mut next) = (BTreeSet::new(), vec![from.to_owned()]);
        while let Some(one) = next.pop() {
            next.extend(uses.get(&one).into_iter().flatten().filter(|other| seen.insert((*other).clone())).cloned());
        }
        seen
    };
    let reach: BTreeMap<&str, BTreeSet<String>> = uses.keys().map(|name| (name.as_str(), reached(name))).collect();
    let ring = |name: &str| -> Vec<&str> {
        let both = |other: &&&str| reach[name].contains(**other) && reach[**other].contains(name);
        reach.keys().filter(both).copied().collect()
    };
    let rings: BTreeSet<Vec<&str>> = reach.keys().map(|name| ring(name)).filter(|ring| ring.len() > 1).collect();
    found.extend(rings.iter().map(|ring| format!("{}: {}", folder.display(), ring.join(" "))));
    found
}

/// What stands in a folder and is named by a file in it, or below it.
fn named(file: &Path, folder: &Path) -> BTreeSet<String> {
    let text = fs::read_to_string(file).unwrap();
    let code = code(text.split("#[cfg(test)]").next().unwrap());
    let depth = file.strip_prefix(folder).unwrap().components().count() - usize::from(file.ends_with("mod.rs"));
    // From `crate` the way leads through the rooms, from the file itself by so many `super`.
    let rooms = folder.iter().skip_while(|part| *part != "src").skip(1).map(|part| part.to_str().unwrap());
    let from_above = rooms.fold("crate::".to_owned(), |way, room| way + room + "::");
    let from_below = "super::".repeat(depth);
    let way = format!(r"(?:{from_above}|(?:^|[^:\w]){from_below})(?:(\w+)|\{{([^;]*)\}};)");
    let mut found = BTreeSet::new();
    for one in Regex::new(&way).unwrap().captures_iter(&code) {
        let list = one.get(1).or(one.get(2)).map_or("", |list| list.as_str());
        // Of a list each item up to its first `::`; what is no file or folder leads nowhere.
        found.extend(list.split([',', '{', '}']).map(|item| item.trim().split("::").next().unwrap().to_owned()));
    }
    let own = file.strip_prefix(folder).unwrap().components().next().unwrap();
    found.remove(Path::new(own.as_os_str()).file_stem().unwrap().to_str().unwrap());
    found
}

/// What a study calls its things stands in its files. Its names may be words of the language, as `gravity` is.
#[test]
fn the_program_knows_no_study() {
    let sheet = load_assumptions(Path::new("experiments/assumptions.yaml")).unwrap();
    let (slots, scenes) = (assumptions_schema(), experiment_schema(&AssumptionSheet::default()));
    let is_a_word = |name: &str| {
        let parameters = &scenes["definitions"]["sweep"]["properties"];
        !slots["properties"]["defaults"]["properties"][name].is_null() || !parameters[name].is_null()
    };
    let assumptions = sheet.iter().map(|(name, _)| name.as_str()).filter(|name| !is_a_word(name)).map(str::to_owned);
    let assumptions: Vec<String> = assumptions.collect();
    let about = parse_study("study.yaml", &fs::read_to_string("study.yaml").unwrap()).unwrap();
    let titles = about.chapters.values().chain(&about.title).map(|title| format!("\"(, )?{title}\""));
    // The arrays that chapter 6 optimises are named in the ids of its experiments: `ch6-beam-b1-heavy`.
    let array = Regex::new(r"^ch6-(?:beam|plate)-([a-z]\d)-").unwrap();
    let ids = files(Path::new("experiments"), "yaml");
    let ids = ids.iter().filter_map(|path| path.file_stem()?.to_str());
    let arrays: BTreeSet<String> = ids.filter_map(|id| Some(array.captures(id)?[1].to_uppercase())).collect();
    assert!(assumptions.len() > 10 && arrays.len() >= 4, "{arrays:?}");
    let names: Vec<String> =
        assumptions.into_iter().chain(arrays).map(|name| format!(r"\b{name}\b")).chain(titles).collect();
    let known = Regex::new(&names.join("|")).unwrap();
    for file in HOUSES.iter().flat_map(|house| sources(Path::new(house.sources))) {
        let text = fs::read_to_string(&file).unwrap();
        let code = text.split("#[cfg(test)]").next().unwrap();
        assert_eq!(known.find(code).map(|found| found.as_str()), None, "{}", file.display());
    }
}

#[test]
fn every_room_of_the_table_is_there() {
    for house in HOUSES {
        for room in house.rooms() {
            let place = Path::new(house.sources).join(&room);
            let there =
                place.is_dir() || place.with_extension("rs").is_file() || Path::new(&room).join("Cargo.toml").is_file();
            assert!(there, "{} lists `{room}`, and there is no such folder", house.table);
        }
    }
}
