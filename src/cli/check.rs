//! `shotdamp check`: the verdicts for the tables on disk.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

use super::args::CheckArgs;
use super::destination::Destination;
use super::error::CliError;
use super::exit::Exit;
use super::output::{print, print_document, print_error, print_unread, print_warnings};
use super::select::{Chosen, choose, no_entry, open};
use crate::atomic::{self, FileError};
use crate::reference;
use crate::report::{
    self, CheckView, Judgement, Standing, check_view, departures, doubts, judge_all, self_test_all, summary_of,
};
use crate::study::{Layout, Study};

/// Where GitHub wants the summary of a step.
const STEP_SUMMARY: &str = "GITHUB_STEP_SUMMARY";

/// The verdicts, from the tables on disk.
pub(super) fn check(layout: &Layout, args: &CheckArgs) -> Result<Exit, CliError> {
    let alone = has_standard_output(layout, args)?;
    let study = open(layout)?;
    let chosen = choose(&study, &args.choice)?;
    print_unread(chosen.unread.iter().copied());
    print_warnings(study.warnings().as_ref());
    let judgement = judge_all(&study);
    if let (Some(id), Some(reason)) = (&args.accept, &args.reason) {
        return accept(&study, &judgement, id, reason);
    }
    let mut exit = chosen.exit(&judgement);
    let view = check_view(&study, &judgement, &chosen.ids, &chosen.unread);
    let mut text =
        if args.json { report::json(&view) } else { summary(&judgement, &chosen) + &doubts(&judgement, &chosen.ids) };
    if args.self_test {
        let (description, worst) = self_test(&study, &chosen);
        exit = exit.max(worst);
        // Standard output is the document's alone.
        if alone { print_error(&description) } else { text += &description }
    }
    if args.json {
        print_document(&text)?;
    } else if !alone {
        print(&text)?;
    }
    if args.reports {
        exit = exit.max(compare_reports(&study, &judgement, (!args.choice.is_all()).then_some(&chosen.ids), alone)?);
    }
    if let Some(to) = &args.junit {
        to.write(&report::junit(&view))?;
    }
    if let Some(to) = &args.markdown {
        to.write(&report::pull_request(&view, &committed(layout, args)?))?;
    }
    if args.github {
        github(&view)?;
    }
    Ok(exit)
}

/// The verdicts in words; nothing where all that was chosen could not be read, which has been said.
fn summary(judgement: &Judgement, chosen: &Chosen<'_>) -> String {
    let judged = chosen.ids.iter().any(|id| judgement.verdicts.get(*id).is_some_and(|judged| !judged.is_empty()));
    if judged || chosen.unread.is_empty() { summary_of(judgement, &chosen.ids) } else { String::new() }
}

/// True if a document has standard output for itself; the errors of destinations come before all work.
fn has_standard_output(layout: &Layout, args: &CheckArgs) -> Result<bool, CliError> {
    let files = [&args.junit, &args.markdown].into_iter().flatten();
    files.clone().try_for_each(|to| to.check(layout))?;
    let documents = files.filter(|to| **to == Destination::StandardOutput).count() + usize::from(args.json);
    // The annotations belong to a step's log.
    if documents + usize::from(args.github) > 1 && documents > 0 {
        return Err(CliError::TwoDocuments);
    }
    Ok(documents > 0)
}

/// The verdicts before; none if this study has never written any.
fn committed(layout: &Layout, args: &CheckArgs) -> Result<Vec<Standing>, CliError> {
    let path = args.against.clone().unwrap_or_else(|| layout.path(report::VERDICTS));
    let unreadable = |problem: String| CliError::Unreadable { path: path.clone(), problem };
    match std::fs::read_to_string(&path) {
        Ok(text) => report::read_json(&text).map_err(|error| unreadable(error.to_string())),
        Err(error) if args.against.is_none() && error.kind() == std::io::ErrorKind::NotFound => Ok(Vec::new()),
        Err(error) => Err(unreadable(error.to_string())),
    }
}

/// What could not be made to fail, and how many could.
fn self_test(study: &Study, chosen: &Chosen<'_>) -> (String, Exit) {
    let ids: Vec<&str> = chosen.ids.iter().copied().collect();
    let failures = self_test_all(study, &ids);
    for failure in &failures {
        print_error(&format!("error: {} cannot fail: {}\n", failure.id, failure.reason));
    }
    let entries: usize = ids.iter().filter_map(|id| study.references.get(*id)).map(|file| file.entries.len()).sum();
    let description = format!("self-test: {} of {entries} entries can fail\n", entries - failures.len());
    (description, if failures.is_empty() { Exit::AsExpected } else { Exit::Unexpected })
}

/// Whether the reports are those of these tables: all of them, or those of the experiments in `only`.
fn compare_reports(
    study: &Study,
    judgement: &Judgement,
    only: Option<&BTreeSet<&str>>,
    alone: bool,
) -> Result<Exit, CliError> {
    let departures = departures(study, judgement, only);
    for departure in &departures {
        print_error(&format!("error: {departure}\n"));
    }
    if departures.is_empty() && !alone {
        print("reports are up to date\n")?;
    }
    Ok(if departures.is_empty() { Exit::AsExpected } else { Exit::Unexpected })
}

fn github(view: &CheckView<'_>) -> Result<(), CliError> {
    print_document(&report::annotations(view))?;
    let Some(file) = std::env::var_os(STEP_SUMMARY).filter(|file| !file.is_empty()).map(PathBuf::from) else {
        return Ok(());
    };
    append_summary(&file, view).map_err(|source| FileError::new("write", &file, source))?;
    Ok(())
}

/// Behind what the step has written already, and with it no longer than is allowed.
fn append_summary(file: &Path, view: &CheckView<'_>) -> std::io::Result<()> {
    use std::io::Write;
    let mut file = std::fs::File::options().create(true).append(true).open(file)?;
    let written = usize::try_from(file.metadata()?.len()).unwrap_or(usize::MAX);
    file.write_all(report::step_summary(view, report::SUMMARY_LIMIT.saturating_sub(written)).as_bytes())
}

fn accept(study: &Study, judgement: &Judgement, id: &str, reason: &str) -> Result<Exit, CliError> {
    let unknown = || no_entry(id, judgement);
    let (experiment, _) = id.split_once('/').ok_or_else(unknown)?;
    let judged =
        judgement.verdicts.get(experiment).into_iter().flatten().find(|one| one.id == id).ok_or_else(unknown)?;
    let name = *study.reference_names().get(experiment).ok_or_else(unknown)?;
    let (reference, bytes) = study.references.get(experiment).zip(study.texts.bytes(name)).ok_or_else(unknown)?;
    let text = String::from_utf8_lossy(bytes);
    let changed = reference::accept(reference, &text, judged, reason)?;
    atomic::write(&study.layout.path(name), changed.as_bytes())?;
    print(&format!("{name}: {id} expects {} now, was {}\n", judged.verdict.word(), judged.expected.word()))?;
    Ok(Exit::AsExpected)
}
