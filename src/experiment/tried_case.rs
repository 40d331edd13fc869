//! Every case tried against physics, before anything runs.

use std::collections::BTreeSet;

use super::case::Case;
use super::check::Checks;
use super::definition::Experiment;
use super::recipe::{Parameter, ParameterValue, Part};
use super::refusal::{Meant, Places, Refusal};
use crate::dynamics::{EngineError, Until};
use crate::measure::{Measure, Settings, SolverChoice};
use crate::scene::Scene;

/// Most steps of one fixed-step run: some ten minutes.
const MOST_STEPS: f64 = 1e11;
/// Kinds of refusal that are told; more of them would hardly help.
const MOST_TOLD: usize = 5;

impl Checks<'_> {
    /// Resolves every case. A mistake is reported where the value that is refused is swept, or else where the scene has it.
    pub fn scenes(&self, experiment: &Experiment, places: &Places<'_>) {
        let mut met = BTreeSet::new();
        let tried: Vec<_> = experiment.cases.iter().map(|case| (case, self.scene(experiment, case))).collect();
        // A sweep may pass over a support: that row fails with this reason, and no other.
        let passes = tried.iter().any(|(_, tried)| tried.is_ok());
        for (case, tried) in tried {
            let Err(refusal) = tried else { continue };
            if passes && refusal.still && MOVE_THE_FORCE.iter().any(|parameter| case.get(*parameter).is_some()) {
                continue;
            }
            if met.insert(refusal.message.clone()) && met.len() <= MOST_TOLD {
                let description = case.describe();
                let message = if description.is_empty() {
                    refusal.message
                } else {
                    format!("{} (at {description})", refusal.message)
                };
                self.findings.wrong::<()>(places.of(&refusal.place, experiment, case), message);
            }
        }
    }

    fn scene(&self, experiment: &Experiment, case: &Case) -> Result<(), Refusal> {
        let recipe = experiment.recipe_of(case)?;
        // A maximisation is tried at both ends of its grid.
        let mut recipes = Vec::new();
        if let Some(maximise) = &experiment.maximise {
            for end in [maximise.grid.first(), maximise.grid.last()].into_iter().flatten() {
                let mut recipe = recipe.clone();
                recipe.set(maximise.over, ParameterValue::Number(*end))?;
                recipes.push(recipe);
            }
        }
        if let Some(orbit) = &experiment.orbit {
            let mut periods = Vec::new();
            for end in [orbit.from, orbit.to] {
                let mut recipe = recipe.clone();
                recipe.set(orbit.along, ParameterValue::Number(end))?;
                periods.push(recipe.resolve(self.assumptions)?.excitation.period());
                recipes.push(recipe);
            }
            if experiment.settings.round_period_to.is_some() && periods[0] != periods[1] {
                return Err(StepError::RoundsAlong.into());
            }
        }
        if recipes.is_empty() {
            recipes.push(recipe);
        }
        let mut all = Vec::new();
        for recipe in &recipes {
            all.extend(experiment.recipes_in(recipe)?);
        }
        for recipe in all {
            let scene = recipe.resolve(self.assumptions)?;
            steps(&scene, case, &experiment.settings)?;
            remembers(&scene, case, experiment)?;
            boxed(&scene, experiment)?;
        }
        Ok(())
    }
}

/// Parameters that move the force.
const MOVE_THE_FORCE: [Parameter; 3] = [Parameter::ForceX, Parameter::ForceY, Parameter::Place];

/// Why a run cannot go in steps.
#[derive(Debug, thiserror::Error)]
enum StepError {
    #[error("a forcing period of {period} s rounds to no step of {step} s at all")]
    RoundsToNone { period: f64, step: f64 },
    #[error("the forcing period changes along the branch, and `round_period_to` would make it jump: leave that out")]
    RoundsAlong,
    #[error("a time step of {time_step} s is longer than the forcing period of {period} s")]
    LongerThanPeriod { time_step: f64, period: f64 },
    #[error("a time step of {time_step} s makes more than {MOST_STEPS:e} steps a run")]
    TooMany { time_step: f64 },
}

impl From<StepError> for Refusal {
    fn from(error: StepError) -> Self {
        let key = match error {
            StepError::RoundsToNone { .. } | StepError::RoundsAlong => "round_period_to",
            StepError::LongerThanPeriod { .. } | StepError::TooMany { .. } => "solver",
        };
        Self { place: Meant::Run(key), ..error.to_string().into() }
    }
}

/// A run whose damping follows from the half cycle before has more to carry on than places and rates.
fn remembers(scene: &Scene, case: &Case, experiment: &Experiment) -> Result<(), Refusal> {
    if !scene.has_equivalent_viscous_damping() {
        return Ok(());
    }
    let needs_name = |measure: &Measure| measure.needs_motion() || measure.needs_settled();
    let is_named = experiment.settings.until == Until::Settled || experiment.measures.iter().any(needs_name);
    if is_named && case.solvers.contains(&SolverChoice::EventDriven) {
        return Err(EngineError::DampingWithMemory.to_string().into());
    }
    if case.direction.is_some() {
        let message =
            "equivalent viscous damping follows from the half cycle before, which `from: last` does not carry on";
        return Err(String::from(message).into());
    }
    Ok(())
}

/// The corners of a box of random starts are starts.
fn boxed(scene: &Scene, experiment: &Experiment) -> Result<(), Refusal> {
    let Some(starts) = &experiment.starts else { return Ok(()) };
    let refuse = |message: String| Refusal { message, place: Meant::whole(Part::Start), ..Refusal::default() };
    if starts.endless(scene).is_some() {
        return Err(refuse("a share of the gap clearance needs a ceiling, and this gap is infinite".into()));
    }
    for start in starts.corners(scene) {
        let scene = Scene { start: Some(start), ..scene.clone() };
        scene.check_start().map_err(|error| refuse(error.to_string()))?;
    }
    Ok(())
}

/// What a scene asks of the steps of its run.
fn steps(scene: &Scene, case: &Case, settings: &Settings) -> Result<(), StepError> {
    let period = scene.excitation.period();
    let in_a_period = |step: f64| (period / step).round();
    if let Some(step) = settings.round_period_to
        && in_a_period(step) < 1.0
    {
        return Err(StepError::RoundsToNone { period, step });
    }
    for solver in &case.solvers {
        let SolverChoice::FixedStep { time_step } = *solver else { continue };
        if in_a_period(time_step) < 1.0 {
            return Err(StepError::LongerThanPeriod { time_step, period });
        }
        let cycles = settings.averaged().end() as f64;
        if in_a_period(time_step) * cycles > MOST_STEPS {
            return Err(StepError::TooMany { time_step });
        }
    }
    Ok(())
}
