//! Integrals of a motion over a stretch of time, from which means and RMS values are read.

/// Integrals over half of the averaged window.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Sums {
    /// s.
    pub duration: f64,
    /// ∫ x dt.
    pub displacement: f64,
    /// ∫ (x − x̄)² dt, x̄ the mean: about zero a motion far from it would lose its digits.
    pub deviation_square: f64,
    /// ∫ v² dt.
    pub velocity_square: f64,
}

impl Sums {
    /// The same over both stretches.
    pub(crate) fn add(&mut self, more: Self) {
        let duration = self.duration + more.duration;
        if self.duration > 0.0 && more.duration > 0.0 {
            let apart = more.displacement / more.duration - self.displacement / self.duration;
            self.deviation_square += apart * apart * (self.duration * (more.duration / duration));
        }
        self.duration = duration;
        self.displacement += more.displacement;
        self.deviation_square += more.deviation_square;
        self.velocity_square += more.velocity_square;
    }

    /// Of raw sums, about zero.
    pub(crate) fn of_raw(duration: f64, displacement: f64, square: f64, velocity_square: f64) -> Self {
        let deviation_square = (square - displacement * (displacement / duration)).max(0.0);
        Self { duration, displacement, deviation_square, velocity_square }
    }

    /// RMS velocity, m/s.
    #[must_use]
    pub fn rms_velocity(&self) -> f64 {
        (self.velocity_square / self.duration).sqrt()
    }

    /// Mean displacement, m.
    #[must_use]
    pub fn mean_displacement(&self) -> f64 {
        self.displacement / self.duration
    }

    /// Standard deviation of the displacement, m.
    #[must_use]
    pub fn std_displacement(&self) -> f64 {
        (self.deviation_square / self.duration).sqrt()
    }
}
