//! Results on disk: tables and records, and the lock that keeps two runs apart.

use std::fs::{self, File, TryLockError};
use std::io::Write;
use std::path::Path;

use super::finished::Finished;
use super::known_rows::KnownRows;
use super::layout::{Layout, journal_name, record_name, table_name};
use super::plan::{Item, State};
use super::record::{FileHash, RECORD_FORMAT, Record};
use super::shard::Shard;
use super::{earlier, spent};
use crate::atomic::{self, FileError};
use crate::experiment::ExperimentId;
use crate::table::{ParquetError, parquet};

/// Writes an experiment's table and then its record, which is what makes the table count. An earlier
/// table with another fingerprint is kept for the day when its inputs come back, one with more numbers for the next run.
///
/// # Errors
/// [`ParquetError`] if one of them cannot be written; the record is then still that of the table before, or absent.
pub fn save(layout: &Layout, item: &Item, finished: &Finished) -> Result<Record, ParquetError> {
    let id = &item.source.experiment.id;
    let path = layout.path(&table_name(id));
    let old = Record::read(&layout.path(&record_name(id)), id).ok();
    if let Some(old) = &old
        && (old.simulation != item.simulation || old.failures.rows < finished.failures.rows)
        && old.table.matches(&path)
    {
        earlier::put_aside(layout, id, &old.table);
    }
    let bytes = parquet::write(&finished.table, &path)?;
    let record = Record {
        format: RECORD_FORMAT,
        experiment: id.clone(),
        simulation: item.simulation.clone(),
        table: FileHash::of(&bytes),
        failures: finished.failures.clone(),
        publication: None,
        left: old.iter().flat_map(Record::files).cloned().collect(),
    };
    record.write(&layout.path(&record_name(id)))?;
    earlier::tidy(layout, id, &record.table);
    finished.spent.keep(layout, id);
    if finished.failures.rows == 0 {
        remove_journal(layout, id);
    }
    Ok(record)
}

/// Removes the journals that a killed run left beside tables that it had completed.
pub fn remove_journals(layout: &Layout, items: &[Item]) {
    for item in items.iter().filter(|item| matches!(item.state, State::Current(_))) {
        remove_journal(layout, &item.source.experiment.id);
    }
}

/// What it was kept for is done; one that cannot be removed is overwritten by the next optimisation.
fn remove_journal(layout: &Layout, id: &ExperimentId) {
    let _ = fs::remove_file(layout.path(&journal_name(id)));
}

/// Keeps the rows of an interrupted experiment for the next run. The table in force and its record stay as they are.
///
/// # Errors
/// [`ParquetError`] if they cannot be written.
pub fn keep(layout: &Layout, item: &Item, finished: &Finished) -> Result<(), ParquetError> {
    let id = &item.source.experiment.id;
    if !finished.has_rows_to_keep() {
        return Ok(());
    }
    finished.spent.keep(layout, id);
    earlier::add(layout, id, &finished.table)
}

/// True if a run of the experiment has left some of what is planned now, and not all of it.
#[must_use]
pub fn is_begun(layout: &Layout, item: &Item) -> bool {
    layout.path(&journal_name(&item.source.experiment.id)).is_file() || KnownRows::of(layout, item).is_part_of(item)
}

/// Held while files are written; other runs wait. The system gives it back when the process ends, however it ends.
#[derive(Debug)]
pub struct Lock {
    file: File,
}

/// What to do about a lock that another run holds.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Held {
    /// Wait until it is free.
    Wait,
    /// Do without.
    GiveUp,
}

/// Why there is no lock.
#[derive(Debug, thiserror::Error)]
pub enum LockError {
    /// Another run holds it, and this one was not to wait.
    #[error("another run is working here: {holder}")]
    Held {
        /// Which, in words.
        holder: String,
    },
    /// The folder cannot be made or locked.
    #[error(transparent)]
    File(#[from] FileError),
}

impl Lock {
    /// The lock of the study. Removes what killed runs left behind. If another run holds it, `held` is called with its description.
    ///
    /// # Errors
    /// [`LockError`] if another run holds it and `held` gives up, or if the folder cannot be made or locked.
    pub fn of_study(layout: &Layout, held: impl FnOnce(&str) -> Held) -> Result<Self, LockError> {
        let results = layout.results();
        // That nothing can be written there is to be said before the work and not after it.
        let reports = layout.path("reports");
        if reports.symlink_metadata().is_ok() {
            atomic::make_folder(&reports).map_err(|source| FileError::new("use", &reports, source))?;
        }
        let lock = Self::take(&results, held)?;
        atomic::sweep(&results);
        atomic::sweep(&layout.path(spent::FOLDER));
        sweep_below(&layout.path("reports"), 4);
        Ok(lock)
    }

    /// The lock of a shard's folder: shards do not keep each other from their work.
    ///
    /// # Errors
    /// As [`Lock::of_study`].
    pub fn of_shard(layout: &Layout, shard: Shard, held: impl FnOnce(&str) -> Held) -> Result<Self, LockError> {
        let folder = layout.path(&shard.folder());
        let lock = Self::take(&folder, held)?;
        atomic::sweep(&folder);
        Ok(lock)
    }

    fn take(folder: &Path, held: impl FnOnce(&str) -> Held) -> Result<Self, LockError> {
        let path = folder.join(".lock");
        let fail = |source| LockError::File(FileError::new("lock", &path, source));
        atomic::make_folder(folder).map_err(fail)?;
        let mut file = File::options().create(true).truncate(false).read(true).write(true).open(&path).map_err(fail)?;
        match file.try_lock() {
            Ok(()) => {}
            Err(TryLockError::WouldBlock) => {
                // A process that has just taken the lock has not signed it yet.
                let signed = fs::read_to_string(&path).ok().filter(|text| !text.is_empty());
                let holder = signed.unwrap_or_else(|| "its process number is not known".into());
                if held(&holder) == Held::GiveUp {
                    return Err(LockError::Held { holder });
                }
                file.lock().map_err(fail)?;
            }
            Err(TryLockError::Error(source)) => return Err(fail(source)),
        }
        // For the information of other runs only: on a full disk it stays empty.
        let _ = file.set_len(0).and_then(|()| file.write_all(signature().as_bytes()));
        Ok(Self { file })
    }
}

impl Drop for Lock {
    fn drop(&mut self) {
        let _ = self.file.set_len(0);
    }
}

/// Who this is, for a person who waits.
fn signature() -> String {
    let arguments: Vec<String> = std::env::args_os().skip(1).map(|word| word.to_string_lossy().into_owned()).collect();
    let host = fs::read_to_string("/proc/sys/kernel/hostname").unwrap_or_default();
    let host = if host.trim().is_empty() { String::new() } else { format!(" on {}", host.trim()) };
    format!("process {}{host}, `{}`", std::process::id(), ["shotdamp".to_owned(), arguments.join(" ")].join(" ").trim())
}

fn sweep_below(folder: &Path, depth: u32) {
    atomic::sweep(folder);
    let Ok(entries) = fs::read_dir(folder) else { return };
    for entry in entries.flatten().filter(|_| depth > 0) {
        if entry.file_type().is_ok_and(|kind| kind.is_dir()) {
            sweep_below(&entry.path(), depth - 1);
        }
    }
}
