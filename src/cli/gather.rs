//! `shotdamp gather`: the tables of all shards become those of the study.

use super::args::GatherArgs;
use super::error::CliError;
use super::exit::Exit;
use super::output::print_unread;
use super::select::{Found, choose};
use super::simulate::held;
use super::update::{Done, conclude};
use crate::study::{Item, Layout, Lock, Shard, State, gather, save};

/// Joins what is stale, then judges, draws and writes as `run` does.
pub(super) fn gather_all(layout: &Layout, args: &GatherArgs) -> Result<Exit, CliError> {
    let _lock = Lock::of_study(layout, held(args.no_wait))?;
    let mut study = Found::look(layout)?.open(layout, &args.choice, args.force);
    let chosen = choose(&study, &args.choice)?;
    print_unread(chosen.unread.iter().copied());
    let stale = |item: &&Item| args.force || !matches!(item.state, State::Current(_));
    let todo: Vec<&Item> = chosen.items.iter().copied().filter(stale).collect();
    let mut problems = Vec::new();
    if !todo.is_empty() {
        let of = division(layout, args.of)?;
        for item in &todo {
            // One table at a time is in memory: they may be large.
            match gather(layout, item, of) {
                Ok(whole) => {
                    if let Err(error) = save(layout, item, &whole) {
                        problems.push(format!("{}: {error}", item.source.experiment.id));
                    }
                }
                Err(error) => problems.push(error.to_string()),
            }
        }
    }
    let experiments = todo.len() - problems.len();
    let done = Done { verb: "gathered", experiments, restored: 0, problems, tables_only: false };
    study.refresh();
    conclude(&study, &args.choice, done)
}

/// The number of shards whose tables are to be joined.
fn division(layout: &Layout, description: Option<u32>) -> Result<u32, CliError> {
    if let Some(of) = description {
        return Ok(of);
    }
    let counts = Shard::counts(layout);
    match counts.as_slice() {
        [] => Err(CliError::NoShards),
        [of] => Ok(*of),
        _ => Err(CliError::Divisions(counts)),
    }
}
