//! Numbers that are none: a ratio of nothing to nothing is undefined, and says so; one that left the range of numbers is an error.

use super::elasticity::Absent;
use super::{EvaluateError, Evaluated, Measure, Measured, ReadOff};
use crate::dynamics::MotionKind;
use crate::scene::Scene;
use crate::text::words;

/// How many particles a scene may have: only several can be struck at one instant.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Particles {
    /// One, or none.
    One,
    /// More.
    Several,
}

impl Evaluated {
    /// Which numbers are undefined, and why, each reason once: `multipliers, lyapunov_exponent undefined: …`. Empty if all are
    /// defined.
    #[must_use]
    pub fn undefined(&self, measures: &[Measure], particles: Particles) -> String {
        // A table that is read again knows the motion only where it has the column.
        let motion = self.motion.filter(|_| measures.contains(&Measure::Motion));
        let mut reasons: Vec<(&str, Vec<String>)> = Vec::new();
        let has_multipliers = measures
            .iter()
            .zip(&self.measured)
            .any(|(measure, one)| *measure == Measure::LargestMultiplier && !one.value.is_nan());
        for (measure, one) in measures.iter().zip(&self.measured) {
            let is_named = measure.is_of_a_period() && motion.is_some_and(|kind| !kind.repeats());
            let is_unnamed = measure.needs_motion() && self.motion.is_none() && measures.contains(&Measure::Motion);
            // The name of the motion says that there is no period, and a row of a fixed step has none.
            if measure.is_name() || is_named || is_unnamed || !one.value.is_nan() {
                continue;
            }
            let (why, name) = if has_multipliers && *measure == Measure::MultiplierResidual {
                ("the product of the multipliers is below the range of numbers", words::of_key(measure))
            } else {
                (measure.why_undefined(motion, one, particles), measure.name_undefined())
            };
            match reasons.iter_mut().find(|(known, _)| *known == why) {
                Some((_, names)) if names.contains(&name) => {}
                Some((_, names)) => names.push(name),
                None => reasons.push((why, vec![name])),
            }
        }
        let texts = reasons.iter().map(|(why, names)| format!("{} undefined: {why}", names.join(", ")));
        texts.collect::<Vec<_>>().join("; ")
    }
}

impl Measure {
    /// Of the period of a motion that comes again.
    fn is_of_a_period(self) -> bool {
        self.needs_multipliers() && self != Self::LyapunovExponent
    }

    /// What it is called where it is undefined: multipliers are so together.
    fn name_undefined(self) -> String {
        match self {
            Self::LargestMultiplier | Self::MultiplierAngle | Self::MultiplierResidual => "multipliers".into(),
            _ => words::of_key(&self),
        }
    }

    /// Why this measure has no number where nothing went wrong, in a run of this motion, if it is known.
    fn why_undefined(self, motion: Option<MotionKind>, one: &Measured, particles: Particles) -> &'static str {
        match self {
            Self::FloorImpactLag | Self::CeilingImpactLag => "no impulse stands in the time history",
            Self::LastPeak | Self::PeakVariation => "the time history has no crest",
            Self::PeakDecayError => {
                "the time history has no crest, or the structure is no single mass and decays in many ways"
            }
            Self::NaturalFrequency | Self::CleanNaturalFrequency | Self::ExactNaturalFrequency | Self::Mac => {
                "there is no such mode"
            }
            Self::Drift => "nothing moves, or a single cycle is averaged, which has no halves",
            Self::FinalHeight => "there is no particle",
            Self::LyapunovExponent => match (motion.map(MotionKind::repeats), particles) {
                (Some(false), Particles::One) => "the cycles are too few",
                (Some(false), Particles::Several) => "particles are struck at one instant, or the cycles are too few",
                (_, Particles::One) => "nothing is left of a disturbance",
                (_, Particles::Several) => "nothing is left of a disturbance, or particles are struck at one instant",
            },
            _ if self.elasticity_in().is_some() || self == Self::VelocityRatioInput => Absent::of(one).why(),
            _ if self.is_of_a_period() => match (motion, particles) {
                (Some(_), Particles::Several) => "particles are struck at one instant",
                (None, Particles::Several) => "the motion does not come again, or particles are struck at one instant",
                (_, Particles::One) => "the motion does not come again",
            },
            Self::SettledVelocityRatio => "the motion does not settle",
            _ if self.needs_events() => "there is no such event",
            _ if self.needs_undamped() => "neither run moves",
            _ => "nothing excites the structure",
        }
    }

    /// It is a number wherever something excites the structure; an event may fail to happen, and a scene may have no particle.
    fn is_of_any_motion(self) -> bool {
        use ReadOff::{Events, Model, Motion, Neighbours, Settled, Shape, Trace};
        !matches!(self.facts().from, Trace | Model | Shape | Events | Motion | Settled | Neighbours)
            && self != Self::FinalHeight
    }
}

/// What was evaluated of so many averaged cycles, if every number is one, or undefined for a reason that has a name.
///
/// # Errors
/// [`EvaluateError::OutOfRange`] for the first number that left the range of numbers.
pub(super) fn in_range(
    scene: &Scene,
    cycles: u32,
    measures: &[Measure],
    evaluated: Evaluated,
) -> Result<Evaluated, EvaluateError> {
    for (measure, measured) in measures.iter().zip(&evaluated.measured) {
        let value = measured.value;
        let fine = match measure {
            // Infinite where nothing is hit, undefined where nothing strikes.
            Measure::FloorImpactLag | Measure::CeilingImpactLag => true,
            // Of a run that does not leave the rest that it starts from.
            Measure::ShortestPeriod => value > 0.0,
            // The second half of one cycle is empty.
            Measure::Drift if cycles < 2 => true,
            _ if value.is_nan() => !measure.is_of_any_motion() || scene.excitation.is_silent(),
            _ => value.is_finite(),
        };
        if !fine {
            return Err(EvaluateError::OutOfRange { measure: *measure, value });
        }
    }
    Ok(evaluated)
}
