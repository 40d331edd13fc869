//! `shotdamp show ID`: the experiment in words.

use std::time::Duration;

use super::args::Choice;
use super::error::CliError;
use super::exit::Exit;
use super::output::{columns, print, print_unread};
use super::select::{choose, open};
use crate::accuracy::idle_cases;
use crate::dynamics::{Allowance, Limit};
use crate::experiment::Experiment;
use crate::report::{scenes, value_in_words};
use crate::scene::{Scene, effects};
use crate::study::{Item, Layout, State, Study, forecast};
use crate::text::words::counted;

/// How long the proof that particles stay on their floors may take; cases beyond it count as not proved.
const PATIENCE: Duration = Duration::from_millis(500);

/// Prints all that is known of an experiment before it runs.
pub(super) fn show(layout: &Layout, id: &str) -> Result<Exit, CliError> {
    let study = open(layout)?;
    let chosen = choose(&study, &Choice { patterns: vec![id.into()], folder: None })?;
    print_unread(chosen.unread.iter().copied());
    let texts: Vec<String> = chosen.items.iter().map(|item| describe(&study, item)).collect();
    print(&texts.join("\n"))?;
    Ok(if chosen.unread.is_empty() { Exit::AsExpected } else { Exit::CouldNot })
}

fn describe(study: &Study, item: &Item) -> String {
    let experiment = &item.source.experiment;
    let source = &experiment.source;
    let section = source.section.as_ref().map(|section| format!("s. {section}"));
    let place: Vec<String> = section.into_iter().chain(source.shown_in.iter().cloned()).collect();
    let place = if place.is_empty() { String::new() } else { place.join(", ") + "; " };
    let mut text = format!("{}: {}\n", experiment.id, experiment.title);
    text += &format!("{place}{}\n\n{}\n", item.source.file, experiment.about);

    let scenes = scenes(study, experiment);
    let first = experiment.cases.first().map(|case| case.describe()).filter(|case| !case.is_empty());
    text += &format!("\nScene{}\n", first.map_or_else(String::new, |case| format!(" of the first case ({case})")));
    for line in scenes.first().map(Scene::describe).unwrap_or_default() {
        text += &format!("  {line}\n");
    }
    text += "\nEffects\n";
    let rows: Vec<Vec<String>> = effects(&scenes)
        .into_iter()
        .map(|effect| {
            let state = match effect.in_force {
                0 => format!("left out: {}", effect.why_not),
                n if n == effect.cases => "in force".into(),
                n => format!("in force in {n} of {}", counted(effect.cases, "case", "cases")),
            };
            vec![format!("  {}", effect.name), state]
        })
        .collect();
    text += &columns(&rows);
    text += &idle(experiment, &scenes);

    text += if item.used.is_empty() { "" } else { "\nAssumptions\n" };
    for (name, entry) in study.sheet.iter().filter(|(name, _)| item.used.contains(*name)) {
        text += &format!("  {name} = {}\n", value_in_words(entry.kind.unit(), &entry.value));
        text += &wrapped(&entry.reason, "      ", 100);
    }

    text += "\nCases\n";
    let mut solvers: Vec<String> = Vec::new();
    for (_, solver) in experiment.runs() {
        if !solvers.contains(&solver.label()) {
            solvers.push(solver.label());
        }
    }
    let (rows, simulations) = item.size();
    let cases = counted(experiment.cases.len(), "case", "cases");
    text += &format!("  {cases}, under {}\n", solvers.join(" and "));
    if item.variants.len() > 1 {
        let ends: Vec<&str> = item.variants.iter().skip(1).map(|variant| variant.label.as_str()).collect();
        text += &format!("  and event-driven with each of {}\n", ends.join(", "));
    }
    text += &format!(
        "  {}, {} at most\n",
        counted(rows, "row", "rows"),
        counted(usize::try_from(simulations).unwrap_or(usize::MAX), "simulation", "simulations")
    );
    for warning in forecast(experiment, &study.sheet.assumptions()) {
        text += &format!("  warning: {warning}\n");
    }
    let state = match &item.state {
        State::Current(_) => "up to date",
        State::Failed(_) => "computed, with failed rows",
        State::Stale(_) => "stale",
    };
    text += &format!("\nFingerprint {}\n({state})\n", item.fingerprint);
    text
}

/// Cases in which what only a particle in flight can meet is named and provably never met.
fn idle(experiment: &Experiment, scenes: &[Scene]) -> String {
    let limit = Limit { time: PATIENCE, ..Limit::default() };
    match Allowance::new(limit).simulate(|| idle_cases(experiment, scenes)) {
        0 => String::new(),
        count => format!(
            "  In {count} of {} it is proved that no particle leaves its floor: ceilings, stops and impacts are idle \
             there and skipped.\n",
            counted(scenes.len(), "case", "cases")
        ),
    }
}

/// The text wrapped at `width` letters, each line after a margin.
fn wrapped(text: &str, margin: &str, width: usize) -> String {
    let mut lines: Vec<String> = Vec::new();
    for word in text.split_whitespace() {
        match lines.last_mut() {
            Some(line) if line.chars().count() + 1 + word.chars().count() <= width => {
                line.push(' ');
                line.push_str(word);
            }
            _ => lines.push(word.into()),
        }
    }
    lines.into_iter().map(|line| format!("{margin}{line}\n")).collect()
}
