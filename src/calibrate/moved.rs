//! One assumption moved at a time: what an entry reads then.

use super::fit::{Read, read};
use super::set::Set;
use super::trials::{Asked, CumulativeEvents, TrialRunner, Workers, Worth};
use crate::experiment::{AssumptionName, AssumptionValue, Assumptions, Experiment};
use crate::measure::ENSEMBLE_OF_A_VARIANT;
use crate::study::{Evaluate, Event, EventHandler, RunError};

/// Members of the ensemble of a chaotic point: as many as the other values of assumptions have in a run at most.
const MEMBERS: u32 = ENSEMBLE_OF_A_VARIANT.most;

/// What an entry of the experiment `asked.0` reads with each of `moves` by itself, all other inputs in force. Only the rows that
/// it reads are run.
///
/// # Errors
/// As [`crate::study::run`].
pub fn moved_alone(
    asked: Asked<'_>,
    moves: &[(AssumptionName, AssumptionValue)],
    experiments: &[&Experiment],
    in_force: &Assumptions,
    threads: usize,
    evaluate: &impl Evaluate,
    handler: &dyn EventHandler,
) -> Result<Vec<Read>, RunError> {
    let workers = Workers { threads, evaluate, handler: &CumulativeEvents::new(handler) };
    let set = |(name, value): &(AssumptionName, AssumptionValue)| {
        let mut set = Set::in_force(in_force);
        set.assumptions.values.insert(name.clone(), value.clone());
        set
    };
    let sets: Vec<Set> = moves.iter().map(set).collect();
    let tables = TrialRunner::new(&workers, Worth::Step { ensemble: MEMBERS }, experiments, &[asked]).tables(&sets)?;
    handler.on_event(&Event::Ended);
    Ok(tables.iter().map(|tables| read(&asked, tables)).collect())
}
