//! Beam clamped at both ends; the study has none.
//!
//! cos β cosh β = 1 and, with ξ = x/L (Blevins, Formulas for Natural Frequency and Mode Shape),
//!
//! φ = cosh βξ − cos βξ − σ (sinh βξ − sin βξ),   σ = (cosh β − cos β)/(sinh β − sin β),   ∫ φ² dξ = 1.

use std::f64::consts::PI;

use super::beam::{self, Beam};
use super::kind::{Family, Kind};
use super::model::{Matrices, Model, Point, unit};

/// A clamped beam in its own modes.
#[derive(Debug, Clone, PartialEq)]
pub struct ClampedBeam {
    beam: Beam,
    modes: Vec<Mode>,
}

pub(super) const KIND: Kind = Kind {
    name: "clamped_beam",
    what: "a beam clamped at both ends",
    family: Family::Beam,
    fields: &beam::FIELDS,
    sides: &["length"],
    performance_point: Some(&[0.5]),
    build: |values| {
        let [count] = values.modes(beam::MOST_MODES, beam::WHY)?;
        Ok(ClampedBeam { beam: Beam::read(values)?, modes: (1..=count as usize).map(Mode::new).collect() }.into())
    },
};

impl Model for ClampedBeam {
    fn total_mass(&self) -> f64 {
        self.beam.mass()
    }

    fn modal_mass(&self) -> f64 {
        // The first mode is largest in the middle.
        let middle = Mode::new(1).at(0.5);
        self.beam.mass() / (middle * middle)
    }

    fn matrices(&self) -> Matrices {
        self.beam.matrices(&self.natural_frequencies())
    }

    fn shape(&self, at: Point) -> Vec<f64> {
        self.modes.iter().map(|mode| mode.at(at.x / self.beam.length)).collect()
    }

    fn sides(&self) -> Vec<f64> {
        vec![self.beam.length]
    }

    fn natural_frequencies(&self) -> Vec<f64> {
        self.modes.iter().map(|mode| self.beam.frequency(mode.beta)).collect()
    }

    fn mode(&self, number: usize) -> Vec<f64> {
        unit(self.modes.len(), number)
    }

    fn exact_frequency(&self, number: usize) -> Option<f64> {
        (number > 0).then(|| self.beam.frequency(Mode::new(number).beta))
    }

    fn exact_shape(&self, number: usize, at: Point) -> Option<f64> {
        (number > 0).then(|| Mode::new(number).at(at.x / self.beam.length))
    }

    fn told(&self) -> String {
        self.beam.told("beam clamped at both ends", &format!("{} exact modes", self.modes.len()))
    }
}

/// A mode, its hyperbolic functions combined into decaying exponentials.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Mode {
    beta: f64,
    near: f64,
    far: f64,
    sigma: f64,
}

impl Mode {
    fn new(n: usize) -> Self {
        // cos((n + ½)π + δ) = (−1)^(n+1) sin δ.
        let sign = if n % 2 == 1 { 1.0 } else { -1.0 };
        let centre = (n as f64 + 0.5) * PI;
        let mut delta = 0.0;
        for _ in 0..200 {
            let next = libm::asin(sign / libm::cosh(centre + delta));
            if next == delta {
                break;
            }
            delta = next;
        }
        let beta = centre + delta;
        let (sine, cosine) = (-sign * libm::cos(delta), sign * libm::sin(delta));
        let small = libm::exp(-beta);
        let denominator = 1.0 - small * small - 2.0 * small * sine;
        Self {
            beta,
            near: (1.0 - small * (sine + cosine)) / denominator,
            far: (cosine - sine - small) / denominator,
            sigma: (1.0 + small * small - 2.0 * small * cosine) / denominator,
        }
    }

    fn at(&self, xi: f64) -> f64 {
        let (sine, cosine) = (libm::sin(self.beta * xi), libm::cos(self.beta * xi));
        self.near * libm::exp(-self.beta * xi) + self.far * libm::exp(self.beta * (xi - 1.0)) - cosine
            + self.sigma * sine
    }
}
