//! Verdicts for GitHub Actions: annotations as workflow commands, and a summary of the step in Markdown.
//!
//! GitHub shows ten annotations a step and refuses a summary above 1 MiB; what does not fit is counted, never dropped in
//! silence.

use super::finding::{self, CheckView, CheckedEntry, Trouble};
use super::markdown::{Align, MarkdownTable, counted, escaped, one_line};
use super::tally::{Tally, VERDICTS, word};
use crate::reference::Judged;

/// Annotations told one by one; the tenth counts the rest.
const TOLD: usize = 9;
/// Longest summary of a step, bytes: GitHub takes 1 MiB, and a step may have something else to say.
pub const SUMMARY_LIMIT: usize = 900 << 10;
/// Longest text of one thing in a summary, bytes.
const LONGEST_PIECE: usize = 16 << 10;
/// Kept free for the sentence on what was cut, bytes.
const CLOSING: usize = 512;

/// One workflow command a line: files that cannot be used, then the worst entries, then how many more there are.
#[must_use]
pub fn annotations(view: &CheckView<'_>) -> String {
    let unexpected = view.unexpected();
    let troubles = view.troubles.iter().map(of_trouble);
    let all: Vec<String> = troubles.chain(unexpected.iter().map(|entry| of_entry(entry))).collect();
    let mut text: String = all.iter().take(TOLD).map(String::as_str).collect();
    if all.len() > TOLD {
        let title = format!("{} more not as expected", all.len() - TOLD);
        text += &command(&[("title", &title)], "All of them are in the summary of this step: `shotdamp check`.");
    }
    text
}

fn of_entry(entry: &CheckedEntry<'_>) -> String {
    let one = entry.judged;
    let title = format!("{}: {}, expected {}", one.id, word(one.verdict), word(one.expected));
    let text: Vec<String> = finding::lines(one).into_iter().map(|(label, line)| format!("{label}: {line}")).collect();
    command(&[("file", entry.file), ("line", &entry.line.to_string()), ("title", &title)], &text.join("\n"))
}

fn of_trouble(trouble: &Trouble) -> String {
    let line = trouble.line.map(|line| line.to_string());
    let mut properties = vec![("file", trouble.file.as_str())];
    properties.extend(line.as_deref().map(|line| ("line", line)));
    properties.push(("title", "this file cannot be used"));
    command(&properties, trouble.message.trim_end())
}

/// `::error file=a,line=1::text`, escaped by GitHub's rules: in a property colon and comma as well.
fn command(properties: &[(&str, &str)], text: &str) -> String {
    let data = |text: &str| text.replace('%', "%25").replace('\r', "%0D").replace('\n', "%0A");
    let property =
        |(key, value): &(&str, &str)| format!("{key}={}", data(value).replace(':', "%3A").replace(',', "%2C"));
    format!("::error {}::{}\n", properties.iter().map(property).collect::<Vec<_>>().join(","), data(text))
}

/// Markdown of at most `room` bytes: what is not as expected in full, then the known differences, then all experiments.
/// Ends by telling what it had to leave out.
#[must_use]
pub fn step_summary(view: &CheckView<'_>, room: usize) -> String {
    let unexpected = view.unexpected();
    let known = view.known();
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
            pieces: known.iter().map(|entry| in_a_line(entry.judged)).collect(),
        },
    ];
    let mut cut = Vec::new();
    for section in &sections {
        let left_out = section.write(&mut text, room.saturating_sub(CLOSING));
        if left_out > 0 {
            cut.push(counted(left_out, section.what[0], section.what[1]));
        }
    }
    if !cut.is_empty() {
        text += &format!("\nCut, as a summary has its limit: {}. `shotdamp check` tells all.\n", cut.join(", "));
    }
    // Not even room for a heading.
    if text.len() > room { String::new() } else { text }
}

struct Section {
    heading: &'static str,
    /// One and many of its pieces.
    what: [&'static str; 2],
    pieces: Vec<String>,
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
    let mut text = format!("- **`{}`**: {}, expected {}\n", one.id, word(one.verdict), word(one.expected));
    for (label, line) in finding::lines(one) {
        let line = if label == "again" { format!("`{line}`") } else { escaped(&clipped(&line)) };
        text += &format!("  - {label}: {line}\n");
    }
    text
}

fn in_a_line(one: &Judged) -> String {
    format!("- `{}`: {}; {}\n", one.id, word(one.verdict), escaped(&clipped(&one_line(&one.found))))
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
    header.extend(VERDICTS.map(|verdict| (word(verdict), Align::Right)));
    let mut table = MarkdownTable::new(&header);
    for experiment in view.entries.chunk_by(|a, b| a.judged.experiment == b.judged.experiment) {
        let tally = Tally::of(experiment.iter().map(|entry| entry.judged));
        let mut row = vec![format!("`{}`", experiment[0].judged.experiment)];
        row.extend(tally.each().map(|(_, count)| if count == 0 { String::new() } else { count.to_string() }));
        table.row(row);
    }
    table.finish()
}
