//! Accepting what came out: the verdict that an entry expects is changed in its file, with the reason.

use super::entry::{Entry, ReferenceFile};
use super::entry_reader::parse_reference;
use super::judged::{Judged, Kind};
use super::verdict::Verdict;
use crate::yaml::{Written, set_keys};

/// Why a verdict cannot be accepted.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum AcceptError {
    /// There is no result.
    #[error("`{id}` is missing, which is never an expected verdict: {found}")]
    Missing {
        /// The entry.
        id: String,
        /// Why there is no result.
        found: String,
    },
    /// A claim waits for what the study does not state.
    #[error(
        "`{id}` is blocked, which no accepted verdict changes: {found}; once the study states what is missing, take \
         `blocked_by` out of the entry"
    )]
    Waits {
        /// The entry.
        id: String,
        /// For what.
        found: String,
    },
    /// There is nothing to accept.
    #[error("`{id}` is as expected already: {verdict}")]
    AsExpected {
        /// The entry.
        id: String,
        /// In a word.
        verdict: String,
    },
    /// No reason was given.
    #[error("an accepted verdict needs a reason: --reason TEXT")]
    NoReason,
    /// The reason cannot stand in an explanation.
    #[error("`{reason}` cannot be an explanation: {problem}")]
    Reason {
        /// What was given.
        reason: String,
        /// What is wrong with it.
        problem: String,
    },
    /// The file is laid out in a way that cannot be changed safely.
    #[error(
        "`{id}` cannot be changed without changing more than it; set `expected` and `explanation` by hand (line {line})"
    )]
    ByHand {
        /// The entry.
        id: String,
        /// Its first line.
        line: u64,
    },
}

/// The text of a reference file in which an entry expects the verdict that it got, and says why. All else stays as it is to
/// the byte.
///
/// # Errors
/// [`AcceptError`]; nothing is changed then.
pub fn accept(file: &ReferenceFile, text: &str, judged: &Judged, reason: &str) -> Result<String, AcceptError> {
    let id = judged.id.clone();
    if judged.verdict == Verdict::Missing {
        return Err(AcceptError::Missing { id, found: judged.found.clone() });
    }
    if (judged.kind, judged.verdict) == (Kind::Claim, Verdict::Blocked) {
        return Err(AcceptError::Waits { id, found: judged.found.clone() });
    }
    let verdict = crate::text::words::of_key(&judged.verdict);
    if judged.as_expected() {
        return Err(AcceptError::AsExpected { id, verdict });
    }
    let reason = reason.split_whitespace().collect::<Vec<_>>().join(" ");
    if reason.is_empty() {
        return Err(AcceptError::NoReason);
    }
    let line = file.entries.iter().find(|entry| entry.id == id).map_or(0, |entry| entry.line);
    let name = id.strip_prefix(&format!("{}/", file.experiment)).unwrap_or(&id);
    let changes = [("expected", Written::Word(&verdict)), ("explanation", Written::Prose(&reason))];
    let changed = set_keys(text, "entries", name, &changes);
    // Whatever the layout was: the new text has to mean this, and nothing else may have moved.
    let wanted = meaning(file, Some((&id, judged.verdict, &reason)));
    let Some(changed) = changed else { return Err(AcceptError::ByHand { id, line }) };
    match parse_reference(&file.experiment, "", &changed) {
        Ok(read) if meaning(&read, None) == wanted => Ok(changed),
        Ok(_) => Err(AcceptError::ByHand { id, line }),
        // The file could be read before.
        Err(problems) => {
            let problem = problems.list.first().map(|first| first.message.clone()).unwrap_or_default();
            Err(AcceptError::Reason { reason, problem })
        }
    }
}

/// The entries without their lines, with one of them changed.
fn meaning(file: &ReferenceFile, change: Option<(&str, Verdict, &str)>) -> Vec<Entry> {
    let mut entries = file.entries.clone();
    for entry in &mut entries {
        entry.line = 0;
        if let Some((_, expected, explanation)) = change.filter(|(id, ..)| *id == entry.id) {
            entry.expected = expected;
            entry.explanation = explanation.into();
        }
    }
    entries
}
