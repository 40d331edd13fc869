//! Numbers that are none: a ratio of nothing to nothing is undefined, and says so; one that left the range of numbers is an error.

use super::{EvaluateError, Evaluated, Measure, ReadOff};
use crate::scene::Scene;

impl Measure {
    /// Why this measure has no number where nothing went wrong.
    #[must_use]
    pub fn why_undefined(self) -> &'static str {
        match self {
            Self::LastPeak | Self::PeakVariation | Self::PeakDecayError => "the time history has no crest",
            Self::NaturalFrequency | Self::CleanNaturalFrequency | Self::ExactNaturalFrequency | Self::Mac => {
                "there is no such mode"
            }
            Self::Drift => "nothing moves",
            Self::FinalHeight => "there is no particle",
            Self::LyapunovExponent => "nothing is left of a disturbance, or particles are struck at one instant",
            _ if self.needs_motion() => "the motion does not come again, or particles are struck at one instant",
            _ if self.needs_events() => "there is no such event",
            _ if self.needs_undamped() => "neither run moves",
            _ => "nothing excites the structure",
        }
    }

    /// It is a number wherever something excites the structure; an event may fail to happen, and a scene may have no particle.
    fn is_of_any_motion(self) -> bool {
        use ReadOff::{Events, Model, Motion, Shape, Trace};
        !matches!(self.facts().from, Trace | Model | Shape | Events | Motion) && self != Self::FinalHeight
    }
}

/// What was evaluated, if every number is one, or undefined for a reason that has a name.
///
/// # Errors
/// [`EvaluateError::OutOfRange`] for the first number that left the range of numbers.
pub(super) fn in_range(scene: &Scene, measures: &[Measure], evaluated: Evaluated) -> Result<Evaluated, EvaluateError> {
    for (measure, measured) in measures.iter().zip(&evaluated.measured) {
        let value = measured.value;
        let fine = match measure {
            // Infinite where nothing is hit.
            Measure::FloorImpactLag | Measure::CeilingImpactLag => !value.is_nan(),
            // Of a run that does not leave the rest that it starts from.
            Measure::ShortestPeriod => value > 0.0,
            _ if value.is_nan() => !measure.is_of_any_motion() || scene.excitation.is_silent(),
            _ => value.is_finite(),
        };
        if !fine {
            return Err(EvaluateError::OutOfRange { measure: *measure, value });
        }
    }
    Ok(evaluated)
}
