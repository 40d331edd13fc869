//! Cantilever: clamped at x = 0, free at x = L.
//!
//! Exact modes (Blevins, Formulas for Natural Frequency and Mode Shape): cos β cosh β = −1 and, with ξ = x/L,
//!
//! φ = cosh βξ − cos βξ − σ (sinh βξ − sin βξ),   σ = (cosh β + cos β)/(sinh β + sin β),   ∫ φ² dξ = 1.
//!
//! The hyperbolic functions are combined into decaying exponentials, so that nothing overflows or cancels, and β is kept as
//! (n − ½)π + δ. The basis ξ^(i+1), i = 1 … N, is [`super::polynomial`].

use super::beam::{self, Beam, FarEnd, Mode};
use super::kind::{Field, Form, Kind};
use super::model::{Matrices, Model, Point, unit};
use super::polynomial;
use crate::text::words::counted;

const BASES: &[&str] = &["polynomial", "exact"];

/// A cantilever in its own modes.
#[derive(Debug, Clone, PartialEq)]
pub struct CantileverBeam {
    beam: Beam,
    basis: Basis,
}

/// How its modes are spanned.
#[derive(Debug, Clone, PartialEq)]
enum Basis {
    /// Rayleigh-Ritz in ξ², … ξ^(N+1).
    Polynomial(Vec<polynomial::Mode>),
    /// The continuous beam's.
    Exact(Vec<Mode>),
}

pub(super) const KIND: Kind = Kind {
    name: "cantilever_beam",
    what: "a cantilever beam",
    fields: &{
        let [a, b, c, d, e, f, g] = beam::FIELDS;
        [a, b, c, d, e, f, g, Field { key: "basis", form: Form::Word(BASES), swept: false }]
    },
    sides: &["length"],
    performance_point: Some(&[1.0]),
    build: |values| {
        let beam = Beam::read(values)?;
        let basis = if values.word("basis", BASES)? == 0 {
            let why = "the upper third of so many polynomials vibrates far faster than any mode of the beam, and the \
                       search for events pays for it; `basis: exact` goes on";
            let [count] = values.modes(polynomial::MOST as u32, why)?;
            Basis::Polynomial(polynomial::modes(count as usize))
        } else {
            let [count] = values.modes(beam::MOST_MODES, beam::WHY)?;
            Basis::Exact((1..=count as usize).map(|n| Mode::new(n, FarEnd::Free)).collect())
        };
        Ok(CantileverBeam { beam, basis }.into())
    },
};

impl Model for CantileverBeam {
    fn total_mass(&self) -> f64 {
        self.beam.mass()
    }

    /// ∫ φ² dm = m where |φ(L)| = 2.
    fn modal_mass(&self) -> f64 {
        0.25 * self.beam.mass()
    }

    fn matrices(&self) -> Matrices {
        self.beam.matrices(&self.natural_frequencies())
    }

    fn shape(&self, at: Point) -> Vec<f64> {
        let xi = at.x / self.beam.length;
        match &self.basis {
            Basis::Polynomial(modes) => polynomial::at(modes, xi),
            Basis::Exact(modes) => modes.iter().map(|mode| mode.at(xi)).collect(),
        }
    }

    fn sides(&self) -> Vec<f64> {
        vec![self.beam.length]
    }

    fn natural_frequencies(&self) -> Vec<f64> {
        match &self.basis {
            Basis::Polynomial(modes) => modes.iter().map(|mode| self.beam.frequency(mode.beta)).collect(),
            Basis::Exact(modes) => modes.iter().map(|mode| self.beam.frequency(mode.beta)).collect(),
        }
    }

    fn mode(&self, number: usize) -> Vec<f64> {
        let order = match &self.basis {
            Basis::Polynomial(modes) => modes.len(),
            Basis::Exact(modes) => modes.len(),
        };
        unit(order, number)
    }

    fn exact_frequency(&self, number: usize) -> Option<f64> {
        (number > 0).then(|| self.beam.frequency(Mode::new(number, FarEnd::Free).beta))
    }

    fn exact_shape(&self, number: usize, at: Point) -> Option<f64> {
        (number > 0).then(|| Mode::new(number, FarEnd::Free).at(at.x / self.beam.length))
    }

    fn describe(&self) -> String {
        let modes = match &self.basis {
            Basis::Polynomial(modes) => counted(modes.len(), "mode of polynomials", "modes of polynomials"),
            Basis::Exact(modes) => counted(modes.len(), "exact mode", "exact modes"),
        };
        self.beam.describe("cantilever", &modes)
    }
}
