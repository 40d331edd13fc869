//! The journal of an optimisation: every point that was evaluated, with its score, so that an interrupted run goes on.
//!
//! Searches are deterministic, so nothing else has to be kept: the next run asks for the same points, takes those that the
//! journal knows, and goes on where it ended, to the same bytes. Numbers are written as their bits.

use std::collections::BTreeMap;
use std::path::Path;

use super::kept_lines::KeptLines;
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
    lines: KeptLines,
}

impl Journal {
    /// The journal at `path`, if it has the same `fingerprint`; else a new one.
    pub(super) fn open(path: Option<&Path>, fingerprint: &str) -> Self {
        let mut known = BTreeMap::new();
        let read = |line: &str| read_line(line).map(|(point, is)| known.insert(point, is)).is_some();
        let lines = KeptLines::open(path, &format!("shotdamp journal 2 {fingerprint}\n"), read);
        Self { known, lines }
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
        self.lines.append(&text);
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
