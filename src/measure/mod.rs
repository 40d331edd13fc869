//! Measures: the numbers that the study plots, computed from [`crate::dynamics`] responses.
//!
//! The velocity ratio ψ is the RMS velocity of the base without damper over the one with it; the displacement ratio η the
//! same with the standard deviation of the displacement (s. 3.5 of the study). Both are averaged over the forcing cycles
//! after the skipped ones.

use std::borrow::Cow;

use serde::{Deserialize, Serialize};

mod energy;
mod evaluate;
mod history;
mod impact;
mod reading;
mod request;
mod shape;
mod trial;

pub use evaluate::{Prepared, Request, evaluate};
pub use request::{EnergySpec, Settings, ShapeOf, ShapeSpec, SolverChoice, TraceSpec};
pub use trial::Trial;

use crate::dynamics::{EngineError, Proof};
use crate::scene::{CompileError, RecipeError};

/// What can be measured. The same word in YAML (`velocity_ratio`) and as a table column.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Measure {
    /// ψ.
    VelocityRatio,
    /// η.
    DisplacementRatio,
    /// RMS velocity of the base, m/s.
    RmsVelocity,
    /// Standard deviation of the base displacement, m.
    StdDisplacement,
    /// Mean base displacement, m.
    MeanDisplacement,
    /// RMS velocity of the base without damper, m/s.
    UndampedRmsVelocity,
    /// Contacts made with the floor, in the averaged window.
    FloorImpacts,
    /// Contacts made with the ceiling.
    CeilingImpacts,
    /// Impacts on a limit stop.
    StopImpacts,
    /// Contacts lost with the floor.
    Separations,
    /// Largest compression of the floor in the window, m.
    FloorCompression,
    /// Largest compression of the ceiling, m.
    CeilingCompression,
    /// Largest base displacement of the last cycle of the trace, m (needs a trace).
    LastPeak,
    /// (largest − smallest)/mean of the trace's positive peaks (needs a trace).
    PeakVariation,
    /// Largest relative departure of the trace's peaks from the first one times exp(−c′ ωn t) (needs a trace).
    PeakDecayError,
    /// |RMS of the first half of the window / RMS of the second half − 1|: zero once transients are gone.
    Drift,
    /// Shortest time between an impulse in the trace and a floor contact, s (needs a trace).
    FloorImpactLag,
    /// The same to a ceiling contact, s (needs a trace).
    CeilingImpactLag,
    /// Highest natural frequency of the scene's contact states, Hz.
    HighestFrequency,
    /// Its period, s.
    ShortestPeriod,
    /// Half the peak-to-peak of the observed displacement in the window, from the extrema of the exact motion, m.
    DisplacementAmplitude,
    /// The same of the velocity, m/s.
    VelocityAmplitude,
    /// Displacement amplitude over the amplitude of the harmonic force, m/N.
    DisplacementPerForce,
    /// Velocity amplitude over the amplitude of the harmonic force, m/(N s).
    VelocityPerForce,
    /// Displacement amplitude over the impulse, m/(N s).
    DisplacementPerImpulse,
    /// Velocity amplitude over the impulse, 1/kg.
    VelocityPerImpulse,
    /// Displacement amplitude without dampers over the one with them.
    DisplacementAmplitudeRatio,
    /// The same of the velocity.
    VelocityAmplitudeRatio,
    /// Displacement amplitude without dampers, m.
    UndampedDisplacementAmplitude,
    /// The same of the velocity, m/s.
    UndampedVelocityAmplitude,
    /// Natural frequency of the scene's `mode`, dampers on board and particles at rest on their floors, rad/s.
    NaturalFrequency,
    /// The same of the model without dampers, rad/s.
    CleanNaturalFrequency,
    /// The same of the continuous structure, rad/s.
    ExactNaturalFrequency,
    /// Modes of the model: what a velocity just after an impulse depends on.
    ModeCount,
    /// Modal assurance criterion of the shape that is kept: a mode's against the exact one, a deflection's against the
    /// forced mode's.
    Mac,
    /// Share of the structure's kinetic energy that is lost from just after an impulse to just before the next; mean over the
    /// averaged cycles.
    DampingMeasure,
    /// Kinetic energy at the impulses, compared with that of the clean structure; mean over the averaged cycles.
    MassMeasure,
    /// First contact of the first particle with its floor in the window, s from the start of the run.
    FloorImpactTime,
    /// Time between the last two floor contacts, s.
    FloorImpactInterval,
    /// By how much that time differs from the one before, s.
    FloorIntervalChange,
    /// Relative speed just before the last floor contact, m/s.
    FloorImpactSpeed,
    /// ω t of the last floor contact, counted from the start of its forcing cycle, rad.
    FloorImpactPhase,
    /// Relative speed at the end of the last floor contact that has ended, m/s.
    FloorReboundSpeed,
    /// Relative speed at its end over the one at its begin.
    FloorRestitution,
    /// Its duration, s.
    FloorContactTime,
    /// First release from the floor in the window, s from the start of the run.
    FloorReleaseTime,
    /// End of the first complete chatter in the window, s from the start of the run.
    ChatterEndTime,
    /// Observed displacement at the end of the run, m.
    FinalDisplacement,
    /// Observed velocity at the end of the run, m/s.
    FinalVelocity,
    /// Height of the first particle over the base at the end of the run, m.
    FinalHeight,
}

impl Measure {
    /// Unit symbol, empty when dimensionless.
    #[must_use]
    pub fn unit(self) -> &'static str {
        match self {
            Self::RmsVelocity
            | Self::UndampedRmsVelocity
            | Self::VelocityAmplitude
            | Self::UndampedVelocityAmplitude
            | Self::FloorImpactSpeed
            | Self::FloorReboundSpeed
            | Self::FinalVelocity => "m/s",
            Self::FloorImpactPhase => "rad",
            Self::DisplacementPerForce => "m/N",
            Self::VelocityPerForce | Self::DisplacementPerImpulse => "m/(N s)",
            Self::VelocityPerImpulse => "1/kg",
            Self::NaturalFrequency | Self::CleanNaturalFrequency | Self::ExactNaturalFrequency => "rad/s",
            Self::StdDisplacement
            | Self::MeanDisplacement
            | Self::FloorCompression
            | Self::CeilingCompression
            | Self::LastPeak
            | Self::DisplacementAmplitude
            | Self::UndampedDisplacementAmplitude
            | Self::FinalDisplacement
            | Self::FinalHeight => "m",
            Self::FloorImpactLag
            | Self::CeilingImpactLag
            | Self::ShortestPeriod
            | Self::FloorImpactTime
            | Self::FloorImpactInterval
            | Self::FloorIntervalChange
            | Self::FloorContactTime
            | Self::FloorReleaseTime
            | Self::ChatterEndTime => "s",
            Self::HighestFrequency => "Hz",
            _ => "",
        }
    }

    /// Symbol of the field, empty if it has none.
    #[must_use]
    pub fn symbol(self) -> &'static str {
        match self {
            Self::VelocityRatio => "ψ",
            Self::DisplacementRatio => "η",
            Self::NaturalFrequency | Self::CleanNaturalFrequency | Self::ExactNaturalFrequency => "ωₙ",
            _ => "",
        }
    }
}

/// How much a number has to be worth.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Rigour {
    /// A result: audited, at a second accuracy, the whole ensemble where the motion is chaotic.
    #[default]
    Result,
    /// A look, to find a maximum or a sensitivity: neither audited nor repeated, ensembles of eight.
    Look,
    /// One step of a search: a single run, and nobody asks whether a neighbouring start would end elsewhere.
    Step,
}

/// A measured number with its own errors.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Measured {
    /// The value; the ensemble mean where the motion is chaotic.
    pub value: f64,
    /// Numerical uncertainty: from a second accuracy of the same run, or the standard error of the ensemble's mean.
    pub numerical: f64,
    /// Standard deviation over the ensemble of perturbed starts; 0 where the motion is not chaotic.
    pub spread: f64,
}

/// One case under one solver, evaluated.
#[derive(Debug, Clone, PartialEq)]
pub struct Evaluated {
    /// In the order of the measures asked for.
    pub measured: Vec<Measured>,
    /// What proves the run.
    pub proof: Proof,
    /// True where a kicked twin of the run ended elsewhere.
    pub chaotic: bool,
    /// Runs averaged.
    pub members: u32,
    /// Time history, if asked for: column name, unit, samples.
    pub trace: Vec<TraceColumn>,
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
    /// The recipe has no scene.
    #[error(transparent)]
    Recipe(#[from] RecipeError),
    /// The scene has no model.
    #[error(transparent)]
    Compile(#[from] CompileError),
    /// The engine gave up, with the reason.
    #[error(transparent)]
    Engine(#[from] EngineError),
    /// A measure of the time history, and none was asked for.
    #[error("{0:?} is read off a time history: give the experiment a trace")]
    NeedsTrace(Measure),
    /// A measure of a shape, and none is kept.
    #[error("{0:?} is read off a shape: give the experiment a shape")]
    NeedsShape(Measure),
    /// A measure of a run that was not made: a mistake of this program.
    #[error("{0:?} needs a run that was not made")]
    NoRun(Measure),
    /// A measure of another excitation.
    #[error("{measure:?} is measured under {excitation}")]
    NotUnder {
        /// Which measure.
        measure: Measure,
        /// Under what it has a meaning.
        excitation: &'static str,
    },
}
