//! The whole study in one table: a row a chapter.

use std::collections::BTreeMap;

use crate::text::number::quantity;

use super::chapter::title;
use super::markdown::{Align, MarkdownTable};
use super::tally::{ROLES, Tally, VERDICTS, agreeing, word};
use super::view::ExperimentView;

/// Experiments and entries by verdict, chapter by chapter and in all.
pub(super) fn table(chapters: &BTreeMap<u32, Vec<&ExperimentView<'_>>>) -> String {
    let mut header = vec![("Chapter", Align::Left), ("Experiments", Align::Right), ("Entries", Align::Right)];
    header.extend(VERDICTS.map(|verdict| (word(verdict), Align::Right)));
    header.extend(ROLES.map(|role| (role, Align::Right)));
    let timed = chapters.values().flatten().any(|view| view.seconds.is_some());
    header.extend(timed.then_some(("Processor time", Align::Right)));
    let mut table = MarkdownTable::new(&header);
    for (number, views) in chapters {
        let title = title(*number);
        table.row(row(format!("[{title}](#{})", anchor(&title)), views, timed));
    }
    if chapters.len() > 1 {
        let all: Vec<&ExperimentView<'_>> = chapters.values().flatten().copied().collect();
        table.row(row("**All**".into(), &all, timed));
    }
    table.finish()
}

fn row(name: String, views: &[&ExperimentView<'_>], timed: bool) -> Vec<String> {
    let judged = views.iter().flat_map(|view| view.judged);
    let tally = Tally::of(judged.clone());
    let counts = tally.each().map(|(_, count)| if count == 0 { String::new() } else { count.to_string() });
    [name, views.len().to_string(), tally.total().to_string()]
        .into_iter()
        .chain(counts)
        .chain(agreeing(judged))
        .chain(timed.then(|| took(views.iter().filter_map(|view| view.seconds))))
        .collect()
}

/// The sum of these times; empty without any.
pub(super) fn took(seconds: impl Iterator<Item = f64>) -> String {
    seconds.reduce(|sum, more| sum + more).map_or_else(String::new, |sum| quantity(sum, "s", 2))
}

/// The name of a heading as a link knows it.
fn anchor(heading: &str) -> String {
    let kept = heading.chars().filter(|letter| letter.is_alphanumeric() || matches!(letter, ' ' | '-'));
    kept.map(|letter| if letter == ' ' { '-' } else { letter.to_ascii_lowercase() }).collect()
}
