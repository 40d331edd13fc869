//! One mass on a spring and a dashpot: m x″ + c x′ + k x = F, with c′ = c/(2 √(k m)).

use super::kind::{Field, Form, Kind};
use super::model::{Matrices, Model, Point, unit};
use crate::dynamics::Matrix;
use crate::text::number::quantity;

/// One mass.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SingleMass {
    /// m, kg.
    pub mass: f64,
    /// k, N/m.
    pub stiffness: f64,
    /// c, N s/m.
    pub damping: f64,
}

pub(super) const KIND: Kind = Kind {
    name: "single_mass",
    what: "a single mass",
    fields: &[
        Field { key: "mass", form: Form::Mass, swept: false },
        Field { key: "stiffness", form: Form::Stiffness, swept: false },
        Field { key: "damping_ratio", form: Form::Ratio, swept: true },
    ],
    sides: &[],
    performance_point: Some(&[]),
    build: |values| {
        let (mass, stiffness) = (values.above_zero("mass")?, values.ratio("stiffness")?);
        let damping_ratio = values.ratio("damping_ratio")?;
        Ok(SingleMass { mass, stiffness, damping: 2.0 * damping_ratio * (stiffness * mass).sqrt() }.into())
    },
};

impl Model for SingleMass {
    fn total_mass(&self) -> f64 {
        self.mass
    }

    fn modal_mass(&self) -> f64 {
        self.mass
    }

    fn matrices(&self) -> Matrices {
        let one = |x: f64| Matrix::diagonal(&[x]);
        Matrices { mass: one(self.mass), damping: one(self.damping), stiffness: one(self.stiffness) }
    }

    fn shape(&self, _: Point) -> Vec<f64> {
        vec![1.0]
    }

    fn sides(&self) -> Vec<f64> {
        Vec::new()
    }

    fn natural_frequencies(&self) -> Vec<f64> {
        vec![(self.stiffness / self.mass).sqrt()]
    }

    fn mode(&self, number: usize) -> Vec<f64> {
        unit(1, number)
    }

    fn exact_frequency(&self, number: usize) -> Option<f64> {
        (number == 1).then(|| (self.stiffness / self.mass).sqrt())
    }

    fn exact_shape(&self, number: usize, _: Point) -> Option<f64> {
        (number == 1).then_some(1.0)
    }

    fn describe(&self) -> String {
        let value = |x, unit| quantity(x, unit, 5);
        format!(
            "one mass: {}, {}, {}",
            value(self.mass, "kg"),
            value(self.stiffness, "N/m"),
            value(self.damping, "N s/m")
        )
    }
}
