//! What a calibration has evaluated: the error of an entry under each set of inputs, so that an interrupted one goes on.
//!
//! An error stands under the hash of all that it depends on: the solver's version, the rows that the entry reads, the values of the
//! inputs that these depend on, and the entry. So an error is used again wherever the same is asked, also after the
//! calibration's file has changed. Numbers are written as their bits.

use std::collections::BTreeMap;
use std::path::Path;

use crate::study::KeptLines;

const HEADER: &str = "shotdamp calibration 3\n";
/// In the place of the bits of an error that is none.
const NO_NUMBER: &str = "none";

/// The error of an entry.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Weighed {
    pub error: f64,
    /// What it adds to the sum of squares.
    pub square: f64,
}

/// The error of an entry; none where it has no number.
pub(super) type EntryError = Option<Weighed>;

/// Errors by the hash of what they depend on, and where they are kept.
pub(super) struct Journal {
    known: BTreeMap<String, EntryError>,
    lines: KeptLines,
}

impl Journal {
    /// The journal at `path`.
    pub(super) fn open(path: Option<&Path>) -> Self {
        let mut known = BTreeMap::new();
        let read = |line: &str| read_line(line).map(|(key, error)| known.insert(key, error)).is_some();
        let lines = KeptLines::open(path, HEADER, read);
        Self { known, lines }
    }

    pub(super) fn get(&self, key: &str) -> Option<EntryError> {
        self.known.get(key).copied()
    }

    /// Adds errors, and sees to it that they reach the disk.
    pub(super) fn add(&mut self, new: Vec<(String, EntryError)>) {
        let mut text = String::new();
        for (key, error) in new {
            let bits = error.map_or_else(
                || NO_NUMBER.to_owned(),
                |Weighed { error, square }| format!("{:016x}{:016x}", error.to_bits(), square.to_bits()),
            );
            text += &format!("{key} {bits}\n");
            self.known.insert(key, error);
        }
        self.lines.append(&text);
    }
}

fn read_line(line: &str) -> Option<(String, EntryError)> {
    let (key, bits) = line.split_once(' ')?;
    let error = match bits {
        NO_NUMBER => None,
        bits if bits.len() == 32 => {
            let number = |digits: &str| u64::from_str_radix(digits, 16).ok().map(f64::from_bits);
            Some(Weighed { error: number(bits.get(..16)?)?, square: number(bits.get(16..)?)? })
        }
        _ => return None,
    };
    (key.len() == 64).then(|| (key.to_owned(), error))
}
