//! Reports: plain functions from data to text, one file per output.
//!
//! Tables and verdicts go in, text comes out; nothing here simulates, draws or touches the disk. No output holds a time,
//! a host or a path beyond the links that the caller passes in.

mod assumption;
mod calibration;
mod candidate;
mod chapter;
mod comparison;
mod console;
mod explain;
mod index;
mod markdown;
mod page;
mod proof;
mod run;
mod tally;
mod view;

pub use assumption::value_in_words;
pub use calibration::calibration;
pub use console::summary;
pub use explain::{EntryView, MoveView, explain};
pub use index::index;
pub use page::page;
pub use view::{AssumptionView, ExperimentView, FigureView, PageView};
