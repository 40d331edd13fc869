//! What the rows of a table come from.

use super::continuation::Continuation;
use super::definition::Experiment;
use super::optimise::Optimise;
use super::starts::Starts;

/// What the rows of an experiment's table come from.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum RowSource<'a> {
    /// Cases, each by itself.
    Cases,
    /// Candidates of a search.
    Search(&'a Optimise),
    /// Orbits of branches.
    Branches(&'a Continuation),
    /// Motions that random starts of each case end in.
    Basins(&'a Starts),
}

impl Experiment {
    /// What its rows come from.
    #[must_use]
    pub fn row_source(&self) -> RowSource<'_> {
        match (&self.optimise, &self.orbit, &self.starts) {
            (Some(optimise), ..) => RowSource::Search(optimise),
            (None, Some(orbit), _) => RowSource::Branches(orbit),
            (None, None, Some(starts)) => RowSource::Basins(starts),
            (None, None, None) => RowSource::Cases,
        }
    }

    /// How many rows it has is known once they are there: its table is made by one task.
    #[must_use]
    pub fn is_whole(&self) -> bool {
        self.row_source() != RowSource::Cases
    }
}
