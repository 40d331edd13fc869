//! From tables to what people read: verdicts, figures, reports.
//!
//! Stands above the study and below the command. Nothing here simulates, and all of it can be made again from the tables.

mod explain;
mod figures;
mod opened;
mod pages;
mod publication;
mod verdicts;
mod views;

pub use explain::explanations;
pub use figures::figure_name;
pub use opened::{Opened, Unread};
pub use pages::{Published, publish};
pub use publication::publication_reasons;
pub use verdicts::{Judgement, judge_all, self_test_all};
pub use views::{scenes, summary};
