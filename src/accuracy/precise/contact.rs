//! What ends a phase, and what follows.

use super::double::Double;
use super::matrix::{Square, dot};
use super::run::{End, PreciseError, Run};
use super::series::{Series, TERMS, Touch, along, away, doubles};
use crate::dynamics::{Event, EventKind, Face, Law};

impl Run<'_> {
    /// u = y − φ·q − offset.
    fn gap(&self, series: &Series, j: usize, face: &Face, offset: f64) -> Vec<Double> {
        let face = along(&face.row, &series.q);
        let mut u: Vec<Double> = series.y[j].iter().zip(face).map(|(y, x)| *y - x).collect();
        u[0] = u[0] - Double::from(offset);
        u
    }

    /// What ends the phase of a particle, positive as long as it does not.
    pub(super) fn guards(&self, series: &Series, j: usize) -> Vec<(End, Vec<Double>)> {
        let particle = &self.system.particles[j];
        // A coordinate that has just been zero is positive or negative by its first derivative that is not.
        let guard = |ceiling: bool, stop: bool, sign: f64, mut terms: Vec<Double>| {
            let order = match self.fresh[j] {
                Some((side, from_stop, order)) if side == ceiling && from_stop == stop => order,
                _ => 0,
            };
            terms.drain(..order);
            terms.iter_mut().for_each(|term| *term = *term * sign);
            terms
        };
        let touch = self.touches[j];
        let mut guards = Vec::new();
        match touch {
            Touch::Flight => {
                guards.push((End::Meets(false), guard(false, false, 1.0, self.gap(series, j, &particle.floor, 0.0))));
                if let Some(ceiling) = &particle.ceiling {
                    let w = self.gap(series, j, ceiling, particle.gap);
                    guards.push((End::Meets(true), guard(true, false, -1.0, w)));
                }
            }
            Touch::Pressed(side) => {
                let Some((face, offset)) = touch.face(self.system, j) else { return guards };
                let u = self.gap(series, j, face, offset);
                guards.push((End::Leaves, guard(side, false, -away(side), u.clone())));
                if let Some(stop) = face.law.stop() {
                    let mut deep = u;
                    deep[0] += Double::from(away(side) * stop.length);
                    guards.push((End::HitsStop, guard(side, true, away(side), deep)));
                }
            }
            Touch::Held(side) | Touch::Stopped(side) => {
                let mut push: Vec<Double> = (0..TERMS - 2)
                    .map(|k| series.y[j][k + 2] * ((k + 1) as f64) * ((k + 2) as f64) * (particle.mass * away(side)))
                    .collect();
                push[0] += Double::from(particle.mass) * self.system.gravity * away(side);
                if let (
                    Touch::Stopped(_),
                    Some((Face { law: Law::Resilient { stiffness, stop: Some(stop), .. }, .. }, _)),
                ) = (touch, touch.face(self.system, j))
                {
                    push[0] = push[0] - Double::from(*stiffness) * stop.length;
                }
                guards.push((End::LetGo, push));
            }
        }
        // Faces that do not move as one may close on the particle.
        if let (Touch::Pressed(side) | Touch::Held(side) | Touch::Stopped(side), Some(ceiling)) =
            (touch, &particle.ceiling)
            && ceiling.row != particle.floor.row
        {
            let across = if side {
                self.gap(series, j, &particle.floor, 0.0)
            } else {
                self.gap(series, j, ceiling, particle.gap).iter().map(|w| -*w).collect()
            };
            guards.push((End::Squeezed, across));
        }
        guards
    }

    pub(super) fn cross(&mut self, j: usize, end: End) -> Result<(), PreciseError> {
        self.phase = None;
        // What is let go when its push vanishes by itself begins with t³, after a jump with t².
        let let_go = if self.goes_on { 3 } else { 2 };
        self.goes_on &= matches!(end, End::LetGo);
        match (end, self.touches[j]) {
            (End::Squeezed, _) => return Err(PreciseError::Squeezed { particle: j, cycle: self.cycle }),
            (End::Meets(ceiling), _) => {
                let particle = &self.system.particles[j];
                let face = if ceiling { particle.ceiling.as_ref().unwrap_or(&particle.floor) } else { &particle.floor };
                let approach = self.relative(j, face);
                self.fresh[j] = Some((ceiling, false, 1));
                self.touches[j] = match face.law {
                    Law::Resilient { .. } => Touch::Pressed(ceiling),
                    Law::Rigid { .. } => {
                        self.collide(j, face, 0.0)?;
                        self.struck = Some(j);
                        Touch::Held(ceiling)
                    }
                };
                let departure = self.relative(j, face);
                self.record(j, met(ceiling, false), approach, departure);
            }
            (End::Leaves, Touch::Pressed(ceiling)) => self.leave(j, ceiling, 1),
            (End::HitsStop, touch @ Touch::Pressed(ceiling)) => {
                let Some((face, _)) = touch.face(self.system, j) else { return Ok(()) };
                let restitution = face.law.stop().map_or(0.0, |stop| stop.restitution);
                let approach = self.relative(j, face);
                self.collide(j, face, restitution)?;
                if restitution == 0.0 {
                    self.struck = Some(j);
                    self.touches[j] = Touch::Stopped(ceiling);
                } else {
                    self.fresh[j] = Some((ceiling, true, 1));
                }
                let departure = self.relative(j, face);
                self.record(j, met(ceiling, true), approach, departure);
            }
            // A face that cannot hold what strikes it has been struck and no more.
            (End::LetGo, Touch::Held(ceiling)) if self.struck == Some(j) => {
                self.touches[j] = Touch::Flight;
                self.fresh[j] = Some((ceiling, false, 2));
            }
            (End::LetGo, Touch::Stopped(ceiling)) if self.struck == Some(j) => {
                self.touches[j] = Touch::Pressed(ceiling);
                self.fresh[j] = Some((ceiling, true, 2));
            }
            (End::LetGo, Touch::Held(ceiling)) => self.leave(j, ceiling, let_go),
            (End::LetGo, Touch::Stopped(ceiling)) => {
                self.touches[j] = Touch::Pressed(ceiling);
                self.fresh[j] = Some((ceiling, true, let_go));
                self.record(j, EventKind::StopRelease, 0.0, 0.0);
            }
            _ => {}
        }
        Ok(())
    }

    /// A face lets go; the gap coordinate is zero up to that order.
    fn leave(&mut self, j: usize, ceiling: bool, order: usize) {
        let speed = self.touches[j].face(self.system, j).map_or(0.0, |(face, _)| self.relative(j, face));
        self.touches[j] = Touch::Flight;
        self.fresh[j] = Some((ceiling, false, order));
        self.record(j, if ceiling { EventKind::CeilingRelease } else { EventKind::FloorRelease }, speed, speed);
    }

    fn relative(&self, j: usize, face: &Face) -> f64 {
        (self.state.w[j] - dot(&face.row, &self.state.v)).near()
    }

    /// An impact with the structure.
    fn collide(&mut self, j: usize, face: &Face, restitution: f64) -> Result<(), PreciseError> {
        let answer =
            Square::of(&self.system.mass).solve(&[doubles(&face.row)]).ok_or(PreciseError::Singular)?.remove(0);
        let particle = Double::from(1.0) / Double::from(self.system.particles[j].mass);
        let speed = self.state.w[j] - dot(&face.row, &self.state.v);
        let impulse = -(speed * (1.0 + restitution)) / (particle + dot(&face.row, &answer));
        self.state.w[j] += impulse * particle;
        self.state.v.iter_mut().zip(&answer).for_each(|(v, by)| *v = *v - *by * impulse);
        Ok(())
    }

    /// An impulse on the structure: what rests on a rigid face is struck by it, or left behind.
    pub(super) fn strike(&mut self, impulse: f64) -> Result<(), PreciseError> {
        let row = doubles(&self.system.force_row);
        let answer = Square::of(&self.system.mass).solve(&[row]).ok_or(PreciseError::Singular)?.remove(0);
        self.state.v.iter_mut().zip(&answer).for_each(|(v, by)| *v += *by * impulse);
        let Some(j) = self.touches.iter().position(|touch| touch.holds()) else { return Ok(()) };
        let touch = self.touches[j];
        let (Touch::Held(ceiling) | Touch::Stopped(ceiling), Some((face, _))) = (touch, touch.face(self.system, j))
        else {
            return Ok(());
        };
        let stopped = touch == Touch::Stopped(ceiling);
        let speed = self.relative(j, face);
        if away(ceiling) * speed < 0.0 {
            self.collide(j, face, 0.0)?;
            self.struck = Some(j);
            self.record(j, met(ceiling, stopped), speed, 0.0);
        } else if speed != 0.0 {
            self.phase = None;
            if stopped {
                self.touches[j] = Touch::Pressed(ceiling);
                self.fresh[j] = Some((ceiling, true, 1));
                self.record(j, EventKind::StopRelease, speed, speed);
            } else {
                self.leave(j, ceiling, 1);
            }
        }
        Ok(())
    }

    fn record(&mut self, particle: usize, kind: EventKind, approach: f64, departure: f64) {
        self.response.proof.events += 1;
        if self.options.averaged().holds(self.cycle) {
            let counts = &mut self.response.counts;
            match kind {
                EventKind::FloorContact => counts.floor_contacts += 1,
                EventKind::FloorRelease => counts.floor_releases += 1,
                EventKind::CeilingContact => counts.ceiling_contacts += 1,
                EventKind::FloorStop | EventKind::CeilingStop => counts.stops += 1,
                _ => {}
            }
        }
        if self.response.events.len() < self.options.record_events {
            let (cycle, time) = (self.cycle, self.time.near());
            let lasts = kind.is_contact();
            self.response.events.push(Event { cycle, time, particle, kind, approach, departure, lasts });
        }
    }
}

fn met(ceiling: bool, stop: bool) -> EventKind {
    match (ceiling, stop) {
        (false, false) => EventKind::FloorContact,
        (true, false) => EventKind::CeilingContact,
        (false, true) => EventKind::FloorStop,
        (true, true) => EventKind::CeilingStop,
    }
}
