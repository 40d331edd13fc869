//! The start of a scene: initial conditions in the place of static equilibrium.

use super::quantity::Dimension;
use super::reader::{Fields, list, quantity, unknown};
use super::recipe::Part;
use super::scene::SceneReader;
use super::yaml::{Node, Value};
use crate::scene::{ParticleStart, Start};

impl<'t> SceneReader<'t> {
    /// `{displacement: 2 mm, velocity: 0.1 m/s, particles: [{height: 10 mm, velocity: -1 m/s}, on_floor]}`.
    pub(super) fn start(&self, node: &'t Node) -> Option<Start> {
        self.parts.borrow_mut().push((Part::Start, node.span));
        let fields = Fields::open(node, "a start", self.findings)?;
        let displacement = fields.optional("displacement", |node| quantity(node, Dimension::Length, self.findings));
        let velocity = fields.optional("velocity", |node| quantity(node, Dimension::Velocity, self.findings));
        let particles =
            fields.optional("particles", |node| list(node, self.findings, |node| self.particle_start(node)));
        fields.close()?;
        Some(Start {
            displacement: displacement?.unwrap_or(0.0),
            velocity: velocity?.unwrap_or(0.0),
            particles: particles?.unwrap_or_default(),
        })
    }

    fn particle_start(&self, node: &'t Node) -> Option<ParticleStart> {
        const WHAT: &str = "the start of a particle";
        match &node.value {
            Value::Scalar(word) if word == "on_floor" => return Some(ParticleStart::OnFloor),
            Value::Scalar(word) => return unknown(self.findings, node.span, WHAT, "word", word, &["on_floor"]),
            _ => {}
        }
        let fields = Fields::open(node, WHAT, self.findings)?;
        let height = fields.required("height", |node| quantity(node, Dimension::Length, self.findings));
        let velocity = fields.required("velocity", |node| quantity(node, Dimension::Velocity, self.findings));
        fields.close()?;
        Some(ParticleStart::InFlight { height: height?, velocity: velocity? })
    }
}
