//! One run over the period from a state at phase 0: by how much it misses itself, and the map about it.

use std::f64::consts::TAU;
use std::ops::Range;

use nalgebra::DMatrix;

use super::{Orbit, OrbitError};
use crate::arithmetic::elimination;
use crate::arithmetic::few::Few;
use crate::arithmetic::matrix::{dot, length};
use crate::budget;
use crate::contact::Relative;
use crate::march;
use crate::motion::{End, Period, Scale, Tape, kind};
use crate::options::{Options, Placed, StartState};
use crate::response::Response;
use crate::states::States;
use crate::system::{Contact, Event, EventKind, HybridSystem};

/// Away from a multiplier, so that the equations have a solution.
const SHIFT: f64 = 1e-9;
/// Each leaves a billionth of all other vectors.
const INVERSE_ITERATIONS: usize = 3;

/// Halves of a period differ, if by more than this, in units of the motion.
const DIFFERS: f64 = 1e-8;

/// A step along a branch does not take away an asymmetry that is so many times what counts as none.
const FAR: f64 = 1e3;

/// Two states of a period are the same within this, in units of the motion.
const SAME: f64 = 1e-9;

/// A state that misses itself by less comes again, in units of the motion.
pub(super) const ROUNDING: f64 = 1e-11;

/// Instants that are one, as a share of a cycle.
const COINCIDES: f64 = 1e-6;

/// A run over the period.
pub(super) struct Shot {
    pub(super) start: End,
    pub(super) scale: Scale,
    pub(super) map: Period,
    /// P(x) − x in units of the motion.
    pub(super) miss: Vec<f64>,
    /// The run itself.
    pub(super) response: Response,
    pub(super) tape: Tape,
    /// A cycle of the drive, s.
    cycle: f64,
}

impl Shot {
    /// From a state, in the given units or in those of the motion itself.
    pub(super) fn new(
        system: &HybridSystem,
        start: End,
        cycles: u32,
        scale: Option<&Scale>,
    ) -> Result<Self, OrbitError> {
        let (response, tape) = shoot(system, &start, cycles)?;
        if tape.last(cycles as usize).any(|cycle| cycle.blurred) {
            return Err(OrbitError::StruckAtOnce);
        }
        let scale = scale.map_or_else(|| own_scale(system, &start, &response, &tape), Clone::clone);
        Ok(Self::in_units(system, start, scale, response, tape))
    }

    fn in_units(system: &HybridSystem, start: End, scale: Scale, response: Response, tape: Tape) -> Self {
        let map = Period::new(system, &scale, tape.last(tape.ends.len()));
        let miss = scale.miss(&start, end(&tape)).collect();
        Self { start, scale, map, miss, response, tape, cycle: system.drive.period }
    }

    /// The same in units of this motion.
    pub(super) fn in_own_units(self, system: &HybridSystem) -> Self {
        let scale = own_scale(system, &self.start, &self.response, &self.tape);
        Self::in_units(system, self.start, scale, self.response, self.tape)
    }

    /// Where it ends.
    pub(super) fn end(&self) -> &End {
        end(&self.tape)
    }

    /// The largest part of the miss; infinite where it ends in other contacts than it starts in.
    pub(super) fn misses_by(&self) -> f64 {
        self.scale.apart(&self.start, self.end())
    }

    /// It leads to no orbit, or is one that leads to no other.
    pub(super) fn unsolved(&self) -> OrbitError {
        let (cycles, miss) = (self.tape.ends.len() as u32, self.misses_by());
        if miss <= ROUNDING { OrbitError::NoNeighbour { cycles } } else { OrbitError::NoConvergence { cycles, miss } }
    }

    /// Cycles after which an orbit comes again for the first time.
    pub(super) fn shortest_period(&self) -> usize {
        let ends = &self.tape.ends;
        let comes_again =
            |part: &usize| ends.len().is_multiple_of(*part) && self.scale.apart(&self.start, &ends[part - 1]) <= SAME;
        (1..ends.len()).find(comes_again).unwrap_or(ends.len())
    }

    /// By how much the second half of the period differs from the first, in units of the motion; `None` of an odd number of cycles.
    fn halves_differ(&self) -> Option<Vec<f64>> {
        let cycles = self.tape.ends.len();
        cycles.is_multiple_of(2).then(|| self.scale.miss(&self.start, &self.tape.ends[cycles / 2 - 1]).collect())
    }

    /// The halves of the period change places between two neighbours: between them is a motion of half the period.
    pub(super) fn swaps_halves(&self, next: &Self) -> bool {
        let (Some(here), Some(there)) = (self.halves_differ(), next.halves_differ()) else { return false };
        let [own, other] = [&here, &there].map(|difference| length(difference));
        own.min(other) > DIFFERS && dot(&here, &there) < -0.5 * own * other
    }

    /// Numbers of a state that are the particles' places.
    pub(super) fn places(&self) -> Range<usize> {
        let half = self.miss.len() / 2;
        half - self.start.contacts.len()..half
    }

    /// 1 − M.
    pub(super) fn closing(&self) -> DMatrix<f64> {
        let size = self.miss.len();
        DMatrix::identity(size, size) - &self.map.matrix
    }

    /// Newton's step to the orbit that closes.
    pub(super) fn step(&self) -> Option<Vec<f64>> {
        elimination::solve(self.closing(), self.miss.clone(), &self.places())
    }

    /// The vector that a period turns into its opposite, of length 1: that of the multiplier next to −1.
    pub(super) fn flipping(&self) -> Option<Vec<f64>> {
        let size = self.miss.len();
        inverse_iteration(&(DMatrix::identity(size, size) * (1.0 + SHIFT) + &self.map.matrix))
    }

    /// The vector that a period leaves as it is, of length 1, and that of the transposed map: those of the multiplier next to 1.
    pub(super) fn kept(&self) -> Option<[Vec<f64>; 2]> {
        let size = self.miss.len();
        let shifted = DMatrix::identity(size, size) * (1.0 + SHIFT) - &self.map.matrix;
        Some([inverse_iteration(&shifted)?, inverse_iteration(&shifted.transpose())?])
    }

    /// Newton's step where a multiplier is 1, with nothing along the vector of that multiplier: an imperfection takes its place.
    pub(super) fn step_beside(&self, [kept, left]: &[Vec<f64>; 2]) -> Option<Vec<f64>> {
        let row: Vec<f64> = kept.iter().copied().chain([0.0]).collect();
        let equations = elimination::bordered(&self.closing(), &row, |i| left[i]);
        let rest = self.miss.iter().copied().chain([0.0]).collect();
        let mut step = elimination::solve(equations, rest, &self.places())?;
        step.truncate(self.miss.len());
        Some(step)
    }

    /// The start moved by a step in units of the motion.
    pub(super) fn moved(&self, step: &[f64]) -> End {
        let state = self.start.state.iter().zip(step).enumerate().map(|(i, (x, step))| x + step * self.scale.unit(i));
        End { state: state.collect(), contacts: self.start.contacts.clone() }
    }

    pub(super) fn contacts(&self) -> Contacts {
        contacts(&self.response)
    }

    /// Its events in their order, and between which jumps of the force each lies.
    pub(super) fn sequence(&self, system: &HybridSystem) -> Sequence {
        let jumps = |event: &Event| system.drive.ticks.iter().filter(|tick| tick.time <= event.time).count();
        self.response.events.iter().map(|event| (event.cycle, jumps(event), event.particle, event.kind)).collect()
    }

    /// The slowest contact with its speed; none after infinitely many.
    pub(super) fn slowest(&self) -> Option<Event> {
        if self.response.events.iter().any(|event| event.kind == EventKind::ChatterEnd) {
            return None;
        }
        let events = self.response.events.iter().filter(|event| event.kind.is_contact());
        events.copied().min_by(|a, b| a.approach.abs().total_cmp(&b.approach.abs()))
    }

    /// The flight before a contact begins from rest on a rigid face.
    pub(super) fn flies_from_rest(&self, contact: &Event) -> bool {
        let of_particle = || self.response.events.iter().filter(|event| event.particle == contact.particle);
        let before = of_particle().take_while(|event| *event != contact).last().or_else(|| of_particle().next_back());
        before.is_some_and(|event| event.kind.is_release() && event.departure == 0.0)
    }

    /// A speed as a share of the motion's.
    pub(super) fn share_of_speed(&self, speed: f64) -> f64 {
        let half = self.miss.len() / 2;
        speed.abs() / self.scale.unit(half).max(self.scale.unit(2 * half - 1))
    }

    /// A contact begins or ends as the period does: there it cannot be followed from one period to the next.
    pub(super) fn meets_its_ends(&self, period: f64) -> bool {
        let last = self.tape.ends.len() as u64 - 1;
        self.response.events.iter().any(|event| {
            (event.cycle == 0 && event.time <= COINCIDES * period)
                || (event.cycle == last && event.time >= (1.0 - COINCIDES) * period)
        })
    }

    /// Σ u |u| (1, cos 2φ, sin 2φ) over all contacts, with the speed u in units of the motion's and the phase φ in the period: zero of a
    /// motion that comes again upside down after half a period, and opposite of two that are each other's mirror image.
    fn asymmetry(&self) -> [f64; 3] {
        let whole = self.tape.ends.len() as f64 * self.cycle;
        let contacts = self.response.events.iter().filter(|event| event.kind.is_contact());
        contacts.fold([0.0; 3], |[sum, even, odd], event| {
            let speed = self.share_of_speed(event.approach);
            let weight = (speed * speed).copysign(event.approach);
            let (sin, cos) = libm::sincos(2.0 * TAU * (since_start(event, self.cycle) / whole));
            [sum + weight, even + weight * cos, odd + weight * sin]
        })
    }

    /// One of two neighbours is like the mirror image of the other: between them is a motion that comes again upside down.
    pub(super) fn swaps_sides(&self, next: &Self) -> bool {
        let (here, there) = (self.asymmetry(), next.asymmetry());
        let [own, other] = [&here, &there].map(|asymmetry| length(asymmetry));
        own.min(other) > DIFFERS && dot(&here, &there) < -0.5 * own * other && self.has_both_sides()
    }

    /// It comes again upside down, unlike a neighbour by far.
    pub(super) fn has_lost_its_asymmetry(&self, before: &Self) -> bool {
        let [own, other] = [self, before].map(|shot| length(&shot.asymmetry()));
        own <= DIFFERS && other > FAR * DIFFERS && self.has_both_sides()
    }

    /// Each contact has one upside down at the other face of the particle, be it at another instant or speed.
    pub(super) fn has_both_sides(&self) -> bool {
        let kinds = |event: &Event| (event.particle, event.kind);
        let mirrored = |event: &Event| (event.particle, upside_down(event.kind));
        let count = |of: (usize, EventKind)| self.response.events.iter().filter(|event| kinds(event) == of).count();
        self.response.events.iter().all(|event| count(kinds(event)) == count(mirrored(event)))
    }

    /// It comes again upside down after half a period, as far as its contacts tell.
    pub(super) fn comes_upside_down(&self, period: f64) -> bool {
        let (events, whole) = (&self.response.events, self.tape.ends.len() as f64 * period);
        let at = |event: &Event| since_start(event, period);
        let fast = self.scale.unit(self.miss.len() - 1);
        events.iter().all(|event| {
            events.iter().any(|other| {
                let late = (at(other) - at(event) + 1.5 * whole) % whole;
                (other.particle, other.kind) == (event.particle, upside_down(event.kind))
                    && late.min(whole - late) <= COINCIDES * period
                    && (other.approach.abs() - event.approach.abs()).abs() <= COINCIDES * fast
            })
        })
    }

    /// How often a rigid face lets a particle go within an instant after it has landed without a bounce.
    pub(super) fn brief_stays(&self, period: f64) -> usize {
        let events = &self.response.events;
        let at = |event: &Event| since_start(event, period);
        let is_brief =
            |(i, release): &(usize, &Event)| {
                release.kind.is_release()
                    && events[..*i].iter().rev().find(|event| event.particle == release.particle).is_some_and(
                        |landing| landing.departure == 0.0 && at(release) - at(landing) <= COINCIDES * period,
                    )
            };
        events.iter().enumerate().filter(is_brief).count()
    }

    /// By how much a surface would have to move for another sequence of contacts, as a share of the motion's length.
    pub(super) fn margin(&self) -> f64 {
        let half = self.miss.len() / 2;
        self.response.proof.smallest_margin / self.scale.unit(0).max(self.scale.unit(half - 1))
    }

    /// The orbit that it closes to.
    pub(super) fn orbit(&self, system: &HybridSystem, distance: f64) -> Result<Orbit, OrbitError> {
        let cycles = self.tape.ends.len();
        Ok(Orbit {
            start: start_at(system, &self.start),
            cycles: cycles as u32,
            contacts: self.tape.last(cycles).map(|cycle| cycle.contacts).sum(),
            kind: kind(system, &self.tape, cycles),
            multipliers: self.map.multipliers()?,
            residual: self.map.residual(),
            distance,
            response: self.response.clone(),
        })
    }
}

/// Time from the first cycle's start to an event, s.
fn since_start(event: &Event, period: f64) -> f64 {
    event.cycle as f64 * period + event.time
}

fn upside_down(kind: EventKind) -> EventKind {
    match kind {
        EventKind::FloorContact => EventKind::CeilingContact,
        EventKind::FloorRelease => EventKind::CeilingRelease,
        EventKind::CeilingContact => EventKind::FloorContact,
        EventKind::CeilingRelease => EventKind::FloorRelease,
        EventKind::FloorStop => EventKind::CeilingStop,
        EventKind::CeilingStop => EventKind::FloorStop,
        EventKind::StopRelease | EventKind::ChatterEnd => kind,
    }
}

/// The vector of length 1 that a matrix shortens most.
fn inverse_iteration(matrix: &DMatrix<f64>) -> Option<Vec<f64>> {
    let mut vector = vec![1.0; matrix.nrows()];
    for _ in 0..INVERSE_ITERATIONS {
        vector = elimination::solve(matrix.clone(), vector, &(0..0))?;
        let length = length(&vector);
        vector.iter_mut().for_each(|x| *x /= length);
    }
    Some(vector)
}

/// Cycle, jumps of the force in it before the event, particle, and what happens.
pub(super) type Sequence = Vec<(u64, usize, usize, EventKind)>;

/// What is met, and by which particle, in any order: an event that moves across phase 0 changes nothing of it.
pub(super) type Contacts = Vec<(usize, EventKind)>;

fn contacts(response: &Response) -> Contacts {
    let mut contacts: Contacts = response.events.iter().map(|event| (event.particle, event.kind)).collect();
    contacts.sort_unstable();
    contacts
}

/// P(x): the state so many cycles later, and the contacts on the way.
pub(super) fn state_after(system: &HybridSystem, start: &End, cycles: u32) -> Result<(End, Contacts), OrbitError> {
    let (response, tape) = shoot(system, start, cycles)?;
    Ok((end(&tape).clone(), contacts(&response)))
}

/// What the motion of a period reaches.
fn own_scale(system: &HybridSystem, start: &End, response: &Response, tape: &Tape) -> Scale {
    let mut reach = tape.reach_with_events(system.mass.order, system.particles.len());
    reach.take(&start.state);
    let row = system.observed_rows.first().map_or(0.0, |row| row.iter().fold(0.0, |most: f64, x| most.max(x.abs())));
    let speed = if row > 0.0 { response.window().rms_velocity() / row } else { 0.0 };
    Scale::of_period(system, &reach, speed)
}

fn shoot(system: &HybridSystem, start: &End, cycles: u32) -> Result<(Response, Tape), OrbitError> {
    if cycles == 0 {
        return Err(OrbitError::NoCycle);
    }
    let options = Options {
        skip: 0,
        average: cycles,
        start: start_at(system, start),
        record_events: usize::MAX,
        ..Options::default()
    };
    Ok(budget::within(|| march::taped(system, &options, States::of(system), cycles as usize))?)
}

fn end(tape: &Tape) -> &End {
    tape.ends.last().expect("a run has one cycle at least")
}

/// The state that a run starts from: relative to the faces, whose contacts follow from which side of them a particle is.
pub(super) fn start_at(system: &HybridSystem, at: &End) -> StartState {
    let n = system.mass.order;
    let (places, rates) = at.state.split_at(n + system.particles.len());
    let particles = system.particles.iter().enumerate().map(|(j, particle)| {
        let relative = |contact: Contact| {
            Relative::of([places[n + j], rates[n + j]], particle, contact.side(), [&places[..n], &rates[..n]])
        };
        let mut contact = at.contacts[j];
        let mut here = relative(contact);
        let side = contact.side();
        if contact.holds(particle) {
            here = Relative { gap: 0.0 - side.away() * side.face(particle).law.depth(), rate: 0.0 };
        } else if contact.presses(particle) && side.away() * here.gap > 0.0 {
            contact = Contact::Flight;
            here = relative(contact);
        } else if contact == Contact::Flight {
            let inside = |face: &Contact| face.presses(particle) && face.side().away() * relative(*face).gap < 0.0;
            if let Some(face) = [Contact::Floor, Contact::Ceiling].into_iter().find(inside) {
                contact = face;
                here = relative(contact);
            }
        }
        Placed { contact, gap: here.gap, rate: here.rate }
    });
    StartState::Given { q: places[..n].to_vec(), rate: rates[..n].to_vec(), particles: particles.collect() }
}

/// The same state at rest in space: absolute places and rates.
pub(super) fn absolute(system: &HybridSystem, start: &StartState) -> Option<End> {
    let StartState::Given { q, rate, particles } = start else { return None };
    let contacts: Few<Contact> = particles.iter().map(|particle| particle.contact).collect();
    Some(End::new([q, rate], &start.absolute(system)?, &contacts))
}
