//! Text to a tree of nodes that know where they stand. The only file that names the YAML crate.
//!
//! A file comes from strangers: the tree is small by construction. Aliases are refused (so nothing multiplies), nesting
//! is bounded (so nothing recurses deeply), and a file has one document of mappings with plain keys.

use serde_yaml::granit_parser::{Event, Parser, ScalarStyle, ScanError, options};

use super::diagnostic::{Findings, Span};

/// Deepest nesting; an experiment needs about eight levels.
const DEEPEST: usize = 32;

/// A value where it stands.
#[derive(Debug)]
pub(crate) struct Node {
    pub value: Value,
    /// A scalar's own place; a collection's is that of the key that introduces it.
    pub span: Span,
}

#[derive(Debug)]
pub(crate) enum Value {
    /// Nothing after the key, `~` or `null`.
    Nothing,
    /// As written, without quotes.
    Scalar(String),
    Sequence(Vec<Node>),
    Mapping(Vec<Entry>),
}

impl Value {
    /// It is the word that leaves a value to a sweep.
    pub fn is_swept(&self) -> bool {
        matches!(self, Self::Scalar(word) if word == "swept")
    }
}

/// A key and its value.
#[derive(Debug)]
pub(crate) struct Entry {
    pub key: String,
    pub key_span: Span,
    pub node: Node,
}

/// Longest text, in bytes.
pub(crate) const LONGEST: usize = 1 << 20;

/// What is wrong with a longer one.
pub(crate) fn too_long(bytes: u64) -> String {
    format!("has {} KiB; at most {} KiB are read", bytes.div_ceil(1024), LONGEST >> 10)
}

/// Most keys of one mapping.
const MOST_KEYS: usize = 1000;

type Located<'t> = (Event<'t>, Span);

/// Reads the one document of `text`; all that is no plain YAML is reported.
pub(crate) fn read_tree(text: &str, findings: &Findings) -> Option<Node> {
    if text.len() > LONGEST {
        return findings.wrong(Span::default(), format!("the file {}", too_long(text.len() as u64)));
    }
    let options = options! {
        emit_comments: false,
        emit_unresolved_aliases: true,
        disallow_directives: true,
        flow_nesting_limit: DEEPEST,
        block_nesting_limit: DEEPEST,
    };
    let events = Parser::new_from_str_with_options(text, options);
    let mut tree = TreeReader { events, text, findings, depth: 0, has_alias: false };
    let mut root = None;
    while let Some((event, span)) = tree.next()? {
        match event {
            Event::StreamStart | Event::DocumentEnd | Event::StreamEnd => {}
            Event::DocumentStart(..) if root.is_none() => {}
            Event::DocumentStart(..) => {
                return findings.report(
                    span,
                    "a second document starts here",
                    Some("one file holds one document: remove the `---`".into()),
                );
            }
            first => root = Some(tree.node((first, span), None)?),
        }
    }
    // What stands for an alias is not there: all that misses it would be the same mistake again.
    if tree.has_alias {
        return None;
    }
    root.or_else(|| findings.wrong(Span::default(), "the file is empty"))
}

struct TreeReader<'f, I> {
    events: I,
    text: &'f str,
    findings: &'f Findings,
    depth: usize,
    has_alias: bool,
}

impl<'t, I> TreeReader<'_, I>
where
    I: Iterator<Item = Result<(Event<'t>, serde_yaml::granit_parser::Span), ScanError>>,
{
    /// `None`: reported; `Some(None)`: the end.
    fn next(&mut self) -> Option<Option<Located<'t>>> {
        match self.events.next() {
            None => Some(None),
            Some(Ok((event, span))) => {
                let range = span.byte_range().unwrap_or_default();
                Some(Some((event, Span { start: range.start, end: range.end })))
            }
            Some(Err(error)) => {
                let start = error.marker().byte_offset().unwrap_or_default();
                let help = error.info().contains("tab").then(|| "indent with spaces".to_owned());
                let message = format!("this is no YAML: {}", error.info());
                self.findings.report(Span { start, end: start + 1 }, message, help)
            }
        }
    }

    fn node(&mut self, (event, span): Located<'t>, introduced_by: Option<Span>) -> Option<Node> {
        let collection_span = introduced_by.unwrap_or(Span { start: span.start, end: span.start + 1 });
        let (value, span) = match event {
            Event::Scalar(text, style, anchor, tag) => {
                self.refuse_properties(span, anchor, tag.is_some());
                let nothing = style == ScalarStyle::Plain && matches!(&*text, "" | "~" | "null");
                let value = if nothing { Value::Nothing } else { Value::Scalar(text.into_owned()) };
                (value, if span.start == span.end { collection_span } else { span })
            }
            Event::SequenceStart(_, anchor, tag) => {
                self.refuse_properties(span, anchor, tag.is_some());
                (Value::Sequence(self.nested(span, Self::items)?), collection_span)
            }
            Event::MappingStart(_, anchor, tag) => {
                self.refuse_properties(span, anchor, tag.is_some());
                (Value::Mapping(self.nested(span, Self::entries)?), collection_span)
            }
            Event::Alias(_) | Event::UnresolvedAlias(_) => {
                self.findings.report::<()>(
                    span,
                    "aliases (`*name`) are not accepted",
                    Some("write the value out where it is used".into()),
                );
                self.has_alias = true;
                (Value::Nothing, span)
            }
            _ => return self.findings.wrong(span, "a value is expected here"),
        };
        Some(Node { value, span })
    }

    fn nested<T>(&mut self, at: Span, read: impl FnOnce(&mut Self) -> Option<T>) -> Option<T> {
        if self.depth == DEEPEST {
            return self.findings.wrong(at, format!("nested more than {DEEPEST} levels deep"));
        }
        self.depth += 1;
        let result = read(self);
        self.depth -= 1;
        result
    }

    fn items(&mut self) -> Option<Vec<Node>> {
        let mut items = Vec::new();
        loop {
            match self.next()?? {
                (Event::SequenceEnd, _) => return Some(items),
                item => items.push(self.node(item, None)?),
            }
        }
    }

    fn entries(&mut self) -> Option<Vec<Entry>> {
        let mut entries: Vec<Entry> = Vec::new();
        loop {
            let (event, key_span) = self.next()??;
            let key = match event {
                Event::MappingEnd => return Some(entries),
                Event::Scalar(key, _, anchor, tag) => {
                    self.refuse_properties(key_span, anchor, tag.is_some());
                    key.into_owned()
                }
                _ => return self.findings.wrong(key_span, "a key must be a plain word"),
            };
            if entries.iter().any(|entry| entry.key == key) {
                self.findings.report::<()>(
                    key_span,
                    format!("`{key}` is given twice"),
                    Some("keep one of the two".into()),
                );
            }
            if entries.len() == MOST_KEYS {
                return self.findings.wrong(key_span, format!("more than {MOST_KEYS} keys in one place"));
            }
            let value = self.next()??;
            let node = self.node(value, Some(key_span))?;
            if key == "<<" {
                self.findings.report::<()>(
                    key_span,
                    "merge keys (`<<`) are not accepted",
                    Some("write out the keys that it stands for".into()),
                );
                continue;
            }
            entries.push(Entry { key, key_span, node });
        }
    }

    fn refuse_properties(&self, span: Span, anchor: usize, tagged: bool) {
        if anchor != 0 {
            self.findings.report::<()>(
                self.before(span, '&'),
                "anchors (`&name`) are not accepted",
                Some("write the value out where it is used".into()),
            );
        }
        if tagged {
            self.findings.wrong::<()>(self.before(span, '!'), "tags (`!name`) are not accepted");
        }
    }

    /// The word that begins with `sign` before a value; the value itself if there is none.
    fn before(&self, value: Span, sign: char) -> Span {
        let before = self.text.get(..value.start).unwrap_or_default();
        let begins = |at: usize| before[..at].ends_with(|c: char| c.is_whitespace() || "[{,".contains(c));
        let Some((start, _)) = before.rmatch_indices(sign).find(|(at, _)| begins(*at)) else { return value };
        let length = before[start..].find(char::is_whitespace).unwrap_or(before.len() - start);
        Span { start, end: start + length }
    }
}
