//! The runs without dampers that a case is compared with.
//!
//! They know nothing of dampers, so that all points of a sweep that differ in these alone, and the same points under other assumptions,
//! are compared with one of them: what one point has run is at hand for the others. The same numbers come out whether it was or not.

use std::collections::VecDeque;
use std::sync::{Arc, Mutex, PoisonError};

use super::Request;
use super::later::settled_later;
use super::{EvaluateError, Measure, Settings, SolverChoice, Subject};
use crate::dynamics::{Options, Response, Until, aside};
use crate::scene::{Scene, compile};

/// Scenes whose runs are kept: those of a sweep over frequencies, or so.
const MOST_SCENES: usize = 1024;

/// The last of them behind.
static KNOWN: Mutex<VecDeque<(Question, Arc<References>)>> = Mutex::new(VecDeque::new());

/// The run without dampers, where something is compared with it, by how it ends.
#[derive(Debug)]
pub(super) struct References {
    /// After the cycles given.
    pub(super) of_cycles: Option<Response>,
    /// Where runs are to settle, and it has.
    pub(super) settled: Option<Response>,
    /// Where it is asked what longer runs settle to, and it has.
    pub(super) settled_later: Option<Response>,
    /// Runs are to settle, and there is none without dampers that has not.
    pub(super) may_settle: bool,
}

/// What the runs hang on.
#[derive(Debug, PartialEq)]
struct Question {
    bare: Scene,
    plain: Options,
    solver: SolverChoice,
    settled: bool,
    settled_later: bool,
}

impl References {
    pub(super) fn of(
        subject: &Subject,
        request: &Request<'_>,
        settings: &Settings,
        solver: SolverChoice,
    ) -> Result<Arc<Self>, EvaluateError> {
        let settled = settings.until == Until::Settled;
        let Some(bare) = subject.undamped.as_ref().filter(|_| request.needs().undamped) else {
            let none = Self { of_cycles: None, settled: None, settled_later: None, may_settle: settled };
            return Ok(Arc::new(none));
        };
        let of_settled = [Measure::SettledVelocityRatio, Measure::VelocityRatioInput];
        let question = Question {
            bare: bare.clone(),
            plain: request.options(bare, settings),
            solver,
            settled,
            settled_later: request.any(|measure| of_settled.contains(&measure)),
        };
        let kept = || KNOWN.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some((_, known)) = kept().iter().rev().find(|(known, _)| *known == question) {
            return Ok(Arc::clone(known));
        }
        let references = Arc::new(aside(|| question.answer())?);
        let mut kept = kept();
        if kept.len() == MOST_SCENES {
            kept.pop_front();
        }
        kept.push_back((question, Arc::clone(&references)));
        Ok(references)
    }
}

impl Question {
    fn answer(&self) -> Result<References, EvaluateError> {
        let (system, plain) = (compile(&self.bare)?, &self.plain);
        let of_cycles = Some(self.solver.solve(&system, plain)?);
        let settles = || self.solver.solve(&system, &Options { until: Until::Settled, ..plain.clone() });
        let settled = if self.settled { Some(settles()?).filter(|run| run.settled.is_some()) } else { None };
        let settled_later = if self.settled_later { settled_later(&system, plain)? } else { None };
        Ok(References { of_cycles, may_settle: settled.is_some(), settled, settled_later })
    }
}
