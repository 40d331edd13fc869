//! A study handed on: whole and up to date, or not at all.

use std::collections::BTreeSet;
use std::fs;

use serde_json::Value;

use crate::cli::relative_files;
use crate::desk::{Desk, STOP, command, shotdamp};

/// A study that has been run, without numbers to hold it against.
fn finished() -> Desk {
    let desk = Desk::new();
    fs::remove_file(desk.layout.path("reference/ch3/ch3-stop.yaml")).unwrap();
    assert_eq!(shotdamp(&desk, &["run", "--quiet"]).err, "");
    desk
}

#[test]
fn a_crate_holds_and_describes_every_file_and_the_unit_of_every_column() {
    let desk = finished();
    let crated = tempfile::tempdir().unwrap();
    let folder = crated.path().join("deep/crate");
    let said = shotdamp(&desk, &["export", "--ro-crate", folder.to_str().unwrap(), "--published", "2024-02-29"]);
    assert_eq!((said.code, said.err.as_str()), (0, ""));
    let text = fs::read_to_string(folder.join("ro-crate-metadata.json")).unwrap();
    let description: Value = serde_json::from_str(&text).unwrap();
    let graph = description["@graph"].as_array().unwrap();
    let ids: BTreeSet<&str> = graph.iter().map(|entity| entity["@id"].as_str().unwrap()).collect();
    assert_eq!(ids.len(), graph.len(), "each once");
    let root = graph.iter().find(|entity| entity["@id"] == "./").unwrap();
    assert_eq!(root["datePublished"], "2024-02-29");
    for name in [
        "experiments/ch3/ch3-gap.yaml",
        "reference/ch3/ch3-gap.yaml",
        "results/ch3-stop.parquet",
        "results/ch3-stop.json",
        "reports/README.md",
        "reports/assumptions.md",
        "reports/verdicts.json",
        "reports/ch3/ch3-gap.png",
        "reports/ch3/ch3-gap.svg",
    ] {
        let held = fs::read(folder.join(name)).unwrap();
        assert!(held == desk.bytes(name) && ids.contains(name), "{name}");
        assert!(root["hasPart"].as_array().unwrap().iter().any(|part| part["@id"] == name), "{name}");
    }
    let at = graph.iter().find(|entity| entity["name"] == "velocity_ratio (ψ)").unwrap();
    assert_eq!(at["unitText"], "1");
    // Every reference within the crate leads somewhere.
    for entity in graph {
        for value in entity.as_object().unwrap().values() {
            for one in value.as_array().unwrap_or(&vec![value.clone()]) {
                let Some(id) = one["@id"].as_str() else { continue };
                assert!(ids.contains(id) || id.starts_with("https://w3id.org/ro/crate/"), "{id} is described");
            }
        }
    }
    // The same study gives the same crate.
    let again = crated.path().join("again");
    shotdamp(&desk, &["export", "--ro-crate", again.to_str().unwrap(), "--published", "2024-02-29"]);
    assert_eq!(fs::read_to_string(again.join("ro-crate-metadata.json")).unwrap(), text);
}

#[test]
fn what_is_not_up_to_date_or_in_the_way_is_told_and_nothing_is_written() {
    let desk = finished();
    let folder = desk.layout.path("crate");
    let export = || shotdamp(&desk, &["export", "--ro-crate", folder.to_str().unwrap()]);
    desk.put("experiments/ch3/ch3-stop.yaml", &STOP.replace("mass: 1 kg", "mass: 2 kg"));
    let before = relative_files(&desk);
    let said = export();
    assert_eq!(said.code, 2);
    assert!(said.err.contains("not up to date: ch3-stop; `shotdamp run`"), "{}", said.err);
    assert!(relative_files(&desk) == before);
    desk.put("crate", "something");
    desk.put("experiments/ch3/ch3-stop.yaml", STOP);
    assert!(export().err.contains("is there already"));
    assert_eq!(desk.bytes("crate"), b"something");
    let wrong = shotdamp(&desk, &["export", "--ro-crate", "x", "--published", "29.2.2024"]);
    assert!(wrong.code == 2 && wrong.err.contains("write a date as 2026-11-21"), "{}", wrong.err);
    for date in ["2026-02-30", "2100-02-29", "2026-04-31", "2026-13-01", "2026-+1-01"] {
        let wrong = shotdamp(&desk, &["export", "--ro-crate", "x", "--published", date]);
        assert!(wrong.code == 2 && wrong.err.contains("there is no such day"), "{date}: {}", wrong.err);
    }
}

#[test]
fn a_crate_of_the_whole_study_is_a_study() {
    let desk = finished();
    desk.put(
        "study.yaml",
        "title: Mine\nauthor: [A. Person, {organisation: A Laboratory}]\nlicence: [CC-BY-4.0, 'https://example.org/terms']\n",
    );
    desk.put(
        "calibrations/it.yaml",
        "title: T\nabout: A.\ncalibrate: {harmonic_reference: [base, loaded]}\nfit: [ch3-gap/grows]\n",
    );
    assert_eq!(shotdamp(&desk, &["run", "--quiet"]).err, "");
    let crated = tempfile::tempdir().unwrap();
    let folder = crated.path().join("crate");
    let said = shotdamp(&desk, &["export", "--ro-crate", folder.to_str().unwrap()]);
    assert_eq!((said.code, said.err.as_str()), (0, ""));
    let root = ["--root", folder.to_str().unwrap()];
    let check = |desk: &Desk, root: &[&str]| {
        let said = shotdamp(desk, &[root, &["check"]].concat());
        (said.code, said.out, said.err)
    };
    let mut inside = std::process::Command::new(command(&desk, &[]).get_program());
    inside.args(root).arg("check").env_remove("GITHUB_STEP_SUMMARY");
    let inside = crate::desk::said(inside);
    assert_eq!((inside.code, inside.out, inside.err), check(&desk, &[]), "the same verdicts from the crate alone");
    let text = fs::read_to_string(folder.join("ro-crate-metadata.json")).unwrap();
    let description: Value = serde_json::from_str(&text).unwrap();
    let find = |id: &str| description["@graph"].as_array().unwrap().iter().find(|one| one["@id"] == id).unwrap();
    assert_eq!(find("./")["author"], serde_json::json!([{"@id": "#author-1"}, {"@id": "#author-2"}]));
    assert_eq!(find("#author-2")["name"], "A Laboratory");
    assert_eq!(find("./")["license"][0]["@id"], "https://spdx.org/licenses/CC-BY-4.0");
    assert!(folder.join("calibrations/it.yaml").is_file());
    // A page that is behind would not be that of these tables.
    desk.put("reports/README.md", "Mine.\n");
    let behind = shotdamp(&desk, &["export", "--ro-crate", crated.path().join("more").to_str().unwrap()]);
    assert!(behind.code == 2 && behind.err.contains("not up to date: reports/README.md"), "{}", behind.err);
}

#[test]
fn a_crate_of_one_experiment_has_no_dead_link_and_names_no_author_that_the_study_does_not() {
    let desk = finished();
    let crated = tempfile::tempdir().unwrap();
    let folder = crated.path().join("crate");
    assert_eq!(shotdamp(&desk, &["export", "--ro-crate", folder.to_str().unwrap(), "ch3-stop"]).code, 0);
    let page = fs::read_to_string(folder.join("reports/ch3/ch3-stop.md")).unwrap();
    let links = regex::Regex::new(r"\]\(([^)#:]+)").unwrap();
    for link in links.captures_iter(&page).map(|found| found[1].to_owned()) {
        assert!(folder.join("reports/ch3").join(&link).is_file(), "{link}");
    }
    let text = fs::read_to_string(folder.join("ro-crate-metadata.json")).unwrap();
    assert!(!text.contains("shotdamp authors") && !text.contains("license"), "{text}");
}
