//! Between the points of a curve: the parabola through the highest and its two neighbours,
//!
//! y(x) = y₁ + s (x − x₁) + κ (x − x₁)²,   which rises s²/(−4κ) above y₁.

/// A point of a curve.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Point {
    /// Where it is.
    pub x: f64,
    /// How high.
    pub y: f64,
}

/// How far the parabola through the highest point of a curve, which stands at `top`, and its neighbours rises above it; 0 if it has but one, and
/// if they lie on a line. `point` gives the points in order, `None` behind the last.
#[must_use]
pub fn overshoot(top: usize, point: impl Fn(usize) -> Option<Point>) -> f64 {
    let three = || Some([point(top.checked_sub(1)?)?, point(top)?, point(top + 1)?]);
    let Some([before, top, behind]) = three() else { return 0.0 };
    let (left, right) = (top.x - before.x, behind.x - top.x);
    let rise = (top.y - before.y) / left;
    let fall = (behind.y - top.y) / right;
    let curvature = (fall - rise) / (left + right);
    let slope = (rise * right + fall * left) / (left + right);
    if curvature < 0.0 { slope * slope / (-4.0 * curvature) } else { 0.0 }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_parabola_is_found_from_three_points_however_far_apart() {
        let point = |x: f64| Point { x, y: 5.0 - 2.0 * (x - 1.3) * (x - 1.3) };
        for [left, right] in [[0.4, 0.4], [0.1, 0.9], [0.9, 0.1]] {
            let three = [1.2 - left, 1.2, 1.2 + right].map(point);
            assert!((three[1].y + overshoot(1, |i| three.get(i).copied()) - 5.0).abs() < 1e-14);
        }
    }
}
