//! Why a command could not do its work.

use std::io;
use std::path::PathBuf;

use crate::atomic::FileError;
use crate::calibrate::CalibrationError;
use crate::spec::{IdError, Problems};
use crate::study::ThreadError;

#[derive(Debug, thiserror::Error)]
pub(super) enum CliError {
    #[error("there is no study here: no folder `experiments` in {} or above it; name one with --root", .0.display())]
    NoStudy(PathBuf),
    #[error("there is no study in {}: it has no folder `experiments`", .0.display())]
    NoStudyAt(PathBuf),
    #[error("there are no experiments yet: write one into experiments/")]
    NoExperiments,
    #[error("no experiment matches `{pattern}`; there are {known}")]
    NoMatch { pattern: String, known: String },
    #[error(
        "no entry of the reference matches `{0}`; `shotdamp check` and the reports name them, as in ch3-limit-stop/parting"
    )]
    NoEntry(String),
    #[error("no experiment belongs to chapter {0}")]
    NoChapter(u32),
    #[error(transparent)]
    Name(#[from] IdError),
    #[error(transparent)]
    Calibration(#[from] CalibrationError),
    #[error(transparent)]
    Text(#[from] Problems),
    #[error(transparent)]
    File(#[from] FileError),
    #[error(transparent)]
    Threads(#[from] ThreadError),
    #[error("{0}")]
    Output(#[from] io::Error),
}

impl CliError {
    pub fn is_broken_pipe(&self) -> bool {
        matches!(self, Self::Output(error) if error.kind() == io::ErrorKind::BrokenPipe)
    }
}
