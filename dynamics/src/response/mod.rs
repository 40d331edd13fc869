//! What a run leaves behind: integrals of the observed motions, counts of events, the proof, and what was asked to be kept.

pub(crate) mod audit;
pub(crate) mod crest;
pub(crate) mod extremes;
pub(crate) mod proof;
pub(crate) mod residual_bound;
pub(crate) mod sample;

use crate::arithmetic::matrix::dot;
use crate::budget;
use crate::error::EngineError;
use crate::flow::sums::Sums;
use crate::motion::{Motion, Settling};
use crate::options::{Averaged, Options, StartState};
use crate::response::extremes::Extremes;
use crate::response::proof::Proof;
use crate::response::sample::Sample;
use crate::system::{Contact, Event, EventKind, HybridSystem, Particle};

/// How a response came about.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Method {
    /// From event to event.
    #[default]
    Simulated,
    /// No event can happen: by powers of the map of one cycle.
    ClosedForm,
}

/// What a run leaves behind.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Response {
    /// How it came about.
    pub method: Method,
    /// What was observed, in the order of [`HybridSystem::observed_rows`](crate::system::HybridSystem::observed_rows).
    pub observed: Vec<Observed>,
    /// The structure's velocities at both ends of every cycle, if asked for.
    pub cycle_rates: Vec<CycleRates>,
    /// Events in the averaged window.
    pub counts: Counts,
    /// What proves the run.
    pub proof: Proof,
    /// What each particle touches as the run begins.
    pub initial_contacts: Vec<Contact>,
    /// Events kept.
    pub events: Vec<Event>,
    /// Time history.
    pub trace: Vec<Sample>,
    /// Observed displacement at the end, m.
    pub final_displacement: f64,
    /// Observed velocity at the end, m/s.
    pub final_velocity: f64,
    /// y and y′ of each particle at the end.
    pub final_particles: Vec<[f64; 2]>,
    /// Height of each particle over its own floor at the end, where that would be if nothing compressed it, m.
    pub final_heights: Vec<f64>,
    /// The state at the end of the last cycle, if asked for; a fixed step, whose cycles end up to a step late, has none.
    pub final_state: Option<StartState>,
    /// The motion that it ends in, if asked for.
    pub motion: Option<Motion>,
    /// That an orbit draws it in, if that was asked for and is seen.
    pub settling: Option<Settling>,
    /// It stays beside the run that it was to be compared with, and ended where that was seen: nothing is averaged.
    pub stays_beside: bool,
    /// The period that was averaged in the place of the cycles given, if the run was to settle and did.
    pub settled: Option<Averaged>,
    /// Highest natural frequency among the contact states visited, rad/s.
    pub highest_frequency: f64,
}

impl Response {
    /// The same, at a last state q, q′ of the structure and with its last particles; refused if that is no number.
    pub(crate) fn at_end(self, system: &HybridSystem, state: [&[f64]; 2], cycle: u64) -> Result<Self, EngineError> {
        let row = system.observed_rows.first();
        let [final_displacement, final_velocity] = state.map(|x| row.map_or(0.0, |row| dot(row, x)));
        let is_number = final_displacement.is_finite() && final_velocity.is_finite();
        let final_heights = heights(system, state[0], &self.final_particles);
        let response = Self { final_displacement, final_velocity, final_heights, ..self };
        if is_number { Ok(response) } else { Err(EngineError::NotFinite { cycle }) }
    }

    /// Counts an event, and keeps it if that is asked for.
    pub(crate) fn enter(&mut self, event: Event, averaged: Averaged, options: &Options) {
        self.proof.events += 1;
        budget::count_event();
        if averaged.holds(event.cycle) {
            self.counts.add(event.kind);
        }
        let traced = options.trace.is_some_and(|trace| trace.covers(event.cycle));
        if traced || self.events.len() < options.record_events {
            self.events.push(event);
        }
    }

    /// The averaged window of the first observed motion.
    #[must_use]
    pub fn window(&self) -> Sums {
        self.observed.first().map(Observed::window).unwrap_or_default()
    }
}

/// How high particles at y, y′ are over their floors, of a structure at q.
fn heights(system: &HybridSystem, q: &[f64], particles: &[[f64; 2]]) -> Vec<f64> {
    let over_floor = |(particle, [y, _]): (&Particle, &[f64; 2])| y - dot(&particle.floor.row, q);
    system.particles.iter().zip(particles).map(over_floor).collect()
}

/// One observed motion over the averaged window.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Observed {
    /// Integrals over the first and the second half.
    pub halves: [Sums; 2],
    /// Largest and smallest values, if asked for.
    pub extremes: Extremes,
}

impl Observed {
    /// Both halves of the averaged window.
    #[must_use]
    pub fn window(&self) -> Sums {
        let [mut whole, second] = self.halves;
        whole.add(second);
        whole
    }
}

/// The structure's velocities q′ at both ends of a cycle.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct CycleRates {
    /// Just after the impulse that opens it.
    pub after: Vec<f64>,
    /// Just before the impulse that opens the next one.
    pub before: Vec<f64>,
}

/// Events in the averaged window.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Counts {
    /// Contacts made with a floor.
    pub floor_contacts: u64,
    /// Contacts lost with a floor.
    pub floor_releases: u64,
    /// Contacts made with a ceiling.
    pub ceiling_contacts: u64,
    /// Impacts on a limit stop.
    pub stops: u64,
}

impl Counts {
    pub(crate) fn add(&mut self, kind: EventKind) {
        match kind {
            EventKind::FloorContact => self.floor_contacts += 1,
            EventKind::FloorRelease => self.floor_releases += 1,
            EventKind::CeilingContact => self.ceiling_contacts += 1,
            EventKind::FloorStop | EventKind::CeilingStop => self.stops += 1,
            EventKind::CeilingRelease | EventKind::StopRelease | EventKind::ChatterEnd => {}
        }
    }
}
