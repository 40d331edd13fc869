//! Recipes: a scene as an experiment names it, before the sweep and the assumptions have filled it in.
//!
//! Dimensionless parameters: m′ = mp/m, c′ = c/(2√(ks m)), h′ = h ωn²/g, f′ = F/(m g), ω′ = ω/ωn with ωn = √(ks/m).

use serde::{Deserialize, Serialize};

use super::error::RecipeError;
use super::given::Given;
use super::place::{ArrayRecipe, PlaceRecipe};
use super::structure::StructureRecipe;
use super::swept::SweptSlots;
use crate::measure::Comparison;
use crate::scene::{Curve, PulseShape, Start, Take};

/// A scene as an experiment names it.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Recipe {
    /// What vibrates.
    pub structure: StructureRecipe,
    /// g, m/s².
    pub gravity: Given,
    /// Of one mass: what it weighs in the run without dampers.
    pub undamped_mass: Given<Carried>,
    /// How the mass measure compares kinetic energies with those of the clean structure.
    pub mass_measure: Given<Comparison>,
    /// What a velocity ratio over several settings is.
    pub mean_ratio: Given<MeanRatio>,
    /// The dampers, in the order of the file.
    pub dampers: Vec<DamperRecipe>,
    /// They are taken out: the clean structure.
    pub without_dampers: bool,
    /// What drives it.
    pub excitation: ExcitationRecipe,
    /// Where it starts; in static equilibrium unless it is stated.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub start: Option<Start>,
    /// Where its motion is observed.
    pub observe: ObserveRecipe,
    /// Which mode natural frequencies and mode shapes are of, from 1; the forced one unless it is stated.
    pub mode: Option<u32>,
}

/// What a velocity ratio over several settings is.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum MeanRatio {
    /// The ratio of the mean RMS velocities: that of the structure at all settings together, which an optimisation reduces.
    OfMeans,
    /// The mean of the velocity ratios.
    OfEach,
}

/// Where the motion is observed, and what is made of several points.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct ObserveRecipe {
    /// Where.
    pub points: PointsRecipe,
    /// How one number is taken of several points.
    pub take: Given<Take>,
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
    /// The crossings of the lines that quarter both sides of a plate.
    NinePointGrid,
}

/// One damper, or an array of them, in the parameters of the file.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct DamperRecipe {
    /// Where it sits.
    pub at: PlaceRecipe,
    /// An array around or from there.
    pub array: Option<ArrayRecipe>,
    /// Particle and enclosure together, of the whole array.
    pub mass: MassRecipe,
    /// What m′ is a share of; on one mass its mass.
    pub mass_reading: Given<MassReading>,
    /// The mass ratio that stands for m′ = 0 under a resilient surface, where a contact without mass is singular.
    pub massless_ratio: Option<Given>,
    /// mp/(mp + ms).
    pub particle_share: Given,
    /// The gap clearance.
    pub gap: GapRecipe,
    /// Whose first natural frequency stands in h′.
    pub gap_frequency: Given<Reference>,
    /// The floor.
    pub floor: SurfaceRecipe,
    /// The ceiling; the same as the floor unless the file says otherwise.
    pub ceiling: SurfaceRecipe,
    /// Limit stop; `None` when the file names none or the sweep takes it out.
    pub stop: Option<StopRecipe>,
    /// Soft walls (Model 3).
    pub walls: Option<WallRecipe>,
    /// What of it a sweep sets.
    #[serde(skip)]
    pub swept: SweptSlots,
}

/// Mass of particle and enclosure.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum MassRecipe {
    /// m′ = (mp + ms)/m.
    Ratio(Given),
    /// mp + ms, kg.
    Mass(Given),
}

/// What the mass ratio of a damper on a beam or plate is a share of.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum MassReading {
    /// The structure's mass.
    Total,
    /// Its first modal mass where the largest amplitude is one.
    Modal,
    /// This share of the structure's mass.
    Share(f64),
}

/// A structure without its dampers, or with them fixed to it.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Reference {
    /// Without.
    Clean,
    /// With.
    Loaded,
}

/// One mass alone, or with its particles.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Carried {
    /// m.
    Base,
    /// m + mp.
    Loaded,
}

/// The gap clearance.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum GapRecipe {
    /// h′ = h ωn²/g.
    Ratio(Given),
    /// h, m.
    Gap(Given),
    /// h′ of each damper of an array.
    Ratios(Vec<f64>),
    /// h of each damper of an array, m.
    Gaps(Vec<f64>),
    /// h of the dampers of an array, m, filled in one of two ways.
    Filled {
        /// The same in all of them.
        uniform: Given,
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

/// The word by which gaps are given.
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
                return Err(RecipeError::out_of_range(format!("{} gaps are too few: one for each damper", gaps.len())));
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
            Err(RecipeError::out_of_range(format!("{} gaps are too many: one for each damper", gaps.len())))
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
        restitution: Given,
    },
    /// Models 2 and 3.
    Resilient {
        /// kf.
        stiffness: StiffnessRecipe,
        /// Natural frequency of the particle on an untuned surface over that of the clean structure.
        untuned_ratio: Option<Given>,
        /// cf.
        damping: ContactDampingRecipe,
        /// Damping against RMS base acceleration in units of g, for equivalent viscous damping.
        damping_curve: Option<Given<Curve>>,
        /// True: the contact ends where its force would turn to tension, false: at zero gap.
        no_tension: bool,
    },
}

/// Stiffness of a resilient surface.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum StiffnessRecipe {
    /// kf/ks.
    Ratio(Given),
    /// A stiffness, or what it is tuned to.
    By(Given<FloorStiffness>),
}

/// A stiffness, or the frequency ω to which it is tuned, kf = mp ω².
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum FloorStiffness {
    /// kf, N/m.
    Stiffness(f64),
    /// ω₁ of the clean structure.
    Clean,
    /// ω₁ of the structure with its dampers fixed to it.
    Loaded,
    /// r ω₁ of the clean structure with r the untuned frequency ratio.
    Untuned,
}

/// Damping of a resilient surface.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum ContactDampingRecipe {
    /// ζf = cf/(2 √(kf mp)), or the damping curve in its place.
    Ratio(Given<ContactDampingRatio>),
    /// cf, N s/m, or the damping curve in its place.
    Damping(Given<ContactDampingConstant>),
}

/// A damping ratio of a contact, or the damping curve in its place.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum ContactDampingRatio {
    /// ζf.
    Ratio(f64),
    /// Equivalent viscous damping by half cycles.
    EquivalentViscous,
}

/// The damping constant of a contact, or the damping curve in its place.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum ContactDampingConstant {
    /// Equivalent viscous damping by half cycles.
    EquivalentViscous,
    /// cf, N s/m; a plain number in JSON.
    #[serde(untagged)]
    Constant(f64),
}

/// Limit stop.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct StopRecipe {
    /// δ, m.
    pub length: Given,
    /// Its restitution.
    pub restitution: Given,
}

/// Soft walls.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct WallRecipe {
    /// kw/ks.
    pub stiffness_ratio: Given,
    /// cw, N s/m.
    pub damping: Given,
    /// mt/m.
    pub ceiling_mass_ratio: Option<Given>,
}

/// Excitation in dimensionless parameters or SI.
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
    /// Of one mass: whose natural frequency a frequency ratio of 1 means.
    pub frequency_reference: Given<Carried>,
    /// τ in J = f′ m g τ.
    pub impulse_time: ImpulseTimeRecipe,
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
        duration: Given,
        /// How the impulse is spread.
        shape: PulseShape,
    },
}

/// How the time τ comes about by which a force ratio becomes an impulse, J = f′ m g τ.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum ImpulseTimeRecipe {
    /// A time.
    By(Given<ImpulseTime>),
    /// τ = κ/ω.
    Factor {
        /// κ.
        factor: Given,
        /// Which ω.
        frequency: Given<ForcingOrNatural>,
    },
}

/// Which frequency.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum ForcingOrNatural {
    /// That of the forcing.
    Forcing,
    /// The first natural one of the clean structure.
    Natural,
}

/// The time τ by which a force ratio becomes an impulse, J = f′ m g τ.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum ImpulseTime {
    /// s.
    Seconds(f64),
    /// 1/ω of the forcing.
    Radian,
    /// 2/ω: half a sine wave of that amplitude.
    HalfSine,
    /// 2π/ω.
    Period,
}

/// The strength of an excitation.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum StrengthRecipe {
    /// f′ = F/(m g): the amplitude of a harmonic force, and for impulses J = f′ m g τ.
    ForceRatio(Given),
    /// a ω²/g, the base amplitude: F = −m a ω² (harmonic only).
    BaseAmplitudeRatio(Given),
    /// J, N s (impulses and pulses only).
    Impulse(Given),
    /// F, N (harmonic only).
    Force(Given),
}

/// The timing of an excitation.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum TimingRecipe {
    /// ω′ = ω/ωn.
    FrequencyRatio(Given),
    /// T, s.
    Period(Given),
    /// ω, rad/s.
    AngularFrequency(Given),
    /// The clean structure's natural frequency of this number.
    ForcedMode(u32),
}
