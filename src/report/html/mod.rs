//! The whole study as one HTML file that needs no network: the pages, the verdicts as a table to sort and filter, and the
//! figures as SVG with values under the pointer.
//!
//! The pages are those that are written as Markdown, from the same functions; here they become sections of one document, and
//! links between files become links within it. Nothing that a study says can become markup or a script: see [`markdown`].

mod figures;
mod links;
mod markdown;
mod shell;
mod strip;
mod table;

pub(super) use links::joined;

use std::collections::BTreeMap;

use self::figures::Figures;
use self::links::Links;
use self::markdown::{Here, render};
use self::shell::Section;
use super::view::ExperimentView;
use super::{chapter, headline, index, overview, reading, tolerances, verdicts::Judgement, views};
use crate::experiment::AboutStudy;
use crate::study::{RunTimes, Study};

/// The file, and what it lacks in words.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Html {
    /// The document.
    pub text: String,
    /// Figures that could not be drawn, with the reason.
    pub problems: Vec<String>,
}

/// The study as one HTML file. The same input gives the same bytes.
#[must_use]
pub fn html(study: &Study, judgement: &Judgement) -> Html {
    let times = RunTimes::read(&study.layout);
    let experiments = views::listed(study, judgement, times.as_ref());
    let links = Links::new(&experiments);
    let figures = Figures::of(study, judgement);
    let here = |page: &'static str, section: &'static str| Here { page, section, links: &links, figures: &figures };
    let mut sections = vec![
        Section::new(
            "study",
            "The study in one page",
            index_page(&study.about, &experiments, &here(links::INDEX, "study")),
        ),
        Section::new("verdicts", "Verdicts", table::section(&experiments, &here(links::INDEX, "verdicts"))),
    ];
    for item in &study.items {
        let experiment = &item.source.experiment;
        let id = experiment.id.0.as_str();
        let page = views::page_name(item);
        // Here each figure says in its place why it is missing.
        let text = views::page(study, judgement, item, &views::Undrawn::new());
        let here = Here { page: &page, section: id, links: &links, figures: &figures };
        sections.push(Section::new(id, &experiment.title, render(&text, &here)));
    }
    let assumptions = views::all_assumptions(study, judgement);
    let others = [
        (links::WHAT_STANDS, "What stands", super::what_stands(&experiments, &study.sheet, &assumptions)),
        (links::WHAT_MOVES, "Kinds of motion", super::what_moves(&experiments)),
        (links::ASSUMPTIONS, "Assumptions", super::assumptions(&assumptions)),
        (links::TOLERANCES, "Tolerances set by hand", tolerances::tolerances(&experiments)),
    ];
    sections.extend(others.map(|(page, title, text)| {
        let id = links::section_of(page);
        Section::new(id, title, render(&text, &here(page, id)))
    }));
    Html { text: shell::document(&sections), problems: figures.problems() }
}

/// The index, with the strip as links to the entries in the place of its picture.
fn index_page(about: &AboutStudy, experiments: &[ExperimentView<'_>], here: &Here<'_>) -> String {
    let mut page = render(&format!("{}{}", index::head(about), headline::section(about, experiments)), here);
    page += &render(&reading::section(), here);
    page += &strip::section(about, experiments);
    page += "<h2 id=\"study/numbers\">All numbers</h2>\n";
    page += &figures::figure(
        &overview::overview_svg(experiments),
        "S/D of each number, here over published, with bars of ± tolerance/D, and |E|/u_val.",
    );
    page + &render(&chapter::tables(about, experiments), here)
}

/// Sections by the file that they are in the Markdown.
type Pages = BTreeMap<String, String>;
