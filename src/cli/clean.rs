//! `shotdamp clean`: remove files that no experiment needs.

use std::collections::BTreeSet;
use std::fs;

use super::args::CleanArgs;
use super::error::CliError;
use super::exit::Exit;
use super::output::print;
use super::select::open;
use super::simulate::held;
use crate::atomic::FileError;
use crate::report::{extra_files, judge_all};
use crate::study::{Layout, Lock, earlier_tables, orphans};
use crate::text::words::counted;

/// Removes files of deleted experiments, and earlier tables.
pub(super) fn clean(layout: &Layout, args: &CleanArgs) -> Result<Exit, CliError> {
    let _lock = Lock::of_study(layout, held(false))?;
    let mut names = BTreeSet::new();
    if args.orphans {
        let study = open(layout)?;
        names.extend(orphans(layout, &study.texts));
        // Also those that no record tells of, as in a study that was just cloned.
        names.extend(extra_files(&study, &judge_all(&study)));
    }
    if args.earlier {
        names.extend(earlier_tables(layout));
    }
    let mut text = String::new();
    for name in &names {
        if !args.dry_run {
            let path = layout.path(name);
            fs::remove_file(&path).map_err(|source| FileError { action: "remove", path: path.clone(), source })?;
            // Whose last earlier table it was needs no folder for them.
            if let Some(folder) = path.parent().filter(|_| name.starts_with("results/earlier/")) {
                let _ = fs::remove_dir(folder);
            }
        }
        text += &format!("{name}\n");
    }
    let done = if args.dry_run { "would be removed" } else { "removed" };
    print(&format!("{text}{} {done}\n", counted(names.len(), "file", "files")))?;
    Ok(Exit::AsExpected)
}
