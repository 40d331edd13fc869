//! What a crossing leads to, and what resilient faces do at a jump of the velocities: they push or they do not, and no
//! velocity jumps for it. Rigid faces are the business of [`super::impacts`].

use super::March;
use super::effects::Effects;
use super::half_cycles::Stage;
use crate::arithmetic::few::Few;
use crate::contact::{Change, Crossing, Hold, Relative, Side};
use crate::error::EngineError;
use crate::search::guards;
use crate::system::{Contact, EventKind, Face, Law, Particle};

/// Rigid faces closer to each other than this share of their way have met.
const CLOSED: f64 = 1e-9;

impl<E: Effects> March<'_, E> {
    /// What a crossing leads to; the state has arrived there.
    pub(super) fn cross(&mut self, j: usize, crossing: Crossing) -> Result<(), EngineError> {
        if E::ALL {
            if crossing == Crossing::HalfCycle {
                if std::mem::replace(&mut self.half.stage, Stage::Begins) == Stage::ThrownBack {
                    return Ok(());
                }
                self.half.sign = -self.half.sign;
                self.close_half_cycle();
                return self.hold_on();
            }
            self.half.jumps();
            if self.contacts[j].is_between() || matches!(crossing, Crossing::Across(_)) {
                self.smooth[j] = false;
                return self.cross_between(j, crossing);
            }
        }
        self.smooth[j] = false;
        let side = self.contacts[j].side();
        let particle = &self.system.particles[j];
        // The push of a dashpot sets in at once, and with it accelerations elsewhere jump.
        let mut jumps = false;
        match crossing {
            // A particle that a rounding has put behind a face which it is leaving has not met it.
            Crossing::To(Side::Floor) => {
                self.particles[j].gap = 0.0;
                if self.particles[j].rate < 0.0 {
                    match particle.floor.law {
                        Law::Rigid { .. } => return self.strike(j, Side::Floor),
                        Law::Resilient { .. } => self.press(j, Side::Floor),
                    }
                    jumps = true;
                }
            }
            Crossing::To(Side::Ceiling) => {
                if let (Some(ceiling), Some(above)) = (&particle.ceiling, self.referred(j, Side::Ceiling)) {
                    match ceiling.law {
                        _ if !(above.rate > 0.0) => {
                            self.particles[j] = Relative { gap: 0.0, rate: above.rate };
                            self.refer_to_floor(j);
                        }
                        Law::Rigid { .. } => return self.strike(j, Side::Ceiling),
                        Law::Resilient { .. } => {
                            self.press(j, Side::Ceiling);
                            jumps = true;
                        }
                    }
                }
            }
            Crossing::Own(Change::Stops) => {
                if let Some(stop) = side.face(particle).law.stop() {
                    self.particles[j].gap = -side.away() * stop.length;
                    return self.strike(j, side);
                }
            }
            Crossing::Own(Change::Releases) if E::ALL && self.contacts[j].holds(particle) => {
                if self.sudden {
                    return self.hold_on();
                }
                self.particles[j].rate = 0.0;
                self.let_go(j, side);
                self.smooth[j] = true;
            }
            Crossing::Own(Change::Releases) => match side.face(particle).law {
                Law::Resilient { no_tension: true, .. } if E::ALL && self.is_compressed(j, side) => {
                    self.slip_smoothly(j, side)?;
                }
                _ => {
                    // It leaves, or is at rest; what rounding has left of an approach would bring it back at once.
                    let rate = self.particles[j].rate;
                    let leaves = side.away() * rate > 0.0;
                    self.particles[j] = Relative { gap: 0.0, rate: if leaves { rate } else { 0.0 } };
                    self.let_go(j, side);
                    jumps = true;
                }
            },
            Crossing::Own(Change::Recovers) => {
                self.particles[j].gap = 0.0;
                self.changed = true;
                self.contacts[j] = Contact::Flight;
                if side == Side::Ceiling {
                    self.refer_to_floor(j);
                }
            }
            Crossing::Own(Change::PushesAgain) => self.slip_smoothly(j, side)?,
            Crossing::Own(Change::Meets) | Crossing::Across(_) | Crossing::HalfCycle => {}
        }
        if E::ALL {
            self.meet_at_once()?;
        } else if let Some(side) = self.meets(j) {
            // No velocity has jumped: no other particle is at a face now that was not before.
            self.press(j, side);
        }
        if jumps { self.hold_on() } else { self.choose_flow() }
    }

    /// Why the contact does not settle: two rigid faces that move by themselves and have met, or nobody knows.
    #[cold]
    pub(super) fn no_progress(&self) -> EngineError {
        let (cycle, time) = (self.cycle, self.time);
        match self.squeezed() {
            Some(particle) => EngineError::Squeezed { particle, cycle, time },
            None => EngineError::NoProgress { cycle, time },
        }
    }

    /// A particle whose faces, rigid or on their stops, move by themselves and have met.
    #[cold]
    pub(super) fn squeezed(&self) -> Option<usize> {
        let between = |j: &usize| {
            let particle = &self.system.particles[*j];
            let yields = |face: &Face| matches!(face.law, Law::Resilient { stop: None, .. });
            particle.has_walls()
                && !yields(&particle.floor)
                && particle.ceiling.as_ref().is_some_and(|ceiling| {
                    let rows = || ceiling.row.iter().zip(&particle.floor.row).zip(&self.q);
                    let rest =
                        particle.gap + [&particle.floor, ceiling].iter().map(|face| face.law.depth()).sum::<f64>();
                    let way = rows().fold(rest, |sum, ((above, below), q)| sum + (above - below) * q);
                    let size =
                        rows().fold(rest, |sum, ((above, below), q)| sum + (above * q).abs() + (below * q).abs());
                    !yields(ceiling) && way <= CLOSED * size
                })
        };
        (0..self.particles.len()).find(between)
    }

    /// A particle in flight that is at a face and moves into it has met it: where there is no gap to cross.
    pub(super) fn meet_at_once(&mut self) -> Result<(), EngineError> {
        let mut arrived = Few::new();
        for j in 0..self.particles.len() {
            if let Some(side) = self.meets(j) {
                match side.face(&self.system.particles[j]).law {
                    Law::Rigid { .. } => arrived.push((j, side)),
                    Law::Resilient { .. } => self.press(j, side),
                }
            }
        }
        if arrived.is_empty() { Ok(()) } else { self.settle(&arrived) }
    }

    /// The face that a particle in flight is at and moves into.
    fn meets(&self, j: usize) -> Option<Side> {
        if self.contacts[j] != Contact::Flight {
            return None;
        }
        let floor = self.particles[j];
        if floor.gap == 0.0 && floor.rate < 0.0 {
            return Some(Side::Floor);
        }
        self.referred(j, Side::Ceiling).filter(|above| above.gap == 0.0 && above.rate > 0.0).map(|_| Side::Ceiling)
    }

    /// A particle in flight presses into a resilient face from now on; at a ceiling its state refers to that.
    fn press(&mut self, j: usize, side: Side) {
        let above = if side == Side::Ceiling { self.referred(j, Side::Ceiling) } else { None };
        let rate = above.unwrap_or(self.particles[j]).rate;
        self.particles[j] = Relative { gap: 0.0, rate };
        self.changed = true;
        self.contacts[j] = side.pressed();
        // It comes with a speed, however smoothly the other face has just let go of it.
        if E::ALL {
            self.smooth[j] = false;
        }
        self.record(j, side.made(), rate, rate);
    }

    /// After a jump of velocities: decides the contact of a particle with a resilient face, as far as velocities do.
    pub(super) fn press_or_part(&mut self, j: usize) -> Result<(), EngineError> {
        let contact = self.contacts[j];
        if E::ALL && contact.is_between() {
            return self.press_or_part_between(j);
        }
        let particle = &self.system.particles[j];
        let side = contact.side();
        let Relative { gap, rate } = self.particles[j];
        let away = side.away();
        match (contact, side.face(particle).law) {
            (Contact::Flight, _) => {
                if let Some(side) = self.meets(j)
                    && let Law::Resilient { .. } = side.face(particle).law
                {
                    self.press(j, side);
                }
            }
            (_, Law::Resilient { stiffness, no_tension, .. }) if contact.presses(particle) => {
                if gap == 0.0 && away * rate > 0.0 {
                    self.let_go(j, side);
                } else if E::ALL && no_tension && -away * (stiffness * gap + self.damping_at(j) * rate) < 0.0 {
                    if self.is_compressed(j, side) {
                        self.slip(j, side)?;
                    } else {
                        self.particles[j].gap = 0.0;
                        self.let_go(j, side);
                    }
                }
            }
            (Contact::FloorReleased | Contact::CeilingReleased, Law::Resilient { stiffness, .. })
                if -away * (stiffness * gap + self.damping_at(j) * rate) > 0.0 =>
            {
                self.slip(j, side)?;
            }
            _ => {}
        }
        Ok(())
    }

    /// A particle that lies at a resilient face without moving against it: what brings it there keeps it there.
    pub(super) fn rest(&mut self, j: usize) -> Result<(), EngineError> {
        let particle = &self.system.particles[j];
        let contact = self.contacts[j];
        let here = self.particles[j];
        let at_rest = |relative: Relative| relative == Relative::default();
        let pressed = contact.presses(particle);
        let side = match contact {
            Contact::Flight if at_rest(here) => Side::Floor,
            Contact::Flight if self.referred(j, Side::Ceiling).is_some_and(at_rest) => Side::Ceiling,
            _ if pressed && at_rest(here) && !contact.is_between() => contact.side(),
            _ => return Ok(()),
        };
        if let Law::Rigid { .. } = side.face(particle).law {
            return Ok(());
        }
        self.changed = true;
        self.contacts[j] = Contact::Flight;
        self.choose_flow()?;
        self.enter_now();
        let grip = self.grip(j, side, false);
        self.smooth[j] = grip.is_nothing();
        self.particles[j] = Relative::default();
        if grip.holds() {
            self.changed = true;
            self.contacts[j] = side.pressed();
        } else if pressed {
            self.let_go(j, side);
        } else if particle.has_no_gap() {
            self.changed = true;
            self.contacts[j] = side.opposite().pressed();
        } else if side == Side::Ceiling {
            self.refer_to_floor(j);
        }
        Ok(())
    }

    /// The face at which a particle in flight lies without moving against it, as far as its places are known there.
    pub(super) fn lies_at(&self, j: usize) -> Option<Side> {
        if self.particles[j] == Relative::default() {
            return Some(Side::Floor);
        }
        let particle = &self.system.particles[j];
        let structure = self.moves_by_itself(particle).then_some([self.q.as_slice(), self.rate.as_slice()]);
        let above = guards::above(particle, self.particles[j], structure)?;
        (above == Relative::default()).then_some(Side::Ceiling)
    }

    /// Refers a particle that leaves the ceiling to the floor again.
    pub(super) fn refer_to_floor(&mut self, j: usize) {
        if let Some(here) = self.referred(j, Side::Floor) {
            self.particles[j] = here;
        }
    }

    /// Position relative to the face on this side, for a particle whose state refers to the other one.
    pub(super) fn referred(&self, j: usize, to: Side) -> Option<Relative> {
        let particle = &self.system.particles[j];
        particle.ceiling.as_ref()?;
        let here = self.particles[j];
        if self.moves_by_itself(particle) {
            return Some(guards::seen_from(to, particle, here, &self.q, &self.rate));
        }
        Some(Relative { gap: here.gap + to.away() * particle.gap, ..here })
    }

    /// The ceiling of a particle does not move with its floor.
    fn moves_by_itself(&self, particle: &Particle) -> bool {
        self.has_walls() && particle.has_walls()
    }

    /// The face that a particle presses into is compressed by more than rounding.
    pub(super) fn is_compressed(&self, j: usize, side: Side) -> bool {
        let here = self.relative_to(j, side);
        here.gap != 0.0 && here.gap.abs() > self.noise(j, side, here)
    }

    /// A face loses its particle.
    pub(super) fn let_go(&mut self, j: usize, side: Side) {
        let rate = self.particles[j].rate;
        let stopped = self.is_on_stop(j, side);
        self.record(j, if stopped { EventKind::StopRelease } else { side.lost() }, rate, rate);
        self.part(j, side, stopped);
    }

    /// Puts a particle off a rigid face or a stop, without an event.
    pub(super) fn part(&mut self, j: usize, side: Side, from_stop: bool) {
        self.changed = true;
        if self.touches_across(j, side) {
            let hold = if from_stop { Hold::Pressed } else { Hold::Away };
            // A face that lets go leaves the other one alone.
            let _always = self.turn(j, side, hold);
            return;
        }
        if E::ALL && from_stop {
            self.contacts[j] = side.pressed();
            return;
        }
        let particle = &self.system.particles[j];
        if particle.has_no_gap() && self.particles[j] == Relative::default() {
            // It goes from face to face.
            self.contacts[j] = side.opposite().pressed();
            self.record(j, side.opposite().made(), 0.0, 0.0);
            return;
        }
        self.contacts[j] = Contact::Flight;
        if side == Side::Ceiling {
            self.refer_to_floor(j);
        }
    }
}
