//! What is read off the motion that a run goes on to, in a longer run that ends where it has settled.

use super::elasticity::{self, Absent};
use super::reading::Reading;
use super::{EvaluateError, Measure, Measured, Subject, Tolerance};
use crate::dynamics::{EngineError, HybridSystem, Options, Orbit, OrbitError, Response, Until, event_driven};
use crate::scene::{Design, Scene};

/// Cycles in which a motion may settle, over those of a run.
const LONGER: u32 = 10;

/// A run and the one without dampers, as far as they have settled.
pub(super) struct Later<'a> {
    pub(super) subject: &'a Subject,
    pub(super) system: &'a HybridSystem,
    pub(super) own: Option<Response>,
    pub(super) undamped: Option<&'a Response>,
}

impl Later<'_> {
    /// The velocity ratio of both; undefined where one does not settle.
    pub(super) fn velocity_ratio(&self) -> f64 {
        let rms = |run: &Response| Reading::of_run(&self.subject.scene, run).rms_velocity(run);
        self.undamped.as_ref().zip(self.own.as_ref()).map_or(f64::NAN, |(undamped, own)| rms(undamped) / rms(own))
    }

    /// Its elasticities, and what is made of them; `None` in the place of any other measure.
    pub(super) fn elasticities(
        &self,
        measures: &[Measure],
        tolerances: &[Tolerance],
    ) -> Result<Vec<Option<Measured>>, EvaluateError> {
        if !measures.iter().any(|measure| measure.needs_neighbours()) {
            return Ok(vec![None; measures.len()]);
        }
        let orbit = self.orbit()?;
        // What tolerances leave is made of the same derivatives.
        let mut known: Vec<(Design, Measured)> = Vec::new();
        let mut of = |design| {
            if let Some((_, measured)) = known.iter().find(|(other, _)| *other == design) {
                return Ok(*measured);
            }
            let measured = match &orbit {
                Ok(orbit) => elasticity::of(self.subject, orbit, design)?,
                Err(absent) => absent.measured(),
            };
            known.push((design, measured));
            Ok(measured)
        };
        let one = |measure: &Measure| match measure {
            Measure::VelocityRatioInput => elasticity::left_by(tolerances, self.velocity_ratio(), &mut of).map(Some),
            _ => measure.elasticity_in().map(&mut of).transpose(),
        };
        measures.iter().map(one).collect()
    }

    /// The orbit that the run has settled to.
    fn orbit(&self) -> Result<Result<Orbit, Absent>, EngineError> {
        self.own.as_ref().map_or(Ok(Err(Absent::NotSettled)), |own| closed(self.system, own))
    }
}

/// The orbit that the runs of a system go on to, and its RMS velocity; `None` where they do not settle or it cannot be closed.
pub(super) fn orbit_of(
    scene: &Scene,
    system: &HybridSystem,
    plain: &Options,
) -> Result<Option<(Orbit, f64)>, EngineError> {
    let Some(run) = settled_later(system, plain)? else { return Ok(None) };
    let velocity = Reading::of_run(scene, &run).rms_velocity(&run);
    Ok(closed(system, &run)?.ok().map(|orbit| (orbit, velocity)))
}

/// The orbit that a run has settled to.
fn closed(system: &HybridSystem, run: &Response) -> Result<Result<Orbit, Absent>, EngineError> {
    let Some((state, settled)) = run.final_state.as_ref().zip(run.settled) else { return Ok(Err(Absent::NotSettled)) };
    match Orbit::near(system, state, u32::try_from(settled.cycles).unwrap_or(u32::MAX)) {
        Ok(orbit) => Ok(Ok(orbit)),
        Err(OrbitError::Engine(overrun @ EngineError::Overrun(_))) => Err(overrun),
        Err(_) => Ok(Err(Absent::NotSmooth)),
    }
}

/// A longer run with its last state, if it settles.
pub(super) fn settled_later(system: &HybridSystem, plain: &Options) -> Result<Option<Response>, EngineError> {
    let average = LONGER * (plain.skip + plain.average);
    let longer = Options { until: Until::Settled, average, final_state: true, ..plain.clone() };
    Ok(Some(event_driven(system, &longer)?).filter(|run| run.settled.is_some()))
}
