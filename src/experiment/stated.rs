//! Inputs that a study's text states, with their place, and the numbers of an experiment that neither it nor an assumption gives.
//!
//! ```yaml
//! stated:                                            # in experiments/assumptions.yaml, by chapter
//!   5:
//!     Table 6: {length: 1.33 m, width: 1 m}
//!     s. 5.3.5: {harmonic.at: [0.25, 0.375]}         # keys may be led by those above them
//! ```
//!
//! An experiment states under its own `stated:` what its figure or table alone has. A number of the scene, the run, the sweep or the
//! optimisation that equals a statement of its key has a source; `{assumed: NAME}` needs none. All others are listed on the page.
//! Grids (`linear`, `log`, …) are chosen for drawing and are no inputs. Where nothing is stated, nothing is listed.

use std::collections::BTreeMap;
use std::fmt;

use serde_json::json;

use super::about_study::chapter_number;
use crate::yaml::{Amount, At, Findings, Node, Span, Value, parse_amount, schema};

/// The key of statements, in an experiment and in the assumptions file.
pub(super) const STATED: &str = "stated";

/// What a text states, by chapter.
pub(super) type StatedByChapter = BTreeMap<u32, Vec<Statement>>;

/// One input that the text states.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Statement {
    /// Its key, which may be led by keys above it.
    key: Vec<String>,
    /// Its value, or the values that it takes.
    amounts: Vec<Amount>,
    /// The same as text.
    text: String,
    /// The table, figure or section.
    place: String,
    span: Span,
}

/// An input without a source.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Unsourced {
    /// `key value`.
    pub input: String,
    /// Other values that the text states for such a key: `Table 2: 3.5 mm`.
    pub stated: Vec<String>,
}

impl fmt::Display for Unsourced {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.input)?;
        if self.stated.is_empty() { Ok(()) } else { write!(f, " ({})", self.stated.join("; ")) }
    }
}

/// An input of an experiment.
#[derive(Debug)]
struct Input {
    /// From the experiment's own key down.
    path: Vec<String>,
    amounts: Vec<Amount>,
    text: String,
}

impl Input {
    /// The key as a reader of the scene finds it: with the one above it, unless it is a column of the sweep.
    fn name(&self) -> String {
        let swept = self.path.first().is_some_and(|part| part == "sweep" || part == "mean_over");
        self.path[self.path.len().saturating_sub(if swept { 1 } else { 2 })..].join(".")
    }
}

impl Statement {
    /// The input is stated: the same value, or one of several.
    fn gives(&self, input: &Input) -> bool {
        let among = matches!(input.amounts.as_slice(), [one] if self.amounts.iter().any(|known| known.is(one)));
        let same = self.amounts.len() == input.amounts.len()
            && self.amounts.iter().zip(&input.amounts).all(|(known, amount)| known.is(amount));
        self.speaks_of(input) && (among || same)
    }

    fn speaks_of(&self, input: &Input) -> bool {
        input.path.ends_with(&self.key)
    }
}

/// `chapter: {place: {key: value}}`.
pub(super) fn read_chapters(at: At<'_>) -> Option<StatedByChapter> {
    let form = "statements are written as `chapter: {Table 6: {key: value}}`";
    let chapters = at
        .by_name(json!({}), form, |key, key_span, at| Some((chapter_number(key, key_span, at)?, read_statements(at)?)));
    chapters.map(|chapters| chapters.into_iter().collect())
}

/// `place: {key: value}`.
pub(super) fn read_statements(at: At<'_>) -> Option<Vec<Statement>> {
    let form = "statements are written as `Table 6: {key: value}`";
    let statement = |place: &str, key: &str, span, at: At<'_>| {
        let (amounts, text) = at.form(
            |node, findings| {
                let help = "what a text states of an input is a number, or a list of numbers";
                leaf(node).or_else(|| findings.wrong(node.span, help))
            },
            |_| {
                let number = json!({"type": ["number", "string"]});
                schema::any_of("A number, or a list", vec![number.clone(), schema::list("Numbers", number)])
            },
        )?;
        let key = key.split('.').map(str::to_owned).collect();
        Some(Statement { key, amounts, text, place: place.to_owned(), span })
    };
    let place = |place: &str, _, at: At<'_>| {
        let of_place = |key: &str, span, at: At<'_>| statement(place, key, span, at);
        at.called("What this table, figure or section states, by key", |at| at.by_name(json!({}), form, of_place))
    };
    at.by_name(json!({}), form, place).map(|statements| statements.concat())
}

/// The inputs of an experiment that neither the study's statements for its chapter nor its own give; none if nothing is stated. A statement
/// of its own that gives none of its inputs is reported.
pub(super) fn without_source(
    root: &Node,
    of_chapter: &[Statement],
    own: &[Statement],
    findings: &Findings,
) -> Vec<Unsourced> {
    if of_chapter.is_empty() && own.is_empty() {
        return Vec::new();
    }
    let inputs = inputs(root);
    for statement in own.iter().filter(|statement| !inputs.iter().any(|input| statement.gives(input))) {
        let key = statement.key.join(".");
        findings.wrong::<()>(statement.span, format!("no input of this experiment is the `{key}` that is stated here"));
    }
    let statements = || of_chapter.iter().chain(own);
    let has_source = |input: &Input| statements().any(|statement| statement.gives(input));
    let mut listed: Vec<(String, Vec<String>, Vec<String>)> = Vec::new();
    for input in inputs.into_iter().filter(|input| !has_source(input)) {
        let key = input.name();
        let others = statements().filter(|statement| statement.speaks_of(&input));
        let others = others.map(|statement| format!("{}: {}", statement.place, statement.text)).collect();
        match listed.iter_mut().find(|(known, _, same)| *known == key && *same == others) {
            Some((_, texts, _)) if texts.contains(&input.text) => {}
            Some((_, texts, _)) => texts.push(input.text),
            None => listed.push((key, vec![input.text], others)),
        }
    }
    let all = listed.into_iter();
    all.map(|(key, texts, stated)| Unsourced { input: format!("{key} {}", texts.join(", ")), stated }).collect()
}

/// Parts of an experiment with inputs, and which of their keys are meant; all where none is named.
const PARTS: [(&str, &[&str]); 5] = [
    ("scene", &[]),
    ("sweep", &[]),
    ("mean_over", &[]),
    // How many members an ensemble has, or what a row may cost, is no input of a study.
    ("run", &["skip", "average", "solver", "round_period_to"]),
    ("optimise", &["gaps", "candidates", "genetic", "stop"]),
];

/// Words of ranges whose points are chosen for drawing.
const GRIDS: [&str; 5] = ["linear", "log", "step", "refined", "place"];

fn inputs(root: &Node) -> Vec<Input> {
    let mut found = Vec::new();
    let Value::Mapping(entries) = &root.value else { return found };
    for (part, keys) in PARTS {
        let Some(Value::Mapping(inner)) = entries.iter().find(|entry| entry.key == part).map(|entry| &entry.node.value)
        else {
            continue;
        };
        for entry in inner.iter().filter(|entry| keys.is_empty() || keys.contains(&entry.key.as_str())) {
            let alternatives = matches!(part, "sweep" | "mean_over");
            walk(&entry.node, &mut vec![part.to_owned(), entry.key.clone()], alternatives, &mut found);
        }
    }
    found
}

/// `alternatives`: a list holds values that are taken one at a time; else it is one value.
fn walk(node: &Node, path: &mut Vec<String>, alternatives: bool, found: &mut Vec<Input>) {
    if names_assumption(node) || path.last().is_some_and(|key| GRIDS.contains(&key.as_str())) {
        return;
    }
    let whole = !(alternatives && matches!(node.value, Value::Sequence(_)));
    if let Some((amounts, text)) = leaf(node).filter(|_| whole) {
        found.push(Input { path: path.clone(), amounts, text });
        return;
    }
    match &node.value {
        Value::Sequence(items) => items.iter().for_each(|item| walk(item, path, alternatives, found)),
        Value::Mapping(entries) => {
            for entry in entries {
                path.push(entry.key.clone());
                walk(&entry.node, path, alternatives, found);
                path.pop();
            }
        }
        Value::Nothing | Value::Scalar(_) => {}
    }
}

/// A number, or a list of nothing but numbers, with its text.
fn leaf(node: &Node) -> Option<(Vec<Amount>, String)> {
    match &node.value {
        Value::Scalar(text) => Some((vec![parse_amount(text)?], text.clone())),
        Value::Sequence(items) if !items.is_empty() => {
            let each: Option<Vec<(Vec<Amount>, String)>> =
                items.iter().map(|item| leaf(item).filter(|_| matches!(item.value, Value::Scalar(_)))).collect();
            let (amounts, texts): (Vec<_>, Vec<_>) = each?.into_iter().unzip();
            Some((amounts.concat(), format!("[{}]", texts.join(", "))))
        }
        _ => None,
    }
}

/// It says `{assumed: …}`.
pub(super) fn names_assumption(node: &Node) -> bool {
    names_assumption_value(&node.value)
}

pub(super) fn names_assumption_value(value: &Value) -> bool {
    matches!(value, Value::Mapping(entries) if matches!(entries.as_slice(), [entry] if entry.key == "assumed"))
}
