//! What the last runs left up to date: of each experiment a hash of its texts, a glance at its files, and the summary of its
//! result. A run plans only the experiments for which one of these has changed; with nothing to do it parses no YAML, opens
//! no table and starts no thread.
//!
//! The snapshot saves time and decides nothing else: where a text, an assumption in use, a table that an entry reads, an output
//! or the program differs, the experiment is planned from its YAML, and its record tells what is stale. A damaged snapshot
//! counts as none.

use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;
use std::time::SystemTime;

use serde::{Deserialize, Serialize};

use super::canonical::hash;
use super::file_kind::FileKind;
use super::glance::{Glance, Match};
use super::layout::{ASSUMPTIONS, Layout, stem};
use super::record::{PRESENTATION_VERSION, RECORD_FORMAT};
use super::summary::{Summary, Used};
use super::texts::Texts;
use crate::atomic::{self, FileError};
use crate::dynamics::SOLVER_VERSION;
use crate::experiment::{AssumptionName, AssumptionSheet, parse_assumptions};
use crate::text::json;

/// Name of the file within the study.
const NAME: &str = "results/snapshot.bin";

/// Hashes of texts by name.
type Hashes = BTreeMap<String, String>;

/// The experiments that are up to date.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Snapshot {
    /// By id.
    pub experiments: BTreeMap<String, Summary>,
    /// True if index and verdicts are as the last run left them.
    pub index_is_current: bool,
    /// The assumptions that experiments depend on which are not up to date, where neither they nor any assumption has changed: an
    /// explanation has, or a file is gone.
    pub used: Used,
    /// Assumptions that no experiment used when it was taken.
    pub unused: BTreeSet<AssumptionName>,
    /// Files that were compared by content, and need not be the next time.
    settled: Option<Box<OnDisk>>,
    /// When it was written; `None` if there is none.
    taken: Option<SystemTime>,
}

/// An experiment, or what concerns the study as a whole, with the files that make it valid.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
struct Seen<T> {
    inputs: Hashes,
    outputs: BTreeMap<String, Glance>,
    content: T,
}

/// The snapshot as it is written.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
struct OnDisk {
    program: Program,
    study: Seen<Assumed>,
    unused: BTreeSet<AssumptionName>,
    /// Experiments and references that there were, whether they are up to date or not.
    listed: BTreeSet<String>,
    experiments: BTreeMap<String, Seen<Summary>>,
}

/// What the program itself contributes.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
struct Program {
    record: u32,
    solver: u32,
    presentation: u32,
    version: String,
    /// Length and time of the executable: a rebuilt program may judge or write otherwise.
    executable: Option<(u64, SystemTime)>,
}

impl Program {
    fn here() -> Self {
        let metadata = || std::fs::metadata(std::env::current_exe().ok()?).ok();
        Self {
            record: RECORD_FORMAT,
            solver: SOLVER_VERSION,
            presentation: PRESENTATION_VERSION,
            version: env!("CARGO_PKG_VERSION").into(),
            executable: metadata().and_then(|metadata| Some((metadata.len(), metadata.modified().ok()?))),
        }
    }
}

/// The assumptions, as hashes.
#[derive(Debug, Clone, PartialEq, Eq, Default, Serialize, Deserialize)]
struct Assumed {
    /// Of each with all that the file says of it.
    each: BTreeMap<AssumptionName, String>,
    /// Ids of the entries that one was fitted to; they are judged differently, whatever they use.
    fitted: BTreeSet<String>,
    /// Of the defaults, to which any experiment may leave what it does not say.
    others: String,
}

impl Assumed {
    fn of(sheet: &AssumptionSheet) -> Self {
        Self {
            each: sheet.iter().map(|(name, entry)| (name.clone(), hash_of(entry))).collect(),
            fitted: sheet.fitted(),
            others: hash_of(&(sheet.cycles(), sheet.defaults().collect::<Vec<_>>())),
        }
    }
}

impl Snapshot {
    /// What of the last runs still holds for these texts and the files on disk.
    #[must_use]
    pub fn current(layout: &Layout, texts: &Texts) -> Self {
        Self::read(layout, texts).unwrap_or_default()
    }

    fn read(layout: &Layout, texts: &Texts) -> Option<Self> {
        let path = layout.path(NAME);
        let mut known = OnDisk::from_bytes(&std::fs::read(&path).ok()?)?;
        let taken = written_at(&path)?;
        if known.program != Program::here() {
            return None;
        }
        let shared = shared_inputs(texts);
        let changed = known.study.changed_assumptions(&shared, texts)?;
        let mut look = Look { layout, taken, settled: false };
        let unchanged = shared == known.study.inputs;
        let texts = texts_by_experiment(texts);
        // The index has a line for an experiment that was deleted since then.
        let all_there = known.listed.iter().all(|id| texts.contains_key(id.as_str()));
        let index_is_current = unchanged && all_there && look.holds(&mut known.study.outputs);
        let mut used = Used::new();
        known.experiments.retain(|id, seen| {
            let Some(texts) = texts.get(id.as_str()) else { return false };
            let holds =
                *texts == seen.inputs && seen.content.used.is_disjoint(&changed) && look.holds(&mut seen.outputs);
            if !holds && unchanged && own_text(texts) == own_text(&seen.inputs) {
                used.insert(id.clone(), seen.content.used.clone());
            }
            holds
        });
        let experiments: BTreeMap<_, _> =
            known.experiments.iter().map(|(id, seen)| (id.clone(), seen.content.clone())).collect();
        let all = texts.len() == experiments.len();
        let unused = known.unused.clone();
        let settled = (look.settled && all && index_is_current).then(|| Box::new(known));
        Some(Self { experiments, index_is_current, used, unused, settled, taken: Some(taken) })
    }

    /// True if every experiment and every reference file among `texts` is up to date, and the index.
    #[must_use]
    pub fn is_complete(&self, texts: &Texts) -> bool {
        self.index_is_current && texts.stems().iter().all(|id| self.experiments.contains_key(*id))
    }

    /// True unless another run has ended since it was read.
    #[must_use]
    pub fn is_latest(&self, layout: &Layout) -> bool {
        self.taken == written_at(&layout.path(NAME))
    }

    /// Writes down which files one `stat` will do for the next time. It saves time only: on a full disk nothing is lost.
    pub fn settle(&self, layout: &Layout) {
        if let Some(settled) = &self.settled {
            let _ = settled.write(&layout.path(NAME));
        }
    }

    /// Forgets it: something that pages link to was written by another command.
    ///
    /// # Errors
    /// [`FileError`] if it cannot be removed.
    pub fn forget(layout: &Layout) -> Result<(), FileError> {
        let path = layout.path(NAME);
        match std::fs::remove_file(&path) {
            Err(error) if error.kind() != std::io::ErrorKind::NotFound => Err(FileError::new("remove", &path, error)),
            _ => Ok(()),
        }
    }

    /// Writes down what is up to date after a run over `texts`: of each experiment the files that it consists of and its
    /// summary, and the files of the study as a whole. Experiments in `kept` are as [`Snapshot::current`] found them.
    ///
    /// # Errors
    /// [`FileError`] if an output cannot be read back or the snapshot not be written.
    pub fn take(
        layout: &Layout,
        texts: &Texts,
        sheet: &AssumptionSheet,
        kept: &BTreeSet<&str>,
        published: BTreeMap<String, (BTreeSet<String>, Summary)>,
        of_the_study: &BTreeSet<String>,
    ) -> Result<(), FileError> {
        let path = layout.path(NAME);
        let old = std::fs::read(&path).ok().and_then(|bytes| OnDisk::from_bytes(&bytes));
        let mut experiments = old.map(|old| old.experiments).unwrap_or_default();
        experiments.retain(|id, _| kept.contains(id.as_str()));
        let mut inputs = texts_by_experiment(texts);
        for (id, (files, content)) in published {
            let outputs = glances(layout, &files)?;
            let inputs = inputs.remove(id.as_str()).unwrap_or_default();
            experiments.insert(id, Seen { inputs, outputs, content });
        }
        let outputs = glances(layout, of_the_study)?;
        let study = Seen { inputs: shared_inputs(texts), outputs, content: Assumed::of(sheet) };
        // Also where it says the same as before: its own time tells which outputs were written later.
        let is_used = |name: &AssumptionName| experiments.values().any(|seen| seen.content.used.contains(name));
        // What uses nothing is known once every experiment is.
        let all_known = texts.ids().iter().all(|id| experiments.contains_key(*id));
        let unused = sheet.iter().map(|(name, _)| name).filter(|name| all_known && !is_used(name)).cloned().collect();
        let listed = texts_by_experiment(texts).into_keys().map(str::to_owned).collect();
        OnDisk { program: Program::here(), study, unused, listed, experiments }.write(&path)
    }
}

impl Seen<Assumed> {
    /// The assumptions that differ now; `None` if no experiment can be relied upon.
    fn changed_assumptions(&self, shared: &Hashes, texts: &Texts) -> Option<BTreeSet<AssumptionName>> {
        let others = |hashes: &Hashes| {
            hashes
                .iter()
                .filter(|(name, _)| *name != ASSUMPTIONS)
                .map(|(k, v)| (k.clone(), v.clone()))
                .collect::<Hashes>()
        };
        if self.inputs == *shared {
            return Some(BTreeSet::new());
        }
        if others(&self.inputs) != others(shared) {
            return None;
        }
        let text = std::str::from_utf8(texts.bytes(ASSUMPTIONS)?).ok()?;
        let now = Assumed::of(&parse_assumptions(ASSUMPTIONS, text).ok()?);
        let differs = |name: &&AssumptionName| now.each.get(*name) != self.content.each.get(*name);
        (now.fitted == self.content.fitted && now.others == self.content.others)
            .then(|| now.each.keys().chain(self.content.each.keys()).filter(differs).cloned().collect())
    }
}

impl OnDisk {
    /// The bytes begin with the hash of the rest.
    fn from_bytes(bytes: &[u8]) -> Option<Self> {
        let (seal, content) = bytes.split_at_checked(32)?;
        (blake3::hash(content).as_bytes() == seal).then(|| postcard::from_bytes(content).ok()).flatten()
    }

    fn write(&self, path: &Path) -> Result<(), FileError> {
        let fail = |error| FileError::new("write", path, std::io::Error::other(error));
        let content = postcard::to_stdvec(self).map_err(fail)?;
        atomic::write(path, &[blake3::hash(&content).as_bytes(), content.as_slice()].concat())
    }
}

/// Compares files with what was seen of them.
struct Look<'a> {
    layout: &'a Layout,
    taken: SystemTime,
    /// A file was compared by content that will not have to be again.
    settled: bool,
}

impl Look<'_> {
    fn holds(&mut self, outputs: &mut BTreeMap<String, Glance>) -> bool {
        outputs.iter_mut().all(|(name, glance)| match glance.compare(&self.layout.path(name), self.taken) {
            Match::Untouched => true,
            Match::Same(now) => {
                self.settled |= now.is_settled();
                *glance = now;
                true
            }
            Match::Different => false,
        })
    }
}

fn written_at(path: &Path) -> Option<SystemTime> {
    std::fs::metadata(path).and_then(|metadata| metadata.modified()).ok()
}

fn glances(layout: &Layout, names: &BTreeSet<String>) -> Result<BTreeMap<String, Glance>, FileError> {
    let glance = |name: &String| {
        let path = layout.path(name);
        let glance = Glance::at(&path).map_err(|source| FileError::new("read", &path, source))?;
        Ok((name.clone(), glance))
    };
    names.iter().map(glance).collect()
}

fn hash_of(value: &impl Serialize) -> String {
    hash(json::line(value).as_bytes())
}

/// Texts that concern the study as a whole: what it says of itself, assumptions and calibrations.
fn shared_inputs(texts: &Texts) -> Hashes {
    let shared = texts.hashes(|name| !Texts::is_of_experiment(name));
    shared.map(|(name, hash)| (name.clone(), hash)).collect()
}

/// The hash of the experiment's own file among those that it consists of.
fn own_text(hashes: &Hashes) -> Option<&String> {
    hashes.iter().find(|(name, _)| FileKind::of(name) == Some(FileKind::Experiment)).map(|(_, hash)| hash)
}

/// The texts of each experiment; two files of one id are both its own, and never those that a run has left.
fn texts_by_experiment(texts: &Texts) -> BTreeMap<&str, Hashes> {
    let mut by_id = BTreeMap::<&str, Hashes>::new();
    for (name, hash) in texts.hashes(Texts::is_of_experiment) {
        by_id.entry(stem(name)).or_default().insert(name.clone(), hash);
    }
    by_id
}
