//! What a run has to reckon with, known before it starts: a run without it has no such code.

use crate::system::{Face, HybridSystem, Law, Particle};

/// What a run has to reckon with.
pub(crate) trait Effects {
    /// Rigid faces and limit stops, faces that cannot pull, walls, half cycles; motion without loss.
    const ALL: bool;
    /// It keeps a tape.
    const TAPED: bool;
}

/// Springs and dashpots, at faces that move as one, and a motion that loses energy.
pub(crate) struct Plain;

/// Whatever a scene can name.
pub(crate) struct Every;

/// The same, on tape.
pub(crate) struct Taped;

impl Effects for Plain {
    const ALL: bool = false;
    const TAPED: bool = false;
}

impl Effects for Every {
    const ALL: bool = true;
    const TAPED: bool = false;
}

impl Effects for Taped {
    const ALL: bool = true;
    const TAPED: bool = true;
}

/// Nothing of a system is more than [`Plain`].
pub(crate) fn is_plain(system: &HybridSystem) -> bool {
    let pulls = |face: &Face| match face.law {
        Law::Resilient { no_tension, stop, .. } => !no_tension && stop.is_none(),
        Law::Rigid { .. } => false,
    };
    let plain = |particle: &Particle| {
        !particle.has_walls() && pulls(&particle.floor) && particle.ceiling.as_ref().is_none_or(pulls)
    };
    system.drive.half_cycles.is_none() && !system.is_undamped() && system.particles.iter().all(plain)
}
