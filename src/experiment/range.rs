//! Ranges of values: a list, or evenly, logarithmically or stepwise between two ends, with units where the parameter
//! has one.
//!
//! Points are rounded to 13 significant digits: decades come out exactly, and on every machine alike.

use super::recipe::{Parameter, ParameterValue, Takes};

use super::definition::AxisScale;
use super::diagnostic::{Findings, Span};
use super::reader::{Choice, all, count, quantity, ratio, scalar};
use super::word::word_of;
use super::yaml::{Node, Value};

/// Most points of all sweeps of a file together.
pub(super) const MOST_POINTS: u32 = 100_000;

/// The values that `node` gives to `parameter`, at least one.
pub(super) fn values(node: &Node, parameter: Parameter, findings: &Findings) -> Option<Vec<ParameterValue>> {
    let parts = match &node.value {
        Value::Sequence(items) if items.is_empty() => {
            return findings.wrong(node.span, "this sweep is empty: give it at least one value");
        }
        Value::Sequence(items) => all(items.iter().map(|item| Some((item, part(item, parameter, findings)?))))?,
        _ => vec![(node, part(node, parameter, findings)?)],
    };
    let mut values: Vec<ParameterValue> = Vec::new();
    for (item, part) in parts {
        let mut part = part.as_slice();
        // A range that begins where the one before ended shares that point with it.
        if part.len() > 1 && values.last() == part.first() {
            part = &part[1..];
        }
        values.extend(part);
        if values.len() > MOST_POINTS as usize {
            return too_many(item.span, values.len() as f64, findings);
        }
    }
    Some(values)
}

/// The same where only numbers make sense.
pub(super) fn numbers(node: &Node, parameter: Parameter, findings: &Findings) -> Option<Vec<f64>> {
    let values = values(node, parameter, findings)?;
    let numbers = values.iter().map(|value| match value {
        ParameterValue::Number(number) => Some(*number),
        _ => findings.wrong(node.span, "numbers are wanted here"),
    });
    all(numbers)
}

pub(super) fn too_many<T>(at: Span, points: f64, findings: &Findings) -> Option<T> {
    let points = if points < 1e9 { format!("{points:.0}") } else { format!("{points:.1e}") };
    findings.report(
        at,
        format!("{points} points are too many: {MOST_POINTS} at most"),
        Some("widen the step, or split the experiment".into()),
    )
}

/// One item of a list: a value, or a range within the list.
fn part(node: &Node, parameter: Parameter, findings: &Findings) -> Option<Vec<ParameterValue>> {
    match node.value {
        Value::Mapping(_) => range(node, parameter, findings),
        _ => Some(vec![value(node, parameter, findings)?]),
    }
}

/// A single value of a parameter.
pub(super) fn value(node: &Node, parameter: Parameter, findings: &Findings) -> Option<ParameterValue> {
    let word = match &node.value {
        Value::Scalar(text) => text.as_str(),
        _ => "",
    };
    match parameter.takes() {
        Takes::RatioOrInfinite if word == "infinite" => Some(ParameterValue::Infinite),
        Takes::Words(known) => known.iter().copied().find(|known| word_of(*known) == word).or_else(|| {
            let [one, other] = describe(known);
            findings.wrong(node.span, format!("`{}` is neither {one} nor {other}", scalar(node, findings)?))
        }),
        _ => size(node, parameter, findings).map(ParameterValue::Number),
    }
}

/// A value of a parameter that is a number, in SI.
pub(super) fn size(node: &Node, parameter: Parameter, findings: &Findings) -> Option<f64> {
    match parameter.takes() {
        Takes::Quantity(dimension) => quantity(node, dimension, findings),
        Takes::Words(_) | Takes::Ratio | Takes::RatioOrInfinite => ratio(node, findings),
    }
}

/// The two words of a parameter that takes words.
fn describe(words: &[ParameterValue]) -> [String; 2] {
    let word = |i: usize| words.get(i).map_or_else(String::new, |known| format!("`{}`", word_of(*known)));
    [word(0), word(1)]
}

fn range(node: &Node, parameter: Parameter, findings: &Findings) -> Option<Vec<ParameterValue>> {
    if let Takes::Words(words) = parameter.takes() {
        let [one, other] = describe(words).map(|word| word.replace('`', ""));
        return findings.wrong(node.span, format!("`{}` is swept over [{one}, {other}]", word_of(parameter)));
    }
    let choice = Choice::read(node, "a range", &["linear", "log", "step"], findings)?;
    let fields = choice.fields("a range", findings)?;
    let from = fields.required("from", |node| end(node, parameter, findings));
    let to = fields.required("to", |node| end(node, parameter, findings));
    let spacing = match choice.name {
        "step" => fields
            .required("step", |node| Some((size(node, parameter, findings)?, node.span)))
            .map(|(step, span)| Spacing::Step(step, span)),
        name => fields.required("points", |node| points(node, name == "log", findings)),
    };
    fields.close()?;
    let (from, to, spacing) = (from?, to?, spacing?);
    let spaced = if matches!(spacing, Spacing::Log(_)) { AxisScale::Log } else { AxisScale::Linear };
    let [from, to] = in_order(from, to, spaced, findings)?;
    let points = match spacing {
        Spacing::Step(step, span) => {
            if step <= 0.0 {
                return findings.wrong(span, "the step must be above zero");
            }
            let steps = ((to - from) / step + 1e-9).floor();
            if steps >= f64::from(MOST_POINTS) {
                return too_many(span, steps + 1.0, findings);
            }
            (0..=steps as u32).map(|i| from + f64::from(i) * step).collect()
        }
        Spacing::Linear(points) => between(from, to, points),
        Spacing::Log(points) => {
            between(libm::log10(from), libm::log10(to), points).into_iter().map(libm::exp10).collect::<Vec<_>>()
        }
    };
    Some(points.into_iter().map(|point| ParameterValue::Number(rounded(point))).collect())
}

/// An end of a range, and where it stands.
pub(super) fn end(node: &Node, parameter: Parameter, findings: &Findings) -> Option<(f64, Span)> {
    Some((size(node, parameter, findings)?, node.span))
}

/// Both ends, if they are those of a range.
pub(super) fn in_order(
    (from, from_at): (f64, Span),
    (to, to_at): (f64, Span),
    spacing: AxisScale,
    findings: &Findings,
) -> Option<[f64; 2]> {
    if from >= to {
        return findings.wrong(to_at, "a range ends above its start");
    }
    if spacing == AxisScale::Log && from <= 0.0 {
        return findings.wrong(from_at, "a logarithmic range starts above zero");
    }
    Some([from, to])
}

enum Spacing {
    Linear(u32),
    Log(u32),
    Step(f64, Span),
}

fn points(node: &Node, log: bool, findings: &Findings) -> Option<Spacing> {
    let points = count(node, "points", MOST_POINTS, findings)?;
    if points < 2 {
        return findings.wrong(node.span, "a range has two points at least");
    }
    Some(if log { Spacing::Log(points) } else { Spacing::Linear(points) })
}

pub(super) fn between(from: f64, to: f64, points: u32) -> Vec<f64> {
    let last = f64::from(points - 1);
    (0..points).map(|i| from + (to - from) * (f64::from(i) / last)).collect()
}

/// To 13 significant digits.
pub(super) fn rounded(x: f64) -> f64 {
    // The text of a finite number always reads back.
    format!("{x:.12e}").parse().unwrap_or(x)
}
