//! What the report writes from, gathered: links as they stand in the written files, assumptions with all who lean on them.

use std::collections::BTreeSet;

use super::figures::figure_name;
use super::opened::{Opened, Unread};
use super::otherwise::PAGES;
use super::verdicts::Judgement;
use crate::reference::Judged;
use crate::report::{
    self, AccuracyLinks, AssumptionView, CheckView, CheckedEntry, ExperimentView, FigureView, PageView, Trouble,
    value_in_words,
};
use crate::scene::{Assumption, Scene, effects};
use crate::spec::{Experiment, FigureSpec};
use crate::study::{Item, RunTimes, table_name};
use crate::text::words;

/// The page of an experiment.
pub(super) fn page(opened: &Opened, judgement: &Judgement, item: &Item) -> String {
    let experiment = &item.source.experiment;
    let used = experiment.assumptions_used(&opened.sheet);
    let up = to_reports(item);
    report::page(&PageView {
        experiment,
        table: judgement.tables.get(&experiment.id.0),
        judged: judged(judgement, &experiment.id.0),
        assumptions: &assumptions(opened, |name| used.contains(&name)),
        effects: &effects(&scenes(opened, experiment)),
        figures: &figures(experiment, ""),
        table_link: &format!("{up}../{}", table_name(&experiment.id)),
        accuracy: accuracy(opened, item, &up),
        index_link: &format!("{up}README.md"),
    })
}

/// Links to what was measured, where it is there.
fn accuracy(opened: &Opened, item: &Item, up: &str) -> Option<AccuracyLinks> {
    let link = |ending: &str| {
        let name = format!("accuracy/{}.{ending}", item.source.experiment.id);
        opened.layout.path(&format!("reports/{name}")).exists().then(|| format!("{up}{name}"))
    };
    Some(AccuracyLinks { page: link("md")?, picture: link("png") })
}

/// The index of all pages.
pub(super) fn index(opened: &Opened, judgement: &Judgement) -> String {
    let times = RunTimes::read(&opened.layout);
    let listed = |item| listed(judgement, item, times.as_ref());
    let views: Vec<ExperimentView<'_>> = opened.items.iter().map(listed).collect();
    let calibrations = opened.calibrations.iter();
    let calibrations: Vec<(String, String)> = calibrations
        .map(|(id, calibration)| (format!("Calibration: {}", calibration.title), format!("calibrations/{id}.md")))
        .collect();
    let calibrations = calibrations.iter().map(|(title, page)| (title.as_str(), page.as_str()));
    let others: Vec<(&str, &str)> = PAGES
        .into_iter()
        .chain(calibrations)
        .filter(|(_, page)| opened.layout.path(&format!("reports/{page}")).exists())
        .collect();
    let machine = times.as_ref().map(|times| &times.machine);
    report::index(&views, &assumptions(opened, |_| true), &others, machine)
}

fn listed<'a>(judgement: &'a Judgement, item: &'a Item, times: Option<&RunTimes>) -> ExperimentView<'a> {
    let experiment = &item.source.experiment;
    let folder = match item.source.folder() {
        "" => String::new(),
        folder => format!("{folder}/"),
    };
    // A figure is there once there is a table to draw it from.
    let drawn = judgement.tables.contains_key(&experiment.id.0);
    ExperimentView {
        experiment,
        judged: judged(judgement, &experiment.id.0),
        seconds: times.and_then(|times| times.seconds.get(&experiment.id.0)).copied(),
        page: format!("{folder}{}.md", experiment.id),
        figures: if drawn { figures(experiment, &folder) } else { Vec::new() },
    }
}

/// The summary on the console, of the experiments and reference files in `ids`.
#[must_use]
pub fn summary(judgement: &Judgement, ids: &BTreeSet<&str>) -> String {
    let judged: Vec<(&str, &[Judged])> = ids.iter().map(|id| (*id, judged(judgement, id))).collect();
    report::summary(&judged)
}

/// All entries of the experiments and reference files in `ids`, with the files that could not be used.
#[must_use]
pub fn check_view<'a>(
    opened: &'a Opened,
    judgement: &'a Judgement,
    ids: &BTreeSet<&'a str>,
    unread: &[&Unread],
) -> CheckView<'a> {
    let mut entries = Vec::new();
    for id in ids {
        let file = opened.reference_name(id).unwrap_or_default();
        let lines = opened.references.get(*id).into_iter().flat_map(|file| &file.entries).map(|entry| entry.line);
        let judged = judged(judgement, id).iter().zip(lines);
        entries.extend(judged.map(|(judged, line)| CheckedEntry { judged, file, line }));
    }
    let trouble = |one: &&Unread| Trouble { file: one.file().into(), line: one.line(), message: one.to_string() };
    CheckView { entries, troubles: unread.iter().map(trouble).collect() }
}

/// The verdicts of the whole study for programs.
pub(super) fn verdicts(opened: &Opened, judgement: &Judgement) -> String {
    let ids = judgement.verdicts.keys().map(String::as_str).collect();
    report::json(&check_view(opened, judgement, &ids, &[]))
}

/// The scenes of the cases, under the assumptions in force.
#[must_use]
pub fn scenes(opened: &Opened, experiment: &Experiment) -> Vec<Scene> {
    let assumptions = opened.sheet.assumptions();
    // Validation has tried every case; one that does not resolve would fail as a row of the table, with its reason.
    let scene = |case| experiment.recipe_of(case).ok()?.resolve(&assumptions).ok();
    experiment.cases.iter().filter_map(scene).collect()
}

fn judged<'a>(judgement: &'a Judgement, id: &str) -> &'a [Judged] {
    judgement.verdicts.get(id).map_or(&[], Vec::as_slice)
}

/// From the page's folder to `reports/`.
fn to_reports(item: &Item) -> String {
    let folders = item.source.folder().split('/').filter(|folder| !folder.is_empty()).count();
    "../".repeat(folders)
}

fn figures(experiment: &Experiment, folder: &str) -> Vec<FigureView> {
    let view = |figure: &FigureSpec| FigureView {
        link: format!("{folder}{}", figure_name(experiment, figure)),
        caption: figure.caption.clone(),
    };
    experiment.figures.iter().map(view).collect()
}

fn assumptions(opened: &Opened, wanted: impl Fn(Assumption) -> bool) -> Vec<AssumptionView> {
    let used_by = |name: &Assumption| {
        let items =
            opened.items.iter().filter(|item| item.source.experiment.assumptions_used(&opened.sheet).contains(name));
        let files = items.filter_map(|item| opened.references.get(&item.source.experiment.id.0));
        files.flat_map(|file| file.entries.iter().map(|entry| entry.id.clone())).collect()
    };
    let entries = opened.sheet.entries.iter().filter(|(name, _)| wanted(**name));
    entries
        .map(|(name, entry)| AssumptionView {
            name: words::of_key(name),
            value: value_in_words(*name, &entry.value),
            reason: entry.reason.clone(),
            used_by: used_by(name),
            fitted_to: entry.fitted_to.clone(),
        })
        .collect()
}
