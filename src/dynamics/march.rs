//! The event-driven driver: from event to event, cycle by cycle.
//!
//! Each segment lies between two instants at which something happens: a jump of the force, or the first event that
//! [`super::search`] certifies. Its flow is exact, its integrals closed; nothing is sampled unless a time history is asked for.

mod between;
mod contacts;
mod half_cycles;
mod impacts;
mod taped;

use std::rc::Rc;

use super::audit::{Audit, Force};
use super::block::Phase;
use super::budget;
use super::contact::{Relative, Side};
use super::contact_state::{contact_damping, dampings};
use super::extremes;
use super::flow::{DrivePhase, Flow};
use super::guards::{self, Contacts, Slipped};
use super::integral::{self, quadrature};
use super::mobility::Mobilities;
use super::motion::{self, Fundamental, Tape};
use super::parabola::Parabola;
use super::reach::{self, OutOfReach};
use super::search::{Clarity, Found, Search};
use super::signals::{self, Signals};
use super::states::States;
use super::system::{Contact, Event, EventKind, HybridSystem, Law, Particle, Tick, dot};
use super::trace::{Sample, SampledParticle};
use super::visits::Visits;
use super::{Averaged, CycleRates, EngineError, Observed, Options, Proof, Response, Until};
use half_cycles::Half;

/// Events at one instant beyond which contacts are left alone for a moment, as they undo each other.
const MOST_EVENTS_AT_AN_INSTANT: u32 = 64;

/// The same within a moment, in periods, so short that what happens in it may be rounding: a structure that is just set in motion hardly
/// moves, and each event rounds its places anew.
const MOST_EVENTS_IN_A_MOMENT: u32 = 256;
const MOMENT: f64 = 1e-12;

/// The longest time, in periods, for which contacts that do not settle are left alone.
const LONGEST_BLINK: f64 = 1e-9;

/// Panels that an integral may take before closed forms are cheaper, where a contact state is hardly ever visited twice.
const FEW_PANELS: usize = 16;

/// Events after which what rounding does at each of them adds up to more than the rest of it.
const MANY_EVENTS: u64 = 10_000;

/// How the observed signals are integrated over a segment.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Integration {
    /// From the ends of the visits of a contact state.
    ByEnds,
    /// Each by panels.
    ByPanels,
    /// By the few panels that half cycles integrate the acceleration by.
    Together,
}

/// A run in progress.
pub(crate) struct March<'a, const TAPED: bool> {
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
    /// Contact damping in force, per particle: that of the face its contact refers to.
    damping: Vec<f64>,
    /// What half cycles have put in its place.
    equivalent: Option<f64>,
    /// The last contact began or ended smoothly: u = u′ = u″ = 0, it leaves with u‴; or its push grows from zero.
    smooth: Vec<bool>,
    /// What has just happened at the second face of a particle.
    slipped: Option<Slipped>,
    /// Some floor and ceiling do not move as one.
    has_walls: bool,
    /// No error dies away.
    undamped: bool,
    /// A time in which nothing can have moved, s.
    nothing: f64,
    averaged: Averaged,
    // Clock.
    cycle: u64,
    time: f64,
    level: f64,
    // Half cycles of the observed acceleration.
    half: Half,
    // Work space.
    search: Search,
    /// Gap parabolas of the particles in flight.
    paths: Vec<Parabola>,
    signals: Signals,
    /// M⁻¹ b: what a unit impulse does to q′.
    answer: Vec<f64>,
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
    // Results.
    visits: Visits,
    clarity: Clarity,
    response: Response,
    audit: Option<Audit>,
    /// What names the motion; kept if `TAPED`, so that other runs have no such code.
    tape: Tape,
    /// Contacts before what may capture particles; kept if `TAPED`.
    held: Vec<Contact>,
}

impl<'a, const TAPED: bool> March<'a, TAPED> {
    /// A run at its start.
    pub(crate) fn new(system: &'a HybridSystem, options: &'a Options, states: States) -> Result<Self, EngineError> {
        let n = system.mass.order;
        let count = system.particles.len();
        let most = n + count;
        let contacts = match &options.start {
            super::StartState::StaticEquilibrium => vec![Contact::Floor; count],
            super::StartState::Given { particles, .. } => particles.iter().map(|(contact, ..)| *contact).collect(),
        };
        let equivalent = system.drive.half_cycles.as_ref().map(|half| half.curve.upper_end());
        let mut damping = Vec::new();
        dampings(system, &contacts, equivalent, &mut damping);
        let flow = states.flow(system, &contacts, &damping)?;
        let answer = states.ground().answer(system)?.to_vec();
        let mut march = Self {
            system,
            options,
            states,
            flow,
            q: vec![0.0; most],
            rate: vec![0.0; most],
            particles: vec![Relative::default(); count],
            contacts,
            damping,
            equivalent,
            smooth: vec![false; count],
            slipped: None,
            has_walls: system.particles.iter().any(Particle::has_walls),
            undamped: system.is_undamped(),
            nothing: f64::EPSILON * f64::EPSILON * system.drive.period,
            averaged: options.averaged(),
            cycle: 0,
            time: 0.0,
            level: 0.0,
            half: Half::default(),
            search: Search::new(options.window_factor),
            paths: vec![Parabola::default(); count],
            signals: Signals::default(),
            answer,
            sudden: false,
            changed: true,
            mobilities: Mobilities::default(),
            phase: DrivePhase::default(),
            phase_time: f64::NAN,
            c: vec![0.0; 2 * most + 2],
            c_end: vec![0.0; 2 * most + 2],
            visits: Visits::default(),
            clarity: Clarity { margin: f64::INFINITY, ties: 0 },
            response: Response {
                observed: vec![Observed::default(); system.observed_rows.len()],
                ..Response::default()
            },
            audit: options.audit.then(Audit::default),
            tape: Tape::default(),
            held: Vec::new(),
        };
        if TAPED && system.drive.half_cycles.is_some() {
            return Err(EngineError::DampingWithMemory);
        }
        march.place(&options.start)?;
        Ok(march)
    }

    /// Start: as asked, or static equilibrium with every particle on its floor.
    fn place(&mut self, start: &super::StartState) -> Result<(), EngineError> {
        match start {
            super::StartState::StaticEquilibrium => loop {
                self.choose_flow()?;
                let drive = DrivePhase::default();
                let flow = &self.flow;
                self.c.fill(0.0);
                flow.leave(&self.c, 0.0, 0.0, drive, &mut self.q, &mut self.rate);
                let n = self.system.mass.order;
                self.rate.fill(0.0);
                let mut fits = true;
                for (i, &j) in flow.modes.attached.iter().enumerate() {
                    self.particles[j].gap = self.q[n + i];
                    if let Some(stop) = self.system.particles[j].floor.law.stop()
                        && self.particles[j].gap < -stop.length
                    {
                        // Its weight alone presses the floor to the stop.
                        self.particles[j].gap = -stop.length;
                        self.contacts[j] = Contact::FloorStop;
                        fits = false;
                    }
                }
                if fits {
                    // Nothing presses a particle without weight: what the drive is about to do decides.
                    return if self.system.gravity > 0.0 { Ok(()) } else { self.settle(&[]) };
                }
                self.changed = true;
            },
            super::StartState::Given { q, rate, particles } => {
                self.q[..q.len()].copy_from_slice(q);
                self.rate[..rate.len()].copy_from_slice(rate);
                for (j, (contact, gap, rate)) in particles.iter().enumerate() {
                    self.changed = true;
                    self.contacts[j] = *contact;
                    self.particles[j] = Relative { gap: *gap, rate: *rate };
                }
                self.settle(&[])?;
            }
        }
        Ok(())
    }

    fn run(mut self) -> Result<Response, EngineError> {
        self.all_cycles()?;
        self.finish()
    }

    fn all_cycles(&mut self) -> Result<(), EngineError> {
        let mut cycles = self.options.cycles();
        let audited = self.first_audited();
        let period = self.system.drive.period;
        while self.cycle < cycles {
            let cycle = self.cycle;
            self.time = 0.0;
            if TAPED {
                self.tape.begin_cycle();
            }
            budget::reach(cycle, cycles);
            if cycle == audited {
                self.begin_audit();
            }
            let single = [Tick { time: 0.0, impulse: 0.0, level: 0.0 }];
            let ticks: &[Tick] =
                if cycle == 0 || self.system.drive.repeats { &self.system.drive.ticks } else { &single };
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
            if TAPED {
                self.end_taped_cycle();
                if let Some(settled) = self.settle_down()? {
                    cycles = settled.end().max(self.options.trace.map_or(0, |trace| trace.to_cycle));
                }
            }
            self.cycle += 1;
        }
        Ok(())
    }

    /// The first cycle that momentum and energy are balanced in; which ones a run that settles will average is not known before.
    fn first_audited(&self) -> u64 {
        match self.options.until {
            Until::Cycles => self.averaged.first,
            Until::Settled => 0,
        }
    }

    fn begin_audit(&mut self) {
        if self.audit.is_some() {
            let state = self.audit_state();
            if let Some(audit) = &mut self.audit {
                audit.begin(state);
            }
        }
    }

    fn finish(mut self) -> Result<Response, EngineError> {
        self.pay_out();
        if let Some(audit) = self.audit.take() {
            let (momentum, energy) = audit.residuals(self.system, &self.audit_state());
            self.response.proof.momentum_residual = momentum;
            self.response.proof.energy_residual = energy;
        }
        self.response.proof.smallest_margin = self.clarity.margin;
        self.response.proof.ties = self.clarity.ties;
        if let Some(row) = self.system.observed_rows.first() {
            self.response.final_displacement = dot(row, &self.q);
            self.response.final_velocity = dot(row, &self.rate);
        }
        self.response.final_particles = (0..self.particles.len()).map(|j| self.absolute(j)).collect();
        self.response.final_state = self.options.final_state.then(|| self.state());
        if self.response.final_displacement.is_finite() && self.response.final_velocity.is_finite() {
            Ok(self.response)
        } else {
            Err(EngineError::NotFinite { cycle: self.cycle })
        }
    }

    /// The state between two cycles, as a run may start from it.
    fn state(&self) -> super::StartState {
        let n = self.system.mass.order;
        let particles = self.contacts.iter().zip(&self.particles).map(|(contact, at)| (*contact, at.gap, at.rate));
        super::StartState::Given {
            q: self.q[..n].to_vec(),
            rate: self.rate[..n].to_vec(),
            particles: particles.collect(),
        }
    }

    /// y and y′ of a particle.
    fn absolute(&self, j: usize) -> [f64; 2] {
        let particle = &self.system.particles[j];
        let side = self.contacts[j].side();
        let row = &side.face(particle).row;
        let offset = if side == Side::Ceiling { particle.gap } else { 0.0 };
        [dot(row, &self.q) + offset + self.particles[j].gap, dot(row, &self.rate) + self.particles[j].rate]
    }

    /// The harmonic force's phase; a segment begins where another ended, so that the last answer is kept.
    fn drive_phase(&mut self, time: f64) -> DrivePhase {
        match self.system.drive.harmonic {
            None => DrivePhase::default(),
            Some(_) if self.phase_time == time => self.phase,
            Some(drive) => {
                let (sine, cosine) = super::elementary::sin_cos(drive.angular_frequency * time);
                self.phase = DrivePhase { cosine: drive.force * cosine, sine: drive.force * sine };
                self.phase_time = time;
                self.phase
            }
        }
    }

    /// A jump of the force.
    fn tick(&mut self, tick: Tick, kick: f64) -> Result<(), EngineError> {
        if TAPED {
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
        if TAPED {
            self.tape_captures()?;
            self.tape.timed();
        }
        Ok(())
    }

    fn record(&mut self, j: usize, kind: EventKind, approach: f64, departure: f64) {
        self.record_at(j, kind, self.time, approach, departure);
    }

    fn record_at(&mut self, particle: usize, kind: EventKind, time: f64, approach: f64, departure: f64) {
        self.response.proof.events += 1;
        if TAPED {
            self.tape.count(kind);
        }
        budget::count_event();
        if self.averaged.holds(self.cycle) {
            self.response.counts.add(kind);
        }
        let wanted = self.response.events.len() < self.options.record_events
            || self.options.trace.as_ref().is_some_and(|trace| trace.covers(self.cycle));
        if wanted {
            self.response.events.push(Event { cycle: self.cycle, time, particle, kind, approach, departure });
        }
    }

    /// Damping of the face that particle j's contact refers to, N s/m.
    fn damping_at(&self, j: usize) -> f64 {
        contact_damping(self.system, &self.contacts, j, self.equivalent)
    }

    /// Makes the flow of the contact state in force current, building it at the first visit.
    fn choose_flow(&mut self) -> Result<(), EngineError> {
        if !self.changed {
            return Ok(());
        }
        self.changed = false;
        if self.has_walls {
            dampings(self.system, &self.contacts, self.equivalent, &mut self.damping);
        } else {
            for j in 0..self.damping.len() {
                self.damping[j] = self.damping_at(j);
            }
        }
        if self.equivalent.is_some() {
            // Which of many dampings are still known hangs on the runs before; what is summed up together must not.
            self.pay_out();
        }
        self.flow = self.states.flow(self.system, &self.contacts, &self.damping)?;
        let width = 2 * self.flow.blocks.len();
        if self.c.len() < width {
            self.c.resize(width, 0.0);
            self.c_end.resize(width, 0.0);
        }
        let highest = &mut self.response.highest_frequency;
        *highest = self.flow.natural_frequencies().fold(*highest, f64::max);
        Ok(())
    }

    /// Block coordinates of the state in the flow in force.
    fn enter_flow(&mut self, drive: DrivePhase) {
        let flow = &self.flow;
        let n = self.system.mass.order;
        for (i, &j) in flow.modes.attached.iter().enumerate() {
            self.q[n + i] = self.particles[j].gap;
            self.rate[n + i] = self.particles[j].rate;
        }
        let (p, rate) = (&self.q[..flow.order], &self.rate[..flow.order]);
        flow.enter(p, rate, self.level, drive, &mut self.c);
        if self.undamped || self.response.proof.events >= MANY_EVENTS {
            flow.correct(p, rate, self.level, drive, &mut self.c);
        }
    }

    /// Propagates to `until` within the cycle, from event to event.
    fn propagate_to(&mut self, until: f64) -> Result<(), EngineError> {
        // Near the start of a cycle the clock counts finer than its instants can be told apart later.
        let instant = f64::EPSILON * self.system.drive.period;
        let longest = LONGEST_BLINK * self.system.drive.period;
        let moment = MOMENT * self.system.drive.period;
        let (mut stuck, mut flickers, mut blink) = (0, 0, instant);
        let (mut last, mut begun) = (self.time, self.time);
        while self.time < until {
            self.segment(until)?;
            if budget::spend(1) {
                return Err(budget::overrun().into());
            }
            if self.time > last + instant {
                blink = if self.time > last + longest { instant } else { blink };
                (stuck, last) = (0, self.time);
                if self.time > begun + moment {
                    (flickers, begun) = (0, self.time);
                }
            }
            stuck += 1;
            flickers += 1;
            if stuck > MOST_EVENTS_AT_AN_INSTANT || flickers > MOST_EVENTS_IN_A_MOMENT {
                let short = blink > 0.0 && blink <= longest;
                if !short || self.squeezed().is_some() {
                    return Err(self.no_progress());
                }
                self.blink(until.min(self.time + blink))?;
                (stuck, flickers, last, blink) = (0, 0, self.time, 2.0 * blink);
            }
        }
        Ok(())
    }

    /// To the next event.
    fn segment(&mut self, until: f64) -> Result<(), EngineError> {
        self.set_guards()?;
        self.follow(until)
    }

    /// Goes on without a look at the contacts, for so short a time that rounding moves them as far: what they do at this instant
    /// is rounding, and one of them undoes what another one does.
    #[cold]
    fn blink(&mut self, until: f64) -> Result<(), EngineError> {
        self.set_guards()?;
        self.search.guards.clear();
        self.clarity.ties += 1;
        self.follow(until)
    }

    #[inline]
    fn set_guards(&mut self) -> Result<(), EngineError> {
        self.choose_flow()?;
        let drive = self.drive_phase(self.time);
        self.enter_flow(drive);
        self.flow.watch(&self.c, self.level, &mut self.signals);
        self.turn_half_cycle()?;
        let flow = &self.flow;
        let state = Contacts {
            system: self.system,
            contacts: &self.contacts,
            particles: &self.particles,
            damping: &self.damping,
            smooth: &self.smooth,
            slipped: self.slipped,
            q: &self.q,
            rate: &self.rate,
        };
        guards::set(state, flow, &self.signals, &mut self.search, &mut self.paths);
        if let (Some(bend), false) = (flow.rows.bend, self.half.idle) {
            guards::half_cycle(bend, self.half.sign, self.half.touching, &mut self.search);
        }
        Ok(())
    }

    /// Follows the flow to the first of the guards that are set.
    #[inline]
    fn follow(&mut self, until: f64) -> Result<(), EngineError> {
        let (flow, drive) = (&self.flow, self.phase);
        let limit = (until - self.time).min(flow.lasts());
        let found = self.search.run(flow, &self.signals, limit, &mut self.clarity);
        let length = match found {
            Found::Nothing => limit,
            Found::Event { time, .. } => time.min(limit),
        };
        let end_drive = match self.system.drive.harmonic {
            None => drive,
            Some(_) => self.drive_phase(self.time + length),
        };
        self.flow.advance(&self.search.kernels, &self.c, end_drive, &mut self.c_end);
        self.sum_up(length, drive);
        if TAPED {
            self.tape.flow(&self.flow, length);
        }
        self.sample(length, drive);
        self.arrive(length, end_drive);
        self.time = match found {
            Found::Nothing if limit < until - self.time => self.time + limit,
            Found::Nothing => until,
            Found::Event { .. } => self.time + length,
        };
        if let Found::Event { guard, .. } = found {
            let super::search::Guard { particle, crossing, .. } = self.search.guards[guard];
            self.sudden = length == 0.0;
            if TAPED {
                self.cross_taped(particle, crossing)?;
            } else {
                self.cross(particle, crossing)?;
            }
        }
        Ok(())
    }

    /// The state at the end of a segment.
    fn arrive(&mut self, length: f64, end_drive: DrivePhase) {
        let n = self.system.mass.order;
        let flow = &self.flow;
        let mut kept = Vec::new();
        if self.has_walls && length > self.nothing {
            self.slipped = None;
        }
        for (j, particle) in self.system.particles.iter().enumerate() {
            let contact = self.contacts[j];
            if contact.face(particle).is_none() {
                if self.smooth[j]
                    && flow.is_short(length)
                    && let Some(side) = self.lies_at(j)
                {
                    // Let go at the same instant as another: u = u‴t³/6 is still nothing, and is kept so to the bit.
                    kept.push((j, side));
                    continue;
                }
                let (path, here) = (self.paths[j], self.particles[j]);
                self.particles[j] = guards::fly(flow, j, path, &self.signals, here, &self.c_end, length);
            }
            // What has begun at zero is there no longer.
            self.smooth[j] &= length <= self.nothing;
        }
        flow.leave(&self.c_end, length, self.level, end_drive, &mut self.q, &mut self.rate);
        for (j, side) in kept {
            self.particles[j] = Relative::default();
            if side == Side::Ceiling {
                self.refer_to_floor(j);
            }
        }
        let flow = &self.flow;
        let short = guards::is_short(flow, length);
        for (i, &j) in flow.modes.attached.iter().enumerate() {
            self.particles[j] = match flow.rows.faces[j].compression {
                Some(_) if short => {
                    let (phases, rest) = self.signals.of(flow.rows.guards[j].first);
                    guards::creep(flow, 2.0 * rest.p2, 1.0, phases, self.particles[j], length)
                }
                _ => Relative { gap: self.q[n + i], rate: self.rate[n + i] },
            };
        }
    }

    /// Adds the segment to the measures, and to the audit if there is one.
    fn sum_up(&mut self, length: f64, drive: DrivePhase) {
        if self.averaged.holds(self.cycle) {
            let half = self.averaged.half(self.cycle);
            if self.visits.half != half || self.visits.is_full() {
                self.pay_out();
                self.visits.half = half;
            }
            let integration = self.integration(length);
            if integration == Integration::ByEnds {
                self.visits.of(&self.flow).visit(&self.c, &self.c_end, self.level, length);
            }
            if integration == Integration::ByPanels || self.options.extremes {
                self.look_along(length);
            }
        }
        let flow = &self.flow;
        let first_audited = self.first_audited();
        if let Some(audit) = &mut self.audit
            && self.cycle >= first_audited
        {
            audit.segment(self.system, flow, &self.c, &self.search.kernels, Force { level: self.level, drive }, length);
        }
        if flow.rows.bend.is_some() {
            self.sum_up_half_cycle(length);
        }
    }

    /// The integrals are differences of end values: not of motion without damping, nor between jumps of the force that follow
    /// each other within a small part of the slowest turn; nor over the few turns for which half cycles leave a contact state as
    /// it is, where panels are cheaper than the equations of its blocks.
    fn integration(&self, length: f64) -> Integration {
        let drive = &self.system.drive;
        if self.equivalent.is_some() && integral::panels(&self.flow.blocks, length) <= FEW_PANELS {
            Integration::Together
        } else if self.flow.closed().is_some() && !self.flow.is_brief(drive.period / drive.ticks.len().max(1) as f64) {
            Integration::ByEnds
        } else {
            Integration::ByPanels
        }
    }

    /// What has to be taken from the observed signals themselves.
    fn look_along(&mut self, length: f64) {
        let sampled = length > 0.0 && self.integration(length) == Integration::ByPanels;
        let flow = &self.flow;
        for (of, &row) in self.response.observed.iter_mut().zip(&flow.rows.observed) {
            let (observed, rest) = flow.rows.evaluate(row, &self.c, self.level, flow.blocks.len());
            if sampled {
                of.halves[self.visits.half].add(quadrature(&flow.blocks, &flow.bank, &observed, rest, length));
            }
            if self.options.extremes {
                extremes::take(&mut of.extremes, &flow.blocks, &observed, rest, length);
            }
        }
    }

    fn pay_out(&mut self) {
        self.visits.pay_out(self.options.displacement, &mut self.response.observed);
    }

    fn audit_state(&self) -> super::audit::State {
        super::audit::State {
            q: self.q[..self.system.mass.order].to_vec(),
            rate: self.rate[..self.system.mass.order].to_vec(),
            particles: (0..self.particles.len()).map(|j| self.absolute(j)).collect(),
            compressions: (0..self.particles.len())
                .map(|j| match side_stiffness(self.system, &self.contacts, j) {
                    Some(stiffness) => [stiffness, self.particles[j].gap],
                    None => [0.0, 0.0],
                })
                .collect(),
            across: (0..self.particles.len()).filter_map(|j| self.stored_across(j)).collect(),
        }
    }

    /// Samples of the time history that fall into the segment.
    fn sample(&mut self, length: f64, drive: DrivePhase) {
        let Some(request) = self.options.trace else { return };
        if !request.covers(self.cycle) {
            return;
        }
        let flow = &self.flow;
        let period = self.system.drive.period;
        let (mut kernels, mut c) = (Vec::with_capacity(flow.blocks.len()), self.c.clone());
        for i in request.next_sample(self.time, period).. {
            let instant = request.instant(i, period);
            let t = instant - self.time;
            if t > length || (t >= length && instant >= period) {
                break;
            }
            kernels.clear();
            kernels.extend(flow.blocks.iter().map(|block| block.kernel(t)));
            flow.advance(&kernels, &self.c, flow.drive_after(drive, t), &mut c);
            let value = |(phases, rest): (&[Phase], Parabola)| signals::value(&flow.blocks, phases, rest, &kernels, t);
            let anywhere = |row: usize| {
                let (phases, rest) = flow.rows.evaluate(row, &self.c, self.level, flow.blocks.len());
                value((&phases, rest))
            };
            let [displacement, velocity, acceleration] = anywhere(flow.rows.observed[0]);
            let sampled = |(j, particle): (usize, &Particle)| {
                let contact = self.contacts[j];
                let faces = [Side::Floor, Side::Ceiling].map(|side| anywhere(flow.rows.face(j, side))[0]);
                let gap = match (contact.face(particle), flow.rows.faces[j].compression) {
                    (None, _) => guards::fly(flow, j, self.paths[j], &self.signals, self.particles[j], &c, t).gap,
                    (Some(_), Some(compression)) => anywhere(compression)[0],
                    (Some(_), None) => self.particles[j].gap,
                };
                SampledParticle::new(particle, contact, faces, gap)
            };
            let sample = Sample {
                time: self.cycle as f64 * period + instant,
                displacement,
                velocity,
                acceleration,
                damping: self.equivalent.or(self.damping.first().copied()).unwrap_or(0.0),
                half_cycle_rms: self.half.last,
                particles: self.system.particles.iter().enumerate().map(sampled).collect(),
            };
            self.response.trace.push(sample);
        }
    }
}

fn side_stiffness(system: &HybridSystem, contacts: &[Contact], j: usize) -> Option<f64> {
    let contact = contacts[j];
    let face = contact.face(&system.particles[j])?;
    match face.law {
        Law::Resilient { stiffness, .. } => Some(stiffness),
        Law::Rigid { .. } => None,
    }
}

/// Runs a system.
pub(crate) fn march(system: &HybridSystem, options: &Options, states: States) -> Result<Response, EngineError> {
    if options.is_taped() {
        return Ok(taped(system, options, states)?.0);
    }
    // A time history shows ceilings, whether anything meets them or not.
    let mut far = if options.trace.is_none() { reach::far(system, options, &states) } else { Vec::new() };
    let spent = budget::events();
    let response = without(system, options, states, &far)?;
    // What is out of reach by less than the smallest margin may be nearer than all that decided it: the same run once more tells.
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
        return March::<false>::new(system, options, states)?.run();
    }
    let has_walls = |system: &HybridSystem| system.particles.iter().any(Particle::has_walls);
    let less = states.ground().without(system, far);
    // What is known of a contact state depends on walls, not on stops nor on a ceiling that moves with its floor.
    let states = if has_walls(&less) == has_walls(system) { states } else { States::of(&less) };
    March::<false>::new(&less, options, states)?.run()
}

/// The fundamental matrix of the averaged cycles.
pub(crate) fn fundamental(
    system: &HybridSystem,
    options: &Options,
    states: States,
) -> Result<Fundamental, EngineError> {
    let mut march = March::<true>::new(system, options, states)?;
    march.all_cycles()?;
    Fundamental::of(system, &march.tape, options.average as usize)
}

/// Runs a system and keeps its tape.
pub(crate) fn taped(system: &HybridSystem, options: &Options, states: States) -> Result<(Response, Tape), EngineError> {
    let mut march = March::<true>::new(system, options, states)?;
    march.all_cycles()?;
    let motion = if options.motion { Some(motion::name(system, &march.tape, options.average as usize)?) } else { None };
    let tape = std::mem::take(&mut march.tape);
    Ok((Response { motion, ..march.finish()? }, tape))
}

/// The proof of a run that was never audited.
impl Default for Clarity {
    fn default() -> Self {
        Self { margin: f64::INFINITY, ties: 0 }
    }
}

impl Proof {
    /// The proof of a run with no event at all.
    #[must_use]
    pub fn linear() -> Self {
        Self { smallest_margin: f64::INFINITY, ..Self::default() }
    }
}
