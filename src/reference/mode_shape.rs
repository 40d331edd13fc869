//! A shape held against an analytic one by the modal assurance criterion,
//! MAC = (Σφψ)²/(Σφ² Σψ²): 1 where the shapes are the same up to a factor, 0 where they have nothing in common.

use serde::Serialize;
use serde_json::json;

use super::absence::Absence;
use super::analytic;
use super::fit::{Fit, FitMeasure};
use super::mapping::{Reads, Seen, claim, forms};
use super::name::Column;
use super::tally::{Decision, Tally};
use super::text::significant;
use super::tube::points;
use super::view::View;
use crate::yaml::{At, Value};

claim! {
    "a mode shape" ModeShape, over_its_sides {
        of: Column = required("List of the deflections", Column::read),
        over: Places =
            required("Lists of the places, as shares of the sides: `x`, or `[x, y]` on a plate", Places::read),
        like: Like = required("The shape to hold it against", Like::read),
        mac: Mac = required("How alike", Mac::read),
    }
}

/// The lists that say where the deflections are.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[serde(untagged)]
pub enum Places {
    /// Along a line.
    Line(Column),
    /// On a rectangle.
    Rectangle([Column; 2]),
}

impl Places {
    fn read(at: At<'_>) -> Option<Self> {
        let rectangle = |at: At<'_>| {
            let lists: Result<[Column; 2], _> = at.pair(Column::read)?.try_into();
            lists.ok().or_else(|| at.wrong("a plate has two sides: `[x, y]`")).map(Self::Rectangle)
        };
        let line = |at: At<'_>| Column::read(at).map(Self::Line);
        at.either(|value| matches!(value, Value::Sequence(_)), rectangle, line)
    }
}

impl Reads for Places {
    fn note<'a>(&'a self, seen: &mut Seen<'a>) {
        match self {
            Self::Line(x) => x.note(seen),
            Self::Rectangle([x, y]) => [x, y].into_iter().for_each(|side| side.note(seen)),
        }
    }
}

forms! {
    "a shape" Like {
        Cantilever(u32) = form("cantilever", "A uniform cantilever's n-th mode, clamped at 0", mode),
        Clamped(u32) = form("clamped", "A uniform beam's n-th mode, clamped at both ends", mode),
        Sine(u32) = form("sine", "sin nπx: a simply supported beam's n-th mode", mode),
        SineProduct([u32; 2]) =
            form("sine_product", "sin mπx sin nπy: a mode of a plate that is simply supported all around", modes),
        Column(Column) = form("column", "Another list of the same row", Column::read),
        Points(Vec<[f64; 2]>) =
            form("points", "Points of a line, x increasing: the shape is read between them", |at| points(at, FEWEST_POINTS)),
    }
}

fn mode(at: At<'_>) -> Option<u32> {
    at.count_from(1, "", MOST_MODES, "modes are counted from 1")
}

fn modes(at: At<'_>) -> Option<[u32; 2]> {
    let modes: Result<[u32; 2], _> = at.pair(mode)?.try_into();
    modes.ok().or_else(|| at.wrong("a plate's mode has two numbers: `[m, n]`"))
}

forms! {
    "a limit on the criterion" Mac {
        AtLeast(f64) = form("at_least", "The shapes are the same", limit),
        AtMost(f64) = form("at_most", "The shapes are different", limit),
    }
}

fn limit(at: At<'_>) -> Option<f64> {
    at.form(
        |node, findings| match At::Node(node, findings).number()? {
            limit if limit > 0.0 && limit < 1.0 => Some(limit),
            _ => findings.wrong(node.span, "a limit on the criterion lies between 0 and 1"),
        },
        |it| json!({"description": it.about(), "type": "number", "exclusiveMinimum": 0, "exclusiveMaximum": 1}),
    )
}

/// Higher modes have more waves than any list has points.
const MOST_MODES: u32 = 1000;
/// Fewer points tell no shapes apart.
const FEWEST_POINTS: usize = 5;

/// What came out.
struct Compared {
    mac: f64,
    points: usize,
    /// Of the same family, the other shape that comes nearest.
    next: Option<(String, f64)>,
}

impl ModeShape {
    fn over_its_sides(&self, at: At<'_>) -> Option<()> {
        match (&self.like, &self.over) {
            (Like::SineProduct(_), Places::Line(_)) => {
                at.under("over").wrong("a plate's shape lies over two lists: `over: [x, y]`")
            }
            (Like::Cantilever(_) | Like::Clamped(_) | Like::Sine(_) | Like::Points(_), Places::Rectangle(_)) => {
                at.under("over").wrong("a beam's shape lies over one list: `over: x`")
            }
            _ => Some(()),
        }
    }

    pub(crate) fn decide(&self, view: &View<'_>) -> Result<Decision, Absence> {
        let compared = self.compared(view)?;
        let mut tally = Tally::new("");
        let margin = match self.mac {
            Mac::AtLeast(limit) => compared.mac - limit,
            Mac::AtMost(limit) => limit - compared.mac,
        };
        tally.require(margin, 0.0, || {
            let limit = match self.mac {
                Mac::AtLeast(limit) => format!("at least {}", significant(limit, 6)),
                Mac::AtMost(limit) => format!("at most {}", significant(limit, 6)),
            };
            let next = compared
                .next
                .as_ref()
                .map_or_else(String::new, |(name, mac)| format!("; {} with {name}", significant(*mac, 2)));
            let mac = significant(compared.mac, 6);
            format!("MAC {mac} with {} over {} points (required: {limit}){next}", self.like.words(), compared.points)
        });
        tally.decision()
    }

    /// The criterion, for a report.
    pub(crate) fn fit(&self, view: &View<'_>) -> Option<Fit> {
        let compared = self.compared(view).ok()?;
        let (measure, limit) = match self.mac {
            Mac::AtLeast(limit) => (FitMeasure::MacAtLeast, limit),
            Mac::AtMost(limit) => (FitMeasure::MacAtMost, limit),
        };
        let remark = compared.next.map_or_else(String::new, |(name, mac)| {
            format!("the nearest of the others is {name}, MAC {}", significant(mac, 2))
        });
        let against = self.like.words();
        Some(Fit { against, measure, points: compared.points, value: compared.mac, u: 0.0, limit, remark })
    }

    /// The shape that would satisfy a claim of likeness and break one of difference; for the self-test.
    pub(crate) fn double(&self, view: &View<'_>) -> Result<Vec<f64>, Absence> {
        let (places, _) = self.lists(view)?;
        self.like.at(&places, || self.other(view))
    }

    fn compared(&self, view: &View<'_>) -> Result<Compared, Absence> {
        let (places, shape) = self.lists(view)?;
        let like = self.like.at(&places, || self.other(view))?;
        // Points may end before the shape does.
        let pairs: Vec<(f64, f64)> = shape.iter().copied().zip(like).filter(|(_, like)| like.is_finite()).collect();
        if pairs.len() < FEWEST_POINTS {
            return Err(Absence::NoRow(format!("{} points are no shape", pairs.len())));
        }
        let mac = criterion(pairs.iter().copied())
            .ok_or_else(|| Absence::Nowhere(format!("`{}` does not move at all", self.of)))?;
        let mut next: Option<(String, f64)> = None;
        for other in self.like.relatives() {
            let values = other.at(&places, || Ok(Vec::new()))?;
            if let Some(mac) = criterion(shape.iter().copied().zip(values))
                && next.as_ref().is_none_or(|(_, largest)| mac > *largest)
            {
                next = Some((other.words(), mac));
            }
        }
        Ok(Compared { mac, points: pairs.len(), next })
    }

    fn lists<'v>(&self, view: &View<'v>) -> Result<(Vec<Spot>, &'v [f64]), Absence> {
        let rows = view.rows(self.source(), None)?;
        let share = |name: &str| {
            let unit = view.unit(&rows, name)?;
            if !unit.is_empty() {
                return Err(Absence::Broken(format!("`{name}` is in {unit}; shares of the side are wanted")));
            }
            view.path(&rows, name)
        };
        let shape = view.path(&rows, &self.of)?;
        let places: Vec<Spot> = match &self.over {
            Places::Line(x) => share(x)?.iter().map(|&x| Spot { x, y: 0.0 }).collect(),
            Places::Rectangle([x, y]) => share(x)?.iter().zip(share(y)?).map(|(&x, &y)| Spot { x, y }).collect(),
        };
        if places.len() != shape.len() {
            return Err(Absence::Broken(format!(
                "`{}` has {} points at {} places",
                self.of,
                shape.len(),
                places.len()
            )));
        }
        Ok((places, shape))
    }

    fn other(&self, view: &View<'_>) -> Result<Vec<f64>, Absence> {
        let Like::Column(name) = &self.like else { return Ok(Vec::new()) };
        let rows = view.rows(self.source(), None)?;
        Ok(view.path(&rows, name)?.to_vec())
    }
}

/// A place on a structure, as shares of its sides.
#[derive(Debug, Clone, Copy)]
struct Spot {
    x: f64,
    y: f64,
}

impl Like {
    /// Its values at the places; NaN where points end.
    fn at(&self, places: &[Spot], other: impl FnOnce() -> Result<Vec<f64>, Absence>) -> Result<Vec<f64>, Absence> {
        let each = |value: &dyn Fn(Spot) -> f64| Ok(places.iter().map(|&spot| value(spot)).collect());
        match self {
            Self::Cantilever(n) => {
                let mode = analytic::Mode::cantilever(*n);
                each(&|spot| mode.at(spot.x))
            }
            Self::Clamped(n) => {
                let mode = analytic::Mode::clamped(*n);
                each(&|spot| mode.at(spot.x))
            }
            Self::Sine(n) => each(&|spot| analytic::sine(*n, spot.x)),
            Self::SineProduct([m, n]) => each(&|spot| analytic::sine(*m, spot.x) * analytic::sine(*n, spot.y)),
            Self::Column(_) => other(),
            Self::Points(points) => each(&|spot| between(points, spot.x)),
        }
    }

    /// Shapes of the same family with which this one could be mistaken.
    fn relatives(&self) -> Vec<Self> {
        let others = |n: u32| (1..=n + 3).filter(move |other| *other != n);
        match self {
            Self::Cantilever(n) => others(*n).map(Self::Cantilever).collect(),
            Self::Clamped(n) => others(*n).map(Self::Clamped).collect(),
            Self::Sine(n) => others(*n).map(Self::Sine).collect(),
            Self::SineProduct([m, n]) => {
                let all = (1..=m + 2).flat_map(|a| (1..=n + 2).map(move |b| [a, b]));
                all.filter(|pair| pair != &[*m, *n]).map(Self::SineProduct).collect()
            }
            Self::Column(_) | Self::Points(_) => Vec::new(),
        }
    }

    fn words(&self) -> String {
        match self {
            Self::Cantilever(n) => format!("mode {n} of a cantilever"),
            Self::Clamped(n) => format!("mode {n} of a clamped beam"),
            Self::Sine(n) => format!("sin {n}πx"),
            Self::SineProduct([m, n]) => format!("sin {m}πx sin {n}πy"),
            Self::Column(name) => format!("`{name}`"),
            Self::Points(points) => format!("{} points", points.len()),
        }
    }
}

/// On the straight line between two points; NaN outside.
fn between(points: &[[f64; 2]], x: f64) -> f64 {
    let i = points.partition_point(|point| point[0] <= x);
    match (i.checked_sub(1).and_then(|i| points.get(i)), points.get(i)) {
        (Some([x0, y0]), Some([x1, y1])) => y0 + (x - x0) / (x1 - x0) * (y1 - y0),
        (Some([x0, y0]), None) if x == *x0 => *y0,
        _ => f64::NAN,
    }
}

/// The criterion; none for a shape that is zero throughout.
fn criterion(pairs: impl Iterator<Item = (f64, f64)>) -> Option<f64> {
    let (mut across, mut one, mut other) = (0.0, 0.0, 0.0);
    for (a, b) in pairs {
        across += a * b;
        one += a * a;
        other += b * b;
    }
    (one > 0.0 && other > 0.0).then(|| across * across / (one * other))
}
