//! One row of a table: taken over from an earlier one, or simulated.

use std::sync::atomic::{AtomicUsize, Ordering};

use super::asked::{asked, needs_shape};
use super::evaluate::{Evaluate, Simulation, evaluate_guarded};
use super::event::{Event, EventHandler};
use super::job::{Job, evaluations, measures_need_trace};
use super::limited::Limited;
use super::maximise::{Along, Sought};
use super::mean::Averaging;
use super::row_failure::RowFailure;
use super::row_fingerprint::RowFingerprints;
use super::tabulate::{self, Outcome, Row};
use super::task::Task;
use super::variant::Variant;
use crate::dynamics::is_interrupted;
use crate::experiment::{Case, Experiment, ParameterValue};
use crate::measure::{Link, Request};
use crate::text::words;

/// One row, of a case that need not be among the experiment's; taken over if it is known.
pub(super) fn outcome(
    task: Task<'_>,
    case: &Case,
    job: &Job,
    evaluate: &impl Evaluate,
    handler: &dyn EventHandler,
) -> Outcome {
    let experiment = task.experiment;
    if let Some(known) = task.known.filter(|known| !known.is_empty()) {
        let fingerprint = RowFingerprints::new(experiment).of(&task.variants[job.variant], case, job);
        if let Some(row) = known.row(experiment, fingerprint) {
            handler.on_event(&Event::Simulated { experiment: &experiment.id, count: evaluations(experiment, job) });
            return Ok(row);
        }
    }
    computed(task, case, job, Link::None, evaluate, handler)
}

/// One row, of a case that need not be among the experiment's, at its place in a chain.
pub(super) fn computed(
    task: Task<'_>,
    case: &Case,
    job: &Job,
    link: Link<'_>,
    evaluate: &impl Evaluate,
    handler: &dyn EventHandler,
) -> Outcome {
    let experiment = task.experiment;
    if is_interrupted() {
        return Err(RowFailure::Interrupted);
    }
    let simulated = AtomicUsize::new(0);
    let done = || {
        simulated.fetch_add(1, Ordering::Relaxed);
        handler.on_event(&Event::Simulated { experiment: &experiment.id, count: 1 });
    };
    let limited = Limited::row(evaluate, task.limit);
    let outcome = simulate(experiment, case, &task.variants[job.variant], job, link, &limited, &done);
    let rest = evaluations(experiment, job).saturating_sub(simulated.into_inner() as u64);
    handler.on_event(&Event::Simulated { experiment: &experiment.id, count: rest });
    // Whatever it says it failed by.
    if outcome.is_err() && is_interrupted() { Err(RowFailure::Interrupted) } else { outcome }
}

fn simulate(
    experiment: &Experiment,
    case: &Case,
    variant: &Variant,
    job: &Job,
    link: Link<'_>,
    evaluate: &impl Evaluate,
    done: &(impl Fn() + Sync),
) -> Outcome {
    let evaluate = &Averaging { experiment, evaluate };
    let recipe = experiment.recipe_of(case)?;
    let mut simulation = asked(experiment, &recipe, variant, job);
    simulation.request.link = link;
    let Some(maximise) = &experiment.maximise else {
        let evaluated = evaluate_guarded(evaluate, &simulation);
        done();
        return Ok(Row { evaluated: evaluated?, place: None });
    };
    let measure = tabulate::maximised_index(experiment, maximise.measure)
        .ok_or_else(|| RowFailure::NotMeasured(words::of_key(&maximise.measure)))?;
    // Histories of the points that are not the maximum are not wanted.
    let request = simulation.request;
    let trace = request.trace.filter(|_| measures_need_trace(&experiment.measures));
    let shape = request.shape.filter(|_| needs_shape(experiment));
    let point =
        Simulation { request: Request { trace, energies: None, shape, each_cycle: None, ..request }, ..simulation };
    let Sought { mut evaluated, place, rise } =
        Along { evaluate, simulation: point, maximise, measure, done }.found()?;
    if job.variant == 0 {
        // The row itself is a result: the point once more, with all that proves it.
        let mut there = recipe.clone();
        there.set(maximise.over, ParameterValue::Number(place.at))?;
        evaluated = evaluate_guarded(evaluate, &Simulation { recipe: &there, ..simulation })?;
        done();
    }
    if let Some(measured) = evaluated.measured.get_mut(measure) {
        measured.numerical = libm::hypot(measured.numerical, rise);
    }
    Ok(Row { evaluated, place: Some(place) })
}
