//! Where a run ended as the start of a run in a neighbouring system: another strength or frequency of the drive, another gap.
//!
//! A run ends with a whole cycle, so that the next one starts at the phase of the drive at which the last one stopped; carried
//! are places and rates of the structure and, relative to their faces, of the particles, with their contacts.

use crate::contact::Side;
use crate::options::{Placed, StartState};
use crate::system::{Contact, HybridSystem, Particle};

impl StartState {
    /// The same state in this system. Surfaces that are nearer now displace a particle by no more than they must: one that would
    /// lie beyond the ceiling or a limit stop lies at it. `None` if the system has other coordinates or particles, or lacks a
    /// face or a stop that a particle touches, or room between a floor and a ceiling.
    #[must_use]
    pub fn carried_to(&self, system: &HybridSystem) -> Option<Self> {
        let Self::Given { q, rate, particles } = self else { return Some(self.clone()) };
        if q.len() != system.mass.order || particles.len() != system.particles.len() {
            return None;
        }
        let placed = particles.iter().zip(&system.particles).map(|(at, particle)| place(*at, particle, q));
        Some(Self::Given { q: q.clone(), rate: rate.clone(), particles: placed.collect::<Option<_>>()? })
    }
}

/// A particle in its new enclosure, on a structure that stands so.
fn place(at: Placed, particle: &Particle, q: &[f64]) -> Option<Placed> {
    let Placed { contact, gap, rate } = at;
    let side = contact.side();
    if (side == Side::Ceiling || contact.is_between()) && particle.ceiling.is_none() {
        return None;
    }
    if contact == Contact::Flight {
        let room = particle.lift(q).map_or(f64::INFINITY, |lift| particle.gap + lift);
        return (room >= 0.0).then_some(Placed { contact, gap: gap.min(room), rate });
    }
    let on_stop = matches!(contact, Contact::FloorStop | Contact::CeilingStop);
    let Some(stop) = side.face(particle).law.stop() else { return (!on_stop).then_some(at) };
    let deepest = -side.away() * stop.length;
    if on_stop {
        return Some(Placed { contact, gap: deepest, rate: 0.0 });
    }
    let gap = if side == Side::Ceiling { gap.min(deepest) } else { gap.max(deepest) };
    Some(Placed { contact, gap, rate })
}
