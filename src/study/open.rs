//! The study as loaded: experiments, assumptions and reference, the plan, and what of it is on disk.

use std::collections::BTreeMap;

use rayon::prelude::*;

use super::file_ids::FileIds;
use super::file_kind::FileKind;
use super::left_out::{LeftOutRecord, PredictedErrors};
use super::load::text;
use crate::experiment::{AboutStudy, AssumptionSheet, Calibration, ExperimentId, RowLimit, parse_calibration};
use crate::reference::{Check, KnownTables, Prose, ReferenceFile, Role, parse_reference};
use crate::study::{
    ASSUMPTIONS, Item, Layout, Loaded, Refused, STUDY, Sensitivity, Summary, Texts, Untried, Used, stem,
};
use crate::yaml::Problems;

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
    pub unread: Vec<Refused>,
}

/// A name that names nothing, in a file that is fine otherwise.
#[derive(Debug, thiserror::Error)]
enum Lost {
    #[error("a placeholder names `{0}`, which is no entry of the reference")]
    Placeholder(String),
    #[error("`{0}` is no entry of the reference: write `experiment/entry`")]
    Entry(String),
    #[error(
        "a placeholder moves `{0}`, which no run of that entry does: the page of its experiment lists the assumptions that are moved, as they are written here"
    )]
    Variant(String),
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
        study.plan(&|id| !known.contains_key(id), used, &|_| {});
        study.known = known;
        study.plan_dependents();
        study.complete()
    }

    /// Reads and plans the experiments whose ids are `wanted`, as if there were no others; `on_untried` is called for each before its cases
    /// are tried.
    #[must_use]
    pub fn of(
        layout: Layout,
        texts: Texts,
        wanted: &(dyn Fn(&str) -> bool + Sync),
        on_untried: &dyn Fn(&Untried<'_>),
    ) -> Self {
        let mut study = Self::empty(layout, texts);
        study.plan(wanted, Used::new(), on_untried);
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
    fn plan(&mut self, wanted: &(dyn Fn(&str) -> bool + Sync), mut used: Used, on_untried: &dyn Fn(&Untried<'_>)) {
        let Self { texts, layout, unread, .. } = self;
        // What an experiment depends on is known where nothing of it has changed.
        let mut loaded = Loaded::chosen(texts, wanted, &|id| used.contains_key(id), on_untried);
        unread.append(&mut loaded.refused);
        let references = references(texts, &loaded, wanted, unread);
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
            self.plan(&|id| lost.contains_key(id), lost.clone(), &|_| {});
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
        self.texts.of(FileKind::Reference).map(|(name, _)| (stem(name), name)).collect()
    }

    /// Names of entries or variants that do not exist: in placeholders, in what assumptions and calibrations were fitted to, in the
    /// conclusions. Those of an experiment that this study does not have are no mistake: an export has a part of the entries.
    fn lost_names(&self) -> Vec<Refused> {
        let has = |id: &str| -> Option<bool> {
            let (experiment, _) = id.split_once('/')?;
            let planned = self.references.get(experiment).map(|file| file.entries.iter().any(|entry| entry.id == id));
            let known = self.known.get(experiment).map(|known| known.judged.iter().any(|one| one.id == id));
            Some(planned.or(known).unwrap_or(true))
        };
        let text = |file: &str| self.texts.bytes(file).map(|bytes| String::from_utf8_lossy(bytes)).unwrap_or_default();
        let refused = |file: &str, (line, column): (usize, usize), mistake: String| {
            Refused::Text(Problems::at(file, &text(file), Some((line as u64, column as u64)), mistake))
        };
        // From a line on, counted from 1.
        let problem_from = |from: usize, file: &str, name: &str, mistake: fn(String) -> Lost| {
            // Not in a longer name that begins or ends alike.
            let joins = |c: char| c.is_alphanumeric() || c == '-' || c == '_';
            let is_alone =
                |line: &str, at: usize| !line[at + name.len()..].starts_with(joins) && !line[..at].ends_with(joins);
            let place = text(file).lines().enumerate().skip(from - 1).find_map(|(index, line)| {
                let (at, _) = line.match_indices(name).find(|(at, _)| is_alone(line, *at))?;
                Some((index + 1, line[..at].chars().count() + 1))
            });
            refused(file, place.unwrap_or((from, 1)), mistake(name.into()).to_string())
        };
        let problem = |file: &str, name: &str, mistake: fn(String) -> Lost| problem_from(1, file, name, mistake);
        let in_prose = |file: &str, prose: &Prose| -> Vec<Refused> {
            let names = prose.placeholders().filter_map(|one| one.entry.as_deref());
            let moved = prose.placeholders().filter_map(|one| one.moved.as_deref());
            // A name without its experiment was checked with its file; in an assumption's reason it means nothing.
            let unknown = |name: &&str| has(name).map_or(file == ASSUMPTIONS, |has| !has);
            let entries = names.filter(unknown).map(|name| problem(file, name, Lost::Placeholder));
            let variants = moved.filter(|label| !self.sheet.has_variant(label));
            entries.chain(variants.map(|label| problem(file, label, Lost::Variant))).collect()
        };
        let in_list = |file: &str, names: &[String], from: usize| -> Vec<Refused> {
            let unknown = |name: &&String| !has(name).unwrap_or(false);
            names.iter().filter(unknown).map(|name| problem_from(from, file, name, Lost::Entry)).collect()
        };
        let mut unread = Vec::new();
        for (file, _) in self.texts.of(FileKind::Reference) {
            let entries = self.references.get(stem(file)).into_iter().flat_map(|reference| &reference.entries);
            unread.extend(entries.flat_map(|entry| in_prose(file, &entry.prose())));
        }
        for (name, assumption) in self.sheet.iter() {
            unread.extend(in_list(ASSUMPTIONS, &assumption.fitted_to, assumption.place.line));
            match Prose::parse(&assumption.reason) {
                Ok(prose) => unread.extend(in_prose(ASSUMPTIONS, &prose)),
                Err(error) => {
                    let mistake = format!("the reason of `{name}` has {error}");
                    unread.push(refused(ASSUMPTIONS, (assumption.place.line, 1), mistake));
                }
            }
        }
        unread.extend(self.about.findings.iter().flat_map(|finding| in_list(STUDY, &finding.entries, 1)));
        for (file, _) in self.texts.of(FileKind::Calibration) {
            let Some(Calibration { fit, hold_out, .. }) = self.calibrations.get(stem(file)) else { continue };
            // All entries of an experiment are asked for by its name.
            let one_by_one = fit.iter().chain(hold_out).filter(|name| !name.ends_with("/*")).cloned();
            unread.extend(in_list(file, &one_by_one.collect::<Vec<_>>(), 1));
        }
        unread
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

fn calibrations(texts: &Texts, sheet: &AssumptionSheet, unread: &mut Vec<Refused>) -> BTreeMap<String, Calibration> {
    let mut calibrations = BTreeMap::new();
    let ids = FileIds::of(texts.of(FileKind::Calibration).map(|(file, _)| file));
    for (file, bytes) in texts.of(FileKind::Calibration) {
        let read = text(file, bytes).and_then(|text| {
            let id = ids.id_of(file)?;
            Ok((id.0, parse_calibration(file, text, sheet).map_err(Refused::Text)?))
        });
        match read {
            Ok((id, calibration)) => drop(calibrations.insert(id, calibration)),
            Err(refused) => unread.push(refused),
        }
    }
    calibrations
}

/// Numbers are held against the result with an uncertainty that needs the ends of the assumptions; claims are not.
fn has_values(file: &ReferenceFile) -> bool {
    file.entries.iter().any(|entry| matches!(entry.check, Check::Value { .. } | Check::Peak { .. }))
}

/// The reference of those experiments that are `wanted`.
fn references(
    texts: &Texts,
    loaded: &Loaded,
    wanted: &dyn Fn(&str) -> bool,
    unread: &mut Vec<Refused>,
) -> BTreeMap<String, ReferenceFile> {
    let mut references = BTreeMap::new();
    let files = || texts.of(FileKind::Reference).filter(|(file, _)| wanted(stem(file)));
    let ids = FileIds::of(files().map(|(file, _)| file));
    for (file, bytes) in files() {
        let reference = text(file, bytes).and_then(|text| {
            let ExperimentId(id) = ids.id_of(file)?;
            let reference = parse_reference(&id, file, text)?;
            let read = reference.other_tables().into_iter().chain([id]);
            let columns = read.filter_map(|id| Some((id.clone(), loaded.columns(texts, &id)?))).collect();
            reference.check_tables(file, text, &KnownTables { ids: texts.ids(), columns })?;
            Ok(reference)
        });
        match reference {
            Ok(reference) => drop(references.insert(reference.experiment.clone(), reference)),
            Err(refused) => unread.push(refused),
        }
    }
    references
}
