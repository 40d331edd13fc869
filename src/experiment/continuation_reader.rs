//! The `orbit` of an experiment: nodes to [`Continuation`].

use std::collections::BTreeMap;

use super::continuation::Continuation;
use super::figure_spec::AxisScale;
use super::range::{by_kind, end, in_order, size};
use super::recipe::Parameter;
use super::sweep::{ReadSweep, about, parameters};
use crate::yaml::reader::no_such;
use crate::yaml::word::{from_word, word_of, words};
use crate::yaml::{At, Findings, Node, Span, Value, schema};

/// Most points of a branch.
const MOST_POINTS: u32 = 100_000;
/// Most forcing periods of a motion.
const MOST_PERIODS: u32 = 10_000;
/// Most times over that a period doubles.
const MOST_DOUBLINGS: u32 = 10;
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

/// Reads what stands under `orbit`.
pub(super) fn read_continuation(at: At<'_>) -> Option<ReadContinuation> {
    let keys = at.keys("an orbit")?;
    let range = keys.required("along", "The parameter, and its range", range);
    let start = "Where motions are taken from the ends of runs; `from` unless stated";
    let starts = keys.optional("start", start, |at| {
        if let At::Node(..) = at {
            range.as_ref()?;
        }
        at.one_or_more(|at| start_within(at, range.as_ref()))
    });
    let some = |at: At<'_>, noun, most| at.count_from(1, noun, most, "one at least is wanted here");
    let periods = "Forcing periods of these motions";
    let periods = keys.optional("periods", periods, |at| some(at, "periods", MOST_PERIODS));
    let doublings = "How many times over doubled periods are followed";
    let doublings = keys.optional("doublings", doublings, |at| at.count("doublings", MOST_DOUBLINGS));
    let asymmetric = "Follow the two motions, too, that begin where a motion loses its symmetry";
    let asymmetric = keys.optional("asymmetric", asymmetric, |at| at.boolean());
    let points = "Points of a branch to either side of its first";
    let points = keys.optional("points", points, |at| some(at, "points", MOST_POINTS));
    keys.close()?;
    let Range { along, from, to, spacing, at: along_at } = range?;
    let continuation = Continuation {
        along,
        from,
        to,
        spacing,
        starts: starts?.unwrap_or_else(|| vec![from]),
        periods: periods?,
        doublings: doublings?.unwrap_or(0),
        asymmetric: asymmetric?.unwrap_or(false),
        points: points?.unwrap_or(USUAL_POINTS),
    };
    Some(ReadContinuation { continuation, along_at, span: at.span() })
}

/// A value within the range.
fn start_within(at: At<'_>, range: Option<&Range>) -> Option<f64> {
    let start = size(at, range.map(|range| range.along))?;
    let Range { along, from, to, .. } = *range?;
    if (from..=to).contains(&start) {
        return Some(start);
    }
    at.report(
        format!("the start lies outside of the range from {from} to {to} of `{}`", word_of(along)),
        Some("move it into the range, or widen the range".into()),
    )
}

/// `{force_ratio: {from: 1, to: 3}}`.
fn range(at: At<'_>) -> Option<Range> {
    let read = |node: &Node, findings: &Findings| {
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
        let ([from, to], spacing) = ends(At::Node(&entry.node, findings), along)?;
        Some(Range { along, from, to, spacing, at: entry.key_span })
    };
    at.form(read, |it| {
        let smooth = parameters().filter(|(_, parameter)| parameter.varies_smoothly());
        schema::one_of_keys(
            it.about(),
            smooth.map(|(name, parameter)| (name, it.part(&about(name), |at| ends(at, parameter)))),
        )
    })
}

/// The ends of a range, and its scale.
fn ends(at: At<'_>, along: Parameter) -> Option<([f64; 2], AxisScale)> {
    by_kind(at, "along_", Some(along.takes()), |at| {
        let keys = at.keys("a range")?;
        let from = keys.required("from", "Where it starts", |at| end(at, Some(along)));
        let to = keys.required("to", "Where it ends", |at| end(at, Some(along)));
        let scale = "The scale on which steps are equal";
        let spacing = keys.optional("spacing", scale, |at| at.word::<AxisScale>("spacing"));
        keys.close()?;
        let (from, to, spacing) = (from?, to?, spacing?.unwrap_or_default());
        Some((in_order(at, from, to, spacing)?, spacing))
    })
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
