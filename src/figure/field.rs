//! A quantity over a rectangular grid: what a map draws. The grid need be neither even nor complete.

use crate::experiment::AxisScale;

use super::axis::Axis;

/// A quantity at a place.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Spot {
    pub x: f64,
    pub y: f64,
    pub value: f64,
}

/// Values over a grid; NaN where there is none.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Field {
    /// Increasing.
    pub x: Vec<f64>,
    /// Increasing.
    pub y: Vec<f64>,
    /// Row by row of y.
    values: Vec<f64>,
}

impl Field {
    /// The field of these spots.
    ///
    /// # Errors
    /// The second of two spots at one place that differ in value.
    pub(super) fn of(spots: &[Spot]) -> Result<Self, Spot> {
        let placed = |spot: &&Spot| spot.x.is_finite() && spot.y.is_finite();
        let x = levels(spots.iter().filter(placed).map(|spot| spot.x));
        let y = levels(spots.iter().filter(placed).map(|spot| spot.y));
        let mut field = Self { values: vec![f64::NAN; x.len() * y.len()], x, y };
        for spot in spots.iter().filter(placed) {
            let at = index(&field.y, spot.y) * field.x.len() + index(&field.x, spot.x);
            let earlier = field.values[at];
            // One point that two sweeps of a union share gave the same bits twice.
            if !earlier.is_nan() && earlier.to_bits() != spot.value.to_bits() {
                return Err(*spot);
            }
            field.values[at] = spot.value;
        }
        Ok(field)
    }

    /// The value at a node of the grid.
    pub(super) fn at(&self, column: usize, row: usize) -> f64 {
        self.values[row * self.x.len() + column]
    }

    /// All nodes with a value.
    pub(super) fn spots(&self) -> impl Iterator<Item = Spot> {
        let place = |(at, value): (usize, &f64)| Spot {
            x: self.x[at % self.x.len()],
            y: self.y[at / self.x.len()],
            value: *value,
        };
        self.values.iter().enumerate().map(place).filter(|spot| spot.value.is_finite())
    }

    /// Between the nodes, linear in x and in y; `None` outside and where a neighbour has no value.
    pub(super) fn sample(&self, x: f64, y: f64) -> Option<f64> {
        let (column, across) = bracket(&self.x, x)?;
        let (row, up) = bracket(&self.y, y)?;
        let mix = |a: f64, b: f64, share: f64| a + share * (b - a);
        let low = mix(self.at(column, row), self.at(column + 1, row), across);
        let high = mix(self.at(column, row + 1), self.at(column + 1, row + 1), across);
        Some(mix(low, high, up)).filter(|value| value.is_finite())
    }
}

/// Bounds of the cells around the nodes: midway between them on the axis, the outer cells as wide outwards as inwards.
pub(super) fn cell_edges(nodes: &[f64], scale: AxisScale) -> Vec<f64> {
    let along: Vec<f64> = match scale {
        AxisScale::Linear => nodes.to_vec(),
        AxisScale::Log => nodes.iter().map(|x| libm::log10(*x)).collect(),
    };
    let mut edges: Vec<f64> = along.windows(2).map(|pair| (pair[0] + pair[1]) / 2.0).collect();
    let (Some(first), Some(last)) = (along.first(), along.last()) else { return edges };
    let alone = if scale == AxisScale::Linear && *first != 0.0 { first.abs() / 2.0 } else { 0.5 };
    let (before, after) = match (edges.first(), edges.last()) {
        (Some(a), Some(b)) => (first - (a - first), last + (last - b)),
        _ => (first - alone, last + alone),
    };
    edges.insert(0, before);
    edges.push(after);
    match scale {
        AxisScale::Linear => edges,
        AxisScale::Log => edges.into_iter().map(libm::exp10).collect(),
    }
}

/// The nodes' shares of an axis.
pub(super) fn shares(nodes: &[f64], axis: &Axis) -> Vec<f64> {
    nodes.iter().map(|x| axis.share_clamped(*x)).collect()
}

/// Numbers without repetition, increasing; two that differ by rounding are one.
fn levels(numbers: impl Iterator<Item = f64>) -> Vec<f64> {
    let mut numbers: Vec<f64> = numbers.collect();
    numbers.sort_by(f64::total_cmp);
    let size = numbers.iter().fold(0.0_f64, |size, x| size.max(x.abs()));
    numbers.dedup_by(|later, earlier| (*later - *earlier).abs() <= 1e-9 * size);
    numbers
}

/// The level that a number is, to rounding.
fn index(levels: &[f64], number: f64) -> usize {
    let at = levels.partition_point(|level| *level < number).min(levels.len() - 1);
    if at > 0 && (number - levels[at - 1]).abs() < (number - levels[at]).abs() { at - 1 } else { at }
}

/// Between which two nodes a number lies, and the share of the way.
fn bracket(nodes: &[f64], number: f64) -> Option<(usize, f64)> {
    let last = nodes.len().checked_sub(2)?;
    let at = nodes.partition_point(|node| *node <= number).saturating_sub(1).min(last);
    let share = (number - nodes[at]) / (nodes[at + 1] - nodes[at]);
    (-1e-9..=1.0 + 1e-9).contains(&share).then_some((at, share))
}
