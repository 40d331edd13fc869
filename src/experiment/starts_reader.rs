//! The `starts` of an experiment: nodes to [`Starts`].

use super::diagnostic::{Findings, Span};
use super::quantity::Dimension;
use super::reader::{Choice, Fields, count, list, number, quantity};
use super::starts::{HeightBox, Interval, ParticleBox, Starts};
use super::yaml::{Node, Value};

/// Most starts of a case.
pub(super) const MOST_STARTS: u32 = 100_000;
/// Seed unless an experiment says.
const USUAL_SEED: u32 = 1;

/// The box as read.
pub(super) struct ReadStarts {
    pub starts: Starts,
    pub span: Span,
    /// Where the particles stand, or all of it.
    pub particles_at: Span,
}

/// Reads the node under `starts`.
pub(super) fn read_starts(node: &Node, findings: &Findings) -> Option<ReadStarts> {
    let fields = Fields::open(node, "a box of starts", findings)?;
    let displacement = fields.optional("displacement", |node| {
        interval(node, findings, "[-5 mm, 5 mm]", |node| quantity(node, Dimension::Length, findings))
    });
    let velocity = fields.optional("velocity", |node| speeds(node, findings));
    let particles_at = fields.get("particles").map_or(node.span, |node| node.span);
    let particles = fields.optional("particles", |node| list(node, findings, |node| particle(node, findings)));
    let starts = fields.required("count", |node| match count(node, "starts", MOST_STARTS, findings)? {
        0 => findings.wrong(node.span, "one start at least is wanted here"),
        count => Some(count),
    });
    let seed = fields.optional("seed", |node| count(node, "", u32::MAX, findings));
    fields.close()?;
    let starts = Starts {
        count: starts?,
        seed: seed?.unwrap_or(USUAL_SEED),
        displacement: displacement?,
        velocity: velocity?,
        particles: particles?.unwrap_or_default(),
    };
    if starts.lists().is_empty() {
        return findings.report(
            node.span,
            "this box is a single point: all starts would be the same",
            Some("write for example `displacement: [-5 mm, 5 mm]`".into()),
        );
    }
    Some(ReadStarts { starts, span: node.span, particles_at })
}

/// `on_floor`, or `{height: [0 mm, 5 mm], velocity: [-1 m/s, 1 m/s]}` with `height_share: [0, 1]` in the place of the height.
fn particle(node: &Node, findings: &Findings) -> Option<ParticleBox> {
    const WHAT: &str = "the box of a particle";
    if let Value::Scalar(_) = node.value {
        Choice::read(node, WHAT, &["on_floor"], findings)?;
        return Some(ParticleBox::OnFloor);
    }
    let fields = Fields::open(node, WHAT, findings)?;
    let height = fields.exactly_one(&["height", "height_share"]);
    let height = height.and_then(|(key, node)| {
        let (heights, most) = match key {
            "height" => {
                let read = |node: &Node| quantity(node, Dimension::Length, findings);
                (HeightBox::Of(interval(node, findings, "[0 mm, 5 mm]", read)?), f64::INFINITY)
            }
            _ => (HeightBox::OfGap(interval(node, findings, "[0, 1]", |node| number(node, findings))?), 1.0),
        };
        let Interval { from, to } = heights.interval();
        if from < 0.0 {
            return findings.wrong(node.span, "a particle starts no lower than its floor, at height 0");
        }
        if to > most {
            return findings.wrong(node.span, "a particle starts no higher than its ceiling, at a share of 1");
        }
        Some(heights)
    });
    let velocity = fields.required("velocity", |node| speeds(node, findings));
    fields.close()?;
    Some(ParticleBox::InFlight { height: height?, velocity: velocity? })
}

fn speeds(node: &Node, findings: &Findings) -> Option<Interval> {
    interval(node, findings, "[-1 m/s, 1 m/s]", |node| quantity(node, Dimension::Velocity, findings))
}

/// Two values in ascending order, or one that does not vary.
fn interval<'t>(
    node: &'t Node,
    findings: &Findings,
    example: &str,
    read: impl Fn(&'t Node) -> Option<f64>,
) -> Option<Interval> {
    let Value::Sequence(_) = node.value else {
        let value = read(node)?;
        return Some(Interval { from: value, to: value });
    };
    let help = Some(format!("write for example {example}"));
    match list(node, findings, read)?.as_slice() {
        &[from, to] if from < to => Some(Interval { from, to }),
        &[from, to] if from > to => {
            findings.report(node.span, "this range runs backwards", Some("write the smaller value first".into()))
        }
        [_, _] => findings.report(
            node.span,
            "this range is empty: both ends are the same",
            Some("write a single value for what does not vary".into()),
        ),
        _ => findings.report(node.span, "a range has two ends", help),
    }
}
