//! The peaks of a frequency response between the points of its grid: place, height and half-power width.
//!
//! Near a resonance the squared reciprocal of a response is a parabola in the frequency, far better than the response
//! itself. So the parabola goes through 1/y², on points at any distances; what the next wider points say instead is how
//! well the grid knows the result. Where the response is not positive, the parabola goes through the response.

use serde::{Deserialize, Serialize};

use super::absence::Absence;
use super::compare::COVERAGE;
use super::extracted::Extracted;
use super::mapping::{Reads, mapping, word};
use super::name::Column;
use super::printed::Printed;
use super::selection::Selection;
use super::text::{symbol, with_unit};
use super::view::{Cell, Line, View};
use crate::measure::column_words;
use crate::optimise::{Parabola, Point};
use crate::yaml::At;

word! {
    "a peak" Peak {
        of: Column = required("The response", Column::read),
        over: Column = required("The frequency", Column::read),
        which: Which = required("Which of its peaks", Which::read),
        prominence: f64 =
            or("What counts as a peak: how far the response falls on both sides, as a fraction of the peak's own height", |at| at.fraction(), USUAL_PROMINENCE),
        read: Feature = required("Which number of it", |at| at.word("number of a peak")),
    }
}

/// A twentieth: a ripple on a resonance is none.
const USUAL_PROMINENCE: f64 = 0.05;

/// Which of several peaks.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Which {
    /// The highest.
    Highest,
    /// The n-th from the low end, counted from 1.
    Number(u32),
    /// The one nearest to a frequency.
    Nearest(Printed),
}

impl Reads for Which {}
impl Reads for Feature {}

impl Which {
    fn read(at: At<'_>) -> Option<Self> {
        let forms = [
            ("highest", "The highest"),
            ("number", "The n-th from the low end, counted from 1"),
            ("nearest", "The one nearest to a frequency"),
        ];
        at.choose("the choice of a peak", &forms, |choice| match choice.name() {
            "highest" => choice.bare().map(|()| Self::Highest),
            "number" => choice.value()?.count_from(1, "", u32::MAX, "peaks are counted from 1").map(Self::Number),
            _ => Printed::read(choice.value()?).map(Self::Nearest),
        })
    }
}

/// A number of a peak.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Feature {
    /// Where it is.
    Place,
    /// How high it is.
    Height,
    /// How wide it is at 1/√2 of its height.
    HalfPowerWidth,
}

impl Feature {
    /// For a reader.
    pub(crate) fn words(self) -> &'static str {
        match self {
            Self::Place => "place",
            Self::Height => "height",
            Self::HalfPowerWidth => "half-power width",
        }
    }
}

impl Peak {
    pub(crate) fn take(&self, view: &View<'_>) -> Result<Extracted, Absence> {
        let line = view.line(self.source(), &self.of, &self.over, None)?;
        let at = self.choose(&line)?;
        let extracted = |value: f64, run: f64, spread: f64, unit: &str| Extracted {
            value,
            run,
            spread,
            unit: unit.into(),
            scale: None,
        };
        Ok(match self.read {
            Feature::Place => {
                let (place, u) = with_errors(&line, at, |top| top.x);
                extracted(place, u, 0.0, &line.over_unit)
            }
            Feature::Height => {
                let (height, u) = with_errors(&line, at, |top| top.y);
                extracted(height, u, line.y[at].spread, &line.unit)
            }
            Feature::HalfPowerWidth => {
                let (width, u) = half_power_width(&line, at)?;
                extracted(width, u, 0.0, &line.over_unit)
            }
        })
    }

    /// Whose unit the number has.
    pub(crate) fn column(&self) -> &Column {
        match self.read {
            Feature::Place | Feature::HalfPowerWidth => &self.over,
            Feature::Height => &self.of,
        }
    }

    /// The highest grid point of the peak that is meant.
    fn choose(&self, line: &Line) -> Result<usize, Absence> {
        let stands_out = |&(x, prominence): &(f64, Cell)| {
            let at = line.x.partition_point(|&other| other < x);
            let enough = prominence.value >= self.prominence * line.y[at].value.abs();
            (enough && prominence.value > COVERAGE * prominence.run).then_some(at)
        };
        let peaks: Vec<usize> = line.prominences().iter().filter_map(stands_out).collect();
        let none = || Absence::Nowhere(format!("the {} has no peak", column_words(&self.of)));
        match &self.which {
            Which::Highest => {
                peaks.into_iter().max_by(|&a, &b| line.y[a].value.total_cmp(&line.y[b].value)).ok_or_else(none)
            }
            Which::Number(n) => {
                let wanted = usize::try_from(*n).unwrap_or(usize::MAX);
                let found = peaks.len();
                peaks.into_iter().nth(wanted.saturating_sub(1)).ok_or_else(|| {
                    Absence::Nowhere(format!("the {} has {found} peaks, not {wanted}", column_words(&self.of)))
                })
            }
            Which::Nearest(printed) => {
                let (near, _) = printed.converted_to(&line.over_unit).ok_or_else(|| {
                    Absence::Broken(format!("`{}` is no `{}` in `{}`", printed.text(), self.over, line.over_unit))
                })?;
                let distance = |at: &usize| (line.x[*at] - near).abs();
                peaks.into_iter().min_by(|a, b| distance(a).total_cmp(&distance(b))).ok_or_else(none)
            }
        }
    }
}

/// The vertex of the parabola through three points of which the middle one is the highest.
fn vertex(points: [Point; 3]) -> Point {
    let reciprocal = points.iter().all(|point| point.y > 0.0);
    let height = |point: Point| if reciprocal { -1.0 / (point.y * point.y) } else { point.y };
    let [left, middle, right] = points;
    let heights = points.map(|point| Point { x: point.x, y: height(point) });
    let bulge = Parabola::through(1, |i| heights.get(i).copied()).filter(|parabola| parabola.curvature < 0.0);
    let vertex = bulge.map(|parabola| {
        let behind = (-parabola.slope / (2.0 * parabola.curvature)).clamp(left.x - middle.x, right.x - middle.x);
        Point { x: middle.x + behind, y: parabola.height(behind) }
    });
    let Point { x, y: top } = vertex.unwrap_or(heights[1]);
    let y = if reciprocal && top < 0.0 { 1.0 / (-top).sqrt() } else { middle.y.max(top) };
    Point { x, y }
}

/// A number of the peak at a grid point, and its uncertainty: what the errors of the three points do to it, and how far it
/// is from what the next wider points say.
fn with_errors(line: &Line, at: usize, read: impl Fn(Point) -> f64) -> (f64, f64) {
    let point = |i: usize| Point { x: line.x[i], y: line.y[i].value };
    let points = [point(at - 1), point(at), point(at + 1)];
    let value = read(vertex(points));
    let wider = if at >= 2 && at + 2 < line.x.len() {
        [point(at - 2), point(at), point(at + 2)]
    } else if at >= 2 {
        [point(at - 2), point(at), point(at + 1)]
    } else if at + 2 < line.x.len() {
        [point(at - 1), point(at), point(at + 2)]
    } else {
        points
    };
    let grid = (read(vertex(wider)) - value).abs();
    let shifts = (0..3).map(|i| {
        let mut moved = points;
        moved[i].y += line.y[at - 1 + i].run;
        let shift = read(vertex(moved)) - value;
        shift * shift
    });
    (value, libm::hypot(grid, shifts.sum::<f64>().sqrt()))
}

/// The width at 1/√2 of the height. √(1/y² − 1/height²) is a straight line in the frequency on either side; what a straight
/// line in y says instead is twice the uncertainty.
fn half_power_width(line: &Line, at: usize) -> Result<(f64, f64), Absence> {
    let (height, u_height) = with_errors(line, at, |top| top.y);
    if height <= 0.0 {
        return Err(Absence::Nowhere(format!("the peak of the {} is not above zero", column_words(&line.of))));
    }
    let level = height / std::f64::consts::SQRT_2;
    let side = |step: isize| -> Result<(f64, f64), Absence> {
        let mut inner = at;
        loop {
            let Some(outer) = inner.checked_add_signed(step).filter(|&i| i < line.x.len()) else {
                return Err(Absence::Nowhere(format!(
                    "the {} ends at {} = {} before it falls to half power",
                    column_words(&line.of),
                    symbol(&line.over),
                    with_unit(line.x[inner], 4, &line.over_unit)
                )));
            };
            if line.y[outer].value > height {
                return Err(Absence::Nowhere(format!(
                    "the {} rises above its peak at {} = {} before it falls to half power",
                    column_words(&line.of),
                    symbol(&line.over),
                    with_unit(line.x[outer], 4, &line.over_unit)
                )));
            }
            if line.y[outer].value < level {
                let (a, b) = (line.y[inner].value, line.y[outer].value);
                let away = |y: f64| (1.0 / (y * y) - 1.0 / (height * height)).max(0.0).sqrt();
                let width = line.x[outer] - line.x[inner];
                let straight = line.x[inner] + width * (a - level) / (a - b);
                let curved = if b > 0.0 {
                    line.x[inner] + width * (away(level) - away(a)) / (away(b) - away(a))
                } else {
                    straight
                };
                // The level itself is as uncertain as the height, and the line falls by a − b in `width`.
                let u_level = u_height / std::f64::consts::SQRT_2 * (width / (a - b)).abs();
                return Ok((curved, libm::hypot((curved - straight) / 2.0, u_level)));
            }
            inner = outer;
        }
    };
    let ((left, u_left), (right, u_right)) = (side(-1)?, side(1)?);
    Ok((right - left, libm::hypot(u_left, u_right)))
}

mapping! {
    "a peak" PrintedPeak, with_numbers {
        of: Column = required("The response", Column::read),
        over: Column = required("The frequency", Column::read),
        which: Option<Which> = optional("Which of its peaks; the one nearest to `at` if absent", Which::read),
        prominence: f64 =
            or("What counts as a peak: how far the response falls on both sides, as a fraction of the peak's own height", |at| at.fraction(), USUAL_PROMINENCE),
        at: Option<Printed> = optional("Where it is", Printed::read),
        height: Option<Printed> = optional("How high it is", Printed::read),
        half_power_width: Option<Printed> = optional("How wide it is at 1/√2 of its height", Printed::read),
    }
}

/// One printed number of a peak, and how it is read from the table.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct PeakNumber<'a> {
    pub published: &'a Printed,
    pub peak: Peak,
}

impl PrintedPeak {
    fn with_numbers(&self, at: At<'_>) -> Option<()> {
        if [&self.at, &self.height, &self.half_power_width].iter().all(|printed| printed.is_none()) {
            return at.wrong("a peak without a printed number: give `at`, `height` or `half_power_width`");
        }
        if self.which().is_none() {
            return at.wrong("a peak without `at` needs `which`: {nearest: 26 rad/s}, {number: 1} or highest");
        }
        Some(())
    }

    fn which(&self) -> Option<Which> {
        self.which.clone().or_else(|| self.at.clone().map(Which::Nearest))
    }

    /// Its printed numbers.
    pub(crate) fn numbers(&self) -> Vec<PeakNumber<'_>> {
        let printed = [
            (&self.at, Feature::Place),
            (&self.height, Feature::Height),
            (&self.half_power_width, Feature::HalfPowerWidth),
        ];
        printed
            .into_iter()
            .filter_map(|(published, read)| {
                let peak = Peak {
                    of: self.of.clone(),
                    over: self.over.clone(),
                    which: self.which()?,
                    prominence: self.prominence,
                    read,
                    rows: Selection::default(),
                    table: None,
                };
                Some(PeakNumber { published: published.as_ref()?, peak })
            })
            .collect()
    }
}
