//! What a calibration has evaluated: the error of an entry under each set of inputs, so that an interrupted one goes on.
//!
//! An error stands under the hash of all that it depends on: the solver's version, the rows that the entry reads, the values of the
//! inputs that these depend on, and the entry. So an error is used again wherever the same is asked, also after the
//! calibration's file has changed. Numbers are written as their bits; a line that was cut off, and all after it, does not count.

use std::collections::BTreeMap;
use std::fs::{self, File};
use std::io::Write;
use std::path::Path;

const HEADER: &str = "shotdamp calibration 1\n";
/// In the place of the bits of an error that is none.
const NO_NUMBER: &str = "none";

/// The error of an entry; none where it has no number.
pub(super) type EntryError = Option<f64>;

/// Errors by the hash of what they depend on, and where they are kept.
pub(super) struct Journal {
    known: BTreeMap<String, EntryError>,
    file: Option<File>,
}

impl Journal {
    /// The journal at `path`. One that cannot be read or written is done without: it saves time and decides nothing.
    pub(super) fn open(path: Option<&Path>) -> Self {
        let Some(path) = path else { return Self { known: BTreeMap::new(), file: None } };
        let text = fs::read_to_string(path).unwrap_or_default();
        let (mut known, mut whole) = (BTreeMap::new(), 0);
        if let Some(lines) = text.strip_prefix(HEADER) {
            whole = HEADER.len();
            for line in lines.split_inclusive('\n') {
                let Some((key, error)) = line.strip_suffix('\n').and_then(read_line) else { break };
                known.insert(key, error);
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
                file.write_all(HEADER.as_bytes())?;
            }
            Ok::<_, std::io::Error>(file)
        };
        Self { known, file: begun().ok() }
    }

    pub(super) fn get(&self, key: &str) -> Option<EntryError> {
        self.known.get(key).copied()
    }

    /// Adds errors, and sees to it that they reach the disk.
    pub(super) fn add(&mut self, new: Vec<(String, EntryError)>) {
        let mut text = String::new();
        for (key, error) in new {
            let bits = error.map_or_else(|| NO_NUMBER.to_owned(), |error| format!("{:016x}", error.to_bits()));
            text += &format!("{key} {bits}\n");
            self.known.insert(key, error);
        }
        if text.is_empty() {
            return;
        }
        let kept = self.file.as_mut().map(|file| file.write_all(text.as_bytes()).and_then(|()| file.sync_data()));
        if let Some(Err(_)) = kept {
            // A full disk ends the journal, not the calibration.
            self.file = None;
        }
    }
}

fn read_line(line: &str) -> Option<(String, EntryError)> {
    let (key, bits) = line.split_once(' ')?;
    let error = match bits {
        NO_NUMBER => None,
        bits if bits.len() == 16 => Some(f64::from_bits(u64::from_str_radix(bits, 16).ok()?)),
        _ => return None,
    };
    (key.len() == 64).then(|| (key.to_owned(), error))
}
