//! What an impact meets: the structure's answer to a unit impulse at a face.
//!
//! It depends on the face alone, so it is computed at the first impact there and kept.

use std::rc::Rc;

use crate::arithmetic::cholesky::Cholesky;
use crate::contact::Side;
use crate::error::EngineError;
use crate::system::HybridSystem;

/// The answers found so far.
#[derive(Default)]
pub(crate) struct Mobilities {
    factor: Option<Cholesky>,
    known: Vec<Mobility>,
}

/// The answer at one face.
struct Mobility {
    particle: usize,
    side: Side,
    /// M⁻¹φ.
    answer: Rc<[f64]>,
}

impl Mobilities {
    /// Finds the answer at a face, to be read with [`Mobilities::answer`].
    pub(crate) fn find(&mut self, system: &HybridSystem, particle: usize, side: Side) -> Result<usize, EngineError> {
        if let Some(index) = self.known.iter().position(|known| known.particle == particle && known.side == side) {
            return Ok(index);
        }
        let factor = match &mut self.factor {
            Some(factor) => factor,
            none => none.insert(Cholesky::new(&system.mass)?),
        };
        let answer = factor.solve(&side.face(&system.particles[particle]).row).into();
        self.known.push(Mobility { particle, side, answer });
        Ok(self.known.len() - 1)
    }

    /// M⁻¹φ.
    pub(crate) fn answer(&self, index: usize) -> &Rc<[f64]> {
        &self.known[index].answer
    }
}
