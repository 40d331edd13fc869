//! Taylor series of the motion in one contact state, in absolute coordinates.
//!
//! M q″ + C q′ + K q = b F(t) + forces of the faces, mp y″ = −mp g + the same from the other side. The series follow from
//! these equations term by term. What a rigid face or a stop holds moves with it: its mass is then the structure's.

use super::double::Double;
use super::matrix::{Square, dot};
use crate::dynamics::{Face, HybridSystem, Law};

/// Terms of a series.
pub(super) const TERMS: usize = 32;
/// What a series may leave out, relative to the largest place.
const LEFT_OUT: f64 = 1e-31;

/// What a particle touches.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Touch {
    Flight,
    /// Into a resilient face; true for the ceiling.
    Pressed(bool),
    /// Held by a rigid face.
    Held(bool),
    /// Held by the stop of a resilient face.
    Stopped(bool),
}

impl Touch {
    /// The face, with its offset from φ·q at which the particle is held or its spring is slack.
    pub(super) fn face(self, system: &HybridSystem, j: usize) -> Option<(&Face, f64)> {
        let particle = &system.particles[j];
        match self {
            Self::Flight => None,
            Self::Pressed(false) | Self::Held(false) | Self::Stopped(false) => Some((&particle.floor, 0.0)),
            _ => particle.ceiling.as_ref().map(|ceiling| (ceiling, particle.gap)),
        }
    }

    pub(super) fn holds(self) -> bool {
        matches!(self, Self::Held(_) | Self::Stopped(_))
    }
}

/// +1 where away from the face is upwards.
pub(super) fn away(ceiling: bool) -> f64 {
    if ceiling { -1.0 } else { 1.0 }
}

/// Depth at which a stop holds; 0 for a rigid face.
pub(super) fn depth(law: &Law, touch: Touch) -> f64 {
    match (law, touch) {
        (Law::Resilient { stop: Some(stop), .. }, Touch::Stopped(_)) => stop.length,
        _ => 0.0,
    }
}

/// One contact state, made ready.
pub(super) struct Phase {
    /// M⁻¹C and M⁻¹K by rows, without their zeros.
    damping: Vec<Vec<(usize, Double)>>,
    stiffness: Vec<Vec<(usize, Double)>>,
    /// M⁻¹b.
    force: Vec<Double>,
    /// M⁻¹φ of each particle's face, where it is pressed.
    faces: Vec<Vec<Double>>,
    /// M⁻¹ times the weight of what is held.
    weight: Vec<Double>,
}

/// Series of all coordinates; entry k belongs to tᵏ.
pub(super) struct Series {
    pub(super) q: Vec<Vec<Double>>,
    pub(super) y: Vec<Vec<Double>>,
}

/// The state at an instant.
#[derive(Clone)]
pub(super) struct State {
    pub(super) q: Vec<Double>,
    pub(super) v: Vec<Double>,
    pub(super) y: Vec<Double>,
    pub(super) w: Vec<Double>,
    /// sin and cos of the harmonic force's phase.
    pub(super) phase: [Double; 2],
    /// Constant force, N.
    pub(super) level: f64,
}

/// M with the masses of what is held.
fn mass(system: &HybridSystem, touches: &[Touch]) -> Square {
    let mut mass = Square::of(&system.mass);
    for (j, touch) in touches.iter().enumerate() {
        if let (true, Some((face, _))) = (touch.holds(), touch.face(system, j)) {
            mass.add_square(system.particles[j].mass, &face.row);
        }
    }
    mass
}

pub(super) fn doubles(row: &[f64]) -> Vec<Double> {
    row.iter().map(|entry| Double::from(*entry)).collect()
}

impl Phase {
    /// `None` for a singular mass matrix.
    pub(super) fn new(system: &HybridSystem, touches: &[Touch]) -> Option<Self> {
        let n = system.mass.order;
        let (damping, stiffness) = (Square::of(&system.damping), Square::of(&system.stiffness));
        let mut columns: Vec<Vec<Double>> = (0..n).map(|j| damping.column(j)).collect();
        columns.extend((0..n).map(|j| stiffness.column(j)));
        columns.push(doubles(&system.force_row));
        let mut weight = vec![Double::ZERO; n];
        for (j, touch) in touches.iter().enumerate() {
            let row = touch.face(system, j).map_or(vec![0.0; n], |(face, _)| face.row.clone());
            columns.push(doubles(&row));
            if touch.holds() {
                let mg = Double::from(system.particles[j].mass) * system.gravity;
                weight.iter_mut().zip(&row).for_each(|(sum, phi)| *sum = *sum - mg * *phi);
            }
        }
        columns.push(weight);
        let mut solved = mass(system, touches).solve(&columns)?;
        let weight = solved.pop()?;
        let faces = solved.split_off(2 * n + 1);
        let force = solved.pop()?;
        let rows = |columns: &[Vec<Double>]| {
            let row = |i: usize| {
                let entries = columns.iter().enumerate().map(|(j, column)| (j, column[i]));
                entries.filter(|(_, entry)| entry.near() != 0.0).collect()
            };
            (0..n).map(row).collect()
        };
        Some(Self { damping: rows(&solved[..n]), stiffness: rows(&solved[n..]), force, faces, weight })
    }

    /// The series of the motion from a state.
    pub(super) fn series(&self, system: &HybridSystem, touches: &[Touch], state: &State) -> Series {
        let (n, count) = (state.q.len(), state.y.len());
        let start = |x: &[Double], v: &[Double]| -> Vec<Vec<Double>> {
            x.iter()
                .zip(v)
                .map(|(x, v)| {
                    let mut terms = vec![Double::ZERO; TERMS];
                    (terms[0], terms[1]) = (*x, *v);
                    terms
                })
                .collect()
        };
        let mut series = Series { q: start(&state.q, &state.v), y: start(&state.y, &state.w) };
        let [mut sine, mut cosine] = state.phase;
        let mut at = [vec![Double::ZERO; n], vec![Double::ZERO; n]];
        for k in 0..TERMS - 2 {
            let up = Double::from((k + 1) as f64);
            for (i, terms) in series.q.iter().enumerate() {
                (at[0][i], at[1][i]) = (terms[k], terms[k + 1] * up);
            }
            let mut force = Double::from(if k == 0 { state.level } else { 0.0 });
            if let Some(drive) = system.drive.harmonic {
                force += sine * drive.force;
                let omega = Double::from(drive.angular_frequency) / up;
                (sine, cosine) = (cosine * omega, -(sine * omega));
            }
            // Push of each face on its particle.
            let mut pushes = vec![Double::ZERO; count];
            for (j, touch) in touches.iter().enumerate() {
                if let (Touch::Pressed(_), Some((face, offset))) = (touch, touch.face(system, j))
                    && let Law::Resilient { stiffness, damping, .. } = face.law
                {
                    let mut u = series.y[j][k] - dot(&face.row, &at[0]);
                    if k == 0 {
                        u = u - Double::from(offset);
                    }
                    let du = series.y[j][k + 1] * up - dot(&face.row, &at[1]);
                    pushes[j] = -(u * stiffness + du * damping);
                }
            }
            let factor = Double::from(1.0) / (up * ((k + 2) as f64));
            for i in 0..n {
                let mut sum = self.force[i] * force;
                if k == 0 {
                    sum += self.weight[i];
                }
                for (j, entry) in &self.damping[i] {
                    sum = sum - *entry * at[1][*j];
                }
                for (j, entry) in &self.stiffness[i] {
                    sum = sum - *entry * at[0][*j];
                }
                for (j, push) in pushes.iter().enumerate().filter(|(_, push)| push.near() != 0.0) {
                    sum = sum - self.faces[j][i] * *push;
                }
                series.q[i][k + 2] = sum * factor;
            }
            for (j, push) in pushes.iter().enumerate() {
                let mut fall = *push / Double::from(system.particles[j].mass);
                if k == 0 {
                    fall = fall - Double::from(system.gravity);
                }
                series.y[j][k + 2] = fall * factor;
            }
        }
        for (j, touch) in touches.iter().enumerate() {
            if let (true, Some((face, offset))) = (touch.holds(), touch.face(system, j)) {
                series.y[j] = along(&face.row, &series.q);
                let ceiling = matches!(touch, Touch::Held(true) | Touch::Stopped(true));
                series.y[j][0] += Double::from(offset) - Double::from(away(ceiling) * depth(&face.law, *touch));
            }
        }
        series
    }
}

/// Σ φᵢ of series.
pub(super) fn along(row: &[f64], q: &[Vec<Double>]) -> Vec<Double> {
    (0..TERMS)
        .map(|k| {
            row.iter().zip(q).filter(|(phi, _)| **phi != 0.0).fold(Double::ZERO, |sum, (phi, q)| sum + q[k] * *phi)
        })
        .collect()
}

impl Series {
    /// How far the series may be followed.
    pub(super) fn reach(&self) -> f64 {
        let all = || self.q.iter().chain(&self.y);
        let largest = |k: usize| all().map(|terms| terms[k].near().abs()).fold(0.0, f64::max);
        let size = largest(0).max(1e-30);
        // Of two last terms, as one of them may vanish by chance.
        let reach = |k: usize| libm::pow(LEFT_OUT * size / largest(k), 1.0 / k as f64);
        reach(TERMS - 1).min(reach(TERMS - 2))
    }
}
