//! A study: the plan, what is stale and why, the parallel runner, its tables and records.
//!
//! texts → experiments → [`Item`]s (what each depends on, what is on disk) → [`run`] → tables and records; what was up to date
//! after the last run ([`Snapshot`]) is neither read nor planned. Nothing here
//! draws or judges: verdicts, figures and reports are made from the tables afterwards.

mod basins;
mod canonical;
mod chain;
mod doubt;
mod earlier;
mod evaluate;
mod event;
mod extent;
mod forecast;
mod gather;
mod glance;
mod inputs;
mod job;
mod journal;
mod keeping;
mod kept_lines;
mod known_rows;
mod layout;
mod left_out;
mod limited;
mod load;
mod machine;
mod maximise;
mod mean;
mod motions;
mod open;
mod optimise;
mod orbit;
mod orphan;
mod plan;
mod progress;
mod reason;
mod record;
mod refine;
mod row_failure;
mod row_fingerprint;
mod run;
mod run_times;
mod shard;
mod shares;
mod snapshot;
mod spent;
mod store;
mod summary;
mod tabulate;
mod tabulate_basins;
mod tabulate_branches;
mod tabulate_candidates;
mod texts;
mod threshold;
mod untabulate;
mod variant;
mod warning;
mod work;

pub use canonical::{Change, fingerprint};
pub use evaluate::{Array, Engine, Evaluate, Simulation};
pub use event::{Event, EventHandler, IgnoreEvents, Left};
pub use extent::Extent;
pub use forecast::{before_run, forecast};
pub use gather::{GatherError, gather};
pub use inputs::Inputs;
pub use job::runs_of_a_row;
pub use keeping::is_keeping_rows;
pub(crate) use kept_lines::KeptLines;
pub use known_rows::KnownRows;
pub use layout::{
    ASSUMPTIONS, Layout, STUDY, calibration_journal_name, folder_of, journal_name, record_name, stem, table_name,
};
pub use left_out::{LeftOutRecord, PredictedErrors};
pub use load::{Loaded, Refused, Source, Untried};
pub use machine::Machine;
pub use motions::{Deviation, Motions, Settling, row_in_words};
pub use open::Study;
pub use orphan::{earlier_tables, orphans};
pub use plan::{Item, State};
pub use progress::Progress;
pub(crate) use progress::simulations;
pub use reason::{Reason, differences};
pub use record::{Failures, FileHash, NoRecord, PRESENTATION_VERSION, Publication, RECORD_FORMAT, Record};
pub use row_failure::{RowFailure, SearchError};
pub use run::{Finished, RunError, Task, run};
pub use run_times::RunTimes;
pub use shard::{NotThePart, Shard, ShardError};
pub use shares::{Attracting, BestMotion, CaseShares, StartShares};
pub use snapshot::Snapshot;
pub use spent::{Cost, Spent};
pub use store::{Held, Lock, LockError, is_begun, keep, remove_journals, save};
pub use summary::{Heading, Summary, Used};
pub use texts::{Bytes, Texts, Unreadable};
pub use threshold::{ThresholdAlong, thresholds};
pub use variant::{Sensitivity, Variant, variants};
