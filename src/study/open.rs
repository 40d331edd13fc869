//! The study as loaded: experiments, assumptions and reference, the plan, and what of it is on disk.

use std::collections::{BTreeMap, BTreeSet};

use rayon::prelude::*;

use super::left_out::{LeftOutRecord, PredictedErrors};
use super::load::text;
use crate::experiment::{AboutStudy, AssumptionSheet, Calibration, Cases, Problems, RowLimit, parse_calibration};
use crate::reference::{Check, Prose, ReferenceFile, ReferenceMistake, ReferenceProblem, Role, parse_reference};
use crate::study::{ASSUMPTIONS, Item, Layout, Loaded, Refused, STUDY, Sensitivity, Summary, Texts, Used, stem};
use crate::text::utf8::decode;

/// The study: what was read and planned, and the experiments that are up to date and need not be.
#[derive(Debug)]
pub struct Study {
    /// Where it lies.
    pub layout: Layout,
    /// The texts that all of this was made from.
    pub texts: Texts,
    /// What it says of itself.
    pub about: AboutStudy,
    /// The assumptions.
    pub sheet: AssumptionSheet,
    /// The experiments that were planned, in the order of their ids.
    pub items: Vec<Item>,
    /// Experiments that are up to date and were neither read nor planned.
    pub known: BTreeMap<String, Summary>,
    /// The reference by id of the experiment.
    pub references: BTreeMap<String, ReferenceFile>,
    /// The calibrations by the names of their files, without ending.
    pub calibrations: BTreeMap<String, Calibration>,
    /// The fitted entries that a calibration left out in turn, and how far off each came out.
    pub left_out: BTreeMap<String, PredictedErrors>,
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
        problem: ReferenceProblem,
        /// The same with the line of the text.
        shown: Box<Problems>,
    },
}

impl Unread {
    fn reference(file: &str, text: &str, problem: ReferenceProblem) -> Self {
        let shown = Box::new(problem.shown(file, text));
        Self::Reference { file: file.into(), problem, shown }
    }

    /// The mistakes with their lines, where there are lines.
    #[must_use]
    pub fn problems(&self) -> Option<&Problems> {
        match self {
            Self::Experiment(Refused::Text(problems)) => Some(problems),
            Self::Reference { shown, .. } => Some(shown),
            Self::Experiment(_) => None,
        }
    }

    /// The line of the first mistake, if it has a place.
    #[must_use]
    pub fn line(&self) -> Option<u64> {
        match self {
            Self::Experiment(Refused::Text(problems)) => {
                problems.list.iter().find_map(|problem| problem.place).and_then(|place| u64::try_from(place.line).ok())
            }
            Self::Experiment(Refused::Encoding { error, .. }) => u64::try_from(error.line).ok(),
            Self::Experiment(_) => None,
            Self::Reference { problem, .. } => problem.line(),
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
        Self::beside(layout, texts, BTreeMap::new(), Used::new())
    }

    /// The same, but for the experiments that are `known` to be up to date; with the assumptions that others are known to depend on.
    #[must_use]
    pub fn beside(layout: Layout, texts: Texts, known: BTreeMap<String, Summary>, used: Used) -> Self {
        let mut study = Self::empty(layout, texts);
        study.plan(&|id| !known.contains_key(id), used);
        study.known = known;
        study.plan_dependents();
        study.complete()
    }

    /// Reads and plans the experiments whose ids are `wanted`, as if there were no others.
    #[must_use]
    pub fn of(layout: Layout, texts: Texts, wanted: &(dyn Fn(&str) -> bool + Sync)) -> Self {
        let mut study = Self::empty(layout, texts);
        study.plan(wanted, Used::new());
        study.complete()
    }

    fn empty(layout: Layout, texts: Texts) -> Self {
        Self {
            layout,
            texts,
            about: AboutStudy::default(),
            sheet: AssumptionSheet::default(),
            items: Vec::new(),
            known: BTreeMap::new(),
            references: BTreeMap::new(),
            calibrations: BTreeMap::new(),
            left_out: BTreeMap::new(),
            unread: Vec::new(),
        }
    }

    /// Reads what is beside the experiments.
    fn complete(mut self) -> Self {
        self.calibrations = calibrations(&self.texts, &self.sheet, &mut self.unread);
        self.left_out = LeftOutRecord::all(&self.texts, &self.calibrations);
        let lost = self.lost_names();
        self.unread.extend(lost);
        self
    }

    /// Looks at what is on disk again, after a run.
    pub fn refresh(&mut self) {
        let Self { items, layout, .. } = self;
        items.par_iter_mut().for_each(|item| item.refresh(layout));
        self.plan_dependents();
    }

    /// Puts a limit in the place of what the experiments say of the limit of a row.
    pub fn limit_rows(&mut self, limit: RowLimit) {
        for item in &mut self.items {
            let experiment = &mut item.source.experiment;
            experiment.limit = limit.over(experiment.limit);
        }
    }

    /// Reads and plans the experiments whose ids are `wanted`; what the others depend on is worked out.
    fn plan(&mut self, wanted: &(dyn Fn(&str) -> bool + Sync), mut used: Used) {
        let Self { texts, layout, unread, .. } = self;
        // What an experiment depends on is known where nothing of it has changed.
        let cases = |id: &str| if used.contains_key(id) { Cases::Tried } else { Cases::ToTry };
        let loaded = Loaded::chosen(texts, wanted, &cases);
        unread.extend(loaded.refused.into_iter().map(Unread::from));
        let references = references(texts, wanted, unread);
        let items: Vec<Item> = loaded
            .sources
            .into_iter()
            .map(|source| (used.remove(&source.experiment.id.0), source))
            .collect::<Vec<_>>()
            .into_par_iter()
            .map(|(used, source)| {
                let reference = references.get(&source.experiment.id.0);
                let asked = source.experiment.moved.is_some();
                let sensitivity = if asked || reference.is_some_and(has_values) {
                    Sensitivity::Wanted
                } else {
                    Sensitivity::NotWanted
                };
                Item::new(layout, source, used, &loaded.sheet, sensitivity)
            })
            .collect();
        self.about = loaded.about;
        self.sheet = loaded.sheet;
        self.references.extend(references);
        self.items.extend(items);
        self.items.sort_by(|a, b| a.source.experiment.id.cmp(&b.source.experiment.id));
    }

    /// Plans those known experiments whose entries read a table that is no longer the one they were judged by.
    fn plan_dependents(&mut self) {
        let tables = self.tables();
        let moved =
            |summary: &Summary| summary.reads.iter().any(|(id, hash)| tables.get(id.as_str()) != Some(&hash.as_str()));
        let lost: Used = self
            .known
            .iter()
            .filter(|(_, summary)| moved(summary))
            .map(|(id, summary)| (id.clone(), summary.used.clone()))
            .collect();
        if !lost.is_empty() {
            self.known.retain(|id, _| !lost.contains_key(id));
            self.plan(&|id| lost.contains_key(id), lost.clone());
        }
    }

    /// The hash of every table that counts, by experiment.
    #[must_use]
    pub fn tables(&self) -> BTreeMap<&str, &str> {
        let known = self.known.iter().map(|(id, summary)| (id.as_str(), summary.table.as_str()));
        let planned = self
            .items
            .iter()
            .filter_map(|item| Some((item.source.experiment.id.0.as_str(), item.record()?.table.blake3.as_str())));
        known.chain(planned).collect()
    }

    /// The names within the study of the reference files, by experiment.
    #[must_use]
    pub fn reference_names(&self) -> BTreeMap<&str, &str> {
        let names = self.texts.files.keys().rev().filter(|name| name.starts_with("reference/"));
        names.map(|name| (stem(name), name.as_str())).collect()
    }

    /// Names of entries or variants that do not exist: in placeholders, in what assumptions and calibrations were fitted to, in the
    /// conclusions. Those of an experiment that this study does not have are no mistake: an export has a part of the entries.
    fn lost_names(&self) -> Vec<Unread> {
        let has = |id: &str| -> Option<bool> {
            let (experiment, _) = id.split_once('/')?;
            let planned = self.references.get(experiment).map(|file| file.entries.iter().any(|entry| entry.id == id));
            let known = self.known.get(experiment).map(|known| known.judged.iter().any(|one| one.id == id));
            Some(planned.or(known).unwrap_or(true))
        };
        let problem = |file: &str, name: &str, mistake: fn(String) -> ReferenceMistake| {
            let text = self.texts.files.get(file).map(|bytes| String::from_utf8_lossy(bytes)).unwrap_or_default();
            let line = text.lines().position(|line| line.contains(name)).map_or(1, |line| line as u64 + 1);
            Unread::reference(file, &text, ReferenceProblem::on_line(line, mistake(name.into())))
        };
        let in_prose = |file: &str, prose: &Prose| -> Vec<Unread> {
            let names = prose.placeholders().filter_map(|one| one.entry.as_deref());
            let moved = prose.placeholders().filter_map(|one| one.moved.as_deref());
            // A name without its experiment was checked with its file; in an assumption's reason it means nothing.
            let unknown = |name: &&str| has(name).map_or(file == ASSUMPTIONS, |has| !has);
            let entries = names.filter(unknown).map(|name| problem(file, name, ReferenceMistake::Placeholder));
            let variants = moved.filter(|label| !self.sheet.has_variant(label));
            entries.chain(variants.map(|label| problem(file, label, ReferenceMistake::Variant))).collect()
        };
        let in_list = |file: &str, names: &[String]| -> Vec<Unread> {
            let unknown = |name: &&String| !has(name).unwrap_or(false);
            names.iter().filter(unknown).map(|name| problem(file, name, ReferenceMistake::NoSuchEntry)).collect()
        };
        let mut unread = Vec::new();
        for file in self.texts.files.keys().filter(|file| file.starts_with("reference/")) {
            let entries = self.references.get(stem(file)).into_iter().flat_map(|reference| &reference.entries);
            unread.extend(entries.flat_map(|entry| in_prose(file, &entry.prose())));
        }
        for (name, assumption) in self.sheet.iter() {
            unread.extend(in_list(ASSUMPTIONS, &assumption.fitted_to));
            match Prose::parse(&assumption.reason) {
                Ok(prose) => unread.extend(in_prose(ASSUMPTIONS, &prose)),
                Err(error) => {
                    let mistake = ReferenceMistake::Reason { name: name.clone(), error };
                    let text = self.texts.files.get(ASSUMPTIONS).map(|bytes| String::from_utf8_lossy(bytes));
                    let problem = ReferenceProblem::on_line(assumption.place.line as u64, mistake);
                    unread.push(Unread::reference(ASSUMPTIONS, &text.unwrap_or_default(), problem));
                }
            }
        }
        unread.extend(self.about.findings.iter().flat_map(|finding| in_list(STUDY, &finding.entries)));
        for file in self.texts.files.keys().filter(|file| file.starts_with("calibrations/")) {
            let Some(Calibration { fit, hold_out, .. }) = self.calibrations.get(stem(file)) else { continue };
            // All entries of an experiment are asked for by its name.
            let one_by_one = fit.iter().chain(hold_out).filter(|name| !name.ends_with("/*")).cloned();
            unread.extend(in_list(file, &one_by_one.collect::<Vec<_>>()));
        }
        unread
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

/// Numbers are held against the result with an uncertainty that needs the ends of the assumptions; claims are not.
fn has_values(file: &ReferenceFile) -> bool {
    file.entries.iter().any(|entry| matches!(entry.check, Check::Value { .. } | Check::Peak { .. }))
}

fn references(
    texts: &Texts,
    wanted: &dyn Fn(&str) -> bool,
    unread: &mut Vec<Unread>,
) -> BTreeMap<String, ReferenceFile> {
    let mut references = BTreeMap::<String, ReferenceFile>::new();
    let files = texts.files.iter().filter(|(file, _)| file.starts_with("reference/") && wanted(stem(file)));
    for (file, bytes) in files {
        let text = String::from_utf8_lossy(bytes);
        let mut refuse = |problem| unread.push(Unread::reference(file, &text, problem));
        let name = file.rsplit('/').next().unwrap_or(file);
        let Some(id) = name.strip_suffix(".yaml") else {
            refuse(ReferenceMistake::Ending.into());
            continue;
        };
        let text = match decode(bytes) {
            Ok(text) => text,
            Err(error) => {
                refuse(error.into());
                continue;
            }
        };
        match parse_reference(id, text) {
            Ok(_) if references.contains_key(id) => refuse(ReferenceMistake::Twice.into()),
            Ok(reference) => {
                references.insert(id.into(), reference);
            }
            Err(problems) => problems.into_iter().for_each(refuse),
        }
    }
    references
}
