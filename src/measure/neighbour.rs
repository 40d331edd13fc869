//! Runs that say how far the numbers of a run are to be trusted. If one of them fails, it alone does: the run keeps its numbers, and what
//! the other one was to say is unknown.
//!
//! The neighbour of a run that ends may have no end: where a particle rests on a floor that returns all of its speed, one that starts a
//! billionth higher hops for ever. A neighbour has as many events as the run, or some times as many; one with far more is given up.

use super::Evaluated;
use crate::dynamics::{EngineError, HybridSystem, Options, Response, event_driven, event_driven_within};
use crate::text::number::count;

/// Events that a neighbour may have for each event of the run.
const FOR_EACH: u64 = 100;
/// Events that it may have besides, for each particle: several times what a particle needs to come to rest where it loses a thousandth of
/// its speed at each impact.
const FOR_A_PARTICLE: u64 = 100_000;

/// The run beside `run` under these options; the inner error says why there is none.
pub(super) fn neighbour(
    system: &HybridSystem,
    options: &Options,
    run: &Response,
) -> Result<Result<Response, String>, EngineError> {
    let own = run.proof.events;
    let events = own.saturating_mul(FOR_EACH).saturating_add(FOR_A_PARTICLE * system.particles.len() as u64);
    let who = "the run from a slightly perturbed start";
    Ok(match event_driven_within(events, system, options) {
        Ok(Ok(neighbour)) => Ok(neighbour),
        Ok(Err(overrun)) => Err(format!(
            "{who} was stopped after {} events in cycle {} of {}; this one has {} in all",
            count(events),
            overrun.cycle,
            overrun.cycles,
            count(own)
        )),
        Err(error) => Err(refused(who, error)?),
    })
}

/// The run once more under these options; the inner error says why there is none.
pub(super) fn repeated(system: &HybridSystem, options: &Options) -> Result<Result<Response, String>, EngineError> {
    Ok(match event_driven(system, options) {
        Ok(repeated) => Ok(repeated),
        Err(error) => Err(refused("the run with search windows half as long", error)?),
    })
}

/// What is said of a run that the engine gave up. One that came to the limit of its row, or was interrupted, is tried again.
fn refused(who: &str, error: EngineError) -> Result<String, EngineError> {
    match error {
        EngineError::Overrun(_) => Err(error),
        _ => Ok(format!("{who} has no result: {error}")),
    }
}

impl Evaluated {
    /// Neighbouring starts end elsewhere, for all that is known.
    #[must_use]
    pub fn may_be_chaotic(&self) -> bool {
        self.chaotic || self.unknown.is_some()
    }

    /// Notes that something is unknown, and why.
    pub(super) fn note_unknown(&mut self, what: &str, why: &str) {
        let text = format!("{what} unknown: {why}");
        self.unknown = Some(self.unknown.take().map_or(text.clone(), |before| format!("{before}; {text}")));
    }
}
