//! The JSON Schemas: every shipped file passes, bad ones do not, and they agree with the readers.

use std::cell::RefCell;
use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};

use regex::Regex;
use serde_json::{Value, json};
use shotdamp::experiment::{
    AssumptionSheet, assumptions_schema, calibration_schema, experiment_schema, load_assumptions, parse_experiment,
    scaffold, structures, study_schema,
};
use shotdamp::reference::{parse_reference, reference_schema};
use shotdamp::yaml::{Dimension, parse_quantity};

use crate::desk::{GAP, STOP};

/// Why a value does not pass; the part of JSON Schema that the schemas use, and a refusal to pass over any other.
fn check(schema: &Value, value: &Value, root: &Value, at: &str) -> Result<(), String> {
    let Value::Object(rules) = schema else { panic!("no schema at {at}: {schema}") };
    let fail = |what: String| Err(format!("{at}: {what}"));
    let sub = |schema: &Value| check(schema, value, root, at);
    let length = value.as_str().map_or(0, |text| text.chars().count());
    let (keys, items) = (value.as_object(), value.as_array());
    for (rule, argument) in rules {
        let number = || argument.as_f64().unwrap();
        let within = |holds: bool, what: &str| if holds { Ok(()) } else { fail(format!("{what} {argument}")) };
        match rule.as_str() {
            "$schema" | "title" | "description" | "examples" | "definitions" | "then" | "else" => {}
            "$ref" => {
                let name = argument.as_str().unwrap().strip_prefix("#/definitions/").unwrap();
                sub(&root["definitions"][name])?;
            }
            "type" => {
                let is = |kind: &Value| match kind.as_str().unwrap() {
                    "object" => value.is_object(),
                    "array" => value.is_array(),
                    "string" => value.is_string(),
                    "number" => value.is_number(),
                    "integer" => value.as_f64().is_some_and(|number| number.fract() == 0.0),
                    "boolean" => value.is_boolean(),
                    other => panic!("{other}"),
                };
                let fits = argument.as_array().map_or_else(|| is(argument), |kinds| kinds.iter().any(is));
                within(fits, "is not of type")?;
            }
            "const" => within(value == argument, "is not")?,
            "enum" => within(argument.as_array().unwrap().contains(value), "is none of")?,
            "minimum" => within(value.as_f64().is_none_or(|x| x >= number()), "is below")?,
            "maximum" => within(value.as_f64().is_none_or(|x| x <= number()), "is above")?,
            "exclusiveMinimum" => within(value.as_f64().is_none_or(|x| x > number()), "is not above")?,
            "exclusiveMaximum" => within(value.as_f64().is_none_or(|x| x < number()), "is not below")?,
            "minLength" => within(!value.is_string() || length as f64 >= number(), "is shorter than")?,
            "minItems" => within(items.is_none_or(|items| items.len() as f64 >= number()), "has fewer items than")?,
            "maxItems" => within(items.is_none_or(|items| items.len() as f64 <= number()), "has more items than")?,
            "minProperties" => within(keys.is_none_or(|keys| keys.len() as f64 >= number()), "has fewer keys than")?,
            "maxProperties" => within(keys.is_none_or(|keys| keys.len() as f64 <= number()), "has more keys than")?,
            "pattern" => {
                let fits = value.as_str().is_none_or(|text| matches(argument.as_str().unwrap(), text));
                within(fits, "does not match")?;
            }
            "required" => {
                for key in argument.as_array().unwrap() {
                    let there = keys.is_none_or(|keys| keys.contains_key(key.as_str().unwrap()));
                    within(there, &format!("lacks {key} of"))?;
                }
            }
            "properties" | "additionalProperties" | "propertyNames" => {
                for (key, one) in keys.into_iter().flatten() {
                    let known = rules.get("properties").and_then(|known| known.get(key));
                    let below = format!("{at}.{key}");
                    match (rule.as_str(), known, argument) {
                        ("propertyNames", ..) => check(argument, &json!(key), root, &below)?,
                        ("properties", Some(schema), _) => check(schema, one, root, &below)?,
                        ("additionalProperties", None, Value::Bool(false)) => {
                            return fail(format!("has no key {key}"));
                        }
                        ("additionalProperties", None, schema) => check(schema, one, root, &below)?,
                        _ => {}
                    }
                }
            }
            "items" => {
                for (index, item) in items.into_iter().flatten().enumerate() {
                    check(argument, item, root, &format!("{at}[{index}]"))?;
                }
            }
            "allOf" => argument.as_array().unwrap().iter().try_for_each(sub)?,
            "anyOf" | "oneOf" => {
                let results: Vec<_> = argument.as_array().unwrap().iter().map(sub).collect();
                let passed = results.iter().filter(|result| result.is_ok()).count();
                if passed == 0 || rule == "oneOf" && passed > 1 {
                    let reasons: Vec<_> = results.into_iter().filter_map(Result::err).collect();
                    return fail(format!("{passed} forms fit: {}", reasons.join(" / ")));
                }
            }
            "not" => within(sub(argument).is_err(), "must not be")?,
            "if" => {
                let branch = if sub(argument).is_ok() { "then" } else { "else" };
                rules.get(branch).map_or(Ok(()), sub)?;
            }
            other => panic!("the schema has `{other}` at {at}, which this test does not look at"),
        }
    }
    Ok(())
}

thread_local! {
    /// There are few patterns, and each is asked for thousands of times.
    static PATTERNS: RefCell<BTreeMap<String, Regex>> = RefCell::default();
}

fn matches(pattern: &str, text: &str) -> bool {
    PATTERNS.with_borrow_mut(|known| {
        known.entry(pattern.to_owned()).or_insert_with(|| Regex::new(pattern).unwrap()).is_match(text)
    })
}

/// The values of a text by another reader, which makes numbers of numbers.
fn as_an_editor(text: &str) -> Value {
    let mut options = serde_yaml::Options::default();
    options.strict_booleans = true;
    serde_yaml::from_str_with_options(text, options).unwrap()
}

fn passes(schema: &Value, text: &str) -> Result<(), String> {
    let value = as_an_editor(text);
    check(schema, &value, schema, "file")
}

fn here(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join(name)
}

/// The YAML files of a folder of chapters, and those of the same folder of the classics.
fn shipped(folder: &str) -> Vec<(String, String)> {
    let mut found = Vec::new();
    let chapters = fs::read_dir(here(folder)).unwrap().flatten().map(|entry| entry.path());
    for chapter in chapters.filter(|path| path.is_dir()).chain([here("examples/classics").join(folder)]) {
        for file in fs::read_dir(chapter).unwrap().flatten() {
            let name = file.file_name().into_string().unwrap();
            found.push((name, fs::read_to_string(file.path()).unwrap()));
        }
    }
    assert!(found.len() > 20, "{folder}");
    found
}

fn sheet() -> AssumptionSheet {
    load_assumptions(&here("experiments/assumptions.yaml")).unwrap()
}

/// With the names of the study's assumptions.
fn of_the_study() -> Value {
    experiment_schema(&sheet())
}

#[test]
fn every_shipped_file_passes_its_schema() {
    for (schema, folder) in [(of_the_study(), "experiments"), (reference_schema(), "reference")] {
        for (name, text) in shipped(folder) {
            assert_eq!(passes(&schema, &text), Ok(()), "{name}");
        }
    }
    let assumptions = fs::read_to_string(here("experiments/assumptions.yaml")).unwrap();
    assert_eq!(passes(&assumptions_schema(), &assumptions), Ok(()));
    for calibration in fs::read_dir(here("calibrations")).unwrap().flatten() {
        let text = fs::read_to_string(calibration.path()).unwrap();
        assert_eq!(passes(&calibration_schema(&sheet()), &text), Ok(()), "{}", calibration.path().display());
    }
    for study in ["study.yaml", "examples/classics/study.yaml"] {
        assert_eq!(passes(&study_schema(), &fs::read_to_string(here(study)).unwrap()), Ok(()), "{study}");
    }
    for text in [STOP, GAP] {
        assert_eq!(passes(&experiment_schema(&AssumptionSheet::default()), text), Ok(()));
    }
}

#[test]
fn committed_schemas_are_those_that_would_be_written() {
    for (name, schema) in [
        ("study", study_schema()),
        ("experiment", of_the_study()),
        ("assumptions", assumptions_schema()),
        ("reference", reference_schema()),
        ("calibration", calibration_schema(&sheet())),
    ] {
        let committed = fs::read_to_string(here(&format!("schema/{name}.json"))).unwrap();
        assert!(committed == format!("{schema:#}\n"), "run `shotdamp schema` and commit schema/{name}.json");
    }
}

/// What a person gets wrong, each one change away from a file that is right.
const MISTAKES: [(&str, &str); 33] = [
    ("title: Limit stop", "titel: Limit stop"),
    ("title: Limit stop\n", "\n"),
    ("chapter: 3", "chapter: three"),
    ("chapter: 3", "chapter: -1"),
    ("section: '3.6.3'", "part: '3.6.3'"),
    ("single_mass:", "double_mass:"),
    ("mass: 1 kg", "mass: 1"),
    ("mass: 1 kg", "mass: 1 mm"),
    ("stiffness: 1000 N/m,", "stiffness: 1000 N s/m,"),
    ("stiffness: 1000 N/m, ", ""),
    ("damping_ratio: 0.05", "damping_ratio: 5 %"),
    ("mass_ratio: 0.05", "mass_ratio: -0.05"),
    ("gap_ratio: 50", "gap_ratio: wide"),
    ("gap_ratio: 50", "gap: 50"),
    ("gap_ratio: 50", "gap_ratio: 50\n      gap: 5 mm"),
    ("gap_ratio: 50", "at: 0.5\n      gap_ratio: 50"),
    ("resilient:", "elastic:"),
    // A limit stop under two rigid faces.
    ("{resilient: {stiffness_ratio: 1, damping_ratio: assumed}}", "{rigid: {restitution: 0.5}}"),
    ("stiffness_ratio: 1, damping_ratio: assumed", "stiffness_ratio: 1"),
    ("stop: {length: assumed,", "stop: {length: 60,"),
    ("restitution: assumed", "restitution: 1.5"),
    ("impulse_train:", "impulse:"),
    ("force_ratio: swept, ", ""),
    ("frequency_ratio: 1", "frequency_ratio: 1, period: 1 s"),
    ("force_ratio: [1, 2, 4]", "force: [1, 2, 4]"),
    ("force_ratio: [1, 2, 4]", "force_ratio: {log: {from: 1, to: 4}}"),
    ("stop: [with, without]", "stop: [with, sometimes]"),
    ("event_driven,", "event_drive,"),
    ("time_step: 0.1 ms", "time_step: 0.1"),
    ("average: 100 cycles", "average: 100 seconds"),
    ("average: 100 cycles", "average: 100 cycles, until: soon"),
    ("measure: [velocity_ratio]", "measure: [velocity]"),
    ("caption: Two curves.", "caption: Two curves., colour: red"),
];

#[test]
fn bad_files_are_refused_by_schema_and_reader_alike() {
    let schema = of_the_study();
    let sheet = load_assumptions(&here("experiments/assumptions.yaml")).unwrap().assumptions();
    for (right, wrong) in MISTAKES {
        assert!(STOP.contains(right), "{right}");
        let text = STOP.replacen(right, wrong, 1);
        assert!(passes(&schema, &text).is_err(), "the schema accepts {wrong}");
        assert!(parse_experiment(&"ch3-x".parse().unwrap(), "x.yaml", &text, &sheet).is_err(), "read: {wrong}");
    }
    let reference = reference_schema();
    let good = "entries:\n  - {id: a, place: s. 3, says: Two., value: \"2\", from: {cell: {of: velocity_ratio}}}\n";
    assert_eq!(passes(&reference, good), Ok(()));
    for (right, wrong) in [
        ("id: a", "id: A b"),
        ("place: s. 3, ", ""),
        ("value: \"2\", from", "from"),
        (", from: {cell: {of: velocity_ratio}}", ""),
        ("cell:", "cel:"),
        ("says: Two.", "says: Two., expected: missing, explanation: x"),
        ("says: Two.", "says: Two., expected: differs"),
        ("says: Two.", "says: Two., tolerance: {relative: 0.1}"),
        ("says: Two.", "says: Two., blocked_by: [impulse]"),
    ] {
        let text = good.replacen(right, wrong, 1);
        assert!(passes(&reference, &text).is_err(), "the schema accepts {wrong}");
        assert!(parse_reference("ch3-x", "it.yaml", &text).is_err(), "read: {wrong}");
    }
}

/// The rules of each way to take a number and of each claim are told where one looks for them.
#[test]
fn the_rules_of_verdicts_leave_out_no_word() {
    let rules = fs::read_to_string(here("reference/README.md")).unwrap();
    let schema = reference_schema();
    let claims = &schema["properties"]["entries"]["items"]["properties"]["claim"];
    for of in [claims, &schema["definitions"]["extraction"]] {
        let words = of["properties"].as_object().unwrap();
        assert!(words.len() > 15, "{words:?}");
        for word in words.keys() {
            let row =
                |line: &str| line.starts_with("| ") && line.split('|').nth(1).unwrap().contains(&format!("`{word}`"));
            assert!(rules.lines().any(row), "`{word}` has no row in reference/README.md");
        }
    }
}

/// Whatever key of a shipped file is misspelt, the schema says so: it knows no fewer keys and no more than the reader.
#[test]
fn the_schema_knows_the_keys_of_the_reader() {
    let schema = of_the_study();
    let mut misspelt = 0;
    for (name, text) in shipped("experiments") {
        let mut whole = as_an_editor(&text);
        for path in paths(&whole) {
            let (parent, key) = path.rsplit_once('/').unwrap();
            // Named sweeps, candidates and what a text states have names of one's own.
            if path.starts_with("/stated/")
                || parent.ends_with("/union")
                || parent.ends_with("/candidates")
                || parent.is_empty() && key == "x"
            {
                continue;
            }
            let parent = whole.pointer_mut(parent).unwrap().as_object_mut().unwrap();
            let value = parent.remove(key).unwrap();
            parent.insert(format!("{key}x"), value);
            assert!(check(&schema, &whole, &schema, "file").is_err(), "{name}: {path} may be misspelt");
            misspelt += 1;
            whole = as_an_editor(&text);
        }
    }
    assert!(misspelt > 500, "{misspelt}");
}

/// The same of reference files, which are asked both: JSON is YAML, so that one key is misspelt without a look at the layout.
#[test]
fn the_schema_and_the_reader_of_a_reference_know_the_same_keys() {
    let schema = reference_schema();
    let read = |value: &Value| parse_reference("ch3-x", "it.yaml", &value.to_string());
    let mut misspelt = 0;
    for (name, text) in shipped("reference") {
        let mut whole = as_an_editor(&text);
        for path in paths(&whole) {
            let (parent, key) = path.rsplit_once('/').unwrap();
            // Columns are named here: they are looked for in the tables.
            if ["/where", "/best_place/at", "/grows_towards/to"].iter().any(|end| parent.ends_with(end)) {
                continue;
            }
            let at = whole.pointer_mut(parent).unwrap().as_object_mut().unwrap();
            let value = at.remove(key).unwrap();
            at.insert(format!("{key}x"), value);
            assert!(check(&schema, &whole, &schema, "file").is_err(), "{name}: {path} may be misspelt");
            let problems = read(&whole).expect_err(&path);
            assert!(problems.list.iter().any(|one| one.message.contains(&format!("`{key}x`"))), "{path}: {problems}");
            misspelt += 1;
            let at = whole.pointer_mut(parent).unwrap().as_object_mut().unwrap();
            let value = at.remove(&format!("{key}x")).unwrap();
            at.insert(key.to_owned(), value);
        }
    }
    assert!(misspelt > 1000, "{misspelt}");
}

/// The paths of all keys.
fn paths(value: &Value) -> Vec<String> {
    let below = |(key, value): (String, &Value)| {
        let own = if value.is_null() { Vec::new() } else { paths(value) };
        own.into_iter().map(move |path| format!("/{key}{path}")).collect::<Vec<_>>()
    };
    match value {
        Value::Object(map) => map
            .iter()
            .flat_map(|(key, value)| [format!("/{key}")].into_iter().chain(below((key.clone(), value))))
            .collect(),
        Value::Array(items) => items.iter().enumerate().flat_map(|(i, one)| below((i.to_string(), one))).collect(),
        _ => Vec::new(),
    }
}

#[test]
fn a_quantity_passes_where_the_reader_takes_it() {
    let schema = of_the_study();
    let mass = &schema["definitions"]["structure"]["properties"]["single_mass"]["properties"];
    for (key, dimension) in [("mass", Dimension::Mass), ("stiffness", Dimension::Stiffness)] {
        for text in [
            "1 kg", "50 g", "1e-3 kg", ".5kg", "5. g", "1 mg", "2 µg", "1", "kg", "1 m", "1000 N/m", "1 kN/m",
            "1 N/mm", "1 kg/s^2", "1 kg/s²", "1 N s/m", "1 N", "-1e3 N/m", "1 N/m/m", "one kg", "1,5 kg", "1 kg m",
        ] {
            let accepted = parse_quantity(text, dimension).is_ok();
            assert_eq!(check(&mass[key], &json!(text), &schema, key).is_ok(), accepted, "{text} as {dimension:?}");
        }
    }
}

/// The schema of a study offers its assumptions where their kind fits, and refuses one of another kind as the reader does.
#[test]
fn assumptions_are_offered_by_kind() {
    let (schema, sheet) = (of_the_study(), sheet().assumptions());
    for (name, fits) in [("stop_length", true), ("gravity", false), ("no_such_name", false)] {
        let text = STOP.replace("length: assumed", &format!("length: {{assumed: {name}}}"));
        assert_eq!(passes(&schema, &text).is_ok(), fits, "{name}");
        assert_eq!(parse_experiment(&"ch3-x".parse().unwrap(), "x.yaml", &text, &sheet).is_ok(), fits, "{name}");
    }
}

#[test]
fn a_scaffold_is_a_valid_experiment_on_every_structure() {
    let schema = of_the_study();
    let sheet = load_assumptions(&here("experiments/assumptions.yaml")).unwrap().assumptions();
    for structure in structures() {
        let text = scaffold(&"ch9-an-idea".parse().unwrap(), structure, "../../schema/experiment.json").unwrap();
        assert_eq!(passes(&schema, &text), Ok(()), "{text}");
        let read = parse_experiment(&"ch9-an-idea".parse().unwrap(), "x.yaml", &text, &sheet);
        assert_eq!(read.map(|experiment| experiment.cases.len()).map_err(|problems| problems.to_string()), Ok(31));
    }
}
