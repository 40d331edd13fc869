//! What is solved once for a system, whatever its gaps and the size of its drive: an ensemble takes it from here.

use std::cell::OnceCell;

use crate::arithmetic::cholesky::Cholesky;
use crate::arithmetic::matrix::Matrix;
use crate::error::EngineError;
use crate::system::HybridSystem;

/// Share of M that rounding may take off a matrix of springs or dashpots.
const ROUNDING: f64 = 1e-9;

/// What bounds on the energy of a run take from its system.
#[derive(Default)]
pub(crate) struct Ground {
    answer: OnceCell<Vec<f64>>,
    stiffness: OnceCell<Option<Cholesky>>,
    sag: OnceCell<Option<Sag>>,
    takes: OnceCell<bool>,
}

/// What the weights of all particles do to a structure at rest.
pub(crate) struct Sag {
    /// Σ mg φ_f.
    pub(crate) weights: Vec<f64>,
    /// How far they sink it.
    pub(crate) places: Vec<f64>,
}

impl Ground {
    /// M⁻¹b: what a unit impulse does to q′.
    pub(crate) fn answer(&self, system: &HybridSystem) -> Result<&[f64], EngineError> {
        if let Some(answer) = self.answer.get() {
            return Ok(answer);
        }
        let answer = Cholesky::new(&system.mass)?.solve(&system.force_row);
        Ok(self.answer.get_or_init(|| answer))
    }

    /// The factor of K, where it holds up any load.
    pub(crate) fn stiffness(&self, system: &HybridSystem) -> Option<&Cholesky> {
        self.stiffness.get_or_init(|| Cholesky::new(&system.stiffness).ok()).as_ref()
    }

    pub(crate) fn sag(&self, system: &HybridSystem) -> Option<&Sag> {
        let sag = || {
            let mut weights = vec![0.0; system.mass.order];
            for particle in &system.particles {
                let weight = particle.mass * system.gravity;
                weights.iter_mut().zip(&particle.floor.row).for_each(|(sum, phi)| *sum += weight * phi);
            }
            let places = self.stiffness(system)?.solve(&weights);
            Some(Sag { weights, places })
        };
        self.sag.get_or_init(sag).as_ref()
    }

    /// Neither springs nor dashpots of the structure give energy.
    pub(crate) fn takes(&self, system: &HybridSystem) -> bool {
        *self.takes.get_or_init(|| {
            // Nothing holds up a structure without springs that carries weights.
            let springs = if system.gravity > 0.0 {
                self.stiffness(system).is_some()
            } else {
                system.gravity == 0.0 && takes(&system.stiffness, &system.mass)
            };
            springs && takes(&system.damping, &system.mass)
        })
    }
}

/// No motion gains energy from such springs or dashpots: with a rounding of themselves as a share of M they are positive.
fn takes(matrix: &Matrix, mass: &Matrix) -> bool {
    let trace = |matrix: &Matrix| (0..matrix.order).map(|i| matrix.at(i, i)).sum::<f64>();
    let rounding = ROUNDING * trace(matrix) / trace(mass);
    if rounding == 0.0 {
        return matrix.entries.iter().all(|entry| *entry == 0.0);
    }
    let entries = matrix.entries.iter().zip(&mass.entries).map(|(own, mass)| own + rounding * mass).collect();
    Cholesky::new(&Matrix { order: matrix.order, entries }).is_ok()
}
