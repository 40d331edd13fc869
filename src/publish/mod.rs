//! From tables to what people read: verdicts, figures, reports.
//!
//! Stands above the study and below the command. Nothing here simulates, and all of it can be made again from the tables.

mod accuracy;
mod committed;
mod explain;
mod figures;
mod opened;
mod otherwise;
mod pages;
mod publication;
mod ro_crate;
mod verdicts;
mod views;

pub use accuracy::{publish_accuracy, publish_accuracy_summary};
pub use committed::{Departure, How, departures};
pub use explain::{Trial, entry, explanations, untried};
pub use figures::figure_name;
pub use opened::{Opened, Unread};
pub use pages::{Published, VERDICTS, publish};
pub use publication::publication_reasons;
pub use ro_crate::{CrateError, RELEASED, export_crate};
pub use verdicts::{Judgement, judge_all, judge_tables, self_test_all};
pub use views::{check_view, scenes, summary};
