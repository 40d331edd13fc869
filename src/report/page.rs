//! One experiment's page.

use crate::experiment::Source;

use super::markdown::one_line;
use super::view::{AccuracyLinks, FigureView, PageView};
use super::{assumption, candidate, comparison, proof, run};

/// The page of an experiment, Markdown.
#[must_use]
pub fn page(view: &PageView<'_>) -> String {
    let experiment = view.experiment;
    let mut text = format!("# {}\n\n", one_line(&experiment.title));
    text += &format!(
        "{} of the study · `{}` · [how to read this page]({}#how-to-read-a-page)\n\n",
        place(&experiment.source),
        experiment.id,
        view.index_link
    );
    text += &format!("{}\n\n", experiment.about.trim());
    for one in view.figures {
        text += &figure(one);
    }
    text += &comparison::section(view.judged);
    if let (Some(optimise), Some(table)) = (&experiment.optimise, view.table) {
        text += &candidate::section(optimise, table);
    }
    if !view.assumptions.is_empty() {
        text += "## Assumptions in force\n\nThe study does not state these inputs; other values could be defended.\n\n";
        text += &assumption::table(view.assumptions);
    }
    text += &run::effects(view.effects);
    match view.table {
        Some(table) => text += &proof::section(table),
        None => text += "## What proves the runs\n\nThere is no result: the experiment has not been run.\n\n",
    }
    text += &view.accuracy.as_ref().map_or_else(String::new, accuracy);
    text += &run::section(experiment);
    text +=
        &format!("All numbers: [the table as Parquet]({}). [All experiments]({}).\n", view.table_link, view.index_link);
    text
}

/// Times differ from run to run, so that they stand on a page of their own.
fn accuracy(links: &AccuracyLinks) -> String {
    let picture =
        links.picture.as_ref().map_or_else(String::new, |link| format!("![Error against wall time]({link})\n\n"));
    format!(
        "## What accuracy costs\n\n{picture}Error against time of both solvers, on some of these cases: [all points, and what each \
         verdict cost]({}).\n\n",
        links.page
    )
}

fn figure(figure: &FigureView) -> String {
    let caption = one_line(&figure.caption);
    // The picture's text stands in brackets.
    let spoken = caption.replace(['[', ']'], "");
    if caption.is_empty() {
        format!("![]({})\n\n", figure.link)
    } else {
        format!("![{spoken}]({})\n\n*{caption}*\n\n", figure.link)
    }
}

/// `Chapter 3, section 3.6.3, Fig. 18`.
pub(super) fn place(source: &Source) -> String {
    let mut text = format!("Chapter {}, section {}", source.chapter, source.section);
    for shown in &source.shown_in {
        text += &format!(", {shown}");
    }
    text
}
