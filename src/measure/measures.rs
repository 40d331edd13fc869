//! The measures: one row a measure below is all that the program knows of it besides its formula.
//!
//! From the rows come the words in YAML and in tables, the JSON Schema, `docs/tables.md`, what an experiment must keep, and
//! what a run has to record. [`super::reading`] holds the formulas.

use serde::{Deserialize, Serialize};

use crate::scene::{Design, Excitation};
use crate::text::words;

/// What is known of a measure.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Facts {
    /// Unit symbol, empty when dimensionless.
    pub unit: &'static str,
    /// Symbol of the field, empty if it has none.
    pub symbol: &'static str,
    /// Its name for people, without unit and symbol; empty where the word in YAML with spaces serves.
    pub words: &'static str,
    /// What it is, in one line.
    pub about: &'static str,
    /// What it is read off.
    pub from: ReadOff,
    /// Which runs it takes.
    pub runs: Runs,
    /// Under what excitation it has a meaning.
    pub under: Under,
}

/// What a measure is read off.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ReadOff {
    /// Velocities averaged over the window.
    Velocity,
    /// Displacements averaged over the window.
    Displacement,
    /// Largest and smallest values in the window.
    Extremes,
    /// Kinetic energies at the impulses.
    Energies,
    /// Numbers of events, or properties of the run itself: they tend to no limit as a run gets more exact.
    Run,
    /// Single events in the window.
    Events,
    /// The state at the end of the run.
    End,
    /// The time history that is kept.
    Trace,
    /// The model: no run is needed.
    Model,
    /// The shape that is kept.
    Shape,
    /// The kind of motion that the run ends in.
    Motion,
    /// How the run ended.
    Ending,
    /// Longer runs, which end where they have settled.
    Settled,
    /// Periodic motions beside the one that a longer run settles to.
    Neighbours,
}

/// Which runs a measure takes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Runs {
    /// The scene as it is.
    Own,
    /// The scene without dampers as well.
    Both,
}

/// Under what excitation a measure has a meaning.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Under {
    /// Any, or none.
    Any,
    /// A harmonic force.
    Harmonic,
    /// Impulses or pulses.
    Impulses,
}

macro_rules! measures {
    ($($Name:ident: $unit:literal, $symbol:literal, $words:literal, $about:literal, $From:ident, $Runs:ident, $Under:ident;)*) => {
        /// What can be measured. The same word in YAML (`velocity_ratio`) and as a table column.
        #[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
        #[serde(rename_all = "snake_case")]
        pub enum Measure {
            $(#[doc = $about] $Name,)*
        }

        impl Measure {
            /// All measures.
            pub const ALL: &[Self] = &[$(Self::$Name,)*];

            /// What is known of it.
            #[must_use]
            pub const fn facts(self) -> Facts {
                match self {
                    $(Self::$Name => Facts {
                        unit: $unit,
                        symbol: $symbol,
                        words: $words,
                        about: $about,
                        from: ReadOff::$From,
                        runs: Runs::$Runs,
                        under: Under::$Under,
                    },)*
                }
            }
        }
    };
}

measures! {
    VelocityRatio: "", "ψ", "", "RMS velocity without dampers over the one with them", Velocity, Both, Any;
    DisplacementRatio: "", "η", "", "standard deviation of the displacement without dampers over the one with them", Displacement, Both, Any;
    RmsVelocity: "m/s", "", "RMS velocity", "RMS velocity of the structure", Velocity, Own, Any;
    StdDisplacement: "m", "", "standard deviation of the displacement", "standard deviation of the displacement", Displacement, Own, Any;
    MeanDisplacement: "m", "", "", "mean displacement; of several points by the largest, the one that is farthest from zero, with its sign", Displacement, Own, Any;
    UndampedRmsVelocity: "m/s", "", "RMS velocity without damper", "RMS velocity without dampers", Velocity, Both, Any;
    FloorImpacts: "", "", "", "contacts made with the floor", Run, Own, Any;
    CeilingImpacts: "", "", "", "contacts made with the ceiling", Run, Own, Any;
    StopImpacts: "", "", "", "impacts on a limit stop", Run, Own, Any;
    Separations: "", "", "", "contacts lost with the floor; a rebound from a rigid floor is an impact alone, and counts as none", Run, Own, Any;
    FloorCompression: "m", "", "", "largest compression of the floor in the time history, of all dampers", Trace, Own, Any;
    CeilingCompression: "m", "", "", "largest compression of the ceiling in the time history, of all dampers", Trace, Own, Any;
    LastPeak: "m", "", "", "last crest of the displacement in the time history", Trace, Own, Any;
    PeakVariation: "", "", "", "(largest − smallest)/mean of the crests above zero in the time history", Trace, Own, Any;
    PeakDecayError: "", "", "", "largest relative departure of the crests above zero in the time history from exp(−c′ ωₙ t), the first one as reference; of a single mass", Trace, Own, Any;
    Drift: "", "", "", "modulus of the RMS velocity of the first half of the window over that of the second, less 1: zero once transients are gone; of an odd number of cycles the first half has one more; undefined of a single cycle", Run, Own, Any;
    FloorImpactLag: "s", "", "", "shortest time between an impulse and a floor contact in the time history, whichever comes first; infinite without such a contact, undefined where no impulse stands in the time history", Trace, Own, Any;
    CeilingImpactLag: "s", "", "", "shortest time between an impulse and a ceiling contact in the time history, whichever comes first; infinite without such a contact, undefined where no impulse stands in the time history", Trace, Own, Any;
    HighestFrequency: "Hz", "", "", "highest natural frequency of the contact states", Run, Own, Any;
    ShortestPeriod: "s", "", "", "its period", Run, Own, Any;
    DisplacementAmplitude: "m", "", "", "half the peak-to-peak of the observed displacement, from the extrema of the exact motion", Extremes, Own, Any;
    VelocityAmplitude: "m/s", "", "", "half the peak-to-peak of the observed velocity", Extremes, Own, Any;
    DisplacementPerForce: "m/N", "", "", "displacement amplitude over the amplitude of the harmonic force", Extremes, Own, Harmonic;
    VelocityPerForce: "m/(N s)", "", "", "velocity amplitude over the amplitude of the harmonic force", Extremes, Own, Harmonic;
    DisplacementPerImpulse: "m/(N s)", "", "", "displacement amplitude over the impulse", Extremes, Own, Impulses;
    VelocityPerImpulse: "1/kg", "", "", "velocity amplitude over the impulse", Extremes, Own, Impulses;
    DisplacementAmplitudeRatio: "", "", "", "displacement amplitude without dampers over the one with them", Extremes, Both, Any;
    VelocityAmplitudeRatio: "", "", "", "velocity amplitude without dampers over the one with them", Extremes, Both, Any;
    UndampedDisplacementAmplitude: "m", "", "", "displacement amplitude without dampers", Extremes, Both, Any;
    UndampedVelocityAmplitude: "m/s", "", "", "velocity amplitude without dampers", Extremes, Both, Any;
    NaturalFrequency: "rad/s", "ωₙ", "", "natural frequency of the scene's `mode`, dampers on board and particles at rest on their floors", Model, Own, Any;
    CleanNaturalFrequency: "rad/s", "ωₙ", "", "the same of the model without dampers", Model, Own, Any;
    ExactNaturalFrequency: "rad/s", "ωₙ", "", "the same of the continuous structure", Model, Own, Any;
    ModeCount: "", "", "", "modes of the model: what a velocity just after an impulse depends on", Model, Own, Any;
    Mac: "", "", "modal assurance criterion", "modal assurance criterion of the shape that is kept: a mode's against the exact one, a deflection's against the forced mode's", Shape, Own, Any;
    DampingMeasure: "", "", "", "share of the structure's kinetic energy that is lost from just after an impulse to just before the next, mean over the cycles", Energies, Both, Impulses;
    MassMeasure: "", "", "", "kinetic energy at the impulses, compared with that of the clean structure, mean over the cycles", Energies, Both, Impulses;
    FloorImpactTime: "s", "", "", "first contact of the first particle with its floor in the window, from the start of the run", Events, Own, Any;
    FloorImpactInterval: "s", "", "", "time between its last two floor contacts", Events, Own, Any;
    FloorIntervalChange: "s", "", "", "by how much that time differs from the one before", Events, Own, Any;
    FloorImpactSpeed: "m/s", "", "", "relative speed just before its last floor contact", Events, Own, Any;
    FloorImpactPhase: "rad", "", "", "ω t of its last floor contact, from the start of the forcing cycle", Events, Own, Any;
    FloorReboundSpeed: "m/s", "", "", "relative speed at the end of its last floor contact that has ended", Events, Own, Any;
    FloorRestitution: "", "", "", "that speed over the one at the start of the same contact", Events, Own, Any;
    FloorContactTime: "s", "", "", "duration of the same contact", Events, Own, Any;
    ContactShare: "", "", "", "share of the averaged time that particles spend in contact with floor or ceiling, mean over the particles", Events, Own, Any;
    FloorReleaseTime: "s", "", "", "first release of the first particle from its floor in the window, from the start of the run", Events, Own, Any;
    ChatterEndTime: "s", "", "", "end of the first complete chatter of the first particle in the window, from the start of the run", Events, Own, Any;
    FinalDisplacement: "m", "", "", "displacement of the structure at the end of the run, of several points at the first", End, Own, Any;
    FinalVelocity: "m/s", "", "", "velocity of the structure at the end of the run, of several points at the first", End, Own, Any;
    FinalHeight: "m", "", "", "height of the first particle over its own floor at the end of the run, whatever point is observed; 0 where an uncompressed floor would be", End, Own, Any;
    Motion: "", "", "", "the kind of motion that the run ends in, in words: `at rest`, `periodic 1:2` (one period of the excitation, two contacts made), `sticking 1:1`, `completed chatter 1:∞`, `quasi-periodic`, `chaotic`, `not settled`; brings the columns below with it", Motion, Own, Any;
    LargestMultiplier: "", "μ", "", "modulus of the largest Floquet multiplier: what a period of the motion leaves of a small disturbance", Motion, Own, Any;
    MultiplierAngle: "rad", "", "", "angle of that multiplier: 0 towards a fold, π towards a doubling of the period", Motion, Own, Any;
    MultiplierResidual: "", "", "", "product of all multipliers against the contraction of dashpots and impacts, relative to the most that it could be", Motion, Own, Any;
    LyapunovExponent: "1/cycle", "λ", "", "growth of the logarithm of a small disturbance in a cycle; with its standard error where the motion does not come again", Motion, Own, Any;
    SettledAfter: "cycles", "", "", "cycles after which the motion comes again to within a millionth", Motion, Own, Any;
    Settled: "", "", "", "1 where the run ended with a period that comes again and attracts, and its averages are of that period; 0 where they are of the cycles given; comes with `until: settled`", Ending, Own, Any;
    AveragedCycles: "cycles", "", "", "cycles averaged over: those of the period where the run has settled, the cycles given otherwise; comes with `until: settled`", Ending, Own, Any;
    SettledVelocityRatio: "", "ψ", "velocity ratio of the settled motion", "the velocity ratio of the motion that the run goes on to, of one period of it; undefined where none is found in ten times the cycles", Settled, Both, Any;
    GapElasticity: "", "", "elasticity of ψ in the gap clearance", "d ln ψ/d ln h of the periodic motion that the run goes on to: by how many per cent the velocity ratio changes for one per cent of every gap clearance, all else as it is", Neighbours, Both, Any;
    MassElasticity: "", "", "elasticity of ψ in the particle mass", "the same for the masses of the particles", Neighbours, Both, Any;
    StiffnessElasticity: "", "", "elasticity of ψ in the floor stiffness", "the same for the stiffnesses of floors and ceilings", Neighbours, Both, Any;
    DampingElasticity: "", "", "elasticity of ψ in the contact damping", "the same for the dashpots of floors and ceilings; where all are rigid, for their restitution", Neighbours, Both, Any;
    ForceElasticity: "", "", "elasticity of ψ in the force", "the same for the amplitude of the force, or the impulse", Neighbours, Both, Any;
    VelocityRatioInput: "", "", "standard uncertainty of ψ by the tolerances", "what the `tolerances` of gap clearance, mass, stiffness, damping and force give the velocity ratio of the periodic motion that the run goes on to: ψ √Σ (u d ln ψ/d ln p)²", Neighbours, Both, Any;
}

/// A column's name in words: a measure's, or those of [`words::of_column`].
#[must_use]
pub fn column_words(name: &str) -> String {
    for point in ["maximum", "onset"] {
        if let Some(over) = name.strip_suffix(&format!("_at_{point}")) {
            return format!("{} at the {point}", column_words(over));
        }
    }
    let measure = Measure::ALL.iter().find(|measure| words::of_key(measure) == name);
    match measure.map(|measure| measure.facts().words) {
        None | Some("") => words::of_column(name),
        Some(words) => words.into(),
    }
}

impl Measure {
    /// Unit symbol, empty when dimensionless.
    #[must_use]
    pub fn unit(self) -> &'static str {
        self.facts().unit
    }

    /// Symbol of the field, empty if it has none.
    #[must_use]
    pub fn symbol(self) -> &'static str {
        self.facts().symbol
    }

    /// Read off a time history, which an experiment must keep then.
    #[must_use]
    pub fn needs_trace(self) -> bool {
        self.facts().from == ReadOff::Trace
    }

    /// Read off the shape that is kept.
    #[must_use]
    pub fn needs_shape(self) -> bool {
        self.facts().from == ReadOff::Shape
    }

    pub(super) fn needs_displacement(self) -> bool {
        self.facts().from == ReadOff::Displacement
    }

    pub(super) fn needs_extremes(self) -> bool {
        self.facts().from == ReadOff::Extremes
    }

    /// Read off single events.
    pub(super) fn needs_events(self) -> bool {
        self.facts().from == ReadOff::Events
    }

    /// Read off the velocities at the ends of cycles.
    #[must_use]
    pub fn needs_energies(self) -> bool {
        self.facts().from == ReadOff::Energies
    }

    /// Read off the kind of motion that the run ends in.
    #[must_use]
    pub fn needs_motion(self) -> bool {
        self.facts().from == ReadOff::Motion
    }

    /// Read off longer runs, which end where they have settled.
    #[must_use]
    pub fn needs_settled(self) -> bool {
        matches!(self.facts().from, ReadOff::Settled | ReadOff::Neighbours)
    }

    /// Read off the periodic motions beside the one that a run settles to.
    pub(super) fn needs_neighbours(self) -> bool {
        self.facts().from == ReadOff::Neighbours
    }

    /// What it is an elasticity in.
    #[must_use]
    pub fn elasticity_in(self) -> Option<Design> {
        Some(match self {
            Self::GapElasticity => Design::Gap,
            Self::MassElasticity => Design::ParticleMass,
            Self::StiffnessElasticity => Design::Stiffness,
            Self::DampingElasticity => Design::Damping,
            Self::ForceElasticity => Design::Force,
            _ => return None,
        })
    }

    /// Of one motion, with its multipliers: of single event-driven runs alone.
    #[must_use]
    pub fn needs_multipliers(self) -> bool {
        self.needs_motion() || self.needs_settled()
    }

    /// A name in place of a number: its column is text, without an error or a spread.
    #[must_use]
    pub fn is_name(self) -> bool {
        self == Self::Motion
    }

    /// A number of events in the averaged cycles.
    #[must_use]
    pub fn is_count(self) -> bool {
        matches!(self, Self::Separations | Self::FloorImpacts | Self::CeilingImpacts | Self::StopImpacts)
    }

    /// The measures that come with a run that ends where it has settled.
    pub fn of_settled_runs() -> impl Iterator<Item = Self> {
        Self::ALL.iter().copied().filter(|measure| measure.facts().from == ReadOff::Ending)
    }

    /// It compares cycles of a run with each other or with those of another one: of a single period there are none.
    #[must_use]
    pub fn compares_cycles(self) -> bool {
        self == Self::Drift || self.needs_energies()
    }

    /// What is known of every orbit.
    pub const OF_AN_ORBIT: [Self; 4] =
        [Self::Motion, Self::LargestMultiplier, Self::MultiplierAngle, Self::MultiplierResidual];

    /// It has a meaning for one period of a motion that comes again, whatever run led there.
    #[must_use]
    pub fn is_of_one_period(self) -> bool {
        use ReadOff::{End, Events, Extremes, Model, Neighbours, Run, Velocity};
        let from = self.facts().from;
        let single =
            matches!(from, Velocity | ReadOff::Displacement | Extremes | Run | Events | End | Model | Neighbours);
        single && !self.compares_cycles() && self != Self::VelocityRatioInput
    }

    /// It changes from one kind of motion to the next, and is constant or without meaning between.
    #[must_use]
    pub fn jumps(self) -> bool {
        matches!(self.facts().from, ReadOff::Motion | ReadOff::Ending | ReadOff::Settled | ReadOff::Neighbours)
    }

    /// The measures that come with this one.
    pub fn companions(self) -> impl Iterator<Item = Self> {
        let all = if self.is_name() { Self::ALL } else { &[] };
        all.iter().copied().filter(|other| other.needs_motion() && !other.is_name())
    }

    /// Of the last instant of the run.
    pub(super) fn is_of_the_end(self) -> bool {
        self.facts().from == ReadOff::End
    }

    /// Of the run itself, where others are means over an ensemble of kicked starts.
    pub(super) fn is_of_own_run(self) -> bool {
        self.needs_trace() || self.is_modal() || self.needs_multipliers()
    }

    /// Compares with the run without dampers, or is of it.
    #[must_use]
    pub fn needs_undamped(self) -> bool {
        self.facts().runs == Runs::Both
    }

    /// A motion without dampers over the one with them: below 1 the dampers do harm.
    #[must_use]
    pub fn is_ratio_to_undamped(self) -> bool {
        matches!(
            self,
            Self::VelocityRatio
                | Self::DisplacementRatio
                | Self::VelocityAmplitudeRatio
                | Self::DisplacementAmplitudeRatio
                | Self::SettledVelocityRatio
        )
    }

    /// Known without a run, as long as a shape that is kept is a mode's.
    #[must_use]
    pub fn is_modal(self) -> bool {
        matches!(self.facts().from, ReadOff::Model | ReadOff::Shape)
    }

    /// Zero or more in any run: part of a sum of such numbers is a bound of the sum.
    #[must_use]
    pub fn is_never_negative(self) -> bool {
        matches!(self, Self::RmsVelocity | Self::UndampedRmsVelocity | Self::StdDisplacement)
    }

    /// A number that tends to its limit as a run gets more exact: no count, no difference that should be zero, no sample.
    pub(super) fn converges(self) -> bool {
        matches!(self.facts().from, ReadOff::Velocity | ReadOff::Displacement | ReadOff::Extremes | ReadOff::Energies)
    }
}

impl Under {
    /// What it admits, in words.
    #[must_use]
    pub fn words(self) -> &'static str {
        match self {
            Self::Any => "any excitation",
            Self::Harmonic => "a harmonic force",
            Self::Impulses => "impulses",
        }
    }

    /// It admits this excitation.
    pub(super) fn admits(self, excitation: &Excitation) -> bool {
        let harmonic = matches!(excitation, Excitation::Harmonic { .. });
        match self {
            Self::Any => true,
            Self::Harmonic => harmonic,
            Self::Impulses => !harmonic,
        }
    }
}
