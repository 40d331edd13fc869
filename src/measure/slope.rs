//! How a measure of settled motion changes with each gap: what an optimiser polishes with.
//!
//! d A/d h_i = (A/h_i) d ln A/d ln h_i along the periodic motion that the run goes on to. The RMS velocity v has that derivative
//! itself, the velocity ratio v₀/v minus it, as v₀ is that of the structure without dampers.

use super::elasticity;
use super::later::orbit_of;
use super::{EvaluateError, Measure, Rigour};
use super::{Prepared, Request};
use crate::optimise::Slope;

impl Prepared<'_> {
    /// The RMS velocity or the velocity ratio of the motion that these gaps settle to, and its derivative by each of them, in the word
    /// by which gaps are given. `None` where the motion does not settle, or has no derivative; a gap of zero has a derivative of 0.
    ///
    /// # Errors
    /// [`EvaluateError`] with the reason.
    ///
    /// # Panics
    /// For another measure.
    pub fn slope(&self, gaps: &[f64], measure: Measure) -> Result<Option<Slope>, EvaluateError> {
        let (scene, system) = self.with_gaps(gaps);
        let request = Request { measures: self.measures, rigour: Rigour::Step, ..Request::default() };
        let plain = request.options(&scene, &self.settings);
        let Some((orbit, velocity)) = orbit_of(&scene, &system, &plain)? else { return Ok(None) };
        let mut of_each = Vec::new();
        for (damper, gap) in gaps.iter().enumerate() {
            let by_gap = |factor: f64| {
                let mut scaled = system.clone();
                scaled.particles[damper].gap *= factor;
                Ok(scaled)
            };
            let Ok(elasticity) = elasticity::of_rms_velocity(&scene, &orbit, by_gap)? else { return Ok(None) };
            of_each.push(if *gap > 0.0 { elasticity.value / gap } else { 0.0 });
        }
        let (value, sign) = match measure {
            Measure::RmsVelocity => (velocity, 1.0),
            Measure::VelocityRatio => match self.undamped_rms_velocity() {
                Some(undamped) => (undamped / velocity, -1.0),
                None => return Err(EvaluateError::NoRun(measure)),
            },
            _ => unreachable!("the reader of `polish` admits no other measure"),
        };
        Ok(Some(Slope { value, gradient: of_each.iter().map(|of_log| sign * value * of_log).collect() }))
    }
}
