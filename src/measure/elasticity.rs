//! Elasticities: by how many per cent the velocity ratio of a periodic motion changes for one per cent of a design parameter.
//!
//! d ln ψ/d ln p = d ln v₀/d ln p − d ln v/d ln p,   v the RMS velocity with dampers, v₀ without
//!
//! v₀ is proportional to the force, and depends on the particles' mass where the run without dampers carries it.

use super::reading::Reading;
use super::{EvaluateError, Measured, Subject, Tolerance};
use crate::dynamics::{Elasticity, ElasticityError, EngineError, HybridSystem, Orbit, OrbitError, StartState};
use crate::scene::{CompileError, Design, Scene, Structure, compile};

/// Why a row has no elasticity. A table keeps it as the numerical error of the number that is not there.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Absent {
    /// The run goes on to no periodic motion.
    NotSettled,
    /// The scene has no such parameter.
    NoParameter,
    /// The derivative does not exist.
    NotSmooth,
}

impl Absent {
    /// What a table keeps.
    pub(super) fn measured(self) -> Measured {
        let numerical = match self {
            Self::NotSettled => f64::NAN,
            Self::NoParameter => 0.0,
            Self::NotSmooth => f64::INFINITY,
        };
        Measured { value: f64::NAN, numerical, spread: 0.0 }
    }

    /// Of what a table keeps.
    pub(super) fn of(measured: &Measured) -> Self {
        match measured.numerical {
            0.0 => Self::NoParameter,
            error if error.is_nan() => Self::NotSettled,
            _ => Self::NotSmooth,
        }
    }

    pub(super) fn why(self) -> &'static str {
        match self {
            Self::NotSettled => "the motion does not settle",
            Self::NoParameter => "the scene has no such parameter, or one of zero",
            Self::NotSmooth => {
                "at this value a contact begins or ends, or the motion turns back: there is no derivative"
            }
        }
    }
}

/// The elasticity of the velocity ratio of an orbit of the subject's scene.
pub(super) fn of(subject: &Subject, orbit: &Orbit, design: Design) -> Result<Measured, EvaluateError> {
    let Some(own) = of_scaled(&subject.scene, orbit, |factor| subject.scene.scaled(design, factor))? else {
        return Ok(Absent::NoParameter.measured());
    };
    let reference = match subject.undamped.as_ref() {
        Some(bare) if reference(subject, bare, design, 2.0).is_some() => {
            match Orbit::near(&compile(bare)?, &StartState::StaticEquilibrium, 1) {
                Ok(orbit) => of_scaled(bare, &orbit, |factor| reference(subject, bare, design, factor))?,
                Err(error) => Some(Err(refused(error)?)),
            }
        }
        _ => None,
    };
    let unchanged = Elasticity { value: 0.0, error: 0.0 };
    Ok(match (own, reference.unwrap_or(Ok(unchanged))) {
        (Ok(own), Ok(reference)) => {
            Measured { value: reference.value - own.value, numerical: reference.error + own.error, spread: 0.0 }
        }
        (Err(absent), _) | (_, Err(absent)) => absent.measured(),
    })
}

/// What the tolerances of parameters leave of a velocity ratio, as a standard uncertainty: u = ψ √Σ (u_p d ln ψ/d ln p)². A parameter that
/// the scene does not have leaves nothing.
pub(super) fn left_by(
    tolerances: &[Tolerance],
    velocity_ratio: f64,
    mut elasticity_in: impl FnMut(Design) -> Result<Measured, EvaluateError>,
) -> Result<Measured, EvaluateError> {
    let (mut sum, mut error) = (0.0, 0.0);
    for Tolerance { of, share } in tolerances {
        let elasticity = elasticity_in(*of)?;
        if elasticity.value.is_nan() {
            match Absent::of(&elasticity) {
                Absent::NoParameter => continue,
                absent => return Ok(absent.measured()),
            }
        }
        let left = share * elasticity.value;
        sum += left * left;
        error += share * elasticity.numerical;
    }
    Ok(Measured { value: velocity_ratio * sum.sqrt(), numerical: velocity_ratio * error, spread: 0.0 })
}

/// The scene without dampers, where it changes with the parameter; one mass that is heavier without dampers carries the particles.
fn reference(subject: &Subject, bare: &Scene, design: Design, factor: f64) -> Option<Scene> {
    match design {
        Design::Force => bare.scaled(design, factor),
        Design::ParticleMass => {
            let mut scaled = bare.clone();
            let (Structure::SingleMass(base), Structure::SingleMass(own)) =
                (&mut scaled.structure, &subject.scene.structure)
            else {
                return None;
            };
            let particles: f64 = subject.scene.dampers.iter().map(|damper| damper.particle_mass).sum();
            let is_loaded = base.mass > own.mass;
            base.mass += (factor - 1.0) * particles;
            is_loaded.then_some(scaled)
        }
        Design::Gap | Design::Stiffness | Design::Damping => None,
    }
}

/// d ln v/d ln p; `None` where the scene does not change with the parameter.
fn of_scaled(
    scene: &Scene,
    orbit: &Orbit,
    scaled: impl Fn(f64) -> Option<Scene>,
) -> Result<Option<Result<Elasticity, Absent>>, EvaluateError> {
    if scaled(1.0).is_none() {
        return Ok(None);
    }
    let system_at = |factor: f64| compile(&scaled(factor).unwrap_or_else(|| scene.clone()));
    of_rms_velocity(scene, orbit, system_at).map(Some)
}

/// d ln v/d ln p for the parameter by whose factor a system is given.
pub(super) fn of_rms_velocity(
    scene: &Scene,
    orbit: &Orbit,
    system_at: impl FnMut(f64) -> Result<HybridSystem, CompileError>,
) -> Result<Result<Elasticity, Absent>, EvaluateError> {
    Ok(match orbit.elasticity(system_at, |run| Reading::of_run(scene, run).rms_velocity(run)) {
        Ok(elasticity) => Ok(elasticity),
        Err(ElasticityError::System(error)) => return Err(error.into()),
        Err(ElasticityError::Orbit(error)) => Err(refused(error)?),
        Err(ElasticityError::Graze { .. } | ElasticityError::Fold { .. } | ElasticityError::Zero) => {
            Err(Absent::NotSmooth)
        }
    })
}

/// A run that came to an end of its time is tried again with more; any other refusal is a result.
fn refused(error: OrbitError) -> Result<Absent, EvaluateError> {
    match error {
        OrbitError::Engine(overrun @ EngineError::Overrun(_)) => Err(overrun.into()),
        _ => Ok(Absent::NotSmooth),
    }
}
