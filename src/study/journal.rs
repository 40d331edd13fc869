//! The journal of an optimisation: every point that was evaluated, with its score, so that an interrupted run goes on.
//!
//! Searches are deterministic, so nothing else has to be kept: the next run asks for the same points, takes those that the
//! journal knows, and goes on where it ended, to the same bytes. Numbers are written as their bits; a line that was cut off, and
//! all after it, does not count.

use std::collections::BTreeMap;
use std::fs::{self, File};
use std::io::Write;
use std::path::Path;

use crate::optimise::Score;

/// What is known of a point.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Known {
    pub score: Score,
    /// How long its evaluation took, s.
    pub seconds: f64,
}

/// Points with what is known of them, and where that is kept.
pub(super) struct Journal {
    known: BTreeMap<Vec<u64>, Known>,
    file: Option<File>,
}

impl Journal {
    /// The journal at `path`, if it has the same `fingerprint`; else a new one. One that cannot be read or written is done
    /// without: it saves time and decides nothing.
    pub(super) fn open(path: Option<&Path>, fingerprint: &str) -> Self {
        let header = format!("shotdamp journal 2 {fingerprint}\n");
        let Some(path) = path else { return Self { known: BTreeMap::new(), file: None } };
        let text = fs::read_to_string(path).unwrap_or_default();
        let mut known = BTreeMap::new();
        let mut whole = 0;
        if let Some(lines) = text.strip_prefix(&header) {
            whole = header.len();
            for line in lines.split_inclusive('\n') {
                let Some((point, is)) = line.strip_suffix('\n').and_then(read_line) else { break };
                known.insert(point, is);
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
        Self { known, file: begun().ok() }
    }

    pub(super) fn get(&self, point: &[f64]) -> Option<Known> {
        self.known.get(&key(point)).copied()
    }

    /// Adds what was evaluated, and sees to it that it reaches the disk.
    pub(super) fn add(&mut self, new: &[(Vec<f64>, Known)]) {
        let mut text = String::new();
        for (point, known) in new {
            self.known.insert(key(point), *known);
            text += &line(point, known);
        }
        let kept = self.file.as_mut().map(|file| file.write_all(text.as_bytes()).and_then(|()| file.sync_data()));
        if let Some(Err(_)) = kept {
            // A full disk ends the journal, not the optimisation.
            self.file = None;
        }
    }
}

fn key(point: &[f64]) -> Vec<u64> {
    point.iter().map(|x| x.to_bits()).collect()
}

fn line(point: &[f64], known: &Known) -> String {
    let numbers = point.iter().copied().chain([known.score.value, known.seconds]);
    let words: Vec<String> = numbers.map(|x| format!("{:016x}", x.to_bits())).collect();
    words.join(" ") + "\n"
}

fn read_line(line: &str) -> Option<(Vec<u64>, Known)> {
    let word = |word: &str| (word.len() == 16).then(|| u64::from_str_radix(word, 16).ok()).flatten();
    let bits = line.split(' ').map(word).collect::<Option<Vec<_>>>()?;
    let (point, rest) = bits.split_at_checked(bits.len().checked_sub(2)?)?;
    let [value, seconds] = [rest[0], rest[1]].map(f64::from_bits);
    Some((point.to_vec(), Known { score: Score { value }, seconds }))
}
