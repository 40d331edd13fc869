//! Plate simply supported along all four sides (Leissa, Vibration of Plates, 1969).
//!
//! φ_mn = 2 sin(m π x/Lx) sin(n π y/Ly),   ω_mn = π² (m²/Lx² + n²/Ly²) √(D/(ρ h)),   D = E h³/(12 (1 − ν²)).
//!
//! They are the plate's own modes. x runs along the width, y along the length.

use std::f64::consts::PI;

use super::kind::{Field, Form, Kind, StructureError};
use super::model::{Matrices, Model, Point, unit};
use crate::text::number::{compact, quantity};

/// Most modes.
const MOST_MODES: u32 = 400;

/// A plate in its own modes.
#[derive(Debug, Clone, PartialEq)]
pub struct SupportedPlate {
    width: f64,
    length: f64,
    thickness: f64,
    youngs_modulus: f64,
    poisson_ratio: f64,
    density: f64,
    rayleigh: f64,
    /// Half waves (m, n) of each mode, slowest first.
    modes: Vec<[u32; 2]>,
}

pub(super) const KIND: Kind = Kind {
    name: "supported_plate",
    what: "a simply supported plate",
    fields: &[
        Field { key: "length", form: Form::Length, swept: true },
        Field { key: "width", form: Form::Length, swept: true },
        Field { key: "thickness", form: Form::Length, swept: true },
        Field { key: "youngs_modulus", form: Form::Stress, swept: false },
        Field { key: "poisson_ratio", form: Form::Ratio, swept: false },
        Field { key: "density", form: Form::Density, swept: false },
        Field { key: "rayleigh", form: Form::Ratio, swept: true },
        Field { key: "modes", form: Form::Modes, swept: true },
    ],
    sides: &["width", "length"],
    performance_point: None,
    build: |values| {
        let why = "no response on record needs them, and the cost grows with the square";
        let [m, n] = values.modes(MOST_MODES, why)?;
        let poisson_ratio = values.ratio("poisson_ratio")?;
        if poisson_ratio > 0.5 {
            let message = format!("poisson_ratio lies between 0 and 0.5, not at {poisson_ratio}");
            return Err(StructureError::of("poisson_ratio", message));
        }
        let mut plate = SupportedPlate {
            width: values.above_zero("width")?,
            length: values.above_zero("length")?,
            thickness: values.above_zero("thickness")?,
            youngs_modulus: values.above_zero("youngs_modulus")?,
            poisson_ratio,
            density: values.above_zero("density")?,
            rayleigh: values.ratio("rayleigh")?,
            modes: Vec::new(),
        };
        let mut modes: Vec<[u32; 2]> = (1..=m).flat_map(|m| (1..=n).map(move |n| [m, n])).collect();
        modes.sort_by(|a, b| plate.frequency(*a).total_cmp(&plate.frequency(*b)));
        plate.modes = modes;
        Ok(plate.into())
    },
};

impl SupportedPlate {
    fn frequency(&self, [m, n]: [u32; 2]) -> f64 {
        let square = |count: u32, side: f64| (f64::from(count) / side) * (f64::from(count) / side);
        // D/(ρ h) = E h²/(12 ρ (1 − ν²)).
        let speed = self.thickness
            * (self.youngs_modulus / (12.0 * self.density * (1.0 - self.poisson_ratio * self.poisson_ratio))).sqrt();
        PI * PI * (square(m, self.width) + square(n, self.length)) * speed
    }

    fn mass(&self) -> f64 {
        self.density * self.thickness * self.width * self.length
    }

    fn at(&self, [m, n]: [u32; 2], at: Point) -> f64 {
        let half_waves = |count: u32, share: f64| libm::sin(f64::from(count) * PI * share);
        2.0 * half_waves(m, at.x / self.width) * half_waves(n, at.y / self.length)
    }

    /// Half waves of a mode of the continuous plate, from 1.
    fn half_waves(&self, number: usize) -> Option<[u32; 2]> {
        // Below the frequency of (number, 1) and of (1, number) there are `number` modes at least.
        let most = u32::try_from(number).ok().filter(|number| (1..=2000).contains(number))?;
        let mut all: Vec<[u32; 2]> =
            (1..=most).flat_map(|m| (1..=most.div_ceil(m)).map(move |n| [m, n])).collect();
        all.sort_by(|a, b| self.frequency(*a).total_cmp(&self.frequency(*b)));
        all.get(number - 1).copied()
    }
}

impl Model for SupportedPlate {
    fn total_mass(&self) -> f64 {
        self.mass()
    }

    /// ∫ φ² dm = m where the largest |φ| is 2.
    fn modal_mass(&self) -> f64 {
        0.25 * self.mass()
    }

    fn matrices(&self) -> Matrices {
        Matrices::modal(self.mass(), &self.natural_frequencies(), self.rayleigh)
    }

    fn shape(&self, at: Point) -> Vec<f64> {
        self.modes.iter().map(|mode| self.at(*mode, at)).collect()
    }

    fn sides(&self) -> Vec<f64> {
        vec![self.width, self.length]
    }

    fn natural_frequencies(&self) -> Vec<f64> {
        self.modes.iter().map(|mode| self.frequency(*mode)).collect()
    }

    fn mode(&self, number: usize) -> Vec<f64> {
        unit(self.modes.len(), number)
    }

    fn exact_frequency(&self, number: usize) -> Option<f64> {
        self.half_waves(number).map(|mode| self.frequency(mode))
    }

    fn exact_shape(&self, number: usize, at: Point) -> Option<f64> {
        self.half_waves(number).map(|mode| self.at(mode, at))
    }

    fn describe(&self) -> String {
        let value = |x, unit| quantity(x, unit, 5);
        format!(
            "simply supported plate: {} by {} by {}, {}, ν = {}, {}, λ = {}, {} modes",
            value(self.length, "m"),
            value(self.width, "m"),
            value(self.thickness, "m"),
            value(self.youngs_modulus, "Pa"),
            compact(self.poisson_ratio, 5),
            value(self.density, "kg/m³"),
            compact(self.rayleigh, 5),
            self.modes.len(),
        )
    }
}
