//! Values of assumptions, and of inputs that a calibration tries, as a reader meets them.

use super::calibration_input::Tried;
use super::recipe::AssumptionValue;
use crate::measure::SolverChoice;
use crate::text::{number, words};

/// The value of an assumption of this unit: `60 mm`, `9.81 m/s²`, `loaded`, a curve by its end points.
#[must_use]
pub fn value_in_words(unit: &str, value: &AssumptionValue) -> String {
    match value {
        AssumptionValue::Number(value) => number::quantity(*value, unit, 6),
        AssumptionValue::Choice(word) => word.replace('_', " "),
        AssumptionValue::Curve(points) => match (points.first(), points.last()) {
            (Some([x0, y0]), Some([x1, y1])) => {
                let point = |x: f64, y: f64| format!("{} at {} g", number::quantity(y, unit, 4), number::compact(x, 4));
                format!("a curve through {} points, {} to {}", points.len(), point(*x0, *y0), point(*x1, *y1))
            }
            _ => "a curve without points".to_owned(),
        },
        AssumptionValue::Places(places) => {
            let coordinate = |share: &f64| number::compact(*share, 4);
            let place = |place: &Vec<f64>| format!("({})", place.iter().map(coordinate).collect::<Vec<_>>().join(", "));
            places.iter().map(place).collect::<Vec<_>>().join(", ")
        }
    }
}

impl Tried {
    /// One of the values, in words. Curves that end alike are named by their place.
    #[must_use]
    pub fn in_words(&self, place: usize) -> String {
        match self {
            Self::Values { units, values, .. } => {
                let tried = |place: usize| {
                    let mut description: Vec<String> = Vec::new();
                    for (unit, value) in units.iter().zip(&values[place]) {
                        let value = value_in_words(unit, value);
                        if !description.contains(&value) {
                            description.push(value);
                        }
                    }
                    description.join(" / ")
                };
                let told_here = tried(place);
                let alike = (0..values.len()).any(|other| other != place && tried(other) == told_here);
                if alike { format!("no. {}, {told_here}", place + 1) } else { told_here }
            }
            Self::Factors { by, .. } => format!("× {}", number::compact(by[place], 4)),
            Self::Solvers(solvers) => match solvers[place] {
                SolverChoice::EventDriven => "exact".into(),
                step @ SolverChoice::FixedStep { .. } => words::of_solver(&step.label()),
            },
        }
    }
}
