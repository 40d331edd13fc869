//! Runs what a calibration needs.

use std::collections::{BTreeMap, BTreeSet};

use super::grid::variants;
use crate::scene::Assumptions;
use crate::spec::{Calibration, Experiment};
use crate::study::{Evaluate, Listen, Task, ThreadError, run};
use crate::table::Table;

/// Why there is no calibration.
#[derive(Debug, thiserror::Error)]
pub enum CalibrationError {
    /// An entry of an experiment that is not there.
    #[error("`{0}` is no entry of an experiment of this study")]
    NoEntry(String),
    /// No thread.
    #[error(transparent)]
    Threads(#[from] ThreadError),
}

/// Runs the experiments of the calibration's entries under every combination of its values, and returns their tables.
///
/// # Errors
/// [`CalibrationError`] for an entry of no experiment.
pub fn simulate(
    calibration: &Calibration,
    experiments: &[&Experiment],
    in_force: &Assumptions,
    threads: usize,
    evaluate: &impl Evaluate,
    listener: &dyn Listen,
) -> Result<BTreeMap<String, Table>, CalibrationError> {
    let mut wanted: BTreeSet<&str> = BTreeSet::new();
    for id in calibration.fit.iter().chain(&calibration.hold_out) {
        let experiment = id.split_once('/').map_or(id.as_str(), |(experiment, _)| experiment);
        if experiments.iter().all(|known| known.id.0 != experiment) {
            return Err(CalibrationError::NoEntry(id.clone()));
        }
        wanted.insert(experiment);
    }
    let chosen: Vec<Experiment> = experiments
        .iter()
        .filter(|experiment| wanted.contains(experiment.id.0.as_str()))
        .map(|experiment| without_searches(experiment))
        .collect();
    let variants = variants(calibration, in_force);
    let metadata = BTreeMap::new();
    let tasks: Vec<Task<'_>> = chosen
        .iter()
        .map(|experiment| Task {
            experiment,
            variants: &variants,
            metadata: &metadata,
            journal: None,
            shard: None,
            known: None,
        })
        .collect();
    let tables =
        run(&tasks, threads, evaluate, listener, |index, finished| (chosen[index].id.to_string(), finished.table))?;
    Ok(tables.into_iter().collect())
}

/// One run a point: where the motion is chaotic the study's numbers are single runs as well.
fn without_searches(experiment: &Experiment) -> Experiment {
    let mut experiment = experiment.clone();
    experiment.settings.ensemble = 0;
    if let Some(optimise) = &mut experiment.optimise {
        optimise.searches.clear();
        optimise.two_opt_of.clear();
        optimise.landscape = None;
    }
    experiment
}
