//! What the report writes from, gathered: links as they stand in the written files, assumptions with the entries that depend on them.

use std::collections::{BTreeMap, BTreeSet};

use super::figures::{figure_name, scene_name};
use super::index::{OVERVIEW, STRIP};
use super::motions::PAGE as WHAT_MOVES;
use super::other_pages::PAGES;
use super::prose;
use super::verdicts::Judgement;
use super::what_stands::PAGE as WHAT_STANDS;
use crate::experiment::{AssumptionName, Experiment, FigureSpec, value_in_words};
use crate::figure::is_sketched;
use crate::reference::Judged;
use crate::report::{
    self, AccuracyLinks, AssumptionView, CheckView, CheckedEntry, ExperimentView, FigureView, PageView, Trouble,
};
use crate::scene::{Scene, effects};
use crate::study::{Heading, Item, Motions, Refused, RunTimes, Study, table_name};

/// Figures for which there is no picture, by the name that a page links, with the reason.
pub(super) type Undrawn = BTreeMap<String, String>;

/// The page of an experiment.
pub(super) fn page(study: &Study, judgement: &Judgement, item: &Item, undrawn: &Undrawn) -> String {
    let experiment = &item.source.experiment;
    let up = to_reports(item);
    let scenes = scenes(study, experiment);
    report::page(&PageView {
        experiment,
        table: judgement.tables.get(&experiment.id.0),
        motions: judgement.motions.get(&experiment.id.0),
        judged: judged(judgement, &experiment.id.0),
        not_judged: study.references.get(&experiment.id.0).map_or(&[], |file| &file.not_judged),
        assumptions: &assumptions(study, judgement, &|name| item.used.contains(name), &|_| Vec::new()),
        effects: &effects(&scenes),
        figures: &[figures(experiment, undrawn), scene(experiment, &scenes)].concat(),
        table_name: &table_name(&experiment.id),
        accuracy: accuracy(study, item, &up),
        to_reports: &up,
    })
}

/// Links to what was measured, where it is there.
fn accuracy(study: &Study, item: &Item, up: &str) -> Option<AccuracyLinks> {
    let name = format!("accuracy/{}.md", item.source.experiment.id);
    let exists = study.layout.path(&format!("reports/{name}")).exists();
    exists.then(|| AccuracyLinks { page: format!("{up}{name}") })
}

/// The page of an experiment, by name below `reports/`.
pub(super) fn page_name(item: &Item) -> String {
    below_reports(item.source.folder(), &item.source.experiment.id.0)
}

fn below_reports(folder: &str, id: &str) -> String {
    let folder = if folder.is_empty() { String::new() } else { format!("{folder}/") };
    format!("{folder}{id}.md")
}

/// The page of the experiment `id`, whose file lies in `folder` below `experiments/`, by name within the study.
#[must_use]
pub fn report_of(folder: &str, id: &str) -> String {
    format!("reports/{}", below_reports(folder, id))
}

/// All experiments in the order of the index.
pub(super) fn listed<'a>(study: &Study, judgement: &'a Judgement, times: Option<&RunTimes>) -> Vec<ExperimentView<'a>> {
    let planned = study.items.iter().map(|item| {
        let experiment = &item.source.experiment;
        let motions = judgement.motions.get(&experiment.id.0).cloned();
        one_listed(judgement, Heading::of(experiment), item.source.folder(), motions, times)
    });
    let known = study
        .known
        .values()
        .map(|known| one_listed(judgement, known.heading.clone(), &known.folder, known.motions.clone(), times));
    let mut views: Vec<ExperimentView<'_>> = planned.chain(known).collect();
    views.sort_by(|a, b| a.experiment.id.cmp(&b.experiment.id));
    views
}

/// All assumptions with the entries that depend on them.
pub(super) fn all_assumptions(study: &Study, judgement: &Judgement) -> Vec<AssumptionView> {
    assumptions(study, judgement, &|_| true, &|name| entries_that_use(study, name))
}

/// What is written of the study as a whole, by name within the study.
pub(super) fn of_the_study(study: &Study, judgement: &Judgement) -> Vec<(String, String)> {
    let times = RunTimes::read(&study.layout);
    let views = listed(study, judgement, times.as_ref());
    let assumptions = all_assumptions(study, judgement);
    [
        ("README.md", index(study, &views, times.as_ref())),
        (STRIP, report::strip_svg(&views)),
        (OVERVIEW, report::overview_svg(&views)),
        ("assumptions.md", report::assumptions(&assumptions)),
        (WHAT_STANDS, report::what_stands(&views, &study.sheet, &assumptions)),
        (WHAT_MOVES, report::what_moves(&views)),
        ("tolerances.md", report::tolerances(&views)),
        ("verdicts.json", verdicts(study, judgement)),
    ]
    .map(|(name, text)| (format!("reports/{name}"), text))
    .into()
}

/// The index of all pages.
fn index(study: &Study, views: &[ExperimentView<'_>], times: Option<&RunTimes>) -> String {
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
    report::index(&study.about, views, &others, times.map(|times| &times.machine))
}

fn one_listed<'a>(
    judgement: &'a Judgement,
    experiment: Heading,
    folder: &str,
    motions: Option<Motions>,
    times: Option<&RunTimes>,
) -> ExperimentView<'a> {
    ExperimentView {
        judged: judged(judgement, &experiment.id.0),
        seconds: times.and_then(|times| times.seconds.get(&experiment.id.0)).copied(),
        motions,
        page: below_reports(folder, &experiment.id.0),
        experiment,
    }
}

/// The summary on the console, of the experiments and reference files in `ids`.
#[must_use]
pub fn summary_of(judgement: &Judgement, ids: &BTreeSet<&str>) -> String {
    let name = |id: &str| judgement.untabled.get(id).map_or_else(|| id.to_owned(), |why| format!("{id} ({why})"));
    let judged: Vec<(String, &[Judged])> = ids.iter().map(|id| (name(id), judged(judgement, id))).collect();
    super::console::summary(&judged)
}

/// All entries of the experiments and reference files in `ids`, with the files that could not be used.
#[must_use]
pub fn check_view<'a>(
    study: &'a Study,
    judgement: &'a Judgement,
    ids: &BTreeSet<&'a str>,
    unread: &[&Refused],
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
    let of_file = |one: &&Refused| {
        let trouble = |(line, message)| Trouble { file: one.file().into(), line, message };
        one.mistakes().into_iter().map(trouble).collect::<Vec<_>>()
    };
    CheckView { entries, troubles: unread.iter().flat_map(of_file).collect() }
}

/// The verdicts of the whole study for programs.
fn verdicts(study: &Study, judgement: &Judgement) -> String {
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

fn figures(experiment: &Experiment, undrawn: &Undrawn) -> Vec<FigureView> {
    let view = |figure: &FigureSpec| {
        let link = figure_name(experiment, figure);
        FigureView { missing: undrawn.get(&link).cloned(), link, caption: figure.caption.clone() }
    };
    experiment.figures.iter().map(view).collect()
}

/// The drawing of what is simulated, where there is one.
fn scene(experiment: &Experiment, scenes: &[Scene]) -> Vec<FigureView> {
    let caption = "What is simulated; of a sweep its first case, with all places of dampers and forces.".into();
    let drawn = is_sketched(scenes);
    drawn.then(|| FigureView { link: scene_name(experiment), caption, missing: None }).into_iter().collect()
}

/// Ids of the entries whose experiments depend on an assumption.
fn entries_that_use(study: &Study, name: &AssumptionName) -> Vec<String> {
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
    judgement: &Judgement,
    wanted: &dyn Fn(&AssumptionName) -> bool,
    used_by: &dyn Fn(&AssumptionName) -> Vec<String>,
) -> Vec<AssumptionView> {
    let entries = study.sheet.iter().filter(|(name, _)| wanted(name));
    entries
        .map(|(name, entry)| AssumptionView {
            name: name.to_string(),
            value: value_in_words(entry.kind.unit(), &entry.value),
            has_range: entry.has_range(),
            reason: prose::filled(&judgement.verdicts, &entry.reason, None),
            used_by: used_by(name),
            fitted_to: entry.fitted_to.clone(),
        })
        .collect()
}
