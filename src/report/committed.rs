//! Whether the reports on disk are what would be written now: byte for byte, and none too many.

use std::collections::BTreeSet;
use std::fmt;
use std::fs;
use std::path::Path;

use super::other_pages::is_written_otherwise;
use super::pages::{NotDrawn, render, rendered};
use super::verdicts::Judgement;
use crate::study::FileKind;
use crate::study::{Refused, Study, stem};

/// What a run writes below `reports/` for an experiment.
const ENDINGS: [&str; 3] = ["md", "png", "svg"];
/// Experiments without a table that are named.
const NAMED: usize = 3;
/// Longest part of a line that is told.
const LONGEST: usize = 160;

/// A file that is not what would be written.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Departure {
    /// By its name within the study.
    pub file: String,
    /// In what.
    pub how: How,
}

/// How a file departs.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum How {
    /// It is not there.
    Missing,
    /// Nothing would write it.
    Extra,
    /// These experiments have no table that is up to date.
    NoTable(Vec<String>),
    /// It holds verdicts, and a reference cannot be read.
    NotJudged,
    /// It cannot be drawn, for this reason.
    NotDrawn(NotDrawn),
    /// It cannot be read, for this reason.
    Unreadable(String),
    /// A text that differs first in this line.
    Line {
        /// Counted from 1.
        number: usize,
        /// As it stands; `None` beyond the end.
        committed: Option<String>,
        /// As it would be.
        generated: Option<String>,
    },
    /// No text; it differs first in this byte, counted from 0.
    Byte(usize),
}

/// Every file below `reports/` that departs from what would be written, in the order of the names; while references cannot be read,
/// these alone. Of the experiments in `only` where there are any: then without the pages of the whole study.
#[must_use]
pub fn departures(study: &Study, judgement: &Judgement, only: Option<&BTreeSet<&str>>) -> Vec<Departure> {
    // Its verdicts stand on the pages of other experiments, too, and a variant that only its entries ask for is not planned.
    let unread = study.unread.iter().map(Refused::file).filter(|file| FileKind::of(file) == Some(FileKind::Reference));
    let unread: Vec<_> = unread.map(|file| Departure { file: file.into(), how: How::NotJudged }).collect();
    if !unread.is_empty() {
        return unread;
    }
    let expected = render(study, judgement, only);
    let mut found: Vec<Departure> = Vec::new();
    for (file, bytes) in &expected {
        let how = match bytes {
            Err(why) => Some(How::NotDrawn(why.clone())),
            Ok(generated) => match fs::read(study.layout.path(file)) {
                Ok(committed) => difference(&committed, generated),
                Err(error) if error.kind() == std::io::ErrorKind::NotFound => Some(How::Missing),
                Err(error) => Some(How::Unreadable(error.to_string())),
            },
        };
        found.extend(how.map(|how| Departure { file: file.clone(), how }));
    }
    let is_asked_for = |id: &str| only.is_none_or(|only| only.contains(id));
    let unmade = study.items.iter().filter(|item| item.record().is_none());
    let unmade = unmade.map(|item| item.source.experiment.id.0.clone()).filter(|id| is_asked_for(id));
    match unmade.collect::<Vec<_>>() {
        none if none.is_empty() => {}
        ids => found.push(Departure { file: format!("reports of {}", named(&ids)), how: How::NoTable(ids) }),
    }
    let extra = match only {
        None => extra(study, &expected.into_keys().collect()),
        Some(_) => {
            let mut extra = extra(study, &rendered(study, judgement));
            extra.retain(|file| owner(study, file).is_some_and(is_asked_for));
            extra
        }
    };
    found.extend(extra.into_iter().map(|file| Departure { file, how: How::Extra }));
    found.sort_by(|a, b| a.file.cmp(&b.file));
    found
}

/// Every page and picture below `reports/` that nothing would write, by its name within the study.
#[must_use]
pub fn extra_files(study: &Study, judgement: &Judgement) -> BTreeSet<String> {
    let mut files = extra(study, &rendered(study, judgement));
    // Of what a run writes: anything else is somebody's own, and `departures` tells of it.
    files.retain(|file| file.rsplit_once('.').is_some_and(|(_, ending)| ENDINGS.contains(&ending)));
    files
}

/// All files below `reports/`.
pub(super) fn present(study: &Study) -> BTreeSet<String> {
    let mut present = BTreeSet::new();
    walk(&study.layout.path("reports"), "reports", &mut present);
    present
}

/// The files below `reports/` that are none of the `expected`.
fn extra(study: &Study, expected: &BTreeSet<String>) -> BTreeSet<String> {
    let mut present = present(study);
    // Whose table is out of date, or whose file cannot be read, has pages that cannot be told from those of an experiment that is gone.
    let made = study.items.iter().filter(|item| item.record().is_some());
    let made: BTreeSet<&str> = made.map(|item| item.source.experiment.id.0.as_str()).collect();
    let unmade = |file: &str| owner(study, file).is_some_and(|id| !made.contains(id));
    let otherwise = |file: &str| file.strip_prefix("reports/").is_some_and(is_written_otherwise);
    present.retain(|file| !expected.contains(file) && !unmade(file) && !otherwise(file));
    present
}

/// Whose file it is: the longest id that its name begins with.
fn owner<'a>(study: &'a Study, file: &str) -> Option<&'a str> {
    study.texts.ids().into_iter().filter(|id| stem(file).starts_with(id)).max_by_key(|id| id.len())
}

/// A few experiments by their ids, of many the number.
fn named(ids: &[String]) -> String {
    match ids {
        few if few.len() <= NAMED => few.join(", "),
        many => format!("{} experiments ({}, …)", many.len(), many[..NAMED].join(", ")),
    }
}

/// `None` if they are the same.
fn difference(committed: &[u8], generated: &[u8]) -> Option<How> {
    if committed == generated {
        return None;
    }
    let (Ok(old), Ok(new)) = (std::str::from_utf8(committed), std::str::from_utf8(generated)) else {
        let same = committed.iter().zip(generated).take_while(|(a, b)| a == b).count();
        return Some(How::Byte(same));
    };
    // With their ends, so that a line break more or less is a difference too.
    let (mut old, mut new) = (old.split_inclusive('\n'), new.split_inclusive('\n'));
    let mut number = 0;
    loop {
        number += 1;
        match (old.next(), new.next()) {
            (Some(a), Some(b)) if a == b => {}
            (a, b) => {
                let line = |line: Option<&str>| line.map(clipped);
                return Some(How::Line { number, committed: line(a), generated: line(b) });
            }
        }
    }
}

fn clipped(line: &str) -> String {
    let line = line.trim_end_matches('\n');
    if line.chars().count() <= LONGEST { line.into() } else { line.chars().take(LONGEST - 1).chain(['…']).collect() }
}

fn walk(folder: &Path, name: &str, found: &mut BTreeSet<String>) {
    let Ok(entries) = fs::read_dir(folder) else { return };
    for entry in entries.flatten() {
        let Ok(file_name) = entry.file_name().into_string() else { continue };
        if file_name.starts_with('.') {
            continue;
        }
        let name = format!("{name}/{file_name}");
        // A linked folder holds somebody's own files, or some that are here anyway.
        let Ok(kind) = entry.file_type() else { continue };
        if kind.is_symlink() && entry.path().is_dir() {
            continue;
        }
        if kind.is_dir() {
            walk(&entry.path(), &name, found);
        } else {
            found.insert(name);
        }
    }
}

impl fmt::Display for Departure {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let file = &self.file;
        match &self.how {
            How::Missing => write!(f, "{file}: is not there"),
            How::Extra => write!(f, "{file}: nothing writes it; remove it"),
            How::NoTable(ids) => match ids.as_slice() {
                [id] => write!(f, "{file}: there is no table that is up to date; `shotdamp run {id}` makes it"),
                _ => write!(f, "{file}: there are no tables that are up to date; `shotdamp run` makes them"),
            },
            How::NotJudged => write!(f, "reports cannot be checked while {file} cannot be read"),
            How::NotDrawn(why) => write!(f, "{file}: cannot be drawn: {why}"),
            How::Unreadable(why) => write!(f, "{file}: cannot be read: {why}"),
            How::Byte(at) => write!(f, "{file}: differs from byte {at} on"),
            How::Line { number, committed, generated } => {
                let text = |line: &Option<String>| line.clone().unwrap_or_else(|| "(the text ends here)".into());
                write!(
                    f,
                    "{file}:{number}: differs first in this line\n    committed  {}\n    generated  {}",
                    text(committed),
                    text(generated)
                )
            }
        }
    }
}
