//! A contact state without its dashpots: masses and springs, which all its dampings share.
//!
//! Half cycles put one damping after another on the same springs, and each of them is split by the normal modes that it has without:
//! only the dashpots are new.

use std::cell::OnceCell;
use std::rc::Rc;

use crate::arithmetic::cholesky::Cholesky;
use crate::arithmetic::matrix::{Matrix, dot};
use crate::contact_state::damped;
use crate::contact_state::load::Load;
use crate::contact_state::rigid::RigidMotions;
use crate::contact_state::spectral::Spectral;
use crate::contact_state::undamped::NormalModes;
use crate::error::EngineError;
use crate::system::{Contact, Face, HybridSystem};

/// Coordinates up to which normal modes are worth their price.
const MOST_COORDINATES: usize = 48;

/// Masses and springs of a contact state.
pub(crate) struct Conservative {
    /// Particles that press into a resilient face: their compressions are the coordinates behind the structure's.
    pub(crate) attached: Vec<usize>,
    /// Factors of the structure's masses, with those that it carries.
    pub(crate) carried: Cholesky,
    /// Mass matrix of p.
    pub(crate) mass: Matrix,
    normal: OnceCell<Option<Normal>>,
}

/// Normal modes, of modal mass 1, and the structure's own damping in them.
pub(crate) struct Normal {
    pub(crate) modes: NormalModes,
    damping: Vec<f64>,
    /// What the modes compress each attached particle's face by.
    compressions: Vec<Vec<f64>>,
    /// The damping by dashpots of 1 N s/m at all of them: half cycles set all at once.
    unit_dashpots: Vec<f64>,
    /// Answer to gravity, once it is known.
    pub(crate) gravity: OnceCell<Rc<Load>>,
}

impl Conservative {
    pub(crate) fn new(system: &HybridSystem, contacts: &[Contact]) -> Result<Self, EngineError> {
        let attached: Vec<usize> = (0..contacts.len()).filter(|&j| contacts[j].presses(&system.particles[j])).collect();
        let mass = carried_mass(system, contacts);
        Ok(Self {
            carried: Cholesky::new(&mass)?,
            mass: mass_of(system, contacts, &mass, &attached),
            attached,
            normal: OnceCell::new(),
        })
    }

    /// Its normal modes: none where a rigid-body motion has no spring, where springs are between particles and second faces, and of
    /// many coordinates.
    pub(crate) fn normal(&self, system: &HybridSystem, contacts: &[Contact]) -> Option<&Normal> {
        let build = || {
            if self.mass.order > MOST_COORDINATES || contacts.iter().any(|contact| contact.is_between()) {
                return None;
            }
            let stiffness = stiffness(system, contacts, &self.attached);
            if RigidMotions::are_left_by(&stiffness) {
                return None;
            }
            let modes = NormalModes::new(&stiffness, &self.mass)?;
            let n = system.damping.order;
            let damped: Vec<Vec<f64>> = modes.shapes.iter().map(|shape| system.damping.times(&shape[..n])).collect();
            let weights = |i: usize, j: usize| modes.omega[i] * modes.omega[j];
            let entry = |i: usize, j: usize| weights(i, j) * dot(&modes.shapes[i][..n], &damped[j]);
            let order = modes.omega.len();
            let damping = (0..order * order).map(|at| (at / order, at % order));
            let damping = damping.map(|(i, j)| if i < j { entry(j, i) } else { entry(i, j) }).collect();
            let each = || modes.shapes.iter().zip(&modes.omega);
            let compression = |place: usize| each().map(|(shape, omega)| omega * shape[place]).collect();
            let compressions: Vec<Vec<f64>> = (n..order).map(compression).collect();
            let mut unit_dashpots = vec![0.0; order * order];
            compressions.iter().for_each(|row| add_square(&mut unit_dashpots, 1.0, row));
            Some(Normal { modes, damping, compressions, unit_dashpots, gravity: OnceCell::new() })
        };
        self.normal.get_or_init(build).as_ref()
    }

    /// The blocks of (p, p′) under dashpots, where they come from normal modes, in the `room` of others.
    pub(crate) fn split(
        &self,
        system: &HybridSystem,
        contacts: &[Contact],
        damping: &[f64],
        room: Spectral,
    ) -> Option<Spectral> {
        if self.mass.order == 1 {
            // It is a block as it stands.
            return None;
        }
        let Normal { modes, damping: structural, compressions, unit_dashpots, .. } = self.normal(system, contacts)?;
        let mut all = structural.clone();
        let first = self.attached.first().map_or(0.0, |&j| damping[j]);
        if self.attached.iter().all(|&j| damping[j] == first) {
            all.iter_mut().zip(unit_dashpots).for_each(|(entry, dashpots)| *entry += first * dashpots);
        } else {
            self.attached.iter().zip(compressions).for_each(|(&j, row)| add_square(&mut all, damping[j], row));
        }
        // Without any dashpot no energy is lost, to the bit: see `modes`.
        if all.iter().all(|entry| *entry == 0.0) { None } else { damped::split(modes, &all, room) }
    }
}

/// A dashpot along this row, added to a damping matrix.
fn add_square(matrix: &mut [f64], damping: f64, row: &[f64]) {
    for (entries, x) in matrix.chunks_exact_mut(row.len()).zip(row) {
        entries.iter_mut().zip(row).for_each(|(entry, y)| *entry += damping * (x * y));
    }
}

/// The face that an attached particle presses into.
pub(crate) fn face_of<'a>(system: &'a HybridSystem, contacts: &[Contact], j: usize) -> &'a Face {
    contacts[j].face(&system.particles[j]).expect("a pressing particle has a face")
}

/// M + Σ mp φ φᵀ over the particles that a face holds.
pub(crate) fn carried_mass(system: &HybridSystem, contacts: &[Contact]) -> Matrix {
    let mut mass = system.mass.clone();
    for (particle, contact) in system.particles.iter().zip(contacts) {
        if let (true, Some(face)) = (contact.holds(particle), contact.face(particle)) {
            mass.add_square(particle.mass, &face.row);
        }
    }
    mass
}

/// Mass matrix of p = (q, w): each particle in contact moves with φ·q + w.
fn mass_of(system: &HybridSystem, contacts: &[Contact], carried: &Matrix, attached: &[usize]) -> Matrix {
    let n = carried.order;
    let mut mass = carried.padded(n + attached.len());
    for (slot, &j) in attached.iter().enumerate() {
        let mut row = face_of(system, contacts, j).row.clone();
        row.resize(mass.order, 0.0);
        row[n + slot] = 1.0;
        mass.add_square(system.particles[j].mass, &row);
    }
    mass
}

/// Stiffness matrix of p: a coordinate of its own for the spring of every face.
pub(crate) fn stiffness(system: &HybridSystem, contacts: &[Contact], attached: &[usize]) -> Matrix {
    let mut all = system.stiffness.padded(system.stiffness.order + attached.len());
    let springs = attached.iter().map(|&j| face_of(system, contacts, j).law.stiffness().unwrap_or(0.0));
    let diagonal = all.entries.iter_mut().step_by(all.order + 1).skip(system.stiffness.order);
    diagonal.zip(springs).for_each(|(entry, spring)| *entry = spring);
    all
}
