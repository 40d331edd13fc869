//! Why something is stale: the file, the key, the old value and the new.

use std::fmt;

use serde_json::Value;

use super::canonical::{Change, canonical};
use super::failures::Failures;
use super::inputs::Inputs;

/// One reason.
#[derive(Debug, Clone, PartialEq)]
pub enum Reason {
    /// There is no record.
    NeverRun,
    /// There is a record that does not count, with the reason.
    RecordUnreadable(String),
    /// An input has changed.
    Changed {
        /// The file that it stands in.
        file: String,
        /// The leaf.
        change: Change,
    },
    /// More such leaves in the same file.
    MoreChanged {
        /// The file.
        file: String,
        /// How many more.
        count: usize,
    },
    /// An output is gone.
    FileMissing(String),
    /// An output is not what was written.
    FileAltered(String),
    /// An output cannot be read, with what the system says.
    FileUnreadable(String, String),
    /// Rows failed the last time.
    Failed(Failures),
    /// There is a table and no report of it.
    NeverPublished,
}

/// Leaves listed one by one before the rest is counted: a longer sweep changes hundreds.
const LISTED: usize = 3;
/// Longest value that is printed in full.
const LONGEST: usize = 60;

/// The leaves in which `new` departs from `old`, each with the file that `file_of` finds for its path.
#[must_use]
pub fn differences(old: &Inputs, new: &Inputs, file_of: &dyn Fn(&[&str]) -> String) -> Vec<Reason> {
    let mut by_file: Vec<(String, Vec<Change>)> = Vec::new();
    for mut change in old.changes_to(new) {
        let file = file_of(&change.path.iter().map(String::as_str).collect::<Vec<_>>());
        if change.path.len() > 1 {
            change.path.remove(0);
        }
        match by_file.iter_mut().find(|(known, _)| *known == file) {
            Some((_, list)) => list.push(change),
            None => by_file.push((file, vec![change])),
        }
    }
    let mut reasons = Vec::new();
    for (file, list) in by_file {
        let count = list.len().saturating_sub(LISTED);
        reasons.extend(list.into_iter().take(LISTED).map(|change| Reason::Changed { file: file.clone(), change }));
        if count > 0 {
            reasons.push(Reason::MoreChanged { file, count });
        }
    }
    reasons
}

impl Reason {
    /// As [`fmt::Display`] has it, with the line that `line_of` finds for the file and the path of what changed.
    #[must_use]
    pub fn describe(&self, line_of: impl Fn(&str, &[String]) -> Option<usize>) -> String {
        let line = match self {
            Self::Changed { file, change } => line_of(file, &change.path).map(|line| (file, line)),
            _ => None,
        };
        let text = self.to_string();
        match line.and_then(|(file, line)| Some((file, line, text.strip_prefix(file.as_str())?))) {
            Some((file, line, rest)) => format!("{file}:{line}{rest}"),
            None => text,
        }
    }
}

impl fmt::Display for Reason {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::NeverRun => write!(f, "it has not been run to its end"),
            Self::RecordUnreadable(what) => write!(f, "its record cannot be used: {what}"),
            Self::Changed { file, change } => {
                let Change { path, old, new } = change;
                write!(f, "{file}: {}: {} -> {}", key(path), describe(old.as_ref()), describe(new.as_ref()))
            }
            Self::MoreChanged { file, count } => write!(f, "{file}: and {count} more"),
            Self::FileMissing(name) => write!(f, "{name} is missing"),
            Self::FileAltered(name) => write!(f, "{name} is not what was written"),
            Self::FileUnreadable(name, why) => write!(f, "{name} cannot be read: {why}"),
            Self::Failed(failures) => write!(f, "{failures}"),
            Self::NeverPublished => write!(f, "figures and report have not been made"),
        }
    }
}

/// The key as it stands in the YAML.
fn key(path: &[String]) -> String {
    let mut keys: Vec<&str> = path.iter().map(String::as_str).collect();
    if keys.first() == Some(&"recipe") {
        keys[0] = "scene";
    }
    // How a value is held inside is not how it is written: `stop_length: 60 mm`, not `stop_length.number`.
    while keys.len() > 1 && matches!(keys.last(), Some(&("number" | "choice" | "curve" | "stated" | "assumed"))) {
        keys.pop();
    }
    keys.join(".")
}

/// A case by what it sets: `gap_ratio = 3.0`.
fn case(value: &Value) -> Option<String> {
    let set = |pair: &Value| match pair.as_array()?.as_slice() {
        [Value::String(name), Value::String(word)] => Some(format!("{name} = {word}")),
        [Value::String(name), Value::Object(held)] if held.len() == 1 => {
            held.values().next().map(|value| format!("{name} = {}", describe(Some(value))))
        }
        _ => None,
    };
    let values = value.get("values")?.as_array().filter(|values| !values.is_empty())?;
    Some(values.iter().map(set).collect::<Option<Vec<_>>>()?.join(", "))
}

fn describe(value: Option<&Value>) -> String {
    let text = match value {
        None => return "(absent)".into(),
        Some(Value::String(text)) => text.clone(),
        Some(value) => case(value).unwrap_or_else(|| canonical(value)),
    };
    if text.chars().count() <= LONGEST { text } else { text.chars().take(LONGEST - 1).chain(['…']).collect() }
}
