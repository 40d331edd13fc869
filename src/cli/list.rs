//! `shotdamp list`: the experiments, one a line.

use super::args::Choice;
use super::error::CliError;
use super::exit::Exit;
use super::output::{columns, print, print_unread};
use super::select::{Found, choose};
use crate::study::{Heading, Layout};

/// One line an experiment: id, where it is shown, title.
pub(super) fn list(layout: &Layout) -> Result<Exit, CliError> {
    let study = Found::look(layout)?.open(layout, &Choice::default(), false);
    let chosen = choose(&study, &Choice::default())?;
    print_unread(&study.unread);
    let planned = chosen.items.iter().map(|item| Heading::of(&item.source.experiment));
    let mut headings: Vec<Heading> = planned.chain(chosen.known.iter().map(|known| known.heading.clone())).collect();
    headings.sort_by(|a, b| a.id.cmp(&b.id));
    let rows: Vec<Vec<String>> = headings
        .into_iter()
        .map(|Heading { id, title, source }| {
            let place = source.section.map_or_else(String::new, |section| format!("s. {section}"));
            vec![id.to_string(), place, source.shown_in.join(", "), title]
        })
        .collect();
    print(&columns(&rows))?;
    Ok(if study.unread.is_empty() { Exit::AsExpected } else { Exit::CouldNot })
}
