//! One experiment's page.

use crate::experiment::{RowSource, Source};
use crate::reference::NotJudged;
use crate::text::words::capitalised;

use super::markdown::{details, one_line};
use super::view::{AccuracyLinks, FigureView, PageView};
use super::{assumption, branch, candidate, coexisting, comparison, doubts, few_rows, motions, proof, run};

/// The page of an experiment, Markdown: its answer first, then the figure and a row for each statement; all else is closed.
#[must_use]
pub fn page(view: &PageView<'_>) -> String {
    let experiment = view.experiment;
    let mut motions_in_words = view.motions.and_then(motions::in_words);
    let mut text = format!("# {}\n\n", one_line(&experiment.title));
    text += &lead(view).unwrap_or_else(|| match motions_in_words.take() {
        Some(words) => format!("**In short.** {words}\n\n"),
        None => comparison::in_short(view.judged),
    });
    let about = format!("{}\n\n", one_line(&experiment.about));
    if view.judged.is_empty() {
        text += &about;
    }
    for one in view.figures {
        text += &figure(one);
    }
    text += &comparison::statements(view.judged);
    text += &details("Said, but not judged", &not_judged(view.not_judged));
    if view.table.is_none() {
        text += "There is no result: the experiment has not been run.\n\n";
    }
    match (experiment.row_source(), view.table) {
        (RowSource::Search(optimise), Some(table)) => text += &candidate::section(optimise, table),
        (RowSource::Branches(continuation), Some(table)) => text += &branch::section(continuation, table),
        (RowSource::Basins(_), Some(table)) => text += &coexisting::section(experiment, table),
        (RowSource::Cases, _) | (_, None) => {}
    }
    text += &view.table.map_or_else(String::new, |table| proof::failures(table) + &doubts::section(table));
    if let Some(words) = motions_in_words {
        text += &format!("**Kinds of motion.** {words}\n\n");
    }
    text += &view.motions.map_or_else(String::new, motions::unsettled);
    text += &details("Uncertainties and sensitivity", &comparison::uncertainties(view.judged));
    let about = if view.judged.is_empty() { "" } else { about.as_str() };
    let run = format!("{about}{}{}", run::section(experiment), run::effects(view.effects));
    text += &details("How it was run", &run);
    text += &details("Inputs without a source", &assumption::without_source(&experiment.without_source));
    let assumptions = assumption::links(view.assumptions, view.to_reports)
        + &experiment.moved.as_ref().map_or_else(String::new, |moved| assumption::not_moved(view.assumptions, moved));
    text += &details("Assumptions", &assumptions);
    text += &details(
        "Proof of the runs, and their cost",
        &(proof::section(view.table) + &accuracy(view.accuracy.as_ref())),
    );
    text += &format!(
        "{}`{id}`. All its numbers: `shotdamp run {id}` writes `{}`. [The study in one page]({up}README.md) · \
         [How to read]({up}README.md#how-to-read)\n",
        place(&experiment.source).map_or_else(String::new, |place| format!("{place}: ")),
        view.table_name,
        id = experiment.id,
        up = view.to_reports,
    );
    text
}

/// The answer first: the verdicts, or what the rows show where there is no statement to judge; `None` where they show no more than
/// their motions.
fn lead(view: &PageView<'_>) -> Option<String> {
    if !view.judged.is_empty() {
        return Some(comparison::in_short(view.judged));
    }
    let table = view.table?;
    match view.experiment.row_source() {
        RowSource::Branches(continuation) => branch::in_short(continuation, table),
        RowSource::Cases => {
            let answers = [coexisting::in_short, few_rows::searched, few_rows::in_short];
            answers.iter().find_map(|answer| answer(view.experiment, table))
        }
        RowSource::Basins(starts) => coexisting::of_starts_in_short(view.experiment, starts, table, view.motions),
        RowSource::Search(_) => None,
    }
}

/// What the study says without an entry, and why.
fn not_judged(statements: &[NotJudged]) -> String {
    let line = |one: &NotJudged| {
        let [place, says, reason] = [&one.place, &one.says, &one.reason].map(|text| one_line(text));
        format!("- {says} ({place}) *{reason}*\n")
    };
    let lines: String = statements.iter().map(line).collect();
    if lines.is_empty() { lines } else { lines + "\n" }
}

/// Times differ from run to run, so that they stand on a page of their own.
fn accuracy(links: Option<&AccuracyLinks>) -> String {
    links.map_or_else(String::new, |links| format!("[Error against time of both solvers]({})\n\n", links.page))
}

fn figure(figure: &FigureView) -> String {
    if let Some(why) = &figure.missing {
        return format!("**Not drawn:** {} {}.\n\n", one_line(&figure.caption), capitalised(&one_line(why)));
    }
    // The picture's text stands in brackets.
    let caption = one_line(&figure.caption).replace(['[', ']'], "");
    format!("![{caption}]({})\n\n", figure.link)
}

/// `Chapter 3, section 3.6.3, Fig. 18`, as far as it is known.
pub(super) fn place(source: &Source) -> Option<String> {
    let chapter = source.chapter.map(|number| format!("Chapter {number}"));
    let section = source.section.as_ref().map(|number| format!("section {number}"));
    let parts: Vec<String> = chapter.into_iter().chain(section).chain(source.shown_in.iter().cloned()).collect();
    (!parts.is_empty()).then(|| capitalised(&parts.join(", ")))
}
