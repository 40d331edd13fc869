//! Results of experiments and calibrations that no longer exist, and earlier tables.

use std::collections::BTreeSet;
use std::fs;

use super::layout::{Layout, stem};
use super::record::Record;
use super::texts::Texts;
use super::{earlier, spent};
use crate::experiment::ExperimentId;

/// What an experiment leaves in `results/`.
const ENDINGS: [&str; 3] = ["parquet", "json", "journal"];
/// What a calibration leaves, and where.
const OF_CALIBRATIONS: [(&str, &[&str]); 2] =
    [("results/calibrations", &["journal"]), ("reports/calibrations", &["md", "json"])];

/// Tables, earlier ones too, records, journals and times of experiments that no file has the name of, and the figures and pages that their records
/// list; journals, pages and records of such calibrations; by their names within the study. A file that cannot be understood still counts
/// as an experiment: it may be repaired.
#[must_use]
pub fn orphans(layout: &Layout, texts: &Texts) -> BTreeSet<String> {
    let known = texts.ids();
    let mut found = BTreeSet::new();
    let is_orphan = |name: &str| stem(name).parse::<ExperimentId>().is_ok_and(|id| !known.contains(id.0.as_str()));
    for folder in names_in(layout, earlier::FOLDER).into_iter().filter(|name| is_orphan(name)) {
        found.extend(names_in(layout, &folder));
    }
    found.extend(names_in(layout, spent::FOLDER).into_iter().filter(|name| is_orphan(name)));
    let calibrations = texts.calibrations();
    for (folder, endings) in OF_CALIBRATIONS {
        let is_left = |name: &String| {
            name.rsplit_once('.').is_some_and(|(_, ending)| endings.contains(&ending))
                && stem(name).parse::<ExperimentId>().is_ok_and(|id| !calibrations.contains(id.0.as_str()))
        };
        found.extend(names_in(layout, folder).into_iter().filter(is_left));
    }
    let Ok(entries) = fs::read_dir(layout.results()) else { return found };
    for entry in entries.flatten() {
        let Ok(name) = entry.file_name().into_string() else { continue };
        let ours = name.rsplit_once('.').is_some_and(|(_, ending)| ENDINGS.contains(&ending));
        let Ok(id) = stem(&name).parse::<ExperimentId>() else { continue };
        if !ours || known.contains(id.0.as_str()) {
            continue;
        }
        found.insert(format!("results/{name}"));
        if let Ok(record) = Record::read(&entry.path(), &id) {
            let files = record.files().filter(|file| file.starts_with("reports/") && layout.path(file).is_file());
            found.extend(files.cloned());
        }
    }
    found
}

/// The tables that experiments had before the ones in force, by their names within the study.
#[must_use]
pub fn earlier_tables(layout: &Layout) -> BTreeSet<String> {
    names_in(layout, earlier::FOLDER).iter().flat_map(|folder| names_in(layout, folder)).collect()
}

/// What lies in a folder of the study, by its name within the study.
fn names_in(layout: &Layout, folder: &str) -> Vec<String> {
    let entries = fs::read_dir(layout.path(folder)).into_iter().flatten().flatten();
    entries.filter_map(|entry| Some(format!("{folder}/{}", entry.file_name().into_string().ok()?))).collect()
}
