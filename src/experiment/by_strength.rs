//! Curves along the strength of a drive.

use std::collections::BTreeSet;

use super::case::differing_in;
use super::definition::Experiment;
use super::recipe::Parameter;

/// The cases that differ in a strength of the drive alone, by their index, with that strength.
pub(crate) fn by_strength(experiment: &Experiment) -> Vec<(Parameter, Vec<usize>)> {
    let sweeps: BTreeSet<&str> = experiment.cases.iter().map(|case| case.sweep.as_str()).collect();
    let mut found = Vec::new();
    for over in experiment.swept.iter().copied().filter(|parameter| parameter.is_strength()) {
        for sweep in &sweeps {
            found.extend(differing_in(&experiment.cases, sweep, over).into_iter().map(|cases| (over, cases)));
        }
    }
    found
}
