//! What a run keeps: events, sums over the averaged window, the balances, the time history.

use super::Run;
use super::stretch::Tally;
use super::vector::Vector;
use crate::arithmetic::matrix::dot;
use crate::contact::Side;
use crate::error::EngineError;
use crate::flow::sums::{About, Sums};
use crate::response::audit::State;
use crate::response::extremes::Extremes;
use crate::response::sample::{Sample, SampledParticle};
use crate::response::{CycleRates, Observed};
use crate::system::{Event, EventKind, Particle};

impl Observed {
    /// Motion no faster than what rounding makes is none.
    pub(super) fn rest_below(&mut self, rounding: f64) {
        let window = self.window();
        if !(window.rms_velocity() <= rounding) {
            return;
        }
        for half in &mut self.halves {
            (half.velocity_square, half.deviation_square) = (0.0, 0.0);
            half.displacement = window.mean_displacement() * half.duration;
        }
        if self.extremes.velocity[0].is_finite() {
            self.extremes = Extremes { displacement: [window.mean_displacement(); 2], velocity: [0.0; 2] };
        }
    }
}

impl<V: Vector> Run<'_, V> {
    pub(super) fn record(&mut self, particle: usize, kind: EventKind, approach: f64, departure: f64) {
        self.record_contact(particle, kind, [approach, departure], kind.is_contact());
    }

    pub(super) fn record_contact(&mut self, particle: usize, kind: EventKind, speeds: [f64; 2], lasts: bool) {
        let [approach, departure] = speeds;
        let time = (self.step - self.schedule.cycle(self.cycle)) as f64 * self.time_step;
        let event = Event { cycle: self.cycle, time, particle, kind, approach, departure, lasts };
        self.response.enter(event, self.options.averaged(), self.options);
    }

    /// The structure's velocities after the impulse that opens a cycle.
    pub(super) fn open_cycle(&mut self) {
        if self.options.cycle_rates {
            let after = self.layout.structure(self.motion.state.as_ref())[1].to_vec();
            self.response.cycle_rates.push(CycleRates { after, before: Vec::new() });
        }
    }

    /// Books a cycle's sums.
    pub(super) fn end_cycle(&mut self) -> Result<(), EngineError> {
        let next = Tally::new(self.layout.size(), self.watch.more.len(), self.options.extremes);
        let tally = std::mem::replace(&mut self.tally, next);
        if !tally.velocity_square.is_finite() {
            return Err(EngineError::NotFinite { cycle: self.cycle });
        }
        if self.options.cycle_rates {
            let before = self.layout.structure(self.motion.state.as_ref())[1].to_vec();
            if let Some(cycle) = self.response.cycle_rates.last_mut() {
                cycle.before = before;
            }
        }
        let weight = self.time_step;
        if self.options.averaged().holds(self.cycle) {
            for (of, range) in self.response.observed.iter_mut().zip(&tally.extremes) {
                of.extremes.take(range.displacement[0], range.velocity[0]);
                of.extremes.take(range.displacement[1], range.velocity[1]);
            }
            let half = self.options.averaged().half(self.cycle);
            let summed = |displacement: f64, [square, velocity_square]: [f64; 2]| {
                let [moved, square] =
                    if self.options.displacement { [displacement * weight, square * weight] } else { [0.0; 2] };
                let (duration, velocity_square) = (tally.steps as f64 * weight, velocity_square * weight);
                Sums::of(&[About { duration, place: 0.0, moved, square, velocity_square }])
            };
            let first = (self.watch.displacement.dot(&tally.state), [tally.displacement_square, tally.velocity_square]);
            let more =
                self.watch.more.iter().zip(&tally.more).map(|([row, _], squares)| (row.dot(&tally.state), *squares));
            for ((displacement, squares), of) in std::iter::once(first).chain(more).zip(&mut self.response.observed) {
                of.halves[half].add(summed(displacement, squares));
            }
        }
        if self.audit.is_some() {
            let passed = &mut self.passed;
            passed.duration += tally.steps as f64 * weight;
            passed.position.iter_mut().zip(tally.state.as_ref()).for_each(|(sum, q)| *sum += q * weight);
            passed.dissipated += tally.passed.dissipated * weight;
            passed.force += tally.passed.force * weight;
            passed.force_modulus += tally.passed.force_modulus * weight;
            passed.work += tally.passed.work;
            passed.work_modulus += tally.passed.work_modulus;
        }
        Ok(())
    }

    /// Half a sample at the end of a smooth piece of the motion, added or taken off: sums over steps become trapezoidal.
    pub(super) fn seam(&mut self, half: f64) {
        if self.audit.is_none() {
            return;
        }
        let state = &self.motion.state;
        let weight = half * self.time_step;
        self.passed.position.iter_mut().zip(state.as_ref()).for_each(|(sum, q)| *sum += weight * q);
        for row in &self.known[self.now].propagator.dissipation {
            let rate = row.dot(state);
            self.passed.dissipated += weight * rate * rate;
        }
    }

    /// The velocity, m/s, that steps can build up out of a rest in which nothing moves: every step rounds the accelerations of
    /// springs that carry weights, ω² x, by a part in ε, and none of it may be lost until the end: ε ω² x T.
    pub(super) fn rounding_of(&self, rest: &[f64]) -> f64 {
        let omega = self.response.highest_frequency;
        let deflection = rest.iter().fold(0.0_f64, |most, x| most.max(x.abs()));
        f64::EPSILON * omega * omega * deflection * self.options.cycles() as f64 * self.system.drive.period
    }

    pub(super) fn audit_state(&self) -> State {
        let structure = self.layout.structure(self.motion.state.as_ref());
        let particles = (0..self.contacts.len()).map(|j| self.absolute(j)).collect();
        State::new(self.system, &self.contacts, structure, particles, |j, side| self.relative(j, side).gap)
    }

    /// Keeps the motion at this step, and looks for the next step to keep.
    pub(super) fn sample(&mut self) {
        let [q, rate] = self.layout.structure(self.motion.state.as_ref());
        let sampled = |(j, particle): (usize, &Particle)| {
            let side = self.contacts[j].side();
            let faces = [Side::Floor, Side::Ceiling].map(|side| dot(&side.face(particle).row, q));
            SampledParticle::new(particle, self.contacts[j], faces, self.relative(j, side).gap)
        };
        let sample = Sample {
            time: self.step as f64 * self.time_step,
            displacement: dot(&self.system.observed_rows[0], q),
            velocity: dot(&self.system.observed_rows[0], rate),
            acceleration: self.known[self.now].propagator.acceleration.at(&self.motion.state, self.motion.force()),
            damping: if self.contacts.is_empty() { 0.0 } else { self.damping(0, self.contacts[0].side()) },
            half_cycle_rms: self.motion.half.map_or(0.0, |half| half.last),
            particles: self.system.particles.iter().enumerate().map(sampled).collect(),
        };
        self.response.trace.push(sample);
        self.seek_sample(self.step + 1);
    }

    /// The first step from `from` on that is nearest to an instant asked for.
    pub(super) fn seek_sample(&mut self, from: u64) {
        let next = &mut self.samples;
        let Some(request) = self.options.trace.filter(|request| request.samples > 0) else {
            next.step = u64::MAX;
            return;
        };
        while next.cycle < request.to_cycle {
            next.step = self.schedule.nearest(next.cycle, next.index as f64 / request.samples as f64);
            if next.step >= from {
                return;
            }
            next.index += 1;
            if next.index == request.samples {
                (next.cycle, next.index) = (next.cycle + 1, 0);
            }
        }
        next.step = u64::MAX;
    }
}
