//! `shotdamp clean`.

use std::fs;

use super::args::CleanArgs;
use super::error::CliError;
use super::exit::Exit;
use super::output::print;
use super::simulate::held;
use crate::atomic::FileError;
use crate::study::{Layout, Lock, Texts, orphans};

/// Removes what experiments that are gone have left.
pub(super) fn clean(layout: &Layout, args: &CleanArgs) -> Result<Exit, CliError> {
    let _lock = Lock::of_study(layout, held(false))?;
    let orphans = orphans(layout, &Texts::read(layout)?);
    let mut text = String::new();
    for name in &orphans {
        if !args.dry_run {
            let path = layout.path(name);
            fs::remove_file(&path).map_err(|source| FileError { action: "remove", path, source })?;
        }
        text += &format!("{name}\n");
    }
    let done = if args.dry_run { "would be removed" } else { "removed" };
    print(&format!("{text}{} files {done}\n", orphans.len()))?;
    Ok(Exit::AsExpected)
}
