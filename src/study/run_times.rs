//! Processor time of each experiment on one machine, in a file beside the reports. It is written on request only, since times
//! differ from run to run; the index reads it like any other input.

use std::collections::BTreeMap;
use std::fs;

use serde::{Deserialize, Serialize};

use super::layout::Layout;
use super::machine::Machine;
use super::spent::Spent;
use crate::atomic::{self, FileError};
use crate::experiment::ExperimentId;
use crate::text::json;

/// Its name within the study.
const NAME: &str = "reports/times.json";

/// Processor time by experiment, s.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct RunTimes {
    /// Where they were taken.
    pub machine: Machine,
    /// Experiments that were simulated there.
    pub seconds: BTreeMap<String, f64>,
}

impl RunTimes {
    /// What the last runs of these experiments took, on this machine.
    #[must_use]
    pub fn of<'a>(layout: &Layout, ids: impl Iterator<Item = &'a ExperimentId>) -> Self {
        let took = |id: &ExperimentId| Some((id.to_string(), Spent::read(layout, id).total()?));
        Self { machine: Machine::here(), seconds: ids.filter_map(took).collect() }
    }

    /// Those that go with the reports; `None` where there are none that can be read.
    #[must_use]
    pub fn read(layout: &Layout) -> Option<Self> {
        serde_json::from_slice(&fs::read(layout.path(NAME)).ok()?).ok()
    }

    /// Writes them for the index.
    ///
    /// # Errors
    /// [`FileError`] if the file cannot be written.
    pub fn write(&self, layout: &Layout) -> Result<(), FileError> {
        atomic::write(&layout.path(NAME), json::page(self).as_bytes())
    }
}
