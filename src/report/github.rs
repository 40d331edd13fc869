//! Verdicts for GitHub Actions: annotations as workflow commands, and a summary of the step in Markdown.
//!
//! GitHub shows ten annotations a step and refuses a summary above 1 MiB; what does not fit is counted, never dropped in
//! silence.

use super::finding::{self, CheckView, CheckedEntry, Trouble};
use super::in_pieces::summary;

/// Annotations written one by one; the tenth counts the rest.
const TOLD: usize = 9;
/// Longest summary of a step, bytes: GitHub takes 1 MiB, and a step may have something else to say.
pub const SUMMARY_LIMIT: usize = 900 << 10;

/// One workflow command a line: files that cannot be used, then the worst entries, then how many more there are.
#[must_use]
pub fn annotations(view: &CheckView<'_>) -> String {
    let unexpected = view.unexpected();
    let troubles = view.troubles.iter().map(of_trouble);
    let all: Vec<String> = troubles.chain(unexpected.iter().map(|entry| of_entry(entry))).collect();
    let mut text: String = all.iter().take(TOLD).map(String::as_str).collect();
    if all.len() > TOLD {
        let title = format!("{} more not as expected", all.len() - TOLD);
        text += &command(&[("title", &title)], "The summary of this step has all of them, as has `shotdamp check`.");
    }
    text
}

fn of_entry(entry: &CheckedEntry<'_>) -> String {
    let one = entry.judged;
    let title = format!("{}: {}, expected {}", one.id, one.verdict.word(), one.expected.word());
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

/// The summary of a step, Markdown of at most `room` bytes.
#[must_use]
pub fn step_summary(view: &CheckView<'_>, room: usize) -> String {
    summary(view, None, room)
}
