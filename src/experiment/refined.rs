//! Refined ranges: a few points to start with, and the rule by which a run adds more where a curve bends.

use serde::{Deserialize, Serialize};
use serde_json::json;

use super::case::{Case, differing_in};
use super::figure_spec::AxisScale;
use super::measures::read_measure;
use super::range::{between, end, in_order, rounded};
use super::recipe::{Parameter, ParameterValue};
use crate::measure::Measure;
use crate::yaml::reader::{number, scalar};
use crate::yaml::{At, Findings, Node, Value, parse_percent, schema};

/// Most points of a curve.
const MOST_POINTS: u32 = 20_000;
/// Fewest points to start with.
const FEWEST_POINTS: u32 = 5;

/// Points added to the curves of a sweep, one parameter running, where a straight line between two of them would miss.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Refinement {
    /// The sweep within a union; empty otherwise.
    pub sweep: String,
    /// The parameter that runs along a curve.
    pub over: Parameter,
    /// How far a straight line may miss, relative to the local value; on a logarithmic scale in its logarithm.
    pub tolerance: f64,
    /// Most points of a curve.
    pub most: u32,
    /// The scale on which points are evenly spaced and intervals halved.
    pub spacing: AxisScale,
    /// The scale on which lines are straight.
    pub value_scale: AxisScale,
    /// The measures that decide; all where none is named.
    pub measures: Vec<Measure>,
    /// A place in closed form that gets a point on either side.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub around: Option<Threshold>,
}

/// A place on a curve that is known in closed form.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Threshold {
    /// The first particle leaves its floor.
    LiftOff,
    /// A motion with an impact on floor and ceiling a period begins.
    TwoImpacts,
    /// A motion with one impact on the floor a period touches the ceiling.
    CeilingGraze,
}

impl Threshold {
    /// All of them, in the order in which a growing strength usually meets them.
    pub const ALL: &[Self] = &[Self::LiftOff, Self::TwoImpacts, Self::CeilingGraze];
}

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
        let beside = "A place in closed form that gets a point on either side";
        let around = keys.optional("around", beside, |at| threshold(at, parameter));
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
            around: around?,
        };
        let points = match spacing {
            AxisScale::Linear => between(from, to, start),
            AxisScale::Log => between(libm::log10(from), libm::log10(to), start).into_iter().map(libm::exp10).collect(),
        };
        Some((points.into_iter().map(|point| ParameterValue::Number(rounded(point))).collect(), refinement))
    })
}

/// `lift_off`, `two_impacts` or `ceiling_graze`, of a strength of the drive.
fn threshold(at: At<'_>, parameter: Parameter) -> Option<Threshold> {
    let threshold = at.word::<Threshold>("threshold")?;
    if matches!(at, At::Node(..)) && !parameter.is_strength() {
        let help =
            "refine `force_ratio`, `base_amplitude_ratio`, `force` or `impulse`, or leave `around` out".to_owned();
        return at.report("a threshold is a strength of the drive", Some(help));
    }
    Some(threshold)
}

/// `1 %` or 0.01, above zero.
pub(super) fn share(at: At<'_>) -> Option<f64> {
    let read = |node: &Node, findings: &Findings| {
        let text = scalar(node, findings)?;
        let value = if text.trim().ends_with('%') { parse_percent(text) } else { Some(number(node, findings)?) };
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
        at.form(read, |it| schema::any_of(it.about(), vec![percent(), schema::inner_share(it.about())]))
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
