//! Where the panels of a map lie: a grid of equal frames, numbers at its left and lower edges, the colour bar at its right.

use super::axis::Tick;
use super::canvas::{text_width, wrapped};
use super::geometry::Rect;
use super::layout::line_height;
use super::map::Map;
use super::style::{BAR, LABEL_TEXT, LEGEND_ROW, LEGEND_TEXT, NOTE_TEXT, SPACE, TALLEST_MAP, TICK_TEXT, WIDTH};

/// How many numbers an axis of a wide and of a narrow panel carries at most.
const MOST_TICKS: [u32; 2] = [8, 3];
/// Frames narrower than this are narrow.
const NARROW: f64 = 480.0;

/// A map's places.
pub(super) struct MapLayout {
    pub height: f64,
    /// One a panel, row by row.
    pub frames: Vec<Rect>,
    /// One a panel: letter and title, broken into lines.
    pub titles: Vec<Vec<String>>,
    /// One a panel: its best place; empty if none is named.
    pub notes: Vec<String>,
    pub bar: Rect,
    pub columns: usize,
    pub x_ticks: Vec<Tick>,
    pub y_ticks: Vec<Tick>,
    /// Top of the row of signs above all panels; none if nothing is to be explained.
    pub legend: Option<f64>,
}

impl MapLayout {
    pub(super) fn new(map: &Map<'_>) -> Self {
        let count = map.panels.len().max(1);
        let columns = map.spec.columns.map_or_else(|| usual_columns(count), |n| n as usize).clamp(1, count);
        let rows = count.div_ceil(columns);
        let widest = |ticks: &[Tick]| ticks.iter().map(|tick| text_width(&tick.label, TICK_TEXT)).fold(0.0, f64::max);

        let bar_numbers = widest(&map.shades.ticks());
        let right = 3.0 * SPACE + BAR + SPACE + bar_numbers + 2.0 * SPACE + LABEL_TEXT + SPACE;
        let place = |most: u32| {
            let (x_ticks, y_ticks) = (map.x.ticks(most), map.y.ticks(most));
            let left = 3.0 * SPACE + line_height() + widest(&y_ticks);
            // Numbers at the ends of neighbouring axes hang over, each by half its width.
            let gap = widest(&x_ticks) + 2.5 * SPACE;
            let width = (WIDTH - left - right - gap * as_f64(columns - 1)) / as_f64(columns);
            (x_ticks, y_ticks, left, gap, width)
        };
        let mut placed = place(MOST_TICKS[0]);
        if placed.4 < NARROW {
            placed = place(MOST_TICKS[1]);
        }
        let (x_ticks, y_ticks, left, gap, widest_frame) = placed;

        let aspect = map.aspect();
        let legend_height = if explains(map) { LEGEND_ROW + SPACE } else { 0.0 };
        let below = TICK_TEXT + LABEL_TEXT + 4.0 * SPACE;
        let heading = |width: f64| Heading::new(map, width, count > 1);
        let free =
            |heading: &Heading| TALLEST_MAP - legend_height - below - as_f64(rows) * (heading.height + 2.0 * SPACE);
        let first = heading(widest_frame);
        let width = widest_frame.min(free(&first) / as_f64(rows) / aspect).max(1.0);
        let Heading { titles, notes, height: heading } = heading(width);

        // What a height limit leaves free goes to both sides.
        let left = left + (widest_frame - width) * as_f64(columns) / 2.0;
        let mut frames = Vec::with_capacity(count);
        for index in 0..count {
            let (column, row) = (as_f64(index % columns), as_f64(index / columns));
            let x = left + column * (width + gap);
            let y = legend_height + (row + 1.0) * heading + row * (width * aspect + 2.0 * SPACE) + SPACE;
            frames.push(Rect { left: x, top: y, right: x + width, bottom: y + width * aspect });
        }
        let bottom = frames.iter().map(|frame| frame.bottom).fold(0.0, f64::max);
        let edge = frames.iter().map(|frame| frame.right).fold(0.0, f64::max) + 3.0 * SPACE;
        let bar = Rect { left: edge, top: frames[0].top, right: edge + BAR, bottom };
        let legend = explains(map).then_some(SPACE);
        Self { height: bottom + below, frames, titles, notes, bar, columns, x_ticks, y_ticks, legend }
    }

    /// True if no panel stands below that one.
    pub(super) fn is_lowest(&self, index: usize) -> bool {
        index + self.columns >= self.frames.len()
    }

    /// True if no panel stands to the left of that one.
    pub(super) fn is_first(&self, index: usize) -> bool {
        index.is_multiple_of(self.columns)
    }
}

/// What stands above the frames.
struct Heading {
    titles: Vec<Vec<String>>,
    notes: Vec<String>,
    height: f64,
}

impl Heading {
    fn new(map: &Map<'_>, width: f64, lettered: bool) -> Self {
        let title = |(index, panel): (u8, &super::map::MapPanel)| {
            let letter = char::from(b'a'.saturating_add(index));
            let mut lines = vec![if lettered { format!("({letter})") } else { String::new() }];
            for part in &panel.title {
                let line = lines.pop().unwrap_or_default();
                let joint = if line.is_empty() || line.ends_with(')') && lines.is_empty() { " " } else { ", " };
                let joined = format!("{line}{joint}{part}").trim_start().to_owned();
                if text_width(&joined, LEGEND_TEXT) <= width || line.is_empty() {
                    lines.push(joined);
                } else {
                    lines.push(line);
                    lines.extend(wrapped(part, LEGEND_TEXT, width));
                }
            }
            lines.retain(|line| !line.is_empty());
            lines
        };
        let titles: Vec<_> = (0_u8..).zip(&map.panels).map(title).collect();
        // All panels say as much as the one with the least room can.
        let words: Vec<Vec<String>> = if lettered {
            map.panels.iter().map(|panel| map.best_in_words(panel)).collect()
        } else {
            // The row of signs names the place of the one panel.
            vec![Vec::new()]
        };
        let room = width - sign_width();
        let fits = |form: &usize| {
            words.iter().all(|forms| forms.get(*form).is_none_or(|text| text_width(text, NOTE_TEXT) <= room))
        };
        let form = (0..4).find(fits).unwrap_or(3);
        let notes: Vec<_> = words.into_iter().map(|forms| forms.get(form).cloned().unwrap_or_default()).collect();
        let lines = titles.iter().map(Vec::len).max().unwrap_or(0);
        let note = if notes.iter().any(|note| !note.is_empty()) { line_height() } else { 0.0 };
        let height = line_height() * as_f64(lines) + note + SPACE / 2.0;
        Self { titles, notes, height }
    }
}

/// Width that the sign of the best place takes before its note.
pub(super) fn sign_width() -> f64 {
    NOTE_TEXT + SPACE / 2.0
}

fn explains(map: &Map<'_>) -> bool {
    map.spec.mark.is_some() || map.has_gaps() || map.panels.iter().any(|panel| !panel.best.is_empty())
}

fn usual_columns(panels: usize) -> usize {
    match panels {
        0 | 1 => 1,
        2 | 4 => 2,
        3 | 5..=9 => 3,
        _ => 4,
    }
}

fn as_f64(n: usize) -> f64 {
    f64::from(u32::try_from(n).unwrap_or(u32::MAX))
}
