//! The gaps of an array as bars, one group a damper: the candidates that the experiment names beside the best that was found.

use super::attributes::Attributes;
use super::axis::{Axis, Extent, Room};
use super::canvas::{Anchor, Lettering, Pen, Sheet, svg, text_width};
use super::error::FigureError;
use super::geometry::{Point, Rect};
use super::label;
use super::source::Source;
use super::style::{
    BLUE_INK, Color, FRAME, GREY, GRID, INK, LABEL_TEXT, LEGEND_ROW, LEGEND_TEXT, PALE, SPACE, TICK, TICK_TEXT, WIDTH,
};
use crate::experiment::{AxisScale, Goal, Optimise};
use crate::table::Data;
use crate::text::number::compact;
use crate::text::words;

/// Without the legend.
const HEIGHT: f64 = 590.0;
/// From a sign of the legend to its text.
const ASIDE: f64 = 54.0;
/// Share of a group that its bars take.
const FILLED: f64 = 0.7;
const MOST_TICKS: u32 = 6;
/// Bars of named candidates, in the order of the table.
const NAMED: [Color; 3] = [INK, GREY, Color(0xB0, 0xB0, 0xB0)];

/// Bars of one colour.
struct Series {
    name: String,
    gaps: Vec<f64>,
    color: Color,
}

/// The SVG of the gaps of this search.
pub(super) fn bars(source: Source<'_>, optimise: &Optimise) -> Result<String, FigureError> {
    let series = series(source, optimise)?;
    let nothing = || FigureError::Nothing { figure: source.figure.to_owned() };
    let word = words::of_key(&optimise.gaps);
    let unit = source.column(&format!("{word}_1"))?.unit.clone();
    let bounds = optimise.bounds.iter().flat_map(|[low, high]| [*low, *high]);
    let all = series.iter().flat_map(|one| one.gaps.iter().copied()).chain(bounds);
    let y = Axis::new(AxisScale::Log, Extent::of(all, AxisScale::Log).ok_or_else(nothing)?, Room::Airy, &unit);
    let y_label = label::with_unit("gap clearance", &y.unit);
    let numbers = y.ticks(MOST_TICKS).iter().map(|tick| text_width(&tick.label, TICK_TEXT)).fold(0.0, f64::max);
    let left = numbers + LABEL_TEXT + 4.0 * SPACE;
    let signs = signs(&series, left);
    let top = signs.last().map_or(0.0, |sign| sign.y + LEGEND_ROW / 2.0) + SPACE;
    let frame = Rect { left, top, right: WIDTH - 2.0 * SPACE, bottom: top + HEIGHT - TICK_TEXT - 4.0 * SPACE };
    Ok(svg(WIDTH, top + HEIGHT, |sheet| {
        paint(sheet, &series, &frame, &y, &y_label);
        for (one, at) in series.iter().zip(signs) {
            sheet.cell(&Rect { left: at.x, top: at.y - 14.0, right: at.x + 40.0, bottom: at.y + 14.0 }, one.color);
            write(sheet, Point { x: at.x + ASIDE, ..at }, &one.name, LEGEND_TEXT, Anchor::Left, false);
        }
    }))
}

/// The named candidates, uniform gaps only where there are no others, and the best of the searches.
fn series(source: Source<'_>, optimise: &Optimise) -> Result<Vec<Series>, FigureError> {
    let word = words::of_key(&optimise.gaps);
    let columns = (1..=optimise.bounds.len())
        .map(|gap| source.column(&format!("{word}_{gap}")))
        .collect::<Result<Vec<_>, _>>()?;
    let candidates = source.column("candidate")?;
    let Data::Text(names) = &candidates.data else {
        return Err(FigureError::Nothing { figure: source.figure.to_owned() });
    };
    let value = source.column(&words::of_key(&optimise.measure))?;
    let gaps =
        |row: usize| columns.iter().map(|column| column.data.number(row).unwrap_or(f64::NAN)).collect::<Vec<f64>>();
    let own = |name: &str| optimise.candidates.iter().any(|candidate| candidate.name == name);
    // What starts from one is a search beside it, not one from nothing.
    let from_own = |name: &str| name.strip_suffix("_two_opt").is_some_and(own);
    let differ = |row: &usize| gaps(*row).windows(2).any(|pair| pair[0] != pair[1]);
    let mut series: Vec<Series> = Vec::new();
    let named = || names.iter().enumerate().filter(|(_, name)| own(name));
    let uniform = named().all(|(row, _)| !differ(&row));
    for (row, name) in named().filter(|(row, _)| uniform || differ(row)) {
        let color = NAMED[series.len().min(NAMED.len() - 1)];
        series.push(Series { name: words::of_level("candidate", name), gaps: gaps(row), color });
    }
    let sign = if optimise.goal == Goal::Minimise { 1.0 } else { -1.0 };
    let searched = |row: &usize| !names[*row].is_empty() && !own(&names[*row]) && !from_own(&names[*row]);
    let fitness =
        |row: &usize| value.data.number(*row).filter(|fitness| fitness.is_finite()).map(|fitness| sign * fitness);
    let best = (0..names.len())
        .filter(searched)
        .filter_map(|row| Some((row, fitness(&row)?)))
        .min_by(|a, b| a.1.total_cmp(&b.1));
    if let Some((row, _)) = best {
        let name = format!("best found here ({})", words::of_level("candidate", &names[row]));
        series.push(Series { name, gaps: gaps(row), color: BLUE_INK });
    }
    Ok(series)
}

/// Where the signs of the legend are, row by row.
fn signs(series: &[Series], left: f64) -> Vec<Point> {
    let mut at = Point { x: left, y: SPACE + LEGEND_ROW / 2.0 };
    let place = |one: &Series| {
        let width = ASIDE + text_width(&one.name, LEGEND_TEXT);
        if at.x > left && at.x + width > WIDTH - SPACE {
            at = Point { x: left, y: at.y + LEGEND_ROW };
        }
        let here = at;
        at.x += width + 3.0 * SPACE;
        here
    };
    series.iter().map(place).collect()
}

fn write(sheet: &Sheet, at: Point, text: &str, size: f64, anchor: Anchor, upright: bool) {
    sheet.text(at, &Lettering { text, size, anchor, upright, color: INK });
}

fn paint(sheet: &Sheet, series: &[Series], frame: &Rect, y: &Axis, y_label: &str) {
    let ticks = y.ticks(MOST_TICKS);
    for tick in ticks.iter().filter(|tick| !tick.label.is_empty()) {
        sheet.line(&[frame.at(0.0, tick.at), frame.at(1.0, tick.at)], Pen::solid(PALE, GRID));
        let at = frame.at(0.0, tick.at);
        sheet.line(&[at, Point { x: at.x + TICK, ..at }], Pen::solid(INK, FRAME));
        write(sheet, Point { x: at.x - SPACE, ..at }, &tick.label, TICK_TEXT, Anchor::Right, false);
    }
    let count = |n: usize| u32::try_from(n).map_or(1.0, f64::from).max(1.0);
    let gaps = series.iter().map(|one| one.gaps.len()).max().unwrap_or(0);
    let group = 1.0 / count(gaps);
    let bar = FILLED * group / count(series.len());
    for gap in 0..gaps {
        let start = (f64::from(u32::try_from(gap).unwrap_or(0)) + (1.0 - FILLED) / 2.0) * group;
        for (index, one) in (0_u32..).zip(series) {
            let Some(share) = one.gaps.get(gap).and_then(|gap| y.share(*gap)) else { continue };
            let from = start + f64::from(index) * bar;
            let (low, high) = (frame.at(from + 0.06 * bar, 0.0), frame.at(from + 0.94 * bar, share.clamp(0.0, 1.0)));
            let note = format!("{}, gap {}: {} {}", one.name, gap + 1, compact(y.displayed(one.gaps[gap]), 4), y.unit);
            sheet.group(&Attributes::note(note.trim_end()), || {
                sheet.cell(&Rect { left: low.x, top: high.y, right: high.x, bottom: low.y }, one.color);
            });
        }
        let middle = frame.at(start + 0.5 * FILLED * group, 0.0);
        let at = Point { y: middle.y + SPACE + TICK_TEXT / 2.0, ..middle };
        write(sheet, at, &format!("gap {}", gap + 1), TICK_TEXT, Anchor::Centre, false);
    }
    let corners = frame.corners();
    sheet.line(&[corners[0], corners[1], corners[2], corners[3], corners[0], corners[1]], Pen::solid(INK, FRAME));
    write(
        sheet,
        Point { x: SPACE + LABEL_TEXT / 2.0, y: frame.at(0.0, 0.5).y },
        y_label,
        LABEL_TEXT,
        Anchor::Centre,
        true,
    );
}
