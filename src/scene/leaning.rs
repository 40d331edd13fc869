//! What a recipe leaves to the assumptions.

use std::collections::BTreeSet;

use super::recipe::{
    ContactDampingRecipe, DamperRecipe, ExcitationKind, GapRecipe, Given, ImpulseTime, MassReading, MassRecipe, Recipe,
    StiffnessRecipe, StrengthRecipe, SurfaceRecipe, TimingRecipe,
};
use super::structure::Family;
use super::{Assumption, AssumptionValue, Assumptions};

impl Recipe {
    /// The assumptions that this recipe leans on, given that a sweep has been applied. The readings in force matter: only
    /// an untuned floor asks what untuned means.
    #[must_use]
    pub fn assumptions(&self, in_force: &Assumptions) -> BTreeSet<Assumption> {
        let mut set = BTreeSet::new();
        let Ok(kind) = self.structure.kind() else { return set };
        set.extend(self.structure.assumed());
        if kind.family == Family::Mass {
            set.insert(Assumption::UndampedMass);
        }
        lean(&mut set, &self.gravity);
        for damper in self.dampers_in_place() {
            damper.lean(&mut set, kind.family, in_force);
        }
        self.lean_of_excitation(&mut set, kind.family);
        if self.observe.leans_on_grid(kind) {
            set.insert(Assumption::GridVelocity);
        }
        set
    }

    fn lean_of_excitation(&self, set: &mut BTreeSet<Assumption>, family: Family) {
        let excitation = &self.excitation;
        let harmonic = excitation.kind == ExcitationKind::Harmonic;
        if let StrengthRecipe::Force(force) = &excitation.strength {
            lean(set, force);
        }
        if let StrengthRecipe::Impulse(impulse) = &excitation.strength {
            lean(set, impulse);
        }
        if matches!(excitation.strength, StrengthRecipe::ForceRatio(_))
            && !harmonic
            && excitation.impulse_time == ImpulseTime::Assumed
        {
            match family {
                Family::Mass => set.extend([Assumption::ImpulseFactor, Assumption::ImpulseFrequency]),
                Family::Beam => set.extend([Assumption::BeamImpulseTime]),
                Family::Plate => set.extend([Assumption::PlateImpulseTime]),
            }
        }
        if family == Family::Mass && matches!(excitation.timing, TimingRecipe::FrequencyRatio(_)) {
            set.insert(if harmonic { Assumption::HarmonicReference } else { Assumption::ImpulseReference });
        }
    }
}

impl DamperRecipe {
    fn lean(&self, set: &mut BTreeSet<Assumption>, family: Family, in_force: &Assumptions) {
        let by_ratio = matches!(self.gap, GapRecipe::Ratio(_) | GapRecipe::Ratios(_));
        if family != Family::Mass {
            if by_ratio {
                set.extend(family.gap_frequency());
            }
            if matches!(self.mass, MassRecipe::Ratio(_)) {
                match self.mass_reading {
                    MassReading::Assumed => set.extend(family.damper_mass()),
                    MassReading::By(name) => drop(set.insert(name)),
                    MassReading::Total | MassReading::Modal => {}
                }
            }
        }
        if let Some(margin) = self.array.as_ref().and_then(|array| array.margin.as_ref()) {
            lean(set, margin);
        }
        for surface in [&self.floor, &self.ceiling] {
            if let SurfaceRecipe::Resilient { stiffness, damping, .. } = surface {
                match stiffness {
                    StiffnessRecipe::Ratio(given) => lean(set, given),
                    StiffnessRecipe::Untuned => drop(set.insert(Assumption::UntunedFrequencyRatio)),
                    StiffnessRecipe::Assumed | StiffnessRecipe::By(_) => {
                        let named =
                            if let StiffnessRecipe::By(by) = stiffness { Some(*by) } else { family.floor_tuning() };
                        set.extend(named);
                        let reading = named.and_then(|tuning| in_force.values.get(&tuning));
                        if matches!(reading, Some(AssumptionValue::Choice(word)) if word == "untuned") {
                            set.insert(Assumption::UntunedFrequencyRatio);
                        }
                    }
                    StiffnessRecipe::Stiffness(_) | StiffnessRecipe::Tuned => {}
                }
                match damping {
                    ContactDampingRecipe::Ratio(given) => {
                        lean(set, given);
                        if in_force.is_equivalent_viscous(*given) {
                            set.insert(Assumption::EquivalentDampingCurve);
                        }
                    }
                    ContactDampingRecipe::EquivalentViscous => drop(set.insert(Assumption::EquivalentDampingCurve)),
                    ContactDampingRecipe::Damping(_) => {}
                }
                if self.mass == MassRecipe::Ratio(0.0) && family == Family::Mass {
                    set.insert(Assumption::MasslessRatio);
                }
            }
        }
        if let Some(stop) = &self.stop {
            lean(set, &stop.length);
            lean(set, &stop.restitution);
        }
        if let Some(walls) = &self.walls {
            lean(set, &walls.ceiling_mass_ratio);
        }
    }
}

fn lean(set: &mut BTreeSet<Assumption>, given: &Given) {
    if let Given::Assumed(name) = given {
        set.insert(*name);
    }
}

impl Family {
    /// The assumption on floors whose stiffness is `assumed`.
    #[must_use]
    pub fn floor_tuning(self) -> Option<Assumption> {
        match self {
            Self::Mass => None,
            Self::Beam => Some(Assumption::BeamFloorTuning),
            Self::Plate => Some(Assumption::PlateFloorTuning),
        }
    }

    /// The assumption on what a mass ratio is a share of.
    #[must_use]
    pub fn damper_mass(self) -> Option<Assumption> {
        match self {
            Self::Mass => None,
            Self::Beam => Some(Assumption::BeamDamperMass),
            Self::Plate => Some(Assumption::PlateDamperMass),
        }
    }

    /// The assumption on the frequency in a gap ratio.
    #[must_use]
    pub fn gap_frequency(self) -> Option<Assumption> {
        match self {
            Self::Mass => None,
            Self::Beam => Some(Assumption::BeamGapFrequency),
            Self::Plate => Some(Assumption::PlateGapFrequency),
        }
    }

    /// The assumption on the damping ratio of floors and ceilings.
    #[must_use]
    pub fn contact_damping_ratio(self) -> Assumption {
        match self {
            Self::Mass => Assumption::ContactDampingRatio,
            Self::Beam => Assumption::BeamContactDampingRatio,
            Self::Plate => Assumption::PlateContactDampingRatio,
        }
    }

    /// The assumption on the floors of optimised arrays.
    #[must_use]
    pub fn array_floor_tuning(self) -> Option<Assumption> {
        match self {
            Self::Mass => None,
            Self::Beam => Some(Assumption::BeamArrayFloorTuning),
            Self::Plate => Some(Assumption::PlateArrayFloorTuning),
        }
    }

    /// The assumption on their damping ratio.
    #[must_use]
    pub fn array_damping_ratio(self) -> Option<Assumption> {
        match self {
            Self::Mass => None,
            Self::Beam => Some(Assumption::BeamArrayDampingRatio),
            Self::Plate => Some(Assumption::PlateArrayDampingRatio),
        }
    }

    /// The assumption on impulses whose size the text does not give, N s.
    #[must_use]
    pub fn impulse(self) -> Option<Assumption> {
        match self {
            Self::Mass => None,
            Self::Beam => Some(Assumption::BeamImpulse),
            Self::Plate => Some(Assumption::PlateImpulse),
        }
    }

    /// The assumption on the amplitude of a harmonic force, N.
    #[must_use]
    pub fn harmonic_force(self) -> Option<Assumption> {
        match self {
            Self::Mass => None,
            Self::Beam => Some(Assumption::BeamHarmonicForce),
            Self::Plate => Some(Assumption::PlateHarmonicForce),
        }
    }
}
