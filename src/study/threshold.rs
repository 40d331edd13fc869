//! Lift-off in closed form: the strength of the drive below which every particle rests on its floor, once transients are gone.
//!
//! The motion with particles at rest is linear, so that one steady state gives the threshold of a whole curve (`dynamics::lift_off`).

use super::refine::number_of;
use crate::dynamics;
use crate::experiment::{Assumptions, Case, Experiment, Parameter, Threshold, by_strength};
use crate::measure::rounded;
use crate::scene::compile;

/// Points beside a threshold are off it by this share.
const BESIDE: f64 = 1e-3;

/// Where particles lift off along a strength of the drive: of several curves the least and the greatest place.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LiftOff {
    /// The strength.
    pub over: Parameter,
    /// The smallest at which a particle lifts off.
    pub least: f64,
    /// That of the curve on which particles rest longest.
    pub most: f64,
    /// Cases below their own.
    pub at_rest: usize,
}

/// Lift-off along the strengths that an experiment sweeps; nothing where particles never rest, and where none is swept.
#[must_use]
pub fn lift_offs(experiment: &Experiment, assumptions: &Assumptions) -> Vec<LiftOff> {
    let mut found: Vec<LiftOff> = Vec::new();
    for (over, cases) in by_strength(experiment) {
        let strongest = cases
            .iter()
            .map(|&case| &experiment.cases[case])
            .reduce(|strongest, case| if case.number(over) > strongest.number(over) { case } else { strongest });
        let Some(at) = strongest.and_then(|case| place(experiment, assumptions, case, over)) else { continue };
        let at_rest = cases.iter().filter(|&&case| experiment.cases[case].number(over).is_some_and(|x| x < at)).count();
        match found.iter_mut().find(|known| known.over == over) {
            Some(known) => {
                (known.least, known.most) = (known.least.min(at), known.most.max(at));
                known.at_rest += at_rest;
            }
            None => found.push(LiftOff { over, least: at, most: at, at_rest }),
        }
    }
    found
}

/// The cases on both sides of a threshold within the range of a curve, whose cases differ in this parameter alone.
pub(super) fn around(
    experiment: &Experiment,
    assumptions: &Assumptions,
    Threshold::LiftOff: Threshold,
    over: Parameter,
    curve: &[Case],
) -> Vec<Case> {
    let within = |value: f64| {
        let numbers = || curve.iter().filter_map(|case| case.number(over));
        numbers().any(|x| x < value) && numbers().any(|x| x > value)
    };
    let Some(strongest) = curve.iter().max_by(|a, b| number_of(a, over).total_cmp(&number_of(b, over))) else {
        return Vec::new();
    };
    let Some(at) = place(experiment, assumptions, strongest, over) else { return Vec::new() };
    let beside = [1.0 - BESIDE, 1.0 + BESIDE].map(|share| share * at).into_iter().filter(|value| within(*value));
    beside.map(|value| strongest.with(over, value)).collect()
}

/// The strength at which a particle lifts off, all else as in this case.
fn place(experiment: &Experiment, assumptions: &Assumptions, case: &Case, over: Parameter) -> Option<f64> {
    let recipe = experiment.recipe_of(case).ok()?;
    let scene = rounded(recipe.resolve(assumptions).ok()?, &experiment.settings);
    // Whatever keeps a case from being compiled fails as a row of the table, with its reason.
    let share = dynamics::lift_off(&compile(&scene).ok()?).ok()??;
    Some(share * case.number(over)?)
}
