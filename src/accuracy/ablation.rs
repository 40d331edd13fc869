//! Ablation: a case with one effect switched at a time, what that does to the result, to the events, and to the time it takes.

use std::time::Duration;

use super::no_accuracy::NoAccuracy;
use super::representative::{is_chaotic, representative, trial, worst};
use super::timing::Times;
use crate::dynamics::{
    Allowance, EngineError, FarSurface, HybridSystem, Method, Options, OutOfReach, Response, event_driven, is_linear,
    out_of_reach,
};
use crate::experiment::{Assumptions, Experiment, Given, Parameter, ParameterValue, Recipe, Slot, StopRecipe};
use crate::measure::{Measure, Settings, Trial};
use crate::scene::{EffectUse, LimitStop, Scene, Switching, compile, effects, switched};

/// How long the median of a run may take to settle.
const PATIENCE: Duration = Duration::from_millis(500);

/// What only particles that leave their floors can meet.
const OF_FLIGHT: [&str; 5] =
    ["ceiling", "limit stop", "contact without tension", "restitution", "equivalent viscous damping"];

/// One case with each effect switched.
#[derive(Debug, Clone, PartialEq)]
pub struct Ablation {
    /// The case in words.
    pub description: String,
    /// It is chaotic: changes of its measures are no more than that.
    pub chaotic: bool,
    /// It is proved that no particle leaves its floor: the run is in closed form.
    pub closed_form: bool,
    /// Events of the case as it is.
    pub events: u64,
    /// Its times.
    pub times: Times,
    /// Effect by effect.
    pub switched: Vec<Switched>,
}

/// One effect.
#[derive(Debug, Clone, PartialEq)]
pub struct Switched {
    /// Its name.
    pub effect: &'static str,
    /// Whether the scene has it.
    pub in_force: bool,
    /// What came of switching it.
    pub outcome: Outcome,
}

/// Why an effect that a scene has never acts.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Idle {
    /// No particle leaves its floor.
    OnFloors,
    /// Its energy does not take a particle there: the surface that is nearest to be reached.
    OutOfReach(OutOfReach),
}

/// What came of switching an effect.
#[derive(Debug, Clone, PartialEq)]
pub enum Outcome {
    /// It was switched.
    Changed {
        /// Largest relative change of the measures.
        change: f64,
        /// Of which.
        worst: Measure,
        /// Events without it, or with it.
        events: u64,
        /// Times without it, or with it.
        times: Times,
    },
    /// The scene has it, but it is proved that it never acts: the run skips it.
    Idle(Idle),
    /// It was not switched, and why.
    Not(String),
}

/// Switches every effect in a few cases that stand for the experiment; all runs of a case together keep to the limit of a row.
///
/// # Errors
/// [`NoAccuracy`] if a case as it is does not run.
pub fn ablation(experiment: &Experiment, assumptions: &Assumptions) -> Result<Vec<Ablation>, NoAccuracy> {
    if experiment.optimise.is_some() {
        return Err(NoAccuracy::Optimisation);
    }
    let within = || Allowance::new(experiment.limit);
    let cases = within().simulate(|| representative(experiment, assumptions))?;
    if cases.is_empty() {
        return Err(NoAccuracy::Nothing);
    }
    let case = |(description, recipe): (String, Recipe)| {
        within().simulate(|| case(description, &recipe, experiment, assumptions))
    };
    cases.into_iter().map(case).collect()
}

/// Of an effect all of whose surfaces are out of reach, the one that is nearest to be reached.
fn nearest(effect: &str, system: &HybridSystem, far: &[OutOfReach]) -> Option<OutOfReach> {
    let ceilings = || system.particles.iter().filter_map(|particle| particle.ceiling.as_ref());
    let all = match effect {
        "ceiling" => ceilings().count(),
        "limit stop" => {
            let floors = system.particles.iter().map(|particle| &particle.floor);
            floors.chain(ceilings()).filter(|face| face.law.stop().is_some()).count()
        }
        _ => return None,
    };
    let own = |far: &&OutOfReach| (far.surface == FarSurface::Ceiling) == (effect == "ceiling");
    let margin = |far: &OutOfReach| far.distance / far.reach;
    let found: Vec<&OutOfReach> = far.iter().filter(own).collect();
    let least = found.iter().copied().min_by(|a, b| margin(a).total_cmp(&margin(b)))?;
    (found.len() == all).then_some(*least)
}

/// How many scenes have a particle of which it is proved that it never leaves its floor.
#[must_use]
pub fn idle_cases(experiment: &Experiment, scenes: &[Scene]) -> usize {
    let Settings { skip, average, .. } = experiment.settings;
    let options = Options { skip, average, ..Options::default() };
    let proved = |scene: &&Scene| {
        let linear = |system| is_linear(&system, &options).unwrap_or_default();
        !scene.dampers.is_empty() && compile(scene).is_ok_and(linear)
    };
    scenes.iter().filter(proved).count()
}

/// How many scenes have ceilings or limit stops that their energy does not take a particle to, and the nearest to be reached.
#[must_use]
pub fn unreached_cases(experiment: &Experiment, scenes: &[Scene]) -> Vec<(&'static str, usize, OutOfReach)> {
    let Settings { skip, average, until, .. } = experiment.settings;
    let mut found: Vec<(&'static str, usize, OutOfReach)> = Vec::new();
    for scene in scenes {
        let Ok(system) = compile(scene) else { continue };
        let options = Options { skip, average, until, start: scene.start_state(), ..Options::default() };
        let far = out_of_reach(&system, &options);
        for effect in ["ceiling", "limit stop"] {
            let Some(near) = nearest(effect, &system, &far) else { continue };
            match found.iter_mut().find(|(name, ..)| *name == effect) {
                Some((_, count, nearest)) => {
                    *count += 1;
                    if near.distance / near.reach < nearest.distance / nearest.reach {
                        *nearest = near;
                    }
                }
                None => found.push((effect, 1, near)),
            }
        }
    }
    found
}

fn case(
    description: String,
    recipe: &Recipe,
    experiment: &Experiment,
    assumptions: &Assumptions,
) -> Result<Ablation, NoAccuracy> {
    let trial = trial(recipe, experiment, assumptions)?;
    let limit_stop = usual_stop(recipe, assumptions);
    let own = event_driven(&trial.system, &trial.options)?;
    let bare = event_driven(&trial.undamped, &trial.undamped_options)?;
    let base = Base { values: trial.read(&own, &bare)?, trial: &trial, bare: &bare };
    let closed_form = own.method == Method::ClosedForm;
    let far = out_of_reach(&trial.system, &trial.options);
    let idle = |name: &str| match nearest(name, &trial.system, &far) {
        _ if closed_form && OF_FLIGHT.contains(&name) => Some(Idle::OnFloors),
        nearest => nearest.map(Idle::OutOfReach),
    };
    let outcome = |EffectUse { name, in_force, why_not, .. }: &EffectUse| match (*name, idle(name)) {
        (_, Some(idle)) if *in_force > 0 => Outcome::Idle(idle),
        ("structural damping", _) if *in_force > 0 => base.undamped(),
        ("further modes", _) if *in_force > 0 => base.one_mode(recipe, experiment, assumptions),
        (name, _) => match switched(&trial.scene, name, limit_stop) {
            Switching::Not(_) if *in_force == 0 => Outcome::Not((*why_not).into()),
            Switching::Not(why) => Outcome::Not(why.into()),
            Switching::Off(scene) | Switching::On(scene) => match compile(&scene) {
                Ok(system) => {
                    let options = Options { start: scene.start_state(), ..trial.options.clone() };
                    base.with(Instead { system: &system, options: &options, trial: &trial }, &bare)
                }
                Err(error) => Outcome::Not(error.to_string()),
            },
        },
    };
    let used = effects(std::slice::from_ref(&trial.scene));
    let switched = used.iter().map(|of| Switched { effect: of.name, in_force: of.in_force > 0, outcome: outcome(of) });
    Ok(Ablation {
        description,
        chaotic: is_chaotic(&trial, &own, &bare)?,
        closed_form,
        events: own.proof.events,
        times: times(&trial.system, &trial.options),
        switched: switched.collect(),
    })
}

/// The limit stop that the study's assumptions give to a scene without one.
fn usual_stop(recipe: &Recipe, assumptions: &Assumptions) -> Option<LimitStop> {
    let kind = recipe.structure.kind().ok()?;
    let by_default = |slot| assumptions.sheet.default_of(slot, kind.name).cloned().map(Given::Assumed);
    let stop = StopRecipe { length: by_default(Slot::StopLength)?, restitution: by_default(Slot::StopRestitution)? };
    stop.resolve(assumptions).ok()
}

/// What takes the place of a case: another system, with its start and what reads its measures.
#[derive(Clone, Copy)]
struct Instead<'a> {
    system: &'a HybridSystem,
    options: &'a Options,
    trial: &'a Trial<'a>,
}

/// The case as it is.
struct Base<'a> {
    trial: &'a Trial<'a>,
    bare: &'a Response,
    values: Vec<f64>,
}

impl Base<'_> {
    /// The case with another system in its place.
    fn with(&self, instead: Instead<'_>, bare: &Response) -> Outcome {
        let Instead { system, options, trial } = instead;
        let run = || -> Result<(u64, Vec<f64>), NoAccuracy> {
            let response = event_driven(system, options)?;
            Ok((response.proof.events, trial.read(&response, bare)?))
        };
        match run() {
            Err(error) => Outcome::Not(error.to_string()),
            Ok((events, values)) => {
                let (worst, change) = worst(&self.trial.measures, &values, &self.values);
                Outcome::Changed { change, worst, events, times: times(system, options) }
            }
        }
    }

    /// Without the structure's dashpots, with dampers and without.
    fn undamped(&self) -> Outcome {
        let still = |system: &HybridSystem| {
            let mut system = system.clone();
            system.damping.entries.fill(0.0);
            system
        };
        let trial = self.trial;
        let system = still(&trial.system);
        let instead = Instead { system: &system, options: &trial.options, trial };
        match event_driven(&still(&trial.undamped), &trial.undamped_options) {
            Ok(bare) => self.with(instead, &bare),
            Err(error @ EngineError::UndampedResonance { .. }) => Outcome::Not(error.to_string()),
            Err(_) => self.with(instead, self.bare),
        }
    }

    /// With the first mode alone.
    fn one_mode(&self, recipe: &Recipe, experiment: &Experiment, assumptions: &Assumptions) -> Outcome {
        let mut recipe = recipe.clone();
        let other = recipe
            .set(Parameter::Modes, ParameterValue::Number(1.0))
            .map_err(|error| error.to_string())
            .and_then(|()| trial(&recipe, experiment, assumptions).map_err(|error| error.to_string()));
        match other {
            Err(error) => Outcome::Not(error),
            Ok(other) => match event_driven(&other.undamped, &other.undamped_options) {
                Ok(bare) => self.with(Instead { system: &other.system, options: &other.options, trial: &other }, &bare),
                Err(error) => Outcome::Not(error.to_string()),
            },
        }
    }
}

/// How long a run takes.
fn times(system: &HybridSystem, options: &Options) -> Times {
    Times::of(|| drop(std::hint::black_box(event_driven(system, options))), PATIENCE)
}
