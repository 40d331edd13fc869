//! A panel: curves and axes made ready, before its place on the sheet is known.

use std::collections::BTreeSet;

use crate::experiment::{self, AxisScale, Band};
use crate::table::Data;

use super::axis::{Axis, Extent, Room, Tick};
use super::beside::Beside;
use super::branch::{Sign, SpecialPoint, signs, special_points};
use super::canvas::text_width;
use super::contact::{Contact, contacts};
use super::error::FigureError;
use super::geometry::{Point, Rect};
use super::label;
use super::layout::Needs;
use super::legend::Legend;
use super::line::{Curve, Join, curves};
use super::peak::{PeakMark, peaks};
use super::quoted::Quoted;
use super::sample::Sample;
use super::source::Source;
use super::strip::{self, Strip};
use super::style::{CURVE, MARKER, TICK_TEXT};

/// How many numbers an axis carries at most.
const MOST_X_TICKS: u32 = 8;
const MOST_Y_TICKS: u32 = 6;
/// The smallest spread that shows as a band, as a share of the axis: about the width of a curve.
const VISIBLE_SPREAD: f64 = 0.004;

/// The shortest contact that shows as a bar, as a share of the axis.
const VISIBLE_CONTACT: f64 = 0.002;

/// How many times as far the y axis may reach so that a bar of tolerance is not cut off.
const BAR_STRETCH: f64 = 1.2;

/// Room for the numbers at peaks, as a share of the axis.
const PEAK_ROOM: f64 = 0.07;

/// How far an axis has to reach.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Reach {
    extent: Extent,
    room: Room,
}

impl Reach {
    /// As far as both.
    pub(super) fn union(self, other: Self) -> Self {
        let room = if self.room == Room::Airy { self.room } else { other.room };
        Self { extent: self.extent.union(other.extent), room }
    }

    fn axis(self, spec: &experiment::Axis, unit: &str) -> Axis {
        Axis::new(spec.scale, self.extent, self.room, unit).in_unit(spec.unit.as_ref())
    }
}

/// Curves that agree to the width of a line: all but the last are drawn wide enough to be seen beneath it.
fn widen_hidden(curves: &mut [Curve], y: &Axis) {
    for index in 0..curves.len() {
        let (here, above) = curves.split_at(index + 1);
        let Some(curve) = here.last().filter(|curve| curve.join == Join::Line) else { continue };
        let hidden = above.iter().any(|other| agrees(&curve.samples, &other.samples, y));
        if hidden && curve.look.width < 1.7 * CURVE {
            curves[index].look.width *= 1.7;
        }
    }
}

/// Whether two curves over the same places lie on each other for the greater part.
fn agrees(one: &[Sample], other: &[Sample], y: &Axis) -> bool {
    const LINE: f64 = 0.006;
    let close = |(a, b): &(&Sample, &Sample)| {
        let apart = y.share(a.y).zip(y.share(b.y)).map(|(a, b)| (a - b).abs());
        a.x.total_cmp(&b.x).is_eq() && apart.is_some_and(|apart| apart < LINE)
    };
    one.len() == other.len() && 2 * one.iter().zip(other).filter(close).count() > one.len()
}

/// Whether a panel draws a part of what another one draws.
fn is_part_of(part: &experiment::Panel, whole: &experiment::Panel) -> bool {
    let draws = |column: &str| part.y.iter().any(|axis| axis.column == column);
    part.x.column == whole.x.column && whole.y.iter().any(|axis| draws(&axis.column))
}

/// What curves take of the y axis, with the marks that it is to reach.
fn y_extent(curves: &[Curve], axis: &experiment::Axis) -> Option<Extent> {
    let samples = curves.iter().flat_map(|curve| &curve.samples);
    let ends = samples.flat_map(|sample| [sample.y, sample.band[0], sample.band[1]]);
    let limits = curves.iter().filter_map(|curve| curve.at_infinity.as_ref()).map(|limit| limit.y);
    Extent::of(ends.chain(limits).chain(axis.reach.into_iter().flatten()), axis.scale)
}

/// How far curves and quoted numbers need the x axis, unless the panel says it; with some room where marks stand at its ends.
fn x_reach(spec: &experiment::Panel, curves: &[Curve], quoted: &[&Quoted], is_marked: bool) -> Option<Reach> {
    if let Some([least, largest]) = spec.x.range {
        return Some(Reach { extent: Extent { least, largest }, room: Room::Tight });
    }
    let samples = curves.iter().flat_map(|curve| &curve.samples);
    let seen = samples.filter(|sample| sample.y.is_finite()).map(|sample| sample.x);
    let wanted = quoted.iter().filter_map(|one| one.x()).chain(spec.x.reach.into_iter().flatten());
    let is_marked = is_marked || spec.markers || spec.band == Band::Seeds || quoted.iter().any(|one| one.is_point());
    let room = if is_marked { Room::Airy } else { Room::Tight };
    Some(Reach { extent: Extent::of(seen.chain(wanted), spec.x.scale)?, room })
}

/// The extent of curves with what is drawn beside them: quoted numbers, guides, numbers at peaks.
fn with_what_is_beside(
    curves: Extent,
    spec: &experiment::Panel,
    scale: AxisScale,
    quoted: &[&Quoted],
    names_guides: bool,
) -> Extent {
    let mut whole = quoted.iter().filter_map(|one| one.y()).fold(curves, |extent, y| extent.with(y, scale));
    for guide in &spec.guides {
        // Named in the legend, a guide needs no room of its own.
        whole = if names_guides && !guide.label.is_empty() {
            whole.with(guide.at, scale)
        } else {
            whole.with_guide(guide.at, scale)
        };
    }
    if spec.peaks.is_some() {
        whole = whole.with_headroom(PEAK_ROOM, scale);
    }
    // A bar that needs little room is shown to its ends.
    quoted.iter().flat_map(|one| one.ends_in_y()).fold(whole, |extent, end| {
        let longer = extent.with(end, scale);
        if longer.span(scale) <= BAR_STRETCH * extent.span(scale) { longer } else { extent }
    })
}

/// What the y axis is called.
fn y_name(source: Source<'_>, spec: &experiment::Panel, curves: &[Curve], unit: &str) -> Result<String, FigureError> {
    let mut names = spec.y.iter().map(|axis| source.label(axis)).collect::<Result<Vec<_>, _>>()?;
    let mut columns: Vec<&str> = spec.y.iter().map(|axis| axis.column.as_str()).collect();
    if let (true, Some(first)) = (spec.over_first, curves.first()) {
        columns.clear();
        names.iter_mut().for_each(|name| *name = format!("{name} over that of {}", first.name.full()));
    }
    Ok(label::shared(&names, &columns, unit))
}

/// One pair of axes with its curves.
pub(super) struct Panel<'a> {
    pub spec: &'a experiment::Panel,
    pub curves: Vec<Curve>,
    x_reach: Reach,
    x_unit: String,
    pub x: Axis,
    pub y: Axis,
    pub x_label: String,
    pub y_label: String,
    pub quoted: Vec<&'a Quoted>,
    /// Parts of the x axis that other panels of the figure draw alone.
    pub closer: Vec<[f64; 2]>,
    pub contacts: Vec<Contact>,
    /// Period of the impulses, s, where the panel shows their moments.
    pub impulses: Option<f64>,
    pub strips: Vec<Strip>,
    pub special_points: Vec<SpecialPoint>,
    pub legend: Legend,
}

impl<'a> Panel<'a> {
    pub(super) fn new(
        source: Source<'_>,
        spec: &'a experiment::Panel,
        beside: Beside<'a>,
    ) -> Result<Self, FigureError> {
        let mut curves = curves(source, spec)?;
        if let Some(range) = spec.x.range {
            curves.iter_mut().for_each(|curve| curve.cut_to(range));
            curves.retain(Curve::shows);
        }
        let nothing = || FigureError::Nothing { figure: source.figure.to_owned() };
        let first = spec.y.first().ok_or_else(nothing)?;
        let (x_unit, y_unit) = (&source.column(&spec.x.column)?.unit, &source.column(&first.column)?.unit);
        let of_curves = y_extent(&curves, first).ok_or_else(nothing)?;
        let room = |one: &&Quoted| one.fits(spec) && one.leaves_room(of_curves, first.scale);
        let quoted: Vec<&Quoted> = beside.quoted.iter().filter(room).collect();
        let closer = source.panels.iter().filter(|other| spec.x.range.is_none() && is_part_of(other, spec));
        let closer = closer.filter_map(|other| other.x.range).collect();
        let mut special_points = special_points(source, spec)?;
        special_points.retain(|point| spec.x.shows(point.x));
        // Of a cloud no point lies half beyond the frame.
        let is_cloud = matches!(source.column(&spec.x.column)?.data, Data::FloatList(_))
            && curves.iter().any(|curve| curve.join == Join::Dots);
        let is_marked = is_cloud || !special_points.is_empty();
        let x_reach = x_reach(spec, &curves, &quoted, is_marked).ok_or_else(nothing)?;
        let x = x_reach.axis(&spec.x, x_unit);

        // A spread that nobody can see needs no word in the legend.
        let visible = VISIBLE_SPREAD * (of_curves.largest - of_curves.least);
        let mut samples = curves.iter().flat_map(|curve| &curve.samples);
        let band = samples.any(|sample| sample.band[1] - sample.band[0] > 2.0 * visible);
        let mut legend = Legend::new(&curves, spec, band, &quoted);
        let mut contacts = contacts(source, spec)?;
        contacts.retain(|contact| spec.x.shows(contact.from) || spec.x.shows(contact.to));
        let impulses = beside.impulses.filter(|_| !contacts.is_empty());
        let visible = VISIBLE_CONTACT * (x_reach.extent.largest - x_reach.extent.least);
        legend.name_instants(contacts.iter().any(|contact| contact.to - contact.from > visible), impulses.is_some());
        let strips = strip::strips(source, spec, &curves)?;
        legend.name_special_points(&special_points);
        let names_guides = !legend.is_empty();
        let whole = with_what_is_beside(of_curves, spec, first.scale, &quoted, names_guides);
        if names_guides {
            legend.name_guides(&spec.guides);
        }
        // Theirs is a scale of its own, apart from the lines.
        legend.name_motions(&strip::classes(&strips, &spec.x));
        let y = Axis::new(first.scale, whole, Room::Airy, y_unit).in_unit(first.unit.as_ref());
        widen_hidden(&mut curves, &y);
        Ok(Self {
            spec,
            x_label: label::with_unit(&source.label(&spec.x)?, &x.unit),
            y_label: label::with_unit(&y_name(source, spec, &curves, y_unit)?, &y.unit),
            legend,
            curves,
            x_reach,
            x_unit: x_unit.clone(),
            x,
            y,
            quoted,
            closer,
            contacts,
            impulses,
            strips,
            special_points,
        })
    }

    /// How far the x axis has to reach, if it is this column's and shows all of it.
    pub(super) fn x_reach(&self, column: &str) -> Option<Reach> {
        (self.spec.x.column == column && self.spec.x.range.is_none()).then_some(self.x_reach)
    }

    /// Panels above each other share the limits of their axis.
    pub(super) fn reach_in_x(&mut self, reach: Reach) {
        self.x = reach.axis(&self.spec.x, &self.x_unit);
    }

    /// Whether another panel of the figure shows this place closer, and has the labels of what stands there.
    pub(super) fn is_shown_closer(&self, x: f64) -> bool {
        self.closer.iter().any(|[from, to]| x >= *from && x <= *to)
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
        Needs { above, y_numbers, y_label: self.y_label.clone(), x_labels, strips: strip::height(&self.strips), beyond }
    }

    /// Where a sample lies; `None` for a gap.
    pub(super) fn place(&self, frame: &Rect, x: f64, y: f64) -> Option<Point> {
        Some(frame.at(self.x.share(x)?, self.y.share(y)?))
    }

    /// The signs of the special points.
    pub(super) fn signs(&self, frame: &Rect) -> Vec<Sign> {
        if self.special_points.is_empty() {
            return Vec::new();
        }
        let points = self.special_points.iter();
        let points = points.filter_map(|point| Some((self.place(frame, point.x, point.y)?, point.kind)));
        let stretches = self.curves.iter().flat_map(|curve| self.stretches(frame, curve));
        let alone: Vec<Point> = stretches.filter(|stretch| stretch.len() == 1).flatten().collect();
        signs(points, &alone, frame)
    }

    /// The marks on the peaks of the curves, curve by curve.
    pub(super) fn peak_marks(&self, frame: &Rect) -> Vec<PeakMark> {
        let Some(marks) = self.spec.peaks else { return Vec::new() };
        let of_curve = |curve: &Curve| {
            let mark = |sample: Sample| {
                let top = self.place(frame, sample.x, sample.y)?;
                Some(PeakMark { at: Point { y: top.y - 1.4 * MARKER, ..top }, x: sample.x, look: curve.look })
            };
            peaks(curve, &self.y, marks).into_iter().filter_map(mark).collect::<Vec<_>>()
        };
        self.curves.iter().flat_map(of_curve).collect()
    }

    /// A curve's dots, those that fall on one place once.
    pub(super) fn dots(&self, frame: &Rect, curve: &Curve) -> Vec<Point> {
        let mut seen = BTreeSet::new();
        let placed = curve.samples.iter().filter_map(|sample| self.place(frame, sample.x, sample.y));
        #[expect(clippy::cast_possible_truncation, reason = "a sheet is some thousand pixels wide")]
        placed.filter(|at| seen.insert([at.x, at.y].map(|place| (2.0 * place).round() as i32))).collect()
    }

    /// A curve's unbroken stretches.
    pub(super) fn stretches(&self, frame: &Rect, curve: &Curve) -> Vec<Vec<Point>> {
        if curve.join == Join::Dots {
            return self.dots(frame, curve).into_iter().map(|dot| vec![dot]).collect();
        }
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
            let up = self.y.share_clamped(sample.band[usize::from(sign > 0.0)]);
            Some(frame.at(self.x.share(sample.x)?, up))
        };
        curve
            .samples
            .split(|sample| self.place(frame, sample.x, sample.y).is_none())
            .filter(|stretch| stretch.len() > 1 && stretch.iter().any(|sample| sample.band[1] > sample.band[0]))
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
}
