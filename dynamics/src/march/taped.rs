//! What a run leaves on the tape that its motion is named from; only runs that are asked for it have this code.

use std::rc::Rc;

use super::March;
use super::effects::Effects;
use crate::arithmetic::few::Few;
use crate::arithmetic::matrix::dot;
use crate::contact::collision::{self, Closed, Outcome};
use crate::contact::touch::Touch;
use crate::contact::{Change, Crossing, Hold, Side};
use crate::error::EngineError;
use crate::motion::{self, Instant, Jump, Kick};
use crate::options::{Averaged, Until};
use crate::response::{Counts, Observed};
use crate::system::{Contact, Law};

impl<E: Effects> March<'_, E> {
    /// An event, with both sides of it.
    pub(super) fn cross_taped(&mut self, j: usize, crossing: Crossing) -> Result<(), EngineError> {
        let gap = self.gap_of(j, crossing);
        let before = self.instant();
        self.held.clone_from(&self.contacts);
        self.cross(j, crossing)?;
        self.tape_captures()?;
        self.choose_flow()?;
        let after = self.instant();
        let force = self.level + self.drive_phase(self.time).sine;
        self.tape.event(gap, before, after, force);
        Ok(())
    }

    /// The gap that closes or opens at a crossing; none where a force comes to zero, where nothing jumps.
    fn gap_of(&self, j: usize, crossing: Crossing) -> Option<(usize, Side)> {
        let (contact, particle) = (self.contacts[j], &self.system.particles[j]);
        let (side, change) = crossing.at(contact.side())?;
        let has_gap = match change {
            Change::Meets | Change::Stops => true,
            Change::Releases => {
                let at_gap = matches!(side.face(particle).law, Law::Resilient { no_tension: false, .. });
                at_gap && contact.at(side, particle) != Hold::Held
            }
            Change::Recovers | Change::PushesAgain => false,
        };
        has_gap.then_some((j, side))
    }

    fn instant(&mut self) -> Instant {
        let Self { system, flow, q, rate, particles, contacts, tape, .. } = self;
        let (n, attached) = (system.mass.order, &flow.modes.attached);
        let places = q[..n].iter().copied().chain(attached.iter().map(|&j| particles[j].gap));
        let rates = rate[..n].iter().copied().chain(attached.iter().map(|&j| particles[j].rate));
        let row = |j: usize| &contacts[j].side().face(&system.particles[j]).row;
        let absolute = (0..particles.len()).map(|j| dot(row(j), rate) + particles[j].rate);
        tape.instant(flow, places.chain(rates).chain(absolute))
    }

    /// An exchange of momentum among rigid contacts.
    pub(super) fn tape_exchange(&mut self, touches: &[Touch], outcomes: &[Outcome]) {
        let pushes: Few<bool> = outcomes.iter().map(|outcome| outcome.pushed).collect();
        let jump = self.jump_of(touches, &pushes, |touch| touch.closed.is_struck().then_some(touch.closed.restitution));
        let arrived = touches.iter().filter(|touch| !touch.held && touch.closed.is_struck()).count();
        self.tape.jump(jump, arrived);
    }

    /// Particles that a face holds from now on, whatever brought them there: they move with it, and the momentum of their
    /// relative speed goes to it.
    pub(super) fn tape_captures(&mut self) -> Result<(), EngineError> {
        let holds = |contact: Contact, j: usize| contact.holds(&self.system.particles[j]);
        if !(0..self.held.len()).any(|j| holds(self.contacts[j], j) && self.contacts[j] != self.held[j]) {
            return Ok(());
        }
        let mut touches = self.touches(&[])?;
        touches.retain(|touch| touch.held);
        let all: Few<bool> = Few::from_elem(true, touches.len());
        let mut jump = self.jump_of(&touches, &all, |_| None);
        jump.holds = true;
        self.tape.jump(jump, 0);
        Ok(())
    }

    /// The impulses of the contacts that push, by the speeds before; a struck one leaves with its restitution, others stay.
    fn jump_of(&self, touches: &[Touch], pushes: &[bool], struck: impl Fn(&Touch) -> Option<f64>) -> Jump {
        let count = touches.len();
        let answers = self.answers(touches);
        let mut impulses = Few::from_elem(0.0, count * count);
        for k in (0..count).filter(|&k| pushes[k]) {
            let speed = |i: usize| if i == k { 1.0 } else { 0.0 };
            let moved: Few<Closed> =
                touches.iter().enumerate().map(|(i, touch)| Closed { speed: speed(i), ..touch.closed }).collect();
            let wanted: Few<f64> =
                touches.iter().enumerate().map(|(i, touch)| -struck(touch).unwrap_or(0.0) * speed(i)).collect();
            for (i, impulse) in collision::push(&moved, &answers, pushes, &wanted).into_iter().enumerate() {
                impulses[i * count + k] = impulse;
            }
        }
        let kick = |(touch, pushes): (&Touch, &bool)| Kick {
            particle: touch.particle,
            side: touch.side,
            answer: Rc::clone(self.mobilities.answer(touch.mobility)),
            restitution: struck(touch).filter(|_| *pushes),
        };
        Jump { kicks: touches.iter().zip(pushes).map(kick).collect(), impulses, holds: false }
    }

    /// At the end of a cycle: the period that is averaged from now on, if the run was to settle and just did.
    pub(super) fn settle_down(&mut self) -> Result<Option<Averaged>, EngineError> {
        if self.options.until == Until::Cycles || self.response.settled.is_some() {
            return Ok(None);
        }
        let Some(cycles) = motion::settled(self.system, &self.tape)? else { return Ok(None) };
        // What was averaged so far is not asked for.
        self.pay_out();
        self.response.observed.fill(Observed::default());
        self.response.counts = Counts::default();
        self.averaged = Averaged { first: self.cycle + 1, cycles };
        self.response.settled = Some(self.averaged);
        Ok(self.response.settled)
    }
}
