//! The box that is searched, and its coordinates from 0 to 1.

/// Bounds of every coordinate.
#[derive(Debug, Clone, PartialEq)]
pub struct Bounds {
    sides: Vec<[f64; 2]>,
}

/// Bounds that enclose nothing.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum BoundsError {
    /// No coordinate.
    #[error("there is nothing to vary")]
    Empty,
    /// A side without length.
    #[error("coordinate {coordinate} lies between {low} and {high}, which is no range")]
    NoRange {
        /// Which, from 1.
        coordinate: usize,
        /// Lower bound.
        low: f64,
        /// Upper bound.
        high: f64,
    },
}

/// How points are spaced along a side.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Spacing {
    /// Evenly.
    Linear,
    /// Evenly in the logarithm; evenly where the lower bound is not above zero.
    Log,
}

impl Bounds {
    /// Bounds, low and high of each coordinate.
    ///
    /// # Errors
    /// [`BoundsError`] unless every side is finite and longer than nothing.
    pub fn new(sides: Vec<[f64; 2]>) -> Result<Self, BoundsError> {
        if sides.is_empty() {
            return Err(BoundsError::Empty);
        }
        let wrong = sides.iter().position(|[low, high]| !(low.is_finite() && high.is_finite() && low < high));
        match wrong {
            Some(at) => Err(BoundsError::NoRange { coordinate: at + 1, low: sides[at][0], high: sides[at][1] }),
            None => Ok(Self { sides }),
        }
    }

    /// Number of coordinates.
    #[must_use]
    pub fn size(&self) -> usize {
        self.sides.len()
    }

    /// The sides.
    #[must_use]
    pub fn sides(&self) -> &[[f64; 2]] {
        &self.sides
    }

    /// Whether a point lies within them.
    #[must_use]
    pub fn hold(&self, point: &[f64]) -> bool {
        self.sides.iter().zip(point).all(|([low, high], x)| (*low..=*high).contains(x))
    }

    /// The point at these shares of the sides; shares beyond an end are at that end.
    #[must_use]
    pub fn at(&self, shares: &[f64]) -> Vec<f64> {
        self.sides
            .iter()
            .zip(shares)
            .map(|([low, high], share)| (low + share * (high - low)).clamp(*low, *high))
            .collect()
    }

    /// The shares of the sides at which a point lies.
    #[must_use]
    pub fn shares(&self, point: &[f64]) -> Vec<f64> {
        self.sides.iter().zip(point).map(|([low, high], x)| ((x - low) / (high - low)).clamp(0.0, 1.0)).collect()
    }

    /// Points along a side, both ends among them (one point: its middle).
    #[must_use]
    pub fn along(&self, side: usize, count: usize, spacing: Spacing) -> Vec<f64> {
        let [low, high] = self.sides[side];
        let share = |i: usize| if count < 2 { 0.5 } else { i as f64 / (count - 1) as f64 };
        let point = |i: usize| match spacing {
            Spacing::Log if low > 0.0 => {
                let (from, to) = (libm::log(low), libm::log(high));
                libm::exp(from + share(i) * (to - from)).clamp(low, high)
            }
            _ => (low + share(i) * (high - low)).clamp(low, high),
        };
        (0..count).map(point).collect()
    }
}
