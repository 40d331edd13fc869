//! The event-driven driver: from event to event, cycle by cycle.
//!
//! Each segment lies between two instants at which something happens: a jump of the force, or the first event that
//! [`crate::search`] certifies. Its flow is exact, its integrals closed; nothing is sampled unless a time history is asked for.

pub(crate) mod reach;
mod visits;

mod between;
mod contacts;
mod effects;
mod grip;
mod half_cycles;
mod impacts;
mod lossless;
mod samples;
mod segment;
mod sums;
mod taped;

use std::marker::PhantomData;
use std::rc::Rc;

use crate::arithmetic::few::Few;
use crate::budget;
use crate::contact::Relative;
use crate::contact::mobility::Mobilities;
use crate::error::EngineError;
use crate::flow::integral::Panels;
use crate::flow::pair_integral::PairIntegrals;
use crate::flow::parabola::Parabola;
use crate::flow::signals::Signals;
use crate::flow::way::Left;
use crate::flow::{Flow, Rest};
use crate::march::reach::OutOfReach;
use crate::march::visits::Visits;
use crate::motion::{self, End, Fundamental, Settling, Tape};
use crate::options::{Averaged, Options, Placed, StartState, Until};
use crate::response::audit::Audit;
use crate::response::extremes::Lookout;
use crate::response::{CycleRates, Observed, Response};
use crate::search::guards::Slipped;
use crate::search::{Clarity, Search};
use crate::states::States;
use crate::system::{Contact, DrivePhase, Event, EventKind, HybridSystem, Particle, Tick};
use effects::{Effects, Every, Plain, Taped};
use half_cycles::Half;
use lossless::Doubled;

/// A run in progress.
pub(crate) struct March<'a, E> {
    system: &'a HybridSystem,
    options: &'a Options,
    states: States,
    /// The flow in force.
    flow: Rc<Flow>,
    // State: structure (with the compressions of the flow in force behind its coordinates), particles, contacts.
    q: Vec<f64>,
    rate: Vec<f64>,
    particles: Vec<Relative>,
    contacts: Vec<Contact>,
    /// The damping that half cycles have put in the place of the stated.
    equivalent: Option<f64>,
    /// The last contact began or ended smoothly: u = u′ = u″ = 0, it leaves with u‴; or its push grows from zero.
    smooth: Vec<bool>,
    /// What has just happened at the second face of a particle.
    slipped: Option<Slipped>,
    /// Some floor and ceiling do not move as one.
    has_walls: bool,
    /// There are ways between contact states: faces move as one, errors die away, and dashpots stay as they are.
    has_ways: bool,
    /// The flow that was left by a way, until the next one is entered: meanwhile `q`, `rate` and what stands behind them are those before.
    left: Option<Left>,
    /// No error dies away.
    undamped: bool,
    /// Between two jumps of the force the slowest block of the flow in force hardly turns.
    is_brief: bool,
    /// The damping of the flow in force is that of half cycles, which give it another one soon.
    is_passing: bool,
    /// Between two jumps of the force on average, s.
    pause: f64,
    /// A time in which nothing can have moved, s.
    nothing: f64,
    averaged: Averaged,
    // Clock.
    cycle: u64,
    time: f64,
    level: f64,
    // Half cycles of the base acceleration.
    half: Half,
    // Work space.
    search: Search,
    panels: Panels,
    pairs: PairIntegrals,
    lookout: Lookout,
    /// Gap parabolas of the particles in flight.
    paths: Vec<Parabola>,
    signals: Signals,
    /// The crossing that is dealt with was due at once, when its segment began.
    sudden: bool,
    /// The contact state or its damping has changed since the flow was chosen.
    changed: bool,
    mobilities: Mobilities,
    /// Phase of the harmonic force, and the time within the cycle that it belongs to.
    phase: DrivePhase,
    phase_time: f64,
    c: Vec<f64>,
    c_end: Vec<f64>,
    work: Vec<f64>,
    doubled: Doubled,
    // Results.
    visits: Visits,
    clarity: Clarity,
    response: Response,
    /// From the averaged window on.
    audit: Option<Audit>,
    /// What names the motion; kept by a run on tape, and the ends of cycles by one that tells whether it settles.
    tape: Tape,
    /// Contacts before what may capture particles; kept by a run on tape.
    held: Vec<Contact>,
    effects: PhantomData<E>,
}

impl<'a, E: Effects> March<'a, E> {
    /// A run at its start.
    pub(crate) fn new(system: &'a HybridSystem, options: &'a Options, states: States) -> Result<Self, EngineError> {
        let n = system.mass.order;
        let count = system.particles.len();
        let most = n + count;
        let contacts = match &options.start {
            StartState::StaticEquilibrium => vec![Contact::Floor; count],
            StartState::Given { particles, .. } => particles.iter().map(|at| at.contact).collect(),
        };
        let equivalent = system.drive.half_cycles.as_ref().map(|half| half.curve.upper_end());
        let flow = states.flow(system, &contacts, equivalent)?;
        let mut march = Self {
            system,
            options,
            states,
            flow,
            q: vec![0.0; most],
            rate: vec![0.0; most],
            particles: vec![Relative::default(); count],
            contacts,
            equivalent,
            smooth: vec![false; count],
            slipped: None,
            has_walls: system.particles.iter().any(Particle::has_walls),
            has_ways: system.drive.half_cycles.is_none()
                && !(system.is_undamped() || system.particles.iter().any(Particle::has_walls)),
            left: None,
            undamped: system.is_undamped(),
            is_brief: false,
            is_passing: false,
            pause: system.drive.period / system.drive.ticks.len().max(1) as f64,
            nothing: f64::EPSILON * f64::EPSILON * system.drive.period,
            averaged: options.averaged(),
            cycle: 0,
            time: 0.0,
            level: 0.0,
            half: Half::default(),
            search: Search::new(options.window_factor),
            panels: Panels::default(),
            pairs: PairIntegrals::default(),
            lookout: Lookout::default(),
            paths: vec![Parabola::default(); count],
            signals: Signals::default(),
            sudden: false,
            changed: true,
            mobilities: Mobilities::default(),
            phase: DrivePhase::default(),
            phase_time: f64::NAN,
            c: vec![0.0; 2 * most + 2],
            c_end: vec![0.0; 2 * most + 2],
            work: Vec::new(),
            doubled: Doubled::default(),
            visits: Visits::default(),
            clarity: Clarity { margin: f64::INFINITY, ties: 0 },
            response: Response {
                observed: vec![Observed::default(); system.observed_rows.len()],
                ..Response::default()
            },
            audit: None,
            tape: Tape::default(),
            held: Vec::new(),
            effects: PhantomData,
        };
        if E::TAPED && system.drive.half_cycles.is_some() {
            return Err(EngineError::DampingWithMemory);
        }
        march.place(&options.start)?;
        march.response.initial_contacts.clone_from(&march.contacts);
        Ok(march)
    }

    /// Start: as asked, or static equilibrium with every particle on its floor.
    fn place(&mut self, start: &StartState) -> Result<(), EngineError> {
        match start {
            StartState::StaticEquilibrium => {
                let Rest { q, gaps, .. } = Rest::of(self.system, |contacts| {
                    self.contacts.clone_from_slice(contacts);
                    self.changed = true;
                    self.choose_flow()?;
                    Ok(Rc::clone(&self.flow))
                })?;
                self.q[..q.len()].copy_from_slice(&q);
                self.particles.iter_mut().zip(gaps).for_each(|(particle, gap)| particle.gap = gap);
                // Nothing presses a particle without weight: what the drive is about to do decides.
                if self.system.gravity > 0.0 { Ok(()) } else { self.settle(&[]) }
            }
            StartState::Given { q, rate, particles } => {
                self.q[..q.len()].copy_from_slice(q);
                self.rate[..rate.len()].copy_from_slice(rate);
                for (at, Placed { gap, rate, .. }) in self.particles.iter_mut().zip(particles) {
                    *at = Relative { gap: *gap, rate: *rate };
                }
                self.settle(&[])
            }
        }
    }

    fn run(mut self) -> Result<Response, EngineError> {
        self.all_cycles()?;
        self.finish()
    }

    fn all_cycles(&mut self) -> Result<(), EngineError> {
        let mut cycles = self.options.cycles();
        let settling = self.options.settling && Settling::is_told(self.system);
        // Which cycles a run that settles will average is not known before.
        let audited = if self.options.until == Until::Settled { 0 } else { self.averaged.first };
        let period = self.system.drive.period;
        while self.cycle < cycles {
            let cycle = self.cycle;
            self.time = 0.0;
            if E::TAPED {
                self.tape.begin_cycle();
            }
            budget::reach(cycle, cycles);
            if self.options.audit && cycle == audited {
                self.audit = Some(Audit::from(self.audit_state()));
            }
            let driven = (cycle == 0 || self.system.drive.repeats) && !self.system.drive.ticks.is_empty();
            let ticks: &[Tick] = if driven { &self.system.drive.ticks } else { &[Tick::STILL] };
            for (i, tick) in ticks.iter().enumerate() {
                if tick.time > self.time {
                    self.propagate_to(tick.time)?;
                }
                let kick = if cycle == 0 && i == 0 { self.options.kick * self.system.drive.scale() } else { 0.0 };
                self.tick(*tick, kick)?;
                if i == 0 && self.options.cycle_rates {
                    let after = self.rate[..self.system.mass.order].to_vec();
                    self.response.cycle_rates.push(CycleRates { after, before: Vec::new() });
                }
            }
            self.propagate_to(period)?;
            if let Some(cycle) = self.response.cycle_rates.last_mut() {
                cycle.before.extend_from_slice(&self.rate[..self.system.mass.order]);
            }
            if E::TAPED || settling {
                let end = self.end();
                self.tape.end_cycle(end);
            }
            if E::TAPED
                && let Some(settled) = self.settle_down()?
            {
                cycles = settled.end().max(self.options.trace.map_or(0, |trace| trace.to_cycle));
            }
            self.cycle += 1;
            let other = self.options.beside.as_ref().filter(|other| other.after == self.cycle);
            if other.is_some_and(|other| other.is_beside(&self.end())) {
                self.response.stays_beside = true;
                break;
            }
        }
        if settling {
            self.response.settling =
                Settling::of(self.system, &self.tape.ends, self.averaged.first..self.averaged.end());
        }
        Ok(())
    }

    fn finish(mut self) -> Result<Response, EngineError> {
        self.pay_out();
        if let Some(audit) = self.audit.take() {
            self.response.proof.balance(self.system, &audit, &self.audit_state());
        }
        self.response.proof.smallest_margin = self.clarity.margin;
        self.response.proof.ties = self.clarity.ties;
        self.response.final_particles = (0..self.particles.len()).map(|j| self.absolute(j)).collect();
        self.response.final_state = self.options.final_state.then(|| self.state());
        self.response.at_end(self.system, [&self.q, &self.rate], self.cycle)
    }

    /// The state between two cycles, as a run may start from it.
    fn state(&self) -> StartState {
        let n = self.system.mass.order;
        let placed = |(contact, at): (&Contact, &Relative)| Placed { contact: *contact, gap: at.gap, rate: at.rate };
        let particles = self.contacts.iter().zip(&self.particles).map(placed);
        StartState::Given { q: self.q[..n].to_vec(), rate: self.rate[..n].to_vec(), particles: particles.collect() }
    }

    /// The same with its particles in space, as states are compared with each other.
    fn end(&self) -> End {
        let n = self.system.mass.order;
        let particles: Few<[f64; 2]> = (0..self.particles.len()).map(|j| self.absolute(j)).collect();
        End::new([&self.q[..n], &self.rate[..n]], &particles, &self.contacts)
    }

    /// y and y′ of a particle.
    fn absolute(&self, j: usize) -> [f64; 2] {
        self.particles[j].absolute(&self.system.particles[j], self.contacts[j].side(), [&self.q, &self.rate])
    }

    /// The harmonic force's phase; a segment begins where another ended, so that the last answer is kept.
    #[inline]
    fn drive_phase(&mut self, time: f64) -> DrivePhase {
        if self.phase_time != time {
            (self.phase, self.phase_time) = (DrivePhase::of(&self.system.drive, time), time);
        }
        self.phase
    }

    /// A jump of the force.
    fn tick(&mut self, tick: Tick, kick: f64) -> Result<(), EngineError> {
        if E::TAPED {
            self.held.clone_from(&self.contacts);
        }
        let stepped = tick.level != self.level;
        self.level = tick.level;
        let impulse = tick.impulse + kick;
        if impulse != 0.0 {
            self.strike_structure(impulse)?;
        }
        if stepped {
            self.regrip()?;
        }
        if E::TAPED {
            self.tape_captures()?;
            self.tape.timed();
        }
        Ok(())
    }

    fn record(&mut self, j: usize, kind: EventKind, approach: f64, departure: f64) {
        self.record_at(j, kind, self.time, approach, departure);
    }

    fn record_at(&mut self, particle: usize, kind: EventKind, time: f64, approach: f64, departure: f64) {
        if E::TAPED {
            self.tape.count(kind);
        }
        let event = Event { cycle: self.cycle, time, particle, kind, approach, departure, lasts: kind.is_contact() };
        self.response.enter(event, self.averaged, self.options);
    }
}

/// Runs a system.
pub(crate) fn march(system: &HybridSystem, options: &Options, states: States) -> Result<Response, EngineError> {
    if options.motion {
        return Ok(named(system, options, states)?.0);
    }
    if options.until == Until::Settled {
        return Ok(taped(system, options, states, motion::NAMING)?.0);
    }
    // A time history shows ceilings, whether anything meets them or not.
    let mut far = if options.trace.is_none() { reach::far(system, options, states.ground()) } else { Vec::new() };
    let spent = budget::events();
    let response = without(system, options, states, &far)?;
    // A surface that is out of reach by less than the smallest margin may have a smaller one: the same run is made with it.
    let sharp = response.proof.smallest_margin;
    if far.iter().all(|far| sharp <= far.room()) {
        return Ok(response);
    }
    far.retain(|far| sharp <= far.room());
    budget::go_back_to(spent);
    without(system, options, States::of(system), &far)
}

/// Runs a system without what it cannot reach.
fn without(
    system: &HybridSystem,
    options: &Options,
    states: States,
    far: &[OutOfReach],
) -> Result<Response, EngineError> {
    if far.is_empty() {
        return run(system, options, states);
    }
    let less = reach::without(system, far);
    // What is known of a contact state depends on walls, not on stops nor on a ceiling that moves with its floor.
    let mut both = less.particles.iter().zip(&system.particles);
    let states = if both.all(|(one, other)| one.has_walls() == other.has_walls()) { states } else { States::of(&less) };
    run(&less, options, states)
}

fn run(system: &HybridSystem, options: &Options, states: States) -> Result<Response, EngineError> {
    if effects::is_plain(system) {
        March::<Plain>::new(system, options, states)?.run()
    } else {
        March::<Every>::new(system, options, states)?.run()
    }
}

/// The fundamental matrix of the averaged cycles.
pub(crate) fn fundamental(
    system: &HybridSystem,
    options: &Options,
    states: States,
) -> Result<Fundamental, EngineError> {
    let (_, tape) = taped(system, options, states, options.average as usize)?;
    Fundamental::of(system, &tape, options.average as usize)
}

/// Runs a system and keeps its tape, with the events of so many last cycles, or of as many as tell that it has settled.
pub(crate) fn taped(
    system: &HybridSystem,
    options: &Options,
    states: States,
    kept: usize,
) -> Result<(Response, Tape), EngineError> {
    let mut march = March::<Taped>::new(system, options, states)?;
    march.tape = Tape::keeping(if options.until == Until::Settled { kept.max(motion::NAMING) } else { kept });
    march.all_cycles()?;
    let tape = std::mem::take(&mut march.tape);
    Ok((march.finish()?, tape))
}

/// The same with its motion named, and with the events that this takes.
pub(crate) fn named(system: &HybridSystem, options: &Options, states: States) -> Result<(Response, Tape), EngineError> {
    let (response, tape) = taped(system, options, states, motion::NAMING)?;
    let motion = Some(motion::name(system, &tape, options.average as usize)?);
    Ok((Response { motion, ..response }, tape))
}
