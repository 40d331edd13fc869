//! Initial conditions: displacement and velocity of one mass, and where each particle is in its enclosure.
//!
//! A particle's height is measured from its floor and its velocity is relative to it, u = y − x and u′ = y′ − x′.

use serde::{Deserialize, Serialize};

use super::{Scene, Structure};
use crate::dynamics::{Contact, Placed, StartState};
use crate::text::number::quantity;

/// Where a run starts.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct Start {
    /// x, m.
    pub displacement: f64,
    /// x′, m/s.
    pub velocity: f64,
    /// One a damper, in the order of the scene; empty: all of them on their floors.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub particles: Vec<ParticleStart>,
}

/// Where a particle starts.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum ParticleStart {
    /// On its floor, which is not compressed, and at rest relative to it.
    OnFloor,
    /// Between floor and ceiling.
    InFlight {
        /// u, m.
        height: f64,
        /// u′, m/s.
        velocity: f64,
    },
}

/// Why a scene cannot start there.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("{0}")]
pub struct StartError(pub String);

impl Start {
    /// The same without particles.
    #[must_use]
    pub fn of_structure(self) -> Self {
        Self { particles: Vec::new(), ..self }
    }

    /// In words, for a person who asks what is simulated.
    pub(super) fn describe(&self) -> String {
        let value = |x, unit| quantity(x, unit, 5);
        let mut text = format!("start: {}, {}", value(self.displacement, "m"), value(self.velocity, "m/s"));
        for particle in &self.particles {
            text += &match particle {
                ParticleStart::OnFloor => "; particle on its floor".to_owned(),
                ParticleStart::InFlight { height, velocity } => format!(
                    "; particle {} above its floor with {} relative to it",
                    value(*height, "m"),
                    value(*velocity, "m/s")
                ),
            };
        }
        text
    }
}

impl Scene {
    /// Refuses a start that does not fit the scene.
    ///
    /// # Errors
    /// [`StartError`] with the reason.
    pub fn check_start(&self) -> Result<(), StartError> {
        let Some(start) = &self.start else { return Ok(()) };
        let refuse = |message: String| Err(StartError(message));
        let moves = start.displacement != 0.0 || start.velocity != 0.0;
        if moves && !matches!(self.structure, Structure::SingleMass(_)) {
            return refuse("displacement and velocity of a start are those of a single mass; strike other structures once, with `single_impulse`".into());
        }
        let (given, dampers) = (start.particles.len(), self.dampers.len());
        if given > 0 && given != dampers {
            return refuse(format!("the start places {given} particles, and the scene has {dampers}: one each"));
        }
        for (particle, damper) in start.particles.iter().zip(&self.dampers) {
            if let ParticleStart::InFlight { height, .. } = particle
                && !(0.0..=damper.gap).contains(height)
            {
                let ceiling =
                    if damper.gap.is_finite() { format!(", which lies at {} m", damper.gap) } else { String::new() };
                return refuse(format!(
                    "a particle starts no lower than its floor and no higher than its ceiling{ceiling}; its height is {height} m"
                ));
            }
        }
        Ok(())
    }

    /// Nothing sets it in motion.
    #[must_use]
    pub fn is_at_rest(&self) -> bool {
        self.excitation.is_silent() && self.start.is_none()
    }

    /// Where a run starts.
    #[must_use]
    pub fn start_state(&self) -> StartState {
        let Some(start) = &self.start else { return StartState::StaticEquilibrium };
        let walls = self.dampers.iter().any(|damper| damper.walls.is_some());
        let order = self.structure.model().natural_frequencies().len() + usize::from(walls);
        let coordinates = |first: f64| {
            let mut all = vec![0.0; order];
            all[0] = first;
            all
        };
        let place = |index: usize| match start.particles.get(index) {
            None | Some(ParticleStart::OnFloor) => Placed::ON_FLOOR,
            Some(ParticleStart::InFlight { height, velocity }) => Placed::new(Contact::Flight, *height, *velocity),
        };
        StartState::Given {
            q: coordinates(start.displacement),
            rate: coordinates(start.velocity),
            particles: (0..self.dampers.len()).map(place).collect(),
        }
    }
}
