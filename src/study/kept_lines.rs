//! A file of lines that grows while something is evaluated, so that an interrupted run goes on from it.
//!
//! It saves time and decides nothing: one that cannot be read or written is done without. A line that was cut off, and all after it,
//! does not count, and is written over.

use std::fs::{self, File};
use std::io::Write;
use std::path::Path;

/// Where lines are kept; nowhere if there is no file.
#[derive(Debug)]
pub(crate) struct KeptLines(Option<File>);

impl KeptLines {
    /// Reads the lines after `header` up to the first that `read` does not take; a file with another header begins anew.
    pub(crate) fn open(path: Option<&Path>, header: &str, mut read: impl FnMut(&str) -> bool) -> Self {
        let Some(path) = path else { return Self(None) };
        let text = fs::read_to_string(path).unwrap_or_default();
        let mut whole = 0;
        if let Some(lines) = text.strip_prefix(header) {
            whole = header.len();
            for line in lines.split_inclusive('\n') {
                if !line.strip_suffix('\n').is_some_and(&mut read) {
                    break;
                }
                whole += line.len();
            }
        }
        let begun = || {
            if let Some(folder) = path.parent() {
                fs::create_dir_all(folder)?;
            }
            let mut file = File::options().create(true).truncate(false).append(true).open(path)?;
            file.set_len(whole as u64)?;
            if whole == 0 {
                file.write_all(header.as_bytes())?;
            }
            Ok::<_, std::io::Error>(file)
        };
        Self(begun().ok())
    }

    /// Adds whole lines, and sees to it that they reach the disk.
    pub(crate) fn append(&mut self, lines: &str) {
        if lines.is_empty() {
            return;
        }
        let kept = self.0.as_mut().map(|file| file.write_all(lines.as_bytes()).and_then(|()| file.sync_data()));
        if let Some(Err(_)) = kept {
            // A full disk ends the file, not the run.
            self.0 = None;
        }
    }
}
