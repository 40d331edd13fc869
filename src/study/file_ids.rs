//! The ids that the names of files are: each file of a kind has one of its own in the whole study, in whatever folder below that of its
//! kind it stands.

use std::collections::BTreeMap;

use super::layout::stem;
use super::refused::Refused;
use crate::experiment::ExperimentId;

const YAML: &str = ".yaml";

/// The ids of files of one kind.
pub(super) struct FileIds<'a> {
    by_stem: BTreeMap<&'a str, Vec<&'a str>>,
}

impl<'a> FileIds<'a> {
    /// Of these files. One of another ending is refused by itself.
    pub(super) fn of(files: impl Iterator<Item = &'a str>) -> Self {
        let mut by_stem = BTreeMap::<&str, Vec<&str>>::new();
        for file in files.filter(|file| file.ends_with(YAML)) {
            by_stem.entry(stem(file)).or_default().push(file);
        }
        Self { by_stem }
    }

    /// The id that one's name is.
    pub(super) fn id_of(&self, file: &str) -> Result<ExperimentId, Refused> {
        let name = file.rsplit('/').next().unwrap_or(file);
        let stem = name.strip_suffix(YAML).ok_or_else(|| Refused::Ending(file.into()))?;
        let id = stem.parse().map_err(|error| Refused::Name { file: file.into(), error })?;
        match self.by_stem.get(stem).and_then(|files| files.iter().find(|other| **other != file)) {
            Some(other) => Err(Refused::Twice { file: file.into(), other: (*other).into() }),
            None => Ok(id),
        }
    }
}
