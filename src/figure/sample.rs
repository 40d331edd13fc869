//! Points of curves.

/// One point of a curve; NaN in y is a gap.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Sample {
    pub x: f64,
    pub y: f64,
    /// Least and largest of the band around y; both y without one.
    pub band: [f64; 2],
}

impl Sample {
    /// Without a band.
    pub(super) fn bare(x: f64, y: f64) -> Self {
        Self { x, y, band: [y, y] }
    }

    /// Within its spread, if that is known.
    pub(super) fn within(x: f64, y: f64, spread: Option<f64>) -> Self {
        let spread = spread.filter(|spread| spread.is_finite()).unwrap_or(0.0);
        Self { x, y, band: [y - spread, y + spread] }
    }

    /// Between two stretches of one line.
    pub(super) fn gap() -> Self {
        Self::bare(f64::NAN, f64::NAN)
    }

    /// On the straight way to the next sample, the place at `x`; `None` if it does not lie between the two.
    pub(super) fn towards(self, next: Self, x: f64) -> Option<Self> {
        let share = (x - self.x) / (next.x - self.x);
        let mix = |a: f64, b: f64| a + share * (b - a);
        (share > 0.0 && share < 1.0).then(|| Self {
            x,
            y: mix(self.y, next.y),
            band: [mix(self.band[0], next.band[0]), mix(self.band[1], next.band[1])],
        })
    }

    pub(super) fn divided_by(self, one: f64) -> Self {
        Self { x: self.x, y: self.y / one, band: self.band.map(|edge| edge / one) }
    }
}
