//! The verdict strip: one cell for each entry, each a link to it.

use super::super::chapter::by_chapter;
use super::super::markdown::html;
use super::super::tally::{VERDICTS, mark, meaning};
use super::super::view::{ExperimentView, name};
use super::links::marked;
use crate::experiment::AboutStudy;
use crate::reference::{Judged, Role};

pub(super) fn section(about: &AboutStudy, experiments: &[ExperimentView<'_>]) -> String {
    let mut text = String::from("<h2 id=\"study/every-verdict\">Every verdict</h2>\n<p class=\"key\">");
    for verdict in VERDICTS {
        let (word, mark) = (verdict.word(), mark(verdict));
        text += &format!("<span title=\"{}\"><i class=\"v {word}\">{mark}</i> {word}</span> ", meaning(verdict));
    }
    text += "<span><i class=\"v held\"></i> held out</span></p>\n";
    for (chapter, views) in by_chapter(experiments) {
        text += &format!("<h3>{}</h3>\n<p class=\"strip\">", html(&about.heading(chapter)));
        for view in views.iter().filter(|view| !view.judged.is_empty()) {
            let cells: Vec<String> = view.judged.iter().map(|one| cell(view, one)).collect();
            text += &format!("<span>{}</span> ", cells.join(""));
        }
        text += "</p>\n";
    }
    text
}

fn cell(view: &ExperimentView<'_>, one: &Judged) -> String {
    let (held, also) = if one.role == Role::HeldOut { (" held", ", held out") } else { ("", "") };
    let (word, id) = (one.verdict.word(), html(&one.id));
    let link = html(&marked(&view.experiment.id.0, name(one)));
    let label = format!("{id}: {word}{also}");
    let mark = mark(one.verdict);
    format!("<a class=\"v {word}{held}\" href=\"#{link}\" title=\"{label}\" aria-label=\"{label}\">{mark}</a>")
}
