//! What the report writes from, gathered: links as they stand in the written files, assumptions with all who lean on them.

use std::collections::BTreeSet;

use super::figures::{figure_name, scene_name};
use super::other_pages::PAGES;
use super::verdicts::Judgement;
use crate::experiment::{Experiment, FigureSpec};
use crate::figure::sketch;
use crate::reference::Judged;
use crate::report::{
    self, AccuracyLinks, AssumptionView, CheckView, CheckedEntry, ExperimentView, FigureView, PageView, Trouble,
    value_in_words,
};
use crate::scene::{Assumption, Scene, effects};
use crate::study::{Item, RunTimes, table_name};
use crate::study::{Study, Unread};
use crate::text::words;

/// The page of an experiment.
pub(super) fn page(study: &Study, judgement: &Judgement, item: &Item) -> String {
    let experiment = &item.source.experiment;
    let used = experiment.assumptions_used(&study.sheet);
    let up = to_reports(item);
    report::page(&PageView {
        experiment,
        table: judgement.tables.get(&experiment.id.0),
        judged: judged(judgement, &experiment.id.0),
        assumptions: &assumptions(study, |name| used.contains(&name)),
        effects: &effects(&scenes(study, experiment)),
        figures: &[figures(experiment, ""), scene(study, experiment)].concat(),
        table_link: &format!("{up}../{}", table_name(&experiment.id)),
        accuracy: accuracy(study, item, &up),
        index_link: &format!("{up}README.md"),
    })
}

/// Links to what was measured, where it is there.
fn accuracy(study: &Study, item: &Item, up: &str) -> Option<AccuracyLinks> {
    let link = |ending: &str| {
        let name = format!("accuracy/{}.{ending}", item.source.experiment.id);
        study.layout.path(&format!("reports/{name}")).exists().then(|| format!("{up}{name}"))
    };
    Some(AccuracyLinks { page: link("md")?, picture: link("png") })
}

/// The index of all pages.
pub(super) fn index(study: &Study, judgement: &Judgement) -> String {
    let times = RunTimes::read(&study.layout);
    let listed = |item| listed(judgement, item, times.as_ref());
    let views: Vec<ExperimentView<'_>> = study.items.iter().map(listed).collect();
    let calibrations = study.calibrations.iter();
    let calibrations: Vec<(String, String)> = calibrations
        .map(|(id, calibration)| (format!("Calibration: {}", calibration.title), format!("calibrations/{id}.md")))
        .collect();
    let calibrations = calibrations.iter().map(|(title, page)| (title.as_str(), page.as_str()));
    let others: Vec<(&str, &str)> = PAGES
        .into_iter()
        .chain(calibrations)
        .filter(|(_, page)| study.layout.path(&format!("reports/{page}")).exists())
        .collect();
    let machine = times.as_ref().map(|times| &times.machine);
    report::index(&views, &assumptions(study, |_| true), &others, machine)
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
pub fn summary_of(judgement: &Judgement, ids: &BTreeSet<&str>) -> String {
    let judged: Vec<(&str, &[Judged])> = ids.iter().map(|id| (*id, judged(judgement, id))).collect();
    super::console::summary(&judged)
}

/// All entries of the experiments and reference files in `ids`, with the files that could not be used.
#[must_use]
pub fn check_view<'a>(
    study: &'a Study,
    judgement: &'a Judgement,
    ids: &BTreeSet<&'a str>,
    unread: &[&Unread],
) -> CheckView<'a> {
    let mut entries = Vec::new();
    for id in ids {
        let file = study.reference_name(id).unwrap_or_default();
        let lines = study.references.get(*id).into_iter().flat_map(|file| &file.entries).map(|entry| entry.line);
        let judged = judged(judgement, id).iter().zip(lines);
        entries.extend(judged.map(|(judged, line)| CheckedEntry { judged, file, line }));
    }
    let trouble = |one: &&Unread| Trouble { file: one.file().into(), line: one.line(), message: one.to_string() };
    CheckView { entries, troubles: unread.iter().map(trouble).collect() }
}

/// The verdicts of the whole study for programs.
pub(super) fn verdicts(study: &Study, judgement: &Judgement) -> String {
    let ids = judgement.verdicts.keys().map(String::as_str).collect();
    report::json(&check_view(study, judgement, &ids, &[]))
}

/// The scenes of the cases, under the assumptions in force.
#[must_use]
pub fn scenes(study: &Study, experiment: &Experiment) -> Vec<Scene> {
    let assumptions = study.sheet.assumptions();
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

/// The drawing of what is simulated, where there is one.
fn scene(study: &Study, experiment: &Experiment) -> Vec<FigureView> {
    let caption = "What is simulated; of a sweep its first case, with all places of dampers and forces.".into();
    let drawn = sketch(&scenes(study, experiment)).is_some();
    drawn.then(|| FigureView { link: scene_name(experiment), caption }).into_iter().collect()
}

fn assumptions(study: &Study, wanted: impl Fn(Assumption) -> bool) -> Vec<AssumptionView> {
    let used_by = |name: &Assumption| {
        let items =
            study.items.iter().filter(|item| item.source.experiment.assumptions_used(&study.sheet).contains(name));
        let files = items.filter_map(|item| study.references.get(&item.source.experiment.id.0));
        files.flat_map(|file| file.entries.iter().map(|entry| entry.id.clone())).collect()
    };
    let entries = study.sheet.entries.iter().filter(|(name, _)| wanted(**name));
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
