//! A set of inputs: the value that each free input takes, and what that makes of the assumptions.

use crate::experiment::{AssumptionValue, Assumptions, Calibration, CalibrationInput, Tried};
use crate::measure::SolverChoice;

/// Substituted what experiments run.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Set {
    pub assumptions: Assumptions,
    /// In the place of the exact solver.
    pub solver: SolverChoice,
}

impl Set {
    pub(super) fn in_force(assumptions: &Assumptions) -> Self {
        Self { assumptions: assumptions.clone(), solver: SolverChoice::EventDriven }
    }

    /// The inputs in force with the value at `places[i]` for each free input i.
    pub(super) fn of(calibration: &Calibration, places: &[usize], in_force: &Assumptions) -> Self {
        let mut set = Self::in_force(in_force);
        let inputs = || calibration.inputs.iter().zip(places);
        for (input, &place) in inputs() {
            match &input.tried {
                Tried::Values { moves, values, .. } => {
                    set.assumptions.values.extend(moves.iter().cloned().zip(values[place].iter().cloned()));
                }
                Tried::Solvers(solvers) => set.solver = solvers[place],
                Tried::Factors { .. } => {}
            }
        }
        // What is scaled may have been set by another input.
        for (input, &place) in inputs() {
            if let Tried::Factors { of, by } = &input.tried
                && let Some(value) = set.assumptions.values.get_mut(of)
            {
                scale(value, by[place]);
            }
        }
        set
    }
}

/// A reading in words has no size.
fn scale(value: &mut AssumptionValue, factor: f64) {
    match value {
        AssumptionValue::Number(number) => *number *= factor,
        AssumptionValue::Curve(points) => points.iter_mut().for_each(|[_, y]| *y *= factor),
        AssumptionValue::Choice(_) | AssumptionValue::Places(_) => {}
    }
}

/// The place of the value in force; the first where that is not among those tried.
pub(super) fn place_in_force(input: &CalibrationInput, in_force: &Assumptions) -> usize {
    let place = match &input.tried {
        Tried::Values { moves, values, .. } => {
            let now: Vec<_> = moves.iter().map(|name| in_force.values.get(name)).collect();
            values.iter().position(|value| value.iter().map(Some).eq(now.iter().copied()))
        }
        Tried::Factors { by, .. } => by.iter().position(|factor| *factor == 1.0),
        Tried::Solvers(solvers) => solvers.iter().position(|solver| *solver == SolverChoice::EventDriven),
    };
    place.unwrap_or(0)
}
