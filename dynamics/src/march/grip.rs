//! Grip: how a face holds a particle that does not move against it.

use crate::contact::{Side, spring_on_stop};
use crate::contact_state::block::Phase;
use crate::flow::Flow;
use crate::flow::parabola::Parabola;
use crate::system::HybridSystem;

/// How a face holds a particle that does not move against it.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Grip {
    /// What it can push per mass, as an acceleration: it holds while this is positive.
    pub(crate) push: f64,
    /// How fast that grows.
    growth: f64,
    /// What of it is rounding.
    noise: f64,
}

impl Grip {
    /// The grip of a face, whose row has these shares, on particle j; with the particle in flight, what brings it back to
    /// the face.
    pub(crate) fn of(
        system: &HybridSystem,
        flow: &Flow,
        phases: &[Phase],
        rest: Parabola,
        j: usize,
        side: Side,
        on_stop: bool,
    ) -> Self {
        let spring = if on_stop { spring_on_stop(&system.particles[j], side) } else { 0.0 };
        let (mut bend, mut growth) = (2.0 * rest.p2, 0.0);
        let mut size = system.gravity + bend.abs() + spring;
        for (block, phase) in flow.blocks.iter().zip(phases) {
            let now = block.acceleration(*phase);
            bend += now.value;
            growth += now.rate;
            size += (2.0 * block.decay * phase.rate).abs() + (block.determinant * phase.value).abs();
        }
        Self {
            push: side.away() * (bend + system.gravity) - spring,
            growth: side.away() * growth,
            noise: 64.0 * f64::EPSILON * size,
        }
    }

    /// With what the other face pushes per mass, and how fast that grows.
    pub(crate) fn against(self, [push, growth]: [f64; 2]) -> Self {
        let noise = self.noise + 64.0 * f64::EPSILON * push.abs();
        Self { push: self.push + push, growth: self.growth + growth, noise }
    }

    /// Whether it holds: where the push is nothing but rounding, by what it becomes.
    pub(crate) fn holds(self) -> bool {
        self.push > self.noise || (self.is_nothing() && self.grows())
    }

    /// A bounce of this speed is over before the push rises above rounding, and counts as none.
    pub(crate) fn outweighs(self, speed: f64) -> bool {
        speed == 0.0 || (self.growth != 0.0 && 2.0 * speed * self.growth.abs() <= self.noise * self.noise)
    }

    /// Where it is nothing: the push sets in.
    pub(crate) fn grows(self) -> bool {
        self.growth >= 0.0
    }

    pub(crate) fn is_nothing(self) -> bool {
        self.push.abs() <= self.noise
    }
}
