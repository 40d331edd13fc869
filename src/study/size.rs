//! How large an experiment is: rows of its table, and simulations.

use super::job::{evaluations, jobs};
use super::plan::Item;
use super::variant::Variant;
use super::{basins, optimise, orbit};
use crate::experiment::{Experiment, RowSource, curves};

impl Item {
    /// The number of rows, those that refined curves will get not counted, of a branch the most, of random starts one a case, and of simulations at most.
    #[must_use]
    pub fn size(&self) -> (usize, u64) {
        let experiment = &self.source.experiment;
        let rows = match experiment.row_source() {
            RowSource::Search(optimise) => optimise::rows(optimise, &self.variants),
            RowSource::Branches(continuation) => orbit::points(continuation, &self.variants),
            RowSource::Cases | RowSource::Basins(_) => jobs(experiment, &self.variants).len(),
        };
        (rows, simulations(experiment, &self.variants))
    }
}

/// Simulations that an experiment takes at most, with all the points that its curves may get.
pub(super) fn simulations(experiment: &Experiment, variants: &[Variant]) -> u64 {
    match experiment.row_source() {
        RowSource::Search(optimise) => return optimise::evaluations(optimise, variants),
        RowSource::Branches(continuation) => return orbit::points(continuation, variants) as u64,
        RowSource::Basins(starts) => return basins::simulations(experiment, starts, variants),
        RowSource::Cases => {}
    }
    let mut of_case = vec![0; experiment.cases.len()];
    for job in jobs(experiment, variants) {
        of_case[job.case] += evaluations(experiment, &job);
    }
    let added = curves(&experiment.cases, &experiment.refined).into_iter().map(|curve| {
        let points = u64::from(curve.rule.most).saturating_sub(curve.cases.len() as u64);
        points * curve.cases.iter().map(|case| of_case[*case]).max().unwrap_or(0)
    });
    of_case.iter().sum::<u64>() + added.sum::<u64>()
}
