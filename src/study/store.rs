//! Results on disk: tables and records, and the lock that keeps two runs apart.

use std::fs::{self, File, TryLockError};
use std::path::Path;

use super::layout::{Layout, journal_name, record_name, table_name};
use super::plan::Item;
use super::record::{FileHash, RECORD_FORMAT, Record};
use super::run::Finished;
use crate::atomic::{self, FileError};
use crate::table::{ParquetError, parquet};

/// Writes an experiment's table and then its record, which is what makes the table count.
///
/// # Errors
/// [`ParquetError`] if one of them cannot be written; the record then still tells of the table before, or of none.
pub fn save(layout: &Layout, item: &Item, finished: &Finished) -> Result<Record, ParquetError> {
    let id = &item.source.experiment.id;
    let bytes = parquet::write(&finished.table, &layout.path(&table_name(id)))?;
    let record = Record {
        format: RECORD_FORMAT,
        experiment: id.clone(),
        simulation: item.simulation.clone(),
        table: FileHash::of(&bytes),
        failures: finished.failures.clone(),
        publication: None,
    };
    record.write(&layout.path(&record_name(id)))?;
    if finished.failures.rows == 0 {
        // What it was kept for is done; one that cannot be removed is begun anew by the next optimisation.
        let _ = fs::remove_file(layout.path(&journal_name(id)));
    }
    Ok(record)
}

/// Held while files of the study are written; other runs wait.
#[derive(Debug)]
pub struct Lock {
    _file: File,
}

impl Lock {
    /// Takes the lock; calls `waiting` first if another run holds it. Removes what killed runs left behind.
    ///
    /// # Errors
    /// [`FileError`] if the folder cannot be made or locked.
    pub fn take(layout: &Layout, waiting: impl FnOnce()) -> Result<Self, FileError> {
        let results = layout.results();
        let path = results.join(".lock");
        let fail = |source| FileError::new("lock", &path, source);
        fs::create_dir_all(&results).map_err(fail)?;
        let file = File::options().create(true).truncate(false).write(true).open(&path).map_err(fail)?;
        match file.try_lock() {
            Ok(()) => {}
            Err(TryLockError::WouldBlock) => {
                waiting();
                file.lock().map_err(fail)?;
            }
            Err(TryLockError::Error(source)) => return Err(fail(source)),
        }
        atomic::sweep(&results);
        sweep_below(&layout.path("reports"), 4);
        Ok(Self { _file: file })
    }
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
