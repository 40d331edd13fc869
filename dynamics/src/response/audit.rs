//! The audit of a run: momentum and energy balanced over the averaged window, by other means than the run used.
//!
//! The run takes its integrals from the signals that it observes; the audit sums up what the dashpots take and where the
//! structure is ([`crate::flow::dissipation`]), and holds it against the physical state at both ends:
//!
//! ρ·[M q′] + ∫ ρ·(K q + C q′) dt + Σ ρ·φ mp ([y′] + g t) = ρ·b (Σ J + ∫ F dt)
//!
//! [E] + ∫ q′·C q′ dt + ∫ Σ c w′² dt + impact losses = work of impulses + ∫ F b·q′ dt.
//!
//! Both hold in chaotic runs too. They cannot show an event that was missed altogether; that is the search's certificate.

use crate::arithmetic::larger_or_nan;
use crate::arithmetic::matrix::dot;
use crate::arithmetic::quadrature;
use crate::budget;
use crate::contact::{Hold, Side};
use crate::contact_state::bank::Kernels;
use crate::flow::{Coordinates, Flow};
use crate::system::{Contact, DrivePhase, HybridSystem};

/// The physical state at an instant.
#[derive(Debug, Clone, Default)]
pub(crate) struct State {
    pub(crate) q: Vec<f64>,
    pub(crate) rate: Vec<f64>,
    /// y, y′.
    pub(crate) particles: Vec<[f64; 2]>,
    /// Stiffness and compression of the face each particle presses into.
    pub(crate) compressions: Vec<[f64; 2]>,
    /// The same of second faces.
    pub(crate) across: Vec<[f64; 2]>,
}

impl State {
    /// Of a structure at q, q′ with its particles at y, y′; `gap` is where one of them is relative to the face on one side.
    pub(crate) fn new(
        system: &HybridSystem,
        contacts: &[Contact],
        [q, rate]: [&[f64]; 2],
        particles: Vec<[f64; 2]>,
        gap: impl Fn(usize, Side) -> f64,
    ) -> Self {
        let spring = |j: usize, side: Side| Some([side.face(&system.particles[j]).law.stiffness()?, gap(j, side)]);
        let own = |j: usize| contacts[j].face(&system.particles[j]).and_then(|_| spring(j, contacts[j].side()));
        let across =
            |j: usize| spring(j, contacts[j].side().opposite()).filter(|_| contacts[j].across() == Hold::Pressed);
        let count = contacts.len();
        Self {
            q: q.to_vec(),
            rate: rate.to_vec(),
            particles,
            compressions: (0..count).map(|j| own(j).unwrap_or_default()).collect(),
            across: (0..count).filter_map(across).collect(),
        }
    }
}

/// What has passed since the window began.
#[derive(Debug, Default)]
pub(crate) struct Audit {
    begin: State,
    impulse: f64,
    impulse_work: f64,
    loss: f64,
    /// All else; impulses and their work count among its moduli.
    passed: Passed,
    /// Where the structure is at a node.
    here: Coordinates,
}

/// What passed between two instants.
#[derive(Debug, Default)]
pub(crate) struct Passed {
    /// s.
    pub(crate) duration: f64,
    /// ∫ q dt.
    pub(crate) position: Vec<f64>,
    /// Work of the dashpots, J.
    pub(crate) dissipated: f64,
    /// ∫ F dt and ∫ |F| dt of the force beside the impulses, N s.
    pub(crate) force: f64,
    pub(crate) force_modulus: f64,
    /// Its work, and the sum of the moduli of its parts, J.
    pub(crate) work: f64,
    pub(crate) work_modulus: f64,
}

impl Passed {
    /// Adds a force and its power, times a weight.
    #[inline(always)]
    pub(crate) fn drive(&mut self, weight: f64, force: f64, power: f64) {
        self.force += weight * force;
        self.force_modulus += weight * force.abs();
        self.work += weight * power;
        self.work_modulus += weight * power.abs();
    }
}

/// Kinetic, gravitational and elastic energy, J.
pub(crate) fn energy(system: &HybridSystem, state: &State) -> f64 {
    let mut energy = 0.5 * system.mass.form(&state.rate, &state.rate) + 0.5 * system.stiffness.form(&state.q, &state.q);
    for ((particle, [y, rate]), [stiffness, w]) in
        system.particles.iter().zip(&state.particles).zip(&state.compressions)
    {
        energy += particle.mass * (0.5 * rate * rate + system.gravity * y) + 0.5 * stiffness * w * w;
    }
    for [stiffness, v] in &state.across {
        energy += 0.5 * stiffness * v * v;
    }
    energy
}

/// The force in force during a segment.
#[derive(Clone, Copy)]
pub(crate) struct Force {
    /// The constant one, N.
    pub(crate) level: f64,
    /// The harmonic one at the segment's start.
    pub(crate) drive: DrivePhase,
}

/// A node of a panel: seconds from the segment's start, and its weight, s.
struct Node {
    time: f64,
    weight: f64,
}

/// The kernels of the nodes of a panel; panels of one length share them.
#[derive(Default)]
struct Nodes {
    length: f64,
    within: Vec<Vec<Kernels>>,
    end: Vec<Kernels>,
}

impl Nodes {
    fn set(&mut self, flow: &Flow, length: f64) {
        if self.length != length {
            let within = quadrature::TEN.iter().map(|[x, _]| flow.kernels(x * length)).collect();
            *self = Self { length, within, end: flow.kernels(length) };
        }
    }
}

impl Audit {
    /// From a state on.
    pub(crate) fn from(state: State) -> Self {
        let passed = Passed { position: vec![0.0; state.q.len()], ..Passed::default() };
        Self { begin: state, passed, ..Self::default() }
    }

    pub(crate) fn impulse(&mut self, impulse: f64, work: f64) {
        self.impulse += impulse;
        self.passed.force_modulus += impulse.abs();
        self.impulse_work += work;
        self.passed.work_modulus += work.abs();
    }

    /// Energy that left otherwise: in an impact, or with a spring that lets go while compressed (and takes it back).
    pub(crate) fn loss(&mut self, loss: f64) {
        self.loss += loss;
    }

    /// Adds what another solver has summed up.
    pub(crate) fn add(&mut self, passed: &Passed) {
        let own = &mut self.passed;
        own.duration += passed.duration;
        own.position.iter_mut().zip(&passed.position).for_each(|(sum, q)| *sum += q);
        own.dissipated += passed.dissipated;
        own.force += passed.force;
        own.force_modulus += passed.force_modulus;
        own.work += passed.work;
        own.work_modulus += passed.work_modulus;
    }

    /// Adds one segment between two states: in closed form if there is one, else by panels.
    pub(crate) fn segment(
        &mut self,
        system: &HybridSystem,
        flow: &Flow,
        [start, end]: [&[f64]; 2],
        force: Force,
        length: f64,
    ) {
        if length == 0.0 {
            return;
        }
        self.passed.duration += length;
        let [start, end] = [start, end].map(|state| &state[..2 * flow.own]);
        if let Some(taken) = flow.dissipation(system).between(start, end) {
            self.passed.dissipated += taken;
            self.moved(system, flow, &flow.integrated(start, end), force.level, length);
        } else {
            self.panels(system, flow, start, force, length);
        }
    }

    /// Integrates one segment by panels.
    fn panels(&mut self, system: &HybridSystem, flow: &Flow, start: &[f64], force: Force, length: f64) {
        let dissipation = flow.dissipation(system);
        let mut nodes = Nodes::default();
        let (mut from, mut c) = (start.to_vec(), vec![0.0; flow.width()]);
        from.resize(flow.width(), 0.0);
        let mut t0 = 0.0;
        // Σ w c over all nodes: where nothing but the blocks moves, their mean is all that positions and rates need.
        let mut sum = vec![0.0; start.len()];
        while t0 < length && !budget::spend(2) {
            let h = dissipation.panel(system, &flow.modes, |i| from[i].abs()).min(length - t0);
            nodes.set(flow, h);
            for ([x, weight], kernels) in quadrature::TEN.iter().zip(&nodes.within) {
                flow.advance_all(kernels, &from, DrivePhase::default(), &mut c);
                let w = weight * h;
                if flow.is_free() {
                    sum.iter_mut().zip(&c).for_each(|(sum, c)| *sum += w * c);
                    self.passed.dissipated += w * dissipation.power(&c[..start.len()]);
                } else {
                    self.node(system, flow, &c[..start.len()], Node { time: t0 + x * h, weight: w }, force);
                }
            }
            flow.advance_all(&nodes.end, &from, DrivePhase::default(), &mut c);
            std::mem::swap(&mut from, &mut c);
            t0 += h;
        }
        if flow.is_free() {
            self.moved(system, flow, &sum, force.level, length);
        }
    }

    /// One node of a panel, in physical coordinates.
    fn node(&mut self, system: &HybridSystem, flow: &Flow, c: &[f64], Node { time, weight }: Node, force: Force) {
        let n = system.mass.order;
        let now = flow.drive_after(force.drive, time);
        let Self { passed, here, .. } = self;
        flow.leave_to(c, time, force.level, now, here);
        let Coordinates { p, rate, .. } = here;
        passed.position.iter_mut().zip(&p[..n]).for_each(|(sum, q)| *sum += weight * q);
        passed.dissipated += weight * system.damping.form(&rate[..n], &rate[..n]);
        for (i, &j) in flow.modes.attached.iter().enumerate() {
            passed.dissipated += weight * flow.modes.damping[j] * rate[n + i] * rate[n + i];
        }
        for across in flow.modes.across.iter().filter(|across| across.presses) {
            let v = dot(&across.row, rate);
            passed.dissipated += weight * across.damping * v * v;
        }
        let force = force.level + now.sine;
        passed.drive(weight, force, force * dot(&system.force_row, &rate[..n]));
    }

    /// Positions and work of a whole segment, from ∫ c dt.
    fn moved(&mut self, system: &HybridSystem, flow: &Flow, sum: &[f64], level: f64, length: f64) {
        let n = system.mass.order;
        let mean: Vec<f64> = sum.iter().map(|c| c / length).collect();
        flow.leave_to(&mean, 0.0, level, DrivePhase::default(), &mut self.here);
        let Coordinates { p, rate, .. } = &self.here;
        self.passed.position.iter_mut().zip(&p[..n]).for_each(|(sum, q)| *sum += length * q);
        self.passed.drive(1.0, level * length, level * length * dot(&system.force_row, &rate[..n]));
    }

    /// Momentum and energy residual, relative to what passed through the system.
    pub(crate) fn residuals(&self, system: &HybridSystem, end: &State) -> (f64, f64) {
        let Self { begin, passed: all, .. } = self;
        if all.duration == 0.0 {
            return (0.0, 0.0);
        }
        let change = |a: &[f64], b: &[f64]| b.iter().zip(a).map(|(b, a)| b - a).collect::<Vec<_>>();
        let moved = change(&begin.q, &end.q);
        let gained = system.mass.times(&change(&begin.rate, &end.rate));
        let held = system.stiffness.times(&all.position);
        let damped = system.damping.times(&moved);
        let mut momentum = 0.0_f64;
        for row in &system.momentum_rows {
            let mut residual = dot(row, &gained) + dot(row, &held) + dot(row, &damped);
            let mut passed = all.force_modulus * dot(row, &system.force_row).abs();
            residual -= dot(row, &system.force_row) * (self.impulse + all.force);
            for state in [begin, end] {
                passed += dot(row, &system.mass.times(&state.rate)).abs();
            }
            for ((particle, a), b) in system.particles.iter().zip(&begin.particles).zip(&end.particles) {
                let share = dot(row, &particle.floor.row) * particle.mass;
                residual += share * (b[1] - a[1] + system.gravity * all.duration);
                passed += (share * system.gravity).abs() * all.duration;
                // What a free particle or structure exchanges without any force: at least what it came with.
                for (state, [_, rate]) in [(begin, a), (end, b)] {
                    let face = dot(&particle.floor.row, &state.rate);
                    passed += share.abs() * (rate.abs() + face.abs());
                }
            }
            momentum = larger_or_nan(momentum, residual.abs() / passed.max(f64::MIN_POSITIVE));
        }
        let residual =
            energy(system, end) - energy(system, begin) + all.dissipated + self.loss - self.impulse_work - all.work;
        let fallen =
            system.particles.iter().zip(&begin.particles).zip(&end.particles).fold(0.0_f64, |sum, ((p, a), b)| {
                // Two bodies that fall together for long are told apart from what they have fallen.
                sum + (p.mass * system.gravity * (b[0] - a[0])).abs()
            });
        let passed = (all.work_modulus + all.dissipated + self.loss.abs() + fallen).max(energy(system, begin).abs());
        (momentum, residual.abs() / passed.max(f64::MIN_POSITIVE))
    }
}
