//! Effects: what a scene is made of besides its numbers, which of them are in force, and why the others are not.
//!
//! An effect that a scene does not name costs nothing: its events, states and forces are not compiled in.

use super::{ContactDamping, ContactEnd, Excitation, Scene, Surface};

/// One effect over all cases of an experiment.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct EffectUse {
    /// Its name.
    pub name: &'static str,
    /// Cases in which it is in force.
    pub in_force: usize,
    /// All cases.
    pub cases: usize,
    /// Why it is left out where it is.
    pub why_not: &'static str,
}

/// Name, test, reason where it is left out.
type Effect = (&'static str, fn(&Scene) -> bool, &'static str);

const EFFECTS: [Effect; 13] = [
    (
        "structural damping",
        |scene| scene.structure.model().matrices().damping.entries.iter().any(|c| *c > 0.0),
        "the damping ratio of the structure is zero",
    ),
    (
        "further modes",
        |scene| scene.structure.model().natural_frequencies().len() > 1,
        "the structure has one degree of freedom",
    ),
    (
        "enclosure mass",
        |scene| scene.dampers.iter().any(|damper| damper.enclosure_mass > 0.0),
        "the mass ratio is that of the particle alone",
    ),
    ("gravity", |scene| scene.gravity > 0.0 && !scene.dampers.is_empty(), "there is no particle that could fall"),
    (
        "rigid impact",
        |scene| surfaces(scene).any(|surface| matches!(surface, Surface::Rigid { .. })),
        "no surface is rigid",
    ),
    (
        "restitution",
        |scene| surfaces(scene).any(|surface| matches!(surface, Surface::Rigid { restitution } if *restitution > 0.0)),
        "no surface is rigid with a restitution above zero",
    ),
    (
        "resilient floor and ceiling",
        |scene| surfaces(scene).any(|surface| matches!(surface, Surface::Resilient { .. })),
        "no surface is resilient",
    ),
    ("equivalent viscous damping", Scene::has_equivalent_viscous_damping, "the dashpots of the surfaces are constant"),
    (
        "contact without tension",
        |scene| {
            surfaces(scene).any(|surface| matches!(surface, Surface::Resilient { ends: ContactEnd::ZeroForce, .. }))
        },
        "contacts end at zero gap",
    ),
    (
        "ceiling",
        |scene| scene.dampers.iter().any(|damper| damper.gap.is_finite()),
        "the gap is infinite: no ceiling can be met",
    ),
    ("limit stop", |scene| scene.dampers.iter().any(|damper| damper.stop.is_some()), "no limit stop is named"),
    (
        "soft walls",
        |scene| scene.dampers.iter().any(|damper| damper.walls.is_some()),
        "the walls are rigid: floor and ceiling move with the structure",
    ),
    (
        "finite pulse",
        |scene| matches!(scene.excitation, Excitation::PulseTrain { .. }),
        "the excitation is not a train of pulses with a duration",
    ),
];

fn surfaces(scene: &Scene) -> impl Iterator<Item = &Surface> {
    scene.dampers.iter().flat_map(|damper| [&damper.floor, &damper.ceiling])
}

impl Scene {
    /// The dashpots of some surface follow from the motion of the half cycle before.
    #[must_use]
    pub fn has_equivalent_viscous_damping(&self) -> bool {
        let follows = |surface: &Surface| {
            matches!(surface, Surface::Resilient { damping: ContactDamping::EquivalentViscous(_), .. })
        };
        surfaces(self).any(follows)
    }
}

/// The effects over the scenes of all cases.
#[must_use]
pub fn effects(scenes: &[Scene]) -> Vec<EffectUse> {
    let count = |(name, test, why_not): Effect| EffectUse {
        name,
        in_force: scenes.iter().filter(|scene| test(scene)).count(),
        cases: scenes.len(),
        why_not,
    };
    EFFECTS.into_iter().map(count).collect()
}
