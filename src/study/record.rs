//! One record per experiment, beside its table: the inputs that table, figures and report were made from.
//!
//! The record holds the inputs and not only their hash, so that `status --why` can name the value that changed.

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::Path;

use serde::{Deserialize, Serialize};

use super::canonical::hash;
use super::failures::Failures;
use super::inputs::Inputs;
use super::reason::Reason;
use crate::atomic::{self, FileError};
use crate::experiment::ExperimentId;
use crate::text::json;

/// Raised when a record changes its shape; older ones then count as absent.
pub const RECORD_FORMAT: u32 = 2;

/// Raised when figures or reports of the same tables come out differently, so that they are made again.
pub const PRESENTATION_VERSION: u32 = 17;

/// What became of one experiment.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Record {
    /// [`RECORD_FORMAT`].
    pub format: u32,
    /// Whose record.
    pub experiment: ExperimentId,
    /// What the table was computed from.
    pub simulation: Inputs,
    /// The table as it was written.
    pub table: FileHash,
    /// Rows without numbers, and the first reason.
    pub failures: Failures,
    /// What verdicts, figures and report were made from, once they were made.
    pub publication: Option<Publication>,
    /// Figures and report that were made before from something else, and may still be there, by their name within the study.
    #[serde(default, skip_serializing_if = "BTreeSet::is_empty")]
    pub left: BTreeSet<String>,
}

/// Length and hash of a file.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct FileHash {
    /// Length in bytes.
    pub bytes: u64,
    /// blake3, hexadecimal.
    pub blake3: String,
}

impl FileHash {
    /// Of these bytes.
    #[must_use]
    pub fn of(bytes: &[u8]) -> Self {
        Self { bytes: bytes.len() as u64, blake3: hash(bytes) }
    }

    /// True if the file at `path` holds these bytes.
    #[must_use]
    pub fn matches(&self, path: &Path) -> bool {
        self.departs(path, "").is_none()
    }

    /// What is wrong with the file at `path`, which is called by `name`; `None` if it holds these bytes.
    #[must_use]
    pub fn departs(&self, path: &Path, name: &str) -> Option<Reason> {
        let name = name.to_owned();
        match fs::metadata(path) {
            Ok(meta) if meta.len() != self.bytes && meta.is_file() => return Some(Reason::FileAltered(name)),
            Err(error) if error.kind() == std::io::ErrorKind::NotFound => return Some(Reason::FileMissing(name)),
            _ => {}
        }
        match fs::read(path) {
            Ok(bytes) if Self::of(&bytes) == *self => None,
            Ok(_) => Some(Reason::FileAltered(name)),
            Err(error) => Some(Reason::FileUnreadable(name, error.to_string())),
        }
    }
}

/// Figures and report of one experiment.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Publication {
    /// What they were made from.
    #[serde(rename = "meaning")]
    pub inputs: Inputs,
    /// The files, by their name within the study.
    pub files: BTreeMap<String, FileHash>,
    /// What each figure among them shows, as a hash: one that would show the same is not drawn again. Absent in records of
    /// before; it is then drawn once more.
    #[serde(default)]
    pub shown: BTreeMap<String, String>,
}

/// Why a record is not there.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum NoRecord {
    /// There is none.
    Absent,
    /// There is one that this program cannot read.
    Unreadable(String),
}

impl Record {
    /// Figures and report that are there, or may be.
    pub fn files(&self) -> impl Iterator<Item = &String> {
        self.left.iter().chain(self.publication.iter().flat_map(|publication| publication.files.keys()))
    }

    /// Reads one.
    ///
    /// # Errors
    /// [`NoRecord`]: absent, damaged, of another format, or another experiment's.
    pub fn read(path: &Path, id: &ExperimentId) -> Result<Self, NoRecord> {
        let bytes = match fs::read(path) {
            Ok(bytes) => bytes,
            Err(error) if error.kind() == std::io::ErrorKind::NotFound => return Err(NoRecord::Absent),
            Err(error) => return Err(NoRecord::Unreadable(error.to_string())),
        };
        let record: Self = serde_json::from_slice(&bytes).map_err(|error| NoRecord::Unreadable(error.to_string()))?;
        if record.format != RECORD_FORMAT {
            return Err(NoRecord::Unreadable(format!("format {} instead of {RECORD_FORMAT}", record.format)));
        }
        if record.experiment != *id {
            return Err(NoRecord::Unreadable(format!("it belongs to {}", record.experiment)));
        }
        Ok(record)
    }

    /// Writes it, whole or not at all.
    ///
    /// # Errors
    /// [`FileError`] if the file cannot be written.
    pub fn write(&self, path: &Path) -> Result<(), FileError> {
        atomic::write_if_changed(path, json::page(self).as_bytes()).map(|_| ())
    }
}
