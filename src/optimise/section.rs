//! Sections of a function: its values along each coordinate through a point, the others held.

use super::bounds::{Bounds, Spacing};
use super::search::{Function, Score};

/// A section along one coordinate.
#[derive(Debug, Clone, PartialEq)]
pub struct Section {
    /// Values of the coordinate, the point's own among them.
    pub along: Vec<f64>,
    /// What the function is there.
    pub scores: Vec<Score>,
}

/// The sections through `centre`, one a coordinate.
///
/// # Errors
/// What `evaluate` fails with.
pub fn sections<E>(
    bounds: &Bounds,
    centre: &[f64],
    points: usize,
    spacing: Spacing,
    evaluate: &mut Function<'_, E>,
) -> Result<Vec<Section>, E> {
    let mut sections = Vec::with_capacity(centre.len());
    for side in 0..bounds.size() {
        let mut along = bounds.along(side, points, spacing);
        along.push(centre[side]);
        along.sort_by(f64::total_cmp);
        along.dedup();
        let moved = |x: &f64| {
            let mut point = centre.to_vec();
            point[side] = *x;
            point
        };
        let scores = evaluate(&along.iter().map(moved).collect::<Vec<_>>())?.scores;
        sections.push(Section { along, scores });
    }
    Ok(sections)
}
