//! A scene with one effect switched: off where it is in force, on where it is not and its numbers are known.

use super::{ContactDamping, ContactEnd, Damper, Excitation, LimitStop, Scene, Surface};

/// What became of switching an effect.
#[derive(Debug, Clone, PartialEq)]
pub enum Switching {
    /// The scene without it.
    Off(Box<Scene>),
    /// The scene with it.
    On(Box<Scene>),
    /// It cannot be switched here, and why.
    Not(&'static str),
}

/// Switches an effect of the dampers or of the excitation, by its name in [`super::effects`]. `limit_stop` is the stop that a
/// scene without one may get.
#[must_use]
pub fn switched(scene: &Scene, effect: &str, limit_stop: Option<LimitStop>) -> Switching {
    let off = |change: &dyn Fn(&mut Damper)| {
        let mut other = scene.clone();
        other.dampers.iter_mut().for_each(change);
        if other == *scene { Switching::Not("the scene names none of it") } else { Switching::Off(Box::new(other)) }
    };
    match effect {
        "enclosure mass" => off(&|damper| damper.enclosure_mass = 0.0),
        "gravity" => Switching::Off(Box::new(Scene { gravity: 0.0, ..scene.clone() })),
        "restitution" => off(&|damper| {
            for surface in surfaces(damper) {
                if let Surface::Rigid { restitution } = surface {
                    *restitution = 0.0;
                }
            }
        }),
        "resilient floor and ceiling" => off(&|damper| {
            if surfaces(damper).any(|surface| matches!(surface, Surface::Resilient { .. })) {
                (damper.stop, damper.walls) = (None, None);
                surfaces(damper).for_each(|surface| *surface = Surface::Rigid { restitution: 0.0 });
            }
        }),
        "equivalent viscous damping" => off(&|damper| {
            for surface in surfaces(damper) {
                if let Surface::Resilient { damping, .. } = surface
                    && let ContactDamping::EquivalentViscous(curve) = damping
                {
                    let sum: f64 = curve.iter().map(|[_, damping]| damping).sum();
                    *damping = ContactDamping::Constant(sum / curve.len().max(1) as f64);
                }
            }
        }),
        "contact without tension" => tension(scene),
        "ceiling" => off(&|damper| damper.gap = f64::INFINITY),
        "limit stop" => stop(scene, limit_stop),
        "soft walls" => off(&|damper| damper.walls = None),
        "finite pulse" => match scene.excitation {
            Excitation::PulseTrain { impulse, period, .. } => {
                let excitation = Excitation::ImpulseTrain { impulse, period };
                Switching::Off(Box::new(Scene { excitation, ..scene.clone() }))
            }
            _ => Switching::Not("the scene gives pulses no duration"),
        },
        _ => Switching::Not("it is what the scene is made of"),
    }
}

fn surfaces(damper: &mut Damper) -> impl Iterator<Item = &mut Surface> {
    [&mut damper.floor, &mut damper.ceiling].into_iter()
}

/// Whether springs may pull needs no number, so that it goes both ways.
fn tension(scene: &Scene) -> Switching {
    let mut other = scene.clone();
    let mut was: Option<ContactEnd> = None;
    for surface in other.dampers.iter_mut().flat_map(surfaces) {
        if let Surface::Resilient { ends, .. } = surface {
            let now = *was.get_or_insert(*ends);
            *ends = if now == ContactEnd::ZeroGap { ContactEnd::ZeroForce } else { ContactEnd::ZeroGap };
        }
    }
    match was {
        None => Switching::Not("no surface is resilient"),
        Some(ContactEnd::ZeroGap) => Switching::On(Box::new(other)),
        Some(ContactEnd::ZeroForce) => Switching::Off(Box::new(other)),
    }
}

fn stop(scene: &Scene, limit_stop: Option<LimitStop>) -> Switching {
    let mut other = scene.clone();
    if scene.dampers.iter().any(|damper| damper.stop.is_some()) {
        other.dampers.iter_mut().for_each(|damper| damper.stop = None);
        return Switching::Off(Box::new(other));
    }
    let Some(limit_stop) = limit_stop else { return Switching::Not("no assumption gives its length") };
    let resilient = |damper: &Damper| matches!(damper.floor, Surface::Resilient { .. });
    if !scene.dampers.iter().any(resilient) {
        return Switching::Not("no surface is resilient");
    }
    other.dampers.iter_mut().for_each(|damper| damper.stop = Some(limit_stop));
    Switching::On(Box::new(other))
}
