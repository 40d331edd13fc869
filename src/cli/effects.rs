//! `shotdamp effects`: each effect of an experiment switched on or off.

use super::args::{Choice, LimitArgs};
use super::error::CliError;
use super::exit::Exit;
use super::output::{print, print_unread};
use super::select::{choose, open};
use crate::accuracy::{ablation, ablation_page};
use crate::study::Layout;

/// What each effect of an experiment changes and costs; writes nothing.
pub(super) fn effects(layout: &Layout, id: &str, limit: &LimitArgs) -> Result<Exit, CliError> {
    let mut study = open(layout)?;
    limit.apply(&mut study);
    let chosen = choose(&study, &Choice { patterns: vec![id.into()], folder: None })?;
    print_unread(chosen.unread.iter().copied());
    let mut exit = if chosen.unread.is_empty() { Exit::AsExpected } else { Exit::CouldNot };
    for item in &chosen.items {
        let experiment = &item.source.experiment;
        match ablation(experiment, &study.sheet.assumptions()) {
            Ok(cases) => {
                print(&format!("# {}: what each effect changes and costs\n\n{}", experiment.id, ablation_page(&cases)))?
            }
            Err(error) => {
                super::output::print_error(&format!("{}: {error}\n", experiment.id));
                exit = Exit::CouldNot;
            }
        }
    }
    Ok(exit)
}
