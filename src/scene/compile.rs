//! Scene to hybrid system: only the effects that the scene names.
//!
//! The structure supplies M, C, K and the shape φ at a point. An enclosure adds ms φφᵀ to M, and both faces of it move with φ·q.
//! Soft walls on one mass add the ceiling side of the enclosure as a second coordinate s = x_top − x, so that
//! M = [[m, mt], [mt, mt]] with mt taken off the base, K = diag(ks, kw).

use super::{
    ContactDamping, ContactEnd, Curve, Damper, Excitation, Matrices, PulseShape, Scene, SingleMass, Structure, Surface,
    Walls,
};
use crate::dynamics::{Drive, Face, HalfCycles, Harmonic, HybridSystem, Law, Matrix, Particle, Spline, Stop, Tick};

/// Why a scene does not compile.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum CompileError {
    /// Soft walls on more than one damper.
    #[error("soft walls are modelled for a single damper on a single mass; this scene has {dampers} dampers")]
    WallsOnArray {
        /// How many.
        dampers: usize,
    },
    /// A resilient face without particle mass.
    #[error(
        "a particle without mass cannot press into a resilient floor (the contact is singular): give it a mass, however small"
    )]
    MasslessContact,
    /// Surfaces of different kinds of damping.
    #[error(
        "equivalent viscous damping holds for floor and ceiling of all dampers together; state it for each of them"
    )]
    MixedDamping,
    /// Surfaces have curves of their own.
    #[error(
        "equivalent viscous damping goes by one curve, and these surfaces have several: give floors and ceilings of all dampers the same `damping_curve`"
    )]
    SeveralCurves,
    /// The damping curve is no curve.
    #[error("the equivalent damping curve needs points with increasing accelerations")]
    DampingCurve,
}

/// Compiles a scene.
///
/// # Errors
/// [`CompileError`] where the scene asks for what no model covers.
pub fn compile(scene: &Scene) -> Result<HybridSystem, CompileError> {
    let walls = match scene.dampers.as_slice() {
        [damper] => damper.walls,
        dampers if dampers.iter().any(|damper| damper.walls.is_some()) => {
            return Err(CompileError::WallsOnArray { dampers: dampers.len() });
        }
        _ => None,
    };
    let curve = curve(scene)?;
    if let Some(walls) = walls {
        return with_walls(scene, walls, curve);
    }
    let model = scene.structure.model();
    let Matrices { mut mass, damping, stiffness } = model.matrices();
    let mut particles = Vec::with_capacity(scene.dampers.len());
    for damper in &scene.dampers {
        let row = model.shape(damper.at);
        if damper.enclosure_mass > 0.0 {
            mass.add_square(damper.enclosure_mass, &row);
        }
        particles.push(particle(damper, &row, &row)?);
    }
    let force_row = model.shape(scene.force_at);
    Ok(HybridSystem {
        mass,
        damping,
        stiffness,
        gravity: scene.gravity,
        drive: drive_of(scene, curve, &particles),
        particles,
        observed_rows: scene.observed.points.iter().map(|point| model.shape(*point)).collect(),
        // Contact forces are internal along every row, since floor and ceiling move alike; along this one the force is felt.
        momentum_rows: vec![force_row.clone()],
        force_row,
    })
}

/// One mass with a third body.
fn with_walls(scene: &Scene, walls: Walls, curve: Option<Spline>) -> Result<HybridSystem, CompileError> {
    let Structure::SingleMass(SingleMass { mass, stiffness, damping }) = scene.structure else {
        return Err(CompileError::WallsOnArray { dampers: scene.dampers.len() });
    };
    let (base, top) = (vec![1.0, 0.0], vec![1.0, 1.0]);
    let third = walls.ceiling_mass;
    let mass = mass + scene.dampers.iter().map(|damper| damper.enclosure_mass).sum::<f64>();
    let particles =
        scene.dampers.iter().map(|damper| particle(damper, &base, &top)).collect::<Result<Vec<Particle>, _>>()?;
    Ok(HybridSystem {
        mass: Matrix { order: 2, entries: vec![mass, third, third, third] },
        damping: Matrix::diagonal(&[damping, walls.damping]),
        stiffness: Matrix::diagonal(&[stiffness, walls.stiffness]),
        gravity: scene.gravity,
        drive: drive_of(scene, curve, &particles),
        particles,
        force_row: base.clone(),
        observed_rows: vec![base.clone()],
        momentum_rows: vec![base],
    })
}

fn particle(damper: &Damper, base: &[f64], top: &[f64]) -> Result<Particle, CompileError> {
    let ceiling = if damper.gap.is_finite() { Some(face(damper, &damper.ceiling, top)?) } else { None };
    let gap = if damper.gap.is_finite() { damper.gap } else { 0.0 };
    Ok(Particle { mass: damper.particle_mass, floor: face(damper, &damper.floor, base)?, ceiling, gap })
}

fn face(damper: &Damper, surface: &Surface, row: &[f64]) -> Result<Face, CompileError> {
    let law = match surface {
        Surface::Rigid { restitution } => Law::Rigid { restitution: *restitution },
        Surface::Resilient { stiffness, damping, ends } => {
            if damper.particle_mass <= 0.0 {
                return Err(CompileError::MasslessContact);
            }
            let damping = match damping {
                ContactDamping::Constant(value) => *value,
                // Renewed at every half cycle; the drive holds the curve.
                ContactDamping::EquivalentViscous(_) => 0.0,
            };
            let stop = damper.stop.map(|stop| Stop { length: stop.length, restitution: stop.restitution });
            Law::Resilient { stiffness: *stiffness, damping, no_tension: *ends == ContactEnd::ZeroForce, stop }
        }
    };
    Ok(Face { row: row.to_vec(), law })
}

/// The excitation, and the half cycles of the base under the first particle, if there is a curve that they are read by.
fn drive_of(scene: &Scene, curve: Option<Spline>, particles: &[Particle]) -> Drive {
    let base = particles.first().map(|first| first.floor.row.clone());
    let half_cycles = curve.zip(base).map(|(curve, base)| HalfCycles { curve, base });
    Drive { half_cycles, ..drive(&scene.excitation) }
}

/// Of equivalent viscous damping: all surfaces with a dashpot share it.
fn curve(scene: &Scene) -> Result<Option<Spline>, CompileError> {
    let (mut curves, mut has_constants) = (Vec::new(), false);
    for damper in &scene.dampers {
        let surfaces = [&damper.floor, &damper.ceiling];
        match surfaces.map(curve_of) {
            [Some(floor), Some(ceiling)] => curves.extend([floor, ceiling]),
            [None, None] => has_constants |= surfaces.iter().any(|it| matches!(it, Surface::Resilient { .. })),
            _ => return Err(CompileError::MixedDamping),
        }
    }
    let Some(curve) = curves.first() else { return Ok(None) };
    if has_constants {
        return Err(CompileError::MixedDamping);
    }
    if curves.iter().any(|other| other != curve) {
        return Err(CompileError::SeveralCurves);
    }
    let points: Vec<[f64; 2]> = curve.iter().map(|[x, damping]| [x * scene.g(), *damping]).collect();
    Spline::through(&points).ok_or(CompileError::DampingCurve).map(Some)
}

fn curve_of(surface: &Surface) -> Option<&Curve> {
    match surface {
        Surface::Resilient { damping: ContactDamping::EquivalentViscous(points), .. } => Some(points),
        _ => None,
    }
}

/// What an excitation is to the engine.
pub(crate) fn drive(excitation: &Excitation) -> Drive {
    let quiet =
        |period: f64, ticks: Vec<Tick>| Drive { period, ticks, repeats: true, harmonic: None, half_cycles: None };
    let once = |impulse: f64| vec![Tick { time: 0.0, impulse, level: 0.0 }];
    match *excitation {
        Excitation::SingleImpulse { impulse, cycle } => Drive { repeats: false, ..quiet(cycle, once(impulse)) },
        Excitation::ImpulseTrain { impulse, period } => quiet(period, once(impulse)),
        Excitation::Harmonic { force, angular_frequency } => Drive {
            harmonic: Some(Harmonic { force, angular_frequency, phase: 0.0 }),
            ..quiet(excitation.period(), once(0.0))
        },
        Excitation::PulseTrain { impulse, period, duration, shape: PulseShape::Rectangular } => {
            let mut ticks = vec![Tick { time: 0.0, impulse: 0.0, level: impulse / duration }];
            if duration < period {
                ticks.push(Tick { time: duration, impulse: 0.0, level: 0.0 });
            }
            quiet(period, ticks)
        }
        Excitation::PulseTrain { impulse, period, duration, shape: PulseShape::Binomial { impulses } } => {
            let weights = binomial(impulses);
            let spacing = duration / f64::from(impulses.max(1));
            let tick =
                |(i, weight): (usize, f64)| Tick { time: i as f64 * spacing, impulse: impulse * weight, level: 0.0 };
            quiet(period, weights.into_iter().enumerate().map(tick).collect())
        }
    }
}

/// C(n−1, i)/2^(n−1) for i = 0 … n−1: built from the middle outwards by ratios, so that nothing overflows.
fn binomial(n: u32) -> Vec<f64> {
    let n = n.max(1) as usize;
    let mut weights = vec![1.0; n];
    for i in 1..n {
        weights[i] = weights[i - 1] * (n - i) as f64 / i as f64;
        if weights[i] > 1e200 {
            weights[..=i].iter_mut().for_each(|weight| *weight *= 1e-200);
        }
    }
    let sum: f64 = weights.iter().sum();
    weights.iter_mut().for_each(|weight| *weight /= sum);
    weights
}
