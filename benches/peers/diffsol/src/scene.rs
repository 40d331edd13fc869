//! A scene from JSON, its equations in each contact state, and the surfaces that end it.

use nalgebra::{DMatrix, DVector};
use serde::Deserialize;

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Contact {
    Flight,
    Floor,
    Ceiling,
}

#[derive(Debug, Clone, Copy, Deserialize)]
struct Face {
    stiffness: f64,
    damping: f64,
}

#[derive(Debug, Clone, Deserialize)]
struct Particle {
    mass: f64,
    gap: f64,
    row: Vec<f64>,
    floor: Face,
    ceiling: Face,
}

#[derive(Debug, Deserialize)]
struct Written {
    mass: Vec<f64>,
    damping: Vec<f64>,
    stiffness: Vec<f64>,
    gravity: f64,
    force_row: Vec<f64>,
    observed_row: Vec<f64>,
    impulse: f64,
    period: f64,
    skip: u32,
    cycles: u32,
    particles: Vec<Particle>,
    start: Vec<f64>,
}

/// State: q, y, q', y', and the integral of the squared observed velocity over the window.
#[derive(Debug)]
pub struct Scene {
    pub period: f64,
    pub skip: u32,
    pub cycles: u32,
    /// With an integral of zero.
    pub start: Vec<f64>,
    /// What the impulse does to the rates.
    pub jump: Vec<f64>,
    pub particles: usize,
    modes: usize,
    gravity: f64,
    damping: DMatrix<f64>,
    stiffness: DMatrix<f64>,
    /// By particle: what the structure does under its push.
    answers: Vec<DVector<f64>>,
    observed: Vec<f64>,
    dampers: Vec<Particle>,
}

/// z' = A z + b, row by row; the observed velocity as a row where it is averaged.
#[derive(Debug, Clone)]
pub struct Equations {
    order: usize,
    a: Vec<f64>,
    b: Vec<f64>,
    observed: Vec<f64>,
    pub guards: Vec<Guard>,
}

/// A surface that ends a contact state.
#[derive(Debug, Clone)]
pub struct Guard {
    row: Vec<f64>,
    offset: f64,
    direction: f64,
    pub particle: usize,
    pub next: Contact,
    pub word: &'static str,
}

impl Scene {
    pub fn read(path: &str) -> Result<Self, String> {
        let text = std::fs::read_to_string(path).map_err(|error| format!("{path}: {error}"))?;
        let written: Written = serde_json::from_str(&text).map_err(|error| format!("{path}: {error}"))?;
        let n = written.force_row.len();
        let square = |entries: &[f64]| DMatrix::from_row_slice(n, n, entries);
        let inverse = square(&written.mass).try_inverse().ok_or("a mass matrix without inverse")?;
        let answer = |row: &[f64]| &inverse * DVector::from_column_slice(row);
        Ok(Self {
            period: written.period,
            skip: written.skip,
            cycles: written.cycles,
            start: written.start.iter().copied().chain([0.0]).collect(),
            jump: (answer(&written.force_row) * written.impulse).as_slice().to_vec(),
            particles: written.particles.len(),
            modes: n,
            gravity: written.gravity,
            damping: &inverse * square(&written.damping),
            stiffness: &inverse * square(&written.stiffness),
            answers: written.particles.iter().map(|particle| answer(&particle.row)).collect(),
            observed: written.observed_row,
            dampers: written.particles,
        })
    }

    pub fn strike(&self, z: &mut [f64]) {
        let rates = &mut z[self.modes + self.particles..];
        rates.iter_mut().zip(&self.jump).for_each(|(rate, jump)| *rate += jump);
    }

    pub fn rms(&self, z: &[f64]) -> f64 {
        (z[z.len() - 1] / (f64::from(self.cycles - self.skip) * self.period)).sqrt()
    }

    pub fn equations(&self, contacts: &[Contact], averaged: bool) -> Equations {
        let (n, v) = (self.modes, self.modes + self.particles);
        let order = 2 * v;
        let mut a = DMatrix::zeros(order, order);
        let mut b = vec![0.0; order];
        let mut guards = Vec::new();
        a.view_mut((0, v), (v, v)).fill_with_identity();
        a.view_mut((v, 0), (n, n)).copy_from(&-&self.stiffness);
        a.view_mut((v, v), (n, n)).copy_from(&-&self.damping);
        for (j, (particle, contact)) in self.dampers.iter().zip(contacts).enumerate() {
            b[v + n + j] = -self.gravity;
            let mut row = vec![0.0; order + 1];
            row[..n].iter_mut().zip(&particle.row).for_each(|(to, from)| *to = -from);
            row[n + j] = 1.0;
            let mut guard = |offset, direction, next, word| {
                guards.push(Guard { row: row.clone(), offset, direction, particle: j, next, word });
            };
            let (face, offset) = match contact {
                Contact::Flight => {
                    guard(0.0, -1.0, Contact::Floor, "floor_contact");
                    guard(particle.gap, 1.0, Contact::Ceiling, "ceiling_contact");
                    continue;
                }
                Contact::Floor => {
                    guard(0.0, 1.0, Contact::Flight, "floor_release");
                    (particle.floor, 0.0)
                }
                Contact::Ceiling => {
                    guard(particle.gap, -1.0, Contact::Flight, "ceiling_release");
                    (particle.ceiling, particle.gap)
                }
            };
            let shares = (0..n).map(|i| (v + i, -self.answers[j][i])).chain([(v + n + j, 1.0 / particle.mass)]);
            for (at, share) in shares {
                for k in 0..v {
                    a[(at, k)] -= share * face.stiffness * row[k];
                    a[(at, v + k)] -= share * face.damping * row[k];
                }
                b[at] += share * face.stiffness * offset;
            }
        }
        let mut observed = vec![0.0; order];
        if averaged {
            observed[v..v + n].copy_from_slice(&self.observed);
        }
        Equations { order, a: a.transpose().as_slice().to_vec(), b, observed, guards }
    }
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

impl Equations {
    pub fn slope(&self, z: &[f64], out: &mut [f64]) {
        for ((out, row), b) in out.iter_mut().zip(self.a.chunks_exact(self.order)).zip(&self.b) {
            *out = b + dot(row, z);
        }
        let rate = dot(&self.observed, z);
        out[self.order] = rate * rate;
    }

    /// The Jacobian at z, times w.
    pub fn jacobian(&self, z: &[f64], w: &[f64], out: &mut [f64]) {
        for (out, row) in out.iter_mut().zip(self.a.chunks_exact(self.order)) {
            *out = dot(row, w);
        }
        out[self.order] = 2.0 * dot(&self.observed, z) * dot(&self.observed, w);
    }

    pub fn surfaces(&self, z: &[f64], out: &mut [f64]) {
        out.iter_mut().zip(&self.guards).for_each(|(out, guard)| *out = dot(&guard.row, z) - guard.offset);
    }

    /// The surface that was found, if it is crossed from the right side; with it all that lie behind already and are left further
    /// behind.
    pub fn met(&self, found: usize, z: &[f64]) -> Vec<&Guard> {
        let mut slope = vec![0.0; z.len()];
        self.slope(z, &mut slope);
        let is_crossed = |guard: &Guard| guard.direction * dot(&guard.row, &slope) > 0.0;
        if !is_crossed(&self.guards[found]) {
            return Vec::new();
        }
        let is_behind = |guard: &Guard| guard.direction * (dot(&guard.row, z) - guard.offset) > 0.0;
        let met = |(i, guard): &(usize, &Guard)| *i == found || (is_crossed(guard) && is_behind(guard));
        self.guards.iter().enumerate().filter(met).map(|(_, guard)| guard).collect()
    }
}
