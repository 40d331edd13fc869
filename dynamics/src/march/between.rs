//! A particle at floor and ceiling at once, where they do not move as one (walls of finite stiffness).
//!
//! Each face goes on by its own law: it presses, holds, lets go, pushes again. The state refers to the face that holds the
//! particle, else to one that presses, and is referred anew where that changes. Two faces that would both hold it are refused.

use super::March;
use super::effects::Effects;
use super::grip::Bend;
use crate::contact::{Change, Crossing, Hold, Relative, STICKING_SPEED, Side};
use crate::contact_state::face_damping;
use crate::error::EngineError;
use crate::search::guards::{self, Slipped};
use crate::system::Law;

/// Roundings of a distance that a bounce has to rise above.
const SEVERAL: f64 = 16.0;
/// Share of its energy that a bounce has to take if bounces are to die away before rounding has added up over too many of them.
const LEAST_LOSS: f64 = 1e-6;

impl<E: Effects> March<'_, E> {
    /// A crossing of a particle that is at both faces, or comes to be.
    pub(super) fn cross_between(&mut self, j: usize, crossing: Crossing) -> Result<(), EngineError> {
        let Some((side, change)) = crossing.at(self.contacts[j].side()) else { return Ok(()) };
        let particle = &self.system.particles[j];
        let law = side.face(particle).law;
        let here = self.relative_to(j, side);
        // The push of a dashpot sets in at once, and with it accelerations elsewhere jump.
        let mut jumps = false;
        match change {
            // A rounding has put the particle behind a face that it is leaving.
            Change::Meets if side.away() * here.rate >= 0.0 => {}
            Change::Meets => match law {
                Law::Rigid { .. } => return self.strike_across(j, side),
                Law::Resilient { .. } => {
                    self.record(j, side.made(), here.rate, here.rate);
                    self.turn(j, side, Hold::Pressed)?;
                    if self.contacts[j].side() == side {
                        self.particles[j].gap = 0.0;
                    }
                    jumps = true;
                }
            },
            Change::Stops => return self.strike_across(j, side),
            Change::Releases if self.contacts[j].at(side, particle) == Hold::Held => {
                if self.sudden {
                    return self.hold_on();
                }
                self.particles[j].rate = 0.0;
                self.let_go(j, side);
                self.is_smooth(j, side);
            }
            Change::Releases
                if matches!(law, Law::Resilient { no_tension: true, .. }) && self.is_compressed(j, side) =>
            {
                self.slip_smoothly(j, side)?;
            }
            Change::Releases => {
                self.record(j, side.lost(), here.rate, here.rate);
                self.turn(j, side, Hold::Away)?;
                jumps = true;
            }
            Change::Recovers => self.turn(j, side, Hold::Away)?,
            Change::PushesAgain => self.slip_smoothly(j, side)?,
        }
        self.meet_at_once()?;
        if jumps { self.hold_on() } else { self.choose_flow() }
    }

    /// A rigid face, or a stop, meets a particle that the other face presses: it holds it until the exchange of momentum says
    /// otherwise.
    fn strike_across(&mut self, j: usize, side: Side) -> Result<(), EngineError> {
        self.turn(j, side, Hold::Held)?;
        self.strike(j, side)
    }

    /// What one face does to a particle changes; its state goes on referring to the face that its contact names.
    pub(super) fn turn(&mut self, j: usize, side: Side, hold: Hold) -> Result<(), EngineError> {
        let particle = &self.system.particles[j];
        let before = self.contacts[j];
        let Some(after) = before.turned(side, hold, particle) else {
            return Err(EngineError::Squeezed { particle: j, cycle: self.cycle, time: self.time });
        };
        if before.side() != after.side() {
            self.particles[j] = self.relative_to(j, after.side());
        }
        if hold == Hold::Held {
            self.particles[j].gap = -side.away() * side.face(particle).law.depth();
        }
        self.changed = true;
        self.contacts[j] = after;
        Ok(())
    }

    /// Where a particle is relative to the face on one side.
    pub(super) fn relative_to(&self, j: usize, side: Side) -> Relative {
        let here = self.particles[j];
        if self.contacts[j].side() == side {
            return here;
        }
        guards::seen_from(side, &self.system.particles[j], here, &self.q, &self.rate)
    }

    /// Some floor and ceiling do not move as one.
    #[inline(always)]
    pub(super) fn has_walls(&self) -> bool {
        E::ALL && self.has_walls
    }

    /// The face across from this side touches the particle too, or alone.
    #[inline]
    pub(super) fn touches_across(&self, j: usize, side: Side) -> bool {
        let contact = self.contacts[j];
        let particle = &self.system.particles[j];
        self.has_walls() && contact.at(side.opposite(), particle) != Hold::Away
    }

    /// Held on the stop of the face on this side.
    #[inline]
    pub(super) fn is_on_stop(&self, j: usize, side: Side) -> bool {
        let (contact, particle) = (self.contacts[j], &self.system.particles[j]);
        let both = || side.face(particle).law.stop().is_some() && contact.side() == side && contact.holds(particle);
        E::ALL && (contact == side.stopped() || (contact.is_between() && both()))
    }

    /// A force comes to zero at one of the faces: its guard begins there.
    fn is_smooth(&mut self, j: usize, side: Side) {
        if self.contacts[j].side() == side {
            self.smooth[j] = true;
        } else {
            self.slipped = Some(Slipped { particle: j, order: 3 });
        }
    }

    /// A face that cannot pull lets go while compressed, or pushes again: the energy of its spring goes and comes.
    pub(super) fn slip(&mut self, j: usize, side: Side) -> Result<(), EngineError> {
        let particle = &self.system.particles[j];
        let pressed = self.contacts[j].at(side, particle) == Hold::Pressed;
        let here = self.relative_to(j, side);
        self.record(j, if pressed { side.lost() } else { side.made() }, here.rate, here.rate);
        self.turn(j, side, if pressed { Hold::Released } else { Hold::Pressed })?;
        if let (Some(audit), Law::Resilient { stiffness, .. }) = (&mut self.audit, side.face(particle).law) {
            let stored = 0.5 * stiffness * here.gap * here.gap;
            audit.loss(if pressed { stored } else { -stored });
        }
        Ok(())
    }

    /// The same where its force has come to zero.
    pub(super) fn slip_smoothly(&mut self, j: usize, side: Side) -> Result<(), EngineError> {
        if self.sudden {
            return self.slip(j, side);
        }
        self.unload(j, side);
        self.slip(j, side)?;
        self.is_smooth(j, side);
        Ok(())
    }

    /// Spring and dashpot cancel to the last digit, by a change of place or of rate, whichever holds less energy. What rounding leaves
    /// of their force is nothing to the flow that ends, and may be a push that sets in again to the next one, and so on.
    fn unload(&mut self, j: usize, side: Side) {
        let particle = &self.system.particles[j];
        let (Relative { gap, rate }, damping) = (self.particles[j], self.damping_on(j, side));
        let cancel = side.away() * rate > 0.0 && damping > 0.0;
        if let Law::Resilient { stiffness, .. } = side.face(particle).law
            && cancel
            && self.contacts[j].side() == side
        {
            self.particles[j] = if stiffness * (gap * gap) < particle.mass * (rate * rate) {
                Relative { gap: -damping * rate / stiffness, rate }
            } else {
                Relative { gap, rate: -stiffness * gap / damping }
            };
        }
    }

    /// After a jump of velocities: whether each of the two faces goes on as it did.
    pub(super) fn press_or_part_between(&mut self, j: usize) -> Result<(), EngineError> {
        for side in [Side::Floor, Side::Ceiling] {
            let particle = &self.system.particles[j];
            let Law::Resilient { stiffness, no_tension, .. } = side.face(particle).law else { continue };
            let (here, away) = (self.relative_to(j, side), side.away());
            let push = -away * (stiffness * here.gap + self.damping_on(j, side) * here.rate);
            match self.contacts[j].at(side, particle) {
                Hold::Pressed if no_tension && push < 0.0 && self.is_compressed(j, side) => self.slip(j, side),
                Hold::Pressed if (no_tension && push < 0.0) || (here.gap == 0.0 && away * here.rate > 0.0) => {
                    self.record(j, side.lost(), here.rate, here.rate);
                    self.turn(j, side, Hold::Away)
                }
                Hold::Released if push > 0.0 => self.slip(j, side),
                Hold::Pressed | Hold::Released | Hold::Held | Hold::Away => Ok(()),
            }?;
        }
        Ok(())
    }

    /// A bounce so low that the distance to this face, a difference of places, does not show it: the other face, which pushes the
    /// particle back, gives it u² = 2 a δ for a rounding δ of that distance, and what is left of this after many bounces is none.
    pub(super) fn slow_between(&self, j: usize, side: Side, restitution: f64, carried: f64) -> f64 {
        let (particle, other) = (&self.system.particles[j], side.opposite());
        let here = self.relative_to(j, other);
        let Law::Resilient { stiffness, .. } = other.face(particle).law else { return STICKING_SPEED };
        let push = (stiffness * here.gap).abs() + (self.damping_on(j, other) * here.rate).abs();
        let back = (push / particle.mass + self.system.gravity) * carried;
        let rounding = self.noise(j, side, here).max(self.noise(j, other, here));
        least_bounce(SEVERAL * back * rounding, restitution)
    }

    /// Damping of a face, N s/m.
    fn damping_on(&self, j: usize, side: Side) -> f64 {
        face_damping(side.face(&self.system.particles[j]).law, self.equivalent)
    }

    /// What the face across from this side pushes per mass, and how fast that grows, in the flow in force.
    pub(super) fn push_across(&self, j: usize, side: Side) -> [f64; 2] {
        let (flow, particle, contact) = (&self.flow, &self.system.particles[j], self.contacts[j]);
        let other = side.opposite();
        let row = if contact.side() == other {
            flow.rows.guards[j].compression
        } else {
            flow.rows.guards[j].across.map(|rows| rows.way)
        };
        let (Law::Resilient { stiffness, .. }, Some(row), Hold::Pressed) =
            (other.face(particle).law, row, contact.at(other, particle))
        else {
            return [0.0; 2];
        };
        let Bend { value: bend, .. } = Bend::of(&flow.blocks, flow.rows.row(row), &self.c, self.level);
        // The way across counts from the particle to the face, as away from the face.
        let bend = if contact.side() == other { other.away() * bend } else { bend };
        let (here, damping) = (self.relative_to(j, other), self.damping_on(j, other));
        let push = -other.away() * (stiffness * here.gap + damping * here.rate);
        let growth = -other.away() * stiffness * here.rate - damping * bend;
        [push / particle.mass, growth / particle.mass]
    }
}

/// The speed below which a bounce counts as none, where rounding adds `added` to u² at each. Where a bounce takes a share of u², the
/// roundings of 1/share bounces add up. Below [`LEAST_LOSS`] these are more bounces than a run has: there u² is what 1/[`LEAST_LOSS`] of them
/// would take of the sum of their roundings, and one rounding at least.
fn least_bounce(added: f64, restitution: f64) -> f64 {
    let loss = 1.0 - restitution * restitution;
    let sum = if loss > LEAST_LOSS { 1.0 / loss } else { (loss / (LEAST_LOSS * LEAST_LOSS)).max(1.0) };
    STICKING_SPEED.max((added * sum).sqrt())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::arithmetic::matrix::Matrix;
    use crate::options::Options;
    use crate::run::event_driven;
    use crate::system::{Drive, Face, HybridSystem, Particle, Tick};

    /// A base on a spring, a light ceiling on stiff walls, and a particle between its springy floor and the rigid ceiling.
    fn without_weight(gap: f64, restitution: f64) -> HybridSystem {
        let face = |row: [f64; 2], law| Face { row: row.to_vec(), law };
        let spring = Law::Resilient { stiffness: 1e3, damping: 0.0, no_tension: false, stop: None };
        HybridSystem {
            mass: Matrix::diagonal(&[1.0, 0.01]),
            damping: Matrix::diagonal(&[0.63, 0.0]),
            stiffness: Matrix { order: 2, entries: vec![1.01e5, -1e5, -1e5, 1e5] },
            gravity: 0.0,
            particles: vec![Particle {
                mass: 0.05,
                floor: face([1.0, 0.0], spring),
                ceiling: Some(face([0.0, 1.0], Law::Rigid { restitution })),
                gap,
            }],
            force_row: vec![1.0, 0.0],
            drive: Drive {
                period: 0.2,
                ticks: vec![Tick { time: 0.0, impulse: 0.5, level: 0.0 }],
                repeats: true,
                harmonic: None,
                half_cycles: None,
            },
            observed_rows: vec![vec![1.0, 0.0]],
            momentum_rows: vec![vec![1.0, 1.0]],
        }
    }

    #[test]
    fn a_particle_without_weight_that_leaves_the_ceiling_where_it_meets_the_floor_keeps_its_momentum() {
        // Without a gap the wall is unstrained where floor and ceiling meet: all forces are zero at that instant.
        for restitution in [0.0, 0.5, 0.9] {
            let run = |gap| {
                let options = Options { skip: 0, average: 3, audit: true, ..Options::default() };
                event_driven(&without_weight(gap, restitution), &options).expect("one face yields")
            };
            let [none, small] = [0.0, 1e-12].map(run);
            for response in [&none, &small] {
                let proof = response.proof;
                assert!(proof.momentum_residual < 1e-12 && proof.energy_residual < 1e-12, "{restitution}: {proof:?}");
            }
            // At restitution 0.9 rounding ends the chatter elsewhere, which moves the end of the run.
            if restitution < 0.9 {
                let off = (none.final_displacement - small.final_displacement).abs();
                assert!(off < 1e-7, "restitution {restitution}: {off:e}");
            }
        }
    }

    #[test]
    fn the_speed_below_which_a_bounce_is_none_has_no_step_where_bounces_cease_to_die_away_and_is_one_rounding_where_nothing_is_lost()
     {
        let restitution = |loss: f64| (1.0 - loss).sqrt();
        let speed = |loss: f64| least_bounce(1e-14, restitution(loss));
        for loss in [1e-2, 1e-4, 1.0000001e-6, 0.9999999e-6, 1e-8, 1e-10] {
            let ratio = speed(loss) / speed(1.001 * loss);
            assert!((ratio - 1.0).abs() < 1e-3, "a loss of {loss}: {ratio}");
        }
        // Where bounces die away they hold a sum of 1 / loss roundings.
        assert!((speed(1e-4) / 1e-5 - 1.0).abs() < 1e-9);
        assert!((least_bounce(1e-14, 1.0) / 1e-7 - 1.0).abs() < 1e-9);
    }
}
