//! Between the points of a curve: the parabola through the highest and its two neighbours,
//!
//! y(x) = y₁ + s (x − x₁) + κ (x − x₁)²,   which rises s²/(−4κ) above y₁.
//!
//! A resonance is no parabola where few points stand in it, but its 1/y² is one. That parabola counts as well where the next points on
//! both sides lie on it, too.

/// A point of a curve.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Point {
    /// Where it is.
    pub x: f64,
    /// How high.
    pub y: f64,
}

/// Share by which the next points may be off the parabola of a resonance.
const NEAR: f64 = 0.2;

/// How far the curve through the highest of some points, which stands at `top`, and its neighbours rises above it; 0 if it has but one, and
/// if they lie on a line. `point` gives the points in order, `None` behind the last.
#[must_use]
pub fn overshoot(top: usize, point: impl Fn(usize) -> Option<Point>) -> f64 {
    let Some(y) = Parabola::through(top, &point) else { return 0.0 };
    y.rise().max(0.0).max(resonance(top, point).unwrap_or(0.0))
}

/// The same of a resonance; `None` where it is none. Where the parabola of 1/y² comes down to zero the points say nothing of the height: it
/// may be as much again.
fn resonance(top: usize, point: impl Fn(usize) -> Option<Point>) -> Option<f64> {
    let inverse = |i: usize| point(i).filter(|one| one.y > 0.0).map(|one| Point { x: one.x, y: 1.0 / (one.y * one.y) });
    let parabola = Parabola::through(top, inverse)?;
    let (here, height) = (point(top)?.y, inverse(top)?.y + parabola.rise().min(0.0));
    let next = [top.checked_sub(2)?, top + 2];
    let lies_on_it =
        |i| inverse(i).is_some_and(|one| (parabola.height(one.x - parabola.middle.x) - one.y).abs() <= NEAR * one.y);
    let rise = if height > 0.0 { 1.0 / height.sqrt() - here } else { here };
    next.into_iter().all(lies_on_it).then_some(rise)
}

/// The parabola through a point and its neighbours.
#[derive(Debug, Clone, Copy)]
pub struct Parabola {
    /// That point.
    pub middle: Point,
    /// s.
    pub slope: f64,
    /// κ.
    pub curvature: f64,
}

impl Parabola {
    /// `None` if the point in the `middle` has not two neighbours.
    pub fn through(middle: usize, point: impl Fn(usize) -> Option<Point>) -> Option<Self> {
        let [before, middle, behind] = [point(middle.checked_sub(1)?)?, point(middle)?, point(middle + 1)?];
        let (left, right) = (middle.x - before.x, behind.x - middle.x);
        let rise = (middle.y - before.y) / left;
        let fall = (behind.y - middle.y) / right;
        let slope = (rise * right + fall * left) / (left + right);
        Some(Self { middle, slope, curvature: (fall - rise) / (left + right) })
    }

    /// How far its vertex is above its middle, negative if it opens upwards; 0 of a line.
    fn rise(&self) -> f64 {
        if self.curvature == 0.0 { 0.0 } else { self.slope * self.slope / (-4.0 * self.curvature) }
    }

    /// Its height so far behind the middle.
    #[must_use]
    pub fn height(&self, behind: f64) -> f64 {
        self.middle.y + behind * (self.slope + behind * self.curvature)
    }
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

    #[test]
    fn the_height_of_a_resonance_is_found_from_few_points_in_it() {
        let found = |damping: f64, shift: f64| {
            let amplitude = |x: f64| 1.0 / libm::hypot(1.0 - x * x, 2.0 * damping * x);
            let points: Vec<Point> =
                (0..40).map(|i| 0.5 + 0.025 * (f64::from(i) + shift)).map(|x| Point { x, y: amplitude(x) }).collect();
            let top = (0..40).max_by(|&a, &b| points[a].y.total_cmp(&points[b].y)).unwrap();
            let rise = overshoot(top, |i| points.get(i).copied());
            [rise / points[top].y, (points[top].y + rise) * 2.0 * damping * (1.0 - damping * damping).sqrt()]
        };
        for shift in [0.0, 0.2, 0.5, 0.8] {
            let [_, share] = found(0.02, shift);
            assert!((share - 1.0).abs() < 0.03, "{shift}: {share} of the height");
        }
        // With less than a point in it there is no telling.
        for (damping, shift) in [(0.002, 0.35), (0.001, 0.25)] {
            let [rise, _] = found(damping, shift);
            assert!(rise >= 1.0, "{damping}: {rise} of the highest point");
        }
    }

    #[test]
    fn a_spike_beside_a_step_is_no_resonance() {
        let points = [2.7, 2.9, 3.0, 1.0, 0.9];
        let point = |i: usize| points.get(i).map(|&y| Point { x: i as f64, y });
        assert!(overshoot(2, point) < 0.22);
    }
}
