//! The page of what stands: every entry has one place on it, and the questions name what they would settle.

use std::collections::{BTreeMap, BTreeSet};

use regex::Regex;
use serde_json::Value;

use crate::guide::document;

#[test]
fn the_readme_counts_the_verdicts_of_the_reports() {
    let verdicts: Value = serde_json::from_str(&document("reports/verdicts.json")).unwrap();
    let entries = verdicts["entries"].as_array().unwrap();
    let [reproduced, differ, fitted, undecidable, blocked] =
        ["reproduced", "differs", "fitted", "undecidable", "blocked"]
            .map(|verdict| entries.iter().filter(|entry| entry["verdict"] == verdict).count());
    let is_used = |entry: &&Value| entry["role"] == "fitted" || entry["role"] == "cross_validated";
    let used = entries.iter().filter(is_used).count();
    let sentence = format!(
        "Of {} published numbers and claims {reproduced} are reproduced, {differ} differ, {undecidable} are undecidable and {blocked} blocked; \
         of {used} used in fits {fitted} agree (fitted).",
        entries.len()
    );
    // Fitted are those used in fits that agree, and no other.
    let fitted = |entry: &&Value| entry["verdict"] == "fitted";
    assert!(entries.iter().filter(fitted).all(|entry| is_used(&entry)));
    let readme = document("README.md").split_whitespace().collect::<Vec<_>>().join(" ");
    assert!(readme.contains(&sentence), "README.md should say: {sentence}");
}

#[test]
fn every_entry_of_the_study_has_one_place_and_its_verdict_fits_it() {
    let page = document("reports/what-stands.md");
    let verdicts: Value = serde_json::from_str(&document("reports/verdicts.json")).unwrap();
    let verdicts: BTreeMap<&str, &str> = verdicts["entries"]
        .as_array()
        .unwrap()
        .iter()
        .map(|entry| (entry["id"].as_str().unwrap(), entry["verdict"].as_str().unwrap()))
        .collect();
    let entry = Regex::new(r"\[`([^`]+/[^`]+)`\]").unwrap();
    let ids = |text: &str| entry.captures_iter(text).map(|found| found[1].to_owned()).collect::<Vec<_>>();
    let mut placed: BTreeSet<String> = BTreeSet::new();
    for section in page.split("\n## ").skip(1) {
        // An entry may turn with several inputs, all in one section.
        let here: BTreeSet<String> = ids(section).into_iter().collect();
        for id in here {
            let verdict = verdicts[id.as_str()];
            match section {
                stands if stands.starts_with("Stands") => assert_eq!(verdict, "reproduced", "{id}"),
                fails if fails.starts_with("Does not stand") => assert_eq!(verdict, "differs", "{id}"),
                _ => {}
            }
            assert!(placed.insert(id.clone()), "{id} has two places");
        }
    }
    assert_eq!(placed.iter().map(String::as_str).collect::<Vec<_>>(), verdicts.keys().copied().collect::<Vec<_>>());
    let count = Regex::new(r"\*\*(\d+)\*\*").unwrap();
    let counted: usize =
        count.captures_iter(page.split("\n## ").next().unwrap()).map(|n| n[1].parse::<usize>().unwrap()).sum();
    assert_eq!(counted, placed.len());
}
