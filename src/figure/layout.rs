//! Where the panels of a figure lie: one above the other, left edges aligned, with room for what stands around them.

use super::canvas::wrapped;
use super::geometry::Rect;
use super::style::{LABEL_TEXT, SPACE, TICK_TEXT, WIDTH, height};

/// What a panel needs around its frame.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Needs {
    /// Height of a legend above the frame.
    pub above: f64,
    /// Width of the widest number at the y axis.
    pub y_numbers: f64,
    /// The label of the y axis.
    pub y_label: String,
    /// Whether numbers and label of the x axis stand below.
    pub x_labels: bool,
    /// Height of strips below the frame.
    pub strips: f64,
    /// Width that the last number of the x axis takes beyond the frame.
    pub beyond: f64,
}

/// A panel's place.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Place {
    /// The box of the axes.
    pub frame: Rect,
    /// The label of the y axis, broken into lines that fit beside the frame.
    pub y_label: Vec<String>,
}

/// Numbers and label of an x axis.
const X_LABELS: f64 = TICK_TEXT + LABEL_TEXT + 4.0 * SPACE;

/// Height of a figure of these panels: legends above frames, strips, and any x axis but the last take nothing from the frames.
pub(super) fn figure_height(needs: &[Needs]) -> f64 {
    let legends: f64 = needs.iter().map(|need| (need.above - least_above(needs)).max(0.0)).sum();
    let axes = needs.iter().filter(|need| need.x_labels).skip(1).map(|_| X_LABELS).sum::<f64>();
    height(needs.len()) + needs.iter().map(|need| need.strips).sum::<f64>() + legends + axes
}

/// Above a frame without a legend there: a panel's letter, if there are several.
fn least_above(needs: &[Needs]) -> f64 {
    if needs.len() > 1 { LABEL_TEXT + SPACE } else { 2.0 * SPACE }
}

/// The panels' places.
pub(super) fn places(needs: &[Needs]) -> Vec<Place> {
    let labels = |need: &Needs| if need.x_labels { X_LABELS } else { SPACE };
    let below = |need: &Needs| need.strips + labels(need);
    let above = |need: &Needs| need.above.max(least_above(needs));
    let taken: f64 = needs.iter().map(|need| above(need) + below(need)).sum();
    let panels = u32::try_from(needs.len().max(1)).map_or(1.0, f64::from);
    let each = ((figure_height(needs) - taken) / panels).max(1.0);

    // A label may be a little longer than its frame is high.
    let longest = each + 2.0 * SPACE;
    let y_labels: Vec<_> = needs.iter().map(|need| wrapped(&need.y_label, LABEL_TEXT, longest)).collect();
    let lines = y_labels.iter().map(|lines| u32::try_from(lines.len()).map_or(1.0, f64::from)).fold(1.0, f64::max);
    let y_numbers = needs.iter().map(|need| need.y_numbers).fold(0.0, f64::max);
    let left = y_numbers + lines * line_height() + 3.0 * SPACE;
    let right = WIDTH - needs.iter().map(|need| need.beyond).fold(0.0, f64::max) - 2.0 * SPACE;

    let mut places = Vec::with_capacity(needs.len());
    let mut top = 0.0;
    for (need, y_label) in needs.iter().zip(y_labels) {
        top += above(need);
        places.push(Place { frame: Rect { left, top, right, bottom: top + each }, y_label });
        top += each + below(need);
    }
    places
}

/// Distance of the lines of a label.
pub(super) fn line_height() -> f64 {
    LABEL_TEXT + SPACE / 2.0
}
