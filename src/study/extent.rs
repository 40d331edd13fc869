//! How much of an experiment a change touches.

use std::collections::BTreeSet;

use serde_json::Value;

use super::job::{Job, jobs};
use super::layout::{Layout, record_name};
use super::meaning::changes;
use super::plan::Item;
use super::record::Record;
use crate::text::words;

/// Rows of a table, and those among them that mean something else than they did.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Extent {
    /// Rows whose meaning has changed, or that are new.
    pub touched: usize,
    /// All rows.
    pub rows: usize,
}

impl Item {
    /// How many rows differ in meaning from those of the table on disk; all of them if there is none.
    #[must_use]
    pub fn extent(&self, layout: &Layout) -> Extent {
        let (rows, _) = self.size();
        let all = Extent { touched: rows, rows };
        let experiment = &self.source.experiment;
        let record = Record::read(&layout.path(&record_name(&experiment.id)), &experiment.id);
        let Ok(Record { simulation: old, .. }) = record else { return all };
        if experiment.optimise.is_some() {
            return all;
        }
        let mut moved: BTreeSet<String> = BTreeSet::new();
        for change in changes(&old, &self.simulation) {
            let path: Vec<&str> = change.path.iter().map(String::as_str).collect();
            match path.as_slice() {
                // Which cases are new is looked at one by one; which parameters they set follows from them.
                ["experiment", "cases" | "swept", ..] => {}
                // The value of an assumption, or one of the ends of its range.
                ["assumptions" | "sensitivity", name, ..] => {
                    moved.insert(name.split_once('=').map_or(*name, |(name, _)| name).into());
                }
                _ => return all,
            }
        }
        let known: Vec<&Value> =
            old["experiment"]["cases"].as_array().map(|cases| cases.iter().collect()).unwrap_or_default();
        let is_touched = |job: &Job| {
            let case = &experiment.cases[job.case];
            let is_new = !serde_json::to_value(case).is_ok_and(|case| known.contains(&&case));
            let assumptions = &self.variants[job.variant].assumptions;
            is_new
                || experiment.recipe_of(case).map_or(true, |recipe| {
                    recipe.assumptions(assumptions).iter().any(|name| moved.contains(&words::of_key(name)))
                })
        };
        let touched = jobs(experiment, &self.variants).iter().filter(|job| is_touched(job)).count();
        Extent { touched, rows }
    }
}
