//! The audit of a run: momentum and energy balanced over the averaged window, by other means than the run used.
//!
//! The run takes its integrals from closed forms of block coordinates; the audit integrates the physical motion by
//! Gauss-Legendre panels and holds it against the physical state at both ends:
//!
//! ρ·[M q′] + ∫ ρ·(K q + C q′) dt + Σ ρ·φ mp ([y′] + g t) = ρ·b (Σ J + ∫ F dt)
//!
//! [E] + ∫ q′·C q′ dt + ∫ Σ c w′² dt + impact losses = work of impulses + ∫ F b·q′ dt.
//!
//! Both hold in chaotic runs too. They cannot show an event that was missed altogether; that is the search's certificate.

use super::block::Kernel;
use super::flow::{DrivePhase, Flow};
use super::integral::GAUSS;
use super::system::{HybridSystem, dot};

/// The physical state at an instant.
#[derive(Debug, Clone, Default)]
pub(crate) struct State {
    pub(crate) q: Vec<f64>,
    pub(crate) rate: Vec<f64>,
    /// y, y′.
    pub(crate) particles: Vec<[f64; 2]>,
    /// Stiffness and compression of the face each particle presses into.
    pub(crate) compressions: Vec<[f64; 2]>,
}

/// What has passed since the window began.
#[derive(Debug, Default)]
pub(crate) struct Audit {
    begin: State,
    duration: f64,
    impulse: f64,
    impulse_passed: f64,
    impulse_work: f64,
    work_passed: f64,
    loss: f64,
    force: f64,
    force_work: f64,
    dissipated: f64,
    /// ∫ q and ∫ q′.
    position: Vec<f64>,
}

/// What passed between two instants, as another solver than the exact flow summed it up.
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

/// Kinetic, gravitational and elastic energy, J.
pub(crate) fn energy(system: &HybridSystem, state: &State) -> f64 {
    let mut energy = 0.5 * system.mass.form(&state.rate, &state.rate) + 0.5 * system.stiffness.form(&state.q, &state.q);
    for ((particle, [y, rate]), [stiffness, w]) in
        system.particles.iter().zip(&state.particles).zip(&state.compressions)
    {
        energy += particle.mass * (0.5 * rate * rate + system.gravity * y) + 0.5 * stiffness * w * w;
    }
    energy
}

impl Audit {
    pub(crate) fn begin(&mut self, state: State) {
        *self = Self { position: vec![0.0; state.q.len()], begin: state, ..Self::default() };
    }

    pub(crate) fn impulse(&mut self, impulse: f64, work: f64) {
        self.impulse += impulse;
        self.impulse_passed += impulse.abs();
        self.impulse_work += work;
        self.work_passed += work.abs();
    }

    /// Energy that left otherwise: in an impact, or with a spring that lets go while compressed (and takes it back).
    pub(crate) fn loss(&mut self, loss: f64) {
        self.loss += loss;
    }

    /// Adds what another solver has summed up.
    pub(crate) fn add(&mut self, passed: &Passed) {
        self.duration += passed.duration;
        self.position.iter_mut().zip(&passed.position).for_each(|(sum, q)| *sum += q);
        self.dissipated += passed.dissipated;
        self.force += passed.force;
        self.impulse_passed += passed.force_modulus;
        self.force_work += passed.work;
        self.work_passed += passed.work_modulus;
    }

    /// Integrates one segment in physical coordinates.
    pub(crate) fn segment(
        &mut self,
        system: &HybridSystem,
        flow: &Flow,
        start: &[f64],
        level: f64,
        drive: DrivePhase,
        length: f64,
    ) {
        let n = system.mass.order;
        let order = flow.order;
        let (mut p, mut rate, mut c) = (vec![0.0; order], vec![0.0; order], vec![0.0; 2 * flow.own]);
        let mut kernels: Vec<Kernel> = Vec::with_capacity(flow.blocks.len());
        self.duration += length;
        let mut t0 = 0.0;
        while t0 < length {
            // As long a panel as the blocks that still move allow.
            let h = flow.panel(start, t0, &mut c).min(length - t0);
            for [x, weight] in GAUSS {
                let t = t0 + x * h;
                kernels.clear();
                kernels.extend(flow.blocks.iter().map(|block| block.kernel(t)));
                flow.advance(&kernels, start, &mut c);
                let now = flow.drive_after(drive, t);
                flow.leave(&c, t, level, now, &mut p, &mut rate);
                let w = weight * h;
                self.position.iter_mut().zip(&p[..n]).for_each(|(sum, q)| *sum += w * q);
                self.dissipated += w * system.damping.form(&rate[..n], &rate[..n]);
                for (i, &j) in flow.modes.attached.iter().enumerate() {
                    self.dissipated += w * flow.modes.damping[j] * rate[n + i] * rate[n + i];
                }
                let force = level + now.sine;
                self.force += w * force;
                let power = force * dot(&system.force_row, &rate[..n]);
                self.force_work += w * power;
                self.work_passed += w * power.abs();
                self.impulse_passed += w * force.abs();
            }
            t0 += h;
        }
    }

    /// Momentum and energy residual, relative to what passed through the system.
    pub(crate) fn residuals(&self, system: &HybridSystem, end: &State) -> (f64, f64) {
        let begin = &self.begin;
        if self.duration == 0.0 {
            return (0.0, 0.0);
        }
        let change = |a: &[f64], b: &[f64]| b.iter().zip(a).map(|(b, a)| b - a).collect::<Vec<_>>();
        let moved = change(&begin.q, &end.q);
        let gained = system.mass.times(&change(&begin.rate, &end.rate));
        let held = system.stiffness.times(&self.position);
        let damped = system.damping.times(&moved);
        let mut momentum = 0.0_f64;
        for row in &system.momentum_rows {
            let mut residual = dot(row, &gained) + dot(row, &held) + dot(row, &damped);
            let mut passed = self.impulse_passed * dot(row, &system.force_row).abs();
            residual -= dot(row, &system.force_row) * (self.impulse + self.force);
            for state in [begin, end] {
                passed += dot(row, &system.mass.times(&state.rate)).abs();
            }
            for ((particle, a), b) in system.particles.iter().zip(&begin.particles).zip(&end.particles) {
                let share = dot(row, &particle.floor.row) * particle.mass;
                residual += share * (b[1] - a[1] + system.gravity * self.duration);
                passed += share.abs() * system.gravity * self.duration;
                // What a free particle or structure exchanges without any force: at least what it came with.
                for (state, [_, rate]) in [(begin, a), (end, b)] {
                    let face = dot(&particle.floor.row, &state.rate);
                    passed += share.abs() * (rate.abs() + face.abs());
                }
            }
            momentum = momentum.max(residual.abs() / passed.max(f64::MIN_POSITIVE));
        }
        let residual = energy(system, end) - energy(system, begin) + self.dissipated + self.loss
            - self.impulse_work
            - self.force_work;
        let fallen =
            system.particles.iter().zip(&begin.particles).zip(&end.particles).fold(0.0_f64, |sum, ((p, a), b)| {
                // Two bodies that fall together for long are told apart from what they have fallen.
                sum + p.mass * system.gravity * (b[0] - a[0]).abs()
            });
        let passed = (self.work_passed + self.dissipated + self.loss.abs() + fallen).max(energy(system, begin).abs());
        (momentum, residual.abs() / passed.max(f64::MIN_POSITIVE))
    }
}
