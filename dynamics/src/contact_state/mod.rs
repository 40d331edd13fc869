//! Modes of one contact state: all of its flow that no drive enters.
//!
//! With the particles in flight taken out (they fall by themselves) and those held by a rigid face counted as mass, a
//! contact state is linear: p = (q, w) with w the compression of every resilient face in contact,
//!
//! q″ = M⁻¹(−K q − C q′ + b F − Σ φ N),   w″ = N/mp − g − φ·q″,   N = −k w − c w′.
//!
//! A particle between two faces that move by themselves feels both: a second spring and dashpot along v = row·p + constant, the
//! distance to the second face ([`Across`]).
//!
//! Its matrix is split into 2 × 2 blocks, from its normal modes ([`damped`]) or else by a Schur form ([`modes`]); forcing and time do not
//! enter, the gap only in the constant of v.

mod alike;
pub(crate) mod bank;
pub(crate) mod block;
mod cluster;
pub(crate) mod conservative;
mod damped;
pub(crate) mod load;
pub(crate) mod modes;
mod resonance;
mod rigid;
mod schur_split;
pub(crate) mod spectral;
mod undamped;

use std::cell::OnceCell;
use std::rc::Rc;

use crate::arithmetic::matrix::{Matrix, dot};
use crate::arithmetic::superposition::Superposition;
use crate::contact::{Hold, Side};
use crate::contact_state::alike::Alike;
use crate::contact_state::conservative::{Conservative, Normal, face_of};
use crate::contact_state::load::{Load, Steady};
use crate::contact_state::spectral::Spectral;
use crate::error::EngineError;
use crate::system::{Contact, HybridSystem, Law, Particle};

/// The second face of a particle that is at both: v is its distance from the particle, negative where it is compressed.
#[derive(Clone)]
pub(crate) struct Across {
    pub(crate) particle: usize,
    /// Its side.
    pub(crate) side: Side,
    /// It pushes; else it was let go.
    pub(crate) presses: bool,
    pub(crate) stiffness: f64,
    pub(crate) damping: f64,
    /// v = row·p + constant.
    pub(crate) row: Vec<f64>,
    pub(crate) constant: f64,
}

impl Across {
    /// The second faces of a contact state; `order` coordinates, of which those behind the structure's belong to `attached`.
    fn all(system: &HybridSystem, contacts: &[Contact], damping: &[f64], attached: &[usize]) -> Vec<Self> {
        let between = (0..contacts.len()).filter(|&j| contacts[j].is_between());
        let of = |(j, [damping, constant]): (usize, &[f64; 2])| {
            let (particle, side) = (&system.particles[j], contacts[j].side().opposite());
            let Law::Resilient { stiffness, .. } = side.face(particle).law else { return None };
            Some(Self {
                particle: j,
                side,
                presses: contacts[j].across() == Hold::Pressed,
                stiffness,
                damping: *damping,
                row: way_across(particle, contacts[j], attached.iter().position(|&a| a == j), attached.len()),
                constant: *constant,
            })
        };
        between.zip(damping[contacts.len()..].as_chunks().0).filter_map(of).collect()
    }

    /// Its force on the particle, upwards, by the coordinates and by their rates: −away (k v + c v′).
    fn force(&self) -> [f64; 2] {
        [self.stiffness, self.damping].map(|size| -self.side.away() * size)
    }
}

/// How the way from a particle to the face across from its own changes with the coordinates.
pub(crate) fn way_across(particle: &Particle, contact: Contact, slot: Option<usize>, slots: usize) -> Vec<f64> {
    let ceiling = particle.ceiling.as_ref().unwrap_or(&particle.floor);
    let mut row: Vec<f64> = ceiling.row.iter().zip(&particle.floor.row).map(|(above, below)| above - below).collect();
    let structure = row.len();
    row.resize(structure + slots, 0.0);
    if let Some(slot) = slot {
        row[structure + slot] = -contact.side().away();
    }
    row
}

/// That way at rest: the gap, and how deep the particle is held in its own face.
pub(crate) fn constant_across(particle: &Particle, contact: Contact) -> f64 {
    particle.gap + if contact.holds(particle) { contact.side().face(particle).law.depth() } else { 0.0 }
}

/// The modes of one contact state.
#[derive(Clone)]
pub(crate) struct Modes {
    /// Contact of each particle, at the floor where the ceiling is alike ([`Contact::at_floor_alike`]).
    pub(crate) contacts: Vec<Contact>,
    /// Contact damping in force as [`dampings`] gives it, N s/m.
    pub(crate) damping: Vec<f64>,
    /// Second faces of the particles that are at both.
    pub(crate) across: Vec<Across>,
    /// Coordinates: those of the structure, then one per resilient contact.
    pub(crate) order: usize,
    /// Which particle the coordinate `structure + i` belongs to.
    pub(crate) attached: Vec<usize>,
    /// Accelerations of p by (p, p′); worked out when they are asked for.
    accelerations: OnceCell<Vec<Vec<f64>>>,
    /// Block coordinates from (p, p′) and back, column by column and row by row.
    pub(crate) spectral: Spectral,
    /// Block coordinates from (p, p′) once more, and back column by column: a segment begins with the one and ends with the other.
    pub(crate) to_blocks: Superposition,
    pub(crate) columns: Superposition,
    /// Answer to gravity.
    pub(crate) gravity: Rc<Load>,
    /// What it would be without dashpots.
    pub(crate) bare: Rc<Conservative>,
    /// It is split by the normal modes of that.
    pub(crate) is_normal: bool,
}

impl Modes {
    /// Of a contact state under these dashpots, in the `room` of one that is not needed any more.
    pub(crate) fn new(
        system: &HybridSystem,
        bare: Rc<Conservative>,
        contacts: &[Contact],
        damping: &[f64],
        room: Option<Self>,
    ) -> Result<Self, EngineError> {
        let (spectral, to_blocks, columns) =
            room.map_or_else(Default::default, |room| (room.spectral, room.to_blocks, room.columns));
        let attached = bare.attached.clone();
        let order = system.mass.order + attached.len();
        let across = Across::all(system, contacts, damping, &attached);
        let normal = bare.split(system, contacts, damping, spectral);
        let mut modes = Self {
            contacts: contacts.to_vec(),
            damping: damping.to_vec(),
            across,
            order,
            attached,
            accelerations: OnceCell::new(),
            to_blocks,
            columns,
            is_normal: normal.is_some(),
            spectral: Spectral::default(),
            gravity: Rc::default(),
            bare,
        };
        modes.spectral = match normal {
            Some(spectral) => spectral,
            None => {
                let accelerations = modes.accelerations(system);
                let mut stiffness = conservative::stiffness(system, contacts, &modes.attached);
                let mut dashpots = system.damping.padded(order);
                for (slot, &j) in modes.attached.iter().enumerate() {
                    dashpots.entries[(system.mass.order + slot) * (order + 1)] = damping[j];
                }
                for across in modes.across.iter().filter(|across| across.presses) {
                    stiffness.add_square(across.stiffness, &across.row);
                    dashpots.add_square(across.damping, &across.row);
                }
                let alike = || Alike::all(system, contacts, damping, &modes.attached);
                modes::split(accelerations, [&modes.bare.mass, &dashpots, &stiffness], alike)?
            }
        };
        let (spectral, width) = (&modes.spectral, modes.spectral.width());
        modes.to_blocks = std::mem::take(&mut modes.to_blocks).of_rows(width, &spectral.to_blocks);
        modes.columns = std::mem::take(&mut modes.columns).of_columns(2 * order, width, &spectral.from_blocks);
        let gravity = || Rc::new(modes.load(system, &modes.falls(system)));
        modes.gravity =
            modes.normal(system).map_or_else(gravity, |normal| Rc::clone(normal.gravity.get_or_init(gravity)));
        Ok(modes)
    }

    /// Which of the attached particles j is.
    pub(crate) fn slot(&self, j: usize) -> Option<usize> {
        self.attached.iter().position(|&attached| attached == j)
    }

    /// The second face of particle j.
    pub(crate) fn across(&self, j: usize) -> Option<&Across> {
        self.across.iter().find(|across| across.particle == j)
    }

    /// Accelerations of p by (p, p′): order rows of 2·order numbers.
    pub(crate) fn accelerations(&self, system: &HybridSystem) -> &[Vec<f64>] {
        self.accelerations.get_or_init(|| accelerations(system, self))
    }

    /// Its answer to a constant load, which alone would give p these accelerations.
    pub(crate) fn load(&self, system: &HybridSystem, load: &[f64]) -> Load {
        match self.normal(system) {
            Some(normal) => Load::still(normal.modes.rest(load), self.spectral.blocks.len()),
            None => Load::new(load, &self.spectral, self.accelerations(system)),
        }
    }

    /// The normal modes that it is split by.
    fn normal(&self, system: &HybridSystem) -> Option<&Normal> {
        if self.is_normal { self.bare.normal(system, &self.contacts) } else { None }
    }

    /// The same with blocks that take in a harmonic drive, where that is in resonance with some of them; and what is steady then.
    pub(crate) fn resonant(&self, system: &HybridSystem, push: &[f64], omega: f64) -> Option<(Self, Steady)> {
        let (spectral, steady) = resonance::split(&self.spectral, self.order, push, omega)?;
        let mut modes = Self {
            to_blocks: Superposition::default().of_rows(spectral.width(), &spectral.to_blocks),
            columns: Superposition::default().of_columns(2 * self.order, spectral.width(), &spectral.from_blocks),
            spectral,
            ..self.clone()
        };
        modes.gravity = Rc::new(modes.load(system, &modes.falls(system)));
        Some((modes, steady))
    }

    /// p″ under a force of this row on the structure, all springs at rest.
    pub(crate) fn answer(&self, system: &HybridSystem, force: &[f64]) -> Vec<f64> {
        let mut answer = self.bare.carried.solve(force);
        for &j in &self.attached {
            let face = face_of(system, &self.contacts, j);
            answer.push(-dot(&face.row, &answer[..force.len()]));
        }
        answer
    }

    /// p″ under gravity, all springs at rest.
    pub(crate) fn falls(&self, system: &HybridSystem) -> Vec<f64> {
        let n = system.mass.order;
        let mut weight = vec![0.0; n];
        for (j, particle) in system.particles.iter().enumerate() {
            if let (true, Some(face)) = (self.contacts[j].holds(particle), self.contacts[j].face(particle)) {
                weight.iter_mut().zip(&face.row).for_each(|(sum, phi)| *sum -= particle.mass * system.gravity * phi);
            }
        }
        for across in self.across.iter().filter(|across| across.presses) {
            let push = across.force()[0] * across.constant;
            let row = pushed(system, &self.contacts, across);
            weight.iter_mut().zip(&row).for_each(|(sum, phi)| *sum += push * phi);
        }
        let mut falls = self.answer(system, &weight);
        falls[n..].iter_mut().for_each(|fall| *fall -= system.gravity);
        for across in self.across.iter().filter(|across| across.presses) {
            if let Some(slot) = self.slot(across.particle) {
                falls[n + slot] += across.force()[0] * across.constant / system.particles[across.particle].mass;
            }
        }
        falls
    }

    /// Numbers that it keeps.
    pub(crate) fn size(&self) -> usize {
        2 * self.order * self.order + 2 * self.to_blocks.size() + 2 * self.columns.size()
    }
}

/// Damping of the face that particle j's contact refers to, N s/m. While the face is compressed, half cycles put another one in its
/// place; a particle in flight, or held, needs no other contact state.
pub(crate) fn contact_damping(system: &HybridSystem, contacts: &[Contact], j: usize, equivalent: Option<f64>) -> f64 {
    let law = contacts[j].side().face(&system.particles[j]).law;
    face_damping(law, equivalent.filter(|_| is_compressed(system, contacts, j)))
}

/// The face that particle j's contact refers to is compressed.
fn is_compressed(system: &HybridSystem, contacts: &[Contact], j: usize) -> bool {
    matches!(contacts[j].at(contacts[j].side(), &system.particles[j]), Hold::Pressed | Hold::Released)
}

/// Some damping of this contact state is that of half cycles, where there are any.
pub(crate) fn feels_half_cycles(system: &HybridSystem, contacts: &[Contact]) -> bool {
    (0..contacts.len()).any(|j| contacts[j].is_between() || is_compressed(system, contacts, j))
}

/// The damping of the face that each particle's contact refers to; then, of those at both faces, that of the second one and the
/// constant of its distance, in which alone the gap enters.
pub(crate) fn dampings(system: &HybridSystem, contacts: &[Contact], equivalent: Option<f64>) -> Vec<f64> {
    let mut all: Vec<f64> = (0..contacts.len()).map(|j| contact_damping(system, contacts, j, equivalent)).collect();
    for (contact, particle) in contacts.iter().zip(&system.particles).filter(|(contact, _)| contact.is_between()) {
        let law = contact.side().opposite().face(particle).law;
        all.extend([face_damping(law, equivalent), constant_across(particle, *contact)]);
    }
    all
}

pub(crate) fn face_damping(law: Law, equivalent: Option<f64>) -> f64 {
    match law {
        Law::Resilient { damping, .. } => equivalent.unwrap_or(damping),
        Law::Rigid { .. } => 0.0,
    }
}

/// Where a second face's force on the particle acts on the structure: at the face itself, and at the one that holds the particle.
fn pushed(system: &HybridSystem, contacts: &[Contact], across: &Across) -> Vec<f64> {
    let (particle, contact) = (&system.particles[across.particle], contacts[across.particle]);
    let mut row: Vec<f64> = across.side.face(particle).row.iter().map(|phi| -phi).collect();
    if let (true, Some(face)) = (contact.holds(particle), contact.face(particle)) {
        row.iter_mut().zip(&face.row).for_each(|(sum, phi)| *sum += phi);
    }
    row
}

/// Accelerations of p by (p, p′): order rows of 2·order numbers.
fn accelerations(system: &HybridSystem, modes: &Modes) -> Vec<Vec<f64>> {
    let Modes { contacts, damping, across, attached, .. } = modes;
    let (n, order, solve) = (system.mass.order, modes.order, &modes.bare.carried);
    let mut a = vec![vec![0.0; 2 * order]; order];
    for j in 0..n {
        let column = |matrix: &Matrix| (0..n).map(|i| -matrix.at(i, j)).collect::<Vec<_>>();
        let (stiff, damped) = (solve.solve(&column(&system.stiffness)), solve.solve(&column(&system.damping)));
        for i in 0..n {
            a[i][j] = stiff[i];
            a[i][order + j] = damped[i];
        }
    }
    for (slot, &particle) in attached.iter().enumerate() {
        let face = face_of(system, contacts, particle);
        let Law::Resilient { stiffness, .. } = face.law else { continue };
        let i = n + slot;
        // N = −k w − c w′ pushes the structure along −φ.
        let push = solve.solve(&face.row);
        for row in 0..n {
            a[row][i] += stiffness * push[row];
            a[row][order + i] += damping[particle] * push[row];
        }
    }
    for across in across.iter().filter(|across| across.presses) {
        let push = solve.solve(&pushed(system, contacts, across));
        for (half, force) in across.force().into_iter().enumerate() {
            for (column, entry) in across.row.iter().enumerate() {
                (0..n).for_each(|row| a[row][half * order + column] += push[row] * force * entry);
            }
        }
    }
    for (slot, &particle) in attached.iter().enumerate() {
        let face = face_of(system, contacts, particle);
        let Law::Resilient { stiffness, .. } = face.law else { continue };
        let i = n + slot;
        for column in 0..2 * order {
            let base = (0..n).fold(0.0, |sum, row| sum + face.row[row] * a[row][column]);
            a[i][column] = -base;
        }
        a[i][i] -= stiffness / system.particles[particle].mass;
        a[i][order + i] -= damping[particle] / system.particles[particle].mass;
        for across in across.iter().filter(|across| across.presses && across.particle == particle) {
            for (half, force) in across.force().into_iter().enumerate() {
                for (column, entry) in across.row.iter().enumerate() {
                    a[i][half * order + column] += force * entry / system.particles[particle].mass;
                }
            }
        }
    }
    a
}
