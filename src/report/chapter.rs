//! The table of experiments, one row each, chapter by chapter.

use std::collections::BTreeMap;

use super::markdown::{Align, MarkdownTable, one_line};
use super::tally::{Tally, mark};
use super::view::ExperimentView;
use crate::experiment::AboutStudy;
use crate::reference::Verdict;
use crate::text::number::quantity;

/// The experiments of each chapter, in their order.
pub(super) fn by_chapter<'v, 'a>(
    experiments: &'v [ExperimentView<'a>],
) -> BTreeMap<Option<u32>, Vec<&'v ExperimentView<'a>>> {
    let mut chapters: BTreeMap<Option<u32>, Vec<&ExperimentView<'_>>> = BTreeMap::new();
    for view in experiments {
        chapters.entry(view.experiment.source.chapter).or_default().push(view);
    }
    chapters
}

/// The name of a chapter in a picture; nothing for what belongs to none.
pub(super) fn label(chapter: Option<u32>) -> String {
    chapter.map_or_else(String::new, |number| format!("Chapter {number}"))
}

/// A table for each chapter.
pub(super) fn tables(about: &AboutStudy, experiments: &[ExperimentView<'_>]) -> String {
    let timed = experiments.iter().any(|view| view.seconds.is_some());
    let mut text = String::from("## Experiments\n\n");
    for (chapter, views) in by_chapter(experiments) {
        let name = about.heading(chapter);
        let mut header = vec![
            (name.as_str(), Align::Left),
            ("Shown in", Align::Left),
            ("Agree", Align::Left),
            ("Others", Align::Left),
        ];
        header.extend(timed.then_some(("Time", Align::Right)));
        let mut table = MarkdownTable::new(&header);
        for view in views {
            let link = format!("[{}]({})", one_line(&view.experiment.title), view.page);
            let mut row = vec![link, view.experiment.source.shown_in.join(", "), agreeing(view), others(view)];
            row.extend(timed.then(|| view.seconds.map_or_else(String::new, |seconds| quantity(seconds, "s", 2))));
            table.row(row);
        }
        text += &table.finish();
    }
    text
}

/// `3 of 5`, of those that do not agree by a fit.
fn agreeing(view: &ExperimentView<'_>) -> String {
    let tally = Tally::of(view.judged);
    match tally.evidence() {
        0 => String::new(),
        evidence => format!("{} of {evidence}", tally.count(Verdict::Reproduced)),
    }
}

/// `◐ 3, ✕ 1, □ 2`.
fn others(view: &ExperimentView<'_>) -> String {
    let tally = Tally::of(view.judged);
    let others = tally.each().filter(|(verdict, count)| *count > 0 && *verdict != Verdict::Reproduced);
    others.map(|(verdict, count)| format!("{} {count}", mark(verdict))).collect::<Vec<_>>().join(", ")
}
