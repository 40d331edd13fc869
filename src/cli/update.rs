//! `shotdamp` and `shotdamp run`: simulate what is stale, then judge, draw and write.

use std::collections::BTreeMap;
use std::path::PathBuf;
use std::sync::Mutex;

use super::args::{Args, RunArgs};
use super::error::CliError;
use super::exit::Exit;
use super::output::{complain, complain_of, print};
use super::select::{Chosen, choose};
use crate::publish::{Opened, Published, judge_all, publish, summary};
use crate::study::{
    Engine, Item, Layout, Listen, Lock, Progress, Silence, Snapshot, State, Task, Texts, journal_name, run, save,
};

/// Brings the chosen experiments up to date.
pub(super) fn update(layout: &Layout, args: &RunArgs, common: &Args) -> Result<Exit, CliError> {
    let whole = args.choice.is_all();
    if whole && !args.force && !args.tables {
        // The short way: no lock, no YAML, no table, no thread.
        if let Some(snapshot) = Snapshot::current(layout, &Texts::read(layout)?) {
            print(&format!("Nothing to do.\n{}", snapshot.summary))?;
            return Ok(Exit::from_code(snapshot.exit_code));
        }
    }
    if args.dry_run {
        return dry_run(layout, args);
    }
    // Figures are drawn on the shared pool.
    super::threads(common.jobs);
    let threads = common.jobs.map_or(0, usize::from);
    let _lock = Lock::take(layout, || complain("waiting for another run in this study\n"))?;
    let opened = Opened::new(layout.clone(), Texts::read(layout)?);
    let chosen = choose(&opened, &args.choice)?;
    complain_of(chosen.unread.iter().copied());
    let todo = todo(&chosen, args);
    let unsaved = simulate(layout, &todo, threads, common.quiet)?;
    let simulated = todo.len();

    // From the texts that were read in the beginning, and the results that are on disk now.
    let texts = opened.texts.clone();
    let opened = Opened::new(layout.clone(), texts);
    let chosen = choose(&opened, &args.choice)?;
    let judgement = judge_all(&opened);
    let published = if args.tables { Published::default() } else { publish(&opened, &judgement, &chosen.ids)? };
    let failed = tell_failures(&chosen);
    for problem in unsaved.iter().chain(&published.problems) {
        complain(&format!("error: {problem}\n"));
    }
    let whole_work = unsaved.is_empty() && published.problems.is_empty() && !failed;
    let exit = chosen.exit(&judgement).max(if whole_work { Exit::AsExpected } else { Exit::CouldNot });
    let text = summary(&judgement, &chosen.ids);
    if whole && whole_work && !args.tables && chosen.unread.is_empty() {
        Snapshot::take(layout, &opened.texts, published.outputs, &text, exit.code())?;
    }
    print(&format!("{}\n{text}", told(&chosen, simulated, published.written)))?;
    Ok(exit)
}

/// What was done, in one line.
fn told(chosen: &Chosen<'_>, simulated: usize, written: usize) -> String {
    let experiments = chosen.items.len();
    format!("{experiments} experiments: {simulated} simulated; {written} figures and reports written.")
}

fn todo<'a>(chosen: &Chosen<'a>, args: &RunArgs) -> Vec<&'a Item> {
    chosen.items.iter().copied().filter(|item| args.force || !matches!(item.state, State::Current(_))).collect()
}

/// Runs and saves; returns in words what could not be saved.
fn simulate(layout: &Layout, items: &[&Item], threads: usize, quiet: bool) -> Result<Vec<String>, CliError> {
    if items.is_empty() {
        return Ok(Vec::new());
    }
    let provenance: Vec<BTreeMap<String, String>> = items.iter().map(|item| item.provenance()).collect();
    let journals: Vec<PathBuf> =
        items.iter().map(|item| layout.path(&journal_name(&item.source.experiment.id))).collect();
    let tasks: Vec<Task<'_>> = items
        .iter()
        .zip(&provenance)
        .zip(&journals)
        .map(|((item, metadata), journal)| item.task(metadata, journal))
        .collect();
    let progress = Progress::new();
    let listener: &dyn Listen = if quiet { &Silence } else { &progress };
    let unsaved = Mutex::new(BTreeMap::new());
    run(&tasks, threads, &Engine, listener, |index, finished| {
        if let Err(error) = save(layout, items[index], &finished)
            && let Ok(mut unsaved) = unsaved.lock()
        {
            unsaved.insert(index, format!("{}: {error}", items[index].source.experiment.id));
        }
    })?;
    Ok(unsaved.into_inner().unwrap_or_default().into_values().collect())
}

/// True if rows of the chosen experiments have no numbers.
fn tell_failures(chosen: &Chosen<'_>) -> bool {
    let mut failed = false;
    for item in &chosen.items {
        if let State::Failed(record) = &item.state {
            failed = true;
            let failures = &record.failures;
            let id = &item.source.experiment.id;
            complain(&format!("error: {id}: {} rows failed; the first: {}\n", failures.rows, failures.first));
        }
    }
    failed
}

fn dry_run(layout: &Layout, args: &RunArgs) -> Result<Exit, CliError> {
    let opened = super::select::open(layout)?;
    let chosen = choose(&opened, &args.choice)?;
    complain_of(chosen.unread.iter().copied());
    let todo = todo(&chosen, args);
    let mut text = String::new();
    for item in &todo {
        let (rows, simulations) = item.size();
        text += &format!("{}: {rows} rows, {simulations} simulations at most\n", item.source.experiment.id);
    }
    text += &format!("{} of {} experiments would be simulated\n", todo.len(), chosen.items.len());
    print(&text)?;
    Ok(if chosen.unread.is_empty() { Exit::AsExpected } else { Exit::CouldNot })
}
