//! The start of a scene: initial conditions in the place of static equilibrium.

use super::scene_reader::SceneReader;
use crate::scene::{ParticleStart, Start};
use crate::yaml::reader::unknown;
use crate::yaml::schema::word;
use crate::yaml::{At, Dimension, Value};

impl SceneReader<'_> {
    /// `{displacement: 2 mm, velocity: 0.1 m/s, particles: [{height: 10 mm, velocity: -1 m/s}, on_floor]}`.
    pub(super) fn start(&self, at: At<'_>) -> Option<Start> {
        let keys = at.keys("a start")?;
        let displacement =
            keys.optional("displacement", "Displacement of the mass", |at| at.quantity(Dimension::Length));
        let velocity = keys.optional("velocity", "Velocity of the mass", |at| at.quantity(Dimension::Velocity));
        let particles = keys.optional("particles", "Starts of particles, one a damper", |at| at.list(particle));
        keys.close()?;
        Some(Start {
            displacement: displacement?.unwrap_or(0.0),
            velocity: velocity?.unwrap_or(0.0),
            particles: particles?.unwrap_or_default(),
        })
    }
}

fn particle(at: At<'_>) -> Option<ParticleStart> {
    const WHAT: &str = "the start of a particle";
    const ON_FLOOR: &str = "on_floor";
    let at_rest = |at: At<'_>| {
        at.form(
            |node, findings| match &node.value {
                Value::Scalar(word) if word == ON_FLOOR => Some(ParticleStart::OnFloor),
                Value::Scalar(other) => unknown(findings, node.span, WHAT, "word", other, &[ON_FLOOR]),
                _ => None,
            },
            |_| word(ON_FLOOR),
        )
    };
    at.either(
        |value| matches!(value, Value::Scalar(_)),
        at_rest,
        |at| {
            let keys = at.keys(WHAT)?;
            let height = keys.required("height", "Height over its floor", |at| at.quantity(Dimension::Length));
            let velocity = "Velocity relative to its floor";
            let velocity = keys.required("velocity", velocity, |at| at.quantity(Dimension::Velocity));
            keys.close()?;
            Some(ParticleStart::InFlight { height: height?, velocity: velocity? })
        },
    )
}
