//! `shotdamp export --ro-crate DIR`.

use super::args::ExportArgs;
use super::destination::outside;
use super::error::CliError;
use super::exit::Exit;
use super::output::{print, print_unread};
use super::select::{choose, open};
use crate::report::{CrateError, export_crate};
use crate::study::Layout;
use crate::text::words::counted;

/// Writes the chosen experiments with all their results into a folder for others.
pub(super) fn export(layout: &Layout, args: &ExportArgs) -> Result<Exit, CliError> {
    outside(layout, &args.ro_crate)?;
    let study = open(layout)?;
    let chosen = choose(&study, &args.choice)?;
    print_unread(chosen.unread.iter().copied());
    if !chosen.unread.is_empty() {
        let files = chosen.unread.iter().map(|unread| unread.file().to_owned()).collect();
        return Err(CrateError::NotUpToDate(files).into());
    }
    let files = export_crate(&study, &chosen.items, &args.ro_crate, &args.published)?;
    let experiments = counted(chosen.items.len(), "experiment", "experiments");
    print(&format!("{}: {experiments}, {files} files\n", args.ro_crate.display()))?;
    Ok(Exit::AsExpected)
}
