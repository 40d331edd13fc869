//! Refined ranges: a few points to start with, and the rule by which a run adds more where a curve bends.

use serde_json::json;

use super::at::At;
use super::definition::{AxisScale, Case, Refinement, differing_in};
use super::diagnostic::Findings;
use super::range::{between, end, in_order, rounded};
use super::reader::{number, scalar};
use super::recipe::{Parameter, ParameterValue};
use super::schema::parts;
use super::validate::read_measure;
use super::yaml::{Node, Value};

/// Most points of a curve.
const MOST_POINTS: u32 = 20_000;
/// Fewest points to start with.
const FEWEST_POINTS: u32 = 5;

/// Whether a range is refined.
pub(super) fn is_refined(value: &Value) -> bool {
    matches!(value, Value::Mapping(entries) if entries.len() == 1 && entries[0].key == "refined")
}

/// The points to start with, and the rule.
pub(super) fn refined(at: At<'_>, parameter: Parameter) -> Option<(Vec<ParameterValue>, Refinement)> {
    let about = "A range that gets more points where a curve bends";
    at.choose("a range", &[("refined", about)], |choice| {
        let keys = choice.keys("a refined range")?;
        let from = keys.required("from", "Where it starts", |at| end(at, Some(parameter)));
        let to = keys.required("to", "Where it ends", |at| end(at, Some(parameter)));
        let points = |at: At<'_>| {
            at.count_from(FEWEST_POINTS, "points", MOST_POINTS, "five points at least show where a curve bends")
        };
        let start = keys.optional("start", "Points to start with", points);
        let most = keys.optional("most", "Points at most", points);
        let tolerance = keys.optional("tolerance", "How far a point may lie off the curve", share);
        let spacing = keys.optional("spacing", "Spacing of the first points", |at| at.word::<AxisScale>("spacing"));
        let scale = "Scale on which the curve is looked at";
        let value_scale = keys.optional("value_scale", scale, |at| at.word::<AxisScale>("scale"));
        let of = keys.optional("of", "Measures whose curve is looked at", |at| at.one_or_more(read_measure));
        keys.close()?;
        let (from, to, spacing) = (from?, to?, spacing?.unwrap_or_default());
        let [from, to] = in_order(at, from, to, spacing)?;
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
    })
}

/// `1 %` or 0.01, above zero.
pub(super) fn share(at: At<'_>) -> Option<f64> {
    let read = |node: &Node, findings: &Findings| {
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
    };
    let percent = || json!({"type": "string", "pattern": r"^\s*[0-9.]+\s*%\s*$"});
    at.named("share", "A share, for example 1 %", |at| {
        at.form(read, |it| parts::any_of(it.about(), vec![percent(), parts::inner_share(it.about())]))
    })
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
