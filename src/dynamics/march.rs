//! The event-driven driver: from event to event, cycle by cycle.
//!
//! Each segment lies between two instants at which something happens: a jump of the force, or the first event that
//! [`super::search`] certifies. Its flow is exact, its integrals closed; nothing is sampled unless a time history is asked for.

use super::audit::Audit;
use super::block::Phase;
use super::contact::{Crossing, Impact, Relative, STICKING_SPEED, Side};
use super::extremes;
use super::flow::{Cholesky, DrivePhase, Flow, Parabola, Signals};
use super::guards::{self, Contacts, Crossings, Grip};
use super::integral::quadrature;
use super::mobility::Mobilities;
use super::search::{Clarity, Found, Search};
use super::system::{Contact, Event, EventKind, HybridSystem, Law, Tick, dot};
use super::trace::Sample;
use super::{CycleRates, EngineError, Observed, Options, Proof, Response};

/// An acceleration below this share of its parts is zero: the crossing that ended the half cycle was smooth.
const SMOOTH: f64 = 1e-9;
/// Events at one instant beyond which the contact is declared undecidable.
const MOST_EVENTS_AT_AN_INSTANT: u32 = 64;

/// A run in progress.
pub(crate) struct March<'a> {
    system: &'a HybridSystem,
    options: &'a Options,
    flows: Vec<Flow>,
    /// Index of the flow in force.
    now: usize,
    // State: structure (with the compressions of the flow in force behind its coordinates), particles, contacts.
    q: Vec<f64>,
    rate: Vec<f64>,
    particles: Vec<Relative>,
    contacts: Vec<Contact>,
    damping: Vec<f64>,
    /// The last contact began or ended smoothly: u = u′ = u″ = 0, it leaves with u‴; or its push grows from zero.
    smooth: Vec<bool>,
    // Clock.
    cycle: u64,
    time: f64,
    level: f64,
    // Half cycles of the observed acceleration.
    half: Half,
    // Work space.
    search: Search,
    crossings: Crossings,
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
    observed_end: Vec<Phase>,
    // Results.
    clarity: Clarity,
    response: Response,
    audit: Option<Audit>,
}

/// Bookkeeping of the equivalent viscous damping.
#[derive(Debug, Clone, Copy, Default)]
struct Half {
    /// Sign of the acceleration in the half cycle; 0 before the first.
    sign: f64,
    /// ∫ a² dt so far.
    square: f64,
    /// Its length so far, s.
    length: f64,
    /// RMS of the last complete one, m/s².
    last: f64,
    /// The crossing was smooth, so that the guard starts at zero.
    touching: bool,
    /// Too weak to leave the curve's lower end: not followed.
    idle: bool,
}

impl<'a> March<'a> {
    /// A run at its start; `at_rest` is the flow with every particle on its floor, if it was built already.
    pub(crate) fn new(
        system: &'a HybridSystem,
        options: &'a Options,
        at_rest: Option<Flow>,
    ) -> Result<Self, EngineError> {
        let n = system.mass.order;
        let count = system.particles.len();
        let damping: Vec<f64> = system
            .particles
            .iter()
            .map(|particle| match particle.floor.law {
                Law::Resilient { damping, .. } => {
                    system.drive.half_cycles.as_ref().map_or(damping, |half| half.curve.upper_end())
                }
                Law::Rigid { .. } => 0.0,
            })
            .collect();
        let most = n + count;
        let mut march = Self {
            system,
            options,
            flows: at_rest.into_iter().collect(),
            now: 0,
            q: vec![0.0; most],
            rate: vec![0.0; most],
            particles: vec![Relative::default(); count],
            contacts: vec![Contact::Floor; count],
            damping,
            smooth: vec![false; count],
            cycle: 0,
            time: 0.0,
            level: 0.0,
            half: Half::default(),
            search: Search::new(options.window_factor),
            crossings: Crossings::new(),
            paths: vec![Parabola::default(); count],
            signals: Signals::default(),
            answer: Cholesky::new(&system.mass)?.solve(&system.force_row),
            sudden: false,
            changed: true,
            mobilities: Mobilities::default(),
            phase: DrivePhase::default(),
            phase_time: f64::NAN,
            c: vec![0.0; 2 * most],
            c_end: vec![0.0; 2 * most],
            observed_end: Vec::new(),
            clarity: Clarity { margin: f64::INFINITY, ties: 0 },
            response: Response {
                observed: vec![Observed::default(); system.observed_rows.len()],
                ..Response::default()
            },
            audit: options.audit.then(Audit::default),
        };
        march.place(&options.start)?;
        Ok(march)
    }

    /// Start: as asked, or static equilibrium with every particle on its floor.
    fn place(&mut self, start: &super::StartState) -> Result<(), EngineError> {
        match start {
            super::StartState::StaticEquilibrium => {
                self.choose_flow()?;
                let drive = DrivePhase::default();
                let flow = &self.flows[self.now];
                self.c.fill(0.0);
                flow.leave(&self.c, 0.0, 0.0, drive, &mut self.q, &mut self.rate);
                let n = self.system.mass.order;
                self.rate.fill(0.0);
                for (i, &j) in flow.attached.iter().enumerate() {
                    self.particles[j].gap = self.q[n + i];
                }
            }
            super::StartState::Given { q, rate, particles } => {
                self.q[..q.len()].copy_from_slice(q);
                self.rate[..rate.len()].copy_from_slice(rate);
                for (j, (contact, gap, rate)) in particles.iter().enumerate() {
                    self.changed = true;
                    self.contacts[j] = *contact;
                    self.particles[j] = Relative { gap: *gap, rate: *rate };
                }
                self.settle()?;
            }
        }
        Ok(())
    }

    pub(crate) fn run(mut self) -> Result<Response, EngineError> {
        let cycles = self.options.cycles();
        let period = self.system.drive.period;
        for cycle in 0..cycles {
            self.cycle = cycle;
            self.time = 0.0;
            if cycle == u64::from(self.options.skip) {
                self.begin_window();
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
        }
        self.finish()
    }

    fn begin_window(&mut self) {
        if self.audit.is_some() {
            let state = self.audit_state();
            if let Some(audit) = &mut self.audit {
                audit.begin(state);
            }
        }
    }

    fn finish(mut self) -> Result<Response, EngineError> {
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
        let fastest = self.flows.iter().flat_map(Flow::natural_frequencies).fold(0.0_f64, f64::max);
        self.response.highest_frequency = fastest;
        if self.response.final_displacement.is_finite() && self.response.final_velocity.is_finite() {
            Ok(self.response)
        } else {
            Err(EngineError::NotFinite { cycle: self.cycle })
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
        let stepped = tick.level != self.level;
        self.level = tick.level;
        let impulse = tick.impulse + kick;
        if impulse != 0.0 {
            self.strike_structure(impulse)?;
        }
        if stepped { self.regrip() } else { Ok(()) }
    }

    /// An impulse on the structure.
    fn strike_structure(&mut self, impulse: f64) -> Result<(), EngineError> {
        let before = self.audit.is_some().then(|| super::audit::energy(self.system, &self.audit_state()));
        // The impulse acts on the structure; a particle that is held receives its share through the face.
        for j in 0..self.particles.len() {
            let row = &self.contacts[j].side().face(&self.system.particles[j]).row;
            self.particles[j].rate -= impulse * dot(row, &self.answer);
            self.smooth[j] = false;
        }
        self.rate.iter_mut().zip(&self.answer).for_each(|(rate, jump)| *rate += impulse * jump);
        if let Some(before) = before {
            let after = super::audit::energy(self.system, &self.audit_state());
            if let Some(audit) = &mut self.audit {
                audit.impulse(impulse, after - before);
            }
        }
        self.half.touching = false;
        self.settle()
    }

    /// After a jump of velocities: decides every contact that the jump has made untenable.
    fn settle(&mut self) -> Result<(), EngineError> {
        // A face that the jump drives into its particle carries it only after their impact.
        let mut struck = Vec::new();
        for j in 0..self.particles.len() {
            let particle = &self.system.particles[j];
            let contact = self.contacts[j];
            let side = contact.side();
            let away = side.away() * self.particles[j].rate;
            match contact {
                Contact::Flight => {
                    let floor = self.particles[j];
                    if floor.gap == 0.0 && floor.rate < 0.0 {
                        self.meet(j, Side::Floor)?;
                    } else if floor.gap == 0.0 && floor.rate == 0.0 {
                        self.rest(j, Side::Floor)?;
                    } else if let Some(ceiling) = self.ceiling_relative(j)
                        && ceiling.gap == 0.0
                    {
                        if ceiling.rate > 0.0 {
                            self.particles[j] = ceiling;
                            self.meet(j, Side::Ceiling)?;
                        } else if ceiling.rate == 0.0 {
                            self.particles[j] = ceiling;
                            self.rest(j, Side::Ceiling)?;
                        }
                    }
                }
                _ if contact.holds(particle) => {
                    if away < 0.0 || (away > 0.0 && particle.is_enclosed()) {
                        self.changed = true;
                        self.contacts[j] = if side.stopped() == contact { side.pressed() } else { Contact::Flight };
                        struck.push((j, side));
                    } else if away > 0.0 {
                        self.let_go(j, side);
                    }
                }
                _ if contact.presses(particle) => {
                    if self.particles[j].gap == 0.0 && away > 0.0 {
                        self.let_go(j, side);
                    } else if let Law::Resilient { stiffness, no_tension: true, .. } = side.face(particle).law {
                        let force = -stiffness * self.particles[j].gap - self.damping[j] * self.particles[j].rate;
                        if force * side.away() < 0.0 {
                            self.slip(j, side);
                        }
                    }
                }
                _ => {
                    if let Law::Resilient { stiffness, .. } = side.face(particle).law {
                        let force = -stiffness * self.particles[j].gap - self.damping[j] * self.particles[j].rate;
                        if force * side.away() > 0.0 {
                            self.slip(j, side);
                        }
                    }
                }
            }
        }
        for (j, side) in struck {
            if side.away() * self.particles[j].rate < 0.0 || self.system.particles[j].is_enclosed() {
                self.strike(j, side, self.restitution(j, side))?;
            } else {
                // Another impact has driven the face away in the meantime.
                let rate = self.particles[j].rate;
                self.record(j, side.lost(), rate, rate);
                self.after_bounce(j, side);
            }
        }
        self.meet_at_once()?;
        self.choose_flow()
    }

    fn restitution(&self, j: usize, side: Side) -> f64 {
        let particle = &self.system.particles[j];
        // All bounces across no gap happen at once.
        if particle.is_enclosed() { 0.0 } else { side.face(particle).law.restitution() }
    }

    /// Position relative to the ceiling, for a particle whose state refers to the floor.
    fn ceiling_relative(&self, j: usize) -> Option<Relative> {
        let particle = &self.system.particles[j];
        let ceiling = particle.ceiling.as_ref()?;
        let floor = self.particles[j];
        if ceiling.row == particle.floor.row {
            return Some(Relative { gap: floor.gap - particle.gap, rate: floor.rate });
        }
        let shift = |x: &[f64]| dot(&ceiling.row, x) - dot(&particle.floor.row, x);
        Some(Relative { gap: floor.gap - particle.gap - shift(&self.q), rate: floor.rate - shift(&self.rate) })
    }

    /// Refers a particle that leaves the ceiling to the floor again.
    fn refer_to_floor(&mut self, j: usize) {
        let particle = &self.system.particles[j];
        let Some(ceiling) = particle.ceiling.as_ref() else { return };
        let here = self.particles[j];
        self.particles[j] = if ceiling.row == particle.floor.row {
            Relative { gap: here.gap + particle.gap, rate: here.rate }
        } else {
            let shift = |x: &[f64]| dot(&ceiling.row, x) - dot(&particle.floor.row, x);
            Relative { gap: here.gap + particle.gap + shift(&self.q), rate: here.rate + shift(&self.rate) }
        };
    }

    /// A particle in flight reaches a face: its state refers to that face already, with gap 0.
    fn meet(&mut self, j: usize, side: Side) -> Result<(), EngineError> {
        match side.face(&self.system.particles[j]).law {
            Law::Rigid { .. } => self.strike(j, side, self.restitution(j, side)),
            Law::Resilient { .. } => {
                let rate = self.particles[j].rate;
                self.changed = true;
                self.contacts[j] = side.pressed();
                self.record(j, side.made(), rate, rate);
                Ok(())
            }
        }
    }

    /// An impact on something rigid: a rigid face, or the stop of a resilient one. Then the particle bounces or is held.
    fn strike(&mut self, j: usize, side: Side, restitution: f64) -> Result<(), EngineError> {
        let particle = &self.system.particles[j];
        let stop = side.face(particle).law.stop();
        let approach = self.particles[j].rate;
        self.changed = true;
        self.contacts[j] = Contact::Flight;
        let impact = self.exchange(j, side, restitution)?;
        self.particles[j].rate = impact.departure;
        self.record(j, if stop.is_some() { side.hit() } else { side.made() }, approach, impact.departure);
        self.half.touching = false;
        let speed = impact.departure.abs();
        let held = match stop {
            None => side.pressed(),
            Some(_) => side.stopped(),
        };
        if speed > STICKING_SPEED {
            self.after_bounce(j, side);
            return Ok(());
        }
        // Slow enough to stay, if the face can push: the relative acceleration decides.
        self.changed = true;
        self.contacts[j] = held;
        self.choose_flow()?;
        let grip = self.grip(j, side);
        if particle.is_enclosed() || grip.holds() && (speed == 0.0 || !grip.is_nothing()) {
            self.smooth[j] = grip.is_nothing();
            if speed > 0.0 {
                let last = self.exchange(j, side, 0.0)?;
                // What was left to bounce: a geometric series of flights of 2u′/a, each shorter by ε. In flight the face no
                // longer carries the particle, so that a is larger than the push per mass that will hold it.
                let series = if restitution < 1.0 { 1.0 / (1.0 - restitution) } else { 0.0 };
                let tail = 2.0 * speed / (grip.push * last.lightening) * series;
                self.record_at(j, EventKind::ChatterEnd, self.time + tail, self.particles[j].rate, 0.0);
            }
            self.particles[j].rate = 0.0;
        } else {
            self.smooth[j] = speed == 0.0 && grip.is_nothing();
            self.after_bounce(j, side);
        }
        Ok(())
    }

    /// A particle that lies at a face without moving against it: what brings it there keeps it there.
    fn rest(&mut self, j: usize, side: Side) -> Result<(), EngineError> {
        self.choose_flow()?;
        let grip = self.grip(j, side);
        self.smooth[j] = grip.is_nothing();
        if grip.holds() || self.system.particles[j].is_enclosed() {
            self.changed = true;
            self.contacts[j] = side.pressed();
        } else if side == Side::Ceiling {
            self.refer_to_floor(j);
        }
        Ok(())
    }

    /// After a jump of the force: lets go what a face can no longer hold.
    fn regrip(&mut self) -> Result<(), EngineError> {
        for j in 0..self.particles.len() {
            let contact = self.contacts[j];
            if contact.holds(&self.system.particles[j]) {
                self.choose_flow()?;
                let grip = self.grip(j, contact.side());
                self.smooth[j] = grip.is_nothing();
                if !grip.holds() && !self.system.particles[j].is_enclosed() {
                    self.let_go(j, contact.side());
                }
            } else if self.particles[j] == Relative::default() {
                self.changed = true;
                self.contacts[j] = Contact::Flight;
                self.rest(j, contact.side())?;
            }
        }
        self.meet_at_once()?;
        self.choose_flow()
    }

    /// The exchange of momentum in an impact, with the jump of the structure; the faces of all other particles move with it.
    /// The particle itself is left to the caller.
    fn exchange(&mut self, j: usize, side: Side, restitution: f64) -> Result<Impact, EngineError> {
        let approach = self.particles[j].rate;
        let contact = std::mem::replace(&mut self.contacts[j], Contact::Flight);
        let meets = self.mobilities.of(self.system, &self.contacts, j, side)?;
        self.contacts[j] = contact;
        let impact = Impact::new(meets.at_face, self.system.particles[j].mass, restitution, approach);
        for (other, particle) in self.system.particles.iter().enumerate() {
            let contact = self.contacts[other];
            if other != j && !contact.holds(particle) {
                let row = &contact.side().face(particle).row;
                self.particles[other].rate += impact.impulse * dot(row, &meets.answer);
            }
        }
        self.rate.iter_mut().zip(&meets.answer).for_each(|(rate, answer)| *rate -= impact.impulse * answer);
        if let Some(audit) = &mut self.audit {
            audit.loss(impact.loss);
        }
        Ok(impact)
    }

    /// The particle moves away from what it struck.
    fn after_bounce(&mut self, j: usize, side: Side) {
        if side.face(&self.system.particles[j]).law.stop().is_some() {
            self.changed = true;
            self.contacts[j] = side.pressed();
        } else {
            self.changed = true;
            self.contacts[j] = Contact::Flight;
            if side == Side::Ceiling {
                self.refer_to_floor(j);
            }
        }
    }

    /// A face loses its particle.
    fn let_go(&mut self, j: usize, side: Side) {
        let rate = self.particles[j].rate;
        let stopped = self.contacts[j] == side.stopped();
        self.record(j, if stopped { EventKind::StopRelease } else { side.lost() }, rate, rate);
        if stopped {
            self.changed = true;
            self.contacts[j] = side.pressed();
            return;
        }
        self.changed = true;
        self.contacts[j] = Contact::Flight;
        if side == Side::Ceiling {
            self.refer_to_floor(j);
        }
    }

    /// A face that cannot pull lets go while compressed, or pushes again: the energy of its spring goes and comes.
    fn slip(&mut self, j: usize, side: Side) {
        let rate = self.particles[j].rate;
        let pressed = self.contacts[j] == side.pressed();
        self.record(j, if pressed { side.lost() } else { side.made() }, rate, rate);
        self.changed = true;
        self.contacts[j] = if pressed { side.released() } else { side.pressed() };
        if let (Some(audit), Law::Resilient { stiffness, .. }) =
            (&mut self.audit, side.face(&self.system.particles[j]).law)
        {
            let stored = 0.5 * stiffness * self.particles[j].gap * self.particles[j].gap;
            audit.loss(if pressed { stored } else { -stored });
        }
    }

    /// How a face holds particle j in the flow in force.
    fn grip(&mut self, j: usize, side: Side) -> Grip {
        let drive = self.drive_phase(self.time);
        self.enter_flow(drive);
        let flow = &self.flows[self.now];
        flow.signals(&self.c, self.level, drive, &mut self.signals);
        Grip::of(self.system, flow, &self.signals, j, side)
    }

    fn record(&mut self, j: usize, kind: EventKind, approach: f64, departure: f64) {
        self.record_at(j, kind, self.time, approach, departure);
    }

    fn record_at(&mut self, particle: usize, kind: EventKind, time: f64, approach: f64, departure: f64) {
        self.response.proof.events += 1;
        if self.options.averages(self.cycle) {
            self.response.counts.add(kind);
        }
        let wanted = self.response.events.len() < self.options.record_events
            || self.options.trace.as_ref().is_some_and(|trace| trace.covers(self.cycle));
        if wanted {
            self.response.events.push(Event { cycle: self.cycle, time, particle, kind, approach, departure });
        }
    }

    /// Makes the flow of the contact state in force current, building it at the first visit.
    fn choose_flow(&mut self) -> Result<(), EngineError> {
        if !self.changed {
            return Ok(());
        }
        self.changed = false;
        let fits = |flow: &Flow| flow.contacts == self.contacts && flow.damping == self.damping;
        if let Some(index) = self.flows.iter().position(fits) {
            self.now = index;
            return Ok(());
        }
        let flow = Flow::build(self.system, &self.contacts, &self.damping)?;
        if self.system.drive.half_cycles.is_some() && self.flows.len() >= 64 {
            self.flows.clear();
        }
        self.flows.push(flow);
        self.now = self.flows.len() - 1;
        Ok(())
    }

    /// Block coordinates of the state in the flow in force.
    fn enter_flow(&mut self, drive: DrivePhase) {
        let flow = &self.flows[self.now];
        let n = self.system.mass.order;
        for (i, &j) in flow.attached.iter().enumerate() {
            self.q[n + i] = self.particles[j].gap;
            self.rate[n + i] = self.particles[j].rate;
        }
        flow.enter(&self.q[..flow.order], &self.rate[..flow.order], self.level, drive, &mut self.c);
    }

    /// Propagates to `until` within the cycle, from event to event.
    fn propagate_to(&mut self, until: f64) -> Result<(), EngineError> {
        // Near the start of a cycle the clock counts finer than its instants can be told apart later.
        let instant = f64::EPSILON * self.system.drive.period;
        let mut stuck = 0;
        let mut last = self.time;
        while self.time < until {
            self.segment(until)?;
            if self.time > last + instant {
                (stuck, last) = (0, self.time);
            }
            stuck += 1;
            if stuck > MOST_EVENTS_AT_AN_INSTANT {
                return Err(EngineError::NoProgress { cycle: self.cycle, time: self.time });
            }
        }
        Ok(())
    }

    fn segment(&mut self, until: f64) -> Result<(), EngineError> {
        self.choose_flow()?;
        let drive = self.drive_phase(self.time);
        self.enter_flow(drive);
        self.flows[self.now].signals(&self.c, self.level, drive, &mut self.signals);
        self.turn_half_cycle()?;
        let flow = &self.flows[self.now];
        let state = Contacts {
            system: self.system,
            contacts: &self.contacts,
            particles: &self.particles,
            damping: &self.damping,
            smooth: &self.smooth,
            q: &self.q,
            rate: &self.rate,
        };
        guards::set(state, flow, &self.signals, &mut self.search, &mut self.crossings, &mut self.paths);
        if self.system.drive.half_cycles.is_some() && !self.half.idle {
            let Half { sign, touching, .. } = self.half;
            guards::half_cycle(flow, &self.signals, sign, touching, &mut self.search, &mut self.crossings);
        }
        let limit = until - self.time;
        let found = self.search.run(&flow.blocks, &flow.series, limit, &mut self.clarity);
        let length = match found {
            Found::Nothing => limit,
            Found::Event { time, .. } => time.min(limit),
        };
        self.sum_up(length, drive);
        self.sample(length);
        self.arrive(length, drive);
        self.time = match found {
            Found::Nothing => until,
            Found::Event { .. } => self.time + length,
        };
        if let Found::Event { guard, .. } = found {
            let (j, crossing) = self.crossings[self.search.guards[guard].label];
            self.sudden = length == 0.0;
            self.cross(j, crossing)?;
        }
        Ok(())
    }

    /// The state at the end of a segment.
    fn arrive(&mut self, length: f64, drive: DrivePhase) {
        let end_drive = match self.system.drive.harmonic {
            None => drive,
            Some(_) => self.drive_phase(self.time + length),
        };
        let n = self.system.mass.order;
        let flow = &self.flows[self.now];
        for (j, particle) in self.system.particles.iter().enumerate() {
            let contact = self.contacts[j];
            if contact.face(particle).is_none() {
                if self.smooth[j] && self.particles[j] == Relative::default() && flow.is_short(length) {
                    // Let go at the same instant as another: u = u‴t³/6 is still nothing, and is kept so to the bit.
                    continue;
                }
                let row = match contact.side() {
                    Side::Floor => flow.face_rows[j].floor,
                    Side::Ceiling => flow.face_rows[j].ceiling,
                };
                let (phases, _) = self.signals.of(row);
                let here = self.particles[j];
                self.particles[j] = guards::fly(flow, self.paths[j], phases, here, &self.search.kernels, length);
            }
            // What has begun at zero is there no longer.
            self.smooth[j] &= length == 0.0;
        }
        flow.advance(&self.search.kernels, &self.c, &mut self.c_end);
        flow.leave(&self.c_end, length, self.level, end_drive, &mut self.q, &mut self.rate);
        for (i, &j) in flow.attached.iter().enumerate() {
            self.particles[j] = Relative { gap: self.q[n + i], rate: self.rate[n + i] };
        }
    }

    /// Starts the first half cycle, and ends one whose acceleration a contact has turned at once.
    fn turn_half_cycle(&mut self) -> Result<(), EngineError> {
        let Some(half_cycles) = &self.system.drive.half_cycles else { return Ok(()) };
        let flow = &self.flows[self.now];
        let bends = guards::accelerations(&flow.blocks, self.signals.of(flow.observed).0);
        // Below the curve's first point every half cycle gives the same damping: no need to follow them until something
        // happens. The bound holds to the end of the segment, and the half cycle under way is as weak.
        let [least, damping] = half_cycles.curve.lower_end();
        let bound = flow
            .blocks
            .iter()
            .zip(&bends)
            .fold(0.0, |sum, (block, phase)| sum + block.amplitude(*phase, 0.0, self.system.drive.period));
        let least = least * self.system.gravity;
        let weak = self.half.square <= least * least * self.half.length;
        if bound < least && weak && self.damping.iter().all(|now| *now == damping) {
            self.half = Half { idle: true, last: self.half.last, ..Half::default() };
            return Ok(());
        }
        self.half.idle = false;
        let total = bends.iter().fold(0.0, |sum, phase| sum + phase.value);
        let rate = bends.iter().fold(0.0, |sum, phase| sum + phase.rate);
        // Its parts: with a single block the acceleration itself is what rounding has left of them.
        let observed = self.signals.of(flow.observed).0;
        let scale = flow.blocks.iter().zip(observed).fold(0.0, |sum, (block, phase)| {
            sum + (2.0 * block.decay * phase.rate).abs() + (block.determinant * phase.value).abs()
        });
        let smooth = total.abs() <= SMOOTH * scale;
        if self.half.sign == 0.0 {
            // From rest the first half cycle goes where the acceleration is about to go.
            self.half.touching = smooth;
            let first = if smooth { rate } else { total };
            self.half.sign = if first < 0.0 { -1.0 } else { 1.0 };
        }
        if self.half.touching && smooth {
            if rate * self.half.sign < 0.0 {
                // The new damping turns the acceleration back before it has got anywhere.
                self.half.sign = -self.half.sign;
            }
            return Ok(());
        }
        // New damping in a contact makes the acceleration jump: it no longer starts from zero.
        self.half.touching = false;
        if total * self.half.sign >= 0.0 {
            return Ok(());
        }
        self.half.sign = -self.half.sign;
        self.close_half_cycle();
        self.choose_flow()?;
        let drive = self.drive_phase(self.time);
        self.enter_flow(drive);
        self.flows[self.now].signals(&self.c, self.level, drive, &mut self.signals);
        Ok(())
    }

    /// The RMS of a finished half cycle sets the damping of the next.
    fn close_half_cycle(&mut self) {
        let Some(half_cycles) = &self.system.drive.half_cycles else { return };
        if self.half.length > 0.0 {
            self.half.last = (self.half.square / self.half.length).sqrt();
            let value = half_cycles.curve.at(self.half.last / self.system.gravity);
            self.damping.fill(value);
            self.changed = true;
        }
        self.half.square = 0.0;
        self.half.length = 0.0;
    }

    /// What a crossing leads to; the state has arrived there.
    fn cross(&mut self, j: usize, crossing: Crossing) -> Result<(), EngineError> {
        if crossing == Crossing::HalfCycle {
            self.half.sign = -self.half.sign;
            self.half.touching = true;
            self.close_half_cycle();
            return self.choose_flow();
        }
        self.half.touching = false;
        self.smooth[j] = false;
        let side = self.contacts[j].side();
        let particle = &self.system.particles[j];
        match crossing {
            // A particle that a rounding has put behind a face which it is leaving has not met it.
            Crossing::ToFloor => {
                self.particles[j].gap = 0.0;
                if self.particles[j].rate < 0.0 {
                    self.meet(j, Side::Floor)?;
                }
            }
            Crossing::ToCeiling => {
                if let Some(Relative { rate, .. }) = self.ceiling_relative(j) {
                    self.particles[j] = Relative { gap: 0.0, rate };
                    if rate > 0.0 {
                        self.meet(j, Side::Ceiling)?;
                    } else {
                        self.refer_to_floor(j);
                    }
                }
            }
            Crossing::ToStop => {
                if let Some(stop) = side.face(particle).law.stop() {
                    self.particles[j].gap = -side.away() * stop.length;
                    self.strike(j, side, stop.restitution)?;
                }
            }
            Crossing::Release if self.contacts[j].holds(particle) => {
                self.particles[j].rate = 0.0;
                self.let_go(j, side);
                self.smooth[j] = !self.sudden;
            }
            Crossing::Release => match side.face(particle).law {
                Law::Resilient { no_tension: true, .. } if self.particles[j].gap != 0.0 => {
                    self.slip(j, side);
                    self.smooth[j] = !self.sudden;
                }
                _ => {
                    self.particles[j].gap = 0.0;
                    self.let_go(j, side);
                }
            },
            Crossing::Recovered => {
                self.particles[j].gap = 0.0;
                self.changed = true;
                self.contacts[j] = Contact::Flight;
                if side == Side::Ceiling {
                    self.refer_to_floor(j);
                }
            }
            Crossing::Again => {
                self.slip(j, side);
                self.smooth[j] = !self.sudden;
            }
            Crossing::HalfCycle => {}
        }
        self.meet_at_once()?;
        self.choose_flow()
    }

    /// A particle in flight that is at a face and moves into it has met it: where there is no gap to cross, or where the
    /// impact of another particle has turned its face.
    fn meet_at_once(&mut self) -> Result<(), EngineError> {
        for j in 0..self.particles.len() {
            if self.contacts[j] != Contact::Flight {
                continue;
            }
            let here = self.particles[j];
            if here.gap == 0.0 && here.rate < 0.0 {
                self.meet(j, Side::Floor)?;
            } else if let Some(above) = self.ceiling_relative(j)
                && above.gap == 0.0
                && above.rate > 0.0
            {
                self.particles[j] = above;
                self.meet(j, Side::Ceiling)?;
            }
        }
        Ok(())
    }

    /// Adds the segment to the measures, and to the audit if there is one.
    fn sum_up(&mut self, length: f64, drive: DrivePhase) {
        let flow = &self.flows[self.now];
        if self.options.averages(self.cycle) {
            let second_half = 2 * (self.cycle - u64::from(self.options.skip)) >= u64::from(self.options.average);
            for (of, &row) in self.response.observed.iter_mut().zip(&flow.all_observed) {
                let (observed, rest) = self.signals.of(row);
                let integrals = match &flow.forms {
                    Some(forms) => {
                        self.observed_end.clear();
                        let end = flow.blocks.iter().zip(observed).zip(&self.search.kernels);
                        self.observed_end.extend(end.map(|((block, phase), kernel)| block.advance(*phase, *kernel)));
                        forms
                            .between(observed, &self.observed_end, length, self.options.displacement)
                            .offset(rest.p0, length)
                    }
                    None => quadrature(&flow.blocks, observed, rest, length),
                };
                let sums = &mut of.halves[usize::from(second_half)];
                sums.duration += length;
                sums.velocity_square += integrals.rate_square;
                sums.displacement += integrals.value;
                sums.displacement_square += integrals.square;
                if self.options.extremes {
                    extremes::take(&mut of.extremes, &flow.blocks, observed, rest, length);
                }
            }
        }
        if let Some(audit) = &mut self.audit
            && self.cycle >= u64::from(self.options.skip)
        {
            audit.segment(self.system, flow, &self.c, self.level, drive, length);
        }
        if self.system.drive.half_cycles.is_some() && !self.half.idle {
            let bends = guards::accelerations(&flow.blocks, self.signals.of(flow.observed).0);
            self.half.square += quadrature(&flow.blocks, &bends, Parabola::default(), length).square;
            self.half.length += length;
        }
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
        }
    }

    /// Samples of the time history that fall into the segment.
    fn sample(&mut self, length: f64) {
        let Some(request) = self.options.trace else { return };
        if !request.covers(self.cycle) {
            return;
        }
        let flow = &self.flows[self.now];
        let period = self.system.drive.period;
        let mut kernels = Vec::with_capacity(flow.blocks.len());
        for i in request.next_sample(self.time, period).. {
            let instant = request.instant(i, period);
            let t = instant - self.time;
            if t > length || (t >= length && instant >= period) {
                break;
            }
            kernels.clear();
            kernels.extend(flow.blocks.iter().map(|block| block.kernel(t)));
            let [displacement, velocity, acceleration] = self.signals.value(flow, flow.observed, &kernels, t);
            let mut sample = Sample {
                time: self.cycle as f64 * period + instant,
                displacement,
                velocity,
                acceleration,
                damping: self.damping.first().copied().unwrap_or(0.0),
                half_cycle_rms: self.half.last,
                ..Sample::default()
            };
            if let Some(particle) = self.system.particles.first() {
                let contact = self.contacts[0];
                let side = contact.side();
                let rows = flow.face_rows[0];
                let row = if side == Side::Floor { rows.floor } else { rows.ceiling };
                let [face, _, _] = self.signals.value(flow, row, &kernels, t);
                let gap = match (contact.face(particle), rows.compression) {
                    (None, _) => {
                        let (phases, here) = (self.signals.of(row).0, self.particles[0]);
                        guards::fly(flow, self.paths[0], phases, here, &kernels, t).gap
                    }
                    (Some(_), Some(compression)) => self.signals.value(flow, compression, &kernels, t)[0],
                    (Some(_), None) => self.particles[0].gap,
                };
                sample.set_particle(particle, side, face, gap, contact);
            }
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
pub(crate) fn march(system: &HybridSystem, options: &Options, at_rest: Option<Flow>) -> Result<Response, EngineError> {
    March::new(system, options, at_rest)?.run()
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
