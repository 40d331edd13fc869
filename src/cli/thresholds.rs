//! Thresholds in words: what is known of a sweep's rows before any of them is simulated.

use std::time::Duration;

use crate::dynamics::{Allowance, Limit};
use crate::experiment::{Experiment, Threshold};
use crate::study::{Study, ThresholdAlong, thresholds};
use crate::text::number::compact;
use crate::text::words::{counted, of_key};

/// How long the proof that particles stay on their floors may take; cases beyond it count as not proved.
pub(super) const PATIENCE: Duration = Duration::from_millis(500);

/// A line for each threshold, indented.
pub(super) fn in_words(study: &Study, experiment: &Experiment) -> String {
    found(study, experiment).iter().map(line).collect()
}

/// Of those with cases below them.
pub(super) fn with_cases_in_words(study: &Study, experiment: &Experiment) -> String {
    found(study, experiment).iter().filter(|found| found.below > 0).map(line).collect()
}

fn found(study: &Study, experiment: &Experiment) -> Vec<ThresholdAlong> {
    let assumptions = study.sheet.assumptions();
    let limit = Limit { time: PATIENCE, ..Limit::default() };
    Allowance::new(limit).simulate(|| thresholds(experiment, &assumptions))
}

fn line(&ThresholdAlong { threshold, over, least, most, below }: &ThresholdAlong) -> String {
    let unit = if over.unit().is_empty() { String::new() } else { format!(" {}", over.unit()) };
    let [least, most] = [least, most].map(|at| compact(at, 4) + &unit);
    let range = if least == most { least } else { format!("{least} to {most}, by case") };
    let (over, cases) = (of_key(&over), counted(below, "case lies", "cases lie"));
    match threshold {
        Threshold::LiftOff => {
            format!("  All particles rest below {over} = {range}, once transients are gone; {cases} there.\n")
        }
        Threshold::TwoImpacts => {
            format!("  No motion has one impact on floor and ceiling a period below {over} = {range}; {cases} there.\n")
        }
        Threshold::CeilingGraze => {
            format!(
                "  A motion with one impact on the floor a period stays below the ceiling up to {over} = {range}; {cases} there.\n"
            )
        }
    }
}
