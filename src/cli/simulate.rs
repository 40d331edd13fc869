//! What commands that simulate share: lock, threads, progress, and the report of failed rows.

use std::collections::BTreeMap;
use std::path::PathBuf;
use std::sync::Mutex;

use rayon::prelude::*;

use super::error::CliError;
use super::output::print_error;
use super::select::Chosen;
use crate::study::{
    Engine, EventHandler, Finished, Held, IgnoreEvents, Item, KnownRows, Layout, Progress, Shard, Spent, State, Task,
    journal_name, keep, run,
};
use crate::table::ParquetError;

/// Whether to wait for another run, which is described.
pub(super) fn held(no_wait: bool) -> impl FnOnce(&str) -> Held {
    move |holder| {
        if no_wait {
            return Held::GiveUp;
        }
        print_error(&format!("waiting for another run: {holder}\n"));
        Held::Wait
    }
}

/// How to run.
#[derive(Debug, Clone, Copy)]
pub(super) struct How {
    /// 0: one a processor.
    pub threads: usize,
    pub quiet: bool,
    pub shard: Option<Shard>,
    /// Simulate also the rows that earlier tables have.
    pub from_scratch: bool,
}

/// How it went.
#[derive(Debug, Default)]
pub(super) struct Ran {
    /// Experiments for which nothing had to be simulated.
    pub restored: usize,
    /// What could not be saved, in words.
    pub unsaved: Vec<String>,
}

/// Runs the items and has each saved as soon as it is finished; of those that an interrupt cuts short the rows are kept.
pub(super) fn simulate(
    layout: &Layout,
    items: &[&Item],
    how: How,
    save: impl Fn(&Item, &Finished) -> Result<(), ParquetError> + Sync,
) -> Result<Ran, CliError> {
    if items.is_empty() {
        return Ok(Ran::default());
    }
    let provenance: Vec<BTreeMap<String, String>> = items.iter().map(|item| item.provenance()).collect();
    let journal = |item: &&Item| {
        let id = &item.source.experiment.id;
        layout.path(&how.shard.map_or_else(|| journal_name(id), |shard| shard.journal_name(id)))
    };
    let journals: Vec<PathBuf> = items.iter().map(journal).collect();
    let known: Vec<KnownRows> = if how.from_scratch {
        items.iter().for_each(|item| Spent::forget(layout, &item.source.experiment.id));
        // What an interrupted search has evaluated; there is none of others.
        journals.iter().for_each(|journal| {
            let _ = std::fs::remove_file(journal);
        });
        items.iter().map(|_| KnownRows::nothing()).collect()
    } else {
        items.par_iter().map(|item| KnownRows::of(layout, item)).collect()
    };
    let tasks: Vec<Task<'_>> = items
        .iter()
        .zip(provenance.iter().zip(&journals))
        .zip(&known)
        .map(|((item, (metadata, journal)), known)| Task {
            shard: how.shard,
            known: Some(known),
            ..item.task(metadata, journal)
        })
        .collect();
    let progress = Progress::new();
    let handler: &dyn EventHandler = if how.quiet { &IgnoreEvents } else { &progress };
    let unsaved = Mutex::new(BTreeMap::new());
    let restored = run(&tasks, how.threads, &Engine, handler, |index, finished| {
        let item = items[index];
        let saved = if finished.interrupted { keep(layout, item, &finished) } else { save(item, &finished) };
        if let Err(error) = saved
            && let Ok(mut unsaved) = unsaved.lock()
        {
            unsaved.insert(index, format!("{}: {error}", item.source.experiment.id));
        }
        finished.spent.is_nothing()
    })?;
    let restored = restored.into_iter().filter(|restored| *restored).count();
    Ok(Ran { restored, unsaved: unsaved.into_inner().unwrap_or_default().into_values().collect() })
}

/// Prints which of the chosen experiments have rows without numbers; true if there are any.
pub(super) fn print_failures(chosen: &Chosen<'_>) -> bool {
    let mut failed = false;
    for item in &chosen.items {
        if let State::Failed(record) = &item.state {
            failed = true;
            let failures = &record.failures;
            let id = &item.source.experiment.id;
            print_error(&format!("error: {id}: {failures}\n"));
        }
    }
    failed
}
