//! Samples of a time history: the motion at one instant, evaluated on the exact flow.

use crate::contact::{Hold, Side};
use crate::system::{Contact, Particle};

/// The motion at one instant.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Sample {
    /// s.
    pub time: f64,
    /// Observed displacement, m.
    pub displacement: f64,
    /// m/s.
    pub velocity: f64,
    /// m/s².
    pub acceleration: f64,
    /// Every particle between its faces, in the order of the system.
    pub particles: Vec<SampledParticle>,
    /// Contact damping in force on the first one, N s/m.
    pub damping: f64,
    /// RMS acceleration of the last complete half cycle, m/s².
    pub half_cycle_rms: f64,
}

impl Sample {
    /// The first particle; zeros without any.
    #[must_use]
    pub fn first(&self) -> SampledParticle {
        self.particles.first().copied().unwrap_or_default()
    }
}

/// A particle and its faces, which are where they are, compressed or not.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct SampledParticle {
    /// y, m.
    pub height: f64,
    /// Floor and ceiling surface, m.
    pub floor: f64,
    /// m.
    pub ceiling: f64,
    /// Where they would be if they were rigid.
    pub rigid_floor: f64,
    /// m.
    pub rigid_ceiling: f64,
}

impl SampledParticle {
    /// `floor` and `ceiling` are φ·q of each, `gap` is measured from the one the contact refers to.
    pub(crate) fn new(particle: &Particle, contact: Contact, [floor, ceiling]: [f64; 2], gap: f64) -> Self {
        let side = contact.side();
        let clearance = if particle.ceiling.is_some() { particle.gap } else { f64::NAN };
        let (rigid_floor, rigid_ceiling) = (floor, ceiling + clearance);
        let height = side.of(floor, ceiling + particle.gap) + gap;
        let mut sampled = Self { height, floor: rigid_floor, ceiling: rigid_ceiling, rigid_floor, rigid_ceiling };
        let resilient = contact.face(particle).is_some_and(|face| !face.law.is_rigid());
        let across = contact.across() == Hold::Pressed;
        let compressed = [resilient.then_some(side), across.then_some(side.opposite())];
        for side in compressed.into_iter().flatten() {
            match side {
                Side::Floor => sampled.floor = height,
                Side::Ceiling => sampled.ceiling = height,
            }
        }
        sampled
    }
}
