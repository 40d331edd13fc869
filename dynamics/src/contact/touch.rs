//! Rigid contacts that are closed at one instant, as the faces of a system: what a collision is made of, and what it gives
//! the structure. [`crate::contact::collision`] says which of them push.

use crate::arithmetic::few::Few;
use crate::arithmetic::matrix::dot;
use crate::contact::Side;
use crate::contact::collision::{Closed, Outcome};
use crate::contact::mobility::Mobilities;
use crate::error::EngineError;
use crate::system::HybridSystem;

/// A rigid contact that is closed.
pub(crate) struct Touch {
    pub(crate) particle: usize,
    pub(crate) side: Side,
    /// On the stop of a resilient face.
    pub(crate) on_stop: bool,
    /// Held until now.
    pub(crate) held: bool,
    /// Place of its mobility.
    pub(crate) mobility: usize,
    pub(crate) closed: Closed,
}

impl Touch {
    /// A particle at a face, moving against it at this rate, upwards.
    pub(crate) fn new(
        system: &HybridSystem,
        mobilities: &mut Mobilities,
        j: usize,
        side: Side,
        held: bool,
        rate: f64,
    ) -> Result<Self, EngineError> {
        let particle = &system.particles[j];
        let both_ways = particle.is_enclosed();
        let law = side.face(particle).law;
        // All bounces across no gap happen at once.
        let restitution = if both_ways { 0.0 } else { law.restitution() };
        Ok(Self {
            particle: j,
            side,
            on_stop: law.stop().is_some(),
            held,
            mobility: mobilities.find(system, j, side)?,
            closed: Closed { mass: particle.mass, speed: side.away() * rate, restitution, both_ways },
        })
    }
}

/// S of the closed contacts, row by row.
pub(crate) fn answers(system: &HybridSystem, mobilities: &Mobilities, touches: &[Touch]) -> Few<f64> {
    let mut answers = Few::with_capacity(touches.len() * touches.len());
    for at in touches {
        let row = &at.side.face(&system.particles[at.particle]).row;
        for from in touches {
            let answer = dot(row, mobilities.answer(from.mobility));
            answers.push(at.side.away() * from.side.away() * answer);
        }
    }
    answers
}

/// What the impulses of a collision do to the structure.
pub(crate) struct Exchange {
    /// Of its velocities.
    pub(crate) jump: Few<f64>,
    /// Energy lost, J.
    pub(crate) loss: f64,
}

impl Exchange {
    pub(crate) fn new(system: &HybridSystem, mobilities: &Mobilities, touches: &[Touch], outcomes: &[Outcome]) -> Self {
        let mut jump = Few::from_elem(0.0, system.mass.order);
        let mut loss = 0.0;
        for (touch, outcome) in touches.iter().zip(outcomes) {
            let impulse = touch.side.away() * outcome.impulse;
            let answer = mobilities.answer(touch.mobility);
            jump.iter_mut().zip(&answer[..]).for_each(|(jump, answer)| *jump -= impulse * answer);
            loss -= 0.5 * outcome.impulse * (touch.closed.speed + outcome.speed);
        }
        Self { jump, loss }
    }
}
