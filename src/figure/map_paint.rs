//! A map put on the sheet: colours, contours, frames and numbers, marks, headings, colour bar.

use super::attributes::{Attributes, Labelled};
use super::axis::Tick;
use super::canvas::{Anchor, Lettering, Pen, Sheet, UNITS, text_width};
use super::contour::{Node, contours};
use super::field::{Field, cell_edges, shares};
use super::geometry::{Point, Rect};
use super::layout::line_height;
use super::map::{Map, MapPanel};
use super::map_layout::{MapLayout, sign_width};
use super::style::{
    CONTOUR, CURVE, Color, FRAME, GREY, INK, LABEL_TEXT, LEGEND_ROW, LEGEND_TEXT, MAP_SIGN, MINOR_TICK, NOTE_TEXT,
    PALE, PAPER, SPACE, TICK, TICK_TEXT, WIDTH,
};

/// Height of the stretches of one colour in which a smooth field is filled.
const SCAN: f64 = 3.0;
/// Slices of a colour bar that runs smoothly.
const SLICES: u32 = 200;
/// What stands for a cell without a value.
const GAP: &str = "no value";
/// Dash of contours below the centre, as drawings have it.
const BELOW: &[f64] = &[12.0, 8.0];

/// Draws a map.
pub(super) fn map(sheet: &Sheet, map: &Map<'_>, layout: &MapLayout) {
    for (index, (panel, frame)) in map.panels.iter().zip(&layout.frames).enumerate() {
        sheet.group(&values(map, &panel.field, frame), || {
            if map.is_smooth() {
                bands(sheet, map, &panel.field, frame);
                lines(sheet, map, &panel.field, frame);
            } else {
                cells(sheet, map, &panel.field, frame);
            }
        });
        axes(sheet, layout, index, frame);
        marks(sheet, map, panel, frame);
        heading(sheet, layout, index, frame);
    }
    labels(sheet, map, layout);
    bar(sheet, map, &layout.bar);
    if let Some(top) = layout.legend {
        legend(sheet, map, Point { x: layout.frames[0].left, y: top + LEGEND_ROW / 2.0 });
    }
}

/// The numbers behind the colours.
fn values(map: &Map<'_>, field: &Field, frame: &Rect) -> Attributes {
    let x = Labelled { axis: &map.x, label: &map.x_label };
    let y = Labelled { axis: &map.y, label: &map.y_label };
    let rows = (0..field.y.len()).flat_map(|row| (0..field.x.len()).map(move |column| field.at(column, row)));
    Attributes::frame(frame, UNITS, x, y)
        .with("value-label", &map.value_label)
        .with_numbers("columns", field.x.iter().map(|x| map.x.displayed(*x)))
        .with_numbers("rows", field.y.iter().map(|y| map.y.displayed(*y)))
        .with_numbers("values", rows.map(|value| map.shades.axis.displayed(value)))
}

fn cells(sheet: &Sheet, map: &Map<'_>, field: &Field, frame: &Rect) {
    let across = shares(&cell_edges(&field.x, map.spec.x.scale), &map.x);
    let up = shares(&cell_edges(&field.y, map.spec.y.scale), &map.y);
    for row in 0..field.y.len() {
        for column in 0..field.x.len() {
            let (low, high) = (frame.at(across[column], up[row]), frame.at(across[column + 1], up[row + 1]));
            let place = Rect { left: low.x, top: high.y, right: high.x, bottom: low.y };
            match map.shades.axis.share(field.at(column, row)) {
                Some(share) => sheet.cell(&place, map.shades.color(share)),
                None => gap(sheet, &place),
            }
        }
    }
}

/// A cell without a value.
fn gap(sheet: &Sheet, place: &Rect) {
    sheet.cell(place, PALE);
    sheet.line(&[place.at(0.0, 0.0), place.at(1.0, 1.0)], Pen::solid(GREY, FRAME))
}

/// Fills a field row by row with stretches of one band each.
fn bands(sheet: &Sheet, map: &Map<'_>, field: &Field, frame: &Rect) {
    let band = |across: f64, up: f64| {
        let value = field.sample(map.x.number(across), map.y.number(up))?;
        Some(map.shades.band(map.shades.axis.share(value)?))
    };
    let colors: Vec<Color> =
        map.shades.slices(1).into_iter().map(|[from, to]| map.shades.color((from + to) / 2.0)).collect();
    let steps = |length: f64| whole(length / SCAN).max(1);
    let (rows, columns) = (steps(frame.height()), steps(frame.width()));
    let mut stretches = vec![Vec::new(); colors.len()];
    for row in 0..rows {
        let middle = (f64::from(row) + 0.5) / f64::from(rows);
        let mut start = 0;
        for column in 1..=columns {
            let at = |column: u32| band((f64::from(column) + 0.5) / f64::from(columns), middle);
            let here = at(start);
            if column < columns && at(column) == here {
                continue;
            }
            if let Some(stretches) = here.and_then(|band| stretches.get_mut(band)) {
                let (left, right) = (f64::from(start) / f64::from(columns), f64::from(column) / f64::from(columns));
                let (low, high) = (f64::from(row) / f64::from(rows), f64::from(row + 1) / f64::from(rows));
                let (a, b) = (frame.at(left, low), frame.at(right, high));
                stretches.push(Rect { left: a.x, top: b.y, right: b.x, bottom: a.y });
            }
            start = column;
        }
    }
    for (stretches, color) in stretches.iter().zip(colors) {
        sheet.cells(stretches, color);
    }
}

/// Contours between the bands; the one at the centre is the nodal line of a shape.
fn lines(sheet: &Sheet, map: &Map<'_>, field: &Field, frame: &Rect) {
    let centre = map.shades.centre();
    let place = |node: &Node| {
        let x = map.x.share(between(&field.x, node.column))?;
        Some(frame.at(x, map.y.share(between(&field.y, node.row))?))
    };
    let share = |value: f64| map.shades.axis.share(value);
    let draw = |level: f64, pen: Pen| {
        for line in contours(field, share, level) {
            let points: Vec<Point> = line.iter().filter_map(place).collect();
            sheet.line(&points, pen);
        }
    };
    for &level in map.shades.levels() {
        let below = centre.is_some_and(|centre| level < centre);
        if centre.is_none_or(|centre| (level - centre).abs() > 1e-6) {
            draw(level, Pen { color: INK, width: CONTOUR, dash: if below { BELOW } else { &[] } });
        }
    }
    if let Some(centre) = centre {
        draw(centre, Pen::solid(INK, CURVE));
    }
}

fn between(nodes: &[f64], along: f64) -> f64 {
    let at = (whole(along.floor()) as usize).min(nodes.len() - 1);
    let next = (at + 1).min(nodes.len() - 1);
    nodes[at] + (along - along.floor()) * (nodes[next] - nodes[at])
}

fn axes(sheet: &Sheet, layout: &MapLayout, index: usize, frame: &Rect) {
    let pen = Pen::solid(INK, FRAME);
    outline(sheet, frame);
    let length = |tick: &Tick| if tick.label.is_empty() { MINOR_TICK } else { TICK };
    for tick in &layout.x_ticks {
        let at = frame.at(tick.at, 0.0);
        sheet.line(&[at, Point { y: at.y + length(tick), ..at }], pen);
        if layout.is_lowest(index) {
            let at = Point { y: at.y + TICK + SPACE / 2.0 + TICK_TEXT / 2.0, ..at };
            write(sheet, at, &tick.label, TICK_TEXT, Anchor::Centre);
        }
    }
    for tick in &layout.y_ticks {
        let at = frame.at(0.0, tick.at);
        sheet.line(&[at, Point { x: at.x - length(tick), ..at }], pen);
        if layout.is_first(index) {
            write(sheet, Point { x: at.x - TICK - SPACE / 2.0, ..at }, &tick.label, TICK_TEXT, Anchor::Right);
        }
    }
}

fn outline(sheet: &Sheet, place: &Rect) {
    let corners = [place.at(0.0, 0.0), place.at(1.0, 0.0), place.at(1.0, 1.0), place.at(0.0, 1.0)];
    let closed = [corners[0], corners[1], corners[2], corners[3], corners[0], corners[1]];
    sheet.line(&closed, Pen::solid(INK, FRAME))
}

fn marks(sheet: &Sheet, map: &Map<'_>, panel: &MapPanel, frame: &Rect) {
    let at = |x: f64, y: f64| frame.at(map.x.share_clamped(x), map.y.share_clamped(y));
    for mark in &panel.marks {
        cross(sheet, at(mark.x, mark.y), MAP_SIGN);
    }
    for best in &panel.best {
        ring(sheet, at(best.x, best.y), MAP_SIGN);
    }
}

/// A cross that stands out on any colour.
fn cross(sheet: &Sheet, at: Point, size: f64) {
    let arm = 0.62 * size;
    let ends =
        |sign: f64| [Point { x: at.x - arm, y: at.y - sign * arm }, Point { x: at.x + arm, y: at.y + sign * arm }];
    for (color, width) in HALO {
        sheet.line(&ends(1.0), Pen::solid(color, width));
        sheet.line(&ends(-1.0), Pen::solid(color, width));
    }
}

/// A ring that stands out on any colour, wide enough for a cross within.
fn ring(sheet: &Sheet, at: Point, size: f64) {
    for (color, width) in HALO {
        sheet.ring(at, size, Pen::solid(color, width));
    }
}

/// Dark on a wider light line.
const HALO: [(Color, f64); 2] = [(PAPER, 2.2 * CURVE), (INK, CURVE)];

fn heading(sheet: &Sheet, layout: &MapLayout, index: usize, frame: &Rect) {
    let note = &layout.notes[index];
    let mut y = frame.top - SPACE / 2.0 - line_height() / 2.0;
    if !note.is_empty() {
        let size = NOTE_TEXT / 2.0;
        ring(sheet, Point { x: frame.left + size, y }, size * 0.8);
        write(sheet, Point { x: frame.left + sign_width(), y }, note, NOTE_TEXT, Anchor::Left);
        y -= line_height();
    }
    for line in layout.titles[index].iter().rev() {
        write(sheet, Point { x: frame.left, y }, line, LEGEND_TEXT, Anchor::Left);
        y -= line_height();
    }
}

fn labels(sheet: &Sheet, map: &Map<'_>, layout: &MapLayout) {
    let (first, last) = (&layout.frames[0], layout.frames.iter().map(|frame| frame.right).fold(0.0, f64::max));
    let bottom = layout.frames.iter().map(|frame| frame.bottom).fold(0.0, f64::max);
    let below = bottom + TICK + SPACE + TICK_TEXT + SPACE / 2.0 + LABEL_TEXT / 2.0;
    write(sheet, Point { x: (first.left + last) / 2.0, y: below }, &map.x_label, LABEL_TEXT, Anchor::Centre);
    let numbers = layout.y_ticks.iter().map(|tick| text_width(&tick.label, TICK_TEXT)).fold(0.0, f64::max);
    let beside = first.left - TICK - SPACE - numbers - SPACE / 2.0 - LABEL_TEXT / 2.0;
    let middle = Point { x: beside, y: (first.top + bottom) / 2.0 };
    upright(sheet, middle, &map.y_label)
}

fn bar(sheet: &Sheet, map: &Map<'_>, place: &Rect) {
    for [from, to] in map.shades.slices(SLICES) {
        let (low, high) = (place.at(0.0, from), place.at(1.0, to));
        let slice = Rect { left: low.x, top: high.y, right: high.x, bottom: low.y };
        sheet.cell(&slice, map.shades.color((from + to) / 2.0));
    }
    outline(sheet, place);
    if let Some(centre) = map.shades.centre() {
        sheet.line(&[place.at(0.0, centre), place.at(1.0, centre)], Pen::solid(INK, CURVE));
    }
    let mut widest = 0.0_f64;
    for Tick { at, label } in &map.shades.ticks() {
        let at = place.at(1.0, *at);
        let length = if label.is_empty() { MINOR_TICK } else { TICK };
        sheet.line(&[at, Point { x: at.x + length, ..at }], Pen::solid(INK, FRAME));
        write(sheet, Point { x: at.x + TICK + SPACE / 2.0, ..at }, label, TICK_TEXT, Anchor::Left);
        widest = widest.max(text_width(label, TICK_TEXT));
    }
    let beside = place.right + TICK + SPACE / 2.0 + widest + SPACE + LABEL_TEXT / 2.0;
    upright(sheet, Point { x: beside, y: place.at(0.0, 0.5).y }, &map.value_label)
}

/// The best place of the only panel, in the longest words for which there is room.
fn one_best(map: &Map<'_>, panel: &MapPanel, room: f64) -> String {
    let texts = map.best_in_words(panel).into_iter().map(|words| format!("{} {words}", map.best_label));
    let mut last = map.best_label.clone();
    for text in texts {
        if text_width(&text, LEGEND_TEXT) <= room {
            return text;
        }
        last = text;
    }
    last
}

/// The signs of marks, best places and gaps, in one row.
fn legend(sheet: &Sheet, map: &Map<'_>, start: Point) {
    let size = LEGEND_TEXT / 2.0;
    let words = map.spec.mark.iter().map(|mark| mark.label.as_str()).chain(map.has_gaps().then_some(GAP));
    let taken: f64 = words.map(|word| text_width(word, LEGEND_TEXT) + 2.0 * size + 5.0 * SPACE).sum();
    let room = WIDTH - start.x - taken - 2.0 * size - 2.0 * SPACE;
    let mut at = Point { x: start.x + size, ..start };
    let mut word = |sign: &dyn Fn(Point), text: &str| {
        sign(at);
        let text_at = Point { x: at.x + size + SPACE, ..at };
        write(sheet, text_at, text, LEGEND_TEXT, Anchor::Left);
        at.x = text_at.x + text_width(text, LEGEND_TEXT) + 4.0 * SPACE;
    };
    if let Some(mark) = &map.spec.mark {
        word(&|at| cross(sheet, at, size), &mark.label);
    }
    if map.panels.iter().any(|panel| !panel.best.is_empty()) {
        let text = match map.panels.as_slice() {
            [one] => one_best(map, one, room),
            _ => map.best_label.clone(),
        };
        word(&|at| ring(sheet, at, size * 0.9), &text);
    }
    if map.has_gaps() {
        let place = |at: Point| Rect { left: at.x - size, top: at.y - size, right: at.x + size, bottom: at.y + size };
        word(&|at| gap(sheet, &place(at)), GAP);
    }
}

fn upright(sheet: &Sheet, at: Point, text: &str) {
    sheet.text(at, &Lettering { text, size: LABEL_TEXT, anchor: Anchor::Centre, upright: true, color: INK })
}

fn write(sheet: &Sheet, at: Point, text: &str, size: f64, anchor: Anchor) {
    if text.is_empty() {
        return;
    }
    sheet.text(at, &Lettering { text, size, anchor, upright: false, color: INK })
}

#[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "lengths of a picture")]
fn whole(length: f64) -> u32 {
    length.max(0.0) as u32
}
