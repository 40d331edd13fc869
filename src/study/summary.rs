//! What the rest of the study needs to know of an experiment that is up to date: enough for the index, the console and the
//! verdicts of other experiments, without its YAML or its table.

use std::collections::{BTreeMap, BTreeSet};

use serde::{Deserialize, Serialize};

use super::motions::Motions;
use crate::experiment::{AssumptionName, Experiment, ExperimentId, Source};
use crate::reference::Judged;

/// An experiment by name.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Heading {
    /// Its id.
    pub id: ExperimentId,
    /// Its title.
    pub title: String,
    /// Its place in the study.
    pub source: Source,
}

impl Heading {
    /// Of this experiment.
    #[must_use]
    pub fn of(experiment: &Experiment) -> Self {
        Self { id: experiment.id.clone(), title: experiment.title.clone(), source: experiment.source.clone() }
    }
}

/// The assumptions that experiments depend on, by id.
pub type Used = BTreeMap<String, BTreeSet<AssumptionName>>;

/// An experiment that is up to date.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Summary {
    /// Its name.
    pub heading: Heading,
    /// The folder of its file below `experiments/`.
    pub folder: String,
    /// The assumptions that it depends on.
    pub used: BTreeSet<AssumptionName>,
    /// Hash of its table.
    pub table: String,
    /// Hashes of the other tables that its entries read, by experiment.
    pub reads: BTreeMap<String, String>,
    /// Its entries with their verdicts.
    pub judged: Vec<Judged>,
    /// The line of each entry in the reference file.
    pub lines: Vec<u64>,
    /// What moves how in it.
    pub motions: Option<Motions>,
}
