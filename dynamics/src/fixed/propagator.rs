//! Propagators: one contact state over one time step, as a matrix.
//!
//! The state is s = (q, u, q′, u′): the structure and, for every particle, the gap u to its floor. A particle in flight is
//! part of it (u″ = −g − φ·q″ is the parabola of free flight, seen from the floor), and so is one that is held, so that every
//! contact state has the same coordinates. With s′ = A s + a + b F, a step of length Δt under a force held constant is
//!
//! s(k+1) = A_d s(k) + a_d + B_d F(k),   where exp([A a b; 0 0 0; 0 0 0] Δt) = [A_d a_d B_d; …].

use super::vector::Vector;
use crate::arithmetic::cholesky::Cholesky;
use crate::arithmetic::matrix::Matrix;
use crate::contact::{Hold, Side, spring_on_stop};
use crate::contact_state::conservative::carried_mass;
use crate::contact_state::modes::scale;
use crate::error::EngineError;
use crate::system::{Contact, HybridSystem, Law, Particle};

/// One contact state over one time step.
pub(super) struct Propagator<V: Vector> {
    /// Contact of each particle.
    pub(super) contacts: Vec<Contact>,
    /// Contact damping in force, per particle, at floor and ceiling, N s/m.
    pub(super) damping: Vec<[f64; 2]>,
    /// A_d.
    pub(super) matrix: V::Matrix,
    /// a_d: weight and the rest position of a ceiling.
    pub(super) offset: V,
    /// B_d.
    pub(super) input: V,
    /// The contact state holds while none of these is negative.
    pub(super) guards: Vec<Form<V>>,
    /// Which of them says how strongly a particle is held.
    holds: Vec<Option<usize>>,
    /// Observed acceleration, and that of the base.
    pub(super) acceleration: Form<V>,
    pub(super) base_acceleration: Form<V>,
    /// The power of all dashpots is the sum of the squares of these.
    pub(super) dissipation: Vec<V>,
}

/// A signal: row·s + force·F + constant.
pub(super) struct Form<V> {
    row: V,
    force: f64,
    constant: f64,
}

impl<V: Vector> Form<V> {
    #[inline(always)]
    pub(super) fn at(&self, state: &V, force: f64) -> f64 {
        self.of(state, force, 1.0)
    }

    /// With so many times the constant.
    #[inline(always)]
    pub(super) fn of(&self, state: &V, force: f64, constant: f64) -> f64 {
        self.row.dot(state) + (self.force * force + self.constant * constant)
    }

    fn new(signal: &Signal) -> Self {
        let size = signal.0.len() - 2;
        Self { row: V::of(&signal.0[..size]), force: signal.0[size + 1], constant: signal.0[size] }
    }
}

/// A signal under construction: a coefficient for each coordinate, then for the constant 1, then for the force.
#[derive(Clone)]
struct Signal(Vec<f64>);

impl Signal {
    fn zero(size: usize) -> Self {
        Self(vec![0.0; size + 2])
    }

    fn plus(mut self, factor: f64, other: &Self) -> Self {
        self.0.iter_mut().zip(&other.0).for_each(|(sum, x)| *sum += factor * x);
        self
    }

    fn plus_constant(mut self, constant: f64) -> Self {
        let size = self.0.len() - 2;
        self.0[size] += constant;
        self
    }

    fn times(self, factor: f64) -> Self {
        Self(self.0.into_iter().map(|x| factor * x).collect())
    }
}

/// Where the coordinates of a system stand in its state vector.
#[derive(Debug, Clone, Copy)]
pub(super) struct Layout {
    /// Coordinates of the structure.
    pub(super) n: usize,
    /// Particles.
    pub(super) particles: usize,
}

impl Layout {
    pub(super) fn of(system: &HybridSystem) -> Self {
        Self { n: system.mass.order, particles: system.particles.len() }
    }

    /// Positions, and as many rates.
    pub(super) fn positions(self) -> usize {
        self.n + self.particles
    }

    pub(super) fn size(self) -> usize {
        2 * self.positions()
    }

    /// Gap of particle j; its rate follows `positions` later.
    pub(super) fn gap(self, j: usize) -> usize {
        self.n + j
    }

    /// q and q′ of a state.
    pub(super) fn structure(self, state: &[f64]) -> [&[f64]; 2] {
        [&state[..self.n], &state[self.positions()..][..self.n]]
    }

    fn unit(self, i: usize) -> Signal {
        let mut signal = Signal::zero(self.size());
        signal.0[i] = 1.0;
        signal
    }

    /// Position of particle j relative to a face: u, or w = u − h − (φ_c − φ_f)·q; and its rate.
    fn relative(self, particle: &Particle, j: usize, side: Side) -> [Signal; 2] {
        let mut position = self.unit(self.gap(j)).plus_constant(-side.height(particle));
        let mut rate = self.unit(self.gap(j) + self.positions());
        for (i, lead) in lead(particle, side).enumerate() {
            position.0[i] -= lead;
            rate.0[i + self.positions()] -= lead;
        }
        [position, rate]
    }
}

/// The faces that a contact state can change at: both in flight and where they move by themselves, else its own.
pub(super) fn sides(contact: Contact, particle: &Particle) -> impl Iterator<Item = Side> {
    let alone = contact != Contact::Flight && !particle.has_walls();
    let is_asked = move |side: &Side| {
        if alone { *side == contact.side() } else { *side == Side::Floor || particle.ceiling.is_some() }
    };
    [Side::Floor, Side::Ceiling].into_iter().filter(is_asked)
}

/// φ_s − φ_f: how a face moves ahead of the floor.
pub(super) fn lead(particle: &Particle, side: Side) -> impl Iterator<Item = f64> {
    side.face(particle).row.iter().zip(&particle.floor.row).map(|(face, floor)| face - floor)
}

impl<V: Vector> Propagator<V> {
    pub(super) fn build(
        system: &HybridSystem,
        contacts: &[Contact],
        damping: &[[f64; 2]],
        time_step: f64,
    ) -> Result<Self, EngineError> {
        let layout = Layout::of(system);
        let (n, positions, size) = (layout.n, layout.positions(), layout.size());
        let pushes = Push::all(system, contacts, damping);
        let accelerations = accelerations(system, contacts, &pushes)?;
        let along = |row: &[f64]| {
            row.iter().zip(&accelerations[..n]).fold(Signal::zero(size), |sum, (x, signal)| sum.plus(*x, signal))
        };

        let mut guards = Vec::new();
        let mut holds = vec![None; layout.particles];
        let mut dissipation = dashpots(&system.damping, layout);
        for (j, particle) in system.particles.iter().enumerate() {
            for side in sides(contacts[j], particle) {
                let (law, away) = (side.face(particle).law, side.away());
                let [w, rate] = layout.relative(particle, j, side);
                let damping = damping[j][side as usize];
                let push = push(law, damping, &w, &rate).times(away);
                match contacts[j].at(side, particle) {
                    Hold::Held if particle.is_enclosed() => {}
                    Hold::Held => {
                        let spring = spring_on_stop(particle, side);
                        let hold = along(&side.face(particle).row).plus_constant(system.gravity);
                        let hold = hold.plus(-1.0, &Push::acceleration(&pushes, j, system)).times(away);
                        holds[j] = Some(guards.len());
                        guards.push(hold.plus_constant(-spring));
                    }
                    Hold::Pressed => {
                        dissipation.push(rate.times(damping.max(0.0).sqrt()));
                        if let Some(stop) = law.stop() {
                            guards.push(w.clone().times(away).plus_constant(stop.length));
                        }
                        guards.push(match law {
                            Law::Resilient { no_tension: true, .. } => push,
                            _ => w.times(-away),
                        });
                    }
                    Hold::Released => {
                        guards.push(w.times(-away));
                        guards.push(push.times(-1.0));
                    }
                    Hold::Away => guards.push(w.times(away)),
                }
            }
        }

        let mut derivative: Vec<Signal> = (0..positions).map(|i| layout.unit(positions + i)).collect();
        derivative.extend(accelerations.iter().cloned());
        let step = exponential(&derivative, time_step);
        Ok(Self {
            contacts: contacts.to_vec(),
            damping: damping.to_vec(),
            matrix: V::matrix(&step[..size]),
            offset: V::of(&step[size]),
            input: V::of(&step[size + 1]),
            guards: guards.iter().map(Form::new).collect(),
            holds,
            acceleration: Form::new(&along(&system.observed_rows[0])),
            base_acceleration: Form::new(&along(system.base_row().unwrap_or_default())),
            dissipation: dissipation.iter().map(|signal| V::of(&signal.0[..size])).collect(),
        })
    }

    /// How strongly a face or its stop holds particle j, m/s²; nothing while it does not.
    pub(super) fn hold(&self, j: usize, state: &V, force: f64) -> f64 {
        self.holds[j].map_or(0.0, |guard| self.guards[guard].at(state, force))
    }
}

/// Force of a resilient face on its particle, upwards: N = −k w − c w′.
fn push(law: Law, damping: f64, w: &Signal, rate: &Signal) -> Signal {
    match law {
        Law::Resilient { stiffness, .. } => w.clone().times(-stiffness).plus(-damping, rate),
        Law::Rigid { .. } => w.clone().times(0.0),
    }
}

/// A resilient face that pushes its particle.
struct Push {
    particle: usize,
    side: Side,
    /// Upwards, N.
    force: Signal,
}

impl Push {
    fn all(system: &HybridSystem, contacts: &[Contact], damping: &[[f64; 2]]) -> Vec<Self> {
        let layout = Layout::of(system);
        let of = |(j, particle): (usize, _)| {
            let is_pressed = move |side: &Side| contacts[j].at(*side, particle) == Hold::Pressed;
            sides(contacts[j], particle).filter(is_pressed).map(move |side| {
                let [w, rate] = layout.relative(particle, j, side);
                let force = push(side.face(particle).law, damping[j][side as usize], &w, &rate);
                Self { particle: j, side, force }
            })
        };
        system.particles.iter().enumerate().flat_map(of).collect()
    }

    /// What all faces give one particle, upwards, m/s².
    fn acceleration(all: &[Self], j: usize, system: &HybridSystem) -> Signal {
        let zero = Signal::zero(Layout::of(system).size());
        let on = all.iter().filter(|push| push.particle == j);
        on.fold(zero, |sum, push| sum.plus(1.0 / system.particles[j].mass, &push.force))
    }
}

/// q″ and u″ by state, weight and force.
fn accelerations(system: &HybridSystem, contacts: &[Contact], pushes: &[Push]) -> Result<Vec<Signal>, EngineError> {
    let layout = Layout::of(system);
    let (n, size) = (layout.n, layout.size());
    let mut loads: Vec<Signal> = (0..n)
        .map(|i| {
            let mut load = Signal::zero(size);
            for j in 0..n {
                load.0[j] = -system.stiffness.at(i, j);
                load.0[layout.positions() + j] = -system.damping.at(i, j);
            }
            load.0[size + 1] = system.force_row[i];
            load
        })
        .collect();
    for Push { particle, side, force } in pushes {
        for (load, phi) in loads.iter_mut().zip(&side.face(&system.particles[*particle]).row) {
            *load = load.clone().plus(-phi, force);
        }
    }
    // What a held particle weighs, and what pushes it, its face passes on to the structure.
    for (j, (particle, contact)) in system.particles.iter().zip(contacts).enumerate() {
        if contact.holds(particle) {
            let on = Push::acceleration(pushes, j, system).plus_constant(-system.gravity);
            for (load, phi) in loads.iter_mut().zip(&contact.side().face(particle).row) {
                *load = load.clone().plus(phi * particle.mass, &on);
            }
        }
    }
    let mass = Cholesky::new(&carried_mass(system, contacts))?;
    let mut accelerations = vec![Signal::zero(size); n];
    for k in 0..size + 2 {
        let column: Vec<f64> = loads.iter().map(|load| load.0[k]).collect();
        for (signal, x) in accelerations.iter_mut().zip(mass.solve(&column)) {
            signal.0[k] = x;
        }
    }
    for (j, particle) in system.particles.iter().enumerate() {
        let ahead = |row: &mut dyn Iterator<Item = f64>| {
            row.zip(&accelerations[..n]).fold(Signal::zero(size), |sum, (x, signal)| sum.plus(x, signal))
        };
        let gap = if contacts[j].holds(particle) {
            ahead(&mut lead(particle, contacts[j].side()))
        } else {
            let floor = ahead(&mut particle.floor.row.iter().copied());
            Push::acceleration(pushes, j, system).plus_constant(-system.gravity).plus(-1.0, &floor)
        };
        accelerations.push(gap);
    }
    Ok(accelerations)
}

/// Rows with q′·C q′ = Σ (row·s)², from the factors of C; a coordinate without damping has none.
fn dashpots(damping: &Matrix, layout: Layout) -> Vec<Signal> {
    let n = layout.n;
    let mut rest = damping.clone();
    let mut rows = Vec::new();
    for k in 0..n {
        let pivot = rest.at(k, k);
        if pivot <= 0.0 {
            continue;
        }
        let factor: Vec<f64> = (0..n).map(|i| rest.at(i, k) / pivot.sqrt()).collect();
        rest.add_square(-1.0, &factor);
        let mut row = Signal::zero(layout.size());
        row.0[layout.positions()..layout.positions() + n].copy_from_slice(&factor);
        rows.push(row);
    }
    rows
}

/// Terms of the Taylor series, at ‖A‖Δt ≤ 1/4: the first one left out is below 1e-21.
const TERMS: usize = 14;

/// exp of the step by scaling and squaring, as columns: one for each coordinate, then a_d and B_d.
///
/// Positions are measured in units that make the matrix of one magnitude, or stiff faces would cost digits.
fn exponential(derivative: &[Signal], time_step: f64) -> Vec<Vec<f64>> {
    let size = derivative.len();
    let whole = size + 2;
    let scales: Vec<f64> =
        (0..whole).map(|i| if i < size / 2 { scale(derivative[size / 2 + i].0[i]) } else { 1.0 }).collect();
    let mut exponent = vec![0.0; whole * whole];
    let mut norm = 0.0_f64;
    for i in 0..size {
        for j in 0..whole {
            exponent[i * whole + j] = derivative[i].0[j] * scales[i] / scales[j] * time_step;
        }
        norm = norm.max(exponent[i * whole..i * whole + size].iter().fold(0.0, |sum, x| sum + x.abs()));
    }
    let mut squarings = 0;
    while norm > 0.25 && squarings < 1000 {
        norm *= 0.5;
        squarings += 1;
        exponent.iter_mut().for_each(|x| *x *= 0.5);
    }
    // exp − 1, so that slow modes keep their digits through the squarings that fast ones need.
    let mut rest = vec![0.0; whole * whole];
    for term in (1..=TERMS).rev() {
        (0..whole).for_each(|i| rest[i * whole + i] += 1.0);
        rest = product(&exponent, &rest, whole);
        rest.iter_mut().for_each(|x| *x /= term as f64);
    }
    for _ in 0..squarings {
        let square = product(&rest, &rest, whole);
        rest.iter_mut().zip(square).for_each(|(x, square)| *x = 2.0 * *x + square);
    }
    (0..whole).for_each(|i| rest[i * whole + i] += 1.0);
    (0..whole).map(|j| (0..size).map(|i| rest[i * whole + j] / scales[i] * scales[j]).collect()).collect()
}

fn product(a: &[f64], b: &[f64], order: usize) -> Vec<f64> {
    let mut c = vec![0.0; order * order];
    for i in 0..order {
        for k in 0..order {
            let factor = a[i * order + k];
            if factor != 0.0 {
                for j in 0..order {
                    c[i * order + j] += factor * b[k * order + j];
                }
            }
        }
    }
    c
}
