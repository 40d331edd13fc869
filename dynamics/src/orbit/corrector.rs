//! A point of a branch beside another: predicted along the tangent, corrected in the plane across it.
//!
//! Unknowns are the state in units of the motion and the parameter as a share of the range, z = (x, λ). With the tangent t at z₀ and a step s
//!
//! (1 − M) δx − (∂P/∂λ) δλ = P(x, λ) − x,   t·(z + δz − z₀ − s t) = 0

use nalgebra::DMatrix;

use super::OrbitError;
use super::newton::{CLOSED, size};
use super::point::{Along, BranchError};
use super::shot::{Contacts, Shot, state_after};
use crate::arithmetic::elimination::{self, Solved};
use crate::arithmetic::matrix::length;
use crate::motion::End;
use crate::system::HybridSystem;

/// Half the distance of the runs whose difference is ∂P/∂λ, as a share of the range: the largest.
const DIFFERENCE: f64 = 1e-6;
/// The smallest.
const LEAST_DIFFERENCE: f64 = 1e-10;
/// Contacts slower than this share of the motion's speed bend P: it is a function of the square of their speed.
const SLOW: f64 = 0.1;
/// Rounding of a run, in units of the motion: no difference, of a stop that does not move.
const NOISE: f64 = 1e-14;
/// Corrections of a point.
const CORRECTIONS: usize = 12;
/// A correction that has become so small needs no new ∂P/∂λ.
const SETTLED: f64 = 1e-4;
/// A correction below this is rounding.
const EXACT: f64 = 1e-15;
/// A correction no longer shrinks because of rounding, if it is below this.
const ROUNDING: f64 = 1e-11;
/// Share of the step that corrections may come to: more leads to another branch.
const ASIDE: f64 = 0.7;

/// A point of a branch.
pub(super) struct At {
    /// As a share of the range.
    pub(super) share: f64,
    pub(super) shot: Shot,
    /// Newton's last step.
    pub(super) distance: f64,
    /// Of length 1: state in units of the motion, then the share.
    pub(super) tangent: Vec<f64>,
    /// Of [1 − M, −∂P/∂λ; tᵀ]; zero where branches cross.
    pub(super) determinant: f64,
}

impl At {
    /// Its tangent in the units of another point.
    pub(super) fn onwards(&self, other: &Shot) -> Vec<f64> {
        let count = self.tangent.len() - 1;
        let state = (0..count).map(|i| self.tangent[i] * self.shot.scale.unit(i) / other.scale.unit(i));
        state.chain([self.tangent[count]]).collect()
    }

    /// How far another point is along the tangent.
    pub(super) fn ahead(&self, other: &Self) -> f64 {
        let moved = self.shot.scale.miss(&self.shot.start, &other.shot.start).chain([other.share - self.share]);
        moved.zip(&self.tangent).fold(0.0, |sum, (z, t)| sum + z * t)
    }
}

/// What is followed.
pub(super) struct Path<F> {
    pub(super) system_at: F,
    pub(super) cycles: u32,
    /// Of a cycle of the drive, after which the period begins.
    pub(super) late: f64,
    from: f64,
    to: f64,
    /// The parameter of the first point.
    begin: f64,
}

impl<E, F: FnMut(f64) -> Result<HybridSystem, E>> Path<F> {
    /// From the point of a parameter on.
    pub(super) fn new(system_at: F, cycles: u32, along: Along, begin: f64) -> Self {
        Self { system_at, cycles, late: 0.0, from: along.from, to: along.to, begin }
    }

    /// The parameter at a share of the range; its ends and the first point are met to the bit.
    pub(super) fn parameter(&self, share: f64) -> f64 {
        match share {
            1.0 => self.to,
            _ if share == self.first() => self.begin,
            _ => self.from + share * (self.to - self.from),
        }
    }

    /// The share of the range at the first point.
    pub(super) fn first(&self) -> f64 {
        (self.begin - self.from) / (self.to - self.from)
    }

    pub(super) fn system(&mut self, share: f64) -> Result<HybridSystem, BranchError<E>> {
        self.system_late(share, self.late)
    }

    /// Of two neighbours, one has a particle that stays on its face for an instant; that of the other leaves at once.
    pub(super) fn begins_to_stay(&mut self, one: &At, other: &At) -> Result<bool, BranchError<E>> {
        let period = self.system(one.share)?.drive.period;
        Ok(one.shot.brief_stays(period).abs_diff(other.shot.brief_stays(period)) == 1)
    }

    /// The first point.
    pub(super) fn begin(&mut self, shot: Shot, distance: f64) -> Result<At, BranchError<E>> {
        let mut onwards = vec![0.0; shot.miss.len() + 1];
        onwards[shot.miss.len()] = 1.0;
        let share = self.first();
        let Solved { x: tangent, determinant } = self.tangent(&shot, share, &onwards)?;
        Ok(At { share, shot, distance, tangent, determinant })
    }

    /// The point at a step along the tangent.
    pub(super) fn correct(&mut self, from: &At, step: f64) -> Result<At, BranchError<E>> {
        let count = from.shot.miss.len();
        let moves: Vec<f64> = from.tangent[..count].iter().map(|t| t * step).collect();
        let mut share = from.share + step * from.tangent[count];
        let mut start = from.shot.moved(&moves);
        // z − z₀ − s t.
        let mut aside = vec![0.0; count + 1];
        let mut slope: Option<(Contacts, Vec<f64>)> = None;
        let mut last = f64::INFINITY;
        for _ in 0..CORRECTIONS {
            let system = self.system(share)?;
            let shot = Shot::new(&system, start, self.cycles, Some(&from.shot.scale))?;
            if !shot.misses_by().is_finite() {
                // Another contact at phase 0: where the motion itself leads.
                start = shot.end().clone();
                last = f64::INFINITY;
                continue;
            }
            let contacts = shot.contacts();
            let by = match slope.take() {
                Some((same, slope)) if last < SETTLED && same == contacts => slope,
                _ => self.slope(&shot, share)?,
            };
            let across = (0..=count).fold(0.0, |sum, i| sum - from.tangent[i] * aside[i]);
            let rest: Vec<f64> = shot.miss.iter().copied().chain([across]).collect();
            let Some(moves) = elimination::solve(bordered(&shot, &by, &from.tangent), rest, &shot.places()) else {
                return Err(shot.unsolved().into());
            };
            let distance = size(&moves);
            // The speed of a slow contact is the root of what a state is known to.
            let settled = if slow(&shot) < 1.0 { EXACT } else { CLOSED };
            if distance <= settled || (distance <= ROUNDING && distance > 0.5 * last) {
                let distance = distance.min(CLOSED);
                let shot = shot.in_own_units(&system);
                if leaves(&from.shot, &shot) {
                    return Err(shot.unsolved().into());
                }
                let Solved { x: tangent, determinant } = self.tangent(&shot, share, &from.onwards(&shot))?;
                return Ok(At { share, shot, distance, tangent, determinant });
            }
            aside.iter_mut().zip(&moves).for_each(|(aside, by)| *aside += by);
            if distance > last || length(&aside) > ASIDE * step.abs() {
                return Err(shot.unsolved().into());
            }
            start = shot.moved(&moves[..count]);
            share += moves[count];
            (slope, last) = (Some((contacts, by)), distance);
        }
        Err(OrbitError::NoConvergence { cycles: self.cycles, miss: last }.into())
    }

    /// ∂P/∂λ in units of the motion, by a difference of runs on both sides; of one side where the other has other contacts.
    fn slope(&mut self, shot: &Shot, share: f64) -> Result<Vec<f64>, BranchError<E>> {
        let mut error = None;
        let mut by = (DIFFERENCE * slow(shot) * slow(shot)).max(LEAST_DIFFERENCE);
        while by >= LEAST_DIFFERENCE {
            let [above, below] = [by, -by].map(|by| self.end_at(shot, share + by));
            let difference = |from: &End, to: &End, over: f64| -> Vec<f64> {
                let miss = shot.scale.miss(from, to).enumerate();
                miss.map(|(i, miss)| if miss.abs() <= NOISE * shot.scale.rounds(i) { 0.0 } else { miss / over })
                    .collect()
            };
            match (above, below) {
                (Ok(Some(above)), Ok(Some(below))) => return Ok(difference(&below, &above, 2.0 * by)),
                (Ok(Some(above)), _) => return Ok(difference(shot.end(), &above, by)),
                (_, Ok(Some(below))) => return Ok(difference(&below, shot.end(), by)),
                (Err(first), _) | (_, Err(first)) => error = Some(first),
                (Ok(None), Ok(None)) => {}
            }
            // A contact comes or goes in between.
            by *= 0.01;
        }
        Err(error.unwrap_or_else(|| shot.unsolved().into()))
    }

    /// Where the same start ends under another parameter; `None` by way of other contacts.
    fn end_at(&mut self, shot: &Shot, share: f64) -> Result<Option<End>, BranchError<E>> {
        let system = self.system(share)?;
        let (end, contacts) = state_after(&system, &shot.start, self.cycles)?;
        Ok((end.contacts == shot.end().contacts && contacts == shot.contacts()).then_some(end))
    }

    /// The direction in which solutions lie side by side, on the side of `onwards`, and the determinant of its equations.
    pub(super) fn tangent(&mut self, shot: &Shot, share: f64, onwards: &[f64]) -> Result<Solved, BranchError<E>> {
        let by = self.slope(shot, share)?;
        let mut rest = vec![0.0; onwards.len()];
        rest[onwards.len() - 1] = 1.0;
        let solved = elimination::solved(bordered(shot, &by, onwards), rest, &shot.places());
        let mut tangent = solved.ok_or_else(|| shot.unsolved())?;
        let all = length(&tangent.x);
        tangent.x.iter_mut().for_each(|t| *t /= all);
        tangent.determinant *= all;
        Ok(tangent)
    }
}

/// The step has come to the branch that this one begins at: to its motion, several times over, or to that which comes again upside down
/// after half a period.
fn leaves(from: &Shot, to: &Shot) -> bool {
    to.shortest_period() < to.tape.ends.len() || to.has_lost_its_asymmetry(from)
}

/// The speed of the slowest contact, as a share of what is slow; 1 at most.
fn slow(shot: &Shot) -> f64 {
    shot.slowest().map_or(1.0, |contact| (shot.share_of_speed(contact.approach) / SLOW).min(1.0))
}

/// [1 − M, −∂P/∂λ; tᵀ].
fn bordered(shot: &Shot, by: &[f64], across: &[f64]) -> DMatrix<f64> {
    elimination::bordered(&shot.closing(), across, |i| -by[i])
}
