//! Cases that stand for an experiment, and whether their motion is chaotic.

use super::no_accuracy::NoAccuracy;
use crate::dynamics::{Method, Options, Response, event_driven};
use crate::experiment::{Assumptions, Case, Experiment, ParameterValue, Recipe};
use crate::measure::{Measure, Needs, SolverChoice, Trial};
use crate::text::words;

/// Cases of an experiment.
const CASES: usize = 3;
/// Kick that tells chaos from order, and how far it may have grown.
pub(super) const TWIN: [f64; 2] = [1e-9, 1e-6];
/// Perturbed starts, and the largest kick, that the floor of a chaotic case is taken from.
const MEMBERS: u32 = 8;
const KICK: f64 = 1e-6;

/// A few cases of an experiment that stand for all of it, with dampers: of each third of its sweep the first one that has
/// events and is not chaotic, tried from the middle outwards, or else the one in the middle.
///
/// # Errors
/// [`NoAccuracy`] if a case that is tried does not run.
pub fn representative(experiment: &Experiment, assumptions: &Assumptions) -> Result<Vec<(String, Recipe)>, NoAccuracy> {
    let simulated = |case: &&Case| case.solvers.contains(&SolverChoice::EventDriven);
    let mut cases: Vec<&Case> = experiment.cases.iter().filter(simulated).collect();
    if cases.is_empty() {
        cases = experiment.cases.iter().collect();
    }
    let damped: Vec<(String, Recipe)> =
        cases.into_iter().filter_map(|case| ready(experiment, case, assumptions)).collect();
    let mut chosen: Vec<(String, Recipe)> = Vec::new();
    for third in 0..CASES {
        let ends = [third, third + 1].map(|end| end * damped.len() / CASES);
        let part = &damped[ends[0]..ends[1]];
        let mut wanted = part.get(part.len() / 2);
        for eighth in [4, 2, 6, 3, 5, 1, 7] {
            // One further in each third, so that what changes from row to row does not always stand the same way.
            let Some(candidate) = part.get(eighth * part.len() / 8 + third) else { continue };
            let trial = trial(&candidate.1, experiment, assumptions)?;
            let own = event_driven(&trial.system, &trial.options)?;
            let bare = event_driven(&trial.undamped, &trial.undamped_options)?;
            if own.proof.events > 0 && !is_chaotic(&trial, &own, &bare)? {
                wanted = Some(candidate);
                break;
            }
        }
        chosen.extend(wanted.cloned());
    }
    Ok(chosen)
}

/// A case ready to be run with dampers and without.
pub(super) fn trial<'a>(
    recipe: &Recipe,
    experiment: &'a Experiment,
    assumptions: &Assumptions,
) -> Result<Trial<'a>, NoAccuracy> {
    let needs = Needs { undamped: true, ..Needs::of(&experiment.measures, false) };
    Ok(Trial::new(recipe.subject(assumptions, needs)?, &experiment.settings, &experiment.measures)?)
}

/// A case with its scene, if that has dampers and something moves them.
fn ready(experiment: &Experiment, case: &Case, assumptions: &Assumptions) -> Option<(String, Recipe)> {
    let mut recipe = experiment.recipes_of(case).ok()?.into_iter().next()?;
    let mut description = case.describe();
    if let Some(maximise) = &experiment.maximise {
        let value = *maximise.grid.get(maximise.grid.len() / 2)?;
        recipe.set(maximise.over, ParameterValue::Number(value)).ok()?;
        let over = format!("{} = {value}", words::of_key(&maximise.over));
        description = if description.is_empty() { over } else { format!("{description}, {over}") };
    }
    let scene = recipe.resolve(assumptions).ok()?;
    let moves = scene.start.is_some() || !scene.excitation.is_silent();
    (moves && !scene.dampers.is_empty()).then_some((description, recipe))
}

/// The largest relative error and its measure.
pub(super) fn worst(measures: &[Measure], values: &[f64], truth: &[f64]) -> (Measure, f64) {
    let errors = measures.iter().zip(values).zip(truth).map(|((measure, value), truth)| {
        let scale = if *truth == 0.0 { 1.0 } else { truth.abs() };
        let error = (value - truth).abs() / scale;
        (*measure, error)
    });
    errors.fold((Measure::RmsVelocity, 0.0), |worst, one| if one.1 >= worst.1 || one.1.is_nan() { one } else { worst })
}

/// A twin that was kicked a little ends elsewhere.
pub(super) fn is_chaotic(trial: &Trial<'_>, own: &Response, bare: &Response) -> Result<bool, NoAccuracy> {
    if own.method == Method::ClosedForm {
        return Ok(false);
    }
    let twin = event_driven(&trial.system, &Options { kick: TWIN[0], ..trial.options.clone() })?;
    let (_, moved) = worst(&trial.measures, &trial.read(&twin, bare)?, &trial.read(own, bare)?);
    Ok(moved.is_nan() || moved >= TWIN[1])
}

/// Spread over perturbed starts, where the motion is chaotic.
pub(super) fn floor(trial: &Trial<'_>, own: &Response, bare: &Response) -> Result<Option<f64>, NoAccuracy> {
    if !is_chaotic(trial, own, bare)? {
        return Ok(None);
    }
    let kicked = |kick: f64| -> Result<Vec<f64>, NoAccuracy> {
        let response = event_driven(&trial.system, &Options { kick, ..trial.options.clone() })?;
        Ok(trial.read(&response, bare)?)
    };
    let still = trial.read(own, bare)?;
    let mut rows = vec![still.clone()];
    for member in 0..MEMBERS {
        rows.push(kicked(KICK * ((f64::from(member) + 0.5) / f64::from(MEMBERS) * 2.0 - 1.0))?);
    }
    let spread = |i: usize| {
        let count = rows.len() as f64;
        let mean = rows.iter().map(|row| row[i]).sum::<f64>() / count;
        let square = rows.iter().map(|row| (row[i] - mean) * (row[i] - mean)).sum::<f64>() / (count - 1.0);
        square.sqrt() / mean.abs()
    };
    Ok(Some((0..still.len()).map(spread).fold(0.0, f64::max)))
}
