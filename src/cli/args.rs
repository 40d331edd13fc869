//! Arguments, as written.

use std::path::PathBuf;

use clap::{Parser, Subcommand};

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
    /// Look for the values of unstated inputs that bring chosen entries nearest, and see what becomes of others
    Calibrate(CalibrateArgs),
    /// Say how an entry hangs on each assumption, and which change of one would reproduce it; simulates nothing
    Explain {
        /// Id of the entry, `ch3-limit-stop/parting`, or a pattern with * and ?
        entry: String,
    },
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
}

#[derive(Debug, clap::Args)]
pub(super) struct CalibrateArgs {
    /// Name of a file in `calibrations/`, without ending
    pub id: String,
    /// Threads; by default one a processor. The results do not depend on it
    #[arg(long, short, value_name = "N", value_parser = clap::value_parser!(u16).range(1..))]
    pub jobs: Option<u16>,
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
