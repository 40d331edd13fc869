//! Numbers in explanations: filled in from the tables, refused where they name nothing, and never written by hand where a
//! placeholder would give them.

use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};

use shotdamp::experiment::{AboutStudy, parse_study};
use shotdamp::reference::{Check, Entry, Judged, Kind, Prose, load_reference, numbers, parse_reference};
use shotdamp::report::{ExperimentView, index};
use shotdamp::study::{Heading, Layout, Study, Texts};

use crate::desk::{ASSUMPTIONS, Desk, shotdamp};

const ENTRY: &str = "entries:\n  - id: optimum\n    place: s. 1\n    says: It is 2.5.\n    value: \"2.5\"\n    from: {maximum: {of: velocity_ratio, over: gap_ratio}}\n    explanation: ";

#[test]
fn a_placeholder_that_is_none_is_an_error_with_its_line() {
    for (explanation, said) in [
        ("\"It is {there}.\"", "unknown placeholder `{there}`"),
        ("\"It is {here.\"", "an opening `{` without its `}`"),
        ("\"It is {here: minimum}.\"", "a placeholder of `minimum`"),
        // Under a move one number comes out.
        ("\"It is {here 2: optimum, gravity=0}.\"", "unknown placeholder `{here 2: optimum, gravity=0}`"),
    ] {
        let problems =
            parse_reference("ch3-gap", "it.yaml", &format!("{ENTRY}{explanation}\n")).unwrap_err().to_string();
        assert!(problems.contains(said) && problems.contains("it.yaml:7:18\n"), "{problems}");
    }
    assert!(parse_reference("ch3-gap", "it.yaml", &format!("{ENTRY}\"It is {{here: optimum}}, {{off}}.\"\n")).is_ok());
}

#[test]
fn a_list_of_entries_that_names_none_is_an_error_with_its_line() {
    let asked = "title: T\nabout: A.\ncalibrate: {stop_length: [50 mm, 60 mm]}\nfit: [ch3-gap/grows]\n";
    let about = "title: T\nabout: A.\nfindings: [{says: It grows., entries: [ch3-gap/grows]}]\n";
    let fitted = ASSUMPTIONS.replacen("reason: fits,", "fitted_to: [ch3-gap/grows], reason: fits,", 1);
    for (file, text) in
        [("experiments/assumptions.yaml", fitted.as_str()), ("calibrations/it.yaml", asked), ("study.yaml", about)]
    {
        let desk = Desk::new();
        desk.put(file, text);
        let fine = shotdamp(&desk, &["check"]);
        assert!(!fine.err.contains("no entry"), "{file}: {}", fine.err);
        desk.put(file, &text.replace("ch3-gap/grows", "ch3-gap/grow"));
        let lost = shotdamp(&desk, &["check"]);
        assert_eq!(lost.code, 2, "{file}: {}", lost.err);
        assert!(lost.err.contains("`ch3-gap/grow` is no entry") && lost.err.contains(file), "{file}: {}", lost.err);
    }
}

#[test]
fn numbers_are_read_with_their_units_and_without_conditions() {
    for (found, read) in [
        ("628 ± 65 mm/s, 21 % below 794.8 mm/s", vec!["628 mm/s", "21 %", "794.8 mm/s"]),
        ("true: 2.027 (h′ = 10), 3.378 (50)", vec!["2.027", "3.378"]),
        ("false: falls back by 27 % of the range up to f′ = 0.794 (2 % allowed)", vec!["27 %", "0.794"]),
        ("true: 13.01 m/(N s) > 10.32 m/(N s)", vec!["13.01 m/(N s)", "10.32 m/(N s)"]),
        ("true: best 3.7 at (0.5, 0.5)", vec!["3.7"]),
        ("up to 3.3e-14 % apart", vec!["3.3e-14 %"]),
        ("8.0 ± 0.2 mm/N, 60 % below 20 mm/N", vec!["8.0 mm/N", "60 %", "20 mm/N"]),
        ("3 N s and 4 masses", vec!["3 N s", "4"]),
    ] {
        assert_eq!(numbers(found), read, "{found}");
    }
}

/// The committed verdicts.
fn verdicts() -> Vec<Judged> {
    let text = fs::read_to_string(Path::new(env!("CARGO_MANIFEST_DIR")).join("reports/verdicts.json")).unwrap();
    let document: serde_json::Value = serde_json::from_str(&text).unwrap();
    document["entries"].as_array().unwrap().iter().map(|one| serde_json::from_value(one.clone()).unwrap()).collect()
}

fn entries() -> Vec<Entry> {
    let mut files: Vec<PathBuf> = Vec::new();
    for chapter in ["ch3", "ch4", "ch5", "ch6"] {
        let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("reference").join(chapter);
        files.extend(fs::read_dir(folder).unwrap().map(|file| file.unwrap().path()));
    }
    files.sort();
    files.iter().flat_map(|file| load_reference(file).unwrap().entries).collect()
}

#[test]
fn the_conclusions_of_the_study_name_entries_of_the_reference() {
    let text = fs::read_to_string(Path::new(env!("CARGO_MANIFEST_DIR")).join("study.yaml")).unwrap();
    let known: Vec<String> = entries().into_iter().map(|entry| entry.id).collect();
    let findings = parse_study("study.yaml", &text).unwrap().findings;
    assert!(!findings.is_empty());
    for id in findings.iter().flat_map(|finding| &finding.entries) {
        assert!(known.contains(id), "no entry `{id}`");
    }
}

#[test]
fn every_placeholder_of_the_reference_gives_a_number() {
    let verdicts = verdicts();
    for entry in entries() {
        let (experiment, _) = entry.id.split_once('/').unwrap();
        let text = entry.prose().filled(|name| {
            let id = match name {
                None => entry.id.clone(),
                Some(name) if name.contains('/') => name.to_owned(),
                Some(name) => format!("{experiment}/{name}"),
            };
            verdicts.iter().find(|one| one.id == id)
        });
        assert!(!text.contains("n/a"), "{}: {text}", entry.id);
    }
}

/// A number within a tenth of what came out is that number, written by hand: today's, or a stale one.
#[test]
fn no_explanation_writes_by_hand_what_a_placeholder_gives() {
    let verdicts = verdicts();
    let mut found: Vec<String> = Vec::new();
    for entry in entries() {
        let Check::Value { published, .. } = &entry.check else { continue };
        let Some(comparison) = verdicts.iter().find(|one| one.id == entry.id).and_then(|one| one.comparison) else {
            continue;
        };
        let here = comparison.simulated * published.half_unit() / comparison.u_data;
        let own = |text: &str| -> Option<f64> { text.split(' ').next()?.replace('\u{202f}', "").parse().ok() };
        // What the study says may be quoted, and a number of another kind has another unit or its own place.
        let quoted: Vec<f64> = numbers(&entry.says).iter().filter_map(|text| own(text)).collect();
        let bare = Prose::parse(&entry.explanation).unwrap().filled(|_| None);
        let near = |x: &f64| (x - here).abs() <= 0.002 * here.abs() && (x - published.value()).abs() > 1e-9;
        let written = numbers(&bare).into_iter().filter(|text| text.contains(published.unit()));
        let written = written.filter_map(|text| own(&text)).filter(|x| near(x) && !quoted.contains(x));
        found.extend(written.map(|x| format!("{}: {x}, write {{here}}", entry.id)));
    }
    assert!(found.is_empty(), "{}", found.join("\n"));
}

/// Entries as the committed verdicts have them, with the explanations of today.
fn judged_today() -> BTreeMap<String, Vec<Judged>> {
    let verdicts = verdicts();
    let mut judged = BTreeMap::<String, Vec<Judged>>::new();
    for entry in entries() {
        let (experiment, _) = entry.id.split_once('/').unwrap();
        let find = |name: Option<&str>| {
            let id = match name {
                None => entry.id.clone(),
                Some(name) if name.contains('/') => name.to_owned(),
                Some(name) => format!("{experiment}/{name}"),
            };
            verdicts.iter().find(|one| one.id == id)
        };
        let Some(one) = find(None) else { continue };
        let explanation = entry.prose().filled(find);
        let blocked_by = entry.blocked_by.clone();
        judged.entry(experiment.into()).or_default().push(Judged { explanation, blocked_by, ..one.clone() });
    }
    judged
}

#[test]
fn the_index_of_the_whole_study_loads_at_once() {
    let layout = Layout::new(env!("CARGO_MANIFEST_DIR"));
    let study = Study::new(layout.clone(), Texts::read(&layout).unwrap());
    let judged = judged_today();
    let views: Vec<ExperimentView<'_>> = study
        .items
        .iter()
        .map(|item| {
            let experiment = &item.source.experiment;
            let page = format!("{}/{}.md", item.source.folder(), experiment.id);
            let judged = judged.get(&experiment.id.0).map_or(&[][..], Vec::as_slice);
            ExperimentView { experiment: Heading::of(experiment), judged, seconds: Some(1.234), motions: None, page }
        })
        .collect();
    let index = index(&AboutStudy::default(), &views, &[], None);
    assert!(index.len() < 30_000, "{} bytes", index.len());
    let numbers = views.iter().flat_map(|view| view.judged).filter(|one| one.kind == Kind::Number).count();
    assert!(index.contains(&format!("**{numbers} numbers**")), "{index}");
    assert!(index.find("## How to read") < index.find("## Experiments"), "first how to read, then what there is");
    for view in &views {
        assert!(index.contains(&format!("]({}", view.page)), "no link to {}", view.page);
    }
}

/// The figures of a printed number, if there are three or more: fewer stand in any text by chance.
fn figures(printed: &str) -> Option<&str> {
    let end = printed.find(|c: char| !(c.is_ascii_digit() || c == '.')).unwrap_or(printed.len());
    let digits = printed[..end].trim_start_matches(['0', '.']).chars().filter(char::is_ascii_digit).count();
    (digits >= 3).then_some(&printed[..end])
}

#[test]
fn an_assumption_whose_reason_quotes_a_number_of_the_study_is_fitted_to_it() {
    let layout = Layout::new(env!("CARGO_MANIFEST_DIR"));
    let study = Study::new(layout.clone(), Texts::read(&layout).unwrap());
    let number = regex::Regex::new(r"\d+(?:\.\d+)?").unwrap();
    let placeholder = regex::Regex::new(r"\{[^}]*\}").unwrap();
    let entries = entries();
    let mut forgotten = Vec::new();
    for (name, assumption) in study.sheet.iter() {
        // A name of an entry quotes nothing.
        let reason = placeholder.replace_all(&assumption.reason, "");
        let quoted: Vec<&str> = number.find_iter(&reason).map(|found| found.as_str()).collect();
        for entry in &entries {
            let printed = match &entry.check {
                Check::Value { published, .. } => Some(published),
                Check::Peak { peak, .. } => peak.at.as_ref(),
                Check::Claim { .. } => None,
            };
            let Some(figures) = printed.and_then(|printed| figures(printed.text())) else { continue };
            if quoted.contains(&figures) && !assumption.fitted_to.contains(&entry.id) {
                forgotten.push(format!("{name}: {} ({figures})", entry.id));
            }
        }
    }
    assert!(forgotten.is_empty(), "{forgotten:#?}");
}

#[test]
fn a_number_that_an_input_was_chosen_by_is_no_evidence_in_another_entry_either() {
    let layout = Layout::new(env!("CARGO_MANIFEST_DIR"));
    let study = Study::new(layout.clone(), Texts::read(&layout).unwrap());
    let is_fitted = |entry: &&Entry| study.sheet.iter().any(|(_, assumption)| assumption.fitted_to.contains(&entry.id));
    for reference in study.references.values() {
        let printed = |entry: &Entry| match &entry.check {
            Check::Value { published, .. } => figures(published.text()).map(|_| published.text().to_owned()),
            _ => None,
        };
        let (fitted, free): (Vec<&Entry>, Vec<&Entry>) = reference.entries.iter().partition(is_fitted);
        let used: Vec<String> = fitted.into_iter().filter_map(printed).collect();
        for entry in free {
            let repeated = printed(entry).is_some_and(|number| used.contains(&number));
            assert!(!repeated, "{} repeats a number that an input was chosen by", entry.id);
        }
    }
}
