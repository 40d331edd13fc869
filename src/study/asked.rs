//! What the engine is asked for a row: which histories and shapes, and with how much rigour.

use super::evaluate::Simulation;
use super::job::Job;
use super::variant::Variant;
use crate::experiment::{Experiment, Recipe, SearchPoint};
use crate::measure::{Link, Request, Rigour};

/// What the engine is asked for a row.
pub(super) fn asked<'a>(
    experiment: &'a Experiment,
    recipe: &'a Recipe,
    variant: &'a Variant,
    job: &Job,
) -> Simulation<'a> {
    Simulation {
        recipe,
        assumptions: &variant.assumptions,
        solver: job.solver,
        settings: experiment.settings_under(&variant.assumptions),
        request: Request {
            measures: &experiment.measures,
            // An instant that an entry reads off a time history has to be moved with the inputs.
            trace: experiment.trace.as_ref(),
            // Other lists are the baseline's alone; a measure of a shape needs it everywhere.
            energies: experiment.energies.as_ref().filter(|_| job.variant == 0),
            shape: experiment.shape.as_ref().filter(|_| job.variant == 0 || needs_shape(experiment)),
            each_cycle: experiment.each_cycle.as_ref().filter(|_| job.variant == 0),
            tolerances: &experiment.tolerances,
            link: Link::None,
            rigour: if job.variant == 0 { Rigour::Result } else { rigours_of_others(experiment)[0] },
        },
    }
}

/// Rigour of the runs that are no results: the first is asked of every one, the second of those that come near a maximum. Where a point is
/// looked for, a moved assumption changes neither.
pub(super) fn rigours_of_others(experiment: &Experiment) -> &'static [Rigour] {
    match experiment.maximise.as_ref().map(|maximise| maximise.wanted) {
        None => &[Rigour::Variant],
        Some(SearchPoint::Onset) => &[Rigour::Look],
        Some(SearchPoint::Maximum) => &[Rigour::Step, Rigour::Look],
    }
}

/// Some measure is read off a shape.
pub(super) fn needs_shape(experiment: &Experiment) -> bool {
    experiment.measures.iter().any(|measure| measure.needs_shape())
}
