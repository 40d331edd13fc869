//! Recipe to scene: dimensionless parameters and assumptions become SI.
//!
//! m′ = mp/m, c′ = c/(2√(ks m)), h′ = h ωn²/g, f′ = F/(m g), ω′ = ω/ωn with ωn = √(ks/m); on beams and plates m′ = (mp + ms)/m, and
//! ωn is the first natural frequency of the clean structure. Every slot is read through [`Inputs`], when and only when the scene
//! needs it: so the record of what was read is what the scene depends on.

use std::cell::LazyCell;
use std::collections::BTreeSet;

use super::assumption::AssumptionName;
use super::assumption_sheet::Assumptions;
use super::error::RecipeError;
use super::given::{Given, Inputs};
use super::part::Part;
use super::parts::{
    Carried, ContactDampingConstant, ContactDampingRatio, ContactDampingRecipe, DamperRecipe, Filling, FloorStiffness,
    GapRecipe, MassReading, MassRecipe, MeanRatio, ObserveRecipe, PointsRecipe, Recipe, Reference, StiffnessRecipe,
    StopRecipe, SurfaceRecipe, TimingRecipe,
};
use super::place::{PlaceRecipe, Places};
use super::slot::Slot;
use crate::measure::{Needs, Subject};
use crate::scene::{
    ContactDamping, ContactEnd, Damper, Kind, LimitStop, Observation, Point, Scene, Start, Structure, Surface, Take,
    Walls, normal_modes,
};

/// What the parts of a recipe refer to.
pub(super) struct Base<'a> {
    pub(super) kind: &'static Kind,
    pub(super) structure: &'a Structure,
    /// Mass of the whole, kg.
    pub(super) mass: f64,
    /// Natural frequencies of the clean structure, rad/s.
    pub(super) frequencies: Vec<f64>,
    pub(super) gravity: f64,
    pub(super) inputs: &'a Inputs<'a>,
}

/// A damper as far as its mass and place.
struct Placed<'r> {
    recipe: &'r DamperRecipe,
    part: Part,
    /// Its place in its array.
    index: usize,
    at: Point,
    particle_mass: f64,
    enclosure_mass: f64,
}

/// The assumptions that were read while a scene was resolved.
#[derive(Debug)]
pub(in crate::experiment) struct Dependencies {
    pub(in crate::experiment) names: BTreeSet<AssumptionName>,
    /// To the end: nothing was refused.
    pub(in crate::experiment) is_resolved: bool,
}

impl Recipe {
    /// The dampers, unless they are taken out.
    fn dampers_in_place(&self) -> &[DamperRecipe] {
        if self.without_dampers { &[] } else { &self.dampers }
    }

    /// The mode that is asked for, or forced; else the first.
    #[must_use]
    pub fn mode_number(&self) -> u32 {
        match (self.mode, &self.excitation.timing) {
            (Some(mode), _) | (None, &TimingRecipe::ForcedMode(mode)) => mode,
            _ => 1,
        }
    }

    /// The scene in SI units.
    ///
    /// # Errors
    /// An assumption that is absent, or a value that physics refuses (negative mass, gap below zero, …).
    pub fn resolve(&self, assumptions: &Assumptions) -> Result<Scene, RecipeError> {
        self.scene(&Inputs::new(assumptions))
    }

    /// All that a measurement may take of it: the scene, the same without dampers, and how it is read.
    ///
    /// # Errors
    /// As [`Recipe::resolve`].
    pub fn subject(&self, assumptions: &Assumptions, needs: Needs) -> Result<Subject, RecipeError> {
        self.read_subject(&Inputs::new(assumptions), needs)
    }

    /// What the velocity ratio is of several such scenes.
    ///
    /// # Errors
    /// An assumption that is absent.
    pub fn mean_ratio_under(&self, assumptions: &Assumptions) -> Result<MeanRatio, RecipeError> {
        Inputs::new(assumptions).get(&self.mean_ratio)
    }

    /// The assumptions that such a measurement depends on: those that are read while it is resolved.
    pub(in crate::experiment) fn dependencies(&self, assumptions: &Assumptions, needs: Needs) -> Dependencies {
        let inputs = Inputs::new(assumptions);
        // What physics refuses has been reported when the file was read; what was read until then counts.
        let is_resolved = self.read_subject(&inputs, needs).is_ok();
        Dependencies { names: inputs.read(), is_resolved }
    }

    fn read_subject(&self, inputs: &Inputs<'_>, needs: Needs) -> Result<Subject, RecipeError> {
        let scene = self.scene(inputs)?;
        let undamped = if needs.undamped { Some(self.without_dampers(&scene, inputs)?) } else { None };
        let comparison = if needs.comparison { Some(inputs.get(&self.mass_measure)?) } else { None };
        Ok(Subject { scene, undamped, comparison, mode: self.mode_number() })
    }

    fn scene(&self, inputs: &Inputs<'_>) -> Result<Scene, RecipeError> {
        let kind = self.structure.kind()?;
        let structure = self.structure.build(inputs)?;
        let gravity = inputs.get(&self.gravity)?;
        at_least("gravity", gravity, 0.0).map_err(|error| error.at_keys(&["gravity"]))?;
        let model = structure.model();
        let base = Base {
            kind,
            structure: &structure,
            mass: model.total_mass(),
            frequencies: model.natural_frequencies(),
            gravity,
            inputs,
        };
        if self.mode_number() as usize > base.frequencies.len() + self.dampers.len() {
            let (mode, modes) = (self.mode_number(), base.frequencies.len());
            let message = format!("there is no mode {mode} in a model of {modes}");
            return Err(RecipeError::out_of_range(message).at_keys(&["mode", "forced_mode"]));
        }
        let places = Places::on(kind, model, inputs);
        let mut placed = Vec::new();
        for (index, damper) in self.dampers_in_place().iter().enumerate() {
            placed.extend(damper.place(&base, &places, index)?);
        }
        let loaded = LazyCell::new(|| base.loaded_frequency(&placed, &places));
        let reference = |reference| match reference {
            Reference::Clean => base.natural(),
            Reference::Loaded => *loaded,
        };
        let dampers = placed
            .iter()
            .map(|damper| damper.resolve(&base, &reference).map_err(|error| error.within(damper.part)))
            .collect::<Result<Vec<_>, _>>()?;
        let particles: f64 = dampers.iter().map(|damper| damper.particle_mass + damper.enclosure_mass).sum();
        let excitation = self.excitation.resolve(&base, particles).map_err(|error| error.within(Part::Excitation))?;
        let silent = self.excitation.is_silent() && self.excitation.at.0.is_empty();
        let force_at = if silent { Point::default() } else { places.point(&self.excitation.at, Part::Excitation)? };
        let observed = self.observe.resolve(&base, &places)?;
        let still = |part, what| RecipeError::Still { part, what, structure: kind.what };
        if !self.excitation.is_silent() && !places.moves(force_at) {
            return Err(still(Part::Excitation, "the force"));
        }
        if !observed.points.iter().any(|point| places.moves(*point)) {
            return Err(still(Part::Observe, "the observed point"));
        }
        let start = self.start.clone().map(|start| if self.without_dampers { start.of_structure() } else { start });
        let scene = Scene { structure, gravity, dampers, excitation, force_at, observed, start };
        scene.check_start()?;
        Ok(scene)
    }

    /// The scene of the run without dampers: same excitation. A beam or plate is then clean; one mass weighs what
    /// `undamped_mass` says.
    fn without_dampers(&self, scene: &Scene, inputs: &Inputs<'_>) -> Result<Scene, RecipeError> {
        let mut scene = scene.clone();
        if let Structure::SingleMass(base) = &mut scene.structure
            && inputs.get(&self.undamped_mass)? == Carried::Loaded
        {
            base.mass += scene.dampers.iter().map(|damper| damper.particle_mass + damper.enclosure_mass).sum::<f64>();
        }
        scene.dampers.clear();
        scene.start = scene.start.map(Start::of_structure);
        Ok(scene)
    }
}

impl StopRecipe {
    /// In SI units.
    ///
    /// # Errors
    /// As [`Recipe::resolve`].
    pub fn resolve(&self, assumptions: &Assumptions) -> Result<LimitStop, RecipeError> {
        self.read(&Inputs::new(assumptions))
    }

    fn read(&self, inputs: &Inputs<'_>) -> Result<LimitStop, RecipeError> {
        let length = inputs.get(&self.length)?;
        above("the limit stop's length", length, 0.0).map_err(|error| error.at_keys(&["length", "stop_length"]))?;
        let restitution = coefficient(inputs.get(&self.restitution)?)?;
        Ok(LimitStop { length, restitution })
    }
}

/// Frequency of the structure without its dampers, or with them, rad/s.
type FrequencyOf<'a> = dyn Fn(Reference) -> f64 + 'a;

impl Base<'_> {
    /// ω₁ of the clean structure.
    pub(super) fn natural(&self) -> f64 {
        self.frequencies.first().copied().unwrap_or(0.0)
    }

    /// Why nothing can be stated in units of ω₁, and what to write instead.
    pub(super) fn without_frequency(&self, instead: &str) -> RecipeError {
        RecipeError::out_of_range(if self.kind.is_lumped() {
            format!("a mass without spring has no natural frequency: {instead}")
        } else {
            "the first natural frequency of this structure comes out as zero: look at its dimensions, Young's modulus and \
             density"
                .into()
        })
    }

    /// First natural frequency with particles and enclosures fixed to the structure. One mass has words of its own for that.
    fn loaded_frequency(&self, placed: &[Placed<'_>], places: &Places<'_>) -> f64 {
        if self.kind.is_lumped() {
            return self.natural();
        }
        let matrices = self.structure.model().matrices();
        let mut mass = matrices.mass;
        for damper in placed {
            mass.add_square(damper.particle_mass + damper.enclosure_mass, &places.shape(damper.at));
        }
        normal_modes(&mass, &matrices.stiffness).first().map_or_else(|| self.natural(), |mode| mode.frequency)
    }
}

impl DamperRecipe {
    fn place<'r>(&'r self, base: &Base<'_>, places: &Places<'_>, index: usize) -> Result<Vec<Placed<'r>>, RecipeError> {
        let part = Part::Damper(index);
        let margin = self.array.as_ref().and_then(|array| array.margin.as_ref()).map(|margin| base.inputs.get(margin));
        let points = places.array(&self.at, self.array.as_ref(), margin.transpose()?.unwrap_or(0.0), part)?;
        let count = points.len() as f64;
        let whole = self.whole_mass(base).map_err(|error| error.within(part).at_keys(&["mass_ratio", "mass"]))?;
        let share = base.inputs.get(&self.particle_share)?;
        if !(share > 0.0 && share <= 1.0) {
            let message = format!("particle_share lies above 0 and up to 1, not at {share}");
            return Err(RecipeError::out_of_range(message).within(part).at_keys(&["particle_share"]));
        }
        let each = whole / count;
        let particle_mass = each * share;
        Ok(points
            .into_iter()
            .enumerate()
            .map(|(index, at)| Placed {
                recipe: self,
                part,
                index,
                at,
                particle_mass,
                enclosure_mass: each - particle_mass,
            })
            .collect())
    }

    /// Particles and enclosures together, kg.
    fn whole_mass(&self, base: &Base<'_>) -> Result<f64, RecipeError> {
        let resilient = [&self.floor, &self.ceiling].iter().any(|s| matches!(s, SurfaceRecipe::Resilient { .. }));
        let inputs = base.inputs;
        let mass = match &self.mass {
            MassRecipe::Ratio(ratio) => match inputs.get(ratio)? {
                ratio if base.kind.is_lumped() => {
                    let needs = "a particle without mass cannot press into a resilient surface: give the damper a \
                                 mass_ratio above 0, or";
                    let massless = resilient && ratio == 0.0;
                    let ratio = if massless {
                        inputs.needed(self.massless_ratio.as_ref(), Slot::MasslessRatio, needs)?
                    } else {
                        ratio
                    };
                    ratio * base.mass
                }
                ratio => ratio * self.reference_mass(base)?,
            },
            MassRecipe::Mass(mass) => inputs.get(mass)?,
        };
        at_least("the particle's mass", mass, 0.0)?;
        if mass == 0.0 && resilient {
            let needs = if base.kind.is_lumped() {
                "a particle without mass cannot press into a resilient surface: give it a mass, however small"
            } else {
                "a damper without mass on a beam or plate is none: write `dampers: without` in the sweep"
            };
            return Err(RecipeError::out_of_range(needs));
        }
        Ok(mass)
    }

    fn reference_mass(&self, base: &Base<'_>) -> Result<f64, RecipeError> {
        Ok(match base.inputs.get(&self.mass_reading)? {
            MassReading::Total => base.mass,
            MassReading::Modal => base.structure.model().modal_mass(),
            MassReading::Share(share) => share * base.mass,
        })
    }
}

impl Placed<'_> {
    fn resolve(&self, base: &Base<'_>, frequency: &FrequencyOf<'_>) -> Result<Damper, RecipeError> {
        let Self { recipe, at, particle_mass, enclosure_mass, .. } = *self;
        let gap = self.gap(base, frequency).map_err(|error| error.at_keys(&["gap_ratio", "gap", "filling"]))?;
        let stop = recipe.stop.as_ref().map(|stop| stop.read(base.inputs)).transpose();
        let stop = stop.map_err(|error| error.under("stop"))?;
        let walls = self.walls(base).map_err(|error| error.under("walls"))?;
        let surface = |recipe: &SurfaceRecipe, key: &'static str| {
            recipe.resolve(base, particle_mass, frequency).map_err(|error| error.under(key))
        };
        let (floor, ceiling) = (surface(&recipe.floor, "floor")?, surface(&recipe.ceiling, "ceiling")?);
        Ok(Damper { at, particle_mass, enclosure_mass, gap, floor, ceiling, stop, walls })
    }

    fn gap(&self, base: &Base<'_>, frequency: &FrequencyOf<'_>) -> Result<f64, RecipeError> {
        let inputs = base.inputs;
        let by_ratio = |ratio: f64| {
            let natural = match base.kind.is_lumped() {
                true => base.natural(),
                false => frequency(inputs.get(&self.recipe.gap_frequency)?),
            };
            if natural == 0.0 {
                return Err(base.without_frequency("write `gap` instead of `gap_ratio`"));
            }
            Ok::<_, RecipeError>(ratio * base.gravity / (natural * natural))
        };
        let each = |list: &[f64]| {
            list.get(self.index).copied().ok_or_else(|| {
                RecipeError::out_of_range(format!("{} gaps are too few: one for each damper of the array", list.len()))
            })
        };
        let gap = match &self.recipe.gap {
            GapRecipe::Ratio(ratio) => by_ratio(inputs.get(ratio)?)?,
            GapRecipe::Gap(gap) => inputs.get(gap)?,
            GapRecipe::Ratios(ratios) => by_ratio(each(ratios)?)?,
            GapRecipe::Gaps(gaps) => each(gaps)?,
            GapRecipe::Filled { uniform, filling: Filling::Uniform, .. } => inputs.get(uniform)?,
            GapRecipe::Filled { optimised, filling: Filling::Optimised, .. } => each(optimised)?,
            GapRecipe::Infinite => f64::INFINITY,
        };
        if gap.is_nan() || gap < 0.0 {
            return Err(RecipeError::out_of_range(format!("a gap clearance cannot be {gap} m")));
        }
        Ok(gap)
    }

    fn walls(&self, base: &Base<'_>) -> Result<Option<Walls>, RecipeError> {
        let Some(walls) = &self.recipe.walls else { return Ok(None) };
        let Structure::SingleMass(mass) = base.structure else {
            return Err(RecipeError::out_of_range("soft walls are modelled on a single mass alone"));
        };
        let inputs = base.inputs;
        let stiffness_ratio = inputs.get(&walls.stiffness_ratio)?;
        above("wall_stiffness_ratio", stiffness_ratio, 0.0)
            .map_err(|error| error.at_keys(&["stiffness_ratio", "wall_stiffness_ratio"]))?;
        let share = inputs.needed(walls.ceiling_mass_ratio.as_ref(), Slot::CeilingMassRatio, "soft walls need")?;
        let ceiling_mass = share * mass.mass;
        if !(ceiling_mass > 0.0 && ceiling_mass < mass.mass) {
            let message = "the ceiling body's mass must lie between 0 and the base mass";
            return Err(RecipeError::out_of_range(message).at_keys(&["ceiling_mass_ratio"]));
        }
        let stiffness = stiffness_ratio * mass.stiffness;
        Ok(Some(Walls { stiffness, damping: inputs.get(&walls.damping)?, ceiling_mass }))
    }
}

impl SurfaceRecipe {
    fn resolve(
        &self,
        base: &Base<'_>,
        particle_mass: f64,
        frequency: &FrequencyOf<'_>,
    ) -> Result<Surface, RecipeError> {
        let inputs = base.inputs;
        match self {
            Self::Rigid { restitution } => Ok(Surface::Rigid { restitution: coefficient(inputs.get(restitution)?)? }),
            Self::Resilient { stiffness, untuned_ratio, damping, damping_curve, no_tension } => {
                let stiffness = stiffness
                    .resolve(base, particle_mass, frequency, untuned_ratio.as_ref())
                    .and_then(|stiffness| above("the surface's stiffness", stiffness, 0.0).map(|()| stiffness))
                    .map_err(|error| {
                        error.at_keys(&["stiffness_ratio", "stiffness", "floor_stiffness_ratio", "floor_tuning"])
                    })?;
                let by_half_cycles = || {
                    let needs = "equivalent viscous damping needs";
                    let curve = inputs.needed(damping_curve.as_ref(), Slot::DampingCurve, needs)?;
                    Ok::<_, RecipeError>(ContactDamping::EquivalentViscous(curve))
                };
                let damping = match damping {
                    ContactDampingRecipe::Damping(given) => match inputs.get(given)? {
                        ContactDampingConstant::Constant(value) => {
                            at_least("the surface's damping", value, 0.0)
                                .map_err(|error| error.at_keys(&["damping"]))?;
                            ContactDamping::Constant(value)
                        }
                        ContactDampingConstant::EquivalentViscous => by_half_cycles()?,
                    },
                    ContactDampingRecipe::Ratio(given) => match inputs.get(given)? {
                        ContactDampingRatio::Ratio(ratio) => {
                            at_least("contact_damping_ratio", ratio, 0.0)
                                .map_err(|error| error.at_keys(&["damping_ratio", "contact_damping_ratio"]))?;
                            ContactDamping::Constant(2.0 * ratio * (stiffness * particle_mass).sqrt())
                        }
                        ContactDampingRatio::EquivalentViscous => by_half_cycles()?,
                    },
                };
                let ends = if *no_tension { ContactEnd::ZeroForce } else { ContactEnd::ZeroGap };
                Ok(Surface::Resilient { stiffness, damping, ends })
            }
        }
    }
}

impl StiffnessRecipe {
    fn resolve(
        &self,
        base: &Base<'_>,
        particle_mass: f64,
        frequency: &FrequencyOf<'_>,
        untuned_ratio: Option<&Given>,
    ) -> Result<f64, RecipeError> {
        let inputs = base.inputs;
        let tuned = |omega: f64| particle_mass * omega * omega;
        Ok(match (self, base.structure) {
            (Self::Ratio(given), Structure::SingleMass(mass)) => inputs.get(given)? * mass.stiffness,
            (Self::Ratio(_), _) => {
                return Err(RecipeError::out_of_range(format!(
                    "stiffness_ratio compares with the spring of a single mass, and {} has none: write `stiffness: tuned`",
                    base.kind.what
                )));
            }
            (Self::By(given), _) => match inputs.get(given)? {
                FloorStiffness::Stiffness(value) => value,
                FloorStiffness::Clean => tuned(base.natural()),
                FloorStiffness::Loaded => tuned(frequency(Reference::Loaded)),
                FloorStiffness::Untuned => {
                    let needs = "an untuned surface needs";
                    let ratio = inputs.needed(untuned_ratio, Slot::UntunedFrequencyRatio, needs)?;
                    above("untuned_frequency_ratio", ratio, 0.0)
                        .map_err(|error| error.at_keys(&["untuned_frequency_ratio"]))?;
                    tuned(base.natural() * ratio)
                }
            },
        })
    }
}

impl ObserveRecipe {
    fn resolve(&self, base: &Base<'_>, places: &Places<'_>) -> Result<Observation, RecipeError> {
        let quarters = [0.25, 0.5, 0.75];
        let grid = || quarters.iter().flat_map(|x| quarters.iter().map(|y| PlaceRecipe::at_shares(&[*x, *y])));
        let recipes: Vec<PlaceRecipe> = match (&self.points, base.kind.performance_point) {
            (PointsRecipe::Points(points), _) => points.clone(),
            (PointsRecipe::Usual, Some(point)) => vec![PlaceRecipe::at_shares(point)],
            (PointsRecipe::Usual, None) => grid().collect(),
            (PointsRecipe::NinePointGrid, _) if base.kind.sides.len() == 2 => grid().collect(),
            (PointsRecipe::NinePointGrid, _) => {
                let message = format!("{} has no nine-point grid, which quarters two sides", base.kind.what);
                return Err(RecipeError::out_of_range(message).within(Part::Observe));
            }
        };
        let points = recipes.iter().map(|place| places.point(place, Part::Observe)).collect::<Result<Vec<_>, _>>()?;
        let take = match &self.take {
            Given::Assumed(_) if points.len() == 1 => Take::Largest,
            given => base.inputs.get(given)?,
        };
        Ok(Observation { points, take })
    }
}

pub(super) fn above(what: &str, value: f64, bound: f64) -> Result<(), RecipeError> {
    if value > bound && value.is_finite() {
        Ok(())
    } else {
        Err(RecipeError::out_of_range(format!("{what} must be above {bound}, not {value}")))
    }
}

fn at_least(what: &str, value: f64, bound: f64) -> Result<(), RecipeError> {
    if value >= bound && value.is_finite() {
        Ok(())
    } else {
        Err(RecipeError::out_of_range(format!("{what} must be {bound} or more, not {value}")))
    }
}

/// A coefficient of restitution.
fn coefficient(restitution: f64) -> Result<f64, RecipeError> {
    if (0.0..=1.0).contains(&restitution) {
        return Ok(restitution);
    }
    let message = format!("restitution lies between 0 and 1, not at {restitution}");
    Err(RecipeError::out_of_range(message).at_keys(&["restitution"]))
}
