//! The files of a study: their names, and the texts as they are now.

use std::collections::{BTreeMap, BTreeSet};
use std::fs::{self, File};
use std::io::Read;
use std::path::{Path, PathBuf};

use super::canonical::hash;
use crate::atomic::{FileError, place_of};
pub use crate::experiment::ASSUMPTIONS;

/// No hand-written experiment is longer; a longer file is refused before it is read.
const LONGEST_TEXT: u64 = 4 << 20;
/// Folders in folders below `experiments/`; ends a walk that a link leads in a circle.
const DEEPEST: u32 = 8;

/// The folders of a study.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Layout {
    root: PathBuf,
}

impl Layout {
    /// The study in this folder.
    #[must_use]
    pub fn new(root: impl Into<PathBuf>) -> Self {
        Self { root: root.into() }
    }

    /// The study that `folder` lies in: the nearest folder upwards that holds `experiments/`.
    #[must_use]
    pub fn find(folder: &Path) -> Option<Self> {
        folder.ancestors().find(|folder| folder.join("experiments").is_dir()).map(Self::new)
    }

    /// The folder that holds all the others.
    #[must_use]
    pub fn root(&self) -> &Path {
        &self.root
    }

    /// A file of the study by its name within it, `experiments/ch3/ch3-gap.yaml`.
    #[must_use]
    pub fn path(&self, name: &str) -> PathBuf {
        self.root.join(name)
    }

    /// The part of the study that a file at this path would lie in, whichever way a link leads there; `None` outside of all.
    #[must_use]
    pub fn part_of(&self, path: &Path) -> Option<&'static str> {
        let place = place_of(path);
        PARTS.into_iter().find(|part| place.starts_with(place_of(&self.path(part))))
    }

    /// The folder of tables and records.
    #[must_use]
    pub fn results(&self) -> PathBuf {
        self.root.join("results")
    }
}

/// The name of the file in which a study says what it is.
pub const STUDY: &str = "study.yaml";

/// All that a study is read from, and all that a run writes.
const PARTS: [&str; 7] = [STUDY, "experiments", "reference", "calibrations", "results", "reports", "schema"];

/// The table of an experiment, within the study.
#[must_use]
pub fn table_name(id: &crate::experiment::ExperimentId) -> String {
    format!("results/{id}.parquet")
}

/// The record of an experiment, within the study.
#[must_use]
pub fn record_name(id: &crate::experiment::ExperimentId) -> String {
    format!("results/{id}.json")
}

/// The journal of an optimisation that is under way, within the study.
#[must_use]
pub fn journal_name(id: &crate::experiment::ExperimentId) -> String {
    format!("results/{id}.journal")
}

/// What a calibration has evaluated, within the study.
#[must_use]
pub fn calibration_journal_name(id: &crate::experiment::ExperimentId) -> String {
    format!("results/calibrations/{id}.journal")
}

/// `study.yaml`, every YAML file under `experiments/`, `reference/` and `calibrations/`, and what calibrations recorded, as it stood at
/// one moment, by its name within the study.
///
/// All that follows, hashes included, is made from these bytes and never from a second look at the disk: a file that is
/// edited while a study runs is stale afterwards.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct Texts {
    /// The bytes by name; names use `/` everywhere.
    pub files: BTreeMap<String, Vec<u8>>,
}

impl Texts {
    /// Reads them all.
    ///
    /// # Errors
    /// [`FileError`] if a folder or a file cannot be read, or is far too large.
    pub fn read(layout: &Layout) -> Result<Self, FileError> {
        let mut texts = Self::default();
        let yaml: &[&str] = &[".yaml", ".yml"];
        for (folder, endings) in
            [("experiments", yaml), ("reference", yaml), ("calibrations", yaml), ("reports/calibrations", &[".json"])]
        {
            let path = layout.path(folder);
            if path.is_dir() {
                texts.walk(&path, folder, endings, DEEPEST)?;
            }
        }
        let about = layout.path(STUDY);
        if about.is_file() {
            texts.files.insert(STUDY.into(), read_text(&about)?);
        }
        Ok(texts)
    }

    /// Ids that the experiments' files are called by, whether they can be understood or not.
    #[must_use]
    pub fn ids(&self) -> BTreeSet<&str> {
        self.files.keys().filter(|name| Self::is_experiment(name)).map(|name| stem(name)).collect()
    }

    /// Ids that the calibrations' files are called by.
    #[must_use]
    pub fn calibrations(&self) -> BTreeSet<&str> {
        self.files.keys().filter(|name| name.starts_with("calibrations/")).map(|name| stem(name)).collect()
    }

    /// True for the text of one experiment or of its reference; assumptions and calibrations concern the whole study.
    pub(super) fn is_of_experiment(name: &str) -> bool {
        Self::is_experiment(name) || name.starts_with("reference/")
    }

    /// True for the text of an experiment.
    pub(super) fn is_experiment(name: &str) -> bool {
        name.starts_with("experiments/") && name != ASSUMPTIONS
    }

    /// Ids that the files of experiments and of their references are called by.
    #[must_use]
    pub fn stems(&self) -> BTreeSet<&str> {
        self.files.keys().filter(|name| Self::is_of_experiment(name)).map(|name| stem(name)).collect()
    }

    fn walk(&mut self, folder: &Path, name: &str, endings: &[&str], depth: u32) -> Result<(), FileError> {
        let fail = |source| FileError::new("list", folder, source);
        for entry in fs::read_dir(folder).map_err(fail)? {
            let entry = entry.map_err(fail)?;
            let Ok(file_name) = entry.file_name().into_string() else { continue };
            if file_name.starts_with('.') {
                continue;
            }
            let path = entry.path();
            let name = format!("{name}/{file_name}");
            if endings.iter().any(|ending| file_name.ends_with(ending)) {
                self.files.insert(name, read_text(&path)?);
            } else if depth > 0 && path.is_dir() {
                self.walk(&path, &name, endings, depth - 1)?;
            }
        }
        Ok(())
    }

    /// The hash of each text, by name.
    #[must_use]
    pub fn hashes(&self) -> BTreeMap<String, String> {
        self.files.iter().map(|(name, bytes)| (name.clone(), hash(bytes))).collect()
    }
}

fn read_text(path: &Path) -> Result<Vec<u8>, FileError> {
    let fail = |source| FileError::new("read", path, source);
    let file = File::open(path).map_err(fail)?;
    // Room for all of it at once: a run with nothing to do spends its time here.
    let length = file.metadata().map_err(fail)?.len().min(LONGEST_TEXT);
    let mut bytes = Vec::with_capacity(usize::try_from(length).unwrap_or(0) + 1);
    file.take(LONGEST_TEXT + 1).read_to_end(&mut bytes).map_err(fail)?;
    if bytes.len() as u64 > LONGEST_TEXT {
        let length = fs::metadata(path).map_or(LONGEST_TEXT, |meta| meta.len());
        let (length, most) = (length.div_ceil(1024), LONGEST_TEXT >> 10);
        return Err(fail(std::io::Error::other(format!("it has {length} KiB; at most {most} KiB are read"))));
    }
    Ok(bytes)
}

/// The folder of a file below `experiments/`, `reference/` or `calibrations/`: `ch3`; empty for one that stands there itself.
#[must_use]
pub fn folder_of(name: &str) -> &str {
    let below = name.split_once('/').map_or(name, |(_, below)| below);
    below.rsplit_once('/').map_or("", |(folder, _)| folder)
}

/// The name of a file without its folder and ending.
#[must_use]
pub fn stem(name: &str) -> &str {
    let name = name.rsplit('/').next().unwrap_or(name);
    name.rsplit_once('.').map_or(name, |(stem, _)| stem)
}
