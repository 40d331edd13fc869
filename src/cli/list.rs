//! `shotdamp list`.

use super::error::CliError;
use super::exit::Exit;
use super::output::{columns, complain_of, print};
use super::select::{choose, open};
use crate::study::Layout;

/// One line an experiment: id, where it is shown, title.
pub(super) fn list(layout: &Layout) -> Result<Exit, CliError> {
    let opened = open(layout)?;
    let chosen = choose(&opened, &super::args::Choice::default())?;
    complain_of(&opened.unread);
    let rows: Vec<Vec<String>> = chosen
        .items
        .iter()
        .map(|item| {
            let experiment = &item.source.experiment;
            let source = &experiment.source;
            let place = format!("s. {}", source.section);
            vec![experiment.id.to_string(), place, source.shown_in.join(", "), experiment.title.clone()]
        })
        .collect();
    print(&columns(&rows))?;
    Ok(if opened.unread.is_empty() { Exit::AsExpected } else { Exit::CouldNot })
}
