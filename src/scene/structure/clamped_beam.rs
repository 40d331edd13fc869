//! Beam clamped at both ends.
//!
//! cos β cosh β = 1 and, with ξ = x/L (Blevins, Formulas for Natural Frequency and Mode Shape),
//!
//! φ = cosh βξ − cos βξ − σ (sinh βξ − sin βξ),   σ = (cosh β − cos β)/(sinh β − sin β),   ∫ φ² dξ = 1.

use super::beam::{self, Beam, FarEnd, Mode};
use super::kind::Kind;
use super::model::{Matrices, Model, Point, unit};
use crate::text::words::counted;

/// A clamped beam in its own modes.
#[derive(Debug, Clone, PartialEq)]
pub struct ClampedBeam {
    beam: Beam,
    modes: Vec<Mode>,
}

pub(super) const KIND: Kind = Kind {
    name: "clamped_beam",
    what: "a beam clamped at both ends",
    fields: &beam::FIELDS,
    sides: &["length"],
    performance_point: Some(&[0.5]),
    build: |values| {
        let [count] = values.modes(beam::MOST_MODES, beam::WHY)?;
        let modes = (1..=count as usize).map(|n| Mode::new(n, FarEnd::Clamped)).collect();
        Ok(ClampedBeam { beam: Beam::read(values)?, modes }.into())
    },
};

impl Model for ClampedBeam {
    fn total_mass(&self) -> f64 {
        self.beam.mass()
    }

    fn modal_mass(&self) -> f64 {
        // The first mode is largest in the middle.
        let middle = Mode::new(1, FarEnd::Clamped).at(0.5);
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
        (number > 0).then(|| self.beam.frequency(Mode::new(number, FarEnd::Clamped).beta))
    }

    fn exact_shape(&self, number: usize, at: Point) -> Option<f64> {
        (number > 0).then(|| Mode::new(number, FarEnd::Clamped).at(at.x / self.beam.length))
    }

    fn describe(&self) -> String {
        self.beam.describe("beam clamped at both ends", &counted(self.modes.len(), "exact mode", "exact modes"))
    }
}
