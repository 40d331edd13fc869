//! The files of a study: their names.

use std::path::{Path, PathBuf};

use crate::atomic::place_of;
pub use crate::experiment::ASSUMPTIONS;

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
