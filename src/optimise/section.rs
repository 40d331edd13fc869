//! Sections of a function: its values along each coordinate through a point, the others held.

use super::bounds::{Bounds, Spacing};

/// A section along one coordinate.
#[derive(Debug, Clone, PartialEq)]
pub struct Section<T> {
    /// Values of the coordinate, the point's own among them.
    pub along: Vec<f64>,
    /// What the function is there.
    pub values: Vec<T>,
}

/// The sections through `centre`, one a coordinate.
///
/// # Errors
/// What `evaluate` fails with.
pub fn sections<T, E>(
    bounds: &Bounds,
    centre: &[f64],
    points: usize,
    spacing: Spacing,
    mut evaluate: impl FnMut(&[Vec<f64>]) -> Result<Vec<T>, E>,
) -> Result<Vec<Section<T>>, E> {
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
        let values = evaluate(&along.iter().map(moved).collect::<Vec<_>>())?;
        sections.push(Section { along, values });
    }
    Ok(sections)
}
