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

/// The sections through `centre`, one a coordinate. All points are evaluated at once, each once: the centre is on every section.
///
/// # Errors
/// What `evaluate` fails with.
pub fn sections<T: Clone, E>(
    bounds: &Bounds,
    centre: &[f64],
    points: usize,
    spacing: Spacing,
    evaluate: impl FnOnce(&[Vec<f64>]) -> Result<Vec<T>, E>,
) -> Result<Vec<Section<T>>, E> {
    let mut all: Vec<Vec<f64>> = Vec::new();
    // Of each section its values of the coordinate, and the places of its points among all.
    let mut cuts: Vec<(Vec<f64>, Vec<usize>)> = Vec::with_capacity(centre.len());
    for side in 0..bounds.size() {
        let mut along = bounds.along(side, points, spacing);
        along.push(centre[side]);
        along.sort_by(f64::total_cmp);
        along.dedup();
        let mut places = Vec::with_capacity(along.len());
        for x in &along {
            let mut point = centre.to_vec();
            point[side] = *x;
            places.push(all.iter().position(|known| *known == point).unwrap_or(all.len()));
            if places.last() == Some(&all.len()) {
                all.push(point);
            }
        }
        cuts.push((along, places));
    }
    let values = evaluate(&all)?;
    let section = |(along, places): (Vec<f64>, Vec<usize>)| {
        let values = places.into_iter().map(|place| values[place].clone()).collect();
        Section { along, values }
    };
    Ok(cuts.into_iter().map(section).collect())
}
