//! A `solver`: `event_driven`, or `{fixed_step: {time_step: 0.1 ms}}`.

use super::diagnostic::Findings;
use super::quantity::Dimension;
use super::reader::{Choice, above_zero};
use super::yaml::Node;
use crate::measure::SolverChoice;

pub(super) fn read_solver(node: &Node, findings: &Findings) -> Option<SolverChoice> {
    let choice = Choice::read(node, "a solver", &["event_driven", "fixed_step"], findings)?;
    if choice.name == "event_driven" {
        choice.bare(findings)?;
        return Some(SolverChoice::EventDriven);
    }
    let fields = choice.fields("a fixed step", findings)?;
    let time_step = fields.required("time_step", |node| above_zero(node, Dimension::Time, findings));
    fields.close()?;
    Some(SolverChoice::FixedStep { time_step: time_step? })
}
