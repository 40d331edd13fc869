//! Measures: the numbers that studies plot, computed from [`crate::dynamics`] responses.
//!
//! The velocity ratio ψ is the RMS velocity of the base without damper over the one with it; the displacement ratio η the
//! same with the standard deviation of the displacement. Both are averaged over the forcing cycles
//! after the skipped ones.

use std::borrow::Cow;

mod case;
mod certainty;
mod contact;
mod each_cycle;
mod elasticity;
mod ending;
mod energy;
mod evaluate;
mod history;
mod impact;
mod kept;
mod later;
mod measures;
mod neighbour;
mod orbit;
mod reading;
mod references;
mod request;
mod shape;
mod slope;
mod subject;
mod trial;
mod undefined;

pub use ending::{Ending, FromStarts};
pub use evaluate::{Prepared, evaluate, rounded};
pub use kept::{
    PROOF, ProofColumn, ProofOf, column_of_damper, energy_columns, of_another_damper, shape_columns, trace_columns,
    unit_of_list,
};
pub use measures::{Facts, Measure, ReadOff, Runs, Under, column_words};
pub use orbit::measured_orbit;
pub use request::{
    CycleSpec, CycleValue, EnergySpec, Link, NamedRows, Request, Settings, ShapeOf, ShapeSpec, SolverChoice, Tolerance,
    TraceSpec,
};
pub use subject::{Comparison, Needs, Subject};
pub use trial::Trial;
pub use undefined::Particles;

use serde::Serialize;

use crate::dynamics::{EngineError, MotionKind, OrbitError, Proof, StartState};
use crate::scene::CompileError;
use crate::text::words;

/// How large the ensemble of a chaotic case has to be.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct EnsembleSize {
    /// Where it may be enough; there are as many members kicked one way as the other.
    pub early: [EarlyEnd; 2],
    /// Members at most.
    pub most: u32,
    /// Half the interval in which each mean lies with a probability of 95 %, relative to the mean, at which it is enough; √n times that
    /// in each of n cases that a number is the mean over: it is known as well where they are about equal.
    pub half_width: f64,
}

/// A size at which an ensemble may end.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct EarlyEnd {
    /// Members so far.
    pub members: u32,
    /// Student's t of one less, for 95 %.
    pub student: f64,
}

/// Of a [`Rigour::Variant`], which only tells how far an input moves a number that is compared to within a few percent: a mean known to one
/// percent is enough.
pub const ENSEMBLE_OF_A_VARIANT: EnsembleSize = EnsembleSize {
    early: [EarlyEnd { members: 4, student: 3.182 }, EarlyEnd { members: 6, student: 2.571 }],
    most: 8,
    half_width: 0.01,
};

/// How much a number has to be worth.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Rigour {
    /// A result: audited, at a second accuracy, the whole ensemble where the motion is chaotic.
    #[default]
    Result,
    /// Under another value of an unstated input, or a place of a landscape: neither audited nor repeated, an ensemble as large as its means
    /// need.
    Variant,
    /// A look at one of several, to choose among them: neither audited nor repeated, ensembles of eight.
    Look,
    /// One step of a search: a single run, and nobody asks whether a neighbouring start would end elsewhere.
    Step,
}

/// A measured number with its own errors.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Measured {
    /// The value; the ensemble mean where the motion is chaotic.
    pub value: f64,
    /// Numerical uncertainty: from a second accuracy of the same run, or the standard error of the ensemble's mean; NaN where it is unknown.
    pub numerical: f64,
    /// Standard deviation over the ensemble of perturbed starts; 0 where the motion is not chaotic, NaN where it is unknown.
    pub spread: f64,
}

/// One case under one solver, evaluated.
#[derive(Debug, Clone, PartialEq)]
pub struct Evaluated {
    /// In the order of the measures asked for.
    pub measured: Vec<Measured>,
    /// What proves the run.
    pub proof: Proof,
    /// True where a kicked twin of the run ended elsewhere; false also where that is `unknown`.
    pub chaotic: bool,
    /// What runs beside this one were to say of it and did not, and why; `None` if they all did.
    pub unknown: Option<String>,
    /// Runs averaged; 0 of a row that needs none.
    pub members: u32,
    /// The kind of motion, if asked for.
    pub motion: Option<MotionKind>,
    /// Time history, if asked for: column name, unit, samples.
    pub trace: Vec<TraceColumn>,
    /// Where the run ended, if another may start there.
    pub end: Option<StartState>,
}

/// One column of a time history.
#[derive(Debug, Clone, PartialEq)]
pub struct TraceColumn {
    /// Name as documented at [`TraceSpec`].
    pub name: Cow<'static, str>,
    /// Unit symbol.
    pub unit: Cow<'static, str>,
    /// Samples.
    pub samples: Vec<f64>,
}

impl TraceColumn {
    /// A column of this name and unit.
    #[must_use]
    pub fn new(name: impl Into<Cow<'static, str>>, unit: impl Into<Cow<'static, str>>, samples: Vec<f64>) -> Self {
        Self { name: name.into(), unit: unit.into(), samples }
    }
}

/// Why a case has no numbers.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum EvaluateError {
    /// The scene has no model.
    #[error(transparent)]
    Compile(#[from] CompileError),
    /// The engine gave up, with the reason.
    #[error(transparent)]
    Engine(#[from] EngineError),
    /// The state that it was to start from is one of another scene.
    #[error(
        "it cannot start where the row before it ended: the structure has other coordinates, or a face that a particle touches is gone"
    )]
    NotCarried,
    /// There is no orbit.
    #[error(transparent)]
    Orbit(#[from] OrbitError),
    /// A measure of the time history, and none was asked for.
    #[error("{0:?} is read off a time history: give the experiment a trace")]
    NeedsTrace(Measure),
    /// A measure of a shape, and none is kept.
    #[error("{0:?} is read off a shape: give the experiment a shape")]
    NeedsShape(Measure),
    /// A measure of a run that was not made: a mistake of this program.
    #[error("{0:?} needs a run that was not made")]
    NoRun(Measure),
    /// A number that floating point cannot hold, or that came of such numbers.
    #[error("`{name}` leaves the range of numbers: {value}", name = words::of_key(measure))]
    OutOfRange {
        /// Which measure.
        measure: Measure,
        /// What came out.
        value: f64,
    },
    /// A measure of another excitation.
    #[error("{measure:?} is measured under {excitation}")]
    NotUnder {
        /// Which measure.
        measure: Measure,
        /// Under what it has a meaning.
        excitation: &'static str,
    },
}
