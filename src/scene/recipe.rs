//! Recipes: a scene in the study's own parameters, before the sweep and the assumptions have filled it in.
//!
//! Table 1 of the study defines m′ = mp/m, c′ = c/(2√(ks m)), h′ = h ωn²/g, f′ = F/(m g), ω′ = ω/ωn with ωn = √(ks/m).

use std::collections::BTreeSet;
use std::f64::consts::TAU;

use serde::{Deserialize, Serialize};

use super::{
    Assumption, AssumptionValue, Assumptions, ContactDamping, ContactEnd, Damper, Excitation, LimitStop, Scene,
    Structure, Surface, Walls,
};

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
    /// What drives it.
    pub excitation: ExcitationRecipe,
}

/// A structure in the study's parameters.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum StructureRecipe {
    /// One mass (chapter 3).
    SingleMass {
        /// m, kg.
        mass: f64,
        /// ks, N/m.
        stiffness: f64,
        /// c′.
        damping_ratio: f64,
    },
}

/// One damper in the study's parameters.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct DamperRecipe {
    /// The particle.
    pub mass: MassRecipe,
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

/// The particle's mass.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum MassRecipe {
    /// m′ = mp/m; 0 under a resilient surface becomes [`Assumption::MasslessRatio`].
    Ratio(f64),
    /// mp, kg.
    Mass(f64),
}

/// The gap clearance.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum GapRecipe {
    /// h′ = h ωn²/g.
    Ratio(f64),
    /// h, m.
    Gap(f64),
    /// No ceiling can be met (h′ = ∞).
    Infinite,
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
#[serde(rename_all = "snake_case")]
pub enum ExcitationRecipe {
    /// One impulse at t = 0.
    SingleImpulse {
        /// How strong.
        strength: StrengthRecipe,
        /// The cycle that time is counted in (a frequency ratio of 1 unless stated).
        timing: TimingRecipe,
    },
    /// Impulses with a period.
    ImpulseTrain {
        /// How strong.
        strength: StrengthRecipe,
        /// How often.
        timing: TimingRecipe,
    },
    /// A harmonic force.
    Harmonic {
        /// How strong.
        strength: StrengthRecipe,
        /// How fast.
        timing: TimingRecipe,
    },
    /// Finite pulses with a period.
    PulseTrain {
        /// How strong: the impulse of a whole pulse.
        strength: StrengthRecipe,
        /// How often.
        timing: TimingRecipe,
        /// s.
        duration: f64,
        /// How the impulse is spread.
        shape: PulseShape,
    },
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
    Impulse(f64),
    /// F, N (harmonic only).
    Force(f64),
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

/// What a sweep may vary: the same words as YAML keys and as table columns.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Parameter {
    /// f′.
    ForceRatio,
    /// a ω²/g.
    BaseAmplitudeRatio,
    /// ω′.
    FrequencyRatio,
    /// m′ of every damper.
    MassRatio,
    /// h′ of every damper; `infinite` allowed.
    GapRatio,
    /// c′.
    DampingRatio,
    /// kf/ks = kc/ks.
    FloorStiffnessRatio,
    /// ζf.
    ContactDampingRatio,
    /// kw/ks; `infinite` leaves the soft walls out (Model 2).
    WallStiffnessRatio,
    /// Limit stop `with` or `without`.
    Stop,
    /// δ, m.
    StopLength,
    /// Duration of a pulse, s.
    PulseDuration,
}

/// A value that a sweep gives to a parameter.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum ParameterValue {
    /// A number, SI or dimensionless.
    Number(f64),
    /// `infinite`.
    Infinite,
    /// `with`.
    With,
    /// `without`.
    Without,
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
}

impl Recipe {
    /// The assumptions that this recipe leans on, given that a sweep has been applied.
    #[must_use]
    pub fn assumptions(&self) -> BTreeSet<Assumption> {
        let mut set = BTreeSet::from([Assumption::UndampedMass]);
        let mut lean = |given: &Given| {
            if let Given::Assumed(name) = given {
                set.insert(*name);
            }
        };
        lean(&self.gravity);
        for damper in &self.dampers {
            for surface in [&damper.floor, &damper.ceiling] {
                if let SurfaceRecipe::Resilient { stiffness, damping, .. } = surface {
                    if let StiffnessRecipe::Ratio(given) = stiffness {
                        lean(given);
                    }
                    match damping {
                        ContactDampingRecipe::Ratio(given) => lean(given),
                        ContactDampingRecipe::EquivalentViscous => {
                            lean(&Given::Assumed(Assumption::EquivalentDampingCurve));
                        }
                        ContactDampingRecipe::Damping(_) => {}
                    }
                    if damper.mass == MassRecipe::Ratio(0.0) {
                        lean(&Given::Assumed(Assumption::MasslessRatio));
                    }
                }
            }
            if let Some(stop) = &damper.stop {
                lean(&stop.length);
                lean(&stop.restitution);
            }
            if let Some(walls) = &damper.walls {
                lean(&walls.ceiling_mass_ratio);
            }
        }
        let (strength, timing) = self.excitation.strength_and_timing();
        let harmonic = matches!(self.excitation, ExcitationRecipe::Harmonic { .. });
        if matches!(strength, StrengthRecipe::ForceRatio(_)) && !harmonic {
            set.extend([Assumption::ImpulseFactor, Assumption::ImpulseFrequency]);
        }
        if matches!(timing, TimingRecipe::FrequencyRatio(_)) {
            set.insert(if harmonic { Assumption::HarmonicReference } else { Assumption::ImpulseReference });
        }
        set
    }

    /// Gives `parameter` the value of a sweep point.
    ///
    /// # Errors
    /// [`RecipeError::NothingToVary`] if the scene has no such parameter.
    pub fn set(&mut self, parameter: Parameter, value: ParameterValue) -> Result<(), RecipeError> {
        let nothing = |what| RecipeError::NothingToVary { parameter, what };
        let number = || match value {
            ParameterValue::Number(x) => Ok(x),
            _ => Err(RecipeError::OutOfRange(format!("{parameter:?} takes a number here"))),
        };
        match parameter {
            Parameter::ForceRatio => *self.excitation.strength_mut() = StrengthRecipe::ForceRatio(number()?),
            Parameter::BaseAmplitudeRatio => {
                *self.excitation.strength_mut() = StrengthRecipe::BaseAmplitudeRatio(number()?);
            }
            Parameter::FrequencyRatio => *self.excitation.timing_mut() = TimingRecipe::FrequencyRatio(number()?),
            Parameter::PulseDuration => match &mut self.excitation {
                ExcitationRecipe::PulseTrain { duration, shape, .. } => {
                    *duration = number()?;
                    if let PulseShape::Binomial { impulses } = shape {
                        // One impulse a step of 1 ms, as the study's figure 31.
                        *impulses = (number()? / 1e-3).round().max(1.0) as u32;
                    }
                }
                _ => return Err(nothing("no pulse")),
            },
            Parameter::DampingRatio => match &mut self.structure {
                StructureRecipe::SingleMass { damping_ratio, .. } => *damping_ratio = number()?,
            },
            _ => {
                if self.dampers.is_empty() {
                    return Err(nothing("no damper"));
                }
                for damper in &mut self.dampers {
                    damper.set(parameter, value)?;
                }
            }
        }
        Ok(())
    }

    /// The scene in SI units.
    ///
    /// # Errors
    /// An assumption that is absent, or a value that physics refuses (negative mass, gap below zero, …).
    pub fn resolve(&self, assumptions: &Assumptions) -> Result<Scene, RecipeError> {
        let StructureRecipe::SingleMass { mass, stiffness, damping_ratio } = self.structure;
        let gravity = assumptions.given(self.gravity)?;
        at_least("gravity", gravity, 0.0)?;
        above("mass", mass, 0.0)?;
        at_least("stiffness", stiffness, 0.0)?;
        at_least("damping_ratio", damping_ratio, 0.0)?;
        let natural = (stiffness / mass).sqrt();
        let structure =
            Structure::SingleMass { mass, stiffness, damping: 2.0 * damping_ratio * (stiffness * mass).sqrt() };
        let dampers = self
            .dampers
            .iter()
            .map(|damper| damper.resolve(mass, stiffness, natural, gravity, assumptions))
            .collect::<Result<Vec<_>, _>>()?;
        let particles: f64 = dampers.iter().map(|damper| damper.particle_mass).sum();
        let excitation = self.excitation.resolve(mass, particles, stiffness, gravity, assumptions)?;
        Ok(Scene { structure, gravity, dampers, excitation })
    }

    /// The scene of the run "without an impact damper", by [`Assumption::UndampedMass`]: same excitation.
    ///
    /// # Errors
    /// As [`Recipe::resolve`].
    pub fn resolve_undamped(&self, assumptions: &Assumptions) -> Result<Scene, RecipeError> {
        let mut scene = self.resolve(assumptions)?;
        let particles: f64 = scene.dampers.iter().map(|damper| damper.particle_mass).sum();
        if assumptions.choice(Assumption::UndampedMass, &["base", "loaded"])? == 1 {
            let Structure::SingleMass { mass, .. } = &mut scene.structure;
            *mass += particles;
        }
        scene.dampers.clear();
        Ok(scene)
    }
}

impl DamperRecipe {
    fn set(&mut self, parameter: Parameter, value: ParameterValue) -> Result<(), RecipeError> {
        let nothing = |what| RecipeError::NothingToVary { parameter, what };
        let number = || match value {
            ParameterValue::Number(x) => Ok(x),
            _ => Err(RecipeError::OutOfRange(format!("{parameter:?} takes a number here"))),
        };
        match parameter {
            Parameter::MassRatio => self.mass = MassRecipe::Ratio(number()?),
            Parameter::GapRatio => {
                self.gap = match value {
                    ParameterValue::Infinite => GapRecipe::Infinite,
                    _ => GapRecipe::Ratio(number()?),
                };
            }
            Parameter::FloorStiffnessRatio | Parameter::ContactDampingRatio => {
                for surface in [&mut self.floor, &mut self.ceiling] {
                    let SurfaceRecipe::Resilient { stiffness, damping, .. } = surface else {
                        return Err(nothing("a rigid surface"));
                    };
                    let stated = Given::Stated(number()?);
                    if parameter == Parameter::FloorStiffnessRatio {
                        *stiffness = StiffnessRecipe::Ratio(stated);
                    } else {
                        *damping = ContactDampingRecipe::Ratio(stated);
                    }
                }
            }
            Parameter::WallStiffnessRatio => {
                let walls = self.walls.as_mut().ok_or_else(|| nothing("no soft walls"))?;
                match value {
                    // Walls that do not give: Model 2.
                    ParameterValue::Infinite => self.walls = None,
                    _ => walls.stiffness_ratio = number()?,
                }
            }
            Parameter::Stop => match value {
                ParameterValue::Without => self.stop = None,
                ParameterValue::With if self.stop.is_some() => {}
                ParameterValue::With => return Err(nothing("no limit stop to take out or leave in")),
                _ => return Err(RecipeError::OutOfRange("stop takes `with` or `without`".into())),
            },
            Parameter::StopLength => {
                self.stop.as_mut().ok_or_else(|| nothing("no limit stop"))?.length = Given::Stated(number()?);
            }
            _ => unreachable!("parameters of structure and excitation are set by Recipe::set"),
        }
        Ok(())
    }

    fn resolve(
        &self,
        base_mass: f64,
        base_stiffness: f64,
        natural: f64,
        gravity: f64,
        assumptions: &Assumptions,
    ) -> Result<Damper, RecipeError> {
        let resilient = [&self.floor, &self.ceiling].iter().any(|s| matches!(s, SurfaceRecipe::Resilient { .. }));
        let particle_mass = match self.mass {
            MassRecipe::Ratio(ratio) if ratio == 0.0 && resilient => {
                assumptions.number(Assumption::MasslessRatio)? * base_mass
            }
            MassRecipe::Ratio(ratio) => ratio * base_mass,
            MassRecipe::Mass(mass) => mass,
        };
        at_least("the particle's mass", particle_mass, 0.0)?;
        let gap = match self.gap {
            GapRecipe::Ratio(ratio) => ratio * gravity / (natural * natural),
            GapRecipe::Gap(gap) => gap,
            GapRecipe::Infinite => f64::INFINITY,
        };
        if gap.is_nan() || gap < 0.0 {
            return Err(RecipeError::OutOfRange(format!("a gap clearance cannot be {gap} m")));
        }
        let surface = |recipe: &SurfaceRecipe| recipe.resolve(base_stiffness, particle_mass, assumptions);
        let stop = match &self.stop {
            None => None,
            Some(stop) => {
                let length = assumptions.given(stop.length)?;
                above("the limit stop's length", length, 0.0)?;
                Some(LimitStop { length, restitution: assumptions.given(stop.restitution)? })
            }
        };
        let walls = match &self.walls {
            None => None,
            Some(walls) => {
                above("wall_stiffness_ratio", walls.stiffness_ratio, 0.0)?;
                let ceiling_mass = assumptions.given(walls.ceiling_mass_ratio)? * base_mass;
                if !(ceiling_mass > 0.0 && ceiling_mass < base_mass) {
                    return Err(RecipeError::OutOfRange(
                        "the ceiling body's mass must lie between 0 and the base mass".into(),
                    ));
                }
                Some(Walls { stiffness: walls.stiffness_ratio * base_stiffness, damping: walls.damping, ceiling_mass })
            }
        };
        Ok(Damper { particle_mass, gap, floor: surface(&self.floor)?, ceiling: surface(&self.ceiling)?, stop, walls })
    }
}

impl SurfaceRecipe {
    fn resolve(
        &self,
        base_stiffness: f64,
        particle_mass: f64,
        assumptions: &Assumptions,
    ) -> Result<Surface, RecipeError> {
        match *self {
            Self::Rigid { restitution } => {
                if !(0.0..=1.0).contains(&restitution) {
                    return Err(RecipeError::OutOfRange(format!(
                        "restitution lies between 0 and 1, not at {restitution}"
                    )));
                }
                Ok(Surface::Rigid { restitution })
            }
            Self::Resilient { stiffness, damping, no_tension } => {
                let stiffness = match stiffness {
                    StiffnessRecipe::Ratio(given) => assumptions.given(given)? * base_stiffness,
                    StiffnessRecipe::Stiffness(value) => value,
                };
                above("the surface's stiffness", stiffness, 0.0)?;
                let damping = match damping {
                    ContactDampingRecipe::Ratio(given) => {
                        let ratio = assumptions.given(given)?;
                        at_least("contact_damping_ratio", ratio, 0.0)?;
                        ContactDamping::Constant(2.0 * ratio * (stiffness * particle_mass).sqrt())
                    }
                    ContactDampingRecipe::Damping(value) => {
                        at_least("the surface's damping", value, 0.0)?;
                        ContactDamping::Constant(value)
                    }
                    ContactDampingRecipe::EquivalentViscous => ContactDamping::EquivalentViscous(
                        assumptions.curve(Assumption::EquivalentDampingCurve)?.clone(),
                    ),
                };
                let ends = if no_tension { ContactEnd::ZeroForce } else { ContactEnd::ZeroGap };
                Ok(Surface::Resilient { stiffness, damping, ends })
            }
        }
    }
}

impl ExcitationRecipe {
    /// Strength and timing, whatever the kind.
    #[must_use]
    pub fn strength_and_timing(&self) -> (StrengthRecipe, TimingRecipe) {
        match self {
            Self::SingleImpulse { strength, timing }
            | Self::ImpulseTrain { strength, timing }
            | Self::Harmonic { strength, timing }
            | Self::PulseTrain { strength, timing, .. } => (*strength, *timing),
        }
    }

    fn strength_mut(&mut self) -> &mut StrengthRecipe {
        match self {
            Self::SingleImpulse { strength, .. }
            | Self::ImpulseTrain { strength, .. }
            | Self::Harmonic { strength, .. }
            | Self::PulseTrain { strength, .. } => strength,
        }
    }

    fn timing_mut(&mut self) -> &mut TimingRecipe {
        match self {
            Self::SingleImpulse { timing, .. }
            | Self::ImpulseTrain { timing, .. }
            | Self::Harmonic { timing, .. }
            | Self::PulseTrain { timing, .. } => timing,
        }
    }

    fn resolve(
        &self,
        mass: f64,
        particles: f64,
        stiffness: f64,
        gravity: f64,
        assumptions: &Assumptions,
    ) -> Result<Excitation, RecipeError> {
        let (strength, timing) = self.strength_and_timing();
        let harmonic = matches!(self, Self::Harmonic { .. });
        let angular_frequency = match timing {
            TimingRecipe::FrequencyRatio(ratio) => {
                let name = if harmonic { Assumption::HarmonicReference } else { Assumption::ImpulseReference };
                let carried = if assumptions.choice(name, &["base", "loaded"])? == 1 { particles } else { 0.0 };
                ratio * (stiffness / (mass + carried)).sqrt()
            }
            TimingRecipe::Period(period) => TAU / period,
            TimingRecipe::AngularFrequency(omega) => omega,
        };
        above("the forcing frequency", angular_frequency, 0.0)?;
        // A stated period is kept to the bit.
        let period = if let TimingRecipe::Period(period) = timing { period } else { TAU / angular_frequency };
        if harmonic {
            let force = match strength {
                StrengthRecipe::ForceRatio(ratio) => ratio * mass * gravity,
                StrengthRecipe::BaseAmplitudeRatio(ratio) => -ratio * mass * gravity,
                StrengthRecipe::Force(force) => force,
                StrengthRecipe::Impulse(_) => {
                    return Err(RecipeError::OutOfRange("a harmonic force takes a force, not an impulse".into()));
                }
            };
            return Ok(Excitation::Harmonic { force, angular_frequency });
        }
        let impulse = match strength {
            StrengthRecipe::Impulse(impulse) => impulse,
            StrengthRecipe::ForceRatio(ratio) => {
                let omega = match assumptions.choice(Assumption::ImpulseFrequency, &["forcing", "natural"])? {
                    0 => angular_frequency,
                    _ => (stiffness / mass).sqrt(),
                };
                assumptions.number(Assumption::ImpulseFactor)? * ratio * mass * gravity / omega
            }
            StrengthRecipe::BaseAmplitudeRatio(_) | StrengthRecipe::Force(_) => {
                return Err(RecipeError::OutOfRange("an impulse takes force_ratio or an impulse in N s".into()));
            }
        };
        Ok(match self {
            Self::SingleImpulse { .. } => Excitation::SingleImpulse { impulse, cycle: period },
            Self::ImpulseTrain { .. } => Excitation::ImpulseTrain { impulse, period },
            Self::PulseTrain { duration, shape, .. } => {
                if !(*duration > 0.0 && *duration <= period) {
                    return Err(RecipeError::OutOfRange(format!(
                        "a pulse of {duration} s does not fit into a forcing period of {period} s"
                    )));
                }
                Excitation::PulseTrain { impulse, period, duration: *duration, shape: *shape }
            }
            Self::Harmonic { .. } => unreachable!("handled above"),
        })
    }
}

impl Assumptions {
    /// The number that an assumption holds.
    ///
    /// # Errors
    /// If it is absent or not a number.
    pub fn number(&self, name: Assumption) -> Result<f64, RecipeError> {
        match self.values.get(&name) {
            Some(AssumptionValue::Number(x)) => Ok(*x),
            _ => Err(RecipeError::Assumption(name, "as a number")),
        }
    }

    /// The index of the choice that an assumption holds among `choices`.
    ///
    /// # Errors
    /// If it is absent or not one of `choices`.
    pub fn choice(&self, name: Assumption, choices: &'static [&'static str]) -> Result<usize, RecipeError> {
        match self.values.get(&name) {
            Some(AssumptionValue::Choice(word)) => choices.iter().position(|choice| choice == word),
            _ => None,
        }
        .ok_or(RecipeError::Assumption(name, "as one of its named readings"))
    }

    /// The curve that an assumption holds.
    ///
    /// # Errors
    /// If it is absent or not a curve.
    pub fn curve(&self, name: Assumption) -> Result<&super::Curve, RecipeError> {
        match self.values.get(&name) {
            Some(AssumptionValue::Curve(curve)) => Ok(curve),
            _ => Err(RecipeError::Assumption(name, "as a curve")),
        }
    }

    /// The number that was stated, or the assumption's.
    ///
    /// # Errors
    /// As [`Assumptions::number`].
    pub fn given(&self, given: Given) -> Result<f64, RecipeError> {
        match given {
            Given::Stated(x) => Ok(x),
            Given::Assumed(name) => self.number(name),
        }
    }
}

fn above(what: &str, value: f64, bound: f64) -> Result<(), RecipeError> {
    if value > bound && value.is_finite() {
        Ok(())
    } else {
        Err(RecipeError::OutOfRange(format!("{what} must be above {bound}, not {value}")))
    }
}

fn at_least(what: &str, value: f64, bound: f64) -> Result<(), RecipeError> {
    if value >= bound && value.is_finite() {
        Ok(())
    } else {
        Err(RecipeError::OutOfRange(format!("{what} must be {bound} or more, not {value}")))
    }
}
