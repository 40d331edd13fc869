//! Verdicts as JSON, for programs: the same facts as the console, none rounded.

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};

use super::finding::{self, CheckView};
use crate::reference::{Comparison, Judged, NoTable};
use crate::text::json;

/// Raised when a key changes its meaning.
const FORMAT: u32 = 1;

/// One document, indented, keys in a fixed order. A number that is not finite is `null`.
#[must_use]
pub fn json(view: &CheckView<'_>) -> String {
    let document = Document {
        format: FORMAT,
        entries: view.entries.iter().map(|entry| Entry::of(entry.judged, entry.file)).collect(),
        unusable: view.troubles.iter().map(|one| Unusable { file: &one.file, message: &one.message }).collect(),
    };
    json::page(&document)
}

#[derive(Serialize)]
struct Document<'a> {
    format: u32,
    entries: Vec<Entry<'a>>,
    unusable: Vec<Unusable<'a>>,
}

#[derive(Serialize)]
struct Unusable<'a> {
    file: &'a str,
    message: &'a str,
}

#[derive(Serialize)]
struct Entry<'a> {
    #[serde(flatten)]
    judged: &'a Judged,
    as_expected: bool,
    /// The numbers, each with E, u_val and |E|/u_val.
    deviations: Vec<Deviation<'a>>,
    file: &'a str,
    rerun: String,
}

#[derive(Serialize)]
struct Deviation<'a> {
    name: &'a str,
    error: f64,
    u_val: f64,
    in_u_val: f64,
    tolerance: f64,
}

impl<'a> Entry<'a> {
    fn of(judged: &'a Judged, file: &'a str) -> Self {
        let deviation = |(name, comparison): (&'a str, &Comparison)| Deviation {
            name,
            error: comparison.error(),
            u_val: comparison.u_val(),
            in_u_val: comparison.deviation(),
            tolerance: comparison.tolerance(),
        };
        Self {
            judged,
            as_expected: judged.as_expected(),
            deviations: judged.comparisons().map(deviation).collect(),
            file,
            rerun: finding::rerun(judged),
        }
    }
}

/// How an entry stands in such a document.
#[derive(Debug, Clone, PartialEq)]
pub struct Standing {
    /// `ch3-favourable-impact/velocity-ratio`.
    pub id: String,
    /// The verdict's word.
    pub verdict: String,
    /// What came out, in words.
    pub found: String,
    /// The table that it reads and that is not there.
    pub no_table: Option<NoTable>,
    /// Its numbers by the names of its parts.
    pub numbers: BTreeMap<String, Number>,
}

/// A number that came out.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Number {
    /// S.
    pub value: f64,
    /// u_num.
    pub u: f64,
}

impl Number {
    /// There is none.
    pub(super) const NONE: Self = Self { value: f64::NAN, u: f64::NAN };

    /// Both to 15 significant digits: what every reader of JSON gives back, and this one.
    pub(super) fn of(value: f64, u: f64) -> Self {
        // The text of a number always reads back.
        let rounded = |x: f64| format!("{x:.14e}").parse().unwrap_or(x);
        Self { value: rounded(value), u: rounded(u) }
    }
}

/// Why verdicts cannot be read.
#[derive(Debug, thiserror::Error)]
pub enum VerdictsError {
    /// Not a document of verdicts.
    #[error(transparent)]
    Json(#[from] serde_json::Error),
    /// Written by another version.
    #[error("it has the format {found} instead of {FORMAT}: write it again with this version, `shotdamp check --json`")]
    Format {
        /// Its format.
        found: u32,
    },
}

/// Reads such a document again.
///
/// # Errors
/// [`VerdictsError`] if it is no such document.
pub fn read_json(text: &str) -> Result<Vec<Standing>, VerdictsError> {
    let document: Written = serde_json::from_str(text)?;
    if document.format != FORMAT {
        return Err(VerdictsError::Format { found: document.format });
    }
    Ok(document.entries.into_iter().map(WrittenEntry::standing).collect())
}

#[derive(Deserialize)]
struct Written {
    format: u32,
    entries: Vec<WrittenEntry>,
}

#[derive(Deserialize)]
struct WrittenEntry {
    id: String,
    verdict: String,
    found: String,
    no_table: Option<NoTable>,
    comparison: Option<WrittenNumber>,
    parts: Vec<WrittenPart>,
}

#[derive(Deserialize)]
struct WrittenPart {
    name: String,
    comparison: Option<WrittenNumber>,
}

/// `null` is what JSON has for a number that is none.
#[derive(Deserialize)]
struct WrittenNumber {
    simulated: Option<f64>,
    u_num: Option<f64>,
}

impl WrittenEntry {
    fn standing(self) -> Standing {
        let number = |written: &WrittenNumber| {
            Number::of(written.simulated.unwrap_or(f64::NAN), written.u_num.unwrap_or(f64::NAN))
        };
        let own = self.comparison.iter().map(|written| (String::new(), number(written)));
        let parts = self.parts.iter().filter_map(|part| Some((part.name.clone(), number(part.comparison.as_ref()?))));
        let numbers = own.chain(parts).collect();
        Standing { id: self.id, verdict: self.verdict, found: self.found, no_table: self.no_table, numbers }
    }
}
