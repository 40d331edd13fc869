//! `shotdamp` and `shotdamp run`: simulate what is stale, then judge, draw and write.

use super::args::{Args, Choice, RunArgs};
use super::dry_run::dry_run;
use super::error::CliError;
use super::exit::Exit;
use super::output::{print, print_error, print_unread};
use super::select::{Chosen, choose};
use super::simulate::{How, Ran, held, simulate, tell_failures};
use crate::report::{Published, doubts, judge_all, publish, summary_of};
use crate::study::{Item, Layout, Lock, RunTimes, Snapshot, State, Study, Texts, save};

/// Brings the chosen experiments up to date.
pub(super) fn update(layout: &Layout, args: &RunArgs, common: &Args) -> Result<Exit, CliError> {
    if args.choice.is_all() && !args.force && !args.tables && !args.times && !args.verify {
        // The short way: no lock, no YAML, no table, no thread.
        if let Some(snapshot) = Snapshot::current(layout, &Texts::read(layout)?) {
            print(&format!("Nothing to do.\n{}", snapshot.summary))?;
            return Ok(Exit::from_code(snapshot.exit_code));
        }
    }
    if args.dry_run {
        return dry_run(layout, args, common);
    }
    // Figures are drawn on the shared pool.
    super::start_threads(common);
    let _lock = Lock::of_study(layout, held(args.no_wait))?;
    let study = Study::new(layout.clone(), Texts::read(layout)?);
    let chosen = choose(&study, &args.choice)?;
    print_unread(chosen.unread.iter().copied());
    let todo = todo(&chosen, args);
    let row_limit = args.row_limit.unwrap_or_default();
    let how = How { threads: common.threads(), quiet: common.quiet, shard: None, row_limit, anew: args.force };
    let Ran { restored, unsaved } =
        simulate(layout, &todo, how, |item, finished| save(layout, item, finished).map(|_| ()))?;
    if args.times {
        RunTimes::of(layout, study.items.iter().map(|item| &item.source.experiment.id)).write(layout)?;
    }
    let experiments = todo.len() - restored;
    let done = Done { verb: "simulated", experiments, restored, problems: unsaved, tables_only: args.tables };
    conclude(layout, study.texts.clone(), &args.choice, done)
}

/// What was done before the verdicts.
pub(super) struct Done {
    /// What, in a word.
    pub verb: &'static str,
    /// To how many experiments.
    pub experiments: usize,
    /// Experiments whose rows all stood in earlier tables.
    pub restored: usize,
    /// What went wrong, in words.
    pub problems: Vec<String>,
    /// Leave figures and reports as they are.
    pub tables_only: bool,
}

/// Judges, draws, writes and tells; from the texts that were read in the beginning, and the results that are on disk now.
pub(super) fn conclude(layout: &Layout, texts: Texts, choice: &Choice, done: Done) -> Result<Exit, CliError> {
    let study = Study::new(layout.clone(), texts);
    let chosen = choose(&study, choice)?;
    let judgement = judge_all(&study);
    // First what went wrong: that nothing can be published may be for the same reason.
    for problem in &done.problems {
        print_error(&format!("error: {problem}\n"));
    }
    let failed = tell_failures(&chosen);
    let published = if done.tables_only { Published::default() } else { publish(&study, &judgement, &chosen.ids)? };
    for problem in &published.problems {
        print_error(&format!("error: {problem}\n"));
    }
    let whole_work = done.problems.is_empty() && published.problems.is_empty() && !failed;
    let exit = chosen.exit(&judgement).max(if whole_work { Exit::AsExpected } else { Exit::CouldNot });
    let text = summary_of(&judgement, &chosen.ids) + &doubts(&judgement, &chosen.ids);
    if choice.is_all() && whole_work && !done.tables_only && chosen.unread.is_empty() {
        Snapshot::take(layout, &study.texts, published.outputs, &text, exit.code())?;
    }
    let (all, Done { verb, experiments, restored, .. }) = (chosen.items.len(), done);
    let written = published.written;
    let restored = if restored == 0 { String::new() } else { format!(", {restored} restored") };
    print(&format!(
        "{all} experiments: {experiments} {verb}{restored}; {written} figures and reports written.\n{text}"
    ))?;
    Ok(exit)
}

/// What there is to do, among the chosen ones.
pub(super) fn todo<'a>(chosen: &Chosen<'a>, args: &RunArgs) -> Vec<&'a Item> {
    chosen.items.iter().copied().filter(|item| args.force || !matches!(item.state, State::Current(_))).collect()
}
