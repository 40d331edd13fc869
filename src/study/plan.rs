//! The plan: what the simulation of each experiment depends on, and whether the table on disk was made from exactly that.

use std::collections::{BTreeMap, BTreeSet};

use serde_json::json;

use super::inputs::Inputs;
use super::layout::{ASSUMPTIONS, Layout, record_name, table_name};
use super::load::Source;
use super::reason::{Reason, differences};
use super::record::{NoRecord, Record};
use super::variant::{Sensitivity, Variant, variants};
use crate::dynamics::SOLVER_VERSION;
use crate::experiment::{AssumptionName, AssumptionSheet, AssumptionValue};
use crate::measure::ENSEMBLE_OF_A_VARIANT;
use crate::table::DEPENDS_ON;

/// One experiment as planned.
#[derive(Debug, Clone, PartialEq)]
pub struct Item {
    /// The experiment and its file.
    pub source: Source,
    /// The assumptions that its numbers depend on, recorded once.
    pub used: BTreeSet<AssumptionName>,
    /// The assumptions under which it runs; the baseline first.
    pub variants: Vec<Variant>,
    /// All that its numbers depend on.
    pub simulation: Inputs,
    /// Whether it is to be simulated.
    pub state: State,
}

/// What is on disk.
#[derive(Debug, Clone, PartialEq)]
pub enum State {
    /// The table with this fingerprint.
    Current(Record),
    /// The table with this fingerprint, but some of its rows failed: it counts, and is tried again.
    Failed(Record),
    /// Nothing, or a table with another fingerprint; and why.
    Stale(Vec<Reason>),
}

impl Item {
    /// Plans one experiment, and looks at what is on disk. The assumptions that it depends on are worked out unless they are known.
    #[must_use]
    pub fn new(
        layout: &Layout,
        source: Source,
        used: Option<BTreeSet<AssumptionName>>,
        sheet: &AssumptionSheet,
        sensitivity: Sensitivity,
    ) -> Self {
        let used = used.unwrap_or_else(|| source.experiment.assumptions_used(sheet));
        let variants = variants(&source.experiment, &used, sheet, sensitivity);
        let simulation = simulation(&source, sheet, &used, &variants);
        let state = state(layout, &source, &simulation);
        Self { source, variants, used, simulation, state }
    }

    /// Hash of [`Item::simulation`].
    #[must_use]
    pub fn fingerprint(&self) -> String {
        self.simulation.fingerprint()
    }

    /// Looks at what is on disk again.
    pub(super) fn refresh(&mut self, layout: &Layout) {
        self.state = state(layout, &self.source, &self.simulation);
    }

    /// The record of the current table, if there is one.
    #[must_use]
    pub fn record(&self) -> Option<&Record> {
        match &self.state {
            State::Current(record) | State::Failed(record) => Some(record),
            State::Stale(_) => None,
        }
    }

    /// Why there is something to simulate; empty if there is not.
    #[must_use]
    pub fn reasons(&self) -> Vec<Reason> {
        match &self.state {
            State::Current(_) => Vec::new(),
            State::Failed(record) => vec![Reason::Failed(record.failures.clone())],
            State::Stale(reasons) => reasons.clone(),
        }
    }

    /// What is written into the table's metadata: where the numbers come from, and no time, host or folder.
    #[must_use]
    pub fn provenance(&self) -> BTreeMap<String, String> {
        let experiment = &self.source.experiment;
        let assumptions: Vec<&str> = self.used.iter().map(|name| name.as_str()).collect();
        let pairs = [
            ("experiment", experiment.id.to_string()),
            ("title", experiment.title.clone()),
            ("section", experiment.source.section.clone().unwrap_or_default()),
            ("fingerprint", self.fingerprint()),
            ("solver_version", SOLVER_VERSION.to_string()),
            (DEPENDS_ON, assumptions.join(", ")),
            ("program", concat!("shotdamp ", env!("CARGO_PKG_VERSION")).to_owned()),
        ];
        pairs.into_iter().map(|(key, value)| (key.to_owned(), value)).collect()
    }
}

fn simulation(
    source: &Source,
    sheet: &AssumptionSheet,
    used: &BTreeSet<AssumptionName>,
    variants: &[Variant],
) -> Inputs {
    let assumptions: BTreeMap<_, _> =
        sheet.iter().filter(|(name, _)| used.contains(*name)).map(|(name, entry)| (name, &entry.value)).collect();
    // Numbers to be held against a table without assumptions change nothing in it.
    let sensitivity = Some(ends(variants)).filter(|ends| !ends.is_empty());
    Inputs::of([
        ("experiment", source.experiment.simulation_json()),
        ("assumptions", json!(assumptions)),
        ("sensitivity", json!(sensitivity)),
        ("ensemble_of_a_variant", json!(ENSEMBLE_OF_A_VARIANT)),
        ("solver_version", json!(SOLVER_VERSION)),
    ])
}

/// The value that each variant moves its assumption to.
fn ends(variants: &[Variant]) -> BTreeMap<&str, &AssumptionValue> {
    variants
        .iter()
        .filter_map(|variant| Some((variant.label.as_str(), variant.assumptions.values.get(variant.moved.as_ref()?)?)))
        .collect()
}

fn state(layout: &Layout, source: &Source, simulation: &Inputs) -> State {
    let id = &source.experiment.id;
    let record = match Record::read(&layout.path(&record_name(id)), id) {
        Ok(record) => record,
        Err(NoRecord::Absent) => return State::Stale(vec![Reason::NeverRun]),
        Err(NoRecord::Unreadable(what)) => return State::Stale(vec![Reason::RecordUnreadable(what)]),
    };
    let mut reasons = differences(&record.simulation, simulation, &|path| match path {
        ["experiment", ..] => source.file.clone(),
        // There as a whole or not at all, as the reference has numbers or not, and assumptions to move; its parts are their ranges.
        ["sensitivity"] => format!("reference of {id}"),
        ["assumptions" | "sensitivity", ..] => ASSUMPTIONS.into(),
        _ => "this program".into(),
    });
    let table = table_name(id);
    reasons.extend(record.table.departs(&layout.path(&table), &table));
    match record {
        _ if !reasons.is_empty() => State::Stale(reasons),
        record if record.failures.rows > 0 => State::Failed(record),
        record => State::Current(record),
    }
}
