//! Where a command writes what an option asks for: standard output, or a file that is none of the study's own.

use std::ffi::OsString;
use std::path::{Path, PathBuf};

use super::error::CliError;
use super::output::print_document;
use crate::atomic::{self, from_here};
use crate::study::Layout;

/// Names of standard output.
const STANDARD_OUTPUT: [&str; 4] = ["-", "/dev/stdout", "/dev/fd/1", "/proc/self/fd/1"];

/// A file, or standard output, which is then the document's alone.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) enum Destination {
    StandardOutput,
    File(PathBuf),
}

impl From<OsString> for Destination {
    fn from(given: OsString) -> Self {
        if STANDARD_OUTPUT.iter().any(|name| given == *name) { Self::StandardOutput } else { Self::File(given.into()) }
    }
}

impl Destination {
    /// The error of a file that the study itself reads or writes; to be asked before any work is done.
    pub fn check(&self, layout: &Layout) -> Result<(), CliError> {
        match self {
            Self::StandardOutput => Ok(()),
            Self::File(path) => outside(layout, path),
        }
    }

    pub fn write(&self, text: &str) -> Result<(), CliError> {
        match self {
            Self::StandardOutput => print_document(text)?,
            Self::File(path) => atomic::write(path, text.as_bytes())?,
        }
        Ok(())
    }
}

/// The error of a path where the study keeps its own files.
pub(super) fn outside(layout: &Layout, path: &Path) -> Result<(), CliError> {
    match layout.part_of(path) {
        Some(part) => Err(CliError::Own { path: from_here(path), part }),
        None => Ok(()),
    }
}
