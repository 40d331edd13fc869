//! `shotdamp new`: an experiment to start from.

use super::args::{NewArgs, SchemaOf};
use super::error::CliError;
use super::exit::Exit;
use super::output::print;
use super::schema::write_all;
use crate::atomic;
use crate::experiment::{ExperimentId, scaffold};
use crate::study::{ASSUMPTIONS, Layout, Texts};

/// Writes an experiment to begin with, and the schemas by which an editor completes and checks it.
pub(super) fn new(layout: &Layout, args: &NewArgs) -> Result<Exit, CliError> {
    let id: ExperimentId = args.id.parse()?;
    let folder = match &args.folder {
        Some(folder) => named(folder)?,
        None => known_folder(layout, &id),
    };
    let name = format!("experiments/{folder}{id}.yaml");
    if name == ASSUMPTIONS {
        return Err(CliError::OfAssumptions);
    }
    let taken = Texts::read(layout)?.ids().contains(id.0.as_str());
    if taken || layout.path(&name).exists() {
        return Err(CliError::Exists(id.to_string()));
    }
    let schema = format!("{}{}", "../".repeat(name.matches('/').count()), SchemaOf::Experiment.file());
    let text = scaffold(&id, &args.structure, &schema)
        .unwrap_or_else(|| unreachable!("the arguments admit no other structure than those that there are"));
    write_all(layout)?;
    atomic::write(&layout.path(&name), text.as_bytes())?;
    print(&format!("{name}\nNext: shotdamp show {id}; shotdamp run {id}\n"))?;
    Ok(Exit::AsExpected)
}

/// The folder that was asked for, with a slash behind it.
fn named(folder: &str) -> Result<String, CliError> {
    let folder = folder.trim_end_matches('/');
    let is_name = |part: &str| !part.is_empty() && part.chars().all(|c| c.is_ascii_alphanumeric() || "-_".contains(c));
    if folder.split('/').all(is_name) { Ok(format!("{folder}/")) } else { Err(CliError::Folder(folder.into())) }
}

/// The folder whose name an id begins with, `ch3/` for `ch3-gap`; empty if there is none.
fn known_folder(layout: &Layout, id: &ExperimentId) -> String {
    let first = id.0.split('-').next().unwrap_or_default();
    let there = layout.path(&format!("experiments/{first}")).is_dir();
    if there { format!("{first}/") } else { String::new() }
}
