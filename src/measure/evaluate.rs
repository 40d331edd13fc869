//! A scene simulated and measured: once, or again and again with other gaps.

use std::f64::consts::TAU;
use std::sync::Arc;

use super::case::Case;
use super::reading::Reading;
use super::references::References;
use super::shape;
use super::undefined::in_range;
use super::{EvaluateError, Evaluated, Measure, Rigour, Subject};
use crate::dynamics::HybridSystem;
use crate::measure::{Request, Settings, SolverChoice};
use crate::scene::{Excitation, Scene, compile};

/// A scene that is ready to be run with other gaps: resolved, compiled and compared with the clean structure once.
#[derive(Debug)]
pub struct Prepared<'a> {
    subject: Subject,
    pub(super) settings: Settings,
    pub(super) measures: &'a [Measure],
    solver: SolverChoice,
    system: HybridSystem,
    reference: Arc<References>,
    /// The gap of each damper, m, that is one in the word by which gaps are given.
    units: Vec<f64>,
}

impl<'a> Prepared<'a> {
    /// Gets a scene ready whose gaps are one each, in the word by which gaps will be given.
    ///
    /// # Errors
    /// [`EvaluateError`] with the reason.
    pub fn new(
        subject: Subject,
        solver: SolverChoice,
        settings: Settings,
        measures: &'a [Measure],
    ) -> Result<Self, EvaluateError> {
        let subject = rounded_subject(subject, &settings);
        let system = compile(&subject.scene)?;
        let request = Request { measures, rigour: Rigour::Look, ..Request::default() };
        let reference = References::of(&subject, &request, &settings, solver)?;
        let units = subject.scene.dampers.iter().map(|damper| damper.gap).collect();
        Ok(Self { subject, settings, measures, solver, system, reference, units })
    }

    /// Runs it with these gaps; sequential and deterministic as [`evaluate`].
    ///
    /// # Errors
    /// [`EvaluateError`] with the reason.
    pub fn evaluate(&self, gaps: &[f64], rigour: Rigour) -> Result<Evaluated, EvaluateError> {
        let (scene, system) = self.with_gaps(gaps);
        let request = Request { measures: self.measures, rigour, ..Request::default() };
        let Self { subject, settings, .. } = self;
        let case = Case { subject, settings, request: &request, scene: &scene };
        in_range(&scene, settings.average, self.measures, case.run(&system, &self.reference, self.solver)?)
    }

    pub(super) fn with_gaps(&self, gaps: &[f64]) -> (Scene, HybridSystem) {
        let (mut scene, mut system) = (self.subject.scene.clone(), self.system.clone());
        for (i, (gap, unit)) in gaps.iter().zip(&self.units).enumerate() {
            scene.dampers[i].gap = gap * unit;
            system.particles[i].gap = gap * unit;
        }
        (scene, system)
    }

    /// RMS velocity of the structure without dampers, where something is compared with it.
    pub(super) fn undamped_rms_velocity(&self) -> Option<f64> {
        let run = self.reference.of_cycles.as_ref()?;
        Some(Reading::of_run(&self.subject.scene, run).rms_velocity(run))
    }
}

/// Simulates one case and measures it. Sequential and deterministic: the same input gives the same bits on any machine.
///
/// # Errors
/// [`EvaluateError`] with the reason.
pub fn evaluate(
    subject: Subject,
    solver: SolverChoice,
    settings: &Settings,
    request: &Request<'_>,
) -> Result<Evaluated, EvaluateError> {
    let subject = rounded_subject(subject, settings);
    let case = Case { subject: &subject, settings, request, scene: &subject.scene };
    if !request.needs_run() {
        return case.without_run();
    }
    let mut system = compile(&subject.scene)?;
    if request.deflection().is_some() {
        shape::watch_products(&mut system);
    }
    let reference = References::of(&subject, request, settings, solver)?;
    in_range(&subject.scene, settings.average, request.measures, case.run(&system, &reference, solver)?)
}

pub(super) fn rounded_subject(subject: Subject, settings: &Settings) -> Subject {
    let undamped = subject.undamped.map(|scene| rounded(scene, settings));
    Subject { scene: rounded(subject.scene, settings), undamped, ..subject }
}

/// The forcing period rounded to whole steps, if the experiment asks for it.
pub fn rounded(mut scene: Scene, settings: &Settings) -> Scene {
    let Some(step) = settings.round_period_to else { return scene };
    let round = |period: f64| (period / step).round().max(1.0) * step;
    match &mut scene.excitation {
        Excitation::SingleImpulse { cycle: period, .. }
        | Excitation::ImpulseTrain { period, .. }
        | Excitation::PulseTrain { period, .. } => *period = round(*period),
        Excitation::Harmonic { angular_frequency, .. } => *angular_frequency = TAU / round(TAU / *angular_frequency),
    }
    scene
}
