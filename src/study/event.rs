//! What happens in a run, for progress bars and logs; the runner itself prints nothing.

use super::failures::Failures;
use crate::experiment::ExperimentId;

/// Something that happened.
#[derive(Debug, Clone, PartialEq)]
pub enum Event<'a> {
    /// The run starts.
    Begun {
        /// Experiments to be run.
        experiments: usize,
        /// Simulations that they take at most.
        simulations: u64,
    },
    /// Simulations were made, or turned out not to be needed.
    Simulated {
        /// For which experiment.
        experiment: &'a ExperimentId,
        /// How many.
        count: u64,
    },
    /// A search has made another step.
    Searched {
        /// For which experiment.
        experiment: &'a ExperimentId,
        /// Which search.
        search: &'a str,
        /// Evaluations of it so far.
        evaluations: u64,
        /// Best fitness of it so far.
        best: f64,
        /// Its unit.
        unit: &'a str,
    },
    /// A calibration has tried more sets of inputs.
    Tried {
        /// Sets so far.
        sets: usize,
        /// Those of them that were not run to the end, as they could not change the answer.
        given_up: usize,
        /// The least residual so far.
        best: Option<f64>,
    },
    /// An experiment's table is complete and on disk.
    Finished {
        /// Which.
        experiment: &'a ExperimentId,
        /// Rows of its table.
        rows: usize,
        /// Rows among them without numbers.
        failures: &'a Failures,
        /// Processor time of its simulations, s; `None` if there were none.
        seconds: Option<f64>,
    },
    /// An interrupt ended an experiment before its last row.
    Interrupted {
        /// Which.
        experiment: &'a ExperimentId,
        /// What there is of it.
        left: Left,
    },
    /// The run is over.
    Ended,
}

/// What an interrupt leaves of an experiment for the next run.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Left {
    /// Nothing was simulated for it yet.
    NotBegun,
    /// Rows, which are kept.
    Rows {
        /// Those that have numbers.
        done: usize,
        /// All of them, as far as they were known.
        rows: usize,
    },
    /// The journal of its searches.
    Journal,
    /// Nothing that could be used.
    Nothing,
}

/// Handles the events of a run. Called from many threads.
pub trait EventHandler: Sync {
    /// Handles one.
    fn on_event(&self, event: &Event<'_>);
}

/// Ignores all of them.
#[derive(Debug, Clone, Copy, Default)]
pub struct IgnoreEvents;

impl EventHandler for IgnoreEvents {
    fn on_event(&self, _event: &Event<'_>) {}
}
