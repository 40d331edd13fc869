//! The audit of a linear run: what passed through it, by Gauss-Legendre panels over the moments of all its cycles at once,
//! held against the states at both ends.

use super::cycle::{Affine, Cycle, leave};
use super::moments::{Moments, pairs};
use crate::dynamics::audit::{Audit, Passed, State};
use crate::dynamics::flow::{DrivePhase, Flow};
use crate::dynamics::integral::GAUSS;
use crate::dynamics::system::{HybridSystem, Law, dot};

/// Adds the cycles that `at` are the states of at the beginning.
pub(super) fn pass(system: &HybridSystem, flow: &Flow, answer: &[f64], cycle: &Cycle, at: &Moments, audit: &mut Audit) {
    let n = system.mass.order;
    let dissipation = Dissipation::new(system, flow);
    let push = dot(&system.force_row, answer);
    let mut now = at.clone();
    for segment in &cycle.segments {
        if segment.impulse != 0.0 {
            let (_, rate) = leave(flow, &now.mean(), 0.0, segment.drive);
            let work = segment.impulse * (dot(&system.force_row, &rate[..n]) + 0.5 * segment.impulse * push);
            audit.impulse(at.count * segment.impulse, at.count * work);
        }
        let start = now.moved(&segment.jump);
        now = start.moved(&segment.flow);
        let mut passed = Passed { position: vec![0.0; n], duration: at.count * segment.length, ..Passed::default() };
        let mut t0 = 0.0;
        while t0 < segment.length {
            let h = dissipation.panel(flow, &start.moved(&Affine::flow(flow, t0))).min(segment.length - t0);
            for [x, weight] in GAUSS {
                let t = t0 + x * h;
                let moments = start.moved(&Affine::flow(flow, t));
                let drive = flow.drive_after(segment.drive, t);
                let (p, rate) = leave(flow, &moments.mean(), segment.level, drive);
                let w = weight * h * at.count;
                passed.position.iter_mut().zip(&p).for_each(|(sum, q)| *sum += w * q);
                let force = segment.level + drive.sine;
                let power = force * dot(&system.force_row, &rate[..n]);
                passed.force += w * force;
                passed.force_modulus += w * force.abs();
                passed.work += w * power;
                passed.work_modulus += w * power.abs();
                passed.dissipated += weight * h * dissipation.of(system, flow, &moments, drive);
            }
            t0 += h;
        }
        audit.add(&passed);
    }
}

/// q′ᵀ C q′ + Σ c w′² as a form of the block coordinates.
struct Dissipation {
    /// p′ of each unit of them.
    columns: Vec<Vec<f64>>,
    /// The form, pair of blocks by pair of blocks.
    pairs: Vec<[f64; 4]>,
}

impl Dissipation {
    fn new(system: &HybridSystem, flow: &Flow) -> Self {
        let still = DrivePhase::default();
        let column = |i: usize| {
            let mut c = vec![0.0; 2 * flow.order];
            c[i] = 1.0;
            leave(flow, &c, 0.0, still).1
        };
        let columns: Vec<Vec<f64>> = (0..2 * flow.order).map(column).collect();
        let damped: Vec<Vec<f64>> = columns.iter().map(|rate| against(system, flow, rate)).collect();
        let form = |(k, l): (usize, usize)| {
            let twice = if k == l { 1.0 } else { 2.0 };
            [(0, 0), (0, 1), (1, 0), (1, 1)].map(|(a, b)| twice * dot(&columns[2 * k + a], &damped[2 * l + b]))
        };
        let pairs = pairs(flow.own).map(form).collect();
        Self { columns, pairs }
    }

    /// Length of a panel: short against the force, and against every block that still moves visibly.
    fn panel(&self, flow: &Flow, now: &Moments) -> f64 {
        let size = |column: usize, square: f64| {
            self.columns[column].iter().fold(0.0_f64, |largest, x| largest.max(x.abs())) * square.max(0.0).sqrt()
        };
        let own = pairs(flow.own).zip(&now.second).filter(|((k, l), _)| k == l);
        let sizes: Vec<f64> = own.map(|((k, _), moment)| size(2 * k, moment[0]) + size(2 * k + 1, moment[3])).collect();
        let total: f64 = sizes.iter().sum();
        let driven = flow.blocks.get(flow.own).map_or(0.0, |block| block.radius);
        let fastest = (0..flow.own)
            .filter(|&k| sizes[k] > 1e-15 * total)
            .fold(driven, |fastest, k| fastest.max(flow.blocks[k].radius));
        if fastest > 0.0 { 1.5 / fastest } else { f64::INFINITY }
    }

    /// Summed over the cycles of the moments.
    fn of(&self, system: &HybridSystem, flow: &Flow, moments: &Moments, drive: DrivePhase) -> f64 {
        let mut sum = self
            .pairs
            .iter()
            .zip(&moments.second)
            .fold(0.0, |sum, (form, moment)| sum + form.iter().zip(moment).fold(0.0, |sum, (a, b)| sum + a * b));
        if system.drive.harmonic.is_some() {
            let (_, driven) = leave(flow, &vec![0.0; 2 * flow.order], 0.0, drive);
            let damped = against(system, flow, &driven);
            sum += moments.count * dot(&driven, &damped);
            for (column, first) in self.columns.iter().zip(moments.first.iter().flatten()) {
                sum += 2.0 * first * dot(column, &damped);
            }
        }
        sum
    }
}

/// What the dashpots push against rates p′.
fn against(system: &HybridSystem, flow: &Flow, rate: &[f64]) -> Vec<f64> {
    let n = system.mass.order;
    let mut force = system.damping.times(&rate[..n]);
    force.extend(flow.modes.attached.iter().zip(&rate[n..]).map(|(&j, rate)| flow.modes.damping[j] * rate));
    force
}

/// The physical state, every particle on its floor.
pub(super) fn state(system: &HybridSystem, flow: &Flow, p: &[f64], rate: &[f64]) -> State {
    let n = system.mass.order;
    let mut state =
        State { q: p[..n].to_vec(), rate: rate[..n].to_vec(), particles: Vec::new(), compressions: Vec::new() };
    for (j, particle) in system.particles.iter().enumerate() {
        let slot = flow.modes.attached.iter().position(|&other| other == j);
        let [gap, speed] = slot.map_or([0.0; 2], |slot| [p[n + slot], rate[n + slot]]);
        let face = &particle.floor.row;
        state.particles.push([dot(face, &state.q) + gap, dot(face, &state.rate) + speed]);
        state.compressions.push(match particle.floor.law {
            Law::Resilient { stiffness, .. } => [stiffness, gap],
            Law::Rigid { .. } => [0.0; 2],
        });
    }
    state
}
