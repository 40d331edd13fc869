//! A study as it lies before us: experiments, assumptions and reference read, planned, and held against what is on disk.

use std::collections::{BTreeMap, BTreeSet};

use rayon::prelude::*;

use super::load::text;
use crate::experiment::{AssumptionSheet, Calibration, parse_calibration};
use crate::reference::{Check, Prose, ReferenceFile, Role, parse_reference};
use crate::study::{ASSUMPTIONS, Item, Layout, Loaded, Refused, Sensitivity, Texts};
use crate::text::utf8::decode;
use crate::text::words;

/// Everything that was read, and the plan.
#[derive(Debug)]
pub struct Study {
    /// Where it lies.
    pub layout: Layout,
    /// The texts that all of this was made from.
    pub texts: Texts,
    /// The assumptions.
    pub sheet: AssumptionSheet,
    /// The experiments, planned, in the order of their ids.
    pub items: Vec<Item>,
    /// The reference by id of the experiment.
    pub references: BTreeMap<String, ReferenceFile>,
    /// The calibrations by the names of their files, without ending.
    pub calibrations: BTreeMap<String, Calibration>,
    /// Files that could not be used.
    pub unread: Vec<Unread>,
}

/// A file that could not be used.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum Unread {
    /// An experiment, the assumptions or a calibration.
    #[error(transparent)]
    Experiment(#[from] Refused),
    /// A reference file.
    #[error("{file}: {problem}")]
    Reference {
        /// Which.
        file: String,
        /// What is wrong with it, with its place.
        problem: String,
    },
}

impl Unread {
    /// The line of the first mistake, if it has a place.
    #[must_use]
    pub fn line(&self) -> Option<u64> {
        match self {
            Self::Experiment(Refused::Text(problems)) => {
                problems.list.iter().find_map(|problem| problem.place).and_then(|place| u64::try_from(place.line).ok())
            }
            Self::Experiment(Refused::Encoding { error, .. }) => u64::try_from(error.line).ok(),
            Self::Experiment(_) => None,
            Self::Reference { problem, .. } => {
                let digits: String = problem.strip_prefix("line ")?.chars().take_while(char::is_ascii_digit).collect();
                digits.parse().ok()
            }
        }
    }

    /// The name of the file.
    #[must_use]
    pub fn file(&self) -> &str {
        match self {
            Self::Experiment(refused) => refused.file(),
            Self::Reference { file, .. } => file,
        }
    }
}

impl Study {
    /// Reads and plans the study that the texts make.
    #[must_use]
    pub fn new(layout: Layout, texts: Texts) -> Self {
        let loaded = Loaded::from_texts(&texts);
        let mut unread: Vec<Unread> = loaded.refused.into_iter().map(Unread::from).collect();
        let references = references(&texts, &mut unread);
        unread.extend(lost_placeholders(&texts, &loaded.sheet, &references));
        let calibrations = calibrations(&texts, &loaded.sheet, &mut unread);
        let mut items: Vec<Item> = loaded
            .sources
            .into_par_iter()
            .map(|source| {
                let reference = references.get(&source.experiment.id.0);
                let asked = source.experiment.moved.is_some();
                let sensitivity = if asked || reference.is_some_and(has_values) {
                    Sensitivity::Wanted
                } else {
                    Sensitivity::NotWanted
                };
                Item::new(&layout, source, &loaded.sheet, sensitivity)
            })
            .collect();
        items.sort_by(|a, b| a.source.experiment.id.cmp(&b.source.experiment.id));
        Self { layout, texts, sheet: loaded.sheet, items, references, calibrations, unread }
    }

    /// The name within the study of the reference file of an experiment.
    #[must_use]
    pub fn reference_name(&self, id: &str) -> Option<&str> {
        let named = |name: &&String| name.strip_prefix("reference/").is_some_and(|rest| stem(rest) == id);
        self.texts.files.keys().find(named).map(String::as_str)
    }

    /// The ids of the entries that an assumption was fitted to.
    #[must_use]
    pub fn fitted(&self) -> BTreeSet<String> {
        self.sheet.iter().flat_map(|(_, entry)| entry.fitted_to.iter().cloned()).collect()
    }

    /// The part of an entry in the choice of inputs.
    #[must_use]
    pub fn role(&self, entry: &str) -> Role {
        let chose = self.sheet.iter().any(|(_, assumption)| assumption.fitted_to.iter().any(|id| id == entry));
        let named = |list: fn(&Calibration) -> &[String]| {
            self.calibrations.values().any(|one| list(one).iter().any(|id| names(id, entry)))
        };
        if chose || named(|calibration| &calibration.fit) {
            Role::Fitted
        } else if named(|calibration| &calibration.hold_out) {
            Role::HeldOut
        } else {
            Role::Neither
        }
    }
}

/// Whether an id of a calibration's list, which may be `EXPERIMENT/*`, names this entry.
fn names(id: &str, entry: &str) -> bool {
    id == entry || id.strip_suffix('*').is_some_and(|start| start.ends_with('/') && entry.starts_with(start))
}

fn calibrations(texts: &Texts, sheet: &AssumptionSheet, unread: &mut Vec<Unread>) -> BTreeMap<String, Calibration> {
    let mut calibrations = BTreeMap::new();
    for (file, bytes) in texts.files.iter().filter(|(file, _)| file.starts_with("calibrations/")) {
        match text(file, bytes).and_then(|text| parse_calibration(file, text, sheet).map_err(Refused::Text)) {
            Ok(calibration) => drop(calibrations.insert(stem(file).to_owned(), calibration)),
            Err(refused) => unread.push(refused.into()),
        }
    }
    calibrations
}

fn stem(name: &str) -> &str {
    let name = name.rsplit('/').next().unwrap_or(name);
    name.strip_suffix(".yaml").unwrap_or(name)
}

/// Numbers are held against the result with an uncertainty that needs the ends of the assumptions; claims are not.
fn has_values(file: &ReferenceFile) -> bool {
    file.entries.iter().any(|entry| matches!(entry.check, Check::Value { .. } | Check::Peak { .. }))
}

/// Placeholders of entries that do not exist, in explanations and in the reasons of the assumptions. Those of an experiment that
/// this study does not have are no mistake: they show no number.
fn lost_placeholders(
    texts: &Texts,
    sheet: &AssumptionSheet,
    references: &BTreeMap<String, ReferenceFile>,
) -> Vec<Unread> {
    let is_lost = |id: &str| match id.split_once('/') {
        None => true,
        Some((experiment, _)) => {
            references.get(experiment).is_some_and(|reference| reference.entries.iter().all(|entry| entry.id != id))
        }
    };
    let lost = |file: &str, prose: &Prose| -> Vec<Unread> {
        let text = texts.files.get(file).map(|bytes| String::from_utf8_lossy(bytes)).unwrap_or_default();
        // Names without their experiment were looked at with their file.
        let unknown = |id: &&str| (file == ASSUMPTIONS || id.contains('/')) && is_lost(id);
        let ids = prose.placeholders().filter_map(|one| one.entry.as_deref()).filter(unknown);
        let problem = |id: &str| {
            let line = text.lines().position(|line| line.contains(id)).map_or(1, |line| line + 1);
            format!("line {line}, column 1: a placeholder names `{id}`, which is no entry of the reference")
        };
        ids.map(|id| Unread::Reference { file: file.into(), problem: problem(id) }).collect()
    };
    let mut unread = Vec::new();
    for file in texts.files.keys().filter(|file| file.starts_with("reference/")) {
        let entries = references.get(stem(file)).into_iter().flat_map(|reference| &reference.entries);
        unread.extend(entries.flat_map(|entry| lost(file, &entry.prose())));
    }
    for (name, assumption) in sheet.iter() {
        match Prose::parse(&assumption.reason) {
            Ok(prose) => unread.extend(lost(ASSUMPTIONS, &prose)),
            Err(error) => {
                let problem = format!("the reason of `{}` has {error}", words::of_key(name));
                unread.push(Unread::Reference { file: ASSUMPTIONS.into(), problem });
            }
        }
    }
    unread
}

fn references(texts: &Texts, unread: &mut Vec<Unread>) -> BTreeMap<String, ReferenceFile> {
    let mut references = BTreeMap::<String, ReferenceFile>::new();
    for (file, bytes) in texts.files.iter().filter(|(file, _)| file.starts_with("reference/")) {
        let mut refuse = |problem: String| unread.push(Unread::Reference { file: file.clone(), problem });
        let name = file.rsplit('/').next().unwrap_or(file);
        let Some(id) = name.strip_suffix(".yaml") else {
            refuse("rename it to end in .yaml".into());
            continue;
        };
        let text = match decode(bytes) {
            Ok(text) => text,
            Err(error) => {
                refuse(format!("line {}: this is {error}", error.line));
                continue;
            }
        };
        match parse_reference(id, text) {
            Ok(_) if references.contains_key(id) => {
                refuse("another file holds the reference of this experiment".into())
            }
            Ok(reference) => {
                references.insert(id.into(), reference);
            }
            Err(problems) => problems.into_iter().for_each(refuse),
        }
    }
    references
}
