//! `shotdamp new`: an experiment to start from.

use super::args::{NewArgs, SchemaOf};
use super::error::CliError;
use super::exit::Exit;
use super::output::print;
use super::schema::write_all;
use super::select::{chapter_of, open};
use crate::atomic;
use crate::experiment::{ExperimentId, IdError, scaffold, structures};
use crate::study::Layout;

/// Writes an experiment to begin with, and the schemas by which an editor completes and checks it.
pub(super) fn new(layout: &Layout, args: &NewArgs) -> Result<Exit, CliError> {
    let id: ExperimentId = args.id.parse().map_err(|error: IdError| CliError::Id(error.to_string()))?;
    let chapter = args.chapter.unwrap_or_else(|| chapter_of(&id.0));
    let name = format!("experiments/ch{chapter}/{id}.yaml");
    let taken = open(layout)?.items.iter().any(|item| item.source.experiment.id == id);
    if taken || layout.path(&name).exists() {
        return Err(CliError::Exists(id.to_string()));
    }
    let schema = format!("../../{}", SchemaOf::Experiment.file());
    let text = scaffold(&id, chapter, &args.structure, &schema)
        .ok_or_else(|| CliError::NoStructure { given: args.structure.clone(), known: structures().join(", ") })?;
    write_all(layout)?;
    atomic::write(&layout.path(&name), text.as_bytes())?;
    print(&format!("{name}\nNext: shotdamp show {id}; shotdamp run {id}\n"))?;
    Ok(Exit::AsExpected)
}
