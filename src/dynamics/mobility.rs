//! What an impact meets: the structure's answer to a unit impulse at a face, with what other faces hold as its mass.
//!
//! It depends on the contact state alone, so it is computed at the first impact in that state and kept.

use super::EngineError;
use super::contact::Side;
use super::flow::{Cholesky, carried_mass};
use super::system::{Contact, HybridSystem, dot};

/// The answers found so far.
#[derive(Default)]
pub(crate) struct Mobilities {
    known: Vec<Mobility>,
}

/// The answer at one face in one contact state.
pub(crate) struct Mobility {
    contacts: Vec<Contact>,
    particle: usize,
    side: Side,
    /// M⁻¹φ.
    pub(crate) answer: Vec<f64>,
    /// φ·M⁻¹φ, 1/kg.
    pub(crate) at_face: f64,
}

impl Mobilities {
    /// The answer where particle `j` strikes while `contacts` hold the others; j itself is in flight.
    pub(crate) fn of(
        &mut self,
        system: &HybridSystem,
        contacts: &[Contact],
        j: usize,
        side: Side,
    ) -> Result<&Mobility, EngineError> {
        let same = |known: &Mobility| known.particle == j && known.side == side && known.contacts == contacts;
        let index = match self.known.iter().position(same) {
            Some(index) => index,
            None => {
                let row = &side.face(&system.particles[j]).row;
                let answer = Cholesky::new(&carried_mass(system, contacts))?.solve(row);
                let at_face = dot(row, &answer);
                self.known.push(Mobility { contacts: contacts.to_vec(), particle: j, side, answer, at_face });
                self.known.len() - 1
            }
        };
        Ok(&self.known[index])
    }
}
