//! `shotdamp` and `shotdamp run`: simulate what is stale, then judge, draw and write.

use std::collections::{BTreeMap, BTreeSet};
use std::path::PathBuf;

use super::args::{Args, Choice, RunArgs};
use super::dry_run::dry_run;
use super::error::CliError;
use super::exit::Exit;
use super::output::{print, print_error, print_progress, print_unread, print_warnings};
use super::select::{Found, choose, matched};
use super::simulate::{How, Ran, held, print_failures, simulate};
use crate::atomic::{check_writable, from_here};
use crate::report::{Elsewhere, INDEX, Judgement, Published, doubts, judge_all, publish, report_of, summary_of};
use crate::study::FileKind;
use crate::study::{Layout, Lock, RunTimes, STUDY, Snapshot, Study, before_run, remove_journals, save};
use crate::text::words::counted;

/// Brings the chosen experiments up to date.
pub(super) fn update(layout: &Layout, args: &RunArgs, common: &Args) -> Result<Exit, CliError> {
    let found = Found::look(layout)?;
    if !args.reads_all() && !args.tables && !args.times {
        // Without lock, YAML, table or thread.
        if let Some(ids) = matched(&found, &args.choice) {
            if !args.dry_run {
                found.snapshot.settle(layout);
            }
            print_warnings(found.snapshot.warnings(&found.texts).as_ref());
            return nothing_to_do(layout, &found.snapshot, &ids);
        }
    }
    if args.dry_run {
        return dry_run(layout, found, args, common);
    }
    // Figures are drawn on the shared pool.
    super::start_threads(common);
    let _lock = Lock::of_study(layout, held(args.no_wait))?;
    // Another run may have ended before this one got the lock.
    let found = if found.snapshot.is_latest(layout) { found } else { Found::look(layout)? };
    let mut study = found.open(layout, &args.choice, args.reads_all());
    args.limit.apply(&mut study);
    let chosen = choose(&study, &args.choice)?;
    print_unread(chosen.unread.iter().copied());
    print_warnings(study.warnings().as_ref());
    let todo = chosen.todo(args.force);
    if !args.choice.is_all() || todo.len() <= WARNED {
        for item in &todo {
            let experiment = &item.source.experiment;
            for warning in before_run(experiment, &study.sheet.assumptions()) {
                print_progress(&format!("warning: {}: {warning}\n", experiment.id));
            }
        }
    }
    // Before the simulations, which may take hours, and not after them.
    for item in todo.iter().filter(|_| !args.tables) {
        check_writable(&layout.path(&report_of(item.source.folder(), &item.source.experiment.id.0)))?;
    }
    if common.command.is_none() && !todo.is_empty() {
        print_progress(&announcement(&study, todo.len()));
    }
    let how = How { threads: common.threads(), quiet: common.quiet, shard: None, from_scratch: args.force };
    let Ran { restored, unsaved } =
        simulate(layout, &todo, how, |item, finished| save(layout, item, finished).map(|_| ()))?;
    if args.times {
        let known = study.known.values().map(|known| &known.heading.id);
        RunTimes::of(layout, study.items.iter().map(|item| &item.source.experiment.id).chain(known)).write(layout)?;
    }
    let (experiments, simulated) = (todo.len() - restored, !todo.is_empty());
    let done = Done { verb: "simulated", experiments, restored, problems: unsaved, tables_only: args.tables };
    // What was looked at while planning is still so where nothing was simulated.
    if simulated {
        study.refresh();
    }
    conclude(&study, &args.choice, done)
}

/// What a run of the whole study is about to do, for who has typed the bare command to see what it does.
fn announcement(study: &Study, experiments: usize) -> String {
    let title = study.about.title.as_ref().map_or_else(String::new, |title| format!(" {title}"));
    format!(
        "Bringing the study{title} in {} up to date: {} to simulate; Ctrl-C is safe, finished rows are kept.\n",
        study.layout.root().display(),
        counted(experiments, "experiment", "experiments")
    )
}

fn nothing_to_do(layout: &Layout, snapshot: &Snapshot, ids: &BTreeSet<&str>) -> Result<Exit, CliError> {
    let chosen = snapshot.experiments.iter().filter(|(id, _)| ids.contains(id.as_str()));
    let verdicts: BTreeMap<_, _> = chosen.map(|(id, known)| (id.clone(), known.judged.clone())).collect();
    let judgement = Judgement { verdicts, ..Judgement::default() };
    let known = |id: &str| snapshot.experiments.get(id).map(|known| known.folder.as_str());
    let page = page_to_open(layout, ids, known, Some(INDEX));
    print(&format!("Nothing to do.\n{}{page}", verdicts_of(&judgement, ids)))?;
    Ok(Exit::of_verdicts(judgement.verdicts.values().flatten()))
}

/// The verdicts in words, where there are any, and the rows whose numbers do not count.
fn verdicts_of(judgement: &Judgement, ids: &BTreeSet<&str>) -> String {
    let judged = ids.iter().any(|id| judgement.verdicts.get(*id).is_some_and(|judged| !judged.is_empty()));
    let summary = if judged { summary_of(judgement, ids) } else { String::new() };
    summary + &doubts(judgement, ids)
}

/// Experiments of a whole study that a run warns of; of more there would be dozens of warnings.
const WARNED: usize = 3;

/// Pages of experiments that are named where the index is not that of this run.
const NAMED: usize = 3;

/// The page to open next: of a single experiment its own, of several the `index`, or their own if there is none of this run; nothing
/// where it is not there.
fn page_to_open<'a>(
    layout: &Layout,
    ids: &BTreeSet<&'a str>,
    folder: impl Fn(&'a str) -> Option<&'a str>,
    index: Option<&str>,
) -> String {
    let own = ids.iter().filter_map(|id| Some(report_of(folder(id)?, id)));
    let names: Vec<String> = match index {
        Some(index) if ids.len() > 1 => vec![index.to_owned()],
        _ => own.collect(),
    };
    let paths: Vec<_> = names.iter().map(|name| layout.path(name)).filter(|path| path.is_file()).collect();
    let shown = |path: &PathBuf| format!("Result: {}\n", from_here(path));
    let mut text: String = paths.iter().take(NAMED).map(shown).collect();
    if paths.len() > NAMED {
        text += &format!("And {} in reports/.\n", counted(paths.len() - NAMED, "more page", "more pages"));
    }
    text
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

/// Judges, draws, writes and reports; from the texts that were read in the beginning, and the results that are on disk now.
pub(super) fn conclude(study: &Study, choice: &Choice, done: Done) -> Result<Exit, CliError> {
    let chosen = choose(study, choice)?;
    remove_journals(&study.layout, &study.items);
    let judgement = judge_all(study);
    // First what went wrong: that nothing can be published may be for the same reason.
    for problem in &done.problems {
        print_error(&format!("error: {problem}\n"));
    }
    let failed = print_failures(&chosen);
    let published = if done.tables_only { Published::default() } else { publish(study, &judgement, &chosen.ids)? };
    for problem in &published.problems {
        print_error(&format!("error: {problem}\n"));
    }
    let all_worked = done.problems.is_empty() && published.problems.is_empty() && !failed;
    let exit = chosen.exit(&judgement).max(if all_worked { Exit::AsExpected } else { Exit::CouldNot });
    let (written, elsewhere) = (published.written, published.elsewhere);
    if !done.tables_only {
        take_snapshot(study, published)?;
    }
    let (all, Done { verb, experiments, restored, tables_only, .. }) = (chosen.count(), done);
    if all > 0 {
        let all = counted(all, "experiment", "experiments");
        let restored = if restored == 0 { String::new() } else { format!(", {restored} restored") };
        let written = format!("{} written", counted(written, "figure or report", "figures and reports"));
        print(&format!("{all}: {experiments} {verb}{restored}; {written}.\n"))?;
    }
    print(&pages_left(elsewhere))?;
    let planned =
        |id| study.items.iter().find(|item| item.source.experiment.id.0 == id).map(|item| item.source.folder());
    let folder = |id| study.known.get(id).map(|known| known.folder.as_str()).or_else(|| planned(id));
    let index = elsewhere.is_none().then_some(INDEX);
    let page = if tables_only { String::new() } else { page_to_open(&study.layout, &chosen.ids, folder, index) };
    print(&(verdicts_of(&judgement, &chosen.ids) + &page))?;
    print_error(&chosen.left_out());
    Ok(exit)
}

/// Why the pages of the whole study were left as they are; nothing if they were not.
fn pages_left(elsewhere: Elsewhere) -> String {
    let Elsewhere { without_table, without_reference } = elsewhere;
    let tables = format!("{} no table here", counted(without_table, "experiment has", "experiments have"));
    let references = format!(
        "the {} cannot be read",
        counted(without_reference, "experiment whose reference", "experiments whose references")
    );
    match (without_table, without_reference) {
        (0, 0) => String::new(),
        (_, 0) => format!("The pages of the whole study are not updated: {tables}; `shotdamp run` makes them.\n"),
        (0, _) => format!("The pages of the whole study are not updated: of {references}.\n"),
        _ => format!("The pages of the whole study are not updated: {tables}, and of {references}.\n"),
    }
}

/// Writes down what is up to date now.
fn take_snapshot(study: &Study, published: Published) -> Result<(), CliError> {
    // What the study says of itself, or a calibration, has a say in every page.
    if study.unread.iter().any(|one| one.file() == STUDY || FileKind::of(one.file()) == Some(FileKind::Calibration)) {
        return Ok(());
    }
    let Published { experiments, of_the_study, .. } = published;
    let kept = study.known.keys().map(String::as_str).collect();
    Ok(Snapshot::take(&study.layout, &study.texts, &study.sheet, &kept, experiments, &of_the_study)?)
}
