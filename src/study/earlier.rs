//! Tables that an experiment had before: put aside when one of another fingerprint takes their place, so that going back to an
//! earlier value simulates nothing; and the rows that an interrupted run has left.
//!
//! Each is called by the hash of its bytes: one that was cut, edited or exchanged is not what its name says, and counts for
//! nothing. The last [`KEPT`] are kept.

use std::fs::{self, File};
use std::path::PathBuf;
use std::time::SystemTime;

use super::layout::{Layout, table_name};
use super::record::FileHash;
use crate::atomic;
use crate::experiment::ExperimentId;
use crate::table::{ParquetError, Table, parquet};

/// Earlier tables that are kept of each experiment.
const KEPT: usize = 8;
/// The folder of all of them, within the study.
pub(super) const FOLDER: &str = "results/earlier";

/// The folder of an experiment's earlier tables, within the study.
pub(super) fn folder(id: &ExperimentId) -> String {
    format!("{FOLDER}/{id}")
}

fn path(layout: &Layout, id: &ExperimentId, hash: &FileHash) -> PathBuf {
    layout.path(&format!("{}/{}.parquet", folder(id), hash.blake3))
}

/// Those that are undamaged, the latest first, each read when it is needed.
pub(super) fn tables(layout: &Layout, id: &ExperimentId) -> impl Iterator<Item = Table> {
    files(layout, id).into_iter().filter_map(|path| {
        let bytes = fs::read(&path).ok()?;
        let name = path.file_stem()?.to_str()?;
        (FileHash::of(&bytes).blake3 == name).then(|| parquet::from_bytes(bytes, name).ok()).flatten()
    })
}

/// Files of the folder, the latest first.
fn files(layout: &Layout, id: &ExperimentId) -> Vec<PathBuf> {
    let entries = fs::read_dir(layout.path(&folder(id))).into_iter().flatten().flatten();
    let stamped = entries.filter_map(|entry| Some((entry.metadata().ok()?.modified().ok()?, entry.path())));
    let mut files: Vec<(SystemTime, PathBuf)> = stamped.collect();
    files.sort_by(|a, b| b.cmp(a));
    files.into_iter().map(|(_, path)| path).collect()
}

/// Puts the table on disk, of this hash, aside. It saves time and decides nothing: one that cannot be put aside is written
/// over.
pub(super) fn put_aside(layout: &Layout, id: &ExperimentId, hash: &FileHash) {
    let to = path(layout, id, hash);
    let _ = fs::create_dir_all(layout.path(&folder(id)));
    if fs::rename(layout.path(&table_name(id)), &to).is_err() {
        return;
    }
    // The file's time is that of its making; they are ordered by when each was last current.
    let _ = File::options().append(true).open(&to).and_then(|file| file.set_modified(SystemTime::now()));
}

/// Adds a table that was never in force: the rows that an interrupted run has.
pub(super) fn add(layout: &Layout, id: &ExperimentId, table: &Table) -> Result<(), ParquetError> {
    let bytes = parquet::to_bytes(table)?;
    Ok(atomic::write(&path(layout, id, &FileHash::of(&bytes)), &bytes)?)
}

/// Removes the copy of the table that is current again, and all but the last [`KEPT`] others.
pub(super) fn tidy(layout: &Layout, id: &ExperimentId, current: &FileHash) {
    let _ = fs::remove_file(path(layout, id, current));
    for path in files(layout, id).into_iter().skip(KEPT) {
        let _ = fs::remove_file(path);
    }
    // Only an empty folder goes.
    let _ = fs::remove_dir(layout.path(&folder(id)));
}
