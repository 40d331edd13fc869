//! Contact: which face does what to a particle, where it is relative to a face, and what a crossing means.

pub(crate) mod collision;
pub(crate) mod mobility;
pub(crate) mod touch;

use crate::arithmetic::matrix::dot;
use crate::system::{Contact, EventKind, Face, Particle};

/// Below this relative speed, m/s, a particle sticks to a rigid face; what it would still have bounced is added to the time at
/// which the chatter ends.
pub(crate) const STICKING_SPEED: f64 = 1e-9;

/// Where a guard leads.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Crossing {
    /// Flight ends at a face.
    To(Side),
    /// Something happens at the face that the state refers to.
    Own(Change),
    /// At the one across, which moves by itself.
    Across(Change),
    /// The base acceleration changes its sign.
    HalfCycle,
}

/// What happens at a face.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Change {
    /// It reaches a particle that flies, or is still at the other one.
    Meets,
    /// It lets go.
    Releases,
    /// Compressed, it reaches its stop.
    Stops,
    /// Released, it is back at its place.
    Recovers,
    /// Released, it pushes again.
    PushesAgain,
}

impl Crossing {
    /// What happens to a particle whose state refers to the face on this side, and at which face.
    pub(crate) fn at(self, own: Side) -> Option<(Side, Change)> {
        match self {
            Self::To(side) => Some((side, Change::Meets)),
            Self::Own(change) => Some((own, change)),
            Self::Across(change) => Some((own.opposite(), change)),
            Self::HalfCycle => None,
        }
    }
}

/// Motion of a particle relative to the face it is at, or to the floor in flight.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(crate) struct Relative {
    /// u = y − φ_f·q, or w = y − φ_c·q − h at the ceiling, m.
    pub(crate) gap: f64,
    /// Its rate, m/s.
    pub(crate) rate: f64,
}

impl Relative {
    /// y and y′ of a particle that is here relative to the face on one side, of a structure at q, q′.
    pub(crate) fn absolute(self, particle: &Particle, side: Side, [q, rate]: [&[f64]; 2]) -> [f64; 2] {
        let row = &side.face(particle).row;
        [dot(row, q) + side.height(particle) + self.gap, dot(row, rate) + self.rate]
    }

    /// The other way round: where a particle at y, y′ is relative to the face on one side.
    pub(crate) fn of([y, y_rate]: [f64; 2], particle: &Particle, side: Side, [q, rate]: [&[f64]; 2]) -> Self {
        let row = &side.face(particle).row;
        Self { gap: y - dot(row, q) - side.height(particle), rate: y_rate - dot(row, rate) }
    }
}

/// What one face does to a particle.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Hold {
    /// It does not touch it.
    Away,
    /// Spring and dashpot push.
    Pressed,
    /// Rigid, or on its stop.
    Held,
    /// It cannot pull, and is still compressed.
    Released,
}

impl Contact {
    /// The side that it refers to; flight refers to the floor.
    #[inline]
    pub(crate) fn side(self) -> Side {
        let at_ceiling = matches!(
            self,
            Self::Ceiling
                | Self::CeilingStop
                | Self::CeilingReleased
                | Self::CeilingFloorReleased
                | Self::HeldByCeiling
                | Self::HeldByCeilingFloorReleased
        );
        if at_ceiling { Side::Ceiling } else { Side::Floor }
    }

    /// The face that the particle moves with: the one that holds it, else the one that it is pressed into, the floor first.
    #[inline]
    pub(crate) fn face(self, particle: &Particle) -> Option<&Face> {
        match self {
            Self::Flight | Self::FloorReleased | Self::CeilingReleased | Self::BothReleased => None,
            _ if self.side() == Side::Ceiling => particle.ceiling.as_ref(),
            _ => Some(&particle.floor),
        }
    }

    /// The same at the floor, where the ceiling is such a face and moves with it: to the structure both are one contact.
    pub(crate) fn at_floor_alike(self, particle: &Particle) -> Self {
        if self == Self::Flight || particle.ceiling.as_ref() != Some(&particle.floor) {
            return self;
        }
        match (self.at(Side::Floor, particle), self.at(Side::Ceiling, particle)) {
            (Hold::Away, hold) => Self::of(hold, Hold::Away, particle).unwrap_or(self),
            _ => self,
        }
    }

    /// Pressed into a resilient face.
    #[inline]
    pub(crate) fn presses(self, particle: &Particle) -> bool {
        let pressed = matches!(
            self,
            Self::Floor | Self::Ceiling | Self::Both | Self::FloorCeilingReleased | Self::CeilingFloorReleased
        );
        pressed && self.face(particle).is_some_and(|face| !face.law.is_rigid())
    }

    /// The floor touches the particle; one that has let go of it does not.
    #[must_use]
    pub fn touches_floor(self) -> bool {
        matches!(self, Self::Floor | Self::FloorStop | Self::FloorCeilingReleased | Self::HeldByFloorCeilingReleased)
            || self.touches_both()
    }

    /// The ceiling does.
    #[must_use]
    pub fn touches_ceiling(self) -> bool {
        matches!(
            self,
            Self::Ceiling | Self::CeilingStop | Self::CeilingFloorReleased | Self::HeldByCeilingFloorReleased
        ) || self.touches_both()
    }

    fn touches_both(self) -> bool {
        matches!(self, Self::Both | Self::HeldByFloor | Self::HeldByCeiling)
    }

    /// At both faces.
    pub(crate) fn is_between(self) -> bool {
        self >= Self::Both
    }

    /// What the face across from the one that the state refers to does.
    pub(crate) fn across(self) -> Hold {
        match self {
            _ if self.touches_both() => Hold::Pressed,
            _ if self.is_between() => Hold::Released,
            _ => Hold::Away,
        }
    }

    /// What the face that the state refers to does; a rigid one that touches holds.
    fn own(self, particle: &Particle) -> Hold {
        match self {
            Self::Flight => Hold::Away,
            Self::FloorReleased | Self::CeilingReleased | Self::BothReleased => Hold::Released,
            _ if self.presses(particle) => Hold::Pressed,
            _ => Hold::Held,
        }
    }

    /// What the face on one side does.
    pub(crate) fn at(self, side: Side, particle: &Particle) -> Hold {
        if self.side() == side { self.own(particle) } else { self.across() }
    }

    /// The contact of this floor and this ceiling; `None` for a particle that both hold.
    pub(crate) fn of(floor: Hold, ceiling: Hold, particle: &Particle) -> Option<Self> {
        let alone = |hold: Hold, side: Side| match hold {
            Hold::Away => Self::Flight,
            Hold::Held if side.face(particle).law.stop().is_some() => side.stopped(),
            Hold::Pressed | Hold::Held => side.pressed(),
            Hold::Released => side.released(),
        };
        Some(match (floor, ceiling) {
            (floor, Hold::Away) => alone(floor, Side::Floor),
            (Hold::Away, ceiling) => alone(ceiling, Side::Ceiling),
            (Hold::Pressed, Hold::Pressed) => Self::Both,
            (Hold::Pressed, Hold::Released) => Self::FloorCeilingReleased,
            (Hold::Released, Hold::Pressed) => Self::CeilingFloorReleased,
            (Hold::Released, Hold::Released) => Self::BothReleased,
            (Hold::Held, Hold::Pressed) => Self::HeldByFloor,
            (Hold::Held, Hold::Released) => Self::HeldByFloorCeilingReleased,
            (Hold::Pressed, Hold::Held) => Self::HeldByCeiling,
            (Hold::Released, Hold::Held) => Self::HeldByCeilingFloorReleased,
            (Hold::Held, Hold::Held) => return None,
        })
    }

    /// What is left when one of the faces does something else; `None` for a particle that both hold.
    pub(crate) fn turned(self, side: Side, hold: Hold, particle: &Particle) -> Option<Self> {
        let across = self.at(side.opposite(), particle);
        match side {
            Side::Floor => Self::of(hold, across, particle),
            Side::Ceiling => Self::of(across, hold, particle),
        }
    }

    /// Held: moves as one with the face.
    pub(crate) fn holds(self, particle: &Particle) -> bool {
        self.face(particle).is_some() && !self.presses(particle)
    }
}

/// Which side of the enclosure.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Side {
    Floor,
    Ceiling,
}

impl Side {
    /// What belongs to it.
    pub(crate) fn of<T>(self, floor: T, ceiling: T) -> T {
        match self {
            Self::Floor => floor,
            Self::Ceiling => ceiling,
        }
    }

    /// +1 where "away from the face" is upwards.
    pub(crate) fn away(self) -> f64 {
        self.of(1.0, -1.0)
    }

    /// How high above the floor it lies where the structure does not bend, m.
    pub(crate) fn height(self, particle: &Particle) -> f64 {
        self.of(0.0, particle.gap)
    }

    pub(crate) fn opposite(self) -> Self {
        self.of(Self::Ceiling, Self::Floor)
    }

    pub(crate) fn pressed(self) -> Contact {
        self.of(Contact::Floor, Contact::Ceiling)
    }

    pub(crate) fn stopped(self) -> Contact {
        self.of(Contact::FloorStop, Contact::CeilingStop)
    }

    pub(crate) fn released(self) -> Contact {
        self.of(Contact::FloorReleased, Contact::CeilingReleased)
    }

    pub(crate) fn made(self) -> EventKind {
        self.of(EventKind::FloorContact, EventKind::CeilingContact)
    }

    pub(crate) fn lost(self) -> EventKind {
        self.of(EventKind::FloorRelease, EventKind::CeilingRelease)
    }

    pub(crate) fn hit(self) -> EventKind {
        self.of(EventKind::FloorStop, EventKind::CeilingStop)
    }

    /// The face; a ceiling that cannot be met is never asked for.
    pub(crate) fn face(self, particle: &Particle) -> &Face {
        match self {
            Self::Floor => &particle.floor,
            Self::Ceiling => particle.ceiling.as_ref().unwrap_or(&particle.floor),
        }
    }
}

/// kδ/mp: what the spring of a face held on its stop pushes by itself, per mass.
pub(crate) fn spring_on_stop(particle: &Particle, side: Side) -> f64 {
    let law = side.face(particle).law;
    law.stiffness().map_or(0.0, |stiffness| stiffness * law.depth() / particle.mass)
}
