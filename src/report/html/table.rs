//! All entries as a table; the script sorts and filters its rows.

use super::super::chapter::by_chapter;
use super::super::markdown::{html, one_line};
use super::super::tally::{VERDICTS, mark, role};
use super::super::view::{ExperimentView, name};
use super::links::marked;
use super::markdown::{Here, inline};
use crate::reference::Judged;
use crate::text::number::significant;

pub(super) fn section(experiments: &[ExperimentView<'_>], here: &Here<'_>) -> String {
    let all = experiments.iter().map(|view| view.judged.len()).sum::<usize>();
    let mut text = format!(
        "<h1>Verdicts</h1>\n{}<p id=\"count\" role=\"status\">{all} entries</p>\n\
         <div class=\"scroll\" tabindex=\"0\" role=\"group\" aria-label=\"Table of verdicts\"><table id=\"entries\">\n\
         <thead><tr>{}</tr></thead>\n<tbody>\n",
        filters(experiments),
        ["Entry", "Chapter", "The study says", "Here", "Verdict", "Used in fits", "|E|/u_val"]
            .map(|name| format!("<th scope=\"col\"><button type=\"button\">{name}</button></th>"))
            .concat()
    );
    for view in experiments {
        for one in view.judged {
            text += &row(view, one, here);
        }
    }
    text + "</tbody></table></div>\n"
}

fn filters(experiments: &[ExperimentView<'_>]) -> String {
    let verdicts = VERDICTS
        .into_iter()
        .filter(|verdict| experiments.iter().flat_map(|view| view.judged).any(|one| one.verdict == *verdict));
    let verdicts: String = verdicts
        .map(|verdict| {
            let (word, mark) = (verdict.word(), mark(verdict));
            format!(
                "<label><input type=\"checkbox\" name=\"verdict\" value=\"{word}\"> <i class=\"v {word}\" \
                 aria-hidden=\"true\">{mark}</i> {word}</label>\n"
            )
        })
        .collect();
    let chapters: String = by_chapter(experiments)
        .into_keys()
        .flatten()
        .map(|chapter| format!("<option value=\"{chapter}\">{chapter}</option>"))
        .collect();
    format!(
        "<form id=\"filters\" role=\"search\" aria-label=\"Filter the verdicts\">\n\
         <label>Text <input type=\"search\" name=\"text\" autocomplete=\"off\"></label>\n\
         <label>Chapter <select name=\"chapter\"><option value=\"\">all</option>{chapters}</select></label>\n\
         <fieldset><legend>Verdict</legend>{verdicts}</fieldset>\n\
         <label><input type=\"checkbox\" name=\"held\" value=\"yes\"> held out only</label>\n\
         <button type=\"reset\">Show all</button>\n</form>\n"
    )
}

fn row(view: &ExperimentView<'_>, one: &Judged, here: &Here<'_>) -> String {
    let rank = VERDICTS.iter().position(|verdict| *verdict == one.verdict).unwrap_or(0);
    let off = one.comparisons().map(|(_, comparison)| comparison.deviation()).fold(f64::NAN, f64::max);
    let (sort, off) =
        if off.is_nan() { (String::new(), String::new()) } else { (off.to_string(), significant(off, 2)) };
    let (id, verdict) = (html(&one.id), one.verdict.word());
    let expected = if one.as_expected() { String::new() } else { format!(" (expected: {})", one.expected.word()) };
    format!(
        "<tr data-verdict=\"{verdict}\" data-chapter=\"{chapter}\" data-role=\"{role}\">\
         <th scope=\"row\"><a href=\"#{link}\">{id}</a></th><td>{chapter}</td><td>{says}</td><td>{found}</td>\
         <td data-sort=\"{rank}\"><i class=\"v {verdict}\" aria-hidden=\"true\">{mark}</i> {verdict}{expected}</td>\
         <td>{role}</td><td data-sort=\"{sort}\">{off}</td></tr>\n",
        chapter = view.experiment.source.chapter.map_or_else(String::new, |chapter| chapter.to_string()),
        link = html(&marked(&view.experiment.id.0, name(one))),
        says = inline(&one_line(&one.statement), here),
        found = inline(&one_line(&one.found), here),
        mark = mark(one.verdict),
        role = role(one),
    )
}
