//! What accuracy costs in time: error against time of both solvers, judged by an independent reference.
//!
//! [`precise`] solves the same model with 32 digits by other means. [`accuracy`] runs some cases of an experiment with the
//! event-driven solver and with fixed steps, and holds both against it; [`publish_accuracy`] writes the page and the diagram.

mod ablation;
mod ablation_page;
mod measured;
mod no_accuracy;
mod over_cases;
mod page;
pub mod precise;
mod publish;
mod representative;
mod scatter;
mod timing;
mod verdict_price;
mod view;

pub use ablation::{Ablation, Idle, Outcome, Switched, ablation, idle_cases, unreached_cases};
pub use ablation_page::{ablation_page, out_of_reach_in_words};
pub use measured::{Accuracy, CaseAccuracy, Contender, Errors, EventTimes, Origin, Point, Skipped, accuracy, errors};
pub use no_accuracy::NoAccuracy;
pub use page::{accuracy_page, accuracy_summary};
pub use publish::{
    Measured, accuracy_view, check_publishable, keep_measured, publish_accuracy, publish_accuracy_summary,
    read_measured,
};
pub use representative::representative;
pub use timing::Times;
pub use verdict_price::VerdictPrice;
pub use view::AccuracyView;
