//! The part of a signal that constant loads add to its blocks: a polynomial of degree two in time.

/// p₀ + p₁ t + p₂ t².
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(crate) struct Parabola {
    pub(crate) p0: f64,
    pub(crate) p1: f64,
    pub(crate) p2: f64,
}

impl Parabola {
    pub(crate) fn at(self, t: f64) -> f64 {
        self.p0 + t * (self.p1 + t * self.p2)
    }

    pub(crate) fn rate(self, t: f64) -> f64 {
        self.p1 + 2.0 * self.p2 * t
    }

    pub(crate) fn derivative(self) -> Self {
        Self { p0: self.p1, p1: 2.0 * self.p2, p2: 0.0 }
    }

    pub(crate) fn times(self, factor: f64) -> Self {
        Self { p0: factor * self.p0, p1: factor * self.p1, p2: factor * self.p2 }
    }

    pub(crate) fn plus(self, other: Self) -> Self {
        Self { p0: self.p0 + other.p0, p1: self.p1 + other.p1, p2: self.p2 + other.p2 }
    }

    /// k times it, plus c times its rate.
    pub(crate) fn spring_and_dashpot(self, stiffness: f64, damping: f64) -> Self {
        Self {
            p0: stiffness * self.p0 + damping * self.p1,
            p1: stiffness * self.p1 + 2.0 * damping * self.p2,
            p2: stiffness * self.p2,
        }
    }
}
