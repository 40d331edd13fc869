//! The ways to run a system: from event to event, in closed form where no event can happen, or step by step.

use super::error::EngineError;
use super::motion::Fundamental;
use super::options::{Options, Until};
use super::response::Response;
use super::states::States;
use super::steady_state::SteadyState;
use super::system::HybridSystem;
use super::{budget, fixed, linear, march, repeated, residual_bound};

/// Runs a system from event to event; where it is proved that there is none, in closed form.
///
/// # Errors
/// [`EngineError`] with the reason.
pub fn event_driven(system: &HybridSystem, options: &Options) -> Result<Response, EngineError> {
    repeated::once(system, options, || simulated(system, options))
}

fn simulated(system: &HybridSystem, options: &Options) -> Result<Response, EngineError> {
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

/// The steady state in closed form: what is left once all transients are gone. `None` unless it is proved that no particle
/// leaves its floor in it, and where undamped modes never settle.
///
/// # Errors
/// [`EngineError`] with the reason.
pub fn steady_state(system: &HybridSystem) -> Result<Option<SteadyState>, EngineError> {
    budget::within(|| linear::steady_state(system))
}

/// The share of its present strength at which the drive takes the first particle off its floor, in closed form: below it every particle
/// rests, once all transients are gone. `None` where no strength does, and where particles never rest under this drive: on rigid floors
/// under impulses, say.
///
/// # Errors
/// [`EngineError`] with the reason.
pub fn lift_off(system: &HybridSystem) -> Result<Option<f64>, EngineError> {
    budget::within(|| linear::lift_off(system))
}

/// The share of its present strength below which the drive keeps up no motion with one impact on the floor and one on the ceiling a period,
/// in closed form: one particle between rigid faces, under a harmonic force on a damped structure. `None` elsewhere, and where no strength
/// does.
///
/// # Errors
/// [`EngineError`] with the reason.
pub fn two_impacts(system: &HybridSystem) -> Result<Option<f64>, EngineError> {
    budget::within(|| linear::two_impacts(system))
}

/// The share of its present strength at which the motion with one impact on the floor a period first touches the ceiling, in closed form:
/// one particle on a rigid floor, under gravity and a harmonic force on a damped structure. `None` elsewhere, and where no motion of this
/// kind that attracts stays below the ceiling.
///
/// # Errors
/// [`EngineError`] with the reason.
pub fn ceiling_graze(system: &HybridSystem) -> Result<Option<f64>, EngineError> {
    budget::within(|| linear::ceiling_graze(system))
}

/// Runs a system with a fixed time step, s: exact propagators of one step, the contact state checked once a step.
///
/// # Errors
/// [`EngineError`] with the reason.
pub fn fixed_step(system: &HybridSystem, options: &Options, time_step: f64) -> Result<Response, EngineError> {
    budget::within(|| fixed::run(system, options, time_step))
}
