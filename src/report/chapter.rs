//! The table of experiments, one row each, chapter by chapter.

use std::collections::BTreeMap;

use super::markdown::{Align, MarkdownTable, one_line};
use super::tally::{Tally, agrees, mark};
use super::view::ExperimentView;
use crate::text::number::quantity;

/// The experiments of each chapter, in their order.
pub(super) fn by_chapter<'v, 'a>(experiments: &'v [ExperimentView<'a>]) -> BTreeMap<u32, Vec<&'v ExperimentView<'a>>> {
    let mut chapters: BTreeMap<u32, Vec<&ExperimentView<'_>>> = BTreeMap::new();
    for view in experiments {
        chapters.entry(view.experiment.source.chapter).or_default().push(view);
    }
    chapters
}

/// The name of a chapter.
pub(super) fn title(chapter: u32) -> String {
    let subject = match chapter {
        3 => ", one mass, one damper",
        4 => ", cantilever beam",
        5 => ", simply supported plate",
        6 => ", optimised arrays of dampers",
        _ => "",
    };
    format!("Chapter {chapter}{subject}")
}

/// A table for each chapter.
pub(super) fn tables(experiments: &[ExperimentView<'_>]) -> String {
    let timed = experiments.iter().any(|view| view.seconds.is_some());
    let mut text = String::from("## Experiments\n\n");
    for (chapter, views) in by_chapter(experiments) {
        let name = title(chapter);
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

/// `3 of 5`.
fn agreeing(view: &ExperimentView<'_>) -> String {
    let agree = view.judged.iter().filter(|one| agrees(one.verdict)).count();
    if view.judged.is_empty() { String::new() } else { format!("{agree} of {}", view.judged.len()) }
}

/// `✕ 1, □ 2`.
fn others(view: &ExperimentView<'_>) -> String {
    let tally = Tally::of(view.judged);
    let others = tally.each().filter(|(verdict, count)| *count > 0 && !agrees(*verdict));
    others.map(|(verdict, count)| format!("{} {count}", mark(verdict))).collect::<Vec<_>>().join(", ")
}
