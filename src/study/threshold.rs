//! Thresholds in closed form along a strength of the drive: where the first particle lifts off, once transients are gone, where a
//! motion with an impact on floor and ceiling a period begins, and where one with an impact on the floor alone touches the ceiling.
//!
//! The motions on one side of each are linear in the strength, so that one scene gives the threshold of a whole curve
//! (`dynamics::lift_off`, `two_impacts`, `ceiling_graze`).

use super::refine::number_of;
use crate::dynamics;
use crate::experiment::{Assumptions, Case, Experiment, Parameter, Threshold, by_strength};
use crate::measure::rounded;
use crate::scene::compile;

/// Points beside a threshold are off it by this share.
const BESIDE: f64 = 1e-3;

/// Where a threshold lies along a strength of the drive: of several curves the least and the greatest place.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ThresholdAlong {
    /// Of what.
    pub threshold: Threshold,
    /// The strength.
    pub over: Parameter,
    /// The smallest place.
    pub least: f64,
    /// The greatest.
    pub most: f64,
    /// Cases below that of their own curve.
    pub below: usize,
}

/// The thresholds along the strengths that an experiment sweeps, where they are known.
#[must_use]
pub fn thresholds(experiment: &Experiment, assumptions: &Assumptions) -> Vec<ThresholdAlong> {
    let mut found: Vec<ThresholdAlong> = Vec::new();
    for (over, cases) in by_strength(experiment) {
        let strongest = cases
            .iter()
            .map(|&case| &experiment.cases[case])
            .reduce(|strongest, case| if case.number(over) > strongest.number(over) { case } else { strongest });
        for &threshold in Threshold::ALL {
            let at = strongest.and_then(|case| place(experiment, assumptions, threshold, case, over));
            let Some(at) = at else { continue };
            let is_below = |case: &&usize| experiment.cases[**case].number(over).is_some_and(|x| x < at);
            let below = cases.iter().filter(is_below).count();
            match found.iter_mut().find(|known| (known.threshold, known.over) == (threshold, over)) {
                Some(known) => {
                    (known.least, known.most) = (known.least.min(at), known.most.max(at));
                    known.below += below;
                }
                None => found.push(ThresholdAlong { threshold, over, least: at, most: at, below }),
            }
        }
    }
    found
}

/// The cases on both sides of a threshold within the range of a curve, whose cases differ in this parameter alone.
pub(super) fn around(
    experiment: &Experiment,
    assumptions: &Assumptions,
    threshold: Threshold,
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
    let Some(at) = place(experiment, assumptions, threshold, strongest, over) else { return Vec::new() };
    let beside = [1.0 - BESIDE, 1.0 + BESIDE].map(|share| share * at).into_iter().filter(|value| within(*value));
    beside.map(|value| strongest.with(over, value)).collect()
}

/// The strength at a threshold, all else as in this case.
fn place(
    experiment: &Experiment,
    assumptions: &Assumptions,
    threshold: Threshold,
    case: &Case,
    over: Parameter,
) -> Option<f64> {
    let recipe = experiment.recipe_of(case).ok()?;
    let scene = rounded(recipe.resolve(assumptions).ok()?, &experiment.settings);
    // Whatever keeps a case from being compiled fails as a row of the table, with its reason.
    let system = compile(&scene).ok()?;
    let share = match threshold {
        Threshold::LiftOff => dynamics::lift_off(&system),
        Threshold::TwoImpacts => dynamics::two_impacts(&system),
        Threshold::CeilingGraze => dynamics::ceiling_graze(&system),
    };
    Some(share.ok()?? * case.number(over)?)
}
