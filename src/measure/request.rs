//! What is asked of a case: measures, solver, window, and which histories to keep with each row.

use serde::{Deserialize, Serialize};

use super::{Measure, Needs, Rigour};
use crate::dynamics::{
    Averaged, EngineError, HybridSystem, Options, Response, StartState, Until, event_driven, fixed_step,
};
use crate::scene::{Design, Scene};
use crate::text::words::EVENT_DRIVEN;

/// Which solver.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum SolverChoice {
    /// Exact propagation between certified events.
    EventDriven,
    /// Steps of one length, contacts looked for at the end of each.
    FixedStep {
        /// Δt, s.
        time_step: f64,
    },
}

impl SolverChoice {
    /// The word in the table's column `solver`: `event_driven`, `fixed_step_1e-5s`.
    #[must_use]
    pub fn label(&self) -> String {
        match self {
            Self::EventDriven => EVENT_DRIVEN.into(),
            Self::FixedStep { time_step } => format!("fixed_step_{time_step:e}s"),
        }
    }

    /// Runs a system by it.
    pub(super) fn solve(self, system: &HybridSystem, options: &Options) -> Result<Response, EngineError> {
        match self {
            Self::EventDriven => event_driven(system, options),
            Self::FixedStep { time_step } => fixed_step(system, options, time_step),
        }
    }
}

/// Whether a run is one of a chain: each starts where the one before it ended, with its companions beside it; the run without dampers
/// starts as the scene says.
#[derive(Debug, Clone, Copy, Default)]
pub enum Link<'a> {
    /// It is not: it starts as the scene says, and nobody asks where it ends.
    #[default]
    None,
    /// The first of a chain: it starts as the scene says.
    First,
    /// It starts where another ended.
    After(&'a StartState),
}

/// What is asked of a case.
#[derive(Debug, Clone, Copy, Default)]
pub struct Request<'a> {
    /// What to measure.
    pub measures: &'a [Measure],
    /// Time history to keep.
    pub trace: Option<&'a TraceSpec>,
    /// Kinetic energies to keep.
    pub energies: Option<&'a EnergySpec>,
    /// Shape to keep.
    pub shape: Option<&'a ShapeSpec>,
    /// Value to keep of each cycle.
    pub each_cycle: Option<&'a CycleSpec>,
    /// How uncertain design parameters are.
    pub tolerances: &'a [Tolerance],
    /// What the numbers have to be worth.
    pub rigour: Rigour,
    /// The place of the run in a chain.
    pub link: Link<'a>,
}

impl Request<'_> {
    pub(super) fn any(&self, test: impl Fn(Measure) -> bool) -> bool {
        self.measures.iter().any(|measure| test(*measure))
    }

    pub(super) fn deflection(&self) -> Option<&ShapeSpec> {
        self.shape.filter(|shape| shape.of == ShapeOf::Deflection)
    }

    /// Something is asked for that only a run can tell.
    pub(super) fn needs_run(&self) -> bool {
        self.any(|measure| !measure.is_modal())
            || self.trace.is_some()
            || self.energies.is_some()
            || self.deflection().is_some()
            || self.each_cycle.is_some()
            || !matches!(self.link, Link::None)
    }

    /// A run of a scene without an audit and without a history.
    pub(super) fn options(&self, scene: &Scene, settings: &Settings) -> Options {
        let of_cycle = |ends: bool| self.each_cycle.is_some_and(|each| each.of.is_of_ends() == ends);
        Options {
            start: scene.start_state(),
            skip: settings.skip,
            average: settings.average,
            displacement: self.any(Measure::needs_displacement) || self.deflection().is_some(),
            extremes: self.any(Measure::needs_extremes),
            record_events: if self.any(Measure::needs_events) || of_cycle(false) { usize::MAX } else { 0 },
            cycle_rates: self.energies.is_some() || self.any(Measure::needs_energies) || of_cycle(true),
            ..Options::default()
        }
    }

    /// What it takes of a subject.
    #[must_use]
    pub fn needs(&self) -> Needs {
        Needs::of(self.measures, self.energies.is_some())
    }
}

/// How a case is run.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Settings {
    /// Forcing cycles left out as transient.
    pub skip: u32,
    /// Forcing cycles averaged over.
    pub average: u32,
    /// When a run ends: after these cycles, or with the first period of a motion that has settled.
    #[serde(default, skip_serializing_if = "is_usual")]
    pub until: Until,
    /// The forcing period is rounded to whole steps of this length in every solver, s: 0.1987 s become 199 steps of 1 ms.
    pub round_period_to: Option<f64>,
    /// Members of the ensemble of perturbed starts that a chaotic point gets; 0 switches ensembles off.
    pub ensemble: u32,
    /// Of which rows the motion is named, where it is measured.
    #[serde(default, skip_serializing_if = "is_usual")]
    pub named: NamedRows,
    /// Cases that a number is the mean over; 0 of one that is measured in a case alone.
    #[serde(skip)]
    pub mean_of: u32,
}

impl Settings {
    /// The cycles averaged over, of a run that is not to settle.
    #[must_use]
    pub fn averaged(&self) -> Averaged {
        Averaged { first: self.skip.into(), cycles: self.average.into() }
    }
}

/// The rows whose motion is named: that takes a third of a run, and the other rows are many.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum NamedRows {
    /// Results: neither rows under a moved assumption nor the points among which a maximum is looked for.
    #[default]
    Results,
    /// All, as numbers that come with the name are asked for by their own words.
    All,
}

fn is_usual<T: Default + PartialEq>(value: &T) -> bool {
    *value == T::default()
}

/// Which part of the motion to keep as a time history. The list columns are then `time` (s), `base_displacement`,
/// `base_velocity`, `base_acceleration`, `particle_displacement`, `floor_displacement` and `ceiling_displacement` (the
/// resilient surfaces where they are), `rigid_floor`, `rigid_ceiling` (where they would be uncompressed),
/// `contact_damping` (N s/m) and `rms_acceleration` (of the last complete half cycle, in g). The lists of particle and faces are
/// those of the first damper; of the others they carry its number, `particle_displacement_2`.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct TraceSpec {
    /// First forcing cycle, counted from 0.
    pub from_cycle: u32,
    /// One past the last.
    pub to_cycle: u32,
    /// Samples a cycle.
    pub samples: u32,
}

/// Which cycles' kinetic energies to keep. The list columns are then `cycle`, `kinetic_energy_after` (J, of the structure alone,
/// just after the impulse that opens the cycle), `kinetic_energy_before` (just before the next one), the same two with
/// `undamped_` in front, `damping_measure_of_cycle` and `mass_measure_of_cycle`.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct EnergySpec {
    /// First forcing cycle, counted from 0.
    pub from_cycle: u32,
    /// One past the last.
    pub to_cycle: u32,
}

/// Relative standard uncertainty of a design parameter: what it leaves of the velocity ratio is `velocity_ratio_input`.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Tolerance {
    /// The parameter.
    pub of: Design,
    /// Its uncertainty over its value.
    pub share: f64,
}

/// Which value to keep of every averaged cycle, or of the last of them: what a bifurcation diagram shows. The list column carries
/// its word.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub struct CycleSpec {
    /// The value.
    pub of: CycleValue,
    /// How many cycles; all that are averaged unless it is stated.
    pub last: Option<u32>,
}

/// A value of a cycle; of contacts, one for each that is made with a floor or a ceiling.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum CycleValue {
    /// Velocity of the structure at the end of the cycle, just before an impulse that opens the next.
    StroboscopicVelocity,
    /// ω t of a contact, from the start of the cycle.
    ImpactPhase,
    /// Relative speed just before a contact.
    ImpactSpeed,
}

/// Which shape to keep. The list columns are then `x` and, with two sides, `y` (shares of the sides; x varies fastest), `shape`
/// (largest modulus 1), and for a mode `exact_shape`, for a deflection `rms_displacement` (m) and `mode_shape`.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct ShapeSpec {
    /// Of what.
    pub of: ShapeOf,
    /// Points along each side.
    pub points: Vec<u32>,
}

/// What a shape is of.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum ShapeOf {
    /// A normal mode.
    Mode,
    /// The motion under the excitation.
    Deflection,
}
