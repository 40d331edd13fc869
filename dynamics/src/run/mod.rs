//! The ways to run a system: from event to event, in closed form where no event can happen.

pub(crate) mod repeated;

use crate::budget::{self, Overrun};
use crate::error::EngineError;
use crate::linear;
use crate::march;
use crate::motion::Fundamental;
use crate::options::{Options, Until};
use crate::response::{Response, residual_bound};
use crate::states::States;
use crate::system::HybridSystem;

/// Runs a system from event to event; where it is proved that there is none, in closed form.
///
/// # Errors
/// [`EngineError`] with the reason.
pub fn event_driven(system: &HybridSystem, options: &Options) -> Result<Response, EngineError> {
    repeated::once(system, options, |options| simulated(system, options))
}

/// The same of a run that may have so many events and is not needed: if it has more, the simulation goes on without it, and the inner error
/// says how far it had come. The limit of the simulation itself is an error as ever.
///
/// # Errors
/// [`EngineError`] with the reason.
pub fn event_driven_within(
    events: u64,
    system: &HybridSystem,
    options: &Options,
) -> Result<Result<Response, Overrun>, EngineError> {
    match budget::share(events, || event_driven(system, options)) {
        Ok(outcome) => outcome.map(Ok),
        Err(overrun) => Ok(Err(overrun)),
    }
}

fn simulated(system: &HybridSystem, options: &Options) -> Result<Response, EngineError> {
    if options.trace.is_some() && system.observed_rows.is_empty() {
        return Err(EngineError::NothingObserved);
    }
    budget::within(|| {
        let states = States::of(system);
        let attempt = match options.until {
            Until::Cycles => linear::attempt(system, options, &states)?,
            // A closed form visits no states that could come again.
            Until::Settled => None,
        };
        let mut response = match attempt {
            Some(response) if options.motion => {
                let taped = Options { audit: false, trace: None, record_events: 0, ..options.clone() };
                Response { motion: march::march(system, &taped, states)?.motion, ..response }
            }
            Some(response) => response,
            None => march::march(system, options, states)?,
        };
        residual_bound::enter(system, options, &mut response);
        Ok(response)
    })
}

/// The fundamental matrix of the averaged cycles of a run, whether they come again or not: what a small change of the state at
/// their begin is at their end.
///
/// # Errors
/// [`EngineError`] with the reason.
pub fn fundamental_matrix(system: &HybridSystem, options: &Options) -> Result<Fundamental, EngineError> {
    budget::within(|| march::fundamental(system, options, States::of(system)))
}

/// True where it is proved, without a simulation, that no particle leaves its floor in the run: it is then in closed form, and
/// what only a particle in flight can meet is skipped.
///
/// # Errors
/// [`EngineError`] with the reason.
pub fn is_linear(system: &HybridSystem, options: &Options) -> Result<bool, EngineError> {
    Ok(budget::within(|| linear::attempt(system, options, &States::of(system)))?.is_some())
}
