//! Ranges of values: a list, or evenly, logarithmically or stepwise between two ends, with units where the parameter
//! has one.
//!
//! Points are rounded to 13 significant digits: decades come out exactly, and on every machine alike.

use serde_json::json;

use super::figure_spec::AxisScale;
use super::recipe::{Parameter, ParameterTakes, ParameterValue};
use crate::yaml::reader::scalar;
use crate::yaml::word::word_of;
use crate::yaml::{At, Findings, Node, Span, Value, schema};

/// Most points of all sweeps of a file together.
pub(super) const MOST_POINTS: u32 = 100_000;

/// The values of a parameter, at least one. In a description any parameter may be meant.
pub(super) fn values(at: At<'_>, parameter: Option<Parameter>) -> Option<Vec<ParameterValue>> {
    if let At::Node(Node { value: Value::Sequence(items), .. }, _) = at
        && items.is_empty()
    {
        return at.wrong("this sweep is empty: give it at least one value");
    }
    let placed = |at: At<'_>| Some((at.span(), part(at, parameter)?));
    let one = |at: At<'_>| placed(at).map(|part| vec![part]);
    let parts = at.either(|value| matches!(value, Value::Sequence(_)), |at| at.list(placed), one)?;
    let mut values: Vec<ParameterValue> = Vec::new();
    for (span, part) in parts {
        let mut part = part.as_slice();
        // A range that begins where the one before ended shares that point with it.
        if part.len() > 1 && values.last() == part.first() {
            part = &part[1..];
        }
        values.extend(part);
        if values.len() > MOST_POINTS as usize {
            return too_many(at, span, values.len() as f64);
        }
    }
    Some(values)
}

/// The same where only numbers make sense.
pub(super) fn numbers(at: At<'_>, parameter: Option<Parameter>) -> Option<Vec<f64>> {
    let values = values(at, parameter)?;
    let numbers = values.iter().map(|value| match value {
        ParameterValue::Number(number) => Some(*number),
        _ => at.wrong("numbers are wanted here"),
    });
    crate::yaml::reader::all(numbers)
}

pub(super) fn too_many<T>(at: At<'_>, span: Span, points: f64) -> Option<T> {
    let points = if points < 1e9 { format!("{points:.0}") } else { format!("{points:.1e}") };
    at.report_at(
        span,
        format!("{points} points are too many: {MOST_POINTS} at most"),
        Some("widen the step, or split the experiment".into()),
    )
}

/// One item of a list: a value, or a range within the list.
fn part(at: At<'_>, parameter: Option<Parameter>) -> Option<Vec<ParameterValue>> {
    let one = |at: At<'_>| value(at, parameter).map(|value| vec![value]);
    at.either(|value| matches!(value, Value::Mapping(_)), |at| range(at, parameter), one)
}

/// Most parameters take the same values: a schema describes them once.
pub(super) fn by_kind<T>(
    at: At<'_>,
    prefix: &str,
    takes: Option<ParameterTakes>,
    read: impl FnOnce(At<'_>) -> Option<T>,
) -> Option<T> {
    let (At::Sketch(_), Some(takes)) = (at, takes) else { return read(at) };
    let kind = match takes {
        ParameterTakes::Words(words) => words.iter().map(|word| word_of(*word)).collect::<Vec<_>>().join("_or_"),
        ParameterTakes::Quantity(dimension) => dimension.name().replace(' ', "_"),
        ParameterTakes::Ratio => "a_ratio".into(),
        ParameterTakes::RatioOrInfinite => "a_ratio_or_infinite".into(),
    };
    let about = if matches!(takes, ParameterTakes::Words(_)) { "One of these" } else { "A value" };
    at.named(&format!("{prefix}{kind}"), about, read)
}

/// A single value of a parameter.
pub(super) fn value(at: At<'_>, parameter: Option<Parameter>) -> Option<ParameterValue> {
    let takes = parameter.map(Parameter::takes);
    match takes {
        Some(ParameterTakes::Words(known)) => by_kind(at, "", takes, |at| {
            let read = |node: &Node, findings: &Findings| {
                let word = if let Value::Scalar(text) = &node.value { text.as_str() } else { "" };
                known.iter().copied().find(|known| word_of(*known) == word).or_else(|| {
                    let [one, other] = describe(known);
                    let given = scalar(node, findings)?;
                    findings.wrong(node.span, format!("`{given}` is neither {one} nor {other}"))
                })
            };
            let words =
                |about: &str| schema::one_of_words(about, &known.iter().map(|word| word_of(*word)).collect::<Vec<_>>());
            at.form(read, |it| words(it.about()))
        }),
        Some(ParameterTakes::RatioOrInfinite) => by_kind(at, "", takes, |at| {
            if at.is_word("infinite") {
                return Some(ParameterValue::Infinite);
            }
            at.ratio().map(ParameterValue::Number)
        }),
        _ => size(at, parameter).map(ParameterValue::Number),
    }
}

/// A value of a parameter that is a number, in SI.
pub(super) fn size(at: At<'_>, parameter: Option<Parameter>) -> Option<f64> {
    match parameter.map(Parameter::takes) {
        Some(takes @ ParameterTakes::Quantity(dimension)) => by_kind(at, "", Some(takes), |at| at.quantity(dimension)),
        Some(ParameterTakes::Words(_) | ParameterTakes::Ratio | ParameterTakes::RatioOrInfinite) => {
            by_kind(at, "", Some(ParameterTakes::Ratio), |at| at.ratio())
        }
        None => at.form(|_, _| None, |_| json!({"type": ["number", "string"]})),
    }
}

/// The two words of a parameter that takes words.
fn describe(words: &[ParameterValue]) -> [String; 2] {
    let word = |i: usize| words.get(i).map_or_else(String::new, |known| format!("`{}`", word_of(*known)));
    [word(0), word(1)]
}

fn range(at: At<'_>, parameter: Option<Parameter>) -> Option<Vec<ParameterValue>> {
    if let Some((ParameterTakes::Words(words), parameter)) = parameter.map(|parameter| (parameter.takes(), parameter)) {
        let [one, other] = describe(words).map(|word| word.replace('`', ""));
        return at.wrong(format!("`{}` is swept over [{one}, {other}]", word_of(parameter)));
    }
    let forms = [
        ("linear", "Evenly spaced points"),
        ("log", "Points evenly spaced in the logarithm"),
        ("step", "Points a step apart"),
    ];
    at.choose("a range", &forms, |choice| {
        let keys = choice.keys("a range")?;
        let from = keys.required("from", "Where it starts", |at| end(at, parameter));
        let to = keys.required("to", "Where it ends", |at| end(at, parameter));
        let spacing = match choice.name() {
            "step" => keys
                .required("step", "From one point to the next", |at| end(at, parameter))
                .map(|(step, span)| Spacing::Step(step, span)),
            name => {
                let points = keys.required("points", "Number of points", |at| {
                    at.count_from(2, "points", MOST_POINTS, "a range has two points at least")
                });
                points.map(if name == "log" { Spacing::Log } else { Spacing::Linear })
            }
        };
        keys.close()?;
        let (from, to, spacing) = (from?, to?, spacing?);
        let spaced = if matches!(spacing, Spacing::Log(_)) { AxisScale::Log } else { AxisScale::Linear };
        let [from, to] = in_order(at, from, to, spaced)?;
        let points = match spacing {
            Spacing::Step(step, span) => {
                if step <= 0.0 {
                    return at.wrong_at(span, "the step must be above zero");
                }
                let steps = ((to - from) / step + 1e-9).floor();
                if steps >= f64::from(MOST_POINTS) {
                    return too_many(at, span, steps + 1.0);
                }
                (0..=steps as u32).map(|i| from + f64::from(i) * step).collect()
            }
            Spacing::Linear(points) => between(from, to, points),
            Spacing::Log(points) => {
                between(libm::log10(from), libm::log10(to), points).into_iter().map(libm::exp10).collect::<Vec<_>>()
            }
        };
        Some(points.into_iter().map(|point| ParameterValue::Number(rounded(point))).collect())
    })
}

/// An end of a range, and where it stands.
pub(super) fn end(at: At<'_>, parameter: Option<Parameter>) -> Option<(f64, Span)> {
    Some((size(at, parameter)?, at.span()))
}

/// Both ends, if they are those of a range.
pub(super) fn in_order(
    at: At<'_>,
    (from, from_at): (f64, Span),
    (to, to_at): (f64, Span),
    spacing: AxisScale,
) -> Option<[f64; 2]> {
    if from >= to {
        return at.wrong_at(to_at, "a range ends above its start");
    }
    if spacing == AxisScale::Log && from <= 0.0 {
        return at.wrong_at(from_at, "a logarithmic range starts above zero");
    }
    Some([from, to])
}

enum Spacing {
    Linear(u32),
    Log(u32),
    Step(f64, Span),
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
