//! The value that a sweep gives to a parameter, set in a recipe.

use super::error::RecipeError;
use super::given::Given;
use super::parameter::{Parameter, ParameterValue};
use super::parts::{
    ContactDampingRatio, ContactDampingRecipe, DamperRecipe, ExcitationKind, Filling, FloorStiffness, GapRecipe,
    MassReading, MassRecipe, Recipe, StiffnessRecipe, StrengthRecipe, SurfaceRecipe, TimingRecipe,
};
use crate::scene::{PulseShape, whole};
use crate::yaml::word::words;

/// A whole number above zero.
fn count(value: f64) -> Result<u32, RecipeError> {
    whole(value).map_err(|error| RecipeError::out_of_range(error.message))
}

/// The number that a sweep gives.
fn number(parameter: Parameter, value: ParameterValue) -> Result<f64, RecipeError> {
    match value {
        ParameterValue::Number(x) => Ok(x),
        _ => Err(RecipeError::out_of_range(format!("{parameter:?} takes a number here"))),
    }
}

impl Recipe {
    /// Gives `parameter` the value of a sweep point: where the scene says `swept`, or else in every place that it has.
    ///
    /// # Errors
    /// [`RecipeError::NothingToVary`] if the scene has no such parameter.
    pub fn set(&mut self, parameter: Parameter, value: ParameterValue) -> Result<(), RecipeError> {
        let word = words::<Parameter>().get(parameter as usize).copied();
        self.put(parameter, value).map_err(|error| error.at_keys(word.as_slice()))
    }

    fn put(&mut self, parameter: Parameter, value: ParameterValue) -> Result<(), RecipeError> {
        let nothing = |what| RecipeError::NothingToVary { parameter, what };
        let number = || number(parameter, value);
        match parameter {
            Parameter::ForceRatio => self.excitation.strength = StrengthRecipe::ForceRatio(number()?.into()),
            Parameter::BaseAmplitudeRatio => {
                self.excitation.strength = StrengthRecipe::BaseAmplitudeRatio(number()?.into())
            }
            Parameter::Force => self.excitation.strength = StrengthRecipe::Force(Given::Stated(number()?)),
            Parameter::Impulse => self.excitation.strength = StrengthRecipe::Impulse(Given::Stated(number()?)),
            Parameter::FrequencyRatio => self.excitation.timing = TimingRecipe::FrequencyRatio(number()?.into()),
            Parameter::AngularFrequency => self.excitation.timing = TimingRecipe::AngularFrequency(number()?.into()),
            Parameter::ForcedMode => self.excitation.timing = TimingRecipe::ForcedMode(count(number()?)?),
            Parameter::ForceX | Parameter::ForceY => {
                let side = usize::from(parameter == Parameter::ForceY);
                if !self.excitation.at.set_share(side, number()?) {
                    return Err(nothing("no such side at the force"));
                }
            }
            Parameter::PulseDuration => match &mut self.excitation.kind {
                ExcitationKind::PulseTrain { duration, shape, .. } => {
                    let seconds = number()?;
                    *duration = seconds.into();
                    if matches!(shape, PulseShape::Binomial { .. }) {
                        let binomial = PulseShape::binomial(seconds);
                        *shape = binomial.map_err(|error| RecipeError::out_of_range(error.to_string()))?;
                    }
                }
                _ => return Err(nothing("no pulse")),
            },
            Parameter::Mode => self.mode = Some(count(number()?)?),
            Parameter::Place => {
                let chosen = count(number()?)?;
                let mut listed = self.excitation.at.choose(chosen);
                for damper in &mut self.dampers {
                    listed |= damper.at.choose(chosen);
                }
                if !listed {
                    return Err(nothing("no list of places: write `at: {assumed: NAME}`"));
                }
            }
            Parameter::Dampers => self.without_dampers = value == ParameterValue::Without,
            Parameter::DampingRatio
            | Parameter::Modes
            | Parameter::Length
            | Parameter::Width
            | Parameter::Thickness
            | Parameter::Rayleigh => {
                if !self.structure.set(parameter, number()?)? {
                    return Err(nothing("a structure without it"));
                }
            }
            _ => {
                if self.dampers.is_empty() {
                    return Err(nothing("no damper"));
                }
                let marked = self.dampers.iter().any(|damper| damper.swept.hold(parameter));
                for damper in self.dampers.iter_mut().filter(|damper| !marked || damper.swept.hold(parameter)) {
                    damper.set(parameter, value)?;
                }
            }
        }
        Ok(())
    }
}

impl DamperRecipe {
    fn set(&mut self, parameter: Parameter, value: ParameterValue) -> Result<(), RecipeError> {
        let nothing = |what| RecipeError::NothingToVary { parameter, what };
        let number = || number(parameter, value);
        match parameter {
            Parameter::MassRatio => self.mass = MassRecipe::Ratio(number()?.into()),
            Parameter::Mass => self.mass = MassRecipe::Mass(number()?.into()),
            Parameter::MassReading => {
                let modal = value == ParameterValue::Modal;
                self.mass_reading = Given::Stated(if modal { MassReading::Modal } else { MassReading::Total });
            }
            Parameter::Filling => match &mut self.gap {
                GapRecipe::Filled { filling, .. } => {
                    *filling = if value == ParameterValue::Optimised { Filling::Optimised } else { Filling::Uniform };
                }
                _ => return Err(nothing("one filling alone: write `gap: {uniform: …, optimised: […]}`")),
            },
            Parameter::ParticleShare => self.particle_share = number()?.into(),
            Parameter::DamperX | Parameter::DamperY => {
                if !self.at.set_share(usize::from(parameter == Parameter::DamperY), number()?) {
                    return Err(nothing("no such side at the damper"));
                }
            }
            Parameter::DamperCount => {
                let array = self.array.as_mut().ok_or_else(|| nothing("no array of dampers"))?;
                array.count = vec![count(number()?)?];
            }
            Parameter::GapRatio => {
                self.gap = match value {
                    ParameterValue::Infinite => GapRecipe::Infinite,
                    _ => GapRecipe::Ratio(number()?.into()),
                };
            }
            Parameter::Gap => self.gap = GapRecipe::Gap(number()?.into()),
            Parameter::FloorStiffnessRatio | Parameter::ContactDampingRatio | Parameter::FloorTuning => {
                let [floor, ceiling] = self.swept.surfaces(parameter);
                for (surface, _) in
                    [(&mut self.floor, floor), (&mut self.ceiling, ceiling)].into_iter().filter(|it| it.1)
                {
                    let SurfaceRecipe::Resilient { stiffness, damping, .. } = surface else {
                        return Err(nothing("a rigid surface"));
                    };
                    match parameter {
                        Parameter::FloorStiffnessRatio => *stiffness = StiffnessRecipe::Ratio(Given::Stated(number()?)),
                        Parameter::ContactDampingRatio => {
                            let ratio = ContactDampingRatio::Ratio(number()?);
                            *damping = ContactDampingRecipe::Ratio(Given::Stated(ratio));
                        }
                        _ if value == ParameterValue::Tuned => {
                            *stiffness = StiffnessRecipe::By(Given::Stated(FloorStiffness::Clean));
                        }
                        // A surface that states a stiffness has it untuned; one that is swept alone, that of its ratio.
                        _ if *stiffness == StiffnessRecipe::By(Given::Stated(FloorStiffness::Clean)) => {
                            *stiffness = StiffnessRecipe::By(Given::Stated(FloorStiffness::Untuned));
                        }
                        _ => {}
                    }
                }
            }
            Parameter::WallStiffnessRatio => {
                let walls = self.walls.as_mut().ok_or_else(|| nothing("no soft walls"))?;
                match value {
                    // Walls that do not give: Model 2.
                    ParameterValue::Infinite => self.walls = None,
                    _ => walls.stiffness_ratio = number()?.into(),
                }
            }
            Parameter::Stop => match value {
                ParameterValue::Without => self.stop = None,
                ParameterValue::With if self.stop.is_some() => {}
                ParameterValue::With => return Err(nothing("no limit stop to take out or leave in")),
                _ => return Err(RecipeError::out_of_range("stop takes `with` or `without`")),
            },
            Parameter::StopLength => {
                self.stop.as_mut().ok_or_else(|| nothing("no limit stop"))?.length = Given::Stated(number()?);
            }
            _ => unreachable!("parameters of structure and excitation are set by Recipe::set"),
        }
        Ok(())
    }
}
