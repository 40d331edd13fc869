//! Changes to a YAML text in place: what is not changed stays as it is to the byte, comments and layout with it.

use std::ops::Range;

use super::diagnostic::Findings;
use super::node::{Entry, Node, Value, read_tree};

/// Longest line that prose is broken into, characters.
const WIDTH: usize = 118;

/// A value to be written.
#[derive(Debug, Clone, Copy)]
pub(crate) enum Written<'a> {
    /// One plain word.
    Word(&'a str),
    /// Sentences; folded over several lines where the layout lets them.
    Prose(&'a str),
}

/// Sets keys of the mapping with this `id` in the list under `list`; keys that it lacks come last in it.
///
/// `None` if the text is no such list or has no such mapping. Whoever calls reads the new text again: it is he who knows
/// what it has to mean.
pub(crate) fn set_keys(text: &str, list: &str, id: &str, changes: &[(&str, Written<'_>)]) -> Option<String> {
    let findings = Findings::default();
    let root = read_tree(text, &findings)?;
    let Value::Sequence(items) = &value_of(&root, list)?.node.value else { return None };
    let item = items.iter().find(|item| {
        matches!(value_of(item, "id"), Some(Entry { node: Node { value: Value::Scalar(found), .. }, .. }) if found == id)
    })?;
    let Value::Mapping(entries) = &item.value else { return None };
    let layout = Layout::of(text, entries.first()?, text.as_bytes().get(item.span.start) == Some(&b'{'));
    let mut edits: Vec<(Range<usize>, String)> = Vec::new();
    let mut added = String::new();
    for (key, value) in changes {
        match entries.iter().find(|entry| entry.key == *key) {
            Some(entry) => edits.extend(layout.replaced(entry, *value)?),
            None => added += &layout.added(key, *value),
        }
    }
    if !added.is_empty() {
        let at = layout.end(entries)?;
        edits.push((at..at, added));
    }
    // From the end, so that places stay what they are; of two at one place the first comes first in the text.
    edits.reverse();
    edits.sort_by_key(|(range, _)| std::cmp::Reverse(range.start));
    let mut changed = text.to_owned();
    for (range, new) in edits {
        changed.replace_range(range, &new);
    }
    Some(changed)
}

fn value_of<'a>(node: &'a Node, key: &str) -> Option<&'a Entry> {
    let Value::Mapping(entries) = &node.value else { return None };
    entries.iter().find(|entry| entry.key == key)
}

/// How the mapping is laid out.
struct Layout<'t> {
    text: &'t str,
    /// `{…}` on a line of its own or several.
    flow: bool,
    /// Characters in front of its keys.
    indent: usize,
    line_break: &'static str,
}

impl<'t> Layout<'t> {
    fn of(text: &'t str, first: &Entry, flow: bool) -> Self {
        let line = text[..first.key_span.start].rfind('\n').map_or(0, |at| at + 1);
        let indent = text[line..first.key_span.start].chars().count();
        Self { text, flow, indent, line_break: if text.contains("\r\n") { "\r\n" } else { "\n" } }
    }

    /// The edits that give a key another value.
    fn replaced(&self, entry: &Entry, value: Written<'_>) -> Option<Vec<(Range<usize>, String)>> {
        let after = &self.text[entry.key_span.end..];
        let colon = after.find(':')? + 1;
        let start = entry.key_span.end + colon + after[colon..].len() - after[colon..].trim_start_matches(' ').len();
        let block = matches!(self.text.as_bytes().get(start), Some(b'>' | b'|'));
        match (value, &entry.node.value) {
            (Written::Word(word), Value::Scalar(_)) if !block => {
                Some(vec![(entry.node.span.start..entry.node.span.end, word.to_owned())])
            }
            (Written::Prose(prose), Value::Scalar(_)) if self.flow => {
                Some(vec![(entry.node.span.start..entry.node.span.end, quoted(prose))])
            }
            (Written::Prose(prose), Value::Scalar(_)) if block => {
                // The header stays, and a comment behind it.
                let content = self.line_end(start)..self.content_end(start);
                Some(vec![(content, self.folded(prose))])
            }
            (Written::Prose(prose), Value::Scalar(_)) => {
                let span = entry.node.span;
                let line_end = self.line_end(span.end);
                Some(vec![(line_end..line_end, self.folded(prose)), (span.start..span.end, ">-".into())])
            }
            _ => None,
        }
    }

    /// A key with its value, as it is put behind the others.
    fn added(&self, key: &str, value: Written<'_>) -> String {
        if self.flow {
            let value = match value {
                Written::Word(word) => word.to_owned(),
                Written::Prose(prose) => quoted(prose),
            };
            return format!(", {key}: {value}");
        }
        let start = format!("{}{}{key}: ", self.line_break, " ".repeat(self.indent));
        start
            + &match value {
                Written::Word(word) => word.to_owned(),
                Written::Prose(prose) => format!(">-{}", self.folded(prose)),
            }
    }

    /// Where another key is put: in a flow mapping behind its `id`, in a block behind its last line.
    fn end(&self, entries: &[Entry]) -> Option<usize> {
        if self.flow {
            return Some(entries.iter().find(|entry| entry.key == "id")?.node.span.end);
        }
        Some(self.block_end(entries.first()?.key_span.start, self.indent))
    }

    /// The end of the text of a block scalar whose header is at `start`, its last line break not included.
    fn content_end(&self, start: usize) -> usize {
        self.block_end(start, self.indent + 1)
    }

    /// The end of the last of the lines after `start` that are indented by at least so much; blank lines at the end are
    /// not counted.
    fn block_end(&self, start: usize, indent: usize) -> usize {
        let mut end = self.line_end(start);
        let mut at = end;
        for line in self.text[end..].split_inclusive('\n').skip(1) {
            at += self.text[at..].find('\n').map_or(0, |to| to + 1);
            let content = line.trim_end_matches(['\n', '\r']);
            let blank = content.trim().is_empty();
            if !blank && content.len() - content.trim_start_matches(' ').len() < indent {
                break;
            }
            if !blank {
                end = at + content.len();
            }
            at += content.len();
        }
        end
    }

    /// The end of the line that holds this place.
    fn line_end(&self, at: usize) -> usize {
        let end = self.text[at..].find('\n').map_or(self.text.len(), |to| at + to);
        if self.text[..end].ends_with('\r') { end - 1 } else { end }
    }

    /// Lines of a folded scalar, each after a line break.
    fn folded(&self, prose: &str) -> String {
        let indent = " ".repeat(self.indent + 2);
        let mut text = String::new();
        let mut width = usize::MAX;
        for word in prose.split_whitespace() {
            let length = word.chars().count();
            if width.saturating_add(1 + length) > WIDTH {
                text += self.line_break;
                text += &indent;
                width = indent.len() + length;
            } else {
                text.push(' ');
                width += 1 + length;
            }
            text += word;
        }
        text
    }
}

/// In double quotes, on one line. JSON's strings are YAML's.
fn quoted(prose: &str) -> String {
    serde_json::Value::from(prose.split_whitespace().collect::<Vec<_>>().join(" ")).to_string()
}
