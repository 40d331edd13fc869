//! How a system is run: which cycles, from where, and what is kept of them.

pub(crate) mod carried;
pub(crate) mod trace;

use serde::{Deserialize, Serialize};

use crate::contact::Relative;
use crate::motion::Settling;
use crate::options::trace::TraceRequest;
use crate::system::{Contact, HybridSystem, Particle};

/// How a system is run.
#[derive(Debug, Clone, PartialEq)]
pub struct Options {
    /// Cycles left out as transient.
    pub skip: u32,
    /// Cycles averaged over.
    pub average: u32,
    /// When it ends.
    pub until: Until,
    /// Where it starts.
    pub start: StartState,
    /// An impulse added at the start, relative to the drive's own, to see whether neighbouring runs stay neighbours.
    pub kick: f64,
    /// Measure displacements too, not velocities alone.
    pub displacement: bool,
    /// Look for the largest and smallest values of the observed motions.
    pub extremes: bool,
    /// Keep the structure's velocities at both ends of every cycle.
    pub cycle_rates: bool,
    /// Keep the state at the end, from which another run may start.
    pub final_state: bool,
    /// Balance momentum and energy.
    pub audit: bool,
    /// Name the motion that it ends in.
    pub motion: bool,
    /// Tell whether an orbit draws it in, as far as a neighbour wants to know.
    pub settling: bool,
    /// End where it is seen to stay beside this run, which has the same options but for the start.
    pub beside: Option<Settling>,
    /// How many events to keep, from the first.
    pub record_events: usize,
    /// Time history to keep.
    pub trace: Option<TraceRequest>,
    /// Search windows are shorter by this factor; 1 as a rule, less for a second accuracy.
    pub window_factor: f64,
}

impl Options {
    /// Cycles to run: the averaged window, and as far as a time history asks for.
    #[must_use]
    pub fn cycles(&self) -> u64 {
        let window = u64::from(self.skip) + u64::from(self.average);
        window.max(self.trace.map_or(0, |trace| trace.to_cycle))
    }

    /// The averaged window, unless the run settles before.
    #[must_use]
    pub fn averaged(&self) -> Averaged {
        Averaged { first: u64::from(self.skip), cycles: u64::from(self.average) }
    }
}

/// When a run ends.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Until {
    /// After the cycles given.
    #[default]
    Cycles,
    /// With the first period of a motion that comes again and attracts, which alone is averaged; after the cycles given where
    /// none is found.
    Settled,
}

/// Cycles that are averaged over.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Averaged {
    /// The first of them.
    pub first: u64,
    /// How many.
    pub cycles: u64,
}

impl Averaged {
    /// One past the last of them.
    #[must_use]
    pub fn end(self) -> u64 {
        self.first + self.cycles
    }

    /// Whether a cycle is among them.
    #[must_use]
    pub fn holds(self, cycle: u64) -> bool {
        (self.first..self.end()).contains(&cycle)
    }

    /// Which half of them a cycle belongs to.
    #[must_use]
    pub fn half(self, cycle: u64) -> usize {
        usize::from(2 * (cycle - self.first) >= self.cycles)
    }
}

impl Default for Options {
    /// 25 cycles skipped and 100 averaged, from static equilibrium; velocities and displacements only.
    fn default() -> Self {
        Self {
            skip: 25,
            average: 100,
            until: Until::Cycles,
            start: StartState::StaticEquilibrium,
            kick: 0.0,
            displacement: true,
            extremes: false,
            cycle_rates: false,
            final_state: false,
            audit: false,
            motion: false,
            settling: false,
            beside: None,
            record_events: 0,
            trace: None,
            window_factor: 1.0,
        }
    }
}

/// Where a run starts.
#[derive(Debug, Clone, PartialEq)]
pub enum StartState {
    /// At rest, every particle on its floor.
    StaticEquilibrium,
    /// Anywhere.
    Given {
        /// Coordinates of the structure.
        q: Vec<f64>,
        /// Their rates.
        rate: Vec<f64>,
        /// Each particle.
        particles: Vec<Placed>,
    },
}

/// Where a particle is.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Placed {
    /// Its contact.
    pub contact: Contact,
    /// Gap coordinate, m: its place relative to the face that its contact names first, to its floor in flight.
    pub gap: f64,
    /// The rate of that, m/s.
    pub rate: f64,
}

impl Placed {
    /// On its floor, which it does not compress.
    pub const ON_FLOOR: Self = Self::new(Contact::Floor, 0.0, 0.0);

    /// With this contact, gap coordinate (m) and rate (m/s).
    #[must_use]
    pub const fn new(contact: Contact, gap: f64, rate: f64) -> Self {
        Self { contact, gap, rate }
    }
}

impl StartState {
    /// y and y′ of each particle; `None` at static equilibrium.
    pub(crate) fn absolute(&self, system: &HybridSystem) -> Option<Vec<[f64; 2]>> {
        let Self::Given { q, rate, particles } = self else { return None };
        let absolute = |(at, particle): (&Placed, &Particle)| {
            Relative { gap: at.gap, rate: at.rate }.absolute(particle, at.contact.side(), [q, rate])
        };
        Some(particles.iter().zip(&system.particles).map(absolute).collect())
    }
}
