//! Recipes: a scene in the study's own parameters, before the sweep and the assumptions have filled it in.
//!
//! Table 1 of the study defines m′ = mp/m, c′ = c/(2√(ks m)), h′ = h ωn²/g, f′ = F/(m g), ω′ = ω/ωn with ωn = √(ks/m).

use serde::{Deserialize, Serialize};

use super::place::PlaceRecipe;
use super::start::StartRecipe;
use super::structure::StructureRecipe;
use super::{Assumption, Parameter, Take};

/// A number that the study states, or the name of the assumption that stands for it.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Given {
    /// Stated, SI or dimensionless.
    Stated(f64),
    /// Taken from the assumptions.
    Assumed(Assumption),
}

/// A scene as an experiment names it.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Recipe {
    /// What vibrates.
    pub structure: StructureRecipe,
    /// g, m/s².
    pub gravity: Given,
    /// The dampers, in the order of the file.
    pub dampers: Vec<DamperRecipe>,
    /// They are taken out: the clean structure.
    pub without_dampers: bool,
    /// What drives it.
    pub excitation: ExcitationRecipe,
    /// Where it starts; in static equilibrium unless it is stated.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub start: Option<StartRecipe>,
    /// Where its motion is observed.
    pub observe: ObserveRecipe,
    /// Which mode natural frequencies and mode shapes are of, from 1; the forced one unless it is stated.
    pub mode: Option<u32>,
}

/// Where the motion is observed, and what is made of several points.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct ObserveRecipe {
    /// Where.
    pub points: PointsRecipe,
    /// How one number is taken of them; `None`: by [`Assumption::GridVelocity`].
    pub take: Option<Take>,
}

/// Observed points.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum PointsRecipe {
    /// The structure's own performance point, or nine of them.
    #[default]
    Usual,
    /// These.
    Points(Vec<PlaceRecipe>),
    /// The crossings of the lines that quarter both sides of a plate (s. 5.2.4).
    NinePointGrid,
}

/// One damper, or an array of them, in the study's parameters.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct DamperRecipe {
    /// Where it sits.
    pub at: PlaceRecipe,
    /// An array around or from there.
    pub array: Option<ArrayRecipe>,
    /// Particle and enclosure together, of the whole array.
    pub mass: MassRecipe,
    /// What m′ is a share of.
    pub mass_reading: MassReading,
    /// mp/(mp + ms).
    pub particle_share: f64,
    /// The gap clearance.
    pub gap: GapRecipe,
    /// The floor.
    pub floor: SurfaceRecipe,
    /// The ceiling; the same as the floor unless the file says otherwise.
    pub ceiling: SurfaceRecipe,
    /// Limit stop; `None` when the file names none or the sweep takes it out.
    pub stop: Option<StopRecipe>,
    /// Soft walls (Model 3).
    pub walls: Option<WallRecipe>,
}

/// An array of equal dampers.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct ArrayRecipe {
    /// How many along each side, or one number for all of them.
    pub count: Vec<u32>,
    /// Distance along each side, or the same along all, m.
    pub spacing: Vec<f64>,
    /// Centred on its place; else it begins there.
    pub centred: bool,
    /// Distance that it keeps from the ends of the structure, m: one that would come nearer is moved inwards as a whole.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub margin: Option<Given>,
}

/// Mass of particle and enclosure.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum MassRecipe {
    /// m′ = (mp + ms)/m; on one mass 0 under a resilient surface becomes [`Assumption::MasslessRatio`].
    Ratio(f64),
    /// mp + ms, kg.
    Mass(f64),
}

/// What the mass ratio of a damper on a beam or plate is a share of.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum MassReading {
    /// By [`Assumption::BeamDamperMass`] or [`Assumption::PlateDamperMass`].
    Assumed,
    /// By this assumption, which is of their kind.
    By(Assumption),
    /// The structure's mass.
    Total,
    /// Its first modal mass where the largest amplitude is one.
    Modal,
}

/// The gap clearance.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum GapRecipe {
    /// h′ = h ωn²/g.
    Ratio(f64),
    /// h, m.
    Gap(f64),
    /// h′ of each damper of an array.
    Ratios(Vec<f64>),
    /// h of each damper of an array, m.
    Gaps(Vec<f64>),
    /// h of the dampers of an array, m, filled in one of two ways.
    Filled {
        /// The same in all of them.
        uniform: f64,
        /// One a damper.
        optimised: Vec<f64>,
        /// Which of the two.
        filling: Filling,
    },
    /// No ceiling can be met (h′ = ∞).
    Infinite,
}

/// How an array is filled.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Filling {
    /// Equal gaps.
    Uniform,
    /// Gaps that an optimiser has found.
    Optimised,
}

/// In which of the study's words gaps are told.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum GapWord {
    /// h, m.
    Gap,
    /// h′ = h ωn²/g.
    GapRatio,
}

impl Recipe {
    /// Gives every damper its own gap, array by array in the order of the file.
    ///
    /// # Errors
    /// [`RecipeError::OutOfRange`] if there are more or fewer gaps than dampers.
    pub fn set_gaps(&mut self, word: GapWord, gaps: &[f64]) -> Result<(), RecipeError> {
        let mut left = gaps;
        for damper in &mut self.dampers {
            let count = damper.array.as_ref().map_or(1, |array| array.count.iter().product::<u32>() as usize);
            let Some((own, rest)) = left.split_at_checked(count) else {
                return Err(RecipeError::OutOfRange(format!("{} gaps are too few: one for each damper", gaps.len())));
            };
            left = rest;
            damper.gap = match word {
                GapWord::Gap => GapRecipe::Gaps(own.to_vec()),
                GapWord::GapRatio => GapRecipe::Ratios(own.to_vec()),
            };
        }
        if left.is_empty() {
            Ok(())
        } else {
            Err(RecipeError::OutOfRange(format!("{} gaps are too many: one for each damper", gaps.len())))
        }
    }
}

/// A surface.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum SurfaceRecipe {
    /// Model 1.
    Rigid {
        /// ε.
        restitution: f64,
    },
    /// Models 2 and 3.
    Resilient {
        /// kf.
        stiffness: StiffnessRecipe,
        /// cf.
        damping: ContactDampingRecipe,
        /// True: the contact ends where its force would turn to tension, false (as the study): at zero gap.
        no_tension: bool,
    },
}

/// Stiffness of a resilient surface.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum StiffnessRecipe {
    /// kf/ks.
    Ratio(Given),
    /// kf, N/m.
    Stiffness(f64),
    /// kf = mp ω₁² of the clean structure.
    Tuned,
    /// kf = mp (r ω₁)² with r = [`Assumption::UntunedFrequencyRatio`].
    Untuned,
    /// By the assumption on floors of beams or of plates.
    Assumed,
    /// By this assumption, which is of their kind.
    By(Assumption),
}

/// Damping of a resilient surface.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum ContactDampingRecipe {
    /// ζf = cf/(2 √(kf mp)).
    Ratio(Given),
    /// cf, N s/m.
    Damping(f64),
    /// Equivalent viscous damping by half cycles (s. 3.3), with the assumed curve.
    EquivalentViscous,
}

/// Limit stop.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct StopRecipe {
    /// δ, m.
    pub length: Given,
    /// Its restitution.
    pub restitution: Given,
}

/// Soft walls.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct WallRecipe {
    /// kw/ks.
    pub stiffness_ratio: f64,
    /// cw, N s/m.
    pub damping: f64,
    /// mt/m.
    pub ceiling_mass_ratio: Given,
}

/// Excitation in the study's parameters.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct ExcitationRecipe {
    /// Of which kind.
    pub kind: ExcitationKind,
    /// Where the force acts.
    pub at: PlaceRecipe,
    /// How strong; of a pulse: the impulse of the whole of it.
    pub strength: StrengthRecipe,
    /// How often; of a single impulse: the cycle that time is counted in.
    pub timing: TimingRecipe,
    /// τ in J = f′ m g τ.
    pub impulse_time: ImpulseTime,
}

/// Kind of an excitation.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum ExcitationKind {
    /// Nothing drives it.
    None,
    /// One impulse at t = 0.
    SingleImpulse,
    /// Impulses with a period.
    ImpulseTrain,
    /// A harmonic force.
    Harmonic,
    /// Finite pulses with a period.
    PulseTrain {
        /// s.
        duration: f64,
        /// How the impulse is spread.
        shape: PulseShape,
    },
}

/// The time τ by which a force ratio becomes an impulse, J = f′ m g τ.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum ImpulseTime {
    /// By assumption: κ/ω for a single mass, [`Assumption::BeamImpulseTime`], [`Assumption::PlateImpulseTime`].
    Assumed,
    /// s.
    Seconds(f64),
    /// 1/ω of the forcing.
    Radian,
    /// 2/ω: half a sine wave of that amplitude.
    HalfSine,
    /// 2π/ω.
    Period,
}

impl ImpulseTime {
    /// The readings by their words in YAML.
    pub const WORDS: [(&'static str, Self); 3] =
        [("radian", Self::Radian), ("half_sine", Self::HalfSine), ("period", Self::Period)];
}

/// The strength of an excitation.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum StrengthRecipe {
    /// f′ = F/(m g): the force amplitude of a harmonic, and for impulses J = κ f′ m g/ω with the assumed κ and ω.
    ForceRatio(f64),
    /// a ω²/g, Duncan's base amplitude: F = −m a ω² (harmonic only).
    BaseAmplitudeRatio(f64),
    /// J, N s (impulses and pulses only).
    Impulse(Given),
    /// F, N (harmonic only).
    Force(Given),
}

/// The timing of an excitation.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum TimingRecipe {
    /// ω′ = ω/ωn.
    FrequencyRatio(f64),
    /// T, s.
    Period(f64),
    /// ω, rad/s.
    AngularFrequency(f64),
    /// The clean structure's natural frequency of this number.
    ForcedMode(u32),
}

/// How a finite pulse spreads its impulse.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum PulseShape {
    /// Constant force over the duration.
    Rectangular,
    /// Impulses with binomial weights, one a millisecond of the duration.
    Binomial {
        /// n: impulses a pulse, spaced duration/n, weights C(n−1, i)/2^(n−1).
        impulses: u32,
    },
}

/// Why a recipe has no scene.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum RecipeError {
    /// The scene lacks what the sweep varies.
    #[error("the sweep varies {parameter:?}, but the scene has {what}")]
    NothingToVary {
        /// Which parameter.
        parameter: Parameter,
        /// What the scene has instead.
        what: &'static str,
    },
    /// An assumption is needed and absent from the file, or of the wrong kind.
    #[error("the assumption {0:?} is needed; give it {1} in the assumptions file")]
    Assumption(Assumption, &'static str),
    /// A value that physics refuses.
    #[error("{0}")]
    OutOfRange(String),
    /// The same, where it is known which part of the scene is meant.
    #[error("{message}")]
    Part {
        /// Which part.
        part: Part,
        /// What is wrong with it.
        message: String,
    },
}

/// A part of a scene that a refusal is about.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Part {
    /// The structure.
    Structure,
    /// A damper, by its place in the file.
    Damper(usize),
    /// The excitation.
    Excitation,
    /// What is observed.
    Observe,
    /// Initial conditions.
    Start,
}

impl Part {
    /// Any damper stands for all of them.
    pub(crate) fn kind(self) -> Self {
        if let Self::Damper(_) = self { Self::Damper(0) } else { self }
    }
}

impl RecipeError {
    /// A structure that is none.
    pub(crate) fn structure(message: String) -> Self {
        Self::Part { part: Part::Structure, message }
    }
}
