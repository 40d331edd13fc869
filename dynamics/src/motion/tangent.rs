//! Tangent vectors along the tape: how far a moved start is from the run at every instant.
//!
//! A vector is (δq, δy, δq′, δy′) with the particles' places as an observer at rest sees them, so that a change
//! of contact state does not transform it.

use std::rc::Rc;

use super::tape::{At, Crossing, Cycle, Jump, Step};
use crate::arithmetic::few::Few;
use crate::arithmetic::matrix::dot;
use crate::arithmetic::wide::widened;
use crate::contact::Side;
use crate::contact_state::bank::Kernels;
use crate::flow::Flow;
use crate::system::{DrivePhase, HybridSystem};

/// Carries vectors along a tape.
pub(super) struct Tangent<'a> {
    system: &'a HybridSystem,
    /// Of the contact states met so far: their p″ under gravity and under a unit force.
    loads: Vec<(Rc<Flow>, Vec<f64>, Vec<f64>)>,
    // Work space.
    kernels: Vec<Kernels>,
    c: Vec<f64>,
    c_end: Vec<f64>,
    p: Vec<f64>,
    bends: Vec<f64>,
    derivatives: [Vec<f64>; 2],
}

impl<'a> Tangent<'a> {
    pub(super) fn new(system: &'a HybridSystem) -> Self {
        Self {
            system,
            loads: Vec::new(),
            kernels: Vec::new(),
            c: Vec::new(),
            c_end: Vec::new(),
            p: Vec::new(),
            bends: Vec::new(),
            derivatives: Default::default(),
        }
    }

    /// Numbers of a vector.
    pub(super) fn size(&self) -> usize {
        2 * (self.system.mass.order + self.system.particles.len())
    }

    /// Through a step of a cycle.
    pub(super) fn carry(&mut self, cycle: &Cycle, step: &Step, vectors: &mut [Vec<f64>]) {
        match step {
            Step::Flow(flow, length) => self.flow(flow, *length, vectors),
            Step::Timed(jumps) => {
                for vector in vectors {
                    jumps.iter().for_each(|jump| self.jump(jump, vector));
                }
            }
            Step::Event(crossing) => self.cross(cycle, crossing, vectors),
        }
    }

    widened! {
        fn flow | flow_wide (&mut self, flow: &Flow, length: f64, vectors: &mut [Vec<f64>]) = flow_by_registers
    }

    #[inline(always)]
    fn flow_by_registers(&mut self, flow: &Flow, length: f64, vectors: &mut [Vec<f64>]) {
        let (n, order) = (self.system.mass.order, flow.order);
        let half = n + self.system.particles.len();
        self.kernels.resize(flow.bank.blocks.len(), Kernels::NONE);
        flow.bank.kernels(&flow.blocks, length, &mut self.kernels);
        for c in [&mut self.c, &mut self.c_end] {
            c.clear();
            c.resize(flow.width(), 0.0);
        }
        self.p.resize(2 * order, 0.0);
        for vector in vectors {
            for (p, x) in self.p.chunks_exact_mut(order.max(1)).zip(vector.chunks_exact(half)) {
                p[..n].copy_from_slice(&x[..n]);
                for (i, &j) in flow.modes.attached.iter().enumerate() {
                    let row = &flow.modes.contacts[j].side().face(&self.system.particles[j]).row;
                    p[n + i] = x[n + j] - dot(row, &x[..n]);
                }
            }
            flow.modes.to_blocks.sum_by_registers(&self.p, &mut self.c);
            flow.advance_all(&self.kernels, &self.c, DrivePhase::default(), &mut self.c_end);
            flow.modes.columns.sum_by_registers(&self.c_end, &mut self.p);
            for (j, particle) in self.system.particles.iter().enumerate() {
                if flow.modes.contacts[j].face(particle).is_none() {
                    vector[n + j] += length * vector[half + n + j];
                }
            }
            for (p, x) in self.p.chunks_exact(order.max(1)).zip(vector.chunks_exact_mut(half)) {
                x[..n].copy_from_slice(&p[..n]);
                for (j, particle) in self.system.particles.iter().enumerate() {
                    if let Some(face) = flow.modes.contacts[j].face(particle) {
                        x[n + j] = dot(&face.row, &p[..n]);
                    }
                }
                for (i, &j) in flow.modes.attached.iter().enumerate() {
                    x[n + j] += p[n + i];
                }
            }
        }
    }

    fn cross(&mut self, cycle: &Cycle, crossing: &Crossing, vectors: &mut [Vec<f64>]) {
        let n = self.system.mass.order;
        let [before, after] =
            [&crossing.before, &crossing.after].map(|instant| cycle.at(instant, self.system.particles.len()));
        let timing = crossing.gap.and_then(|(j, side)| {
            let row = &side.face(&self.system.particles[j]).row;
            let speed = before.particles[j] - dot(row, &before.rate[..n]);
            (speed != 0.0).then_some((j, row, speed))
        });
        let Some((j, row, speed)) = timing else {
            for vector in vectors {
                crossing.jumps.iter().for_each(|jump| self.jump(jump, vector));
            }
            return;
        };
        let mut derivatives = std::mem::take(&mut self.derivatives);
        for (derivative, at) in derivatives.iter_mut().zip([before, after]) {
            self.derivative(at, crossing.force, derivative);
        }
        let [before, after] = &derivatives;
        for vector in vectors {
            let late = -(vector[n + j] - dot(row, &vector[..n])) / speed;
            vector.iter_mut().zip(before).for_each(|(x, f)| *x += late * f);
            crossing.jumps.iter().for_each(|jump| self.jump(jump, vector));
            vector.iter_mut().zip(after).for_each(|(x, f)| *x -= late * f);
        }
        self.derivatives = derivatives;
    }

    fn jump(&self, jump: &Jump, vector: &mut [f64]) {
        let n = self.system.mass.order;
        let (places, rates) = vector.split_at_mut(n + self.system.particles.len());
        let row = |particle: usize, side: Side| &side.face(&self.system.particles[particle]).row;
        let speed = |rates: &[f64], particle: usize, side: Side| {
            side.away() * (rates[n + particle] - dot(row(particle, side), &rates[..n]))
        };
        let speeds: Few<f64> = jump.kicks.iter().map(|kick| speed(rates, kick.particle, kick.side)).collect();
        for (kick, by) in jump.kicks.iter().zip(jump.impulses.chunks_exact(speeds.len().max(1))) {
            let push = kick.side.away() * dot(by, &speeds);
            rates[n + kick.particle] += push;
            let impulse = push * self.system.particles[kick.particle].mass;
            rates[..n].iter_mut().zip(&kick.answer[..]).for_each(|(rate, answer)| *rate -= impulse * answer);
        }
        if jump.holds {
            for kick in &jump.kicks {
                places[n + kick.particle] = dot(row(kick.particle, kick.side), &places[..n]);
                rates[n + kick.particle] = dot(row(kick.particle, kick.side), &rates[..n]);
            }
        }
    }

    /// x′ at an instant.
    fn derivative(&mut self, at: At<'_>, force: f64, derivative: &mut Vec<f64>) {
        let (n, order) = (self.system.mass.order, at.flow.order);
        let modes = &at.flow.modes;
        let known = self.loads.iter().position(|(flow, ..)| Rc::ptr_eq(flow, at.flow));
        let place = known.unwrap_or_else(|| {
            let push = modes.answer(self.system, &self.system.force_row);
            self.loads.push((Rc::clone(at.flow), modes.falls(self.system), push));
            self.loads.len() - 1
        });
        let (_, falls, push) = &self.loads[place];
        let accelerations = modes.accelerations(self.system);
        self.bends.clear();
        self.bends.extend((0..order).map(|i| {
            let (by_place, by_rate) = accelerations[i].split_at(order);
            dot(by_place, at.p) + dot(by_rate, at.rate) + falls[i] + force * push[i]
        }));
        let bends = &self.bends;
        derivative.clear();
        derivative.extend_from_slice(&at.rate[..n]);
        derivative.extend_from_slice(at.particles);
        derivative.extend_from_slice(&bends[..n]);
        for (j, particle) in self.system.particles.iter().enumerate() {
            derivative.push(match modes.contacts[j].face(particle) {
                None => -self.system.gravity,
                Some(face) => dot(&face.row, &bends[..n]) + modes.slot(j).map_or(0.0, |i| bends[n + i]),
            });
        }
    }
}
