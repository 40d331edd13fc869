//! Files to text, with limits first: a file is never read further than an experiment could reach.

use std::fs::File;
use std::io::Read;
use std::path::Path;

use super::recipe::{AssumptionSheet, Assumptions};
use crate::atomic::from_here;
use crate::yaml::{LONGEST, Problems, too_long};

use super::assumption_reader::parse_assumptions;
use super::definition::Experiment;
use super::id::ExperimentId;
use super::validate::parse_experiment;
use crate::text::utf8::decode;

/// Reads an experiment; its id is the file's name without ending. Every case is tried against `assumptions`.
///
/// # Errors
/// Every mistake of the file, with its place.
pub fn load_experiment(path: &Path, assumptions: &Assumptions) -> Result<Experiment, Problems> {
    let file = from_here(path);
    let stem = path.file_stem().map(|stem| stem.to_string_lossy().into_owned()).unwrap_or_default();
    let id: ExperimentId = stem.parse().map_err(|error: super::IdError| {
        Problems::unreadable(&file, error.to_string(), Some("rename the file".into()))
    })?;
    parse_experiment(&id, &file, &read(path, &file)?, assumptions)
}

/// Reads the assumptions file.
///
/// # Errors
/// Every mistake of the file, with its place.
pub fn load_assumptions(path: &Path) -> Result<AssumptionSheet, Problems> {
    let file = from_here(path);
    parse_assumptions(&file, &read(path, &file)?)
}

pub(crate) fn read(path: &Path, file: &str) -> Result<String, Problems> {
    let cannot = |error: std::io::Error| Problems::unreadable(file, format!("cannot be read: {error}"), None);
    let mut bytes = Vec::new();
    File::open(path).map_err(cannot)?.take(LONGEST as u64 + 1).read_to_end(&mut bytes).map_err(cannot)?;
    if bytes.len() > LONGEST {
        let length = std::fs::metadata(path).map_or(bytes.len() as u64, |meta| meta.len());
        return Err(Problems::unreadable(file, too_long(length), None));
    }
    decode(&bytes).map(str::to_owned).map_err(|error| Problems::unreadable(file, format!("is {error}"), None))
}
