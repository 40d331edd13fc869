//! The comment on a pull request: first what it changes against the committed verdicts, then the summary of a check.

use super::finding::CheckView;
use super::in_pieces::{Section, summary};
use super::json::Standing;
use super::markdown::{escaped, one_line};
use super::movement::{Moved, between_verdicts, standing};
use crate::text::number::{compact, significant};

/// Longest comment, bytes: GitHub takes 65536 characters.
pub const PULL_REQUEST_LIMIT: usize = 60_000;

/// Markdown of at most [`PULL_REQUEST_LIMIT`] bytes; `committed` are the verdicts before, of this and other experiments.
#[must_use]
pub fn pull_request(view: &CheckView<'_>, committed: &[Standing]) -> String {
    let now: Vec<Standing> = view.entries.iter().map(|entry| standing(entry.judged)).collect();
    let checked = |id: &str| view.entries.iter().any(|entry| id.starts_with(&format!("{}/", entry.judged.experiment)));
    let before: Vec<Standing> = committed.iter().filter(|one| checked(&one.id)).cloned().collect();
    let movement = between_verdicts(&before, &now);
    let mut pieces: Vec<String> = Vec::new();
    for (id, old, new) in &movement.judged_differently {
        let found = now.iter().find(|one| one.id == *id).map_or("", |one| one.found.as_str());
        pieces.push(format!("- `{id}`: {old} → **{new}**; {}\n", escaped(&one_line(found))));
    }
    for (id, old, new) in &movement.read_differently {
        pieces.push(format!("- `{id}`: the same verdict, {} → {}\n", escaped(&one_line(old)), escaped(&one_line(new))));
    }
    pieces.extend(movement.new.iter().map(|id| format!("- `{id}`: new\n")));
    pieces.extend(movement.gone.iter().map(|id| format!("- `{id}`: removed\n")));
    pieces.extend(movement.moved.iter().map(number));
    if pieces.is_empty() {
        pieces.push("No verdict and no number changed.\n".into());
    }
    let changes =
        Section { heading: "### Changed against the committed verdicts\n\n", what: ["change", "changes"], pieces };
    summary(view, Some(changes), PULL_REQUEST_LIMIT)
}

fn number(moved: &Moved) -> String {
    let beyond = if moved.is_beyond() { "**beyond its uncertainty**" } else { "within its uncertainty" };
    let (from, to) = (compact(moved.from, 6), compact(moved.to, 6));
    format!("- `{}`: {from} → {to}, {beyond} ({} u)\n", moved.name, significant(moved.deviation(), 2))
}
