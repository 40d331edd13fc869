//! A panel: curves and axes made ready, before its place on the sheet is known.

use crate::experiment;

use super::axis::{Axis, Extent, Room, Tick};
use super::canvas::text_width;
use super::error::FigureError;
use super::geometry::{Point, Rect};
use super::label;
use super::layout::Needs;
use super::legend::{Legend, Obstacles};
use super::line::{Curve, Sample, Source, curves};
use super::render::QuotedPoint;
use super::style::{QUOTED, SPACE, TICK_TEXT};

/// How many numbers an axis carries at most.
const MOST_X_TICKS: u32 = 8;
const MOST_Y_TICKS: u32 = 6;
/// The smallest spread that shows as a band, as a share of the axis: about the width of a curve.
const VISIBLE_SPREAD: f64 = 0.004;

/// Room for the numbers at peaks, as a share of the axis.
const PEAK_ROOM: f64 = 0.07;

/// One pair of axes with its curves.
pub(super) struct Panel<'a> {
    pub spec: &'a experiment::Panel,
    pub curves: Vec<Curve>,
    pub x: Axis,
    pub y: Axis,
    pub x_label: String,
    pub y_label: String,
    pub quoted: Vec<&'a QuotedPoint>,
    pub legend: Legend,
}

impl<'a> Panel<'a> {
    pub(super) fn new(
        source: Source<'_>,
        spec: &'a experiment::Panel,
        quoted: &'a [QuotedPoint],
    ) -> Result<Self, FigureError> {
        let curves = curves(source, spec)?;
        let quoted: Vec<&QuotedPoint> =
            quoted.iter().filter(|point| spec.y.iter().any(|axis| axis.column == point.column)).collect();
        let nothing = || FigureError::Nothing { figure: source.figure.to_owned() };

        let x_column = source.column(&spec.x.column)?;
        let samples = || curves.iter().flat_map(|curve| &curve.samples);
        let seen = samples().filter(|sample| sample.y.is_finite()).map(|sample| sample.x);
        let wanted = quoted.iter().map(|point| point.x).chain(spec.x.reach.into_iter().flatten());
        let x_extent = Extent::of(seen.chain(wanted), spec.x.scale).ok_or_else(nothing)?;
        let x_room = if spec.markers || !quoted.is_empty() { Room::Airy } else { Room::Tight };
        let x = Axis::new(spec.x.scale, x_extent, x_room, &x_column.unit);

        let unit = match spec.y.first() {
            Some(axis) => source.column(&axis.column)?.unit.clone(),
            None => return Err(nothing()),
        };
        let scale = spec.y[0].scale;
        let ends = samples().flat_map(|sample| [sample.y, sample.y - sample.spread, sample.y + sample.spread]);
        let limits = curves.iter().filter_map(|curve| curve.at_infinity.as_ref()).map(|limit| limit.y);

        let marks = quoted.iter().map(|point| point.y).chain(spec.y[0].reach.into_iter().flatten());
        let mut y_extent = Extent::of(ends.chain(limits).chain(marks), scale).ok_or_else(nothing)?;
        for guide in &spec.guides {
            y_extent = y_extent.with_guide(guide.at, scale);
        }
        if spec.peaks.is_some() {
            y_extent = y_extent.with_headroom(PEAK_ROOM, scale);
        }
        let y = Axis::new(scale, y_extent, Room::Airy, &unit);

        let x_name = source.label(&spec.x)?;
        let y_names = spec.y.iter().map(|axis| source.label(axis)).collect::<Result<Vec<_>, _>>()?;
        // A spread that nobody can see needs no word in the legend.
        let visible = VISIBLE_SPREAD * (y_extent.largest - y_extent.least);
        let band = samples().any(|sample| sample.spread > visible);
        let quoted_labels: Vec<&str> = quoted.iter().map(|point| point.label.as_str()).collect();
        Ok(Self {
            spec,
            x_label: label::with_unit(&x_name, &x.unit),
            y_label: label::with_unit(&label::shared(&y_names, &unit), &y.unit),
            legend: Legend::new(&curves, spec.markers, band, &quoted_labels),
            curves,
            x,
            y,
            quoted,
        })
    }

    pub(super) fn x_ticks(&self) -> Vec<Tick> {
        self.x.ticks(MOST_X_TICKS)
    }

    pub(super) fn y_ticks(&self) -> Vec<Tick> {
        self.y.ticks(MOST_Y_TICKS)
    }

    /// What the panel needs around its frame, with `above` for a legend there.
    pub(super) fn needs(&self, above: f64, x_labels: bool) -> Needs {
        let width = |tick: &Tick| text_width(&tick.label, TICK_TEXT);
        // A number at the right end of the axis hangs over by half its width.
        let beyond =
            self.x_ticks().iter().filter(|tick| tick.at > 0.95).map(|tick| width(tick) / 2.0).fold(0.0, f64::max);
        let y_numbers = self.y_ticks().iter().map(width).fold(0.0, f64::max);
        Needs { above, y_numbers, y_label: self.y_label.clone(), x_labels, beyond }
    }

    /// Where a sample lies; `None` for a gap.
    pub(super) fn place(&self, frame: &Rect, x: f64, y: f64) -> Option<Point> {
        Some(frame.at(self.x.share(x)?, self.y.share(y)?))
    }

    /// A curve's unbroken stretches.
    pub(super) fn stretches(&self, frame: &Rect, curve: &Curve) -> Vec<Vec<Point>> {
        curve
            .samples
            .split(|sample| self.place(frame, sample.x, sample.y).is_none())
            .filter(|stretch| !stretch.is_empty())
            .map(|stretch| stretch.iter().filter_map(|sample| self.place(frame, sample.x, sample.y)).collect())
            .collect()
    }

    /// The outlines of a curve's band: along its upper edge and back along the lower one.
    pub(super) fn bands(&self, frame: &Rect, curve: &Curve) -> Vec<Vec<Point>> {
        let edge = |sample: &Sample, sign: f64| {
            let up = self.y.share_clamped(sample.y + sign * sample.spread);
            Some(frame.at(self.x.share(sample.x)?, up))
        };
        curve
            .samples
            .split(|sample| self.place(frame, sample.x, sample.y).is_none())
            .filter(|stretch| stretch.len() > 1 && stretch.iter().any(|sample| sample.spread > 0.0))
            .map(|stretch| {
                let upper = stretch.iter().filter_map(|sample| edge(sample, 1.0));
                let lower = stretch.iter().rev().filter_map(|sample| edge(sample, -1.0));
                upper.chain(lower).collect()
            })
            .collect()
    }

    /// A horizontal line through the frame.
    pub(super) fn level(&self, frame: &Rect, y: f64) -> Option<[Point; 2]> {
        let up = self.y.share(y)?;
        Some([frame.at(0.0, up), frame.at(1.0, up)])
    }

    /// All that a legend or the label of a guide must not cover.
    pub(super) fn obstacles(&self, frame: &Rect) -> Obstacles {
        let mut obstacles = Obstacles::default();
        for curve in &self.curves {
            obstacles.lines.extend(self.stretches(frame, curve));
            obstacles.lines.extend(self.bands(frame, curve));
            if let Some(limit) = &curve.at_infinity {
                obstacles.lines.extend(self.level(frame, limit.y).map(Vec::from));
            }
        }
        for guide in &self.spec.guides {
            obstacles.lines.extend(self.level(frame, guide.at).map(Vec::from));
        }
        for point in &self.quoted {
            let at = frame.at(self.x.share_clamped(point.x), self.y.share_clamped(point.y));
            let spot = Rect { left: at.x, top: at.y, right: at.x, bottom: at.y };
            obstacles.boxes.push(spot.grown(QUOTED + SPACE));
            // Where only one coordinate is quoted, a line stands for the other.
            if point.y.is_nan() {
                obstacles.lines.push(vec![Point { y: frame.top, ..at }, Point { y: frame.bottom, ..at }]);
            }
            if point.x.is_nan() {
                obstacles.lines.push(vec![Point { x: frame.left, ..at }, Point { x: frame.right, ..at }]);
            }
        }
        obstacles
    }
}
