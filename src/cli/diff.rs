//! `shotdamp diff`: what moved between two runs.

use std::cell::OnceCell;
use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::{Path, PathBuf};

use super::args::DiffArgs;
use super::error::CliError;
use super::exit::Exit;
use super::output::print;
use super::select::{matches, no_match, open};
use crate::atomic::place_of;
use crate::reference::{NoTable, WhyNoTable};
use crate::report::{self, Detail, Movement, Standing, VERDICTS, judge_tables};
use crate::study::{Item, Layout, Reason, State, Study};
use crate::table::{Table, parquet};

/// One of the two.
enum Side {
    Tables(BTreeMap<String, Table>),
    Verdicts(Vec<Standing>),
}

/// Prints what moved between two runs.
pub(super) fn diff(layout: &Layout, args: &DiffArgs) -> Result<Exit, CliError> {
    let a = args.a.clone().unwrap_or_else(|| layout.path(VERDICTS));
    let b = args.b.clone().unwrap_or_else(|| layout.results());
    let (before, now) = (Side::read(&a)?, Side::read(&b)?);
    if let Some(pattern) = &args.only {
        let ids: BTreeSet<String> = before.ids().chain(now.ids()).map(str::to_owned).collect();
        if !ids.iter().any(|id| matches(pattern, id)) {
            return Err(no_match(pattern, &ids.iter().map(String::as_str).collect()));
        }
    }
    let is_asked_for = |id: &str| args.only.as_deref().is_none_or(|pattern| matches(pattern, id));
    let opened = OnceCell::new();
    let study = || match opened.get() {
        Some(study) => Ok(study),
        None => open(layout).map(|study| opened.get_or_init(|| study)),
    };
    let own = [&a, &b].map(|path| place_of(&folder_of_tables(path)) == place_of(&layout.results()));
    let mut stale = Vec::new();
    for (is_own, side) in own.into_iter().zip([&before, &now]) {
        if let Side::Tables(tables) = side
            && is_own
        {
            stale.extend(stale_among(study()?, |id| tables.contains_key(id) && is_asked_for(id)));
        }
    }
    let mut not_run = Vec::new();
    let (movements, mut whole) = match (before, now) {
        (Side::Tables(mut a), Side::Tables(mut b)) => {
            [&mut a, &mut b].into_iter().for_each(|side| side.retain(|id, _| is_asked_for(id)));
            of_tables(&a, &b)
        }
        (a, b) => {
            let ((mut a, lacking_a), (mut b, lacking_b)) = (a.verdicts(study, own[0])?, b.verdicts(study, own[1])?);
            not_run = [lacking_a, lacking_b].concat();
            // Only now: their entries may read tables of other experiments.
            for side in [&mut a, &mut b] {
                side.retain(|one| !not_run.contains(&one.id) && is_asked_for(experiment_of(&one.id)));
            }
            not_run.retain(|id| is_asked_for(experiment_of(id)));
            let movement = report::between_verdicts(&a, &b);
            (vec![("verdicts".to_owned(), movement)], Vec::new())
        }
    };
    whole.extend(stale);
    let detail = if args.all { Detail::All } else { Detail::Farthest };
    print(&report::diff(&movements, &whole, &not_run, detail))?;
    let beyond = !whole.is_empty() || movements.iter().any(|(_, movement)| movement.is_beyond());
    Ok(if beyond { Exit::Unexpected } else { Exit::AsExpected })
}

/// Experiment by experiment, and those that only one of them has.
fn of_tables(a: &BTreeMap<String, Table>, b: &BTreeMap<String, Table>) -> (Vec<(String, Movement)>, Vec<String>) {
    let mut movements = Vec::new();
    let mut whole = Vec::new();
    for id in a.keys().chain(b.keys()).collect::<BTreeSet<_>>() {
        match (a.get(id), b.get(id)) {
            (Some(a), Some(b)) => movements.push((id.clone(), report::between_tables(a, b))),
            (Some(_), None) => whole.push(format!("{id}: only in the first")),
            _ => whole.push(format!("{id}: only in the second")),
        }
    }
    (movements, whole)
}

/// Those of the study's own tables that say nothing of the inputs as they are now.
fn stale_among(study: &Study, is_meant: impl Fn(&str) -> bool) -> Vec<String> {
    let says_nothing = |reason: &Reason| matches!(reason, Reason::Changed { .. } | Reason::MoreChanged { .. });
    let is_stale = |item: &&Item| matches!(&item.state, State::Stale(reasons) if reasons.iter().any(says_nothing));
    let ids = study.items.iter().filter(is_stale).map(|item| &item.source.experiment.id);
    ids.filter(|id| is_meant(&id.0)).map(|id| format!("{id}: its table is stale; shotdamp run {id}")).collect()
}

impl Side {
    fn read(path: &Path) -> Result<Self, CliError> {
        let unreadable = |path: &Path, problem: String| CliError::Unreadable { path: path.to_path_buf(), problem };
        let verdicts = if path.is_dir() { path.join("verdicts.json") } else { path.to_path_buf() };
        if verdicts.is_file() {
            if verdicts.extension().is_some_and(|ending| ending == "parquet") {
                return Err(CliError::OneTable(verdicts));
            }
            let text = fs::read_to_string(&verdicts).map_err(|error| unreadable(&verdicts, error.to_string()))?;
            return report::read_json(&text)
                .map(Self::Verdicts)
                .map_err(|error| unreadable(&verdicts, error.to_string()));
        }
        let files = tables_in(path).map_err(|error| unreadable(path, error.to_string()))?;
        if files.is_empty() {
            return Err(CliError::NoResults(path.to_path_buf()));
        }
        let read = |(id, file): (String, PathBuf)| {
            let table = parquet::read(&file).map_err(|error| unreadable(&file, error.to_string()))?;
            Ok((id, table))
        };
        files.into_iter().map(read).collect::<Result<_, CliError>>().map(Self::Tables)
    }

    /// Its experiments; one may be there several times.
    fn ids(&self) -> Box<dyn Iterator<Item = &str> + '_> {
        match self {
            Self::Tables(tables) => Box::new(tables.keys().map(String::as_str)),
            Self::Verdicts(verdicts) => Box::new(verdicts.iter().map(|one| experiment_of(&one.id))),
        }
    }

    /// Judged by the reference of this study, if it has not been, and the entries that read a table which has not been run.
    ///
    /// Entries of experiments that it does not have are left out: those of which the study has none, and in a folder that is not the study's
    /// `own` those of which there is no table, as nothing says that one is to come.
    fn verdicts<'s>(
        self,
        study: impl Fn() -> Result<&'s Study, CliError>,
        own: bool,
    ) -> Result<(Vec<Standing>, Vec<String>), CliError> {
        let (mut standings, is_judged) = match self {
            Self::Verdicts(verdicts) => (verdicts, true),
            Self::Tables(tables) => {
                (judge_tables(study()?, &tables).iter().map(report::standing).collect::<Vec<_>>(), false)
            }
        };
        let has_experiment = |one: &Standing| match &one.no_table {
            Some(NoTable { experiment, why }) if experiment == experiment_of(&one.id) => match why {
                WhyNoTable::NoExperiment => false,
                WhyNoTable::NotRun => own || is_judged,
                WhyNoTable::Stale | WhyNoTable::Failed => true,
            },
            _ => true,
        };
        standings.retain(has_experiment);
        let lacks_table = |one: &&Standing| one.no_table.as_ref().is_some_and(|table| table.why == WhyNoTable::NotRun);
        let not_run = standings.iter().filter(|_| !is_judged).filter(lacks_table).map(|one| one.id.clone()).collect();
        Ok((standings, not_run))
    }
}

/// The experiment of an entry.
fn experiment_of(entry: &str) -> &str {
    entry.split_once('/').map_or(entry, |(experiment, _)| experiment)
}

/// Where the tables are that a folder stands for: in it, or in its `results/`.
fn folder_of_tables(folder: &Path) -> PathBuf {
    let results = folder.join("results");
    if results.is_dir() { results } else { folder.to_path_buf() }
}

/// The tables that a folder stands for, by experiment.
fn tables_in(folder: &Path) -> std::io::Result<BTreeMap<String, PathBuf>> {
    let mut found = BTreeMap::new();
    for entry in fs::read_dir(folder_of_tables(folder))? {
        let path = entry?.path();
        let stem = path.file_stem().and_then(|stem| stem.to_str());
        if let (Some(stem), Some("parquet")) = (stem, path.extension().and_then(|extension| extension.to_str())) {
            found.insert(stem.to_owned(), path.clone());
        }
    }
    Ok(found)
}
