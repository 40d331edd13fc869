//! Typed reading of a node tree: each reader gives its value, or reports what is wrong and gives `None`.
//!
//! A reader reads all of its parts before it gives up, so one pass finds every mistake.

use serde::de::DeserializeOwned;

use super::diagnostic::{Findings, Span};
use super::node::{Node, Value};
use super::quantity::{Dimension, NO_COMMA, QuantityError, parse_in, parse_number, parse_quantity};
use super::word::{closest, did_you_mean, from_word, words};

/// Reports a word that is none of the known ones.
pub(crate) fn unknown<T>(
    findings: &Findings,
    at: Span,
    what: &str,
    role: &str,
    given: &str,
    known: &[&str],
) -> Option<T> {
    // Between braces a comma ends the value: what follows it reads as a key.
    let is_number = role == "key" && given.starts_with(|c: char| c.is_ascii_digit());
    let help = if is_number { Some(NO_COMMA.into()) } else { suggestion(findings, given, known) };
    findings.report(at, format!("{what} has no {role} `{given}`"), help)
}

/// Reports a word that is none of an enum's.
pub(crate) fn no_such<T>(findings: &Findings, at: Span, role: &str, given: &str, known: &[&str]) -> Option<T> {
    let article = if role.starts_with(['a', 'e', 'i', 'o', 'u']) { "an" } else { "a" };
    findings.report(at, format!("`{given}` is not {article} {role}"), suggestion(findings, given, known))
}

fn suggestion(findings: &Findings, given: &str, known: &[&str]) -> Option<String> {
    if findings.is_full() {
        return None;
    }
    Some(did_you_mean(given, known.iter().copied()).unwrap_or_else(|| {
        format!("known are {}", known.iter().map(|word| format!("`{word}`")).collect::<Vec<_>>().join(", "))
    }))
}

/// What a node is, in words.
pub(crate) fn kind(node: &Node) -> &'static str {
    match node.value {
        Value::Nothing => "nothing",
        Value::Scalar(_) => "a single value",
        Value::Sequence(_) => "a list",
        Value::Mapping(_) => "keys with values",
    }
}

/// The text of a single value.
pub(crate) fn scalar<'t>(node: &'t Node, findings: &Findings) -> Option<&'t str> {
    match &node.value {
        Value::Scalar(text) => Some(text),
        Value::Mapping(entries) if matches!(entries.as_slice(), [entry] if entry.key == "assumed") => {
            no_assumption(findings, node.span)
        }
        Value::Mapping(entries)
            if let [entry] = entries.as_slice()
                && closest(&entry.key, ["assumed"]).is_some() =>
        {
            no_such(findings, entry.key_span, "key of a value", &entry.key, &["assumed"])
        }
        _ => findings.wrong(node.span, format!("a single value is wanted here, not {}", kind(node))),
    }
}

/// A text, not empty.
pub(crate) fn text(node: &Node, findings: &Findings) -> Option<String> {
    let text = scalar(node, findings)?.trim();
    if text.is_empty() {
        return findings.wrong(node.span, "a text is wanted here");
    }
    if text.contains(|c: char| c.is_control() && c != '\n') {
        return findings.wrong(node.span, "control characters are not accepted");
    }
    Some(text.into())
}

/// `true` or `false`.
pub(crate) fn boolean(node: &Node, findings: &Findings) -> Option<bool> {
    match scalar(node, findings)? {
        "true" => Some(true),
        "false" => Some(false),
        other => findings.report(node.span, format!("`{other}` is neither true nor false"), None),
    }
}

/// Reports that a value is wanted where an assumption is named.
fn no_assumption<T>(findings: &Findings, at: Span) -> Option<T> {
    findings.report(at, "no assumption can stand here", Some("write a value".into()))
}

fn measured(node: &Node, findings: &Findings, parsed: Result<f64, QuantityError>) -> Option<f64> {
    if node.value.is_swept() {
        let varied = findings.varied.iter().map(|word| format!("`{word}`")).collect::<Vec<_>>().join(", ");
        let help = Some(format!("give it a value here; a sweep varies {varied}"));
        return findings.report(node.span, "no sweep varies this key", help);
    }
    if matches!(&node.value, Value::Scalar(word) if word == "assumed") {
        return no_assumption(findings, node.span);
    }
    parsed.map_err(|error| findings.report::<()>(node.span, error.to_string(), error.help())).ok()
}

/// A quantity in SI.
pub(crate) fn quantity(node: &Node, wanted: Dimension, findings: &Findings) -> Option<f64> {
    measured(node, findings, parse_quantity(scalar(node, findings)?, wanted))
}

/// A number alone, or with a unit: in `unit` where that is known, and in SI otherwise.
pub(crate) fn number_in(node: &Node, unit: Option<&str>, findings: &Findings) -> Option<f64> {
    measured(node, findings, parse_in(scalar(node, findings)?, unit))
}

/// A quantity above zero.
pub(crate) fn above_zero(node: &Node, wanted: Dimension, findings: &Findings) -> Option<f64> {
    let value = quantity(node, wanted, findings)?;
    if value > 0.0 { Some(value) } else { findings.wrong(node.span, format!("{} above zero is wanted", wanted.name())) }
}

/// A dimensionless number.
pub(crate) fn number(node: &Node, findings: &Findings) -> Option<f64> {
    measured(node, findings, parse_number(scalar(node, findings)?))
}

/// A dimensionless number that is not negative.
pub(crate) fn ratio(node: &Node, findings: &Findings) -> Option<f64> {
    let value = number(node, findings)?;
    if value >= 0.0 { Some(value) } else { findings.wrong(node.span, "this ratio cannot be negative") }
}

/// A whole number up to `most`, with or without its noun: `25` or `25 cycles`.
pub(crate) fn count(node: &Node, noun: &str, most: u32, findings: &Findings) -> Option<u32> {
    let text = scalar(node, findings)?.trim();
    let end = text.find(|c: char| !c.is_ascii_digit()).unwrap_or(text.len());
    let (digits, rest) = text.split_at(end);
    let singular = noun.strip_suffix('s').unwrap_or(noun);
    let rest = rest.trim();
    if digits.is_empty() || !(rest.is_empty() || rest == noun || rest == singular) {
        let help = if noun.is_empty() { "write for example 25".into() } else { format!("write for example 25 {noun}") };
        return findings.report(node.span, format!("`{text}` is not a number of {}", or_things(noun)), Some(help));
    }
    match digits.parse::<u32>() {
        Ok(value) if value <= most => Some(value),
        _ => findings.wrong(node.span, format!("{digits} is too many: {most} at most")),
    }
}

fn or_things(noun: &str) -> &str {
    if noun.is_empty() { "things" } else { noun }
}

/// One of the words of an enum.
pub(crate) fn word<T: DeserializeOwned>(node: &Node, role: &str, findings: &Findings) -> Option<T> {
    let text = scalar(node, findings)?;
    from_word(text).or_else(|| no_such(findings, node.span, role, text, words::<T>()))
}

/// Each item of a list.
pub(crate) fn list<'t, T>(node: &'t Node, findings: &Findings, read: impl Fn(&'t Node) -> Option<T>) -> Option<Vec<T>> {
    match &node.value {
        Value::Sequence(items) if items.is_empty() => findings.wrong(node.span, "this list is empty"),
        Value::Sequence(items) => all(items.iter().map(read)),
        _ => findings.report(
            node.span,
            format!("a list is wanted here, not {}", kind(node)),
            Some("write [one, two] or lines that begin with `- `".into()),
        ),
    }
}

/// A list, or one thing that stands for a list of one.
pub(crate) fn one_or_more<'t, T>(
    node: &'t Node,
    findings: &Findings,
    read: impl Fn(&'t Node) -> Option<T>,
) -> Option<Vec<T>> {
    match node.value {
        Value::Sequence(_) => list(node, findings, read),
        _ => Some(vec![read(node)?]),
    }
}

/// All values, or `None` if one was reported; unlike `collect`, it does not stop at the first.
pub(crate) fn all<T>(values: impl Iterator<Item = Option<T>>) -> Option<Vec<T>> {
    let values: Vec<_> = values.collect();
    values.into_iter().collect()
}

/// What was chosen among named forms: `rigid`, or `resilient: {…}`.
pub(crate) struct Choice<'t> {
    pub name: &'static str,
    /// What stands behind the colon.
    pub content: Option<&'t Node>,
    pub span: Span,
}

impl<'t> Choice<'t> {
    /// Reads `node` as one of `names`.
    pub fn read(node: &'t Node, what: &'static str, names: &[&'static str], findings: &Findings) -> Option<Self> {
        let (given, content, span) = match &node.value {
            Value::Scalar(word) => (word.as_str(), None, node.span),
            Value::Mapping(entries) => match entries.as_slice() {
                [entry] => (entry.key.as_str(), Some(&entry.node), entry.key_span),
                _ => {
                    let forms: Vec<_> = names.iter().map(|name| format!("`{name}`")).collect();
                    return findings.wrong(node.span, format!("{what} is exactly one of {}", forms.join(", ")));
                }
            },
            _ => return findings.wrong(node.span, format!("{what} cannot be {}", kind(node))),
        };
        match names.iter().find(|name| **name == given) {
            Some(name) => Some(Self { name, content, span }),
            None => unknown(findings, span, what, "form", given, names),
        }
    }

    /// The name of a form that has no values of its own.
    pub fn bare(&self, findings: &Findings) -> Option<&'static str> {
        match self.content {
            None => Some(self.name),
            Some(node) => findings.wrong(node.span, format!("`{}` takes no values: write the word alone", self.name)),
        }
    }

    /// The mapping behind the colon.
    pub fn values(&self, findings: &Findings) -> Option<&'t Node> {
        let wanted = || findings.wrong(self.span, format!("`{}` needs its values: {}: {{…}}", self.name, self.name));
        self.content.or_else(wanted)
    }
}
