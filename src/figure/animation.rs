//! An animation of runs: each enclosure and its particle as they move, beside their paths with a cursor, slowed down.
//!
//! The motion is CSS within the SVG: a part of the drawing follows keyframes of its path, the fewest from which the path departs
//! by less than a pixel. It stands still where the reader wants less motion, and in a picture of pixels.

use std::fmt::Write as _;

use super::attributes::{Attributes, Labelled};
use super::axis::{Axis, Extent, Room};
use super::canvas::{Anchor, Lettering, Pen, Sheet, UNITS, svg};
use super::error::FigureError;
use super::geometry::{Point, Rect, simplified};
use super::group::Group;
use super::label;
use super::source::Source;
use super::style::{
    BLUE_INK, CURVE, Color, FRAME, GREY, GRID, GUIDE, INK, LABEL_TEXT, LEGEND_TEXT, Look, PALE, SPACE, TICK_TEXT, WIDTH,
};
use crate::experiment::{AnimationSpec, AxisScale};
use crate::measure::column_of_damper;
use crate::table::Data;

/// Height of a row, and of what stands above and below its frames.
const ROW: f64 = 660.0;
const ABOVE: f64 = 124.0;
const BELOW: f64 = 126.0;
/// Left and right edges of the enclosure and of the paths.
const MODEL: [f64; 2] = [70.0, 430.0];
const PATHS: [f64; 2] = [620.0, 1400.0];
const PARTICLE: f64 = 26.0;
/// Between the enclosures of an array.
const BETWEEN: f64 = 18.0;
/// How long it plays at least, s.
const PLAYS: f64 = 8.0;
/// How far a keyframe's straight stretches may be from the path, in pixels.
const DEVIATION: f64 = 0.6;

/// What moves in one row of the table.
struct Run {
    title: String,
    time: Vec<f64>,
    dampers: Vec<Damper>,
}

/// An enclosure and its particle.
struct Damper {
    /// Where the floor would be without its spring.
    base: Vec<f64>,
    floor: Vec<f64>,
    ceiling: Vec<f64>,
    particle: Vec<f64>,
    /// Between the faces at rest; not finite without a ceiling.
    gap: f64,
    /// Of the particle: in an array each has its own.
    color: Color,
}

/// The SVG of the rows that the figure draws.
pub(super) fn animation(
    source: Source<'_>,
    spec: &AnimationSpec,
    impulses: Option<f64>,
) -> Result<String, FigureError> {
    let runs = runs(source, spec)?;
    let nothing = || FigureError::Nothing { figure: source.figure.to_owned() };
    let dampers = runs.iter().flat_map(|run| &run.dampers);
    let heights = dampers.flat_map(|it| [&it.base, &it.floor, &it.ceiling, &it.particle]).flatten().copied();
    let y = Axis::new(AxisScale::Linear, Extent::of(heights, AxisScale::Linear).ok_or_else(nothing)?, Room::Airy, "m");
    let mut style = String::new();
    let rows = f64::from(u32::try_from(runs.len()).unwrap_or(1));
    let mut place = Row { top: 0.0, y: &y, name: source.figure.to_owned(), impulses };
    let text = svg(WIDTH, rows * ROW, |sheet| {
        for (index, run) in runs.iter().enumerate() {
            place.name = format!("{}-{index}", source.figure);
            place.paint(sheet, run, &mut style);
            place.top += ROW;
        }
    });
    style += "@media(prefers-reduced-motion:reduce){[data-move]{animation:none!important}}\n";
    Ok(text.replacen(">\n", &format!(">\n{OPEN}{style}{CLOSE}"), 1))
}

const OPEN: &str = "<style>\n";
const CLOSE: &str = "</style>\n";

/// Without its motion.
pub(super) fn still(svg: &str) -> String {
    match (svg.split_once(OPEN), svg.split_once(CLOSE)) {
        (Some((before, _)), Some((_, after))) => format!("{before}{after}"),
        _ => svg.to_owned(),
    }
}

fn runs(source: Source<'_>, spec: &AnimationSpec) -> Result<Vec<Run>, FigureError> {
    let by = spec.by.iter().map(|name| source.column(name)).collect::<Result<Vec<_>, _>>()?;
    let groups = Group::split(source.table.rows(), &by);
    let mut runs = Vec::new();
    for group in &groups {
        for &row in &group.rows {
            let list = |name: &str| -> Result<Vec<f64>, FigureError> {
                let Data::FloatList(cells) = &source.column(name)?.data else { return Ok(Vec::new()) };
                Ok(cells.get(row).cloned().unwrap_or_default())
            };
            let moving = |name: &str, index: usize| list(&column_of_damper(name, index));
            let count = (1..).take_while(|index| moving("rigid_floor", *index).is_ok_and(|path| !path.is_empty()));
            let count = 1 + count.count();
            let damper = |index: usize| {
                let (base, rigid_ceiling) = (moving("rigid_floor", index)?, moving("rigid_ceiling", index)?);
                let gap = base.first().zip(rigid_ceiling.first()).map_or(f64::NAN, |(floor, ceiling)| ceiling - floor);
                Ok(Damper {
                    floor: moving("floor_displacement", index)?,
                    ceiling: moving("ceiling_displacement", index)?,
                    particle: moving("particle_displacement", index)?,
                    base,
                    gap,
                    color: particle_color(index),
                })
            };
            let run = Run {
                title: group.varying_words(&groups).join(", "),
                time: list("time")?,
                dampers: (0..count).map(damper).collect::<Result<_, FigureError>>()?,
            };
            if run.time.len() > 1 {
                runs.push(run);
            }
        }
    }
    if runs.is_empty() { Err(FigureError::Nothing { figure: source.figure.to_owned() }) } else { Ok(runs) }
}

/// A row of the drawing.
struct Row<'a> {
    top: f64,
    y: &'a Axis,
    /// Begins the names of its keyframes.
    name: String,
    impulses: Option<f64>,
}

impl Row<'_> {
    fn frame(&self, [left, right]: [f64; 2]) -> Rect {
        Rect { left, top: self.top + ABOVE, right, bottom: self.top + ROW - BELOW }
    }

    fn up(&self, height: f64) -> f64 {
        self.frame(PATHS).at(0.0, self.y.share_clamped(height)).y
    }

    fn paint(&self, sheet: &Sheet, run: &Run, style: &mut String) {
        let frame = self.frame(PATHS);
        let (first, last) = (run.time[0], run.time[run.time.len() - 1]);
        let x = Axis::new(AxisScale::Linear, Extent { least: first, largest: last }, Room::Tight, "s");
        let slow = (PLAYS / (last - first)).ceil().max(1.0);
        let clock = Clock { first, last, plays: slow * (last - first) };
        let slowed = if slow > 1.0 { format!("slowed down {slow} times") } else { "in real time".to_owned() };
        let title = if run.title.is_empty() { slowed } else { format!("{}, {slowed}", run.title) };
        write(sheet, Point { x: MODEL[0], y: self.top + LEGEND_TEXT }, &title, LEGEND_TEXT, Anchor::Left, INK);
        self.axes(sheet, &frame, &x);
        for at in self.impulses.into_iter().flat_map(|period| moments(period, first, last)) {
            let at = frame.at(x.share_clamped(at), 0.0);
            sheet.line(&[at, Point { y: frame.top, ..at }], Pen { color: GREY, width: GUIDE, dash: &[3.0, 7.0] });
        }
        let y_label = label::with_unit("displacement", &self.y.unit);
        let labels = [(&x, "Time (s)"), (self.y, y_label.as_str())].map(|(axis, label)| Labelled { axis, label });
        let mut at = Point { x: frame.left, y: self.top + ABOVE - SPACE - LEGEND_TEXT / 2.0 };
        sheet.group(&Attributes::frame(&frame, UNITS, labels[0], labels[1]), || {
            for (name, path, color) in run.paths() {
                let place = |(t, y): (&f64, &f64)| frame.at(x.share_clamped(*t), self.y.share_clamped(*y));
                let points: Vec<Point> = run.time.iter().zip(path).map(place).collect();
                sheet.group(&Attributes::name(&name), || sheet.line(&points, Pen::solid(color, 0.7 * CURVE)));
            }
        });
        for (name, color) in run.legend() {
            write(sheet, at, &name, LEGEND_TEXT, Anchor::Left, color);
            at.x += super::canvas::text_width(&name, LEGEND_TEXT) + 3.0 * SPACE;
        }
        let across = [(first, 0.0), (last, frame.width())];
        let cursor = Frames { axis: 'X', offsets: across.map(|(x, y)| Point { x, y }).to_vec() };
        self.moving(sheet, style, "cursor", &clock, &cursor, || {
            let ends = [frame.at(0.0, 0.0), frame.at(0.0, 1.0)];
            sheet.line(&ends, Pen::solid(INK, GUIDE));
        });
        self.models(sheet, run, &clock, style);
    }

    /// The enclosures side by side, their faces and particles, at the heights of their paths.
    fn models(&self, sheet: &Sheet, run: &Run, clock: &Clock, style: &mut String) {
        let count = f64::from(u32::try_from(run.dampers.len()).unwrap_or(1));
        let width = (MODEL[1] - MODEL[0] - BETWEEN * (count - 1.0)) / count;
        for (index, damper) in (0_u32..).zip(&run.dampers) {
            let left = MODEL[0] + f64::from(index) * (width + BETWEEN);
            let number = if run.dampers.len() > 1 { format!("-{}", index + 1) } else { String::new() };
            self.model(sheet, &Model { left, right: left + width, number, time: &run.time, damper }, clock, style);
        }
    }

    fn model(&self, sheet: &Sheet, model: &Model<'_>, clock: &Clock, style: &mut String) {
        let Model { left, right, ref number, time, damper } = *model;
        let follow = |path: &[f64]| {
            let from = self.up(path[0]);
            let offset = |(t, y): (&f64, &f64)| Point { x: *t, y: self.up(*y) - from };
            Frames { axis: 'Y', offsets: time.iter().zip(path).map(offset).collect() }
        };
        let closed = damper.gap.is_finite();
        let floor = self.up(damper.base[0]);
        let ceiling = if closed { self.up(damper.base[0] + damper.gap) } else { self.frame(PATHS).top };
        self.moving(sheet, style, &format!("base{number}"), clock, &follow(&damper.base), || {
            let wall = |x: f64| [Point { x, y: floor }, Point { x, y: ceiling }];
            for side in [wall(left), wall(right)] {
                sheet.line(&side, Pen::solid(GREY, 1.6 * CURVE));
            }
            for y in [Some(floor), closed.then_some(ceiling)].into_iter().flatten() {
                sheet.line(&[Point { x: left, y }, Point { x: right, y }], Pen::solid(GREY, 1.6 * CURVE));
            }
        });
        let inset = (right - left) / 12.0;
        let faces = [("floor", &damper.floor, floor_color()), ("ceiling", &damper.ceiling, ceiling_color())];
        for (name, path, color) in faces.into_iter().take(if closed { 2 } else { 1 }) {
            let y = self.up(path[0]);
            self.moving(sheet, style, &format!("{name}{number}"), clock, &follow(path), || {
                let ends = [Point { x: left + inset, y }, Point { x: right - inset, y }];
                sheet.line(&ends, Pen::solid(color, 1.6 * CURVE));
            });
        }
        let centre = Point { x: (left + right) / 2.0, y: self.up(damper.particle[0]) };
        self.moving(sheet, style, &format!("particle{number}"), clock, &follow(&damper.particle), || {
            sheet.disc(centre, PARTICLE.min((right - left) / 4.0), damper.color);
        });
        if !number.is_empty() {
            let at = Point { x: centre.x, y: self.frame(PATHS).bottom + SPACE + TICK_TEXT / 2.0 };
            write(sheet, at, number.trim_start_matches('-'), TICK_TEXT, Anchor::Centre, INK);
        }
    }

    fn axes(&self, sheet: &Sheet, frame: &Rect, x: &Axis) {
        for tick in self.y.ticks(5).iter().filter(|tick| !tick.label.is_empty()) {
            let at = frame.at(0.0, tick.at);
            sheet.line(&[at, frame.at(1.0, tick.at)], Pen::solid(PALE, GRID));
            write(sheet, Point { x: at.x - SPACE, ..at }, &tick.label, TICK_TEXT, Anchor::Right, INK);
        }
        for tick in x.ticks(6).iter().filter(|tick| !tick.label.is_empty()) {
            let at = frame.at(tick.at, 0.0);
            let at = Point { y: at.y + SPACE + TICK_TEXT / 2.0, ..at };
            write(sheet, at, &tick.label, TICK_TEXT, Anchor::Centre, INK);
        }
        let corners = frame.corners();
        sheet.line(&[corners[0], corners[1], corners[2], corners[3], corners[0]], Pen::solid(INK, FRAME));
        let below = Point { y: frame.bottom + 2.0 * SPACE + TICK_TEXT + LABEL_TEXT / 2.0, ..frame.at(0.5, 0.0) };
        write(sheet, below, "Time (s)", LABEL_TEXT, Anchor::Centre, INK);
        let at = Point { x: MODEL[1] + SPACE + LABEL_TEXT / 2.0, ..frame.at(0.0, 0.5) };
        let text = &label::with_unit("displacement", &self.y.unit);
        sheet.text(at, &Lettering { text, size: LABEL_TEXT, anchor: Anchor::Centre, upright: true, color: INK });
    }

    /// Paints a part that follows its keyframes.
    fn moving(
        &self,
        sheet: &Sheet,
        style: &mut String,
        part: &str,
        clock: &Clock,
        frames: &Frames,
        paint: impl FnOnce(),
    ) {
        let name = format!("{}-{part}", self.name);
        // Writing to a string cannot fail.
        _ = writeln!(style, "[data-move=\"{name}\"]{{animation:{name} {:.2}s linear infinite}}", clock.plays);
        _ = writeln!(style, "@keyframes {name}{{{}}}", frames.css(clock));
        sheet.group(&Attributes::default().with("move", &name), paint);
    }
}

/// Where an enclosure is drawn.
struct Model<'a> {
    left: f64,
    right: f64,
    /// Ends the names of its parts, in an array.
    number: String,
    time: &'a [f64],
    damper: &'a Damper,
}

impl Run {
    /// The paths to draw, with their names.
    fn paths(&self) -> Vec<(String, &[f64], Color)> {
        let numbered = |name: &str, index: usize| match self.dampers.len() {
            1 => name.to_owned(),
            _ => format!("{name} {}", index + 1),
        };
        let mut paths = Vec::new();
        for (index, damper) in self.dampers.iter().enumerate() {
            paths.push((numbered("floor", index), damper.floor.as_slice(), floor_color()));
            if damper.gap.is_finite() {
                paths.push((numbered("ceiling", index), &damper.ceiling, ceiling_color()));
            }
            paths.push((numbered("particle", index), &damper.particle, damper.color));
        }
        paths
    }

    /// Names of what has a colour.
    fn legend(&self) -> Vec<(String, Color)> {
        if let [_] = self.dampers.as_slice() {
            return self.paths().into_iter().map(|(name, _, color)| (name, color)).collect();
        }
        let closed = self.dampers.iter().any(|damper| damper.gap.is_finite());
        let faces = [("floors", floor_color()), ("ceilings", ceiling_color())];
        let faces = faces.into_iter().take(if closed { 2 } else { 1 }).map(|(name, color)| (name.to_owned(), color));
        let number = |index: usize| if index == 0 { "particle 1".to_owned() } else { (index + 1).to_string() };
        let particles = self.dampers.iter().enumerate();
        faces.chain(particles.map(|(index, damper)| (number(index), damper.color))).collect()
    }
}

/// From the times of a run to the shares of its playing time.
struct Clock {
    first: f64,
    last: f64,
    /// s.
    plays: f64,
}

/// How far a part is from where it is drawn, over time.
struct Frames {
    axis: char,
    /// Time in s, offset in pixels.
    offsets: Vec<Point>,
}

impl Frames {
    fn css(&self, clock: &Clock) -> String {
        let share = |time: f64| (time - clock.first) / (clock.last - clock.first);
        // Time as long as the paths are wide, so that steep and flat stretches count alike.
        let wide = PATHS[1] - PATHS[0];
        let points: Vec<Point> = self.offsets.iter().map(|at| Point { x: wide * share(at.x), y: at.y }).collect();
        let frame = |at: &Point| {
            format!("{:.2}%{{transform:translate{}({:.0}px)}}", 100.0 * at.x / wide, self.axis, at.y * UNITS)
        };
        simplified(&points, DEVIATION).iter().map(frame).collect()
    }
}

/// The moments of impulses of this period within a stretch of time.
fn moments(period: f64, first: f64, last: f64) -> impl Iterator<Item = f64> {
    let start = (first / period).ceil();
    (0..64_u8).map(move |n| (start + f64::from(n)) * period).take_while(move |at| *at <= last)
}

/// Colours of the particles of an array, none of them that of a face.
const PARTICLES: [usize; 5] = [1, 3, 4, 5, 6];

fn particle_color(index: usize) -> Color {
    Look::new(PARTICLES[index % PARTICLES.len()], 1, 0).color
}

fn floor_color() -> Color {
    Look::of_path("floor_displacement").map_or(BLUE_INK, |look| look.color)
}

fn ceiling_color() -> Color {
    Look::of_path("ceiling_displacement").map_or(BLUE_INK, |look| look.color)
}

fn write(sheet: &Sheet, at: Point, text: &str, size: f64, anchor: Anchor, color: Color) {
    sheet.text(at, &Lettering { text, size, anchor, upright: false, color });
}
