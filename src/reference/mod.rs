//! The published numbers and claims, and what became of each.
//!
//! An [`Entry`] says where a number or claim stands and how it is read from a table. [`judge`] holds it against the tables:
//! values and peaks after ASME V&V 20, claims as predicates, curves within a tube, shapes by MAC. [`self_test`] shows that every entry can fail.

mod absence;
mod accept;
mod analytic;
mod average;
mod claims;
mod columns;
mod compare;
mod damage;
mod decide;
mod entry;
mod entry_reader;
mod extract;
mod extracted;
mod extraction;
mod fit;
mod found;
mod judge;
mod judged;
mod line;
mod mapping;
mod mode_shape;
mod motion_behind;
mod name;
mod place;
mod predicate;
mod price;
mod printed;
mod prose;
mod resonance;
mod selection;
mod self_test;
mod shape;
mod tally;
mod text;
mod tube;
mod verdict;
mod view;
mod words;

pub use absence::{NoTable, WhyNoTable};
pub use accept::{AcceptError, accept};
pub(crate) use compare::COVERAGE;
pub use compare::Comparison;
pub use entry::{Check, Entry, NotJudged, Reading, ReferenceFile, Tolerance, ToleranceSize};
pub use entry_reader::{load_reference, parse_reference, reference_schema};
pub use extraction::Extraction;
pub use fit::{Fit, FitMeasure};
pub use found::Found;
pub use judge::judge;
pub use judged::{Judged, Kind, Moved, Part, Role};
pub(crate) use mapping::KnownTables;
pub use motion_behind::MotionBehind;
pub use predicate::Predicate;
pub use price::Price;
pub use printed::{Printed, PrintedError, PrintedUnit};
pub use prose::{CameOut, Placeholder, Prose, ProseError, numbers};
pub use resonance::{Feature, PrintedPeak, Which};
pub use selection::{Allowed, Selection};
pub use self_test::{Flaw, SelfTestFailure, self_test};
pub(crate) use text::symbol;
pub use verdict::Verdict;
pub use view::{TableState, Tables};
