//! Particles that are alike: what some of them do against the others no structure feels.
//!
//! Where k/m and c/m are the same, v = √μ w of particle by particle, with μ = m by the mass of the first, obeys
//!
//! v″ = −(k/m) v − (c/m) v′ − R q″,   and the structure feels Rᵀ((k/m) v + (c/m) v′),   rows of R: √μ φ.
//!
//! Along an axis z with zᵀR = 0 that is a particle on a face at rest: z·v has a block of its own. As many axes as particles
//! outnumber the rank of R would give equal eigenvalues, which at critical damping no Schur form tells apart.

use nalgebra::DMatrix;

use crate::arithmetic::matrix::{dot, length};
use crate::contact_state::conservative::face_of;
use crate::system::{Contact, HybridSystem, Law};

/// Share of the longest column of R below which what is left of another one is rounding.
const NOTHING: f64 = 1e-13;
/// Ratios that differ by less are the same.
const ROUNDING: f64 = 4.0 * f64::EPSILON;

/// Particles that are alike, more of them than the structure feels.
pub(crate) struct Alike {
    /// Their coordinates.
    places: Vec<usize>,
    /// √μ of each, so that no unit of mass tells in S.
    roots: Vec<f64>,
    /// At right angles to each other and of length 1, those first that move the structure.
    axes: Vec<Vec<f64>>,
    /// How many do.
    felt: usize,
    /// k/m and c/m.
    stiffness: f64,
    damping: f64,
}

impl Alike {
    /// Those of a contact state; its coordinates are those of the structure, then the compressions of the `attached`.
    pub(crate) fn all(system: &HybridSystem, contacts: &[Contact], damping: &[f64], attached: &[usize]) -> Vec<Self> {
        let mut all: Vec<Self> = Vec::new();
        for (slot, &j) in attached.iter().enumerate().filter(|(_, j)| !contacts[**j].is_between()) {
            let Law::Resilient { stiffness, .. } = face_of(system, contacts, j).law else { continue };
            let [stiffness, damping] = [stiffness, damping[j]].map(|part| part / system.particles[j].mass);
            let place = system.mass.order + slot;
            let same = |a: f64, b: f64| (a - b).abs() <= ROUNDING * a.max(b);
            match all.iter_mut().find(|one| same(one.stiffness, stiffness) && same(one.damping, damping)) {
                Some(one) => one.places.push(place),
                None => {
                    all.push(Self { places: vec![place], roots: vec![], axes: vec![], felt: 0, stiffness, damping });
                }
            }
        }
        all.retain(|one| one.stiffness > 0.0 && one.places.len() > 1);
        for one in &mut all {
            let particles: Vec<usize> = one.places.iter().map(|place| attached[place - system.mass.order]).collect();
            let mass = |j: usize| system.particles[j].mass;
            one.roots = particles.iter().map(|&j| (mass(j) / mass(particles[0])).sqrt()).collect();
            one.find_axes(&particles.iter().map(|&j| &face_of(system, contacts, j).row[..]).collect::<Vec<_>>());
        }
        all.retain(|one| one.felt < one.places.len());
        all
    }

    /// Puts the axes into x = S e and e = S⁻¹ x, whose places are those of p in the order of `elastic`; and k/m and c/m where a place of x
    /// is one that no structure feels.
    pub(crate) fn turn(
        &self,
        elastic: &[usize],
        turn: &mut DMatrix<f64>,
        back: &mut DMatrix<f64>,
        apart: &mut [Option<[f64; 2]>],
    ) {
        let places: Vec<usize> = (0..elastic.len()).filter(|&i| self.places.contains(&elastic[i])).collect();
        debug_assert_eq!(places.len(), self.places.len(), "each of them has a spring, so none is a rigid body");
        for (k, (axis, &place)) in self.axes.iter().zip(&places).enumerate() {
            for ((entry, root), &own) in axis.iter().zip(&self.roots).zip(&places) {
                turn[(place, own)] = entry * root;
                back[(own, place)] = entry / root;
            }
            apart[place] = (k >= self.felt).then_some([self.stiffness, self.damping]);
        }
    }

    /// Finds axes along the columns of R, then across; `rows` are those of the faces.
    fn find_axes(&mut self, rows: &[&[f64]]) {
        let count = self.places.len();
        let column = |k: usize| rows.iter().zip(&self.roots).map(|(row, root)| root * row[k]).collect::<Vec<_>>();
        let mut columns: Vec<Vec<f64>> = (0..rows[0].len()).map(column).collect();
        let nothing = NOTHING * columns.iter().fold(0.0_f64, |most, column| most.max(length(column)));
        let mut units: Vec<Vec<f64>> =
            (0..count).map(|i| (0..count).map(|k| f64::from(u8::from(k == i))).collect()).collect();
        while self.axes.len() < count {
            // The longest that is left comes next.
            let longest =
                |all: &[Vec<f64>]| (0..all.len()).max_by(|&a, &b| length(&all[a]).total_cmp(&length(&all[b])));
            let moving = longest(&columns).filter(|&k| length(&columns[k]) > nothing);
            let mut axis = match moving {
                Some(k) => columns.swap_remove(k),
                None => longest(&units).map(|k| units.swap_remove(k)).expect("units span everything"),
            };
            self.felt += usize::from(moving.is_some());
            // Once more, for what rounding has left of the others.
            across(&mut axis, &self.axes);
            let size = length(&axis);
            axis.iter_mut().for_each(|entry| *entry /= size);
            columns.iter_mut().chain(&mut units).for_each(|other| across(other, std::slice::from_ref(&axis)));
            self.axes.push(axis);
        }
    }
}

/// Takes off `axis` what it has along others.
fn across(axis: &mut [f64], others: &[Vec<f64>]) {
    for other in others {
        let share = dot(axis, other);
        axis.iter_mut().zip(other).for_each(|(entry, along)| *entry -= share * along);
    }
}
