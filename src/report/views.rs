//! What the report writes from, gathered: links as they stand in the written files, assumptions with the entries that depend on them.

use std::collections::{BTreeMap, BTreeSet};

use super::figures::figure_name;
use super::other_pages::PAGES;
use super::verdicts::Judgement;
use crate::experiment::{Experiment, FigureSpec};
use crate::reference::Judged;
use crate::report::{
    self, AccuracyLinks, AssumptionView, CheckView, CheckedEntry, ExperimentView, FigureView, PageView, Trouble,
    value_in_words,
};
use crate::scene::{Assumption, Scene, effects};
use crate::study::{Heading, Item, Picture, RunTimes, table_name};
use crate::study::{Study, Unread};
use crate::text::words;

/// The page of an experiment.
pub(super) fn page(study: &Study, judgement: &Judgement, item: &Item) -> String {
    let experiment = &item.source.experiment;
    let up = to_reports(item);
    report::page(&PageView {
        experiment,
        table: judgement.tables.get(&experiment.id.0),
        judged: judged(judgement, &experiment.id.0),
        assumptions: &assumptions(study, &|name| item.used.contains(name), &|_| Vec::new()),
        effects: &effects(&scenes(study, experiment)),
        figures: &figures(pictures(experiment), ""),
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
    let planned = study.items.iter().map(|item| planned(judgement, item));
    let known = study.known.values().map(|known| (known.heading.clone(), known.folder.as_str(), known.figures.clone()));
    let mut views: Vec<ExperimentView<'_>> =
        planned.chain(known).map(|one| listed(judgement, one, times.as_ref())).collect();
    views.sort_by(|a, b| a.experiment.id.cmp(&b.experiment.id));
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
    report::index(&views, &assumptions(study, &|_| true, &|name| entries_that_use(study, name)), &others, machine)
}

/// An experiment in the index: its name, folder and figures.
type Listed<'a> = (Heading, &'a str, Vec<Picture>);

fn planned<'a>(judgement: &Judgement, item: &'a Item) -> Listed<'a> {
    let experiment = &item.source.experiment;
    // A figure is there once there is a table to draw it from.
    let drawn = judgement.tables.contains_key(&experiment.id.0);
    let pictures = if drawn { pictures(experiment) } else { Vec::new() };
    (Heading::of(experiment), item.source.folder(), pictures)
}

fn listed<'a>(
    judgement: &'a Judgement,
    (experiment, folder, pictures): Listed<'_>,
    times: Option<&RunTimes>,
) -> ExperimentView<'a> {
    let folder = if folder.is_empty() { String::new() } else { format!("{folder}/") };
    ExperimentView {
        judged: judged(judgement, &experiment.id.0),
        seconds: times.and_then(|times| times.seconds.get(&experiment.id.0)).copied(),
        page: format!("{folder}{}.md", experiment.id),
        figures: figures(pictures, &folder),
        experiment,
    }
}

/// The figures of an experiment.
pub(super) fn pictures(experiment: &Experiment) -> Vec<Picture> {
    let picture =
        |figure: &FigureSpec| Picture { file: figure_name(experiment, figure), caption: figure.caption.clone() };
    experiment.figures.iter().map(picture).collect()
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
    let files = study.reference_names();
    let mut entries = Vec::new();
    for id in ids {
        let file = files.get(id).copied().unwrap_or_default();
        let lines = study.references.get(*id).into_iter().flat_map(|file| &file.entries).map(|entry| entry.line);
        let lines = lines.chain(study.known.get(*id).into_iter().flat_map(|known| known.lines.iter().copied()));
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

fn figures(pictures: Vec<Picture>, folder: &str) -> Vec<FigureView> {
    let view = |picture: Picture| FigureView { link: format!("{folder}{}", picture.file), caption: picture.caption };
    pictures.into_iter().map(view).collect()
}

/// Ids of the entries whose experiments depend on an assumption.
fn entries_that_use(study: &Study, name: &Assumption) -> Vec<String> {
    let planned = study.items.iter().filter(|item| item.used.contains(name)).filter_map(|item| {
        let id = &item.source.experiment.id.0;
        let ids = study.references.get(id)?.entries.iter().map(|entry| entry.id.as_str()).collect::<Vec<_>>();
        Some((id.as_str(), ids))
    });
    let known = study.known.iter().filter(|(_, known)| known.used.contains(name));
    let known = known.map(|(id, known)| (id.as_str(), known.judged.iter().map(|one| one.id.as_str()).collect()));
    let by_experiment: BTreeMap<&str, Vec<&str>> = planned.chain(known).collect();
    by_experiment.into_values().flatten().map(str::to_owned).collect()
}

fn assumptions(
    study: &Study,
    wanted: &dyn Fn(&Assumption) -> bool,
    used_by: &dyn Fn(&Assumption) -> Vec<String>,
) -> Vec<AssumptionView> {
    let entries = study.sheet.entries.iter().filter(|(name, _)| wanted(name));
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
