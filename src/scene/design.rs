//! What a designer of a particle impact damper chooses, and a scene with one of these choices scaled.

use serde::{Deserialize, Serialize};

use super::{ContactDamping, Damper, Excitation, Scene, Surface};

/// A quantity of the dampers, of all of them at once, or of the excitation.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Design {
    /// Gap clearances h.
    Gap,
    /// Masses of the particles; enclosures weigh what they do.
    ParticleMass,
    /// Springs of floors and ceilings.
    Stiffness,
    /// Dashpots of floors and ceilings; where all are rigid their restitution.
    Damping,
    /// Amplitude of the force, or the impulse.
    Force,
}

impl Scene {
    /// The scene with this quantity times `factor` and all other quantities, in SI units, as they are: springs and dashpots are the
    /// same under a heavier particle. `None` where the scene has no such quantity, or one of zero.
    #[must_use]
    pub fn scaled(&self, design: Design, factor: f64) -> Option<Self> {
        let mut scene = self.clone();
        let mut found = false;
        let mut scale = |value: &mut f64| {
            found |= *value > 0.0 && value.is_finite();
            *value *= factor;
        };
        match design {
            Design::Gap => scene.dampers.iter_mut().for_each(|damper| scale(&mut damper.gap)),
            Design::ParticleMass => scene.dampers.iter_mut().for_each(|damper| scale(&mut damper.particle_mass)),
            Design::Stiffness => surfaces(&mut scene.dampers).for_each(|surface| {
                if let Surface::Resilient { stiffness, .. } = surface {
                    scale(stiffness);
                }
            }),
            Design::Damping => {
                let is_resilient = |surface: &mut Surface| matches!(surface, Surface::Resilient { .. });
                let some_give = surfaces(&mut scene.dampers).any(is_resilient);
                surfaces(&mut scene.dampers).for_each(|surface| match surface {
                    Surface::Rigid { restitution } if !some_give => scale(restitution),
                    Surface::Resilient { damping: ContactDamping::Constant(value), .. } => scale(value),
                    Surface::Resilient { damping: ContactDamping::EquivalentViscous(curve), .. } => {
                        curve.iter_mut().for_each(|[_, value]| scale(value));
                    }
                    Surface::Rigid { .. } => {}
                });
            }
            Design::Force => match &mut scene.excitation {
                Excitation::Harmonic { force: strength, .. }
                | Excitation::SingleImpulse { impulse: strength, .. }
                | Excitation::ImpulseTrain { impulse: strength, .. }
                | Excitation::PulseTrain { impulse: strength, .. } => {
                    found = *strength != 0.0;
                    *strength *= factor;
                }
            },
        }
        found.then_some(scene)
    }
}

fn surfaces(dampers: &mut [Damper]) -> impl Iterator<Item = &mut Surface> {
    dampers.iter_mut().flat_map(|damper| [&mut damper.floor, &mut damper.ceiling])
}
