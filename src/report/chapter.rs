//! A chapter of the study at a glance, as a part of the index.

use super::glance::took;
use super::markdown::{Align, MarkdownTable, counted, one_line};
use super::page::place;
use super::tally::{ROLES, Tally, VERDICTS, agreeing, word};
use super::view::ExperimentView;

/// Pictures side by side in the gallery.
const GALLERY_COLUMNS: usize = 3;
/// Width of a picture in the gallery, pixels of the page.
const GALLERY_WIDTH: usize = 280;

/// The chapter's section of the index.
pub(super) fn section(chapter: u32, experiments: &[&ExperimentView<'_>]) -> String {
    let tally = Tally::of(experiments.iter().flat_map(|view| view.judged));
    let mut text = format!(
        "## {}\n\n{}, {}: {}.\n\n",
        title(chapter),
        counted(experiments.len(), "experiment", "experiments"),
        counted(tally.total(), "entry", "entries"),
        tally.describe()
    );
    let mut header = vec![("Experiment", Align::Left), ("In the study", Align::Left)];
    header.extend(VERDICTS.map(|verdict| (word(verdict), Align::Right)));
    header.extend(ROLES.map(|role| (role, Align::Right)));
    let timed = experiments.iter().any(|view| view.seconds.is_some());
    header.extend(timed.then_some(("Processor time", Align::Right)));
    let mut table = MarkdownTable::new(&header);
    for view in experiments {
        let tally = Tally::of(view.judged);
        let mut row = vec![link(view), place(&view.experiment.source)];
        // Zeros would hide what there is.
        row.extend(tally.each().map(|(_, count)| if count == 0 { String::new() } else { count.to_string() }));
        row.extend(agreeing(view.judged));
        row.extend(timed.then(|| took(view.seconds.into_iter())));
        table.row(row);
    }
    text += &table.finish();
    text += &gallery(experiments);
    text
}

/// The name of a chapter.
pub(super) fn title(chapter: u32) -> String {
    let subject = match chapter {
        3 => ": one mass, one damper",
        4 => ": cantilever beam",
        5 => ": simply supported plate",
        6 => ": optimised arrays of dampers",
        _ => "",
    };
    format!("Chapter {chapter}{subject}")
}

fn link(view: &ExperimentView<'_>) -> String {
    format!("[{}]({})", one_line(&view.experiment.title), view.page)
}

/// The figures with their experiments' verdicts, in rows.
fn gallery(experiments: &[&ExperimentView<'_>]) -> String {
    let pictures: Vec<String> =
        experiments.iter().flat_map(|view| view.figures.iter().map(|figure| picture(view, &figure.link))).collect();
    if pictures.is_empty() {
        return String::new();
    }
    let mut text = String::from("<table>\n");
    for row in pictures.chunks(GALLERY_COLUMNS) {
        text += &format!("<tr>\n{}</tr>\n", row.concat());
    }
    text + "</table>\n\n"
}

fn picture(view: &ExperimentView<'_>, link: &str) -> String {
    let title = html(&one_line(&view.experiment.title));
    let width = GALLERY_WIDTH;
    format!(
        "<td><a href=\"{page}\"><img src=\"{link}\" width=\"{width}\" alt=\"{title}\"></a><br>{title}<br><sub>{description}</sub></td>\n",
        page = view.page,
        description = Tally::of(view.judged).describe(),
    )
}

fn html(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;").replace('"', "&quot;")
}
