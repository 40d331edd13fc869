//! The audit of a linear run: what passed through it, by Gauss-Legendre panels over the moments of all its cycles at once,
//! held against the states at both ends.

use super::cycle::{Affine, Cycle, leave};
use super::moments::Moments;
use crate::dynamics::audit::{Audit, Passed, State};
use crate::dynamics::block::pairs;
use crate::dynamics::budget;
use crate::dynamics::contact::{Relative, Side};
use crate::dynamics::flow::Flow;
use crate::dynamics::integral::GAUSS;
use crate::dynamics::system::{HybridSystem, dot};

/// Adds the cycles that `at` are the states of at the beginning.
pub(super) fn pass(system: &HybridSystem, flow: &Flow, answer: &[f64], cycle: &Cycle, at: &Moments, audit: &mut Audit) {
    let n = system.mass.order;
    let dissipation = flow.dissipation(system);
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
        while t0 < segment.length && !budget::spend(4) {
            let there = start.moved(&Affine::flow(flow, t0));
            let squares: Vec<[f64; 4]> =
                pairs(flow.own).zip(there.second()).filter(|((k, l), _)| k == l).map(|(_, moment)| moment).collect();
            let size = |i: usize| squares[i / 2][3 * (i % 2)].max(0.0).sqrt();
            let h = dissipation.panel(system, &flow.modes, size).min(segment.length - t0);
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
                let mut dissipated = dissipation.of_moments(&moments.second());
                if system.drive.harmonic.is_some() {
                    let (_, driven) = leave(flow, &vec![0.0; 2 * flow.order], 0.0, drive);
                    dissipated += dissipation.beside(system, &flow.modes, &driven, &moments.first(), moments.count);
                }
                passed.dissipated += weight * h * dissipated;
            }
            t0 += h;
        }
        audit.add(&passed);
    }
}

/// The physical state, every particle on its floor.
pub(super) fn state(system: &HybridSystem, flow: &Flow, p: &[f64], rate: &[f64]) -> State {
    let n = system.mass.order;
    let mut state = State { q: p[..n].to_vec(), rate: rate[..n].to_vec(), ..State::default() };
    for (j, particle) in system.particles.iter().enumerate() {
        let slot = flow.modes.attached.iter().position(|&other| other == j);
        let [gap, speed] = slot.map_or([0.0; 2], |slot| [p[n + slot], rate[n + slot]]);
        let here = Relative { gap, rate: speed };
        state.particles.push(here.absolute(particle, Side::Floor, [&state.q, &state.rate]));
        state.compressions.push(particle.floor.law.stiffness().map_or([0.0; 2], |stiffness| [stiffness, gap]));
    }
    state
}
