//! Equivalent viscous damping: the half cycles of the base acceleration, each of which sets the next one's dashpots.
//!
//! A half cycle ends where the acceleration a changes its sign. There the dashpot of a particle that is pressed changes by Δc, and a
//! jumps by Δc u′/m: half of the time back over zero. What then crosses zero a moment later is the same half cycle, which has begun
//! late; taken for one of its own it would have next to no RMS, and set the dashpots to the curve's lower end.

use super::March;
use super::effects::Effects;
use super::sums::Integration;
use crate::arithmetic::four::Four;
use crate::error::EngineError;
use crate::flow::Flow;

/// An acceleration below this share of what it may become is zero: the crossing that ended the half cycle was smooth.
const SMOOTH: f64 = 1e-9;
/// Share of a place that rounding may have moved it by.
const ROUNDING: f64 = 16.0 * f64::EPSILON;
/// An acceleration that stays at or below so many times its rounding has died away; so has one that is nothing.
const DIED_AWAY: f64 = 64.0;
/// A segment in which no block turns by more than this is short.
const SHORT: f64 = 0.5;

/// Bookkeeping of the equivalent viscous damping.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Half {
    /// Sign of the acceleration in the half cycle; 0 before the first.
    pub(super) sign: f64,
    /// ∫ a² dt so far.
    pub(super) square: f64,
    /// Its length so far, s.
    pub(super) length: f64,
    /// RMS of the last complete one, m/s².
    pub(super) last: f64,
    pub(super) stage: Stage,
    /// Too weak to be told from rounding: not followed.
    pub(super) idle: bool,
}

/// How far a half cycle has come.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub(super) enum Stage {
    /// Under way, or there is none yet.
    #[default]
    UnderWay,
    /// It begins: the acceleration is zero.
    Begins,
    /// The damping that it began with has thrown the acceleration back over zero: its sign is still the one before.
    ThrownBack,
    /// After that something else has made the acceleration jump: it is of the sign that this leaves.
    Open,
}

impl Half {
    /// A contact, an impulse or the force makes the acceleration jump.
    pub(super) fn jumps(&mut self) {
        self.stage = match self.stage {
            Stage::UnderWay | Stage::Begins => Stage::UnderWay,
            Stage::ThrownBack | Stage::Open => Stage::Open,
        };
    }

    /// The sign of the acceleration until its next crossing.
    pub(super) fn sign_so_far(&self) -> f64 {
        if self.stage == Stage::ThrownBack { -self.sign } else { self.sign }
    }
}

impl<E: Effects> March<'_, E> {
    /// Starts the first half cycle, and ends one whose acceleration a contact has turned at once.
    pub(super) fn turn_half_cycle(&mut self) -> Result<(), EngineError> {
        let Some(half_cycles) = &self.system.drive.half_cycles else { return Ok(()) };
        let flow = &self.flow;
        let Some(bend) = flow.rows.bend else { return Ok(()) };
        let bends = self.signals.of(bend);
        let bound = if flow.bank.near_critical.is_empty() {
            let each = flow.bank.blocks.iter().zip(bends.phases);
            each.fold(Four::ZERO, |sum, (blocks, phases)| sum + blocks.amplitudes(*phases)).sum()
        } else {
            let each = flow.blocks.iter().zip(bends.each());
            each.fold(0.0, |sum, (block, phase)| sum + block.amplitude(phase, 0.0, self.system.drive.period))
        };
        let places = self.q.iter().zip(&flow.rows.bend_of_places);
        let rounding = ROUNDING * places.fold(0.0, |sum, (place, answer)| sum + place.abs() * answer);
        if bound <= DIED_AWAY * rounding {
            let [_, damping] = half_cycles.curve.lower_end();
            self.half = Half { idle: true, last: self.half.last, ..Half::default() };
            if self.equivalent != Some(damping) {
                self.equivalent = Some(damping);
                self.changed = true;
                self.renew()?;
            }
            return Ok(());
        }
        self.half.idle = false;
        let total = bends.sum.value;
        let rate = bends.sum.rate;
        let smooth = total.abs() <= SMOOTH * bound + rounding;
        if self.half.sign == 0.0 {
            // From rest the first half cycle goes where the acceleration is about to go.
            self.half.stage = if smooth { Stage::Begins } else { Stage::UnderWay };
            let first = if smooth { rate } else { total };
            self.half.sign = if first < 0.0 { -1.0 } else { 1.0 };
        }
        if self.half.stage == Stage::Begins && smooth {
            if rate * self.half.sign < 0.0 {
                // The new damping turns the acceleration back before it has got anywhere.
                self.half.sign = -self.half.sign;
            }
            return Ok(());
        }
        let against = total * self.half.sign < 0.0;
        match std::mem::take(&mut self.half.stage) {
            _ if !against => return Ok(()),
            Stage::UnderWay => {}
            // By a jump that the renewal itself has made: no half cycle is over, and none is to be that short.
            Stage::Begins | Stage::ThrownBack => {
                self.half.stage = Stage::ThrownBack;
                return Ok(());
            }
            Stage::Open => {
                self.half.sign = -self.half.sign;
                return Ok(());
            }
        }
        self.half.sign = -self.half.sign;
        self.close_half_cycle();
        self.renew()?;
        if self.signals.of(bend).sum.value * self.half.sign < 0.0 {
            self.half.stage = Stage::ThrownBack;
        }
        Ok(())
    }

    /// Goes on with the damping now in force.
    fn renew(&mut self) -> Result<(), EngineError> {
        self.hold_on()?;
        let drive = self.drive_phase(self.time);
        self.enter_flow(drive);
        self.flow.rows.watch(&self.c, self.level, self.flow.blocks.len(), &mut self.signals);
        Ok(())
    }

    /// How a segment's part in the half cycle that is followed is integrated: over a short one the shares of the acceleration may
    /// cancel all along.
    pub(super) fn half_cycle_integration(&self, length: f64) -> Option<Integration> {
        if self.flow.rows.bend.is_none() || self.half.idle {
            return None;
        }
        let is_short = self.flow.turns_below(SHORT, length);
        Some(if is_short { Integration::Panels } else { self.integration_of_one() })
    }

    /// Adds a segment to the half cycle.
    pub(super) fn sum_up_half_cycle(&mut self, integration: Integration, length: f64) {
        let Flow { blocks, bank, rows, .. } = &*self.flow;
        let Some(bend) = rows.bend else { return };
        let bend = self.signals.of(bend);
        self.half.length += length;
        self.half.square += if integration == Integration::Pairs {
            self.pairs.square(bank, bend.phases)
        } else {
            self.panels.square(blocks, bend.each())
        };
    }

    /// The RMS of a finished half cycle sets the damping of the next.
    pub(super) fn close_half_cycle(&mut self) {
        let Some(half_cycles) = &self.system.drive.half_cycles else { return };
        if self.half.length > 0.0 {
            self.half.last = (self.half.square / self.half.length).sqrt();
            let value = half_cycles.curve.at(self.half.last);
            self.equivalent = Some(value);
            self.changed = true;
        }
        self.half.square = 0.0;
        self.half.length = 0.0;
    }
}
