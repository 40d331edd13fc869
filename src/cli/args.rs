//! Arguments, as written.

use std::path::PathBuf;

use clap::{Parser, Subcommand};

use crate::publish::RELEASED;
use crate::study::Shard;

/// Reproduces a published study of particle impact dampers.
///
/// Without a command: brings everything up to date (simulates only what is stale), renews figures and reports, and prints
/// the verdicts.
#[derive(Debug, Parser)]
#[command(
    version,
    after_help = "Exit code: 0 every verdict is the expected one; 1 some verdict is not; \
                  2 something could not run, is missing, or was asked for wrongly."
)]
pub(super) struct Args {
    /// Folder of the study; by default the nearest one upwards that holds `experiments`
    #[arg(long, global = true, value_name = "DIR")]
    pub root: Option<PathBuf>,
    #[command(subcommand)]
    pub command: Option<Command>,
}

#[derive(Debug, Subcommand)]
pub(super) enum Command {
    /// Bring experiments up to date
    Run(RunArgs),
    /// Join the tables of all shards, after checking that no row is missing or there twice; then as `run`
    Gather(GatherArgs),
    /// Hand the study on: experiments, reference, tables, figures and pages in one described folder
    Export(ExportArgs),
    /// List the experiments
    List,
    /// Show one experiment: its scene in words, the effects in force, the assumptions it uses, its cases
    Show {
        /// Id of the experiment
        id: String,
    },
    /// Say what is stale; writes nothing
    Status(StatusArgs),
    /// Give the verdicts over the tables on disk; simulates and writes nothing
    Check(CheckArgs),
}

/// Which experiments.
#[derive(Debug, Default, Clone, clap::Args)]
pub(super) struct Choice {
    /// Ids, or patterns with * and ?; none for all
    #[arg(value_name = "PATTERN")]
    pub patterns: Vec<String>,
    /// Only this chapter of the study
    #[arg(long, value_name = "N")]
    pub chapter: Option<u32>,
}

#[derive(Debug, Default, clap::Args)]
pub(super) struct RunArgs {
    #[command(flatten)]
    pub choice: Choice,
    /// Simulate also what is up to date
    #[arg(long)]
    pub force: bool,
    /// Threads; by default one a processor. The results do not depend on it
    #[arg(long, short, value_name = "N", value_parser = clap::value_parser!(u16).range(1..))]
    pub jobs: Option<u16>,
    /// Only say what would be simulated
    #[arg(long)]
    pub dry_run: bool,
    /// Go on after an experiment that fails; this is what happens anyway
    #[arg(long)]
    pub keep_going: bool,
    /// Print errors only
    #[arg(long, short)]
    pub quiet: bool,
    /// Only the third of eight parts of the work, into tables of its own; `gather` joins them
    #[arg(long, value_name = "3/8", conflicts_with = "dry_run")]
    pub shard: Option<Shard>,
    /// Fail if another run is at work here, instead of waiting for it
    #[arg(long)]
    pub no_wait: bool,
}

#[derive(Debug, clap::Args)]
pub(super) struct GatherArgs {
    #[command(flatten)]
    pub choice: Choice,
    /// The number of shards; needed only if there are tables of several divisions
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..))]
    pub of: Option<u32>,
    /// Gather also what is up to date
    #[arg(long)]
    pub force: bool,
    /// Print errors only
    #[arg(long, short)]
    pub quiet: bool,
    /// Fail if another run is at work here, instead of waiting for it
    #[arg(long)]
    pub no_wait: bool,
}

#[derive(Debug, clap::Args)]
pub(super) struct ExportArgs {
    #[command(flatten)]
    pub choice: Choice,
    /// Write an RO-Crate into this folder, which must not exist yet
    #[arg(long, value_name = "DIR")]
    pub ro_crate: PathBuf,
    /// When it is published, for its description; by default when this version of the program was
    #[arg(long, value_name = "YYYY-MM-DD", value_parser = date, default_value = RELEASED)]
    pub published: String,
}

fn date(text: &str) -> Result<String, String> {
    let parts: Vec<Option<u32>> = text.split('-').map(|part| part.parse().ok()).collect();
    let lengths = text.split('-').map(str::len);
    match parts.as_slice() {
        [Some(_), Some(1..=12), Some(1..=31)] if lengths.eq([4, 2, 2]) => Ok(text.into()),
        _ => Err("a date is written 2026-11-21".into()),
    }
}

#[derive(Debug, clap::Args)]
pub(super) struct StatusArgs {
    #[command(flatten)]
    pub choice: Choice,
    /// Name the inputs that changed
    #[arg(long)]
    pub why: bool,
    /// Exit with 1 if anything is stale
    #[arg(long)]
    pub exit_code: bool,
}

#[derive(Debug, clap::Args)]
pub(super) struct CheckArgs {
    #[command(flatten)]
    pub choice: Choice,
    /// Show of each entry that it can fail
    #[arg(long)]
    pub self_test: bool,
}
