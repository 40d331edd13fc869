//! Reports: plain functions from data to text, one file per output.
//!
//! Tables and verdicts go in, text comes out; nothing here simulates, draws or touches the disk. No output holds a time,
//! a host or a path beyond the links that the caller passes in.

mod ablation;
mod accuracy;
mod assumption;
mod calibration;
mod candidate;
mod chapter;
mod comparison;
mod console;
mod diff;
mod explain;
mod finding;
mod github;
mod glance;
mod index;
mod json;
mod junit;
mod markdown;
mod movement;
mod page;
mod proof;
mod run;
mod tally;
mod verdict_price;
mod view;

pub use ablation::ablation;
pub use accuracy::{AccuracyView, accuracy_page, accuracy_summary};
pub use assumption::value_in_words;
pub use calibration::calibration;
pub use console::summary;
pub use diff::{Detail, diff};
pub use explain::{EntryView, MoveView, explain};
pub use finding::{CheckView, CheckedEntry, Trouble};
pub use github::{SUMMARY_LIMIT, annotations, step_summary};
pub use index::index;
pub use json::{Number, Standing, json, read_json};
pub use junit::junit;
pub use movement::{Moved, Movement, between_tables, between_verdicts, standing};
pub use page::page;
pub use verdict_price::VerdictPrice;
pub use view::{AccuracyLinks, AssumptionView, ExperimentView, FigureView, PageView};
