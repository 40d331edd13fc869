//! The `orbit` of an experiment: nodes to [`Continuation`].

use std::collections::BTreeMap;

use super::continuation::Continuation;
use super::definition::AxisScale;
use super::diagnostic::{Findings, Span};
use super::range::{end, in_order, size};
use super::reader::{Fields, count, no_such, one_or_more, word};
use super::recipe::Parameter;
use super::sweep::ReadSweep;
use super::word::{from_word, word_of, words};
use super::yaml::{Node, Value};

/// Most points of a branch.
pub(super) const MOST_POINTS: u32 = 100_000;
/// Most forcing periods of a motion.
pub(super) const MOST_PERIODS: u32 = 10_000;
/// Most times over that a period doubles.
pub(super) const MOST_DOUBLINGS: u32 = 10;
/// Points of a branch unless an experiment says.
const USUAL_POINTS: u32 = 500;

/// A continuation as read.
pub(super) struct ReadContinuation {
    pub continuation: Continuation,
    pub along_at: Span,
    pub span: Span,
}

/// The range of a parameter.
struct Range {
    along: Parameter,
    from: f64,
    to: f64,
    spacing: AxisScale,
    at: Span,
}

/// Reads the node under `orbit`.
pub(super) fn read_continuation(node: &Node, findings: &Findings) -> Option<ReadContinuation> {
    let fields = Fields::open(node, "an orbit", findings)?;
    let range = fields.required("along", |node| range(node, findings));
    let starts = fields.optional("start", |node| {
        let range = range.as_ref()?;
        one_or_more(node, findings, |node| start(node, range, findings))
    });
    let periods = fields.optional("periods", |node| some(node, "periods", MOST_PERIODS, findings));
    let doublings = fields.optional("doublings", |node| count(node, "doublings", MOST_DOUBLINGS, findings));
    let points = fields.optional("points", |node| some(node, "points", MOST_POINTS, findings));
    fields.close()?;
    let Range { along, from, to, spacing, at } = range?;
    let continuation = Continuation {
        along,
        from,
        to,
        spacing,
        starts: starts?.unwrap_or_else(|| vec![from]),
        periods: periods?,
        doublings: doublings?.unwrap_or(0),
        points: points?.unwrap_or(USUAL_POINTS),
    };
    Some(ReadContinuation { continuation, along_at: at, span: node.span })
}

/// A value within the range.
fn start(node: &Node, range: &Range, findings: &Findings) -> Option<f64> {
    let Range { along, from, to, .. } = *range;
    let start = size(node, along, findings)?;
    if (from..=to).contains(&start) {
        return Some(start);
    }
    findings.report(
        node.span,
        format!("the start lies outside of the range from {from} to {to} of `{}`", word_of(along)),
        Some("move it into the range, or widen the range".into()),
    )
}

fn some(node: &Node, noun: &str, most: u32, findings: &Findings) -> Option<u32> {
    match count(node, noun, most, findings)? {
        0 => findings.wrong(node.span, "one at least is wanted here"),
        count => Some(count),
    }
}

/// `{force_ratio: {from: 1, to: 3}}`.
fn range(node: &Node, findings: &Findings) -> Option<Range> {
    let entry = match &node.value {
        Value::Mapping(entries) => match entries.as_slice() {
            [entry] => entry,
            _ => return findings.wrong(node.span, "a branch is followed along one parameter"),
        },
        _ => {
            let help = Some("write `along: {force_ratio: {from: 1, to: 3}}`".to_owned());
            return findings.report(node.span, "a branch is followed along a parameter with its range", help);
        }
    };
    let Some(along) = from_word::<Parameter>(&entry.key) else {
        return no_such(findings, entry.key_span, "parameter", &entry.key, words::<Parameter>());
    };
    if !along.varies_smoothly() {
        let message = format!("`{}` takes no values in between: no branch can be followed along it", entry.key);
        return findings.wrong(entry.key_span, message);
    }
    let fields = Fields::open(&entry.node, "a range", findings)?;
    let from = fields.required("from", |node| end(node, along, findings));
    let to = fields.required("to", |node| end(node, along, findings));
    let spacing = fields.optional("spacing", |node| word::<AxisScale>(node, "spacing", findings));
    fields.close()?;
    let (from, to, spacing) = (from?, to?, spacing?.unwrap_or_default());
    let [from, to] = in_order(from, to, spacing, findings)?;
    Some(Range { along, from, to, spacing, at: entry.key_span })
}

impl ReadContinuation {
    /// What a sweep of the first scene alone would be.
    pub(super) fn sweep(&self) -> ReadSweep {
        let along = self.continuation.along;
        ReadSweep {
            cases: vec![self.continuation.first_case()],
            swept: vec![along],
            places: BTreeMap::from([(along, self.along_at)]),
            refined: Vec::new(),
            continued: Vec::new(),
        }
    }
}
