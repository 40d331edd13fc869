//! Refined ranges: a few points to start with, and the rule by which a run adds more where a curve bends.

use super::recipe::{Parameter, ParameterValue};
use crate::measure::Measure;

use super::definition::{AxisScale, Case, Refinement, differing_in};
use super::diagnostic::Findings;
use super::range::{between, end, in_order, rounded};
use super::reader::{Choice, count, number, one_or_more, scalar, word};
use super::yaml::{Node, Value};

/// Most points of a curve.
pub(super) const MOST_POINTS: u32 = 20_000;

/// Whether a range is refined.
pub(super) fn is_refined(node: &Node) -> bool {
    matches!(&node.value, Value::Mapping(entries) if entries.len() == 1 && entries[0].key == "refined")
}

/// The points to start with, and the rule.
pub(super) fn refined(
    node: &Node,
    parameter: Parameter,
    findings: &Findings,
) -> Option<(Vec<ParameterValue>, Refinement)> {
    let choice = Choice::read(node, "a range", &["refined"], findings)?;
    let fields = choice.fields("a refined range", findings)?;
    let from = fields.required("from", |node| end(node, parameter, findings));
    let to = fields.required("to", |node| end(node, parameter, findings));
    let points = |node: &Node| {
        let points = count(node, "points", MOST_POINTS, findings)?;
        if points < 5 {
            findings.wrong(node.span, "five points at least show where a curve bends")
        } else {
            Some(points)
        }
    };
    let start = fields.optional("start", points);
    let most = fields.optional("most", points);
    let tolerance = fields.optional("tolerance", |node| share(node, findings));
    let spacing = fields.optional("spacing", |node| word::<AxisScale>(node, "spacing", findings));
    let value_scale = fields.optional("value_scale", |node| word::<AxisScale>(node, "scale", findings));
    let of =
        fields.optional("of", |node| one_or_more(node, findings, |node| word::<Measure>(node, "measure", findings)));
    fields.close()?;
    let (from, to, spacing) = (from?, to?, spacing?.unwrap_or_default());
    let [from, to] = in_order(from, to, spacing, findings)?;
    let start = start?.unwrap_or(60);
    let refinement = Refinement {
        sweep: String::new(),
        over: parameter,
        tolerance: tolerance?.unwrap_or(0.01),
        most: most?.unwrap_or(600).max(start),
        spacing,
        value_scale: value_scale?.unwrap_or_default(),
        measures: of?.unwrap_or_default(),
    };
    let points = match spacing {
        AxisScale::Linear => between(from, to, start),
        AxisScale::Log => between(libm::log10(from), libm::log10(to), start).into_iter().map(libm::exp10).collect(),
    };
    Some((points.into_iter().map(|point| ParameterValue::Number(rounded(point))).collect(), refinement))
}

/// `1 %` or 0.01, above zero.
fn share(node: &Node, findings: &Findings) -> Option<f64> {
    let value = match scalar(node, findings)?.trim().strip_suffix('%') {
        Some(percent) => percent.trim().parse::<f64>().ok().map(|percent| percent / 100.0),
        None => Some(number(node, findings)?),
    };
    match value {
        Some(value) if value > 0.0 && value < 1.0 => Some(value),
        _ => findings.report(
            node.span,
            "a share between nothing and the whole is wanted here",
            Some("write for example 1 %".into()),
        ),
    }
}

/// The cases of a refined sweep that differ in its parameter alone, by their index, in order of the parameter.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Curve<'a> {
    pub rule: &'a Refinement,
    pub cases: Vec<usize>,
}

/// All curves, in the order of their first cases.
pub(crate) fn curves<'a>(cases: &[Case], rules: impl IntoIterator<Item = &'a Refinement>) -> Vec<Curve<'a>> {
    let of_rule = |rule: &'a Refinement| {
        differing_in(cases, &rule.sweep, rule.over).into_iter().map(move |cases| Curve { rule, cases })
    };
    let mut curves: Vec<Curve<'a>> = rules.into_iter().flat_map(of_rule).collect();
    curves.sort_by_key(|curve| curve.cases.first().copied());
    curves
}
