//! Thresholds in closed form along a strength of the drive: where the first particle lifts off, once transients are gone, where a
//! motion with an impact on floor and ceiling a period begins, and where one with an impact on the floor alone touches the ceiling.
//!
//! The motions on one side of each are linear in the strength, so that one scene gives the threshold of a whole curve
//! (`dynamics::lift_off`, `two_impacts`, `ceiling_graze`).

use std::time::Duration;

use cpu_time::ThreadTime;

use crate::dynamics;
use crate::experiment::{Assumptions, Case, Experiment, Parameter, Threshold, by_strength, curves};
use crate::measure::rounded;
use crate::scene::compile;
use crate::text::number::quantity;
use crate::text::words::of_key;

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
        let strongest = strongest(cases.iter().map(|&case| &experiment.cases[case]), over);
        for &threshold in Threshold::ALL {
            let at = strongest.and_then(|case| place(experiment, assumptions, threshold, case, over).ok()?);
            let Some(at) = at else { continue };
            let is_below = |case: &&usize| {
                experiment.cases[**case].number(over).is_some_and(|x| x * at >= 0.0 && x.abs() < at.abs())
            };
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

/// The curves that shall have points beside a threshold and get none, each threshold once: the first of them at its
/// greatest strength, and why. It looks for as long as `patience`, of processor time.
pub(super) fn missed(experiment: &Experiment, assumptions: &Assumptions, patience: Duration) -> Vec<(Case, String)> {
    let begun = ThreadTime::now();
    let mut told: Vec<(Threshold, Case, String)> = Vec::new();
    for curve in curves(&experiment.cases, &experiment.refined) {
        let cases: Vec<Case> = curve.cases.iter().map(|&case| experiment.cases[case].clone()).collect();
        let over = curve.rule.over;
        let Some((threshold, strongest)) = curve.rule.around.zip(strongest(cases.iter(), over)) else { continue };
        if begun.elapsed() > patience {
            break;
        }
        if told.iter().any(|(known, ..)| *known == threshold) {
            continue;
        }
        // A place that is not known yet may still be found.
        let Ok(at) = place(experiment, assumptions, threshold, strongest, over) else { continue };
        if at.is_some_and(|at| !beside(&cases, strongest, over, at).is_empty()) {
            continue;
        }
        let why = match at {
            Some(at) => {
                format!("its place, {} = {}, lies outside the range", of_key(&over), quantity(at, over.unit(), 4))
            }
            None => "this scene has no such place".into(),
        };
        let warning = format!("`around: {}` adds no points: {why}", of_key(&threshold));
        told.push((threshold, strongest.clone(), warning));
    }
    told.into_iter().map(|(_, case, warning)| (case, warning)).collect()
}

/// The case of a curve at its greatest strength.
fn strongest<'c>(curve: impl Iterator<Item = &'c Case>, over: Parameter) -> Option<&'c Case> {
    curve.max_by(|a, b| number_of(a, over).total_cmp(&number_of(b, over)))
}

/// The cases on both sides of a threshold within the range of a curve, whose cases differ in this parameter alone.
pub(super) fn around(
    experiment: &Experiment,
    assumptions: &Assumptions,
    threshold: Threshold,
    over: Parameter,
    curve: &[Case],
) -> Vec<Case> {
    let Some(strongest) = strongest(curve.iter(), over) else { return Vec::new() };
    let Ok(Some(at)) = place(experiment, assumptions, threshold, strongest, over) else { return Vec::new() };
    beside(curve, strongest, over, at)
}

/// A case of a curve moved to both sides of a place, as far as they lie within the range of the curve.
fn beside(curve: &[Case], case: &Case, over: Parameter, at: f64) -> Vec<Case> {
    let within = |value: f64| {
        let numbers = || curve.iter().filter_map(|case| case.number(over));
        numbers().any(|x| x < value) && numbers().any(|x| x > value)
    };
    let sides = [1.0 - BESIDE, 1.0 + BESIDE].map(|share| share * at).into_iter().filter(|value| within(*value));
    sides.map(|value| case.with(over, value)).collect()
}

/// Whatever keeps a case from being looked at fails as a row of the table, with its reason.
struct NotKnown;

/// The strength at a threshold, all else as in this case; `None` where there is no such place.
fn place(
    experiment: &Experiment,
    assumptions: &Assumptions,
    threshold: Threshold,
    case: &Case,
    over: Parameter,
) -> Result<Option<f64>, NotKnown> {
    let strength = case.number(over).ok_or(NotKnown)?;
    let recipe = experiment.recipe_of(case).map_err(|_| NotKnown)?;
    let scene = rounded(recipe.resolve(assumptions).map_err(|_| NotKnown)?, &experiment.settings);
    let system = compile(&scene).map_err(|_| NotKnown)?;
    let share = match threshold {
        Threshold::LiftOff => dynamics::lift_off(&system),
        Threshold::TwoImpacts => dynamics::two_impacts(&system),
        Threshold::CeilingGraze => dynamics::ceiling_graze(&system),
    };
    Ok(share.map_err(|_| NotKnown)?.map(|share| share * strength))
}

/// The value of a parameter; NaN where it is a word.
pub(super) fn number_of(case: &Case, parameter: Parameter) -> f64 {
    case.number(parameter).unwrap_or(f64::NAN)
}
