//! Runs without loss: each segment is followed in twice the digits, and its end is rounded once.
//!
//! No error dies away there, and an error of the same sign in each segment adds up. Two come from the march itself. The gap of a
//! particle in flight is the difference of u + φ·q, which falls freely, and of the place of its face: both are taken from the state
//! at the start. And a particle that arrives at a face is put there to the bit, though the clock gives the instant of it to one
//! rounding only. To move the particle alone would change its energy; so the whole state moves on by the time that the clock lacks.

use super::March;
use super::effects::Effects;
use crate::arithmetic::exact::Twice;
use crate::contact::{Change, Crossing, Relative, Side};
use crate::search::{Found, Guard, guards};
use crate::system::{DrivePhase, Law};

/// A time that the clock lacks is shorter than this, in units of the fastest block's time; what is longer is not rounding.
const LONGEST_LACK: f64 = 1e-12;

/// What such a run keeps beside its state.
#[derive(Default)]
pub(super) struct Doubled {
    /// Low parts of the block coordinates at both ends of the segment.
    pub(super) low: Vec<f64>,
    end_low: Vec<f64>,
    /// (p, p′) at the end of the segment.
    end: Vec<Twice>,
    /// The state at its start.
    q: Vec<f64>,
    rate: Vec<f64>,
    particles: Vec<Relative>,
}

impl<E: Effects> March<'_, E> {
    /// No error dies away.
    #[inline(always)]
    pub(super) fn is_undamped(&self) -> bool {
        E::ALL && self.undamped
    }

    /// The state at the end of a segment.
    #[cold]
    pub(super) fn arrive_doubled(&mut self, length: f64, end_drive: DrivePhase, found: Found) {
        let doubled = &mut self.doubled;
        doubled.q.clone_from(&self.q);
        doubled.rate.clone_from(&self.rate);
        doubled.particles.clone_from(&self.particles);
        let Doubled { low, end_low, end, .. } = doubled;
        self.flow.turn_doubled(&self.search.kernels, [&self.c, low], &mut self.c_end, end_low);
        self.flow.leave_doubled([&self.c_end, end_low], length, self.level, end_drive, end);
        let lack = match found {
            Found::Event { guard, .. } if length > 0.0 => self.lack(self.search.guards[guard], length),
            _ => 0.0,
        };
        if lack != 0.0 {
            self.flow.move_on(lack, &self.c_end, length, self.level, &mut self.doubled.end);
        }
        self.arrive(length, end_drive, None);
        let (places, rates) = self.doubled.end.split_at(self.flow.order);
        self.q.iter_mut().zip(places).for_each(|(q, place)| *q = place.rounded());
        self.rate.iter_mut().zip(rates).for_each(|(rate, of)| *rate = of.rounded());
        if self.flow.turns_below(guards::SHORT, length) {
            // Gaps have been followed by their derivatives.
            return;
        }
        let n = self.system.mass.order;
        for (i, &j) in self.flow.modes.attached.iter().enumerate() {
            self.particles[j] = Relative { gap: self.q[n + i], rate: self.rate[n + i] };
        }
        for j in 0..self.particles.len() {
            if self.contacts[j].face(&self.system.particles[j]).is_none() {
                let [q, rate] = [&self.q, &self.rate].map(|all| all[..n].iter().copied().map(Twice::of));
                let [gap, rate] = self.flown(j, [length, lack], q, rate);
                self.particles[j] = Relative { gap: gap.rounded(), rate: rate.rounded() };
            }
        }
    }

    /// Seconds from the time of an event by the clock to the instant at which its particle is at the face.
    fn lack(&self, Guard { particle: j, crossing, .. }: Guard, length: f64) -> f64 {
        if crossing == Crossing::HalfCycle || self.system.drive.harmonic.is_some() {
            return 0.0;
        }
        let particle = &self.system.particles[j];
        let contact = self.contacts[j];
        let side = contact.side();
        let target = match (crossing, side.face(particle).law) {
            (Crossing::To(Side::Floor) | Crossing::Own(Change::Recovers), _) => 0.0,
            (Crossing::Own(Change::Releases), Law::Resilient { .. }) if contact.presses(particle) => 0.0,
            (Crossing::To(Side::Ceiling), _) if !self.has_walls() => particle.gap,
            (Crossing::Own(Change::Stops), law) => -side.away() * law.depth(),
            _ => return 0.0,
        };
        let (n, order) = (self.system.mass.order, self.flow.order);
        let (places, rates) = self.doubled.end.split_at(order);
        let [mut gap, rate] = match self.flow.modes.slot(j) {
            Some(slot) => [places[n + slot], rates[n + slot]],
            None => self.flown(j, [length, 0.0], places.iter().copied(), rates.iter().copied()),
        };
        gap.add(-target);
        let lack = -gap.rounded() / rate.high;
        if lack.abs() <= LONGEST_LACK * self.flow.series.unit { lack } else { 0.0 }
    }

    /// Gap and rate of particle j in flight after a time, in two parts, with the structure at `places` and `rates`.
    fn flown(
        &self,
        j: usize,
        [time, lack]: [f64; 2],
        places: impl Iterator<Item = Twice>,
        rates: impl Iterator<Item = Twice>,
    ) -> [Twice; 2] {
        let Doubled { q: old, rate: old_rate, particles, .. } = &self.doubled;
        let here = particles[j];
        let row = &self.contacts[j].side().face(&self.system.particles[j]).row;
        let gravity = self.system.gravity;
        let (mut gap, mut rate) = (Twice::of(here.gap), Twice::of(here.rate));
        // y′ at the start, and its mean in the time.
        row.iter().zip(old_rate).for_each(|(phi, rate_then)| rate.add_product(*phi, *rate_then));
        let mut mean = rate;
        mean.add_product(-0.5 * gravity, time);
        gap.add_times(time, mean.settled());
        row.iter().zip(old).for_each(|(phi, place)| gap.add_product(*phi, *place));
        rate.add_product(-gravity, time);
        gap.low += lack * rate.high;
        rate.low -= lack * gravity;
        row.iter().zip(places).for_each(|(phi, place)| gap.add_times(-phi, place));
        row.iter().zip(rates).for_each(|(phi, rate_now)| rate.add_times(-phi, rate_now));
        [gap.settled(), rate.settled()]
    }
}
