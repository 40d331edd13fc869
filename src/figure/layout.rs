//! Where the panels of a figure lie: one above the other, left edges aligned, with room for what stands around them.

use super::geometry::Rect;
use super::style::{LABEL_TEXT, SPACE, TICK_TEXT, WIDTH, height};

/// What a panel needs around its frame.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Needs {
    /// Height of a legend above the frame.
    pub above: f64,
    /// Width of the widest label at the y axis.
    pub y_labels: f64,
    /// Whether numbers and label of the x axis stand below.
    pub x_labels: bool,
    /// Width that the last number of the x axis takes beyond the frame.
    pub beyond: f64,
}

/// Height of a figure with so many panels.
pub(super) fn figure_height(needs: &[Needs]) -> f64 {
    height(needs.len())
}

/// The panels' frames.
pub(super) fn frames(needs: &[Needs]) -> Vec<Rect> {
    let left = needs.iter().map(|need| need.y_labels).fold(0.0, f64::max) + LABEL_TEXT + 4.0 * SPACE;
    let right = WIDTH - needs.iter().map(|need| need.beyond).fold(0.0, f64::max) - 2.0 * SPACE;
    let below = |need: &Needs| if need.x_labels { TICK_TEXT + LABEL_TEXT + 4.0 * SPACE } else { 2.5 * SPACE };
    let above = |need: &Needs| need.above.max(2.0 * SPACE);
    let taken: f64 = needs.iter().map(|need| above(need) + below(need)).sum();
    let panels = u32::try_from(needs.len().max(1)).map_or(1.0, f64::from);
    let each = ((figure_height(needs) - taken) / panels).max(1.0);
    let mut frames = Vec::with_capacity(needs.len());
    let mut top = 0.0;
    for need in needs {
        top += above(need);
        frames.push(Rect { left, top, right, bottom: top + each });
        top += each + below(need);
    }
    frames
}
