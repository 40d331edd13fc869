//! What is to be said of an experiment before it runs: warnings of what may take long or fail, of averages
//! that begin too early, and of thresholds that get no points.

use std::time::Duration;

use cpu_time::ThreadTime;

use super::threshold::missed;
use crate::dynamics::{Allowance, Limit, Until};
use crate::experiment::{Assumptions, Case, Experiment};
use crate::measure::{Settings, SolverChoice};
use crate::scene::{Damper, Scene, Surface};
use crate::text::number::{compact, significant};
use crate::text::words::counted;

/// Fixed steps that take about a second.
const STEPS_A_SECOND: f64 = 3e7;
/// Time of a run that is worth a warning, s.
const LONG: f64 = 60.0;
/// Dampers whose contact states are no longer few.
const MANY_DAMPERS: usize = 12;
/// Coordinates of a structure beyond which a contact state takes seconds to set up.
const MANY_MODES: usize = 100;
/// Restitution from which on a particle takes very many bounces to come to rest.
const ELASTIC: f64 = 0.999;
/// Share of the free vibration that may be left where averages begin.
const LEFT: f64 = 0.01;
/// Processor time for which cases are looked at.
const PATIENCE: Duration = Duration::from_millis(300);

/// Warnings, each once, with the first case that it is about.
#[must_use]
pub fn forecast(experiment: &Experiment, assumptions: &Assumptions) -> Vec<String> {
    let limit = Limit { time: PATIENCE, ..Limit::default() };
    let missed = Allowance::new(limit).simulate(|| missed(experiment, assumptions, PATIENCE));
    of_scenes(experiment, assumptions)
        .into_iter()
        .map(|(_, warning)| warning)
        .chain(missed.into_iter().map(|(case, warning)| of_case(&case, warning)))
        .collect()
}

/// Those that a run begins with: what may never end, averages that begin too early, and dampers that do nothing.
#[must_use]
pub fn before_run(experiment: &Experiment, assumptions: &Assumptions) -> Vec<String> {
    let is_reported = |(cause, _): &(Cause, String)| matches!(cause, Cause::Bounces | Cause::Transient | Cause::Still);
    of_scenes(experiment, assumptions).into_iter().filter(is_reported).map(|(_, warning)| warning).collect()
}

/// Warnings of the scenes of an experiment, each once, with the first case that it is about; that of a transient with the case in which
/// it dies away most slowly.
fn of_scenes(experiment: &Experiment, assumptions: &Assumptions) -> Vec<(Cause, String)> {
    let begun = ThreadTime::now();
    let mut warnings: Vec<(Cause, String)> = Vec::new();
    let mut slowest: Option<(&Case, f64)> = None;
    for case in experiment.cases.iter().take_while(|_| begun.elapsed() <= PATIENCE) {
        let Some(scene) = experiment.first_scene(case, assumptions) else { continue };
        for (cause, warning) in of_scene(experiment, &scene, &case.solvers) {
            if warnings.iter().all(|(known, _)| *known != cause) {
                warnings.push((cause, of_case(case, warning)));
            }
        }
        if let Some(decay) = decay_a_cycle(experiment, &scene)
            && slowest.is_none_or(|(_, least)| decay < least)
        {
            slowest = Some((case, decay));
        }
    }
    let left = slowest.and_then(|(case, decay)| Some((case, transient(experiment.settings.skip, decay)?)));
    warnings.extend(left.map(|(case, warning)| (Cause::Transient, of_case(case, warning))));
    warnings
}

/// A warning with the case that it is about.
fn of_case(case: &Case, warning: String) -> String {
    let place = case.describe();
    if place.is_empty() { warning } else { format!("{warning} ({place})") }
}

/// Of what a warning is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Cause {
    Silence,
    Steps,
    Dampers,
    Still,
    Modes,
    Bounces,
    Transient,
    Damping,
}

fn of_scene(experiment: &Experiment, scene: &Scene, solvers: &[SolverChoice]) -> Vec<(Cause, String)> {
    let mut warnings = Vec::new();
    if scene.is_at_rest() && experiment.measures.iter().any(|measure| measure.needs_undamped()) {
        warnings.push((Cause::Silence, "the excitation is zero: nothing moves, and every ratio is undefined".into()));
    }
    let cycles = experiment.settings.averaged().end() as f64;
    for solver in solvers {
        let SolverChoice::FixedStep { time_step } = solver else { continue };
        let steps = cycles * scene.excitation.period() / time_step;
        let seconds = steps / STEPS_A_SECOND;
        if seconds > LONG {
            let (steps, minutes) = (significant(steps, 2), significant(seconds / 60.0, 2));
            warnings.push((Cause::Steps, format!("{steps} fixed steps take about {minutes} min a run")));
        }
    }
    warnings.extend(overdamped(scene).map(|warning| (Cause::Damping, warning)));
    let count = scene.dampers.len();
    if count >= MANY_DAMPERS {
        let warning = format!("{count} dampers can be in 2^{count} contact states, each set up at its first visit");
        warnings.push((Cause::Dampers, warning));
    }
    let modes = scene.structure.model().natural_frequencies().len();
    if modes >= MANY_MODES {
        warnings.push((Cause::Modes, format!("{modes} modes: each contact state takes seconds to set up")));
    }
    let stands_still = |damper: &Damper| !scene.structure.model().moves(damper.at);
    if let Some(number) = scene.dampers.iter().position(stands_still) {
        let warning = format!("damper {} stands where the structure does not move: it does nothing", number + 1);
        warnings.push((Cause::Still, warning));
    }
    for damper in &scene.dampers {
        if let Surface::Rigid { restitution } = damper.floor
            && restitution >= ELASTIC
        {
            let gap = if damper.gap.is_finite() { significant(damper.gap, 2) + " m" } else { "no end".into() };
            let warning = format!(
                "restitution {restitution} with a gap of {gap}: a particle that loses next to nothing may bounce without end"
            );
            warnings.push((Cause::Bounces, warning));
            break;
        }
    }
    warnings
}

/// c/(2 m) and k/m of the structure's first mode.
fn first_mode(scene: &Scene) -> [f64; 2] {
    let model = scene.structure.model();
    let (matrices, shape) = (model.matrices(), model.mode(1));
    let [mass, damping, stiffness] =
        [matrices.mass, matrices.damping, matrices.stiffness].map(|matrix| matrix.form(&shape, &shape));
    [damping / (2.0 * mass), stiffness / mass]
}

/// A damping ratio above 1 is seldom meant: 5 stands for 5 %.
fn overdamped(scene: &Scene) -> Option<String> {
    let [half, square] = first_mode(scene);
    let ratio = half / square.sqrt();
    (ratio.is_finite() && ratio > 1.0).then(|| {
        let [ratio, hundredth] = [ratio, ratio / 100.0].map(|ratio| compact(ratio, 3));
        format!("the damping ratio of the structure is {ratio}, above critical damping; {ratio} % is {hundredth}")
    })
}

/// How the first mode's free vibration dies away in a cycle of the drive without dampers, e^(−a t): a = c/(2 m), above critical damping
/// that of the slower exponential. `None` where nothing is averaged after it.
fn decay_a_cycle(experiment: &Experiment, scene: &Scene) -> Option<f64> {
    let Settings { skip, until, .. } = experiment.settings;
    let averages = !experiment.measures.iter().all(|measure| measure.is_modal());
    if skip == 0 || until == Until::Settled || scene.is_at_rest() || !averages {
        return None;
    }
    let [half, square] = first_mode(scene);
    let exponent = if half * half > square { square / (half + (half * half - square).sqrt()) } else { half };
    Some(exponent * scene.excitation.period())
}

/// What is left of a free vibration that dies away so in a cycle, where averages begin. These carry it along, and their uncertainty does
/// not know of it.
fn transient(skip: u32, decay: f64) -> Option<String> {
    let left = libm::exp(-decay * f64::from(skip));
    (left > LEFT).then(|| {
        let enough = (-libm::log(LEFT) / decay).ceil();
        let remedy = if enough <= f64::from(u32::MAX) {
            format!("`skip: {enough} cycles` leaves less than 1 %")
        } else {
            "next to nothing damps it".into()
        };
        format!(
            "after {}, {} % of the free vibration remains in the run without dampers, and is part of the averages; {remedy}",
            counted(skip as usize, "cycle", "cycles"),
            significant(100.0 * left, 2)
        )
    })
}
