//! A segment: the flow of the contact state in force, followed to the next event or to the next jump of the force.

use std::rc::Rc;

use super::March;
use super::effects::Effects;
use super::half_cycles::Stage;
use crate::arithmetic::wide::widened;
use crate::budget;
use crate::contact::{Change, Crossing, Relative, Side};
use crate::contact_state::{contact_damping, feels_half_cycles};
use crate::error::EngineError;
use crate::flow::way::{BESIDE, Left};
use crate::search::guards::{self, Contacts};
use crate::search::{Found, Guard};
use crate::system::{DrivePhase, Law};

/// Events at one instant beyond which contacts are left alone for a moment, as they undo each other.
const MOST_EVENTS_AT_AN_INSTANT: u32 = 64;

/// The same within a moment, in periods, so short that its events may be rounding: a structure that is just set in motion hardly
/// moves, and each event rounds its coordinates anew.
const MOST_EVENTS_IN_A_MOMENT: u32 = 256;
const MOMENT: f64 = 1e-12;

/// The longest time, in periods, for which contacts that do not settle are left alone: a force that begins at zero moves a structure
/// at rest by t³, which is rounding for the longer the larger the places are.
const LONGEST_BLINK: f64 = 1e-6;

/// The time to the next event, in periods, after which contacts have settled: the next time they do not, they are left alone for as
/// short as at first.
const SETTLED: f64 = 1e-9;

/// Events after which the rounding of the changes of state adds up to more than all other rounding.
const MANY_EVENTS: u64 = 10_000;

/// radius·t below which t³ is rounding.
const CUBE_IS_NOTHING: f64 = 5e-6;

impl<E: Effects> March<'_, E> {
    /// Damping of the face that particle j's contact refers to, N s/m.
    pub(super) fn damping_at(&self, j: usize) -> f64 {
        contact_damping(self.system, &self.contacts, j, self.equivalent)
    }

    /// Makes the flow of the contact state in force current, building it at the first visit.
    pub(super) fn choose_flow(&mut self) -> Result<(), EngineError> {
        if !self.changed {
            return Ok(());
        }
        self.changed = false;
        self.flow = match self.states.at_hand(&self.contacts, self.equivalent) {
            Some(known) => known,
            None => self.states.flow(self.system, &self.contacts, self.equivalent)?,
        };
        self.is_brief = self.flow.is_brief(self.pause);
        self.is_passing = E::ALL && self.equivalent.is_some() && feels_half_cycles(self.system, &self.contacts);
        let width = self.flow.width() + BESIDE;
        if self.c.len() < width {
            self.c.resize(width, 0.0);
            self.c_end.resize(width, 0.0);
        }
        let highest = &mut self.response.highest_frequency;
        *highest = highest.max(self.flow.highest_frequency);
        Ok(())
    }

    /// Block coordinates of the state in the flow in force.
    #[inline(always)]
    pub(super) fn enter_flow(&mut self, drive: DrivePhase) {
        let flow = &self.flow;
        if let Some(left) = self.left.take() {
            if flow.has_ways {
                let here = self.particles[left.particle];
                let new = flow.enter_from(&left, &mut self.c_end, self.level, here, &mut self.c);
                if new > 0 {
                    self.states.keep(new);
                }
                return;
            }
            self.leave(&left);
        }
        let (flow, n) = (&self.flow, self.system.mass.order);
        for (i, &j) in flow.modes.attached.iter().enumerate() {
            self.q[n + i] = self.particles[j].gap;
            self.rate[n + i] = self.particles[j].rate;
        }
        let (p, rate) = (&self.q[..flow.order], &self.rate[..flow.order]);
        flow.enter(p, rate, self.level, drive, &mut self.work, &mut self.c);
        self.c[2 * flow.blocks.len()..flow.width()].fill(0.0);
        if self.is_undamped() {
            flow.enter_doubled([p, rate], self.level, drive, &mut self.c, &mut self.doubled.low);
        } else if self.response.proof.events >= MANY_EVENTS {
            flow.correct(&mut self.work, &mut self.c);
        }
    }

    widened! {
        /// Propagates to `until` within the cycle, from event to event.
        pub(super) fn propagate_to | propagate_wide (&mut self, until: f64) -> Result<(), EngineError> = propagate
    }

    #[inline(always)]
    fn propagate(&mut self, until: f64) -> Result<(), EngineError> {
        // Near the start of a cycle the clock counts finer than its instants can be told apart later.
        let instant = f64::EPSILON * self.system.drive.period;
        let longest = LONGEST_BLINK * self.system.drive.period;
        let settled = SETTLED * self.system.drive.period;
        let moment = MOMENT * self.system.drive.period;
        let (mut stuck, mut flickers, mut blink) = (0, 0, instant);
        let (mut last, mut begun) = (self.time, self.time);
        while self.time < until {
            self.set_guards()?;
            self.follow(until)?;
            if budget::spend(1) {
                return Err(budget::overrun().into());
            }
            if self.time > last + instant {
                blink = if self.time > last + settled { instant } else { blink };
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
        self.come_out();
        Ok(())
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

    #[inline(always)]
    fn set_guards(&mut self) -> Result<(), EngineError> {
        self.choose_flow()?;
        let drive = self.drive_phase(self.time);
        self.enter_flow(drive);
        self.flow.rows.watch_by_registers(&self.c, self.level, self.flow.blocks.len(), &mut self.signals);
        if E::ALL {
            self.turn_half_cycle()?;
        }
        let flow = &self.flow;
        let state = Contacts {
            system: self.system,
            flow,
            signals: &self.signals,
            contacts: &self.contacts,
            particles: &self.particles,
            smooth: &self.smooth,
            slipped: self.slipped,
            q: &self.q,
            rate: &self.rate,
            has_walls: self.has_walls(),
            plain: !E::ALL,
        };
        guards::set(state, &mut self.search, &mut self.paths);
        if E::ALL
            && let (Some(bend), false) = (flow.rows.bend, self.half.idle)
        {
            let begins = self.half.stage == Stage::Begins;
            self.search.guards.push(Guard::half_cycle(bend, self.half.sign_so_far(), begins));
        }
        Ok(())
    }

    /// Follows the flow to the first of the guards that are set.
    #[inline(always)]
    fn follow(&mut self, until: f64) -> Result<(), EngineError> {
        let (flow, drive) = (&self.flow, self.phase);
        let limit = (until - self.time).min(flow.modes.spectral.lasts);
        let found = self.search.run(flow, &self.signals, limit, &mut self.clarity);
        let length = match found {
            Found::Nothing => limit,
            Found::Event { time, .. } => time.min(limit),
        };
        let end_drive = match self.system.drive.harmonic {
            None => drive,
            Some(_) => self.drive_phase(self.time + length),
        };
        self.flow.advance_all(&self.search.kernels, &self.c, end_drive, &mut self.c_end);
        self.sum_up(length, drive);
        if E::TAPED {
            self.tape.flow(&self.flow, length);
        }
        if let Some(request) = self.options.trace {
            self.sample(request, length, drive);
        }
        if self.is_undamped() {
            self.arrive_doubled(length, end_drive, found);
        } else {
            self.arrive(length, end_drive, self.goes_straight(length, found));
        }
        self.time = match found {
            Found::Nothing if limit < until - self.time => self.time + limit,
            Found::Nothing => until,
            Found::Event { .. } => self.time + length,
        };
        if let Found::Event { guard, .. } = found {
            let Guard { particle, crossing, .. } = self.search.guards[guard];
            self.sudden = length == 0.0;
            if E::TAPED {
                self.cross_taped(particle, crossing)?;
            } else {
                self.cross(particle, crossing)?;
            }
        }
        Ok(())
    }

    /// The particle whose event ends a segment, if the next flow can be entered from the block coordinates of this one: nothing but the
    /// contact of that particle with a resilient face changes, and rounding does not have to be taken off.
    #[inline(always)]
    fn goes_straight(&self, length: f64, found: Found) -> Option<usize> {
        let Found::Event { guard, .. } = found else { return None };
        let able = self.has_ways && self.flow.has_ways && !self.flow.turns_below(guards::SHORT, length);
        let able = able && self.response.proof.events < MANY_EVENTS;
        let Guard { particle: j, crossing, .. } = self.search.guards[guard];
        (able && (!E::ALL || self.presses_or_parts(j, crossing))).then_some(j)
    }

    /// A crossing at which a particle meets a resilient face, or leaves one that can pull.
    fn presses_or_parts(&self, j: usize, crossing: Crossing) -> bool {
        let particle = &self.system.particles[j];
        let law = |side: Side| side.face(particle).law;
        match crossing {
            Crossing::To(side) => !law(side).is_rigid(),
            Crossing::Own(Change::Releases) => {
                let pulls = matches!(law(self.contacts[j].side()), Law::Resilient { no_tension: false, .. });
                pulls && !self.contacts[j].holds(particle)
            }
            Crossing::Own(_) | Crossing::Across(_) | Crossing::HalfCycle => false,
        }
    }

    /// The structure after all, where no way leads on: more than the contact of one particle is about to change, or the run pauses.
    #[inline(always)]
    pub(super) fn come_out(&mut self) {
        if let Some(left) = self.left.take() {
            self.leave(&left);
        }
    }

    #[cold]
    fn leave(&mut self, Left { flow, .. }: &Left) {
        let drive = self.drive_phase(self.time);
        flow.leave(&self.c_end, 0.0, self.level, drive, &mut self.work, [&mut self.q, &mut self.rate]);
    }

    /// The state at the end of a segment; only that of the particles, where the flow is left by a way for the event of the `straight` one.
    #[inline(always)]
    pub(super) fn arrive(&mut self, length: f64, end_drive: DrivePhase, straight: Option<usize>) {
        let n = self.system.mass.order;
        let flow = &self.flow;
        let mut kept = Vec::new();
        if self.has_walls() && length > self.nothing {
            self.slipped = None;
        }
        for (j, particle) in self.system.particles.iter().enumerate() {
            let contact = self.contacts[j];
            if contact.face(particle).is_none() {
                if self.smooth[j]
                    && flow.turns_below(CUBE_IS_NOTHING, length)
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
        if let Some(particle) = straight {
            for &j in &flow.modes.attached {
                let row = flow.rows.row(flow.rows.guards[j].first);
                let (share, rest) = (row.shares(&self.c_end), row.rest(self.level));
                self.particles[j] = Relative { gap: rest.p0 + share.value, rate: rest.p1 + share.rate };
            }
            self.left = Some(Left { flow: Rc::clone(flow), particle });
            if !E::TAPED {
                return;
            }
        }
        flow.leave(&self.c_end, length, self.level, end_drive, &mut self.work, [&mut self.q, &mut self.rate]);
        if straight.is_some() {
            return;
        }
        for (j, side) in kept {
            self.particles[j] = Relative::default();
            if side == Side::Ceiling {
                self.refer_to_floor(j);
            }
        }
        let flow = &self.flow;
        let short = flow.turns_below(guards::SHORT, length);
        for (i, &j) in flow.modes.attached.iter().enumerate() {
            self.particles[j] = match flow.rows.guards[j].compression {
                Some(_) if short => {
                    let own = self.signals.of(flow.rows.guards[j].first);
                    guards::creep(flow, 2.0 * own.rest.p2, 1.0, own, self.particles[j], length)
                }
                _ => Relative { gap: self.q[n + i], rate: self.rate[n + i] },
            };
        }
    }
}
