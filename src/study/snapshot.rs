//! The short way for a run with nothing to do: one file that remembers every text that went in and every file that came
//! out of the last complete run, and what it said in the end.
//!
//! If all of them are as they were, nothing is parsed, no table opened and no thread started. The snapshot decides
//! nothing else: when anything differs it is put aside and the plan asks the records, which know the meaning.

use std::collections::BTreeMap;
use std::fs::File;
use std::io::{Read, Seek, SeekFrom};
use std::path::Path;
use std::time::SystemTime;

use serde::{Deserialize, Serialize};

use super::layout::{Layout, Texts};
use super::record::{PRESENTATION_VERSION, RECORD_FORMAT};
use crate::atomic::{self, FileError};
use crate::dynamics::SOLVER_VERSION;

/// Name of the file within the study.
const NAME: &str = "results/snapshot.json";
/// Outputs of which the head and the tail say enough: a Parquet file ends with the seal over all its bytes and a PNG with the
/// checksum over all its pixels, and a record only repeats what the inputs mean, which are looked at themselves. Whoever
/// edits the middle leaves a later time. Reports are read whole.
const HEAD_AND_TAIL: [&str; 3] = ["parquet", "png", "json"];
/// How much of each.
const LOOK: usize = 4 << 10;

/// The last complete run.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Snapshot {
    versions: Versions,
    inputs: BTreeMap<String, String>,
    outputs: BTreeMap<String, Glance>,
    /// What it printed in the end.
    pub summary: String,
    /// Its exit code.
    pub exit_code: u8,
}

/// What the program itself contributed.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct Versions {
    record: u32,
    solver: u32,
    presentation: u32,
}

impl Versions {
    const CURRENT: Self = Self { record: RECORD_FORMAT, solver: SOLVER_VERSION, presentation: PRESENTATION_VERSION };
}

/// An output at a glance: enough to see that it was cut, replaced or edited.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct Glance {
    bytes: u64,
    blake3: String,
}

impl Glance {
    /// True if the file is still what was seen, and nobody has written to it after `taken`.
    fn holds(&self, path: &Path, taken: Option<SystemTime>) -> bool {
        let later = || Some(std::fs::metadata(path).ok()?.modified().ok()? > taken?);
        later() != Some(true) && Self::at(path).is_ok_and(|glance| glance == *self)
    }

    fn at(path: &Path) -> std::io::Result<Self> {
        let mut file = File::open(path)?;
        let bytes = file.metadata()?.len();
        let short = path.extension().is_some_and(|extension| HEAD_AND_TAIL.iter().any(|one| extension == *one));
        let length = usize::try_from(bytes).map_err(std::io::Error::other)?;
        let mut seen = vec![0; if short { length.min(2 * LOOK) } else { length }];
        let (head, tail) = seen.split_at_mut(length.min(LOOK));
        file.read_exact(head)?;
        if short && length > 2 * LOOK {
            file.seek(SeekFrom::Start(bytes - LOOK as u64))?;
        }
        file.read_exact(tail)?;
        Ok(Self { bytes, blake3: blake3::hash(&seen).to_hex().to_string() })
    }
}

impl Snapshot {
    /// The last complete run, if these texts and all its outputs are still what they were.
    #[must_use]
    pub fn current(layout: &Layout, texts: &Texts) -> Option<Self> {
        let path = layout.path(NAME);
        let snapshot: Self = serde_json::from_slice(&std::fs::read(&path).ok()?).ok()?;
        let taken = std::fs::metadata(&path).and_then(|meta| meta.modified()).ok();
        let same = snapshot.versions == Versions::CURRENT
            && snapshot.inputs == texts.hashes()
            && snapshot.outputs.iter().all(|(name, glance)| glance.holds(&layout.path(name), taken));
        same.then_some(snapshot)
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

    /// Remembers a complete run over `texts` that left `outputs` (names within the study) and said `summary`.
    ///
    /// # Errors
    /// [`FileError`] if an output cannot be read back or the snapshot not be written.
    pub fn take(
        layout: &Layout,
        texts: &Texts,
        outputs: impl IntoIterator<Item = String>,
        summary: &str,
        exit_code: u8,
    ) -> Result<(), FileError> {
        let outputs = outputs
            .into_iter()
            .map(|name| {
                let path = layout.path(&name);
                let glance = Glance::at(&path).map_err(|source| FileError::new("read", &path, source))?;
                Ok((name, glance))
            })
            .collect::<Result<_, FileError>>()?;
        let snapshot =
            Self { versions: Versions::CURRENT, inputs: texts.hashes(), outputs, summary: summary.into(), exit_code };
        let path = layout.path(NAME);
        let text = serde_json::to_string_pretty(&snapshot)
            .map_err(|error| FileError::new("write", &path, std::io::Error::other(error)))?;
        // Also where it says the same as before: its own time tells which outputs were written later.
        atomic::write(&path, text.as_bytes())
    }
}
