//! Markdown with a limit: sections in pieces, as many as fit, and a last sentence on what was cut.

use super::finding::{self, CheckView, CheckedEntry};
use super::markdown::{Align, MarkdownTable, escaped, one_line};
use super::tally::{Tally, VERDICTS};
use crate::reference::Judged;
use crate::text::words::counted;

/// Longest text of one thing in a summary, bytes.
const LONGEST_PIECE: usize = 16 << 10;
/// Kept free for the sentence on what was cut, bytes.
const CLOSING: usize = 512;

/// A heading and what stands under it.
pub(super) struct Section {
    pub(super) heading: &'static str,
    /// One and many of its pieces.
    pub(super) what: [&'static str; 2],
    pub(super) pieces: Vec<String>,
}

impl Section {
    /// Appends the pieces in order as long as `text` stays within `room`; returns how many it left out.
    fn write(&self, text: &mut String, room: usize) -> usize {
        let mut pieces = self.pieces.iter().filter(|piece| !piece.is_empty()).peekable();
        let fits = |text: &String, more: usize| text.len() + more <= room;
        match pieces.peek() {
            Some(first) if fits(text, self.heading.len() + first.len()) => text.push_str(self.heading),
            _ => return pieces.count(),
        }
        while let Some(piece) = pieces.next_if(|piece| fits(text, piece.len() + 1)) {
            text.push_str(piece);
        }
        text.push('\n');
        pieces.count()
    }
}

fn in_full(entry: &CheckedEntry<'_>) -> String {
    let one = entry.judged;
    let mut text = format!("- **`{}`**: {}, expected {}\n", one.id, one.verdict.word(), one.expected.word());
    for (label, line) in finding::lines(one) {
        let line = if label == "again" { format!("`{line}`") } else { escaped(&clipped(&line)) };
        text += &format!("  - {label}: {line}\n");
    }
    text
}

fn in_a_line(one: &Judged) -> String {
    format!("- `{}`: {}; {}\n", one.id, one.verdict.word(), escaped(&clipped(&one_line(&one.found))))
}

fn fenced(title: &str, message: &str) -> String {
    // A longer fence than any in the text.
    let longest = message.split(|letter| letter != '`').map(str::len).max().unwrap_or(0);
    let fence = "`".repeat(longest.max(2) + 1);
    format!("`{title}`\n\n{fence}text\n{}\n{fence}\n\n", clipped(message.trim_end()))
}

fn clipped(text: &str) -> String {
    if text.len() <= LONGEST_PIECE {
        return text.to_owned();
    }
    let mut end = LONGEST_PIECE;
    while !text.is_char_boundary(end) {
        end -= 1;
    }
    format!("{} … ({} bytes more)", &text[..end], text.len() - end)
}

fn by_experiment(view: &CheckView<'_>) -> String {
    let mut header = vec![("Experiment", Align::Left)];
    header.extend(VERDICTS.map(|verdict| (verdict.word(), Align::Right)));
    let mut table = MarkdownTable::new(&header);
    for experiment in view.entries.chunk_by(|a, b| a.judged.experiment == b.judged.experiment) {
        let tally = Tally::of(experiment.iter().map(|entry| entry.judged));
        let mut row = vec![format!("`{}`", experiment[0].judged.experiment)];
        row.extend(tally.each().map(|(_, count)| if count == 0 { String::new() } else { count.to_string() }));
        table.row(row);
    }
    table.finish()
}

/// The summary of a check: `before`, files that cannot be used, what is not as expected in full, all experiments, known differences.
/// At most `room` bytes; ends with what it had to leave out.
pub(super) fn summary(view: &CheckView<'_>, before: Option<Section>, room: usize) -> String {
    let unexpected = view.unexpected();
    let tally = Tally::of(view.entries.iter().map(|entry| entry.judged));
    let mut text = format!(
        "## Verdicts\n\n{}: {}. {}\n\n",
        counted(tally.total(), "entry", "entries"),
        tally.describe(),
        match unexpected.len() {
            0 => "All as expected.".to_owned(),
            some => format!("**{some} not as expected.**"),
        }
    );
    let sections = [
        Section {
            heading: "### Files that cannot be used\n\n",
            what: ["file that cannot be used", "files that cannot be used"],
            pieces: view.troubles.iter().map(|trouble| fenced(&trouble.file, &trouble.message)).collect(),
        },
        Section {
            heading: "### Not as expected\n\n",
            what: ["entry that is not as expected", "entries that are not as expected"],
            pieces: unexpected.iter().map(|entry| in_full(entry)).collect(),
        },
        Section {
            heading: "### By experiment\n\n",
            what: ["table of the experiments", "tables of the experiments"],
            pieces: vec![by_experiment(view)],
        },
        Section {
            heading: "### Not reproduced, as expected\n\n",
            what: ["known difference", "known differences"],
            pieces: view.known().iter().map(|entry| in_a_line(entry.judged)).collect(),
        },
    ];
    let mut cut = Vec::new();
    for section in before.iter().chain(&sections) {
        let left_out = section.write(&mut text, room.saturating_sub(CLOSING));
        if left_out > 0 {
            cut.push(counted(left_out, section.what[0], section.what[1]));
        }
    }
    if !cut.is_empty() {
        text += &format!("\nCut to the limit of a summary: {}. `shotdamp check` shows all.\n", cut.join(", "));
    }
    // Not even room for a heading.
    if text.len() > room { String::new() } else { text }
}
