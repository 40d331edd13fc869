//! Peaks of curves, to be marked with their place: a frequency response is read by its resonances.

use crate::experiment::PeakMarks;

use super::axis::Axis;
use super::geometry::Point;
use super::line::Curve;
use super::sample::Sample;
use super::style::Look;

/// A mark on a peak, with its place on the x axis.
pub(super) struct PeakMark {
    pub(super) at: Point,
    pub(super) x: f64,
    pub(super) look: Look,
}

/// The samples of a curve at which it peaks, the most prominent first. A peak's prominence is how far one has to descend
/// from it before the curve rises above it, here as a share of the axis.
pub(super) fn peaks(curve: &Curve, y: &Axis, marks: PeakMarks) -> Vec<Sample> {
    let mut found: Vec<(f64, Sample)> = Vec::new();
    for stretch in curve.samples.split(|sample| y.share(sample.y).is_none()) {
        let height: Vec<f64> = stretch.iter().filter_map(|sample| y.share(sample.y)).collect();
        for at in 1..height.len().saturating_sub(1) {
            // A plateau counts once, at its first sample.
            if height[at - 1] >= height[at] || height[at + 1] > height[at] {
                continue;
            }
            let foot = |side: &mut dyn Iterator<Item = usize>| {
                side.take_while(|&i| height[i] <= height[at]).map(|i| height[i]).fold(height[at], f64::min)
            };
            let feet = foot(&mut (0..at).rev()).max(foot(&mut (at + 1..height.len())));
            let prominence = height[at] - feet;
            if prominence >= marks.prominence {
                found.push((prominence, stretch[at]));
            }
        }
    }
    found.sort_by(|a, b| b.0.total_cmp(&a.0));
    found.truncate(marks.most as usize);
    found.into_iter().map(|(_, sample)| sample).collect()
}
