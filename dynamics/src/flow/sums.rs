//! Integrals of a motion over a stretch of time, from which means and RMS values are read.

/// Share of a mean that dividing by its duration rounds off.
const ROUNDING: f64 = 2.0 * f64::EPSILON;

/// Integrals over a stretch of time: a cycle, half of the averaged window, or all of it.
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

/// Integrals over a part of a stretch, of the displacement about a place that is near enough to the motion.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(crate) struct About {
    /// s.
    pub(crate) duration: f64,
    /// x₀, m.
    pub(crate) place: f64,
    /// ∫ (x − x₀) dt.
    pub(crate) moved: f64,
    /// ∫ (x − x₀)² dt.
    pub(crate) square: f64,
    /// ∫ v² dt.
    pub(crate) velocity_square: f64,
}

impl Sums {
    /// The same over both stretches.
    pub(crate) fn add(&mut self, more: Self) {
        let duration = self.duration + more.duration;
        if self.duration > 0.0 && more.duration > 0.0 {
            let means = [&*self, &more].map(Self::mean_displacement);
            // Two means that are one but for their rounding are not apart.
            let apart =
                if (means[1] - means[0]).abs() <= ROUNDING * means[0].abs() { 0.0 } else { means[1] - means[0] };
            self.deviation_square += apart * apart * (self.duration * (more.duration / duration));
        }
        self.duration = duration;
        self.displacement += more.displacement;
        self.deviation_square += more.deviation_square;
        self.velocity_square += more.velocity_square;
    }

    /// Of parts whose own means need not be known: of what lasts a moment, rounding leaves none.
    pub(crate) fn of(parts: &[About]) -> Self {
        let longer = |a: &&About, b: &&About| a.duration.total_cmp(&b.duration);
        let Some(origin) = parts.iter().max_by(longer).map(|part| part.place) else { return Self::default() };
        let mut sums = Self::default();
        for part in parts {
            sums.duration += part.duration;
            sums.displacement += (part.place - origin) * part.duration + part.moved;
            sums.velocity_square += part.velocity_square;
        }
        if sums.duration > 0.0 {
            let mean = sums.displacement / sums.duration;
            for &About { duration, place, moved, square, .. } in parts {
                let apart = (place - origin) - mean;
                sums.deviation_square += square + apart * (2.0 * moved + apart * duration);
            }
        }
        sums.displacement += origin * sums.duration;
        sums.deviation_square = sums.deviation_square.max(0.0);
        sums
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
