//! The files that a person writes, each kind in a folder of its own.

use super::layout::ASSUMPTIONS;

/// What a file is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum FileKind {
    /// An experiment.
    Experiment,
    /// What was published of an experiment.
    Reference,
    /// A calibration.
    Calibration,
}

impl FileKind {
    /// All of them.
    pub const ALL: [Self; 3] = [Self::Experiment, Self::Reference, Self::Calibration];

    /// The folder of its files.
    #[must_use]
    pub const fn folder(self) -> &'static str {
        match self {
            Self::Experiment => "experiments",
            Self::Reference => "reference",
            Self::Calibration => "calibrations",
        }
    }

    /// What a file is by its name within the study; `None` of those of no such kind, as of the assumptions among the experiments.
    #[must_use]
    pub fn of(name: &str) -> Option<Self> {
        let (folder, _) = name.split_once('/').filter(|_| name != ASSUMPTIONS)?;
        Self::ALL.into_iter().find(|kind| kind.folder() == folder)
    }
}
