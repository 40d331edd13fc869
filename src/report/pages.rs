//! Figures and reports of a study, written where they are not what they should be.

use std::collections::{BTreeMap, BTreeSet};
use std::fs;

use rayon::prelude::*;

use super::figures::{figure_name, picture, scene_name, shown, vector};
use super::json::read_json;
use super::publication::{inputs, reasons_beside, shows_same_scene};
use super::quoted::Said;
use super::verdicts::Judgement;
use super::views::{self, report_of};
use crate::atomic::{self, FileError};
use crate::experiment::{Experiment, FigureSpec};
use crate::figure::{FigureError, Picture, figure_stem, sketch};
use crate::measure::rounded;
use crate::reference::{Judged, ReferenceFile, Verdict};
use crate::study::FileKind;
use crate::study::{
    FileHash, Heading, Inputs, Item, Publication, Record, State, Study, Summary, record_name, stem, table_name,
};
use crate::table::{Table, UNDEFINED};

/// The verdicts for programs, within the study.
pub const VERDICTS: &str = "reports/verdicts.json";

/// Why there is no picture.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum NotDrawn {
    /// There is nothing to draw from.
    #[error("its table cannot be read")]
    NoTable,
    /// The figure does not fit the table.
    #[error(transparent)]
    Figure(#[from] FigureError),
    /// There is nothing to show, as no row has a number.
    #[error("{error}; {why}")]
    Undefined {
        /// As the figure says it.
        error: FigureError,
        /// Why the numbers are undefined.
        why: String,
    },
}

impl NotDrawn {
    /// The error of a figure, with the reason where its numbers are undefined.
    fn of(error: FigureError, table: &Table) -> Self {
        let undefined = table.texts(UNDEFINED).and_then(|cells| cells.iter().find(|cell| !cell.is_empty()));
        match (&error, undefined) {
            (FigureError::Nothing { .. }, Some(why)) => Self::Undefined { error, why: why.clone() },
            _ => Self::Figure(error),
        }
    }
}

/// What publishing did.
#[derive(Debug, Default)]
pub struct Published {
    /// Experiments that are up to date now, by id: their files, and what the rest of the study needs to know of them.
    pub experiments: BTreeMap<String, (BTreeSet<String>, Summary)>,
    /// Files of the study as a whole.
    pub of_the_study: BTreeSet<String>,
    /// Experiments that cannot be judged here and that those files have verdicts of: they are left as they are.
    pub elsewhere: Elsewhere,
    /// Files that were written.
    pub written: usize,
    /// Figures that were drawn; those that would show the same as before are not.
    pub drawn: usize,
    /// Figures that could not be drawn, in words.
    pub problems: Vec<String>,
}

/// Experiments that cannot be judged here and have a verdict in the reports, by the reason.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Elsewhere {
    /// Without a table, as in a study that was just cloned.
    pub without_table: usize,
    /// With a reference that cannot be read.
    pub without_reference: usize,
}

impl Elsewhere {
    /// There are none.
    #[must_use]
    pub fn is_none(self) -> bool {
        self == Self::default()
    }
}

/// An experiment whose table counts, while it is published.
struct Page<'a> {
    item: &'a Item,
    record: &'a Record,
    folder: String,
    /// What figures and report depend on.
    inputs: Inputs,
    stale: bool,
}

/// Draws what is stale, renders every page of the experiments in `ids` and the index, and writes what differs. Pages of others
/// that were planned are written where their figures are up to date: a verdict on them may have changed with a table that it
/// reads.
///
/// # Errors
/// [`FileError`] if a file cannot be written.
pub fn publish(study: &Study, judgement: &Judgement, ids: &BTreeSet<&str>) -> Result<Published, FileError> {
    let mut published = Published::default();
    let pages = study.items.iter().filter_map(|item| page(study, item));
    let pages: Vec<Page<'_>> = pages.filter(|page| !keeps_its_verdicts(study, page)).collect();
    let chosen = |page: &&Page<'_>| ids.contains(page.item.source.experiment.id.0.as_str());
    let stale = pages.iter().filter(chosen).filter(|page| page.stale);
    let jobs = stale.flat_map(jobs).filter(|(page, figure)| !is_drawn(study, judgement, page, figure));
    let mut figures = draw(study, judgement, jobs);
    published.drawn = figures.values().map(Vec::len).sum();
    for page in pages.iter().filter(|page| chosen(page) || !page.stale) {
        let id = page.item.source.experiment.id.0.as_str();
        let drawn = figures.remove(id).unwrap_or_default();
        write_page(study, judgement, page, drawn, &mut published)?;
    }
    published.elsewhere = judged_elsewhere(study);
    if published.elsewhere.is_none() {
        for (name, text) in views::of_the_study(study, judgement) {
            published.written += usize::from(atomic::write_if_changed(&study.layout.path(&name), text.as_bytes())?);
            published.of_the_study.insert(name);
        }
    }
    Ok(published)
}

/// Whether a page on disk tells verdicts that nobody can judge now, as its reference cannot be read: it stays.
fn keeps_its_verdicts(study: &Study, page: &Page<'_>) -> bool {
    !is_reference_read(study, &page.item.source.experiment.id.0) && study.layout.path(&page_of(page)).exists()
}

fn is_reference_read(study: &Study, id: &str) -> bool {
    study.unread.iter().all(|one| FileKind::of(one.file()) != Some(FileKind::Reference) || stem(one.file()) != id)
}

/// How many experiments without a table, as in a study that was just cloned, or without a reference that can be read have a verdict in the
/// reports: the pages of the whole study would lose what is known of them.
fn judged_elsewhere(study: &Study) -> Elsewhere {
    let tables = study.tables();
    let mut unjudged = study.texts.ids();
    unjudged.retain(|id| !tables.contains_key(id) || !is_reference_read(study, id));
    if unjudged.is_empty() {
        return Elsewhere::default();
    }
    let verdicts = fs::read_to_string(study.layout.path(VERDICTS)).unwrap_or_default();
    let verdicts = read_json(&verdicts).unwrap_or_default();
    let judged = verdicts.iter().filter(|one| one.verdict != Verdict::Missing.word());
    let judged: BTreeSet<&str> = judged.filter_map(|one| Some(one.id.split_once('/')?.0)).collect();
    let (without_reference, without_table): (Vec<&str>, Vec<&str>) =
        judged.intersection(&unjudged).partition(|id| !is_reference_read(study, id));
    Elsewhere { without_table: without_table.len(), without_reference: without_reference.len() }
}

/// Everything that a run would write under `reports/`, by name within the study; or why it cannot be made. Of the experiments in `only`
/// where there are any: then without the pages of the whole study.
pub(super) fn render(
    study: &Study,
    judgement: &Judgement,
    only: Option<&BTreeSet<&str>>,
) -> BTreeMap<String, Result<Vec<u8>, NotDrawn>> {
    let is_asked_for = |item: &&Item| only.is_none_or(|only| only.contains(item.source.experiment.id.0.as_str()));
    let pages: Vec<Page<'_>> = study.items.iter().filter(is_asked_for).filter_map(|item| page(study, item)).collect();
    let mut figures = draw(study, judgement, pages.iter().flat_map(jobs));
    let mut files = BTreeMap::new();
    for page in &pages {
        let id = &page.item.source.experiment.id;
        let drawn = figures.remove(id.0.as_str()).unwrap_or_default();
        let text = views::page(study, judgement, page.item, &undrawn(page, &drawn));
        for (figure, picture) in drawn {
            for (name, form) in names(page, figure) {
                files.insert(name, picture.as_ref().map(|picture| form.of(picture).to_vec()).map_err(Clone::clone));
            }
        }
        if let Some((name, drawing)) = scene(study, page) {
            files.insert(name, Ok(drawing.into_bytes()));
        }
        files.insert(page_of(page), Ok(text.into_bytes()));
    }
    if only.is_none() {
        let of_the_study = views::of_the_study(study, judgement);
        files.extend(of_the_study.into_iter().map(|(name, text)| (name, Ok(text.into_bytes()))));
    }
    files
}

/// The names of all that [`render`] gives.
pub(super) fn rendered(study: &Study, judgement: &Judgement) -> BTreeSet<String> {
    let pages: Vec<Page<'_>> = study.items.iter().filter_map(|item| page(study, item)).collect();
    let mut files: BTreeSet<String> = pages.iter().map(page_of).collect();
    files.extend(pages.iter().flat_map(jobs).flat_map(|(page, figure)| names(page, figure).map(|(name, _)| name)));
    files.extend(pages.iter().filter_map(|page| scene(study, page)).map(|(name, _)| name));
    files.extend(views::of_the_study(study, judgement).into_iter().map(|(name, _)| name));
    files
}

/// Every figure and sketch as SVG, by name within the study: as it is on disk where that is what would be drawn.
pub(super) fn svgs(study: &Study, judgement: &Judgement) -> BTreeMap<String, Result<String, NotDrawn>> {
    let pages: Vec<Page<'_>> = study.items.iter().filter_map(|item| page(study, item)).collect();
    let jobs: Vec<_> = pages.iter().flat_map(jobs).collect();
    let figures = jobs.par_iter().map(|(page, figure)| {
        let [(name, _), _] = names(page, figure);
        let kept = is_drawn(study, judgement, page, figure).then(|| fs::read_to_string(study.layout.path(&name)).ok());
        let svg = kept.flatten().map_or_else(|| vector_of(study, judgement, page, figure), Ok);
        (name, svg)
    });
    let mut svgs: BTreeMap<_, _> = figures.collect();
    let sketches: Vec<_> = pages.par_iter().filter_map(|page| scene(study, page)).collect();
    svgs.extend(sketches.into_iter().map(|(name, svg)| (name, Ok(svg))));
    svgs
}

fn vector_of(study: &Study, judgement: &Judgement, page: &Page<'_>, figure: &FigureSpec) -> Result<String, NotDrawn> {
    let experiment = &page.item.source.experiment;
    let table = judgement.tables.get(&experiment.id.0).ok_or(NotDrawn::NoTable)?;
    let said = said(study, judgement, experiment);
    vector(experiment, figure, table, said).map_err(|error| NotDrawn::of(error, table))
}

fn page<'a>(study: &Study, item: &'a Item) -> Option<Page<'a>> {
    let record = item.record()?;
    let folder = match item.source.folder() {
        "" => "reports".to_owned(),
        folder => format!("reports/{folder}"),
    };
    let inputs = inputs(study, item, record);
    let stale = !reasons_beside(study, item, record, &inputs).is_empty();
    Some(Page { item, record, folder, inputs, stale })
}

/// The figures of a page.
fn jobs<'a>(page: &'a Page<'a>) -> impl Iterator<Item = (&'a Page<'a>, &'a FigureSpec)> {
    page.item.source.experiment.figures.iter().map(move |figure| (page, figure))
}

/// The forms in which a figure is written.
#[derive(Clone, Copy)]
enum Form {
    Svg,
    Png,
}

impl Form {
    fn of(self, picture: &Picture) -> &[u8] {
        match self {
            Self::Svg => picture.svg.as_bytes(),
            Self::Png => &picture.png,
        }
    }
}

/// A figure's files within the study.
fn names(page: &Page<'_>, figure: &FigureSpec) -> [(String, Form); 2] {
    let stem = figure_stem(&page.item.source.experiment, figure);
    [(Form::Svg, "svg"), (Form::Png, "png")].map(|(form, ending)| (format!("{}/{stem}.{ending}", page.folder), form))
}

/// Name of the page, within the study.
fn page_of(page: &Page<'_>) -> String {
    report_of(page.item.source.folder(), &page.item.source.experiment.id.0)
}

/// Name of the drawing of what is simulated, within the study.
fn scene_of(page: &Page<'_>) -> String {
    format!("{}/{}", page.folder, scene_name(&page.item.source.experiment))
}

/// The drawing of what is simulated, by its name within the study.
fn scene(study: &Study, page: &Page<'_>) -> Option<(String, String)> {
    Some((scene_of(page), sketch(&views::scenes(study, &page.item.source.experiment))?))
}

/// The same as it is on disk, where it would come out the same.
fn kept_scene(study: &Study, page: &Page<'_>) -> Option<(String, FileHash)> {
    let old = page.record.publication.as_ref().filter(|old| shows_same_scene(old, &page.inputs))?;
    let (name, hash) = old.files.get_key_value(&scene_of(page))?;
    hash.matches(&study.layout.path(name)).then(|| (name.clone(), hash.clone()))
}

/// What the study says of an experiment, and what became of it.
fn said<'a>(study: &'a Study, judgement: &'a Judgement, experiment: &Experiment) -> Said<'a> {
    let id = experiment.id.0.as_str();
    // Moments are shown in time histories alone, and those are of one case.
    let scene = || views::scenes(study, experiment).pop();
    let impulses =
        experiment.trace.as_ref().and_then(|_| rounded(scene()?, &experiment.settings).excitation.impulse_period());
    Said {
        reference: study.references.get(id),
        judged: judgement.verdicts.get(id).map_or(&[], Vec::as_slice),
        impulses,
        colours: Some(&study.about.colours),
    }
}

/// What a figure would show; `None` without a table.
fn shows(study: &Study, judgement: &Judgement, page: &Page<'_>, figure: &FigureSpec) -> Option<String> {
    let experiment = &page.item.source.experiment;
    let id = experiment.id.0.as_str();
    let table = judgement.tables.get(id)?;
    Some(shown(experiment, figure, table, &page.record.table, said(study, judgement, experiment)))
}

/// True if the figure is on disk and shows what it would show.
fn is_drawn(study: &Study, judgement: &Judgement, page: &Page<'_>, figure: &FigureSpec) -> bool {
    let shows = shows(study, judgement, page, figure);
    page.record.publication.as_ref().is_some_and(|old| {
        names(page, figure).iter().all(|(name, _)| {
            let known = old.shown.get(name);
            known.is_some()
                && known == shows.as_ref()
                && old.files.get(name).is_some_and(|hash| hash.matches(&study.layout.path(name)))
        })
    })
}

/// A figure, or why there is none.
type Drawn<'a> = Vec<(&'a FigureSpec, Result<Picture, NotDrawn>)>;

/// Draws side by side; each picture is one thread's work alone.
fn draw<'a>(
    study: &'a Study,
    judgement: &'a Judgement,
    jobs: impl Iterator<Item = (&'a Page<'a>, &'a FigureSpec)>,
) -> BTreeMap<&'a str, Drawn<'a>> {
    let jobs: Vec<_> = jobs.collect();
    let drawn: Vec<_> = jobs
        .par_iter()
        .map(|(page, figure)| {
            let experiment = &page.item.source.experiment;
            let id = experiment.id.0.as_str();
            let picture = judgement.tables.get(id).ok_or(NotDrawn::NoTable).and_then(|table| {
                picture(experiment, figure, table, said(study, judgement, experiment))
                    .map_err(|error| NotDrawn::of(error, table))
            });
            (id, *figure, picture)
        })
        .collect();
    let mut by_id = BTreeMap::<&str, Drawn<'_>>::new();
    for (id, figure, picture) in drawn {
        by_id.entry(id).or_default().push((figure, picture));
    }
    by_id
}

/// Those of which there is no picture.
fn undrawn(page: &Page<'_>, drawn: &Drawn<'_>) -> views::Undrawn {
    let experiment = &page.item.source.experiment;
    let why = |(figure, picture): &(&FigureSpec, Result<Picture, NotDrawn>)| {
        Some((figure_name(experiment, figure), picture.as_ref().err()?.to_string()))
    };
    drawn.iter().filter_map(why).collect()
}

/// The verdicts of an experiment with their explanations as the file has them: their numbers are those of other tables, too.
fn judged_as_written(judgement: &Judgement, reference: Option<&ReferenceFile>, id: &str) -> Vec<Judged> {
    let mut judged = judgement.verdicts.get(id).cloned().unwrap_or_default();
    for one in &mut judged {
        let entry = reference.and_then(|file| file.entries.iter().find(|entry| entry.id == one.id));
        if let Some(entry) = entry {
            one.explanation = entry.explanation.clone();
        }
    }
    judged
}

/// The summary of an experiment; `None` if it is to be looked at again the next time: rows of it failed, its reference cannot
/// be read, or an entry reads a table that does not count.
fn summary(study: &Study, judgement: &Judgement, page: &Page<'_>) -> Option<Summary> {
    let experiment = &page.item.source.experiment;
    let id = experiment.id.0.as_str();
    let reference = study.references.get(id);
    let tables = study.tables();
    let reads = reference.map(ReferenceFile::other_tables).unwrap_or_default();
    let reads: Option<BTreeMap<String, String>> =
        reads.into_iter().map(|id| Some((id.clone(), (*tables.get(id.as_str())?).to_owned()))).collect();
    let is_read = matches!(page.item.state, State::Current(_)) && study.unread.iter().all(|one| stem(one.file()) != id);
    is_read.then_some(Summary {
        heading: Heading::of(experiment),
        folder: page.item.source.folder().to_owned(),
        used: page.item.used.clone(),
        table: page.record.table.blake3.clone(),
        reads: reads?,
        judged: judged_as_written(judgement, reference, id),
        lines: reference.into_iter().flat_map(|file| &file.entries).map(|entry| entry.line).collect(),
        motions: judgement.motions.get(id).cloned(),
    })
}

fn write_page(
    study: &Study,
    judgement: &Judgement,
    page: &Page<'_>,
    drawn: Drawn<'_>,
    published: &mut Published,
) -> Result<(), FileError> {
    let id = &page.item.source.experiment.id;
    let layout = &study.layout;
    let old = page.record.publication.as_ref();
    let mut files: BTreeMap<String, FileHash> = BTreeMap::new();
    let mut shown: BTreeMap<String, String> = BTreeMap::new();
    let mut whole = true;
    let mut unwanted: BTreeSet<String> = page.record.files().cloned().collect();
    let text = views::page(study, judgement, page.item, &undrawn(page, &drawn));
    // Those that were not drawn now are there already.
    for (_, figure) in jobs(page) {
        for (name, _) in names(page, figure) {
            if let Some(old) = old
                && let (Some(hash), false) = (old.files.get(&name), drawn.iter().any(|(other, _)| *other == figure))
            {
                shown.extend(old.shown.get(&name).map(|shows| (name.clone(), shows.clone())));
                files.insert(name, hash.clone());
            }
        }
    }
    for (figure, picture) in drawn {
        match picture {
            Ok(picture) => {
                let shows = shows(study, judgement, page, figure);
                for (name, form) in names(page, figure) {
                    let bytes = form.of(&picture);
                    published.written += usize::from(atomic::write_if_changed(&layout.path(&name), bytes)?);
                    shown.extend(shows.iter().map(|shows| (name.clone(), shows.clone())));
                    files.insert(name, FileHash::of(bytes));
                }
            }
            Err(why) => {
                whole = false;
                // Also where no record tells of it, as in a study that was just cloned.
                unwanted.extend(names(page, figure).map(|(name, _)| name));
                // Failed rows are reported elsewhere, and are the reason.
                if page.record.failures.rows == 0 {
                    published.problems.push(format!("{id}: {why}"));
                }
            }
        }
    }
    if let Some((name, hash)) = kept_scene(study, page) {
        files.insert(name, hash);
    } else if let Some((name, drawing)) = scene(study, page) {
        published.written += usize::from(atomic::write_if_changed(&layout.path(&name), drawing.as_bytes())?);
        files.insert(name, FileHash::of(drawing.as_bytes()));
    }
    let name = page_of(page);
    published.written += usize::from(atomic::write_if_changed(&layout.path(&name), text.as_bytes())?);
    files.insert(name, FileHash::of(text.as_bytes()));
    // A figure that was renamed or taken out, or has nothing to show any more, does not stay behind.
    for gone in unwanted.iter().filter(|name| !files.contains_key(*name)) {
        let path = layout.path(gone);
        match fs::remove_file(&path) {
            Err(error) if error.kind() != std::io::ErrorKind::NotFound => {
                return Err(FileError { action: "remove", path, source: error });
            }
            _ => {}
        }
    }
    if whole && let Some(summary) = summary(study, judgement, page) {
        let outputs = files.keys().cloned().chain([table_name(id), record_name(id)]).collect();
        published.experiments.insert(id.0.clone(), (outputs, summary));
    }
    let (left, publication) = if whole {
        (BTreeSet::new(), Some(Publication { inputs: page.inputs.clone(), files, shown }))
    } else {
        (files.into_keys().collect(), None)
    };
    let record = Record { publication, left, ..page.record.clone() };
    record.write(&layout.path(&record_name(id)))
}
