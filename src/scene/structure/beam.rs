//! What uniform Euler-Bernoulli beams share: section and material, ρA w″ + EI w⁗ = 0 with ω = β² √(EI/(ρA L⁴)).

use std::f64::consts::PI;

use super::kind::{Field, Form, StructureError, Values};
use super::model::Matrices;
use crate::text::number::{compact, quantity};

/// Most exact modes: their shapes are right to rounding far beyond, but no motion has ever needed as many.
pub(super) const MOST_MODES: u32 = 256;
/// Why not more.
pub(super) const WHY: &str = "no response on record needs them, and the cost grows with the square";

/// A uniform beam of rectangular section, whatever holds its ends.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Beam {
    /// L, m.
    pub length: f64,
    /// m.
    pub width: f64,
    /// m.
    pub thickness: f64,
    /// E, Pa.
    pub youngs_modulus: f64,
    /// ρ, kg/m³.
    pub density: f64,
    /// λ in C = λ (M + K).
    pub rayleigh: f64,
}

/// Keys of every beam.
pub(super) const FIELDS: [Field; 7] = [
    Field { key: "length", form: Form::Length, swept: true },
    Field { key: "width", form: Form::Length, swept: true },
    Field { key: "thickness", form: Form::Length, swept: true },
    Field { key: "youngs_modulus", form: Form::Stress, swept: false },
    Field { key: "density", form: Form::Density, swept: false },
    Field { key: "rayleigh", form: Form::Ratio, swept: true },
    Field { key: "modes", form: Form::Modes, swept: true },
];

impl Beam {
    pub(super) fn read(values: &Values<'_>) -> Result<Self, StructureError> {
        Ok(Self {
            length: values.above_zero("length")?,
            width: values.above_zero("width")?,
            thickness: values.above_zero("thickness")?,
            youngs_modulus: values.above_zero("youngs_modulus")?,
            density: values.above_zero("density")?,
            rayleigh: values.ratio("rayleigh")?,
        })
    }

    /// ρ A L, kg.
    pub(super) fn mass(&self) -> f64 {
        self.density * self.width * self.thickness * self.length
    }

    /// ω of the wave number β/L, rad/s.
    pub(super) fn frequency(&self, beta: f64) -> f64 {
        // I/A of a rectangle: h²/12.
        let speed = self.thickness * (self.youngs_modulus / (12.0 * self.density)).sqrt();
        beta * beta * speed / (self.length * self.length)
    }

    pub(super) fn matrices(&self, natural_frequencies: &[f64]) -> Matrices {
        Matrices::modal(self.mass(), natural_frequencies, self.rayleigh)
    }

    pub(super) fn describe(&self, what: &str, modes: &str) -> String {
        let value = |x, unit| quantity(x, unit, 5);
        format!(
            "{what}: {} by {} by {}, {}, {}, λ = {}, {modes}",
            value(self.length, "m"),
            value(self.width, "m"),
            value(self.thickness, "m"),
            value(self.youngs_modulus, "Pa"),
            value(self.density, "kg/m³"),
            compact(self.rayleigh, 5),
        )
    }
}

/// What holds the far end of a beam whose near end is clamped.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum FarEnd {
    Free,
    Clamped,
}

/// A mode of the continuous beam, its hyperbolic functions combined into decaying exponentials: right at any number.
///
/// cos β cosh β = e with e = −1 where the far end is free and 1 where it is clamped.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Mode {
    pub(super) beta: f64,
    /// Weight of e^(−βξ), of e^(β(ξ−1)), and σ.
    near: f64,
    far: f64,
    sigma: f64,
}

impl Mode {
    /// Mode `n`, from 1.
    pub(super) fn new(n: usize, end: FarEnd) -> Self {
        let (e, half_turns) = match end {
            FarEnd::Free => (-1.0, n as f64 - 0.5),
            FarEnd::Clamped => (1.0, n as f64 + 0.5),
        };
        // β = c + δ with cos c = 0, so that sin δ = ±1/cosh β: a fixed point that contracts by e^(−β).
        let centre = half_turns * PI;
        let sign = if n % 2 == 1 { 1.0 } else { -1.0 };
        let mut delta = 0.0;
        for _ in 0..200 {
            let next = libm::asin(sign / libm::cosh(centre + delta));
            if next == delta {
                break;
            }
            delta = next;
        }
        let beta = centre + delta;
        let (sine, cosine) = (-e * sign * libm::cos(delta), e * sign * libm::sin(delta));
        let small = libm::exp(-beta);
        let denominator = 1.0 - small * small - e * 2.0 * small * sine;
        // ½(1 − σ) e^β and ½(1 + σ), with e^β taken out of σ's quotient.
        Self {
            beta,
            near: (1.0 - e * small * (sine + cosine)) / denominator,
            far: (e * (cosine - sine) - small) / denominator,
            sigma: (1.0 + small * small - e * 2.0 * small * cosine) / denominator,
        }
    }

    /// Its shape at ξ = x/L.
    pub(super) fn at(&self, xi: f64) -> f64 {
        let (sine, cosine) = (libm::sin(self.beta * xi), libm::cos(self.beta * xi));
        self.near * libm::exp(-self.beta * xi) + self.far * libm::exp(self.beta * (xi - 1.0)) - cosine
            + self.sigma * sine
    }
}
