//! `shotdamp list`: the experiments, one a line.

use super::error::CliError;
use super::exit::Exit;
use super::output::{columns, print, print_unread};
use super::select::{choose, open};
use crate::study::Layout;

/// One line an experiment: id, where it is shown, title.
pub(super) fn list(layout: &Layout) -> Result<Exit, CliError> {
    let study = open(layout)?;
    let chosen = choose(&study, &super::args::Choice::default())?;
    print_unread(&study.unread);
    let rows: Vec<Vec<String>> = chosen
        .items
        .iter()
        .map(|item| {
            let experiment = &item.source.experiment;
            let source = &experiment.source;
            let place = source.section.as_ref().map_or_else(String::new, |section| format!("s. {section}"));
            vec![experiment.id.to_string(), place, source.shown_in.join(", "), experiment.title.clone()]
        })
        .collect();
    print(&columns(&rows))?;
    Ok(if study.unread.is_empty() { Exit::AsExpected } else { Exit::CouldNot })
}
