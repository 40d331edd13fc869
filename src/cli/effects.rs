//! `shotdamp effects`.

use super::args::Choice;
use super::error::CliError;
use super::exit::Exit;
use super::output::{complain_of, print};
use super::select::{choose, open};
use crate::report::ablation as told;
use crate::study::{Layout, ablation};

/// What each effect of an experiment changes and costs; writes nothing.
pub(super) fn effects(layout: &Layout, id: &str) -> Result<Exit, CliError> {
    let opened = open(layout)?;
    let chosen = choose(&opened, &Choice { patterns: vec![id.into()], chapter: None })?;
    complain_of(chosen.unread.iter().copied());
    let mut exit = if chosen.unread.is_empty() { Exit::AsExpected } else { Exit::CouldNot };
    for item in &chosen.items {
        let experiment = &item.source.experiment;
        match ablation(experiment, &opened.sheet.assumptions()) {
            Ok(cases) => {
                print(&format!("# {}: what each effect changes and costs\n\n{}", experiment.id, told(&cases)))?
            }
            Err(error) => {
                super::output::complain(&format!("{}: {error}\n", experiment.id));
                exit = Exit::CouldNot;
            }
        }
    }
    Ok(exit)
}
