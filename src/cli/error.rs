//! Why a command could not do its work.

use std::io;
use std::path::PathBuf;

use crate::atomic::{FileError, from_here};
use crate::calibrate::CalibrationError;
use crate::experiment::IdError;
use crate::reference::AcceptError;
use crate::report::CrateError;
use crate::study::{LockError, RunError};
use crate::yaml::Problems;

#[derive(Debug, thiserror::Error)]
pub(super) enum CliError {
    #[error("there is no study here: no folder `experiments` in {} or above it; make that folder to begin a study, or name a study with --root", from_here(.0))]
    NoStudy(PathBuf),
    #[error("there is no study in {}: it has no folder `experiments`; make that folder to begin a study there", from_here(.0))]
    NoStudyAt(PathBuf),
    #[error("the current folder cannot be found: {0}; change to one that exists, or name a study with --root")]
    Here(#[source] io::Error),
    #[error("there are no experiments yet: `shotdamp new ID` begins one in experiments/")]
    NoExperiments,
    #[error("no experiment matches `{pattern}`; {hint}")]
    NoMatch { pattern: String, hint: String },
    #[error("no experiment in experiments/{folder} matches `{pattern}`; elsewhere one does: leave out --folder")]
    ElsewhereOnly { pattern: String, folder: String },
    #[error("there is no calibration `{id}`; {hint}")]
    NoCalibration { id: String, hint: String },
    #[error("`shotdamp {0}` needs the id of an experiment, or --all")]
    NothingChosen(&'static str),
    #[error("no experiment lies in experiments/{folder}; there are {known}")]
    NoFolder { folder: String, known: String },
    #[error(
        "`{0}` cannot name a folder of experiments/: write names of letters, digits, `-` and `_`, with `/` between them"
    )]
    Folder(String),
    #[error("there is no entry `{entry}`; {hint}")]
    NoEntry { entry: String, hint: String },
    #[error("{} holds neither tables (*.parquet) nor verdicts (verdicts.json)", from_here(.0))]
    NoResults(PathBuf),
    #[error("{} is a single table: name the folder that it lies in", from_here(.0))]
    OneTable(PathBuf),
    #[error("cannot compare {}: {problem}", from_here(.path))]
    Unreadable { path: PathBuf, problem: String },
    #[error("`{path}` is or lies in `{part}` of this study, which holds its own files: name another place")]
    Own { path: String, part: &'static str },
    #[error("only one document can go to standard output: name a file for the others")]
    TwoDocuments,
    #[error("there is an experiment `{0}` already; choose another id")]
    Exists(String),
    #[error("experiments/assumptions.yaml holds the assumptions of all experiments: name this one otherwise")]
    OfAssumptions,
    #[error(transparent)]
    Accept(#[from] AcceptError),
    #[error(transparent)]
    Name(#[from] IdError),
    #[error(transparent)]
    Calibration(#[from] CalibrationError),
    #[error(transparent)]
    Text(#[from] Problems),
    #[error(transparent)]
    File(#[from] FileError),
    #[error(transparent)]
    Lock(#[from] LockError),
    #[error("there are no tables of shards; `shotdamp run --shard 1/8` makes those of the first of eight")]
    NoShards,
    #[error("there are tables of {} shards; say which with --of", .0.iter().map(u32::to_string).collect::<Vec<_>>().join(" and of "))]
    Divisions(Vec<u32>),
    #[error(transparent)]
    Crate(#[from] CrateError),
    #[error(transparent)]
    Run(#[from] RunError),
    #[error("{0}")]
    Output(#[from] io::Error),
}
