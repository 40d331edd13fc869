//! A curve held against a published or analytic one, point by point within a tube of widths on both axes.
//!
//! A curve that is a little shifted is not far off, however steep it is. So the distance of a point to a curve is the
//! smallest that some place of the curve has in units of the tube, the larger of both axes'. It is taken both ways: each
//! computed point within the published range to the published curve, and each published point to the computed curve, so
//! that a peak that is not there shows as one that should not be.

use super::absence::Absence;
use super::claims::{Within, within};
use super::fit::{Fit, FitMeasure};
use super::mapping::{claim, mapping};
use super::name::Column;
use super::tally::{Decision, Tally};
use super::text::{significant, symbol, with_unit};
use super::view::{Line, View};
use crate::yaml::At;

claim! {
    "a curve" Curve {
        of: Column = required("The measure", Column::read),
        over: Column = required("The parameter", Column::read),
        points: Vec<[f64; 2]> =
            required("Its points, x increasing, in the units of the two columns", |at| points(at, 2)),
        tube: Tube = required("How far a point may lie beside the curve", Tube::read),
    }
}
mapping! {
    "a tube" Tube {
        x: Within = required("Along the parameter", width),
        y: Within = required("Along the measure", width),
    }
}

fn width(at: At<'_>) -> Option<Within> {
    match within(None)(at)? {
        Within::Relative(0.0) | Within::Absolute(0.0) => at.wrong("a tube has a width above zero on both axes"),
        width => Some(width),
    }
}

/// Points of a line, x increasing.
pub(super) fn points(at: At<'_>, least: usize) -> Option<Vec<[f64; 2]>> {
    let point = |at: At<'_>| {
        let point: Result<[f64; 2], _> = at.pair(|at| at.number())?.try_into();
        point.ok().or_else(|| at.report("a point has two numbers", Some("write [x, y]".into())))
    };
    let points = at.list(point)?;
    if points.len() < least {
        return at.wrong(format!("{} points are no line: {least} at least", points.len()));
    }
    if !points.is_sorted_by(|a, b| a[0] < b[0]) {
        return at.wrong("the points do not stand in order: x increases from each to the next");
    }
    Some(points)
}

/// A point of a curve.
#[derive(Debug, Clone, Copy)]
struct Point {
    x: f64,
    y: f64,
}

/// How far a point is beside a curve.
struct Departure {
    /// In widths of the tube.
    widths: f64,
    /// Its uncertainty, of the point's own.
    u: f64,
    x: f64,
}

impl Curve {
    pub(crate) fn decide(&self, view: &View<'_>) -> Result<Decision, Absence> {
        let (line, departures) = self.departures(view)?;
        let mut tally = Tally::new("widths");
        for departure in &departures {
            tally.require(1.0 - departure.widths, departure.u, || self.words(departure, &line));
        }
        tally.decision()
    }

    /// The worst departure, for a report.
    pub(crate) fn fit(&self, view: &View<'_>) -> Option<Fit> {
        let (line, departures) = self.departures(view).ok()?;
        let worst = departures.iter().max_by(|a, b| a.widths.total_cmp(&b.widths))?;
        Some(Fit {
            against: format!("{} points of `{}` over `{}`", self.points.len(), self.of, self.over),
            measure: FitMeasure::TubeWidths,
            points: departures.len(),
            value: worst.widths,
            u: worst.u,
            limit: 1.0,
            remark: format!(
                "at {} = {}; the tube is ±{} wide in x, ±{} in y",
                self.over,
                with_unit(worst.x, 4, &line.over_unit),
                self.tube.x.words(worst.x.abs(), &line.over_unit),
                self.tube.y.words(line.range(), &line.unit)
            ),
        })
    }

    fn words(&self, departure: &Departure, line: &Line) -> String {
        let at = with_unit(departure.x, 4, &line.over_unit);
        format!(
            "largest departure {} of the tube's width, at {} = {at}",
            significant(departure.widths, 3),
            symbol(&self.over)
        )
    }

    fn departures(&self, view: &View<'_>) -> Result<(Line, Vec<Departure>), Absence> {
        let line = view.line(self.source(), &self.of, &self.over, None)?;
        let published: Vec<Point> = self.points.iter().map(|&[x, y]| Point { x, y }).collect();
        let computed: Vec<Point> = line.x.iter().zip(&line.y).map(|(&x, cell)| Point { x, y: cell.value }).collect();
        if computed.len() < 2 {
            return Err(Absence::NoRow(format!("one point of `{}` is no curve", self.of)));
        }
        let (first, last) = (published[0].x, published[published.len() - 1].x);
        let mut departures: Vec<Departure> = Vec::new();
        for (point, cell) in computed.iter().zip(&line.y) {
            if (first..=last).contains(&point.x) {
                let u = cell.run / self.width(&self.tube.y, point.y);
                departures.push(Departure { widths: self.widths_beside(*point, &published), u, x: point.x });
            }
        }
        for point in &published {
            // The error of the nearest computed point.
            let near = line.x.partition_point(|x| *x < point.x).min(line.x.len() - 1);
            let u = line.y[near].run / self.width(&self.tube.y, point.y);
            departures.push(Departure { widths: self.widths_beside(*point, &computed), u, x: point.x });
        }
        Ok((line, departures))
    }

    fn width(&self, within: &Within, at: f64) -> f64 {
        within.allows(at, at).max(f64::MIN_POSITIVE)
    }

    /// The smallest distance of a point to a polyline, in widths of the tube at the point.
    fn widths_beside(&self, point: Point, curve: &[Point]) -> f64 {
        let scaled = |other: Point| Point {
            x: (other.x - point.x) / self.width(&self.tube.x, point.x),
            y: (other.y - point.y) / self.width(&self.tube.y, point.y),
        };
        curve.windows(2).map(|pair| from_origin(scaled(pair[0]), scaled(pair[1]))).fold(f64::INFINITY, f64::min)
    }
}

/// The smallest max(|x|, |y|) on the straight line between two points: at an end, where a coordinate is zero, or where both
/// are equally large.
fn from_origin(a: Point, b: Point) -> f64 {
    let (dx, dy) = (b.x - a.x, b.y - a.y);
    let candidates = [0.0, 1.0, -a.x / dx, -a.y / dy, (a.y - a.x) / (dx - dy), -(a.x + a.y) / (dx + dy)];
    candidates
        .into_iter()
        .filter(|share| share.is_finite())
        .map(|share| {
            let share = share.clamp(0.0, 1.0);
            (a.x + share * dx).abs().max((a.y + share * dy).abs())
        })
        .fold(f64::INFINITY, f64::min)
}
