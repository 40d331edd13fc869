//! What the check at the end of a step leads to. The state has gone as far beyond a face as a step took it.

use super::Run;
use super::propagator::lead;
use super::stretch::{HalfCycle, Stretch};
use super::vector::Vector;
use crate::dynamics::EngineError;
use crate::dynamics::audit::energy;
use crate::dynamics::cholesky::Cholesky;
use crate::dynamics::conservative::carried_mass;
use crate::dynamics::contact::{Impact, Relative, STICKING_SPEED, Side};
use crate::dynamics::system::{Contact, EventKind, Law, Particle, dot};

impl<V: Vector> Run<'_, V> {
    /// The contact state for the next steps.
    pub(super) fn decide(&mut self, end: Stretch) -> Result<(), EngineError> {
        self.seam(-0.5);
        if end.broken {
            // The sample of this step is the state that the check leaves behind.
            let before = self.watch.velocity.dot(&self.motion.state);
            for j in 0..self.contacts.len() {
                self.check(j)?;
            }
            let after = self.watch.velocity.dot(&self.motion.state);
            self.tally.velocity_square += after * after - before * before;
            self.motion.half.iter_mut().for_each(HalfCycle::jumps);
        }
        if end.turned
            && let (Some(half), Some(half_cycles)) = (self.motion.half, &self.system.drive.half_cycles)
        {
            self.equivalent = half_cycles.curve.at(half.last);
        }
        self.choose_propagator()?;
        self.seam(0.5);
        Ok(())
    }

    /// Whether the contact of a particle still holds, and what takes its place.
    fn check(&mut self, j: usize) -> Result<(), EngineError> {
        let particle = &self.system.particles[j];
        let contact = self.contacts[j];
        let side = contact.side();
        let away = side.away();
        let here = self.relative(j, side);
        if contact == Contact::Flight {
            if here.gap < 0.0 {
                self.meet(j, Side::Floor, here)?;
            } else if particle.ceiling.is_some() {
                let ceiling = self.relative(j, Side::Ceiling);
                if ceiling.gap > 0.0 {
                    self.meet(j, Side::Ceiling, ceiling)?;
                }
            }
        } else if contact.holds(particle) {
            let propagator = &self.propagators[self.now];
            if propagator.hold(j, &self.motion.state, self.motion.force()) < 0.0 {
                self.let_go(j, side);
            }
        } else if let Law::Resilient { stiffness, no_tension, stop, .. } = side.face(particle).law {
            let compressed = 0.5 * stiffness * here.gap * here.gap;
            let pushes = away * (-stiffness * here.gap - self.damping(j) * here.rate) > 0.0;
            if contact.presses(particle) {
                if away * here.gap > 0.0 {
                    self.let_go(j, side);
                } else if no_tension && !pushes {
                    self.record(j, side.lost(), here.rate, here.rate);
                    self.contacts[j] = side.released();
                    self.lose(compressed);
                } else if let Some(stop) = stop
                    && away * here.gap < -stop.length
                {
                    self.place(j, side, Relative { gap: -away * stop.length, ..here });
                    if away * here.rate < 0.0 {
                        self.strike(j, side, stop.restitution)?;
                    }
                }
            } else if away * here.gap > 0.0 {
                self.contacts[j] = Contact::Flight;
            } else if pushes {
                self.record(j, side.made(), here.rate, here.rate);
                self.contacts[j] = side.pressed();
                self.lose(-compressed);
            }
        }
        Ok(())
    }

    /// Books energy that an impact takes, or a spring that lets go while compressed.
    fn lose(&mut self, energy: f64) {
        if let Some(audit) = &mut self.audit {
            audit.loss(energy);
        }
    }

    /// A particle in flight is found beyond a face.
    fn meet(&mut self, j: usize, side: Side, here: Relative) -> Result<(), EngineError> {
        match side.face(&self.system.particles[j]).law {
            Law::Rigid { restitution } => {
                self.place(j, side, Relative { gap: 0.0, ..here });
                if side.away() * here.rate < 0.0 { self.strike(j, side, restitution) } else { Ok(()) }
            }
            Law::Resilient { .. } => {
                self.contacts[j] = side.pressed();
                self.record(j, side.made(), here.rate, here.rate);
                Ok(())
            }
        }
    }

    /// An impact on something rigid, where the particle is. It sticks below [`STICKING_SPEED`] if both then move the
    /// same way; whether the face can hold it is asked at the end of the next step.
    fn strike(&mut self, j: usize, side: Side, restitution: f64) -> Result<(), EngineError> {
        let face = side.face(&self.system.particles[j]);
        let stop = face.law.stop();
        let here = self.relative(j, side);
        self.contacts[j] = Contact::Flight;
        let answer = Cholesky::new(&carried_mass(self.system, &self.contacts))?.solve(&face.row);
        let mass = self.system.particles[j].mass;
        let impact = Impact::new(dot(&face.row, &answer), mass, restitution, here.rate);
        let jump: Vec<f64> = answer.iter().map(|a| -a * impact.impulse).collect();
        self.kick_structure(&jump, |contact, particle| contact.holds(particle));
        self.place(j, side, Relative { rate: impact.departure, ..here });
        self.lose(impact.loss);
        self.record(j, if stop.is_some() { side.hit() } else { side.made() }, here.rate, impact.departure);
        let (n, positions) = (self.layout.n, self.layout.positions());
        let speed = dot(&face.row, &self.motion.state.values()[positions..positions + n]);
        let slow = impact.departure.abs() < STICKING_SPEED;
        self.contacts[j] = match stop {
            Some(_) if slow => side.stopped(),
            Some(_) => side.pressed(),
            None if slow && speed * (speed + impact.departure) > 0.0 => side.pressed(),
            None => Contact::Flight,
        };
        if self.contacts[j].holds(&self.system.particles[j]) {
            self.place(j, side, Relative { rate: 0.0, ..here });
        }
        Ok(())
    }

    /// A face loses its particle.
    fn let_go(&mut self, j: usize, side: Side) {
        let rate = self.relative(j, side).rate;
        let stopped = self.contacts[j] == side.stopped();
        self.record(j, if stopped { EventKind::StopRelease } else { side.lost() }, rate, rate);
        self.contacts[j] = if stopped { side.pressed() } else { Contact::Flight };
    }

    /// The structure's velocity jumps. Particles that `follow` keep their velocity relative to their face, the others their own.
    fn kick_structure(&mut self, jump: &[f64], follow: impl Fn(Contact, &Particle) -> bool) {
        let (positions, layout) = (self.layout.positions(), self.layout);
        let state = self.motion.state.values_mut();
        state[positions..].iter_mut().zip(jump).for_each(|(rate, jump)| *rate += jump);
        for (j, particle) in self.system.particles.iter().enumerate() {
            let gap_rate = &mut state[layout.gap(j) + positions];
            if follow(self.contacts[j], particle) {
                let ahead = lead(particle, self.contacts[j].side());
                *gap_rate += ahead.zip(jump).fold(0.0, |sum, (lead, jump)| sum + lead * jump);
            } else {
                *gap_rate -= dot(&particle.floor.row, jump);
            }
        }
    }

    /// An impulse at the forcing point. It acts on the structure; a particle that is held receives its share through its
    /// face, or loses it.
    pub(super) fn impulse(&mut self, impulse: f64) -> Result<(), EngineError> {
        self.seam(-0.5);
        let before = self.audit.is_some().then(|| energy(self.system, &self.audit_state()));
        let jump: Vec<f64> = self.jump.iter().map(|jump| impulse * jump).collect();
        self.kick_structure(&jump, |_, _| false);
        if let Some(before) = before {
            let after = energy(self.system, &self.audit_state());
            if let Some(audit) = &mut self.audit {
                audit.impulse(impulse, after - before);
            }
        }
        for j in 0..self.contacts.len() {
            if !self.contacts[j].holds(&self.system.particles[j]) {
                continue;
            }
            let side = self.contacts[j].side();
            let away = side.away() * self.relative(j, side).rate;
            if away < 0.0 {
                self.strike(j, side, side.face(&self.system.particles[j]).law.restitution())?;
            } else if away > 0.0 {
                self.let_go(j, side);
            }
        }
        self.choose_propagator()?;
        self.seam(0.5);
        Ok(())
    }
}
