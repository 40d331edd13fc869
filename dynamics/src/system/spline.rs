//! Cubic spline through measured points ("not a knot" ends, as MATLAB's `spline`), end values outside.

use crate::arithmetic::gauss::eliminate;

/// A curve y(x); constant beyond its first and last point.
#[derive(Debug, Clone, PartialEq)]
pub struct Spline {
    x: Vec<f64>,
    y: Vec<f64>,
    /// Second derivatives at the points.
    curvature: Vec<f64>,
}

impl Spline {
    /// The spline through `points`, sorted by strictly increasing x; `None` if they are not, or are none.
    #[must_use]
    pub fn through(points: &[[f64; 2]]) -> Option<Self> {
        let increasing = points.windows(2).all(|pair| pair[0][0] < pair[1][0]);
        if points.is_empty() || !increasing || points.iter().flatten().any(|v| !v.is_finite()) {
            return None;
        }
        let x: Vec<f64> = points.iter().map(|p| p[0]).collect();
        let y: Vec<f64> = points.iter().map(|p| p[1]).collect();
        let curvature = curvature(&x, &y);
        Some(Self { x, y, curvature })
    }

    /// y at `x`.
    #[must_use]
    pub fn at(&self, x: f64) -> f64 {
        let last = self.x.len() - 1;
        if !(x > self.x[0]) {
            return self.y[0];
        }
        if x >= self.x[last] {
            return self.y[last];
        }
        let right = self.x.partition_point(|knot| *knot <= x);
        let left = right - 1;
        let h = self.x[right] - self.x[left];
        let (a, b) = ((self.x[right] - x) / h, (x - self.x[left]) / h);
        a * self.y[left]
            + b * self.y[right]
            + ((a * a * a - a) * self.curvature[left] + (b * b * b - b) * self.curvature[right]) * h * h / 6.0
    }

    /// Where the curve is lowest, with its value there; between its points a spline may fall below all of them.
    #[must_use]
    pub fn lowest(&self) -> [f64; 2] {
        let at = |x: f64| [x, self.at(x)];
        let between = (1..self.x.len()).flat_map(|right| {
            let left = right - 1;
            let h = self.x[right] - self.x[left];
            let [from, to] = [self.curvature[left], self.curvature[right]].map(|curvature| curvature * h * h / 6.0);
            // y′ h = a b² + b b + c at the share b of the way.
            let (a, b) = (3.0 * (to - from), 6.0 * from);
            let c = self.y[right] - self.y[left] - 2.0 * from - to;
            let root = (b * b - 4.0 * a * c).sqrt();
            let q = -0.5 * (b + root.copysign(b));
            [q / a, c / q].into_iter().filter(|b| (0.0..=1.0).contains(b)).map(move |b| self.x[left] + b * h)
        });
        let least = |least: [f64; 2], one: [f64; 2]| if one[1] < least[1] || one[1].is_nan() { one } else { least };
        self.x.iter().copied().chain(between).map(at).fold(at(self.x[0]), least)
    }

    /// The first point: below its abscissa the curve is constant.
    #[must_use]
    pub fn lower_end(&self) -> [f64; 2] {
        [self.x[0], self.y[0]]
    }

    /// The value beyond the last point.
    #[must_use]
    pub fn upper_end(&self) -> f64 {
        self.y[self.y.len() - 1]
    }
}

/// Second derivatives; by a dense system, as the curves have a dozen points.
fn curvature(x: &[f64], y: &[f64]) -> Vec<f64> {
    let n = x.len();
    if n < 3 {
        return vec![0.0; n];
    }
    let h: Vec<f64> = x.windows(2).map(|p| p[1] - p[0]).collect();
    let mut a = vec![vec![0.0; n + 1]; n];
    if n == 3 {
        // One parabola.
        a[0][0] = 1.0;
        a[0][1] = -1.0;
        a[2][2] = 1.0;
        a[2][1] = -1.0;
    } else {
        a[0][0] = -h[1];
        a[0][1] = h[0] + h[1];
        a[0][2] = -h[0];
        a[n - 1][n - 3] = -h[n - 2];
        a[n - 1][n - 2] = h[n - 3] + h[n - 2];
        a[n - 1][n - 1] = -h[n - 3];
    }
    for i in 1..n - 1 {
        a[i][i - 1] = h[i - 1];
        a[i][i] = 2.0 * (h[i - 1] + h[i]);
        a[i][i + 1] = h[i];
        a[i][n] = 6.0 * ((y[i + 1] - y[i]) / h[i] - (y[i] - y[i - 1]) / h[i - 1]);
    }
    eliminate(&mut a);
    a.iter().map(|row| row[n]).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_cubic_is_reproduced_and_ends_are_held() {
        let cubic = |x: f64| 1.0 + x - 2.0 * x * x + 0.5 * x * x * x;
        let points: Vec<[f64; 2]> = [0.7, 1.5, 2.0, 4.0, 7.6].iter().map(|&x| [x, cubic(x)]).collect();
        let spline = Spline::through(&points).unwrap();
        for x in [0.7, 1.1, 3.3, 6.0] {
            assert!((spline.at(x) - cubic(x)).abs() < 1e-11);
        }
        assert_eq!(spline.at(0.1), spline.at(0.7));
        assert_eq!(spline.at(99.0), spline.upper_end());
    }

    #[test]
    fn the_lowest_point_is_found_between_the_points() {
        // A parabola with its minimum −1 at 3.
        let parabola = |x: f64| (x - 3.0) * (x - 3.0) - 1.0;
        let points: Vec<[f64; 2]> = [0.0, 1.0, 5.0, 6.0].iter().map(|&x| [x, parabola(x)]).collect();
        let [x, y] = Spline::through(&points).unwrap().lowest();
        assert!((x - 3.0).abs() < 1e-12 && (y + 1.0).abs() < 1e-12, "{x} {y}");
        let line = Spline::through(&[[1.0, 2.0], [3.0, 1.0]]).unwrap();
        assert_eq!(line.lowest(), [3.0, 1.0]);
    }
}
