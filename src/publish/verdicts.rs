//! Verdicts over the tables on disk.

use std::collections::{BTreeMap, BTreeSet};

use rayon::prelude::*;

use super::opened::Opened;
use crate::reference::{Judged, ReferenceFile, SelfTestFailure, TableState, Tables, judge, self_test};
use crate::study::{Item, State, table_name};
use crate::table::{Table, parquet};

/// The tables that count, and the verdicts that they give.
#[derive(Debug, Default)]
pub struct Judgement {
    /// Tables by experiment.
    pub tables: BTreeMap<String, Table>,
    /// Verdicts by experiment, in the order of its reference file.
    pub verdicts: BTreeMap<String, Vec<Judged>>,
}

/// What is known of the table of an experiment.
enum OnDisk {
    Present(Table),
    Stale,
    NotRun,
    Failed(String),
}

/// Reads every table that has the meaning of its experiment, and judges every entry.
#[must_use]
pub fn judge_all(opened: &Opened) -> Judgement {
    let states = on_disk(opened);
    let tables = tables(&states);
    let fitted = opened.fitted();
    let verdict = |(id, file): (&String, &ReferenceFile)| (id.clone(), judged(opened, file, &tables, &fitted));
    let verdicts = opened.references.iter().map(verdict).collect();
    let tables = states
        .into_iter()
        .filter_map(|(id, state)| match state {
            OnDisk::Present(table) => Some((id, table)),
            _ => None,
        })
        .collect();
    Judgement { tables, verdicts }
}

/// The verdicts that these tables give, whatever they were computed from.
#[must_use]
pub fn judge_tables(opened: &Opened, tables: &BTreeMap<String, Table>) -> Vec<Judged> {
    let states: Tables<'_> = tables.iter().map(|(id, table)| (id.clone(), TableState::Present(table))).collect();
    let fitted = opened.fitted();
    opened.references.values().flat_map(|file| judged(opened, file, &states, &fitted)).collect()
}

fn judged(opened: &Opened, file: &ReferenceFile, tables: &Tables<'_>, fitted: &BTreeSet<String>) -> Vec<Judged> {
    let mut judged = judge(file, tables, fitted);
    judged.iter_mut().for_each(|one| one.role = opened.role(&one.id));
    judged
}

/// Shows of each entry of these experiments that it can fail; returns those that cannot.
#[must_use]
pub fn self_test_all(opened: &Opened, ids: &[&str]) -> Vec<SelfTestFailure> {
    let states = on_disk(opened);
    let tables = tables(&states);
    let files: Vec<_> = ids.iter().filter_map(|id| opened.references.get(*id)).collect();
    let failures: Vec<_> = files.par_iter().map(|file| self_test(file, &tables)).collect();
    failures.into_iter().flatten().collect()
}

fn on_disk(opened: &Opened) -> BTreeMap<String, OnDisk> {
    let read = |item: &Item| {
        let id = &item.source.experiment.id;
        let state = match &item.state {
            State::Current(_) | State::Failed(_) => match parquet::read(&opened.layout.path(&table_name(id))) {
                Ok(table) => OnDisk::Present(table),
                Err(error) => OnDisk::Failed(error.to_string()),
            },
            State::Stale(_) if opened.layout.path(&table_name(id)).is_file() => OnDisk::Stale,
            State::Stale(_) => OnDisk::NotRun,
        };
        (id.to_string(), state)
    };
    let states: Vec<_> = opened.items.par_iter().map(read).collect();
    states.into_iter().collect()
}

fn tables(states: &BTreeMap<String, OnDisk>) -> Tables<'_> {
    states.iter().map(|(id, on_disk)| (id.clone(), on_disk.state())).collect()
}

impl OnDisk {
    fn state(&self) -> TableState<'_> {
        match self {
            Self::Present(table) => TableState::Present(table),
            Self::Stale => TableState::Stale,
            Self::NotRun => TableState::NotRun,
            Self::Failed(reason) => TableState::Failed(reason.clone()),
        }
    }
}
