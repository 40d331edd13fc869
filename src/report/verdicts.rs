//! Verdicts over the tables on disk.

use std::collections::{BTreeMap, BTreeSet};

use rayon::prelude::*;

use super::prose;
use crate::reference::{Judged, ReferenceFile, Role, SelfTestFailure, TableState, Tables, judge, self_test};
use crate::study::{Item, Motions, State, Study, is_begun, table_name};
use crate::table::{Table, parquet};

/// The tables that count, and the verdicts that they give.
#[derive(Debug, Default)]
pub struct Judgement {
    /// Tables by experiment.
    pub tables: BTreeMap<String, Table>,
    /// Verdicts by experiment, in the order of its reference file.
    pub verdicts: BTreeMap<String, Vec<Judged>>,
    /// Why an experiment has no table that counts, by id.
    pub untabled: BTreeMap<String, &'static str>,
    /// What moves how in those that were planned, where that is measured.
    pub motions: BTreeMap<String, Motions>,
}

/// What is known of the table of an experiment.
enum OnDisk {
    Present(Table),
    Stale,
    /// A run of it was interrupted.
    Unfinished,
    NotRun,
    NoExperiment,
    Failed(String),
}

/// Reads every table that has the meaning of its experiment, and judges every entry.
#[must_use]
pub fn judge_all(study: &Study) -> Judgement {
    let states = on_disk(study);
    let tables = tables(&states);
    let fitted = study.sheet.fitted();
    let known = study.known.iter().map(|(id, known)| (id.clone(), known.judged.clone()));
    let verdict = |(id, file): (&String, &ReferenceFile)| (id.clone(), judged(study, file, &tables, &fitted));
    let mut verdicts = study.references.iter().map(verdict).chain(known).collect();
    prose::fill(&mut verdicts);
    let why = |on_disk: &OnDisk| match on_disk {
        OnDisk::Stale => Some("out of date"),
        OnDisk::Unfinished => Some("unfinished"),
        OnDisk::NotRun => Some("not run"),
        OnDisk::Present(_) | OnDisk::NoExperiment | OnDisk::Failed(_) => None,
    };
    let untabled = states.iter().filter_map(|(id, on_disk)| Some((id.clone(), why(on_disk)?))).collect();
    let tables: BTreeMap<String, Table> = states
        .into_iter()
        .filter_map(|(id, state)| match state {
            OnDisk::Present(table) => Some((id, table)),
            _ => None,
        })
        .collect();
    let motions = |item: &Item| {
        let experiment = &item.source.experiment;
        Some((experiment.id.0.clone(), Motions::of(experiment, tables.get(&experiment.id.0)?)?))
    };
    let motions = study.items.par_iter().filter_map(motions).collect();
    Judgement { tables, verdicts, untabled, motions }
}

/// The verdicts that these tables give, whatever they were computed from.
#[must_use]
pub fn judge_tables(study: &Study, tables: &BTreeMap<String, Table>) -> Vec<Judged> {
    let present = tables.iter().map(|(id, table)| (id.clone(), TableState::Present(table)));
    let states: Tables<'_> = orphans(study).map(|id| (id.clone(), TableState::NoExperiment)).chain(present).collect();
    let fitted = study.sheet.fitted();
    study.references.values().flat_map(|file| judged(study, file, &states, &fitted)).collect()
}

fn judged(study: &Study, file: &ReferenceFile, tables: &Tables<'_>, fitted: &BTreeSet<String>) -> Vec<Judged> {
    let mut judged = judge(file, tables, fitted);
    for one in &mut judged {
        one.role = study.role(&one.id);
        let left_out = || study.left_out.get(&one.id).copied().flatten();
        if one.role == Role::Fitted && left_out().is_some_and(|errors| one.comes_out(errors)) {
            one.role = Role::CrossValidated;
        }
    }
    judged
}

/// Shows of each entry of these experiments that it can fail; returns those that cannot.
#[must_use]
pub fn self_test_all(study: &Study, ids: &[&str]) -> Vec<SelfTestFailure> {
    let states = on_disk(study);
    let tables = tables(&states);
    let files: Vec<_> = ids.iter().filter_map(|id| study.references.get(*id)).collect();
    let failures: Vec<_> = files.par_iter().map(|file| self_test(file, &tables)).collect();
    failures.into_iter().flatten().collect()
}

fn on_disk(study: &Study) -> BTreeMap<String, OnDisk> {
    let read = |item: &Item| {
        let id = &item.source.experiment.id;
        let state = match &item.state {
            State::Current(_) | State::Failed(_) => match parquet::read(&study.layout.path(&table_name(id))) {
                Ok(table) => OnDisk::Present(table),
                Err(error) => OnDisk::Failed(error.to_string()),
            },
            State::Stale(_) if study.layout.path(&table_name(id)).is_file() => OnDisk::Stale,
            State::Stale(_) if is_begun(&study.layout, item) => OnDisk::Unfinished,
            State::Stale(_) => OnDisk::NotRun,
        };
        (id.to_string(), state)
    };
    let states: Vec<_> = study.items.par_iter().map(read).collect();
    // Of what is known to be up to date only the tables that entries of other experiments read.
    let others: BTreeSet<String> = study.references.values().flat_map(ReferenceFile::other_tables).collect();
    let known = others.into_iter().filter_map(|id| {
        let known = study.known.get(&id)?;
        let table = parquet::read(&study.layout.path(&table_name(&known.heading.id)));
        Some((id, table.map_or_else(|error| OnDisk::Failed(error.to_string()), OnDisk::Present)))
    });
    let orphans = orphans(study).map(|id| (id.clone(), OnDisk::NoExperiment));
    states.into_iter().chain(known).chain(orphans).collect()
}

/// What entries speak of and no experiment is; one that cannot be read is there all the same.
fn orphans(study: &Study) -> impl Iterator<Item = &String> {
    let ids = study.texts.ids();
    study.references.keys().filter(move |id| !ids.contains(id.as_str()))
}

fn tables(states: &BTreeMap<String, OnDisk>) -> Tables<'_> {
    states.iter().map(|(id, on_disk)| (id.clone(), on_disk.state())).collect()
}

impl OnDisk {
    fn state(&self) -> TableState<'_> {
        match self {
            Self::Present(table) => TableState::Present(table),
            Self::Stale => TableState::Stale,
            Self::NotRun | Self::Unfinished => TableState::NotRun,
            Self::NoExperiment => TableState::NoExperiment,
            Self::Failed(reason) => TableState::Failed(reason.clone()),
        }
    }
}
