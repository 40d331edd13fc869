//! The `starts` of an experiment: nodes to [`Starts`].

use super::starts::{HeightBox, Interval, ParticleBox, Starts};
use crate::yaml::{At, Dimension, Span, Value, reader, schema};

/// Most starts of a case.
const MOST_STARTS: u32 = 100_000;
/// Seed unless an experiment says.
const USUAL_SEED: u32 = 1;

/// The box as read.
pub(super) struct ReadStarts {
    pub starts: Starts,
    pub span: Span,
    /// Where the particles stand, or all of it.
    pub particles_at: Span,
}

/// Reads what stands under `starts`.
pub(super) fn read_starts(at: At<'_>) -> Option<ReadStarts> {
    let keys = at.keys("a box of starts")?;
    let displacement = keys.optional("displacement", "Displacement of the mass", |at| {
        interval(at, "[-5 mm, 5 mm]", |at| at.quantity(Dimension::Length))
    });
    let velocity = keys.optional("velocity", "Velocity of the mass", speeds);
    let particles_at = keys.span_of("particles").unwrap_or(at.span());
    let particles = keys.optional("particles", "Where particles may start, one a damper", |at| at.list(particle));
    let count = keys.required("count", "Starts of every case", |at| {
        at.count_from(1, "starts", MOST_STARTS, "one start at least is wanted here")
    });
    let seed = keys.optional("seed", "Seed of the random numbers; 1 unless stated", |at| at.count("", u32::MAX));
    keys.close()?;
    let starts = Starts {
        count: count?,
        seed: seed?.unwrap_or(USUAL_SEED),
        displacement: displacement?,
        velocity: velocity?,
        particles: particles?.unwrap_or_default(),
    };
    if starts.lists().is_empty() {
        return at.report(
            "this box is a single point: all starts would be the same",
            Some("write for example `displacement: [-5 mm, 5 mm]`".into()),
        );
    }
    Some(ReadStarts { starts, span: at.span(), particles_at })
}

/// `on_floor`, or `{height: [0 mm, 5 mm], velocity: [-1 m/s, 1 m/s]}` with `height_share: [0, 1]` in the place of the height.
fn particle(at: At<'_>) -> Option<ParticleBox> {
    const WHAT: &str = "the box of a particle";
    let on_floor = |at: At<'_>| at.choose(WHAT, &[("on_floor", "")], |it| it.bare().map(|()| ParticleBox::OnFloor));
    at.either(
        |value| matches!(value, Value::Scalar(_)),
        on_floor,
        |at| {
            let keys = at.keys(WHAT)?;
            let heights = [
                ("height", "Height over its floor"),
                ("height_share", "Height over its floor as a share of the gap clearance"),
            ];
            let height = keys.exactly_one(&heights, height);
            let velocity = keys.required("velocity", "Velocity relative to its floor", speeds);
            keys.close()?;
            Some(ParticleBox::InFlight { height: height?, velocity: velocity? })
        },
    )
}

fn height(key: &str, at: At<'_>) -> Option<HeightBox> {
    let share = |at: At<'_>| at.form(reader::number, |sketch| schema::between(sketch.about(), 0.0, 1.0));
    let (heights, most) = match key {
        "height" => {
            let read = |at: At<'_>| at.quantity(Dimension::Length);
            (HeightBox::Of(interval(at, "[0 mm, 5 mm]", read)?), f64::INFINITY)
        }
        _ => (HeightBox::OfGap(interval(at, "[0, 1]", share)?), 1.0),
    };
    let Interval { from, to } = heights.interval();
    if from < 0.0 {
        return at.wrong("a particle starts no lower than its floor, at height 0");
    }
    if to > most {
        return at.wrong("a particle starts no higher than its ceiling, at a share of 1");
    }
    Some(heights)
}

fn speeds(at: At<'_>) -> Option<Interval> {
    interval(at, "[-1 m/s, 1 m/s]", |at| at.quantity(Dimension::Velocity))
}

/// Two values in ascending order, or one that does not vary.
fn interval(at: At<'_>, example: &str, read: impl Fn(At<'_>) -> Option<f64>) -> Option<Interval> {
    let range = |at: At<'_>| match at.pair(&read)?.as_slice() {
        &[from, to] if from < to => Some(Interval { from, to }),
        &[from, to] if from > to => {
            at.report("this range runs backwards", Some("write the smaller value first".into()))
        }
        [_, _] => at.report(
            "this range is empty: both ends are the same",
            Some("write a single value for what does not vary".into()),
        ),
        _ => at.report("a range has two ends", Some(format!("write for example {example}"))),
    };
    let one = |at: At<'_>| read(at).map(|value| Interval { from: value, to: value });
    at.either(|value| matches!(value, Value::Sequence(_)), range, one)
}
