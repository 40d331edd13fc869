//! The time history: samples of the segments that it covers.

use super::March;
use super::effects::Effects;
use crate::arithmetic::lanes::WIDTH;
use crate::contact::Side;
use crate::flow::signals::{self, Row};
use crate::options::trace::TraceRequest;
use crate::response::sample::{Sample, SampledParticle};
use crate::search::guards;
use crate::system::{DrivePhase, Particle};

impl<E: Effects> March<'_, E> {
    /// Samples of the time history that fall into the segment; one at its end is taken by the next segment, after the jump.
    pub(super) fn sample(&mut self, request: TraceRequest, length: f64, drive: DrivePhase) {
        if !request.covers(self.cycle) {
            return;
        }
        let flow = &self.flow;
        let period = self.system.drive.period;
        let mut c = self.c.clone();
        let taken = (self.cycle - request.from_cycle) * request.samples;
        for i in (self.response.trace.len() as u64).saturating_sub(taken)..request.samples {
            let instant = request.instant(i, period);
            let t = instant - self.time;
            if t >= length {
                break;
            }
            let kernels = flow.kernels(t);
            flow.advance_all(&kernels, &self.c, flow.drive_after(drive, t), &mut c);
            let anywhere = |row: &Row| {
                let kernel = |k: usize| kernels[k / WIDTH].at(k % WIDTH);
                signals::motion(&flow.blocks, row.phases(&self.c), row.rest(self.level), kernel, t)
            };
            let [displacement, velocity, acceleration, _] = anywhere(flow.rows.row(flow.rows.observed[0]));
            let sampled = |(j, particle): (usize, &Particle)| {
                let contact = self.contacts[j];
                let faces = [Side::Floor, Side::Ceiling].map(|side| anywhere(flow.face(self.system, j, side))[0]);
                let gap = match (contact.face(particle), flow.rows.guards[j].compression) {
                    (None, _) => guards::fly(flow, j, self.paths[j], &self.signals, self.particles[j], &c, t).gap,
                    (Some(_), Some(compression)) => anywhere(flow.rows.row(compression))[0],
                    (Some(_), None) => self.particles[j].gap,
                };
                SampledParticle::new(particle, contact, faces, gap)
            };
            let sample = Sample {
                time: self.cycle as f64 * period + instant,
                displacement,
                velocity,
                acceleration,
                damping: self.equivalent.or(self.flow.modes.damping.first().copied()).unwrap_or(0.0),
                half_cycle_rms: self.half.last,
                particles: self.system.particles.iter().enumerate().map(sampled).collect(),
            };
            self.response.trace.push(sample);
        }
    }
}
