//! Rigid faces and limit stops: impacts, and whether a face can hold what no longer bounces.
//!
//! Velocities first: [`collision`](crate::contact::collision) takes all contacts that are closed at the instant together.
//! Then accelerations: of the particles that are left without relative speed, those are held that their faces have to push.

use super::March;
use super::effects::Effects;
use super::grip::{Bend, Grip};
use crate::arithmetic::few::Few;
use crate::arithmetic::matrix::dot;
use crate::contact::collision::{self, Closed, Outcome};
use crate::contact::touch::{self, Exchange, Touch};
use crate::contact::{Hold, Relative, STICKING_SPEED, Side};
use crate::error::EngineError;
use crate::response::audit::energy;
use crate::search::guards::Slipped;
use crate::system::{Contact, EventKind, Particle};

/// A particle that its face may hold from now on.
pub(super) struct Candidate {
    particle: usize,
    side: Side,
    on_stop: bool,
    before: Before,
    /// Relative speed that is left: too slow a bounce to be followed.
    speed: f64,
    restitution: f64,
}

/// What a candidate comes from.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Before {
    /// Held until now, and not struck.
    Held,
    /// Struck at this instant.
    Struck,
    /// It lies there without being held.
    Apart,
}

impl<E: Effects> March<'_, E> {
    /// An impulse on the structure: a particle that is held receives its share through the face.
    pub(super) fn strike_structure(&mut self, impulse: f64) -> Result<(), EngineError> {
        let before = self.audit.is_some().then(|| energy(self.system, &self.audit_state()));
        // M⁻¹ b: what a unit impulse does to q′.
        let answer = self.states.ground().answer(self.system)?;
        for j in 0..self.particles.len() {
            let row = &self.contacts[j].side().face(&self.system.particles[j]).row;
            self.particles[j].rate -= impulse * dot(row, answer);
            self.smooth[j] = false;
        }
        self.rate.iter_mut().zip(answer).for_each(|(rate, jump)| *rate += impulse * jump);
        let work = before.map(|before| energy(self.system, &self.audit_state()) - before);
        if let (Some(audit), Some(work)) = (&mut self.audit, work) {
            audit.impulse(impulse, work);
        }
        self.half.jumps();
        self.settle(&[])
    }

    /// A particle meets a rigid face or a stop, and with it every other one that rounding cannot tell apart from it.
    pub(super) fn strike(&mut self, j: usize, side: Side) -> Result<(), EngineError> {
        let mut arrived = Few::from_elem((j, side), 1);
        if self.particles.len() > 1 {
            let others = (0..self.particles.len()).filter(|&other| other != j);
            let tied: Few<_> = others.filter_map(|other| Some((other, self.arrives(other)?))).collect();
            for &(other, side) in &tied {
                if let Some(stop) = side.face(&self.system.particles[other]).law.stop() {
                    self.particles[other].gap = -side.away() * stop.length;
                }
            }
            if !tied.is_empty() {
                self.clarity.ties += tied.len() as u64;
                // One after the other they may leave with other speeds.
                self.clarity.margin = 0.0;
            }
            arrived.extend(tied);
        }
        self.settle(&arrived)
    }

    /// The rigid face, or the stop, that a particle moves into and has reached, as far as rounding can tell.
    fn arrives(&self, j: usize) -> Option<Side> {
        let particle = &self.system.particles[j];
        let contact = self.contacts[j];
        let reached =
            |side: Side, here: Relative| side.away() * here.rate < 0.0 && here.gap.abs() <= self.noise(j, side, here);
        if contact.presses(particle) {
            let (side, Relative { gap, rate }) = (contact.side(), self.particles[j]);
            let stop = side.face(particle).law.stop()?;
            return reached(side, Relative { gap: gap + side.away() * stop.length, rate }).then_some(side);
        }
        let rigid = |side: Side| side.face(particle).law.is_rigid();
        let flies = |side: Side| contact == Contact::Flight && rigid(side);
        if flies(Side::Floor) && reached(Side::Floor, self.particles[j]) {
            return Some(Side::Floor);
        }
        let above = self.referred(j, Side::Ceiling)?;
        (flies(Side::Ceiling) && reached(Side::Ceiling, above)).then_some(Side::Ceiling)
    }

    /// What of a gap is rounding, of its own parts and of the instant.
    pub(super) fn noise(&self, j: usize, side: Side, here: Relative) -> f64 {
        let particle = &self.system.particles[j];
        let parts = |row: &[f64]| row.iter().zip(&self.q).fold(0.0, |sum, (a, b)| sum + (a * b).abs());
        let size = parts(&side.face(particle).row) + if side == Side::Ceiling { particle.gap.abs() } else { 0.0 };
        16.0 * f64::EPSILON * (size + here.rate.abs() * self.system.drive.period)
    }

    /// After a jump of velocities: decides every contact that the jump has made untenable. `arrived` particles in flight
    /// are at a rigid face, pressed ones at its stop.
    pub(super) fn settle(&mut self, arrived: &[(usize, Side)]) -> Result<(), EngineError> {
        self.come_out();
        let candidates = if E::ALL { self.collide(arrived)? } else { Few::new() };
        for j in 0..self.particles.len() {
            // Whose state refers to a rigid face already.
            if !candidates.iter().any(|candidate| candidate.particle == j && !candidate.on_stop) {
                self.press_or_part(j)?;
            }
        }
        self.hold(candidates)?;
        for j in 0..self.particles.len() {
            self.rest(j)?;
        }
        self.choose_flow()
    }

    /// After a jump of accelerations: lets go what a face can no longer hold.
    pub(super) fn hold_on(&mut self) -> Result<(), EngineError> {
        let holds = |(contact, particle): (&Contact, &Particle)| contact.holds(particle);
        if E::ALL && self.contacts.iter().zip(&self.system.particles).any(holds) {
            let held = (0..self.particles.len()).filter(|&j| holds((&self.contacts[j], &self.system.particles[j])));
            let candidates = held.map(|j| self.candidate(j)).collect();
            self.hold(candidates)?;
        }
        self.choose_flow()
    }

    /// After a jump of the force: the same, and what rests at a face without being pressed to it may be so from now on.
    pub(super) fn regrip(&mut self) -> Result<(), EngineError> {
        self.half.jumps();
        let mut touches = self.touches(&[])?;
        touches.retain(|touch| touch.closed.speed == 0.0);
        for touch in touches.iter().filter(|touch| !touch.on_stop) {
            self.particles[touch.particle] = Relative::default();
        }
        self.hold(touches.iter().map(Candidate::at_rest).collect())?;
        for j in 0..self.particles.len() {
            self.rest(j)?;
        }
        self.choose_flow()
    }

    fn candidate(&self, j: usize) -> Candidate {
        let side = self.contacts[j].side();
        let on_stop = self.is_on_stop(j, side);
        Candidate { particle: j, side, on_stop, before: Before::Held, speed: 0.0, restitution: 0.0 }
    }

    /// The rigid contacts that are closed.
    pub(super) fn touches(&mut self, arrived: &[(usize, Side)]) -> Result<Few<Touch>, EngineError> {
        let mut touches = Few::new();
        for (j, particle) in self.system.particles.iter().enumerate() {
            let contact = self.contacts[j];
            let here = self.particles[j];
            let held = contact.holds(particle);
            let rigid = |side: Side| side.face(particle).law.is_rigid();
            let above = || self.referred(j, Side::Ceiling);
            let side = if let Some((_, side)) = arrived.iter().find(|(other, _)| *other == j) {
                *side
            } else if held {
                contact.side()
            } else if contact == Contact::Flight && here.gap == 0.0 && rigid(Side::Floor) {
                Side::Floor
            } else if contact == Contact::Flight
                && above().is_some_and(|above| above.gap == 0.0 && rigid(Side::Ceiling))
            {
                Side::Ceiling
            } else if let (true, Some(stop)) = (contact.presses(particle), contact.side().face(particle).law.stop())
                && here.gap == -contact.side().away() * stop.length
            {
                contact.side()
            } else {
                continue;
            };
            let rate = match (contact, side) {
                (Contact::Flight, Side::Ceiling) => above().map_or(here.rate, |above| above.rate),
                _ => here.rate,
            };
            touches.push(Touch::new(self.system, &mut self.mobilities, j, side, held, rate)?);
        }
        Ok(touches)
    }

    /// S of the closed contacts, row by row.
    pub(super) fn answers(&self, touches: &[Touch]) -> Few<f64> {
        touch::answers(self.system, &self.mobilities, touches)
    }

    /// The exchange of momentum among all closed rigid contacts. Gives those that may be held.
    fn collide(&mut self, arrived: &[(usize, Side)]) -> Result<Few<Candidate>, EngineError> {
        let touches = self.touches(arrived)?;
        if touches.is_empty() {
            return Ok(Few::new());
        }
        let closed: Few<Closed> = touches.iter().map(|touch| touch.closed).collect();
        let outcomes = if closed.iter().any(Closed::is_struck) {
            let outcomes = collision::collide(&closed, &self.answers(&touches));
            self.exchange(&touches, &outcomes);
            if E::TAPED {
                self.tape_exchange(&touches, &outcomes);
            }
            self.half.jumps();
            outcomes
        } else {
            closed.iter().map(|contact| Outcome { speed: contact.speed, ..Outcome::default() }).collect()
        };
        let mut candidates = Few::new();
        for (touch, outcome) in touches.iter().zip(&outcomes) {
            let slow = if self.has_walls() { self.slow(touch) } else { STICKING_SPEED };
            let Touch { particle: j, side, on_stop, held, closed, .. } = *touch;
            let away = side.away();
            let gap = if on_stop { self.particles[j].gap } else { 0.0 };
            let struck = outcome.pushed && closed.is_struck();
            if struck {
                let kind = if on_stop { side.hit() } else { side.made() };
                self.record(j, kind, away * closed.speed, away * outcome.speed);
                self.lasts(j, false);
            }
            self.changed = true;
            self.smooth[j] = false;
            self.particles[j] = Relative { gap, rate: away * outcome.speed };
            if outcome.speed <= slow {
                let (speed, restitution) = (outcome.speed, closed.restitution);
                let before = match (struck, held) {
                    (true, _) => Before::Struck,
                    (false, true) => Before::Held,
                    (false, false) => Before::Apart,
                };
                candidates.push(Candidate { particle: j, side, on_stop, before, speed, restitution });
            } else if held && !struck {
                self.let_go(j, side);
            } else {
                self.part(j, side, on_stop);
            }
        }
        Ok(candidates)
    }

    /// Relative speed below which a particle sticks to a face beside another one.
    #[cold]
    fn slow(&self, touch: &Touch) -> f64 {
        let Touch { particle: j, side, closed, mobility, .. } = *touch;
        if !self.touches_across(j, side) {
            return STICKING_SPEED;
        }
        let row = &side.face(&self.system.particles[j]).row;
        let carried = 1.0 + closed.mass * dot(row, self.mobilities.answer(mobility));
        self.slow_between(j, side, closed.restitution, carried)
    }

    /// Gives the impulses of a collision to the structure; the faces of all particles that are not part of it move along.
    fn exchange(&mut self, touches: &[Touch], outcomes: &[Outcome]) {
        let Exchange { jump, loss } = Exchange::new(self.system, &self.mobilities, touches, outcomes);
        for (j, particle) in self.system.particles.iter().enumerate() {
            if !touches.iter().any(|touch| touch.particle == j) {
                self.particles[j].rate -= dot(&self.contacts[j].side().face(particle).row, &jump);
            }
        }
        self.rate.iter_mut().zip(&jump).for_each(|(rate, jump)| *rate += jump);
        if let Some(audit) = &mut self.audit {
            audit.loss(loss);
        }
    }

    /// Decides which of the candidates are held. Whether a face must push one of them depends on which others are held: the
    /// pushes solve a problem of the same kind as the impulses of a collision, and are found in the same way: the first that is
    /// wrong is turned round. So the last of n turns once at most, and each one before it twice as often as that behind it
    /// (Murty 1974); what turns more often is nothing but rounding.
    fn hold(&mut self, candidates: Few<Candidate>) -> Result<(), EngineError> {
        if candidates.is_empty() {
            return Ok(());
        }
        self.come_out();
        let mut holds = Few::from_elem(true, candidates.len());
        let mut grips = Few::from_elem(Grip::default(), candidates.len());
        let mut turns = Few::from_elem(0, candidates.len());
        for candidate in &candidates {
            self.fix(candidate, true);
        }
        let most = |i: usize| 1_usize << (candidates.len() - 1 - i).min(16);
        for _ in 0..1 + 2 * candidates.len() + (1_usize << candidates.len().min(16)) {
            self.choose_flow()?;
            self.enter_now();
            let mut wrong = None;
            for (i, candidate) in candidates.iter().enumerate() {
                grips[i] = self.grip(candidate.particle, candidate.side, candidate.on_stop);
                let grip = grips[i];
                let enclosed = self.system.particles[candidate.particle].is_enclosed();
                // A face that pushes with nothing holds what does not move; what still bounces goes on.
                let able = grip.holds() && (grip.outweighs(candidate.speed) || !grip.is_nothing());
                let fits = holds[i] == (enclosed || able);
                // Neither way: what rounding has left of nothing.
                let fits = fits || turns[i] > most(i);
                if !fits && wrong.is_none() {
                    wrong = Some(i);
                }
            }
            let Some(i) = wrong else { break };
            turns[i] += 1;
            holds[i] = if turns[i] > most(i) { grips[i].grows() } else { !holds[i] };
            self.fix(&candidates[i], holds[i]);
        }
        for (i, ((candidate, holds), grip)) in candidates.iter().zip(&holds).zip(&grips).enumerate() {
            let (j, side) = (candidate.particle, candidate.side);
            let at_rest = grip.outweighs(candidate.speed);
            self.smooth[j] = at_rest && (grip.is_nothing() || turns[i] > most(i));
            if at_rest && self.contacts[j].side() == side {
                self.particles[j].rate = 0.0;
            }
            if *holds {
                match candidate.before {
                    _ if !at_rest => self.end_chatter(candidate, *grip)?,
                    Before::Struck => self.lasts(j, true),
                    Before::Held | Before::Apart => {}
                }
                self.particles[j].rate = 0.0;
            } else {
                if candidate.before == Before::Held {
                    let kind = if candidate.on_stop { EventKind::StopRelease } else { side.lost() };
                    self.record(j, kind, 0.0, 0.0);
                }
                self.part(j, side, candidate.on_stop);
                if at_rest && self.contacts[j].side() != side && self.touches_across(j, side) {
                    // The state refers to the other face now.
                    let order = if std::mem::take(&mut self.smooth[j]) { 3 } else { 2 };
                    self.slipped = Some(Slipped { particle: j, order });
                }
            }
        }
        self.choose_flow()
    }

    /// Whether the contact that has just been made goes on.
    fn lasts(&mut self, j: usize, lasts: bool) {
        let now = (self.cycle, self.time);
        let last = self.response.events.iter_mut().rfind(|event| event.particle == j && event.kind.is_contact());
        if let Some(event) = last.filter(|event| (event.cycle, event.time) == now) {
            event.lasts = lasts;
        }
    }

    /// Holds a candidate, or does not; its state goes on referring to the face.
    fn fix(&mut self, candidate: &Candidate, holds: bool) {
        let Candidate { particle: j, side, on_stop, .. } = *candidate;
        self.changed = true;
        if self.touches_across(j, side) {
            let hold = match (on_stop, holds) {
                (_, true) => Hold::Held,
                (true, false) => Hold::Pressed,
                (false, false) => Hold::Away,
            };
            // The face across does not hold it: that was refused where they met.
            let _always = self.turn(j, side, hold);
            return;
        }
        self.contacts[j] = match (on_stop, holds) {
            (true, true) => side.stopped(),
            (true, false) | (false, true) => side.pressed(),
            (false, false) => Contact::Flight,
        };
    }

    /// What is left to bounce is a geometric series of flights of 2u′/a, each shorter by ε: its time is added, and its last
    /// speed goes to the structure with all that it carries.
    fn end_chatter(&mut self, candidate: &Candidate, grip: Grip) -> Result<(), EngineError> {
        let touches: Few<Touch> =
            self.touches(&[])?.into_iter().filter(|touch| touch.held || touch.particle == candidate.particle).collect();
        let closed: Few<Closed> = touches.iter().map(|touch| touch.closed).collect();
        let still: Few<f64> = Few::from_elem(0.0, closed.len());
        let all: Few<bool> = Few::from_elem(true, closed.len());
        let answers = self.answers(&touches);
        let pushes = collision::push(&closed, &answers, &all, &still);
        let outcome = |(contact, p): (&Closed, &f64)| Outcome { impulse: p * contact.mass, speed: 0.0, pushed: true };
        let outcomes: Few<Outcome> = closed.iter().zip(&pushes).map(outcome).collect();
        self.exchange(&touches, &outcomes);
        // In flight the face no longer carries the particle, so that a is larger than the push per mass that will hold it.
        let alone: Few<Closed> = touches
            .iter()
            .zip(&closed)
            .map(|(touch, closed)| Closed {
                speed: if touch.particle == candidate.particle { 1.0 } else { 0.0 },
                ..*closed
            })
            .collect();
        let own = touches.iter().position(|touch| touch.particle == candidate.particle);
        let lightening = own.map_or(1.0, |own| -1.0 / collision::push(&alone, &answers, &all, &still)[own]);
        let series = if candidate.restitution < 1.0 { 1.0 / (1.0 - candidate.restitution) } else { 0.0 };
        let tail = 2.0 * candidate.speed / (grip.push * lightening) * series;
        let speed = candidate.side.away() * candidate.speed;
        self.record_at(candidate.particle, EventKind::ChatterEnd, self.time + tail, speed, 0.0);
        for touch in &touches {
            self.particles[touch.particle].rate = 0.0;
        }
        Ok(())
    }

    /// Enters the flow in force, for [`Self::grip`].
    pub(super) fn enter_now(&mut self) {
        let drive = self.drive_phase(self.time);
        self.enter_flow(drive);
    }

    /// How a face holds particle j in the flow that has been entered.
    pub(super) fn grip(&self, j: usize, side: Side, on_stop: bool) -> Grip {
        let row = self.flow.face(self.system, j, side);
        let bend = Bend::of(&self.flow.blocks, row, &self.c, self.level);
        let grip = Grip::of(self.system, bend, j, side, on_stop);
        if self.touches_across(j, side) { grip.against(self.push_across(j, side)) } else { grip }
    }
}

impl Candidate {
    fn at_rest(touch: &Touch) -> Self {
        let Touch { particle, side, on_stop, held, .. } = *touch;
        let before = if held { Before::Held } else { Before::Apart };
        Self { particle, side, on_stop, before, speed: 0.0, restitution: 0.0 }
    }
}
