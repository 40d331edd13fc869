//! What the check at the end of a step leads to. The state has gone as far beyond a face as a step took it.

use super::propagator::sides;
use super::stretch::{HalfCycle, Stretch};
use super::vector::Vector;
use super::{Closing, Run};
use crate::arithmetic::few::Few;
use crate::arithmetic::matrix::dot;
use crate::contact::collision::{self, Closed};
use crate::contact::touch::{self, Exchange, Touch};
use crate::contact::{Hold, Relative, STICKING_SPEED, Side};
use crate::error::EngineError;
use crate::response::audit::energy;
use crate::system::{EventKind, Law};

impl<V: Vector> Run<'_, V> {
    /// The contact state for the next steps.
    pub(super) fn decide(&mut self, end: Stretch) -> Result<(), EngineError> {
        self.seam(-0.5);
        if end.broken {
            // The sample of this step is the state that the check leaves behind.
            let before = self.observed_velocities();
            for j in 0..self.contacts.len() {
                self.check(j)?;
            }
            self.collide()?;
            let mut changes = self
                .observed_velocities()
                .into_iter()
                .zip(before)
                .map(|(after, before)| after * after - before * before);
            self.tally.velocity_square += changes.next().unwrap_or_default();
            self.tally.more.iter_mut().zip(changes).for_each(|([_, square], change)| *square += change);
            self.motion.half.iter_mut().for_each(HalfCycle::jumps);
        }
        if end.turned
            && let (Some(half), Some(half_cycles)) = (self.motion.half, &self.system.drive.half_cycles)
        {
            self.equivalent = Some(half_cycles.curve.at(half.last));
        }
        self.choose_propagator()?;
        self.seam(0.5);
        Ok(())
    }

    fn observed_velocities(&self) -> Few<f64> {
        let more = self.watch.more.iter().map(|[_, velocity]| velocity);
        std::iter::once(&self.watch.velocity).chain(more).map(|row| row.dot(&self.motion.state)).collect()
    }

    /// Whether the contact of a particle still holds, and what takes its place.
    fn check(&mut self, j: usize) -> Result<(), EngineError> {
        let particle = &self.system.particles[j];
        for side in sides(self.contacts[j], particle) {
            let here = self.relative(j, side);
            match self.contacts[j].at(side, particle) {
                Hold::Away if side.away() * here.gap < 0.0 => {
                    self.meet(j, side, here)?;
                    if !particle.has_walls() {
                        break;
                    }
                }
                Hold::Away => {}
                Hold::Held => {
                    let propagator = &self.known[self.now].propagator;
                    if propagator.hold(j, &self.motion.state, self.motion.force()) < 0.0 {
                        self.let_go(j, side)?;
                    }
                }
                hold @ (Hold::Pressed | Hold::Released) => self.check_spring(j, side, hold, here)?,
            }
        }
        Ok(())
    }

    /// The same for a face that is compressed, and pushes its particle or has let go of it.
    fn check_spring(&mut self, j: usize, side: Side, hold: Hold, here: Relative) -> Result<(), EngineError> {
        let Law::Resilient { stiffness, no_tension, stop, .. } = side.face(&self.system.particles[j]).law else {
            return Ok(());
        };
        let away = side.away();
        let compressed = 0.5 * stiffness * here.gap * here.gap;
        let pushes = away * (-stiffness * here.gap - self.damping(j, side) * here.rate) > 0.0;
        let is_back = away * here.gap > 0.0;
        if hold == Hold::Released {
            if is_back {
                self.turn(j, side, Hold::Away)?;
            } else if pushes {
                self.record(j, side.made(), here.rate, here.rate);
                self.turn(j, side, Hold::Pressed)?;
                self.lose(-compressed);
            }
        } else if is_back {
            self.let_go(j, side)?;
        } else if no_tension && !pushes {
            self.record(j, side.lost(), here.rate, here.rate);
            self.turn(j, side, Hold::Released)?;
            self.lose(compressed);
        } else if let Some(stop) = stop
            && away * here.gap < -stop.length
        {
            self.arrive(j, side, Relative { gap: -away * stop.length, ..here })?;
        }
        Ok(())
    }

    /// What one face does to a particle changes.
    fn turn(&mut self, j: usize, side: Side, hold: Hold) -> Result<(), EngineError> {
        let time = (self.step - self.schedule.cycle(self.cycle)) as f64 * self.time_step;
        let after = self.contacts[j].turned(side, hold, &self.system.particles[j]);
        self.contacts[j] = after.ok_or(EngineError::Squeezed { particle: j, cycle: self.cycle, time })?;
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
            Law::Rigid { .. } => self.arrive(j, side, Relative { gap: 0.0, ..here }),
            Law::Resilient { .. } => {
                self.record(j, side.made(), here.rate, here.rate);
                self.turn(j, side, Hold::Pressed)
            }
        }
    }

    /// A particle has come to something rigid: it is put there, and takes part in the step's collision if it moves into it.
    fn arrive(&mut self, j: usize, side: Side, here: Relative) -> Result<(), EngineError> {
        self.place(j, side, here);
        if side.away() * here.rate < 0.0 {
            self.closing.push(Closing { particle: j, side, held: false });
            self.turn(j, side, Hold::Held)?;
        }
        Ok(())
    }

    /// The exchange of momentum among what moves into something rigid at this step and what is held, by the rule of exact
    /// events. What is struck sticks below [`STICKING_SPEED`] if both then move the same way; whether the face can hold it is
    /// asked at the end of the next step.
    fn collide(&mut self) -> Result<(), EngineError> {
        if self.closing.is_empty() {
            return Ok(());
        }
        let mut touches = Few::new();
        for (j, particle) in self.system.particles.iter().enumerate() {
            let (side, rate, held) = match self.closing.iter().find(|closing| closing.particle == j) {
                Some(Closing { side, held, .. }) => (*side, self.relative(j, *side).rate, *held),
                None if self.contacts[j].holds(particle) => (self.contacts[j].side(), 0.0, true),
                None => continue,
            };
            touches.push(Touch::new(self.system, &mut self.mobilities, j, side, held, rate)?);
        }
        self.closing.clear();
        let closed: Few<Closed> = touches.iter().map(|touch| touch.closed).collect();
        let outcomes = collision::collide(&closed, &touch::answers(self.system, &self.mobilities, &touches));
        let Exchange { jump, loss } = Exchange::new(self.system, &self.mobilities, &touches, &outcomes);
        self.kick_structure(&jump);
        self.lose(loss);
        for (touch, outcome) in touches.iter().zip(&outcomes) {
            let Touch { particle: j, side, on_stop, held, closed, .. } = *touch;
            let (away, struck) = (side.away(), outcome.pushed && closed.is_struck());
            let departure = away * outcome.speed;
            let row = &side.face(&self.system.particles[j]).row;
            let face = dot(row, self.layout.structure(self.motion.state.as_ref())[1]);
            let sticks = on_stop || closed.both_ways || !struck || face * (face + departure) > 0.0;
            let rests = outcome.speed < STICKING_SPEED && sticks;
            let gap = self.relative(j, side).gap;
            self.place(j, side, Relative { gap, rate: if rests { 0.0 } else { departure } });
            if struck {
                let kind = if on_stop { side.hit() } else { side.made() };
                self.record_contact(j, kind, [away * closed.speed, departure], rests);
            } else if held && !rests {
                self.let_go(j, side)?;
                continue;
            }
            let elsewhere = if on_stop { Hold::Pressed } else { Hold::Away };
            self.turn(j, side, if rests { Hold::Held } else { elsewhere })?;
        }
        // A stop does not hold for a step what its spring throws back.
        self.choose_propagator()?;
        for Touch { particle: j, side, .. } in touches.into_iter().filter(|touch| touch.on_stop && !touch.held) {
            if self.known[self.now].propagator.hold(j, &self.motion.state, self.motion.force()) < 0.0 {
                self.turn(j, side, Hold::Pressed)?;
            }
        }
        Ok(())
    }

    /// A face loses its particle.
    fn let_go(&mut self, j: usize, side: Side) -> Result<(), EngineError> {
        let rate = self.relative(j, side).rate;
        let particle = &self.system.particles[j];
        let held = self.contacts[j].at(side, particle) == Hold::Held;
        let stopped = held && side.face(particle).law.stop().is_some();
        self.record(j, if stopped { EventKind::StopRelease } else { side.lost() }, rate, rate);
        self.turn(j, side, if stopped { Hold::Pressed } else { Hold::Away })
    }

    /// The structure's velocity jumps; the particles keep their own.
    fn kick_structure(&mut self, jump: &[f64]) {
        let (positions, layout) = (self.layout.positions(), self.layout);
        let state = self.motion.state.as_mut();
        state[positions..].iter_mut().zip(jump).for_each(|(rate, jump)| *rate += jump);
        for (j, particle) in self.system.particles.iter().enumerate() {
            state[layout.gap(j) + positions] -= dot(&particle.floor.row, jump);
        }
    }

    /// An impulse at the forcing point. It acts on the structure; a particle that is held receives its share through its
    /// face, or loses it.
    pub(super) fn impulse(&mut self, impulse: f64) -> Result<(), EngineError> {
        self.seam(-0.5);
        let before = self.audit.is_some().then(|| energy(self.system, &self.audit_state()));
        let jump: Few<f64> = self.jump.iter().map(|jump| impulse * jump).collect();
        self.kick_structure(&jump);
        let work = before.map(|before| energy(self.system, &self.audit_state()) - before);
        if let (Some(audit), Some(work)) = (&mut self.audit, work) {
            audit.impulse(impulse, work);
        }
        let holds = |j: &usize| self.contacts[*j].holds(&self.system.particles[*j]);
        let closing = |j: usize| Closing { particle: j, side: self.contacts[j].side(), held: true };
        self.closing.extend((0..self.contacts.len()).filter(holds).map(closing));
        self.collide()?;
        self.choose_propagator()?;
        self.seam(0.5);
        Ok(())
    }
}
