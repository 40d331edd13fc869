//! `shotdamp run --shard 3/8`: one part of the work, for one task of a cluster's scheduler.

use super::args::{Args, RunArgs};
use super::error::CliError;
use super::exit::Exit;
use super::output::{print, print_error, print_unread};
use super::select::{choose, open};
use super::simulate::{How, Ran, held, simulate};
use crate::study::{Item, Layout, Lock, Shard, State};
use crate::text::words::counted;

/// Simulates the shard's part of what is stale, and writes nothing but its own tables: no verdicts, figures or reports.
///
/// A row without numbers is a result like any other; `gather` reports it.
pub(super) fn run_shard(layout: &Layout, args: &RunArgs, shard: Shard, common: &Args) -> Result<Exit, CliError> {
    let _lock = Lock::of_shard(layout, shard, held(args.no_wait))?;
    let mut study = open(layout)?;
    args.limit.apply(&mut study);
    let chosen = choose(&study, &args.choice)?;
    print_unread(chosen.unread.iter().copied());
    let stale = |item: &&Item| args.force || !matches!(item.state, State::Current(_));
    let part: Vec<&Item> = chosen.items.iter().copied().filter(stale).filter(|item| shard.has_part_of(item)).collect();
    let todo: Vec<&Item> = part.iter().copied().filter(|item| args.force || !shard.has_done(layout, item)).collect();
    let how = How { threads: common.threads(), quiet: common.quiet, shard: Some(shard), from_scratch: args.force };
    let Ran { unsaved, restored } = simulate(layout, &todo, how, |item, finished| shard.save(layout, item, finished))?;
    for problem in &unsaved {
        print_error(&format!("error: {problem}\n"));
    }
    let parts = counted(part.len(), "stale experiment", "stale experiments");
    let done = todo.len().saturating_sub(unsaved.len() + restored);
    print(&format!("shard {shard}: has part of {parts}; {done} simulated.\n"))?;
    Ok(if unsaved.is_empty() && chosen.unread.is_empty() { Exit::AsExpected } else { Exit::CouldNot })
}
