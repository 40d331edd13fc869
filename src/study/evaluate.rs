//! The one thing that a study needs of the engine, so that a runner can be tried without one.

use std::panic::{AssertUnwindSafe, catch_unwind};

use crate::experiment::{Assumptions, GapWord, Recipe};
use crate::measure::{self, Evaluated, Measure, Needs, Prepared, Request, Rigour};
use crate::measure::{EnergySpec, Settings, ShapeSpec, SolverChoice, TraceSpec};

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
    pub settings: &'a Settings,
    /// What to measure.
    pub measures: &'a [Measure],
    /// Time history to keep.
    pub trace: Option<&'a TraceSpec>,
    /// Kinetic energies to keep.
    pub energies: Option<&'a EnergySpec>,
    /// Shape to keep.
    pub shape: Option<&'a ShapeSpec>,
    /// Whether it is a result, or a look on the way to one.
    pub rigour: Rigour,
}

/// What turns a simulation into numbers: the engine, or a stand-in for it.
pub trait Evaluate: Sync {
    /// The numbers, or why there are none. The same simulation gives the same bits, whoever asks and when.
    ///
    /// # Errors
    /// The reason, in words for the table's `failure` column.
    fn evaluate(&self, simulation: &Simulation<'_>) -> Result<Evaluated, String>;

    /// Gets ready the array of a simulation, whose gaps, told in `word`, alone will change.
    ///
    /// # Errors
    /// The reason, in words.
    fn array<'a>(&'a self, simulation: Simulation<'a>, word: GapWord) -> Result<Box<dyn Array + 'a>, String>
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
    /// The reason, in words.
    fn evaluate(&self, gaps: &[f64], rigour: Rigour) -> Result<Evaluated, String>;
}

/// An array that is built anew for all gaps.
struct Unprepared<'a, E> {
    evaluate: &'a E,
    simulation: Simulation<'a>,
    word: GapWord,
}

impl<E: Evaluate> Array for Unprepared<'_, E> {
    fn evaluate(&self, gaps: &[f64], rigour: Rigour) -> Result<Evaluated, String> {
        let mut recipe = self.simulation.recipe.clone();
        recipe.set_gaps(self.word, gaps).map_err(|error| error.to_string())?;
        self.evaluate.evaluate(&Simulation { recipe: &recipe, rigour, ..self.simulation })
    }
}

impl Array for Prepared<'_> {
    fn evaluate(&self, gaps: &[f64], rigour: Rigour) -> Result<Evaluated, String> {
        Prepared::evaluate(self, gaps, rigour).map_err(|error| error.to_string())
    }
}

/// The engine, [`measure::evaluate`].
#[derive(Debug, Clone, Copy, Default)]
pub struct Engine;

impl Evaluate for Engine {
    fn evaluate(&self, it: &Simulation<'_>) -> Result<Evaluated, String> {
        let Simulation { measures, trace, energies, shape, rigour, .. } = *it;
        let request = Request { measures, trace, energies, shape, rigour };
        let subject = it.recipe.subject(it.assumptions, request.needs()).map_err(|error| error.to_string())?;
        measure::evaluate(subject, it.solver, it.settings, &request).map_err(|error| error.to_string())
    }

    fn array<'a>(&'a self, it: Simulation<'a>, word: GapWord) -> Result<Box<dyn Array + 'a>, String> {
        let needs = Needs::of(it.measures, false);
        let of = |recipe: &Recipe| recipe.subject(it.assumptions, needs).map_err(|error| error.to_string());
        let mut recipe = it.recipe.clone();
        let dampers = of(&recipe)?.scene.dampers.len();
        recipe.set_gaps(word, &vec![1.0; dampers]).map_err(|error| error.to_string())?;
        let ready = Prepared::new(of(&recipe)?, it.solver, it.settings, it.measures);
        Ok(Box::new(ready.map_err(|error| error.to_string())?))
    }
}

/// As [`Evaluate::evaluate`]; a panic is a failure of this simulation and of no other.
pub(super) fn evaluate_guarded(evaluate: &impl Evaluate, simulation: &Simulation<'_>) -> Result<Evaluated, String> {
    guarded(|| evaluate.evaluate(simulation))
}

/// A panic is an error of this evaluation and of no other.
pub(super) fn guarded<T>(evaluate: impl FnOnce() -> Result<T, String>) -> Result<T, String> {
    // What is evaluated is only read, and what a panic may have left half done dies with it.
    catch_unwind(AssertUnwindSafe(evaluate)).unwrap_or_else(|panic| {
        let message = panic
            .downcast_ref::<&str>()
            .copied()
            .or_else(|| panic.downcast_ref::<String>().map(String::as_str))
            .unwrap_or("without a message");
        Err(format!("the program made a mistake here (panic: {message})"))
    })
}
