//! The arguments of the command, with their help.

use std::path::PathBuf;
use std::time::Duration;

use clap::builder::PossibleValuesParser;
use clap::{Parser, Subcommand};

use super::destination::Destination;
use super::output::Colour;
use crate::experiment::{RowLimit, structures};
use crate::report::RELEASED;
use crate::study::{Shard, Study};

/// Reproduces a published study of particle impact dampers.
///
/// Without a command: brings everything up to date. Simulates only what is stale, renews figures and reports, and prints the
/// verdicts.
#[derive(Debug, Parser)]
#[command(
    version,
    after_help = "\
Examples:
  shotdamp                                    bring everything up to date, print the verdicts
  shotdamp run ch3-limit-stop                 one experiment
  shotdamp status --why                       what is stale, and which input changed
  shotdamp check --junit verdicts.xml         verdicts over the tables on disk, for a CI
  shotdamp new ch3-my-idea                    an experiment to begin with

Exit code: 0 every verdict is the expected one; 1 some verdict is not;
2 something could not run, is missing, or was asked for wrongly; 130 interrupted."
)]
pub(super) struct Args {
    /// Folder of the study [default: the nearest parent folder with `experiments`]
    #[arg(long, global = true, value_name = "DIR")]
    pub root: Option<PathBuf>,
    /// Number of threads; results do not depend on it [default: one per processor]
    #[arg(long, short, global = true, value_name = "N", value_parser = clap::value_parser!(u16).range(1..))]
    pub jobs: Option<u16>,
    /// Print errors only
    #[arg(long, short, global = true)]
    pub quiet: bool,
    /// When to use colours; `auto`: on a terminal, unless NO_COLOR is set
    #[arg(long, global = true, value_name = "WHEN", value_enum, default_value_t = Colour::Auto)]
    pub color: Colour,
    #[command(subcommand)]
    pub command: Option<Command>,
}

impl Args {
    /// The number of threads as runners take it: 0 stands for one a processor.
    pub(super) fn threads(&self) -> usize {
        self.jobs.map_or(0, usize::from)
    }

    /// How many threads that are: one per processor unless they were counted.
    pub(super) fn workers(&self) -> usize {
        let processors = || std::thread::available_parallelism().map_or(1, usize::from);
        self.jobs.map_or_else(processors, usize::from)
    }
}

#[derive(Debug, Subcommand)]
pub(super) enum Command {
    /// Bring experiments up to date
    Run(RunArgs),
    /// Join the tables of all shards, check that each row occurs once, and continue as `run`
    Gather(GatherArgs),
    /// Write the whole study as one HTML file, from the tables on disk; simulates nothing
    Report(ReportArgs),
    /// Export the study as an RO-Crate: experiments, reference, tables, figures and pages
    Export(ExportArgs),
    /// List the experiments
    #[command(after_help = "\
Examples:
  shotdamp list
  shotdamp list | grep 'Fig. 18'              the experiment that draws a figure of the study")]
    List,
    /// Describe an experiment: scene, effects in force, assumptions used, cases
    #[command(after_help = "\
Examples:
  shotdamp show ch3-limit-stop
  shotdamp show 'ch5-*'")]
    Show {
        /// Id of the experiment, a pattern with * and ?, or its file
        id: String,
    },
    /// List what is stale; writes nothing
    Status(StatusArgs),
    /// Print the verdicts for the tables on disk; simulates nothing, and writes only what an option asks for
    Check(CheckArgs),
    /// Compare two runs: which numbers moved, and whether beyond their uncertainty
    Diff(DiffArgs),
    /// Remove files of deleted experiments, or earlier tables
    Clean(CleanArgs),
    /// Write an experiment to start from
    New(NewArgs),
    /// Write JSON Schemas, with which editors complete and check the files of a study
    Schema(SchemaArgs),
    /// Print shell completions
    #[command(after_help = "\
Examples:
  shotdamp completions bash > ~/.local/share/bash-completion/completions/shotdamp
  shotdamp completions fish > ~/.config/fish/completions/shotdamp.fish")]
    Completions {
        /// Which shell
        shell: clap_complete::Shell,
    },
    /// Switch each effect of an experiment on or off, and print the change in result, events and time; writes nothing
    #[command(after_help = "\
Examples:
  shotdamp effects ch3-limit-stop
  shotdamp effects 'ch5-measures-*'")]
    Effects {
        /// Id of the experiment, a pattern with * and ?, or its file
        id: String,
        #[command(flatten)]
        limit: LimitArgs,
    },
    /// Measure error against wall time of both solvers; writes reports/accuracy.md and reports/accuracy/
    Accuracy(AccuracyArgs),
    /// Fit unstated inputs to chosen entries, and judge the entries held out
    Calibrate(CalibrateArgs),
    /// Show how an entry depends on each assumption, and which change of one would reproduce it; simulates only with --run
    #[command(after_help = "\
Examples:
  shotdamp explain ch3-limit-stop/parting
  shotdamp explain 'ch6-beam-b1-heavy/*'
  shotdamp explain --run ch3-limit-stop/parting     with every assumption moved, simulated now")]
    Explain {
        /// Id of the entry, `ch3-limit-stop/parting`, or a pattern with * and ?
        entry: String,
        /// Simulate what the tables lack: every other value of every assumption that the entry depends on, one at a time
        #[arg(long)]
        run: bool,
        #[command(flatten)]
        limit: LimitArgs,
    },
}

/// Which experiments.
#[derive(Debug, Default, Clone, clap::Args)]
pub(super) struct Choice {
    /// Ids, patterns with * and ?, or files [default: all]
    #[arg(value_name = "PATTERN")]
    pub patterns: Vec<String>,
    /// Only experiments in this folder of `experiments/`
    #[arg(long, value_name = "DIR")]
    pub folder: Option<String>,
}

/// How long rows may take.
#[derive(Debug, Default, Clone, clap::Args)]
pub(super) struct LimitArgs {
    /// The most that a row may take, `1e7 events`, `30 s` or `1e7 events, 5 min`, in the place of `run: {limit: …}`
    #[arg(long, value_name = "LIMIT")]
    row_limit: Option<RowLimit>,
}

impl LimitArgs {
    /// Puts it in the place of the study's own.
    pub(super) fn apply(&self, study: &mut Study) {
        study.limit_rows(self.row_limit.unwrap_or_default());
    }
}

#[derive(Debug, Default, clap::Args)]
#[command(after_help = "\
Examples:
  shotdamp run                                all that is stale
  shotdamp run ch3-limit-stop                 one experiment; --force to simulate it again
  shotdamp run 'ch3-gap*' --dry-run           what a pattern would simulate
  shotdamp run --folder ch4 --jobs 1
  shotdamp run --force --times                all of it from nothing, and what it took")]
pub(super) struct RunArgs {
    #[command(flatten)]
    pub choice: Choice,
    /// Simulate again also what is up to date
    #[arg(long)]
    pub force: bool,
    /// Print what would be simulated, and stop
    #[arg(long)]
    pub dry_run: bool,
    /// Simulate only; leave figures and reports as they are, for `check --reports`
    #[arg(long)]
    pub tables: bool,
    /// Write the processor time of each experiment to reports/times.json, which the index shows
    #[arg(long, conflicts_with_all = ["dry_run", "shard"])]
    pub times: bool,
    #[command(flatten)]
    pub limit: LimitArgs,
    /// Look at every byte of earlier results, and simulate again what is damaged or was changed
    #[arg(long)]
    pub verify: bool,
    /// Compute one of n parts of the work, here the third of eight; `gather` joins their tables
    #[arg(long, value_name = "3/8", conflicts_with = "dry_run")]
    pub shard: Option<Shard>,
    /// Fail if another run holds the lock, instead of waiting
    #[arg(long)]
    pub no_wait: bool,
}

impl RunArgs {
    /// Tables that are known to be up to date are read, too.
    pub(super) fn reads_all(&self) -> bool {
        self.force || self.verify
    }
}

#[derive(Debug, clap::Args)]
#[command(after_help = "\
Examples:
  shotdamp gather                             after the last shard
  shotdamp gather --of 64                     if there are tables of several divisions")]
pub(super) struct GatherArgs {
    #[command(flatten)]
    pub choice: Choice,
    /// Number of shards; needed only if there are tables of several divisions
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..))]
    pub of: Option<u32>,
    /// Gather again also what is up to date
    #[arg(long)]
    pub force: bool,
    /// Fail if another run holds the lock, instead of waiting
    #[arg(long)]
    pub no_wait: bool,
}

#[derive(Debug, clap::Args)]
#[command(after_help = "\
Examples:
  shotdamp export --ro-crate study-crate
  shotdamp export --ro-crate chapter-3 --folder ch3")]
pub(super) struct ExportArgs {
    #[command(flatten)]
    pub choice: Choice,
    /// Write an RO-Crate into this folder, which must not exist yet
    #[arg(long, value_name = "DIR")]
    pub ro_crate: PathBuf,
    /// Date of publication in its metadata; defaults to that of this version of the program
    #[arg(long, value_name = "YYYY-MM-DD", value_parser = date, default_value = RELEASED)]
    pub published: String,
}

#[derive(Debug, clap::Args)]
#[command(after_help = "\
The file needs no network and no other file: pages, figures with values under the pointer, and all verdicts to sort and filter.
Its address names a page or an entry: study.html#ch3-limit-stop, study.html#ch3-limit-stop/parting.

Examples:
  shotdamp report --html study.html
  shotdamp --root examples/classics report --html classics.html")]
pub(super) struct ReportArgs {
    /// The file to write; `-`: standard output
    #[arg(long, value_name = "FILE")]
    pub html: Destination,
}

#[derive(Debug, thiserror::Error)]
#[error("write a number of seconds above zero, such as 0.5")]
struct SecondsError;

fn seconds(text: &str) -> Result<Duration, SecondsError> {
    let seconds = text.parse().ok().and_then(|seconds| Duration::try_from_secs_f64(seconds).ok());
    seconds.filter(|seconds| !seconds.is_zero()).ok_or(SecondsError)
}

#[derive(Debug, thiserror::Error)]
#[error("there is no such day; write a date as 2026-11-21")]
struct DateError;

fn date(text: &str) -> Result<String, DateError> {
    let is_number = |part: &str| part.bytes().all(|byte| byte.is_ascii_digit());
    let parts: Vec<Option<u32>> = text.split('-').map(|part| part.parse().ok().filter(|_| is_number(part))).collect();
    let lengths = text.split('-').map(str::len);
    match parts.as_slice() {
        [Some(year), Some(month), Some(day)] if lengths.eq([4, 2, 2]) && (1..=days_of(*month, *year)).contains(day) => {
            Ok(text.into())
        }
        _ => Err(DateError),
    }
}

/// Days of a month of the Gregorian calendar; none of a month that there is not.
fn days_of(month: u32, year: u32) -> u32 {
    let is_leap = year.is_multiple_of(4) && (!year.is_multiple_of(100) || year.is_multiple_of(400));
    match month {
        2 => 28 + u32::from(is_leap),
        4 | 6 | 9 | 11 => 30,
        1..=12 => 31,
        _ => 0,
    }
}

#[derive(Debug, clap::Args)]
#[command(after_help = "\
Examples:
  shotdamp accuracy ch3-limit-stop
  shotdamp accuracy --all --longest 0.5       without the smallest steps of long runs")]
pub(super) struct AccuracyArgs {
    /// Ids, patterns with * and ?, or files
    #[arg(value_name = "PATTERN", conflicts_with = "all")]
    pub patterns: Vec<String>,
    /// All experiments; prints the summary in the place of their pages
    #[arg(long)]
    pub all: bool,
    /// Measure nothing: write pages and pictures again from what was measured before, with the verdicts as they are
    #[arg(long, conflicts_with_all = ["all", "patterns"])]
    pub pages: bool,
    /// Longest run in seconds; smaller steps are skipped
    #[arg(long, value_name = "SECONDS", value_parser = seconds, default_value = "2")]
    pub longest: Duration,
    #[command(flatten)]
    pub limit: LimitArgs,
}

#[derive(Debug, clap::Args)]
#[command(after_help = "\
Examples:
  shotdamp calibrate beam-arrays
  shotdamp calibrate all-chapters --jobs 2")]
pub(super) struct CalibrateArgs {
    /// Name of a file in `calibrations/`, without extension, or the file
    pub id: String,
    #[command(flatten)]
    pub limit: LimitArgs,
}

#[derive(Debug, clap::Args)]
#[command(after_help = "\
Examples:
  shotdamp status --why
  shotdamp status --exit-code --quiet || shotdamp run")]
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
#[command(after_help = "\
Examples:
  shotdamp check                              all verdicts; what is not as expected in full
  shotdamp check 'ch3-*' --junit verdicts.xml
  shotdamp check --markdown summary.md        what a pull request changes
  shotdamp check --github                     in a workflow: annotations, and a summary of the step
  shotdamp check --reports                    are the committed reports those of these results?
  shotdamp check --accept ch3-limit-stop/same-below --reason \"Within the noise since the finer sweep.\"")]
pub(super) struct CheckArgs {
    #[command(flatten)]
    pub choice: Choice,
    /// Check that each entry can fail
    #[arg(long)]
    pub self_test: bool,
    /// Also write the verdicts as JUnit XML; `-`: to standard output, in their place
    #[arg(long, value_name = "FILE")]
    pub junit: Option<Destination>,
    /// Also write the summary that a pull request shows, as Markdown: changes against the committed verdicts first; `-`: to
    /// standard output, in the place of the verdicts
    #[arg(long, value_name = "FILE")]
    pub markdown: Option<Destination>,
    /// With --markdown: the committed verdicts [default: reports/verdicts.json]
    #[arg(long, value_name = "FILE", requires = "markdown")]
    pub against: Option<PathBuf>,
    /// Print the worst verdicts as GitHub annotations, and append to $GITHUB_STEP_SUMMARY
    #[arg(long)]
    pub github: bool,
    /// Print the verdicts as JSON instead
    #[arg(long, conflicts_with = "github")]
    pub json: bool,
    /// Also check that reports/ is up to date; with PATTERN, only the pages and figures of those experiments
    #[arg(long)]
    pub reports: bool,
    /// Change the expected verdict of this entry (experiment/entry) in its file to the one that it got
    #[arg(long, value_name = "ID", requires = "reason", conflicts_with_all = ["patterns", "folder"])]
    pub accept: Option<String>,
    /// With --accept: why; becomes the explanation of the entry
    #[arg(long, value_name = "TEXT", requires = "accept")]
    pub reason: Option<String>,
}

#[derive(Debug, clap::Args)]
#[command(after_help = "\
Each side is a folder of tables (results/), or of reports (reports/, or a verdicts.json).
Two folders of tables are compared row by row; otherwise verdict by verdict, tables judged by this study's reference.
Exit code 1 if anything moved beyond its uncertainty. Entries of experiments that were not run are counted apart.

Examples:
  shotdamp diff                               what the reports say against what the tables give now
  shotdamp diff --only 'ch3-gap*'
  shotdamp diff before/results results
  shotdamp diff before/results --all")]
pub(super) struct DiffArgs {
    /// The first [default: the reports of this study]
    #[arg(value_name = "A")]
    pub a: Option<PathBuf>,
    /// The second [default: the tables of this study]
    #[arg(value_name = "B")]
    pub b: Option<PathBuf>,
    /// Only these experiments: an id, or a pattern with * and ?
    #[arg(long, value_name = "PATTERN")]
    pub only: Option<String>,
    /// List all that moved, not only the farthest few of each experiment
    #[arg(long)]
    pub all: bool,
}

#[derive(Debug, clap::Args)]
#[command(after_help = "\
The file is valid as written; change it, and check it with `shotdamp show` and in your editor.

Examples:
  shotdamp new ch3-my-idea
  shotdamp new ch5-thin-plate --structure supported_plate")]
pub(super) struct NewArgs {
    /// Id of the experiment: lower-case letters, digits and hyphens
    pub id: String,
    /// Folder of `experiments/` [default: one whose name the id begins with, if there is one]
    #[arg(long, value_name = "DIR")]
    pub folder: Option<String>,
    /// Kind of structure
    #[arg(long, value_name = "KIND", default_value = "single_mass", value_parser = PossibleValuesParser::new(structures()))]
    pub structure: String,
}

#[derive(Debug, clap::Args)]
#[command(after_help = "\
An editor with a YAML language server uses a schema in files that begin with
  # yaml-language-server: $schema=../../schema/experiment.json

Examples:
  shotdamp schema                             writes schema/*.json into the study
  shotdamp schema experiment                  prints one")]
pub(super) struct SchemaArgs {
    /// Print this schema instead of writing all
    #[arg(value_enum)]
    pub of: Option<SchemaOf>,
}

/// The kinds of file that have a schema.
#[derive(Debug, Clone, Copy, PartialEq, Eq, clap::ValueEnum)]
pub(super) enum SchemaOf {
    Study,
    Experiment,
    Assumptions,
    Reference,
    Calibration,
}

#[derive(Debug, clap::Args)]
#[command(group(clap::ArgGroup::new("what").required(true).multiple(true)), after_help = "\
Name at least one of --orphans and --earlier.

Examples:
  shotdamp clean --orphans --dry-run
  shotdamp clean --orphans
  shotdamp clean --earlier                    free disk space; going back to earlier inputs then re-simulates")]
pub(super) struct CleanArgs {
    /// Remove tables, records, figures and pages of experiments and calibrations whose files no longer exist, and every other .md, .png
    /// and .svg below reports/ that no run writes
    #[arg(long, group = "what")]
    pub orphans: bool,
    /// Remove earlier tables, which are kept so that going back to earlier inputs simulates nothing
    #[arg(long, group = "what")]
    pub earlier: bool,
    /// Print what would be removed, and stop
    #[arg(long)]
    pub dry_run: bool,
}
