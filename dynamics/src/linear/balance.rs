//! The audit of a linear run: what passed through it, by Gauss-Legendre panels over the moments of all its cycles at once,
//! held against the states at both ends.

use super::cycle::{Affine, Cycle};
use super::moments::Moments;
use crate::arithmetic::matrix::dot;
use crate::arithmetic::quadrature;
use crate::budget;
use crate::contact::{Relative, Side};
use crate::contact_state::block::pairs;
use crate::flow::Flow;
use crate::response::audit::{Audit, Passed, State};
use crate::system::HybridSystem;

/// Adds the cycles that `at` are the states of at the beginning.
pub(super) fn pass(system: &HybridSystem, flow: &Flow, answer: &[f64], cycle: &Cycle, at: &Moments, audit: &mut Audit) {
    let n = system.mass.order;
    let dissipation = flow.dissipation(system);
    let push = dot(&system.force_row, answer);
    let mut now = at.clone();
    for segment in &cycle.segments {
        if segment.impulse != 0.0 {
            let [_, rate] = flow.left(&now.mean.concat(), 0.0, 0.0, segment.drive);
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
            for [x, weight] in quadrature::TEN {
                let t = t0 + x * h;
                let moments = start.moved(&Affine::flow(flow, t));
                let drive = flow.drive_after(segment.drive, t);
                let [p, rate] = flow.left(&moments.mean.concat(), 0.0, segment.level, drive);
                let w = weight * h * at.count;
                passed.position.iter_mut().zip(&p).for_each(|(sum, q)| *sum += w * q);
                let force = segment.level + drive.sine;
                passed.drive(w, force, force * dot(&system.force_row, &rate[..n]));
                let mut dissipated = dissipation.of_moments(&moments.second());
                if system.drive.harmonic.is_some() {
                    let [_, driven] = flow.at_rest(0.0, drive);
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
    let structure = [&p[..n], &rate[..n]];
    let relative = |j: usize| {
        flow.modes.slot(j).map_or(Relative::default(), |slot| Relative { gap: p[n + slot], rate: rate[n + slot] })
    };
    let absolute = |(j, particle)| relative(j).absolute(particle, Side::Floor, structure);
    let particles = system.particles.iter().enumerate().map(absolute).collect();
    State::new(system, &flow.modes.contacts, structure, particles, |j, _| relative(j).gap)
}
