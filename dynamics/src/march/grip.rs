//! Grip: how a face holds a particle that does not move against it.

use crate::contact::{Side, spring_on_stop};
use crate::contact_state::block::Block;
use crate::flow::signals::Row;
use crate::system::HybridSystem;

/// The acceleration of a signal.
pub(crate) struct Bend {
    pub(crate) value: f64,
    /// How fast it grows.
    rate: f64,
    /// The moduli of its parts, whose rounding it has.
    size: f64,
}

impl Bend {
    /// Of a row at these block coordinates, under this constant force.
    pub(crate) fn of(blocks: &[Block], row: &Row, c: &[f64], force: f64) -> Self {
        let constant = 2.0 * row.rest(force).p2;
        let mut bend = Self { value: constant, rate: 0.0, size: constant.abs() };
        for (block, phase) in blocks.iter().zip(row.phases(c)) {
            let now = block.acceleration(phase);
            bend.value += now.value;
            bend.rate += now.rate;
            bend.size += (2.0 * block.decay * phase.rate).abs() + (block.determinant * phase.value).abs();
        }
        bend
    }
}

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
    /// The grip on particle j of a face with this acceleration; with the particle in flight, what brings it back to the face.
    pub(crate) fn of(system: &HybridSystem, face: Bend, j: usize, side: Side, on_stop: bool) -> Self {
        let spring = if on_stop { spring_on_stop(&system.particles[j], side) } else { 0.0 };
        Self {
            push: side.away() * (face.value + system.gravity) - spring,
            growth: side.away() * face.rate,
            noise: 64.0 * f64::EPSILON * (system.gravity + spring + face.size),
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
