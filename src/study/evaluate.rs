//! The interface between study and engine; tests run a study with a stand-in for the engine.

use std::panic::{AssertUnwindSafe, catch_unwind};

use super::row_failure::RowFailure;
use crate::experiment::{Assumptions, Experiment, GapWord, Recipe};
use crate::measure::{self, Evaluated, Measure, Needs, Prepared, Request, Rigour, Settings, SolverChoice};
use crate::optimise::Slope;

/// One simulation to be made.
#[derive(Debug, Clone, Copy)]
pub struct Simulation<'a> {
    /// The scene, sweep point applied.
    pub recipe: &'a Recipe,
    /// The assumptions in force.
    pub assumptions: &'a Assumptions,
    /// Under which solver.
    pub solver: SolverChoice,
    /// How long.
    pub settings: Settings,
    /// What is asked of it.
    pub request: Request<'a>,
}

impl<'a> Simulation<'a> {
    /// A step of a search: by the experiment's first solver, and without lists.
    #[must_use]
    pub fn step(
        experiment: &'a Experiment,
        recipe: &'a Recipe,
        assumptions: &'a Assumptions,
        measures: &'a [Measure],
    ) -> Self {
        Self {
            recipe,
            assumptions,
            solver: experiment.solvers.first().copied().unwrap_or(SolverChoice::EventDriven),
            settings: experiment.settings_under(assumptions),
            request: Request { measures, rigour: Rigour::Step, ..Request::default() },
        }
    }
}

/// What turns a simulation into numbers: the engine, or a stand-in for it.
pub trait Evaluate: Sync {
    /// The numbers, or why there are none. The same simulation gives the same bits, on any thread and at any time.
    ///
    /// # Errors
    /// The reason.
    fn evaluate(&self, simulation: &Simulation<'_>) -> Result<Evaluated, RowFailure>;

    /// Prepares the array of a simulation of which only the gaps, given in `word`, will change.
    ///
    /// # Errors
    /// The reason.
    fn array<'a>(&'a self, simulation: Simulation<'a>, word: GapWord) -> Result<Box<dyn Array + 'a>, RowFailure>
    where
        Self: Sized,
    {
        Ok(Box::new(Unprepared { evaluate: self, simulation, word }))
    }
}

/// An array of dampers with gaps to choose.
pub trait Array: Send + Sync {
    /// As [`Evaluate::evaluate`], with these gaps, one a damper.
    ///
    /// # Errors
    /// The reason.
    fn evaluate(&self, gaps: &[f64], rigour: Rigour) -> Result<Evaluated, RowFailure>;

    /// A measure of the motion that these gaps settle to, and its derivative by each of them. `None` where it does not settle, or has
    /// no derivative.
    ///
    /// # Errors
    /// The reason.
    fn slope(&self, gaps: &[f64], measure: Measure) -> Result<Option<Slope>, RowFailure>;
}

/// An array that is rebuilt for each set of gaps.
struct Unprepared<'a, E> {
    evaluate: &'a E,
    simulation: Simulation<'a>,
    word: GapWord,
}

impl<E: Evaluate> Array for Unprepared<'_, E> {
    fn evaluate(&self, gaps: &[f64], rigour: Rigour) -> Result<Evaluated, RowFailure> {
        let mut recipe = self.simulation.recipe.clone();
        recipe.set_gaps(self.word, gaps)?;
        let request = Request { rigour, ..self.simulation.request };
        self.evaluate.evaluate(&Simulation { recipe: &recipe, request, ..self.simulation })
    }

    /// A stand-in for the engine knows no derivatives.
    fn slope(&self, _: &[f64], _: Measure) -> Result<Option<Slope>, RowFailure> {
        Ok(None)
    }
}

impl Array for Prepared<'_> {
    fn evaluate(&self, gaps: &[f64], rigour: Rigour) -> Result<Evaluated, RowFailure> {
        Ok(Prepared::evaluate(self, gaps, rigour)?)
    }

    fn slope(&self, gaps: &[f64], measure: Measure) -> Result<Option<Slope>, RowFailure> {
        Ok(Prepared::slope(self, gaps, measure)?)
    }
}

/// The engine, [`measure::evaluate`].
#[derive(Debug, Clone, Copy, Default)]
pub struct Engine;

impl Evaluate for Engine {
    fn evaluate(&self, it: &Simulation<'_>) -> Result<Evaluated, RowFailure> {
        let subject = it.recipe.subject(it.assumptions, it.request.needs())?;
        Ok(measure::evaluate(subject, it.solver, &it.settings, &it.request)?)
    }

    fn array<'a>(&'a self, it: Simulation<'a>, word: GapWord) -> Result<Box<dyn Array + 'a>, RowFailure> {
        let needs = Needs::of(it.request.measures, false);
        let mut recipe = it.recipe.clone();
        let dampers = recipe.subject(it.assumptions, needs)?.scene.dampers.len();
        recipe.set_gaps(word, &vec![1.0; dampers])?;
        let subject = recipe.subject(it.assumptions, needs)?;
        Ok(Box::new(Prepared::new(subject, it.solver, it.settings, it.request.measures)?))
    }
}

/// As [`Evaluate::evaluate`]; a panic is a failure of this simulation and of no other.
pub(super) fn evaluate_guarded(evaluate: &impl Evaluate, simulation: &Simulation<'_>) -> Result<Evaluated, RowFailure> {
    guarded(|| evaluate.evaluate(simulation))
}

/// A panic is an error of this evaluation and of no other.
pub(super) fn guarded<T>(evaluate: impl FnOnce() -> Result<T, RowFailure>) -> Result<T, RowFailure> {
    // What is evaluated is only read, and what a panic may have left half done dies with it.
    catch_unwind(AssertUnwindSafe(evaluate)).unwrap_or_else(|panic| {
        let message = panic
            .downcast_ref::<&str>()
            .copied()
            .or_else(|| panic.downcast_ref::<String>().map(String::as_str))
            .unwrap_or("without a message");
        Err(RowFailure::Panic(message.to_owned()))
    })
}
