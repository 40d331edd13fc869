//! A `solver`: `event_driven`, or `{fixed_step: {time_step: 0.1 ms}}`.

use crate::measure::SolverChoice;
use crate::text::words::EVENT_DRIVEN;
use crate::yaml::{At, Dimension};

pub(super) fn read_solver(at: At<'_>) -> Option<SolverChoice> {
    let names = [(EVENT_DRIVEN, ""), ("fixed_step", "Steps of one length, contacts looked for at the end of each")];
    let about = "A solver: event_driven, or fixed_step with its time step";
    at.named("solver", about, |at| {
        at.choose("a solver", &names, |choice| {
            if choice.name() == EVENT_DRIVEN {
                choice.bare()?;
                return Some(SolverChoice::EventDriven);
            }
            let keys = choice.keys("a fixed step")?;
            let time_step = keys.required("time_step", "Time step", |at| at.above_zero(Dimension::Time));
            keys.close()?;
            Some(SolverChoice::FixedStep { time_step: time_step? })
        })
    })
}
