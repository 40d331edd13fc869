//! The one thing that a study needs of the engine, so that a runner can be tried without one.

use std::panic::{AssertUnwindSafe, catch_unwind};

use crate::measure::{self, Evaluated, Measure, Request, Rigour};
use crate::scene::{Assumptions, Recipe};
use crate::spec::{EnergySpec, Settings, ShapeSpec, SolverChoice, TraceSpec};

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
}

/// The engine, [`measure::evaluate`].
#[derive(Debug, Clone, Copy, Default)]
pub struct Engine;

impl Evaluate for Engine {
    fn evaluate(&self, it: &Simulation<'_>) -> Result<Evaluated, String> {
        let Simulation { measures, trace, energies, shape, rigour, .. } = *it;
        let request = Request { measures, trace, energies, shape, rigour };
        measure::evaluate(it.recipe, it.assumptions, it.solver, it.settings, &request)
            .map_err(|error| error.to_string())
    }
}

/// As [`Evaluate::evaluate`]; a panic is a failure of this simulation and of no other.
pub(super) fn evaluate_guarded(evaluate: &impl Evaluate, simulation: &Simulation<'_>) -> Result<Evaluated, String> {
    // The simulation is only read, and what a panic may have left half done dies with it.
    catch_unwind(AssertUnwindSafe(|| evaluate.evaluate(simulation))).unwrap_or_else(|panic| {
        let message = panic
            .downcast_ref::<&str>()
            .copied()
            .or_else(|| panic.downcast_ref::<String>().map(String::as_str))
            .unwrap_or("without a message");
        Err(format!("the program made a mistake here (panic: {message})"))
    })
}
