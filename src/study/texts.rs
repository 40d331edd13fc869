//! The texts that a study is read from, as they are now.

use std::collections::{BTreeMap, BTreeSet};
use std::fs::{self, File};
use std::io::{self, Read};
use std::path::{Path, PathBuf};

use super::canonical::hash;
use super::file_kind::FileKind;
use super::layout::{Layout, STUDY, stem};
use crate::atomic::FileError;

/// No hand-written experiment is longer; a longer file is refused before it is read.
const LONGEST_TEXT: u64 = 4 << 20;
/// Folders in folders below `experiments/`.
const DEEPEST: u32 = 8;

/// `study.yaml`, every YAML file under `experiments/`, `reference/` and `calibrations/`, and what calibrations recorded, as it stood at
/// one moment, by its name within the study.
///
/// All that follows, hashes included, is made from these bytes and never from a second look at the disk: a file that is
/// edited while a study runs is stale afterwards.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct Texts {
    /// The bytes by name, or why there are none; names use `/` everywhere.
    pub files: BTreeMap<String, Bytes>,
}

/// What a file holds.
pub type Bytes = Result<Vec<u8>, Unreadable>;

/// Why a file of the study cannot be read.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum Unreadable {
    /// A folder with the name of a file.
    #[error("it is a folder; rename it, or remove it")]
    Folder,
    /// A link without its file.
    #[error("it is a link to a file that does not exist; restore that file, or remove the link")]
    BrokenLink,
    /// A link to a folder above it, or to itself.
    #[error("it is a link that leads back to itself; remove it")]
    Circle,
    /// A pipe, a socket or a device: opening one may wait for ever.
    #[error("it is a pipe or a device; put a file in its place, or remove it")]
    NoFile,
    /// No text of a study is that long.
    #[error("it has {} KiB, and at most {} KiB are read; split it, or remove it", .0.div_ceil(1024), LONGEST_TEXT >> 10)]
    TooLong(u64),
    /// It may not be read.
    #[error("permission denied; give yourself the right to read it (chmod u+r), or remove it")]
    NoPermission,
    /// What else the system says.
    #[error("{0}")]
    Failed(String),
}

impl Texts {
    /// Reads them all.
    ///
    /// # Errors
    /// [`FileError`] if a folder cannot be listed: nobody knows what it holds.
    pub fn read(layout: &Layout) -> Result<Self, FileError> {
        let mut texts = Self::default();
        let written = FileKind::ALL.map(|kind| (kind.folder(), [".yaml", ".yml"].as_slice()));
        for (folder, endings) in written.into_iter().chain([("reports/calibrations", [".json"].as_slice())]) {
            let path = layout.path(folder);
            if path.is_dir() {
                texts.read_below(Folder { path, name: folder.into(), depth: DEEPEST }, endings)?;
            }
        }
        let about = layout.path(STUDY);
        if about.symlink_metadata().is_ok() {
            texts.files.insert(STUDY.into(), read_text(&about));
        }
        Ok(texts)
    }

    /// What a file holds, if it is there and can be read.
    #[must_use]
    pub fn bytes(&self, name: &str) -> Option<&[u8]> {
        self.files.get(name)?.as_deref().ok()
    }

    /// Those of a kind, by name, with what they hold.
    pub(super) fn of(&self, kind: FileKind) -> impl Iterator<Item = (&str, &Bytes)> {
        let files = self.files.iter().map(|(name, bytes)| (name.as_str(), bytes));
        files.filter(move |(name, _)| FileKind::of(name) == Some(kind))
    }

    /// Ids that the experiments' files are called by, whether they can be understood or not.
    #[must_use]
    pub fn ids(&self) -> BTreeSet<&str> {
        self.of(FileKind::Experiment).map(|(name, _)| stem(name)).collect()
    }

    /// Ids that the calibrations' files are called by.
    #[must_use]
    pub fn calibrations(&self) -> BTreeSet<&str> {
        self.of(FileKind::Calibration).map(|(name, _)| stem(name)).collect()
    }

    /// True for the text of one experiment or of its reference; assumptions and calibrations concern the whole study.
    pub(super) fn is_of_experiment(name: &str) -> bool {
        matches!(FileKind::of(name), Some(FileKind::Experiment | FileKind::Reference))
    }

    /// Ids that the files of experiments and of their references are called by.
    #[must_use]
    pub fn stems(&self) -> BTreeSet<&str> {
        self.files.keys().filter(|name| Self::is_of_experiment(name)).map(|name| stem(name)).collect()
    }

    /// Each real folder once, by its own name rather than by that of a link: links that lead to each other's folders end nowhere else.
    fn read_below(&mut self, folder: Folder, endings: &[&str]) -> Result<(), FileError> {
        let mut seen = BTreeSet::new();
        let (mut folders, mut links) = (vec![folder], Vec::new());
        // Links wait until no real folder is left; those that stand higher come first, then the order of their names.
        while let Some(folder) = folders.pop().or_else(|| links.pop()) {
            // Of a folder that has no real path listing tells why.
            if !seen.insert(folder.path.canonicalize().unwrap_or_else(|_| folder.path.clone())) {
                continue;
            }
            self.list(&folder, endings, &mut folders, &mut links)?;
            links.sort_by(|a, b| a.depth.cmp(&b.depth).then_with(|| b.name.cmp(&a.name)));
        }
        Ok(())
    }

    /// Reads the files of a folder and finds the folders in it.
    fn list(
        &mut self,
        folder: &Folder,
        endings: &[&str],
        folders: &mut Vec<Folder>,
        links: &mut Vec<Folder>,
    ) -> Result<(), FileError> {
        let fail = |source| FileError::new("list", &folder.path, source);
        for entry in fs::read_dir(&folder.path).map_err(fail)? {
            let entry = entry.map_err(fail)?;
            let Ok(file_name) = entry.file_name().into_string() else { continue };
            if file_name.starts_with('.') {
                continue;
            }
            let path = entry.path();
            let name = format!("{}/{file_name}", folder.name);
            if endings.iter().any(|ending| file_name.ends_with(ending)) {
                self.files.insert(name, read_text(&path));
            } else if path.is_symlink() && leads_back(&path) {
                self.files.insert(name, Err(Unreadable::Circle));
            } else if folder.depth > 0 && path.is_dir() {
                let found = if path.is_symlink() { &mut *links } else { &mut *folders };
                found.push(Folder { path, name, depth: folder.depth - 1 });
            }
        }
        Ok(())
    }

    /// The hash of each text whose name is wanted; of one that cannot be read, of the reason.
    pub(super) fn hashes(&self, is_wanted: impl Fn(&str) -> bool) -> impl Iterator<Item = (&String, String)> {
        self.files.iter().filter(move |(name, _)| is_wanted(name)).map(|(name, bytes)| {
            (name, bytes.as_ref().map_or_else(|error| hash(error.to_string().as_bytes()), |bytes| hash(bytes)))
        })
    }
}

/// A folder that is still to be listed.
struct Folder {
    path: PathBuf,
    /// Within the study.
    name: String,
    /// Folders in folders that are followed below it.
    depth: u32,
}

/// Whether a link to a folder leads to one that it lies in.
fn leads_back(link: &Path) -> bool {
    let folder = link.parent().and_then(|folder| folder.canonicalize().ok());
    folder.zip(link.canonicalize().ok()).is_some_and(|(folder, target)| folder.starts_with(target))
}

fn read_text(path: &Path) -> Bytes {
    // Before it is opened: to open a pipe is to wait for its writer.
    let metadata = path.metadata().map_err(|error| Unreadable::of(path, &error))?;
    if metadata.is_dir() {
        return Err(Unreadable::Folder);
    }
    if !metadata.is_file() {
        return Err(Unreadable::NoFile);
    }
    let file = File::open(path).map_err(|error| Unreadable::of(path, &error))?;
    // Room for all of it at once: a run with nothing to do spends its time here.
    let length = metadata.len().min(LONGEST_TEXT);
    let mut bytes = Vec::with_capacity(usize::try_from(length).unwrap_or(0) + 1);
    file.take(LONGEST_TEXT + 1).read_to_end(&mut bytes).map_err(|error| Unreadable::of(path, &error))?;
    if bytes.len() as u64 > LONGEST_TEXT { Err(Unreadable::TooLong(metadata.len())) } else { Ok(bytes) }
}

impl Unreadable {
    fn of(path: &Path, error: &io::Error) -> Self {
        match error.kind() {
            io::ErrorKind::NotFound | io::ErrorKind::NotADirectory if path.is_symlink() => Self::BrokenLink,
            io::ErrorKind::PermissionDenied => Self::NoPermission,
            // No portable kind of error names a loop of links; nothing else is left.
            _ if path.is_symlink() && path.canonicalize().is_err() => Self::Circle,
            _ => Self::Failed(error.to_string()),
        }
    }
}
