//! Modes of one contact state: all of its flow that no drive enters.
//!
//! With the particles in flight taken out (they fall by themselves) and those held by a rigid face counted as mass, a
//! contact state is linear: p = (q, w) with w the compression of every resilient face in contact,
//!
//! q″ = M⁻¹(−K q − C q′ + b F − Σ φ N),   w″ = N/mp − g − φ·q″,   N = −k w − c w′.
//!
//! Its matrix is split into 2 × 2 blocks ([`super::modes`]); gap, forcing and time do not enter.

use super::EngineError;
use super::cholesky::Cholesky;
use super::load::Load;
use super::spectral::Spectral;
use super::system::{Contact, Face, HybridSystem, Law, Matrix, dot};

/// The modes of one contact state.
pub(crate) struct Modes {
    /// Contact of each particle.
    pub(crate) contacts: Vec<Contact>,
    /// Contact damping in force, per particle, N s/m.
    pub(crate) damping: Vec<f64>,
    /// Coordinates: those of the structure, then one per resilient contact.
    pub(crate) order: usize,
    /// Which particle the coordinate `structure + i` belongs to.
    pub(crate) attached: Vec<usize>,
    /// Accelerations of p by (p, p′): order rows of 2·order numbers.
    pub(crate) accelerations: Vec<Vec<f64>>,
    /// Block coordinates from (p, p′) and back, column by column and row by row.
    pub(crate) spectral: Spectral,
    /// The way back once more, column by column: as a segment ends with it.
    pub(crate) columns: Vec<f64>,
    /// Answer to gravity.
    pub(crate) gravity: Load,
    carried: Cholesky,
}

impl Modes {
    pub(crate) fn new(system: &HybridSystem, contacts: &[Contact], damping: &[f64]) -> Result<Self, EngineError> {
        let n = system.mass.order;
        let attached: Vec<usize> = (0..contacts.len()).filter(|&j| contacts[j].presses(&system.particles[j])).collect();
        let mass = carried_mass(system, contacts);
        let carried = Cholesky::new(&mass)?;
        let face_of = |j: usize| contacts[j].face(&system.particles[j]).expect("a pressing particle has a face");
        let accelerations = accelerations(system, &carried, &attached, &face_of, damping);
        let spectral = super::modes::split(&accelerations, &mass_of(system, mass, &attached, &face_of))?;
        let (size, width) = (2 * (n + attached.len()), spectral.width());
        let columns = (0..size * width).map(|i| spectral.from_blocks[(i % size) * width + i / size]).collect();
        let mut modes = Self {
            contacts: contacts.to_vec(),
            damping: damping.to_vec(),
            order: n + attached.len(),
            attached,
            accelerations,
            spectral,
            columns,
            gravity: Load::default(),
            carried,
        };
        let falls = modes.falls(system);
        modes.gravity = Load::new(&falls, &modes.spectral, &modes.accelerations);
        Ok(modes)
    }

    /// p″ under a force of this row on the structure, all springs at rest.
    pub(crate) fn answer(&self, system: &HybridSystem, force: &[f64]) -> Vec<f64> {
        let mut answer = self.carried.solve(force);
        for &j in &self.attached {
            let face = self.contacts[j].face(&system.particles[j]).expect("a pressing particle has a face");
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
        let mut falls = self.answer(system, &weight);
        falls[n..].iter_mut().for_each(|fall| *fall -= system.gravity);
        falls
    }

    /// Numbers that it keeps.
    pub(crate) fn size(&self) -> usize {
        self.accelerations.len() * 2 * self.order + 3 * self.columns.len()
    }
}

/// Damping of the face that particle j's contact refers to, N s/m; half cycles put another one in its place.
pub(crate) fn contact_damping(system: &HybridSystem, contacts: &[Contact], j: usize, equivalent: Option<f64>) -> f64 {
    match contacts[j].side().face(&system.particles[j]).law {
        Law::Resilient { damping, .. } => equivalent.unwrap_or(damping),
        Law::Rigid { .. } => 0.0,
    }
}

/// Accelerations of p by (p, p′): order rows of 2·order numbers.
fn accelerations<'a>(
    system: &HybridSystem,
    solve: &Cholesky,
    attached: &[usize],
    face_of: &dyn Fn(usize) -> &'a Face,
    damping: &[f64],
) -> Vec<Vec<f64>> {
    let n = system.mass.order;
    let order = n + attached.len();
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
        let face = face_of(particle);
        let Law::Resilient { stiffness, .. } = face.law else { continue };
        let i = n + slot;
        // N = −k w − c w′ pushes the structure along −φ.
        let push = solve.solve(&face.row);
        for row in 0..n {
            a[row][i] += stiffness * push[row];
            a[row][order + i] += damping[particle] * push[row];
        }
    }
    for (slot, &particle) in attached.iter().enumerate() {
        let face = face_of(particle);
        let Law::Resilient { stiffness, .. } = face.law else { continue };
        let i = n + slot;
        for column in 0..2 * order {
            let base = (0..n).fold(0.0, |sum, row| sum + face.row[row] * a[row][column]);
            a[i][column] = -base;
        }
        a[i][i] -= stiffness / system.particles[particle].mass;
        a[i][order + i] -= damping[particle] / system.particles[particle].mass;
    }
    a
}

/// M + Σ mp φ φᵀ over the particles that a face holds.
pub(crate) fn carried_mass(system: &HybridSystem, contacts: &[Contact]) -> Matrix {
    let mut mass = system.mass.clone();
    let n = mass.order;
    for (particle, contact) in system.particles.iter().zip(contacts) {
        if let (true, Some(face)) = (contact.holds(particle), contact.face(particle)) {
            for i in 0..n {
                for j in 0..n {
                    mass.entries[i * n + j] += particle.mass * face.row[i] * face.row[j];
                }
            }
        }
    }
    mass
}

/// Mass matrix of p = (q, w): each particle in contact moves with φ·q + w.
fn mass_of<'a>(
    system: &HybridSystem,
    carried: Matrix,
    attached: &[usize],
    face_of: &dyn Fn(usize) -> &'a Face,
) -> Matrix {
    let n = carried.order;
    let mut mass = Matrix::diagonal(&vec![0.0; n + attached.len()]);
    let order = mass.order;
    for i in 0..n {
        mass.entries[i * order..][..n].copy_from_slice(&carried.entries[i * n..][..n]);
    }
    for (slot, &j) in attached.iter().enumerate() {
        let particle = system.particles[j].mass;
        let mut row = face_of(j).row.clone();
        row.resize(order, 0.0);
        row[n + slot] = 1.0;
        for (i, x) in row.iter().enumerate() {
            for (k, y) in row.iter().enumerate() {
                mass.entries[i * order + k] += particle * x * y;
            }
        }
    }
    mass
}
