//! Hybrid systems: a linear structure, particles that touch it or do not, and what drives it.
//!
//! The structure has coordinates q with M q″ + C q′ + K q = b F(t) + contact forces. Particle j is at y_j; a face of its
//! enclosure moves with the row φ of the structure: the floor lies at φ_f·q, the ceiling at φ_c·q + h. Nothing here knows
//! whether the structure is one mass, a beam or a plate.

pub(crate) mod spline;

use crate::arithmetic::elementary::sin_cos;
use crate::arithmetic::matrix::{Matrix, dot};

/// A structure with its particles and its drive, in any consistent units in which speeds are well above 10⁻⁹, where bouncing ends; those
/// named here are SI. Coordinates may be generalised: rows φ give displacements of points, φ·q.
#[derive(Debug, Clone, PartialEq)]
pub struct HybridSystem {
    /// M of the structure without particles, n by n: kg where coordinates are displacements.
    pub mass: Matrix,
    /// C, N s/m.
    pub damping: Matrix,
    /// K, N/m.
    pub stiffness: Matrix,
    /// g, m/s², on the particles only.
    pub gravity: f64,
    /// The particles.
    pub particles: Vec<Particle>,
    /// b: generalised force of a unit force at the forcing point.
    pub force_row: Vec<f64>,
    /// What drives it.
    pub drive: Drive,
    /// The observed displacements are these rows times q. The first is the one that half cycles, time histories and the
    /// final state refer to; there is always one.
    pub observed_rows: Vec<Vec<f64>>,
    /// Rows ρ along which contact forces are internal (ρ·φ_f = ρ·φ_c for every particle): there the momentum is balanced.
    pub momentum_rows: Vec<Vec<f64>>,
}

impl HybridSystem {
    /// The base whose acceleration sets the damping by half cycles.
    pub(crate) fn base_row(&self) -> Option<&[f64]> {
        self.drive.half_cycles.as_ref().map(|half| half.base.as_slice())
    }

    /// Neither the structure nor a floor takes energy. Ceilings and stops do not count: a run may do without them.
    pub(crate) fn is_undamped(&self) -> bool {
        let keeps = |particle: &Particle| match particle.floor.law {
            Law::Rigid { restitution } => restitution == 1.0,
            Law::Resilient { damping, .. } => damping == 0.0,
        };
        let still = self.damping.entries.iter().all(|entry| *entry == 0.0);
        still && self.drive.half_cycles.is_none() && self.particles.iter().all(keeps)
    }
}

/// A particle in its enclosure.
#[derive(Debug, Clone, PartialEq)]
pub struct Particle {
    /// mp, kg.
    pub mass: f64,
    /// The floor, at u = y − φ_f·q = 0.
    pub floor: Face,
    /// The ceiling, at w = y − φ_c·q − h = 0; `None` where it cannot be met.
    pub ceiling: Option<Face>,
    /// h, m; any value where there is no ceiling.
    pub gap: f64,
}

/// A face of an enclosure.
#[derive(Debug, Clone, PartialEq)]
pub struct Face {
    /// φ.
    pub row: Vec<f64>,
    /// How it pushes back.
    pub law: Law,
}

/// Contact law of a face.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Law {
    /// Impulse and momentum; sticks where it can push.
    Rigid {
        /// ε.
        restitution: f64,
    },
    /// Spring and dashpot.
    Resilient {
        /// N/m.
        stiffness: f64,
        /// N s/m; replaced where half cycles renew it, from the upper end of their curve on.
        damping: f64,
        /// True: the contact ends where its force would turn to tension; false: at zero gap.
        no_tension: bool,
        /// Where the compression ends.
        stop: Option<Stop>,
    },
}

/// Limit stop of a resilient face.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Stop {
    /// δ, m.
    pub length: f64,
    /// Its restitution.
    pub restitution: f64,
}

/// What drives the structure, cycle by cycle. Time is kept as a cycle and a time within it, so that a million cycles cost
/// no digits.
#[derive(Debug, Clone, PartialEq)]
pub struct Drive {
    /// Length of a cycle, s.
    pub period: f64,
    /// Jumps of the force within a cycle, by time; the first at 0.
    pub ticks: Vec<Tick>,
    /// False: the ticks belong to the first cycle alone.
    pub repeats: bool,
    /// A harmonic force F sin(ω t + φ) beside them, with ω·period a multiple of 2π.
    pub harmonic: Option<Harmonic>,
    /// Contact damping renewed at every half cycle of the base acceleration.
    pub half_cycles: Option<HalfCycles>,
}

impl Drive {
    /// The harmonic force, if the force never jumps beside it.
    pub(crate) fn harmonic_alone(&self) -> Option<Harmonic> {
        let silent = self.ticks.iter().all(|tick| tick.impulse == 0.0 && tick.level == 0.0);
        self.harmonic.filter(|_| silent)
    }

    /// How long the force of each tick stays on: until the next one, or the end of the cycle.
    pub(crate) fn stretches(&self) -> impl Iterator<Item = f64> {
        let ends = self.ticks.iter().skip(1).map(|tick| tick.time).chain([self.period]);
        self.ticks.iter().zip(ends).map(|(tick, end)| end - tick.time)
    }

    /// Σ|J| + Σ|F| Δt of a cycle with ticks, without the harmonic force.
    pub(crate) fn impulse_of_ticks(&self) -> f64 {
        let given = |(tick, stretch): (&Tick, f64)| tick.impulse.abs() + tick.level.abs() * stretch;
        self.ticks.iter().zip(self.stretches()).map(given).sum()
    }

    /// The impulse that the drive gives in a cycle, or its harmonic force in a radian: the scale of a kick, N s.
    #[must_use]
    pub fn scale(&self) -> f64 {
        self.impulse_of_ticks() + self.harmonic.map_or(0.0, |drive| drive.force.abs() / drive.angular_frequency)
    }
}

/// Phase of the harmonic drive: F cos(ω t + φ) and F sin(ω t + φ).
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(crate) struct DrivePhase {
    pub(crate) cosine: f64,
    pub(crate) sine: f64,
}

impl DrivePhase {
    /// At a time within the cycle; zero without a harmonic force.
    pub(crate) fn of(drive: &Drive, time: f64) -> Self {
        drive.harmonic.map_or_else(Self::default, |harmonic| {
            let (sine, cosine) = sin_cos(harmonic.angular_frequency * time + harmonic.phase);
            Self { cosine: harmonic.force * cosine, sine: harmonic.force * sine }
        })
    }
}

/// An instant at which the force jumps.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Tick {
    /// Time within the cycle, s.
    pub time: f64,
    /// Impulse given at that instant, N s.
    pub impulse: f64,
    /// Constant force from then on, N.
    pub level: f64,
}

impl Tick {
    /// A cycle without force.
    pub(crate) const STILL: Self = Self { time: 0.0, impulse: 0.0, level: 0.0 };
}

/// F sin(ω t + φ).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Harmonic {
    /// F, N.
    pub force: f64,
    /// ω, rad/s.
    pub angular_frequency: f64,
    /// φ: where in its own period the cycles of the drive begin, rad.
    pub phase: f64,
}

/// Equivalent viscous damping: c = curve(RMS of the base acceleration over the half cycle before).
#[derive(Debug, Clone, PartialEq)]
pub struct HalfCycles {
    /// The curve: acceleration in m/s², then N s/m; end values outside.
    pub curve: spline::Spline,
    /// φ of the base: its displacement is φ·q.
    pub base: Vec<f64>,
}

/// What a particle touches.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Default)]
pub enum Contact {
    /// Nothing: free flight.
    #[default]
    Flight,
    /// Floor: pressed into it, or stuck to it if it is rigid.
    Floor,
    /// Ceiling.
    Ceiling,
    /// Held on the floor's limit stop.
    FloorStop,
    /// Held on the ceiling's limit stop.
    CeilingStop,
    /// Let go by a floor that cannot pull, which is still compressed.
    FloorReleased,
    /// The same at the ceiling.
    CeilingReleased,
    // Floor and ceiling at once, where they do not move as one.
    /// Pressed into floor and ceiling.
    Both,
    /// Pressed into the floor; let go by a ceiling that cannot pull, which is still compressed.
    FloorCeilingReleased,
    /// Pressed into the ceiling; let go by the floor.
    CeilingFloorReleased,
    /// Let go by both, which are still compressed.
    BothReleased,
    /// Held by the floor, rigid or on its limit stop, and pressed into the ceiling.
    HeldByFloor,
    /// The same, let go by the ceiling.
    HeldByFloorCeilingReleased,
    /// Held by the ceiling, and pressed into the floor.
    HeldByCeiling,
    /// The same, let go by the floor.
    HeldByCeilingFloorReleased,
}

/// What happened.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum EventKind {
    /// Contact made with the floor.
    FloorContact,
    /// Contact lost with the floor.
    FloorRelease,
    /// Contact made with the ceiling.
    CeilingContact,
    /// Contact lost with the ceiling.
    CeilingRelease,
    /// Impact on the floor's limit stop.
    FloorStop,
    /// Impact on the ceiling's limit stop.
    CeilingStop,
    /// Let go by a limit stop.
    StopRelease,
    /// The last of infinitely many impacts.
    ChatterEnd,
}

impl EventKind {
    /// A contact is made, with a face or with its stop.
    #[must_use]
    pub fn is_contact(self) -> bool {
        matches!(self, Self::FloorContact | Self::CeilingContact | Self::FloorStop | Self::CeilingStop)
    }

    /// A contact is lost.
    pub(crate) fn is_release(self) -> bool {
        matches!(self, Self::FloorRelease | Self::CeilingRelease | Self::StopRelease)
    }
}

/// An event in its place.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Event {
    /// Forcing cycle, from 0.
    pub cycle: u64,
    /// Time within the cycle, s. That of the end of chatter is when its infinitely many impacts are over, shortly after the impact
    /// that foretold it.
    pub time: f64,
    /// Which particle.
    pub particle: usize,
    /// What.
    pub kind: EventKind,
    /// Relative velocity just before, m/s, upwards positive.
    pub approach: f64,
    /// Relative velocity just after, m/s.
    pub departure: f64,
    /// The contact goes on; false if the particle bounces off a rigid face, or is not pushed by it.
    pub lasts: bool,
}

impl Particle {
    /// Between rigid faces without a gap: a part of the structure, which no face ever loses.
    #[must_use]
    pub fn is_enclosed(&self) -> bool {
        let rigid = |face: &Face| face.law.is_rigid();
        self.has_no_gap() && rigid(&self.floor) && self.ceiling.as_ref().is_some_and(rigid)
    }

    /// Floor and ceiling do not move as one.
    pub(crate) fn has_walls(&self) -> bool {
        self.ceiling.as_ref().is_some_and(|ceiling| ceiling.row != self.floor.row)
    }

    /// How far the ceiling is above where it is over the floor of a structure at rest, for q, or how fast it moves away, for q′; `None`
    /// without a ceiling.
    pub(crate) fn lift(&self, x: &[f64]) -> Option<f64> {
        let ceiling = self.ceiling.as_ref()?;
        Some(dot(&ceiling.row, x) - dot(&self.floor.row, x))
    }

    /// Between faces that move as one, without a gap: what leaves one of them is at the other.
    pub(crate) fn has_no_gap(&self) -> bool {
        self.gap == 0.0 && self.ceiling.as_ref().is_some_and(|ceiling| ceiling.row == self.floor.row)
    }
}

impl Law {
    pub(crate) fn is_rigid(self) -> bool {
        matches!(self, Self::Rigid { .. })
    }

    /// N/m; none of a rigid face.
    pub(crate) fn stiffness(self) -> Option<f64> {
        match self {
            Self::Resilient { stiffness, .. } => Some(stiffness),
            Self::Rigid { .. } => None,
        }
    }

    /// The stop beside the springs of a face, if it has one.
    #[must_use]
    pub fn stop(self) -> Option<Stop> {
        match self {
            Self::Resilient { stop, .. } => stop,
            Self::Rigid { .. } => None,
        }
    }

    /// How far it can be compressed to its stop, m.
    pub(crate) fn depth(self) -> f64 {
        self.stop().map_or(0.0, |stop| stop.length)
    }

    /// Restitution of what holds a particle: a rigid face, or the stop of a resilient one.
    pub(crate) fn restitution(self) -> f64 {
        match self {
            Self::Rigid { restitution } => restitution,
            Self::Resilient { stop, .. } => stop.map_or(0.0, |stop| stop.restitution),
        }
    }
}
