//! Recipe to scene: dimensionless parameters and assumptions become SI.
//!
//! Table 1 of the study defines m′ = mp/m, c′ = c/(2√(ks m)), h′ = h ωn²/g, f′ = F/(m g), ω′ = ω/ωn with ωn = √(ks/m); on beams and
//! plates m′ = (mp + ms)/m, and ωn is the first natural frequency of the clean structure.

use super::normal_modes::{add_square, normal_modes};
use super::place::{PlaceRecipe, Places};
use super::recipe::{
    ContactDampingRecipe, DamperRecipe, Filling, GapRecipe, MassReading, MassRecipe, ObserveRecipe, Part, PointsRecipe,
    Recipe, RecipeError, StiffnessRecipe, SurfaceRecipe, TimingRecipe,
};
use super::structure::{Family, Kind, Point, Structure};
use super::{
    Assumption, Assumptions, ContactDamping, ContactEnd, Damper, LimitStop, Observation, Scene, Surface, Take, Walls,
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
    pub(super) assumptions: &'a Assumptions,
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

impl Recipe {
    /// The dampers, unless they are taken out.
    pub(super) fn dampers_in_place(&self) -> &[DamperRecipe] {
        if self.without_dampers { &[] } else { &self.dampers }
    }

    /// The mode that is asked for, or forced; else the first.
    #[must_use]
    pub fn mode_number(&self) -> u32 {
        match (self.mode, self.excitation.timing) {
            (Some(mode), _) | (None, TimingRecipe::ForcedMode(mode)) => mode,
            _ => 1,
        }
    }

    /// The scene in SI units.
    ///
    /// # Errors
    /// An assumption that is absent, or a value that physics refuses (negative mass, gap below zero, …).
    pub fn resolve(&self, assumptions: &Assumptions) -> Result<Scene, RecipeError> {
        let kind = self.structure.kind()?;
        let structure = self.structure.build(assumptions)?;
        let gravity = assumptions.given(self.gravity)?;
        at_least("gravity", gravity, 0.0)?;
        let model = structure.model();
        let base = Base {
            kind,
            structure: &structure,
            mass: model.total_mass(),
            frequencies: model.natural_frequencies(),
            gravity,
            assumptions,
        };
        if self.mode_number() as usize > base.frequencies.len() + self.dampers.len() {
            let (mode, modes) = (self.mode_number(), base.frequencies.len());
            return Err(RecipeError::structure(format!("there is no mode {mode} in a model of {modes}")));
        }
        let places = Places::on(kind, model);
        let mut placed = Vec::new();
        for (index, damper) in self.dampers_in_place().iter().enumerate() {
            placed.extend(damper.place(&base, &places, index)?);
        }
        let loaded = base.loaded_frequency(&placed, &places);
        let dampers = placed
            .iter()
            .map(|damper| damper.resolve(&base, loaded).map_err(|error| error.within(damper.part)))
            .collect::<Result<Vec<_>, _>>()?;
        let particles: f64 = dampers.iter().map(|damper| damper.particle_mass + damper.enclosure_mass).sum();
        let excitation = self.excitation.resolve(&base, particles).map_err(|error| error.within(Part::Excitation))?;
        let silent = self.excitation.is_silent() && self.excitation.at.0.is_empty();
        let force_at = if silent { Point::default() } else { places.point(&self.excitation.at, Part::Excitation)? };
        let observed = self.observe.resolve(&base, &places)?;
        let scene = Scene { structure, gravity, dampers, excitation, force_at, observed };
        self.start.as_ref().map_or(Ok(()), |start| start.check(&scene))?;
        Ok(scene)
    }

    /// The scene of the run "without an impact damper": same excitation. A beam or plate is then clean; one mass is taken by
    /// [`Assumption::UndampedMass`].
    ///
    /// # Errors
    /// As [`Recipe::resolve`].
    pub fn resolve_undamped(&self, assumptions: &Assumptions) -> Result<Scene, RecipeError> {
        let mut scene = self.resolve(assumptions)?;
        if let Structure::SingleMass(base) = &mut scene.structure
            && assumptions.choice_or_first(Assumption::UndampedMass, &["base", "loaded"])? == 1
        {
            base.mass += scene.dampers.iter().map(|damper| damper.particle_mass + damper.enclosure_mass).sum::<f64>();
        }
        scene.dampers.clear();
        Ok(scene)
    }
}

impl Base<'_> {
    /// ω₁ of the clean structure.
    pub(super) fn natural(&self) -> f64 {
        self.frequencies.first().copied().unwrap_or(0.0)
    }

    /// First natural frequency with particles and enclosures fixed to the structure; nothing for one mass, which has words of
    /// its own for that.
    fn loaded_frequency(&self, placed: &[Placed<'_>], places: &Places<'_>) -> Option<f64> {
        if self.kind.family == Family::Mass {
            return None;
        }
        let matrices = self.structure.model().matrices();
        let mut mass = matrices.mass;
        for damper in placed {
            add_square(&mut mass, damper.particle_mass + damper.enclosure_mass, &places.shape(damper.at));
        }
        normal_modes(&mass, &matrices.stiffness).first().map(|mode| mode.frequency)
    }

    /// The clean frequency, or the loaded one where the assumption says so.
    fn clean_or_loaded(&self, loaded: Option<f64>, by: Option<Assumption>) -> Result<f64, RecipeError> {
        match loaded.zip(by) {
            Some((loaded, by)) if self.assumptions.choice(by, &["clean", "loaded"])? == 1 => Ok(loaded),
            _ => Ok(self.natural()),
        }
    }
}

impl DamperRecipe {
    fn place<'r>(&'r self, base: &Base<'_>, places: &Places<'_>, index: usize) -> Result<Vec<Placed<'r>>, RecipeError> {
        let part = Part::Damper(index);
        let margin = self.array.as_ref().and_then(|array| array.margin).map(|margin| base.assumptions.given(margin));
        let points = places.array(&self.at, self.array.as_ref(), margin.transpose()?.unwrap_or(0.0), part)?;
        let count = points.len() as f64;
        let whole = self.whole_mass(base).map_err(|error| error.within(part))?;
        if !(self.particle_share > 0.0 && self.particle_share <= 1.0) {
            let message = format!("particle_share lies above 0 and up to 1, not at {}", self.particle_share);
            return Err(RecipeError::Part { part, message });
        }
        let each = whole / count;
        let particle_mass = each * self.particle_share;
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
        let mass = match self.mass {
            MassRecipe::Ratio(ratio) if ratio == 0.0 && resilient && base.kind.family == Family::Mass => {
                base.assumptions.number(Assumption::MasslessRatio)? * base.mass
            }
            MassRecipe::Ratio(ratio) if base.kind.family == Family::Mass => ratio * base.mass,
            MassRecipe::Ratio(ratio) => ratio * self.reference_mass(base)?,
            MassRecipe::Mass(mass) => mass,
        };
        at_least("the particle's mass", mass, 0.0)?;
        if mass == 0.0 && resilient {
            return Err(RecipeError::OutOfRange(
                "a damper without mass on a beam or plate is none: write `dampers: without` in the sweep".into(),
            ));
        }
        Ok(mass)
    }

    fn reference_mass(&self, base: &Base<'_>) -> Result<f64, RecipeError> {
        const READINGS: &[&str] = &["total", "modal"];
        let modal = match self.mass_reading {
            MassReading::Total => false,
            MassReading::Modal => true,
            MassReading::By(by) => base.assumptions.choice(by, READINGS)? == 1,
            MassReading::Assumed => match base.kind.family.damper_mass() {
                Some(by) => base.assumptions.choice(by, READINGS)? == 1,
                None => false,
            },
        };
        Ok(if modal { base.structure.model().modal_mass() } else { base.mass })
    }
}

impl Placed<'_> {
    fn resolve(&self, base: &Base<'_>, loaded: Option<f64>) -> Result<Damper, RecipeError> {
        let Self { recipe, at, particle_mass, enclosure_mass, .. } = *self;
        let gap = self.gap(base, loaded)?;
        let surface = |recipe: &SurfaceRecipe| recipe.resolve(base, particle_mass, loaded);
        let stop = match &recipe.stop {
            None => None,
            Some(stop) => {
                let length = base.assumptions.given(stop.length)?;
                above("the limit stop's length", length, 0.0)?;
                Some(LimitStop { length, restitution: base.assumptions.given(stop.restitution)? })
            }
        };
        let walls = self.walls(base)?;
        let (floor, ceiling) = (surface(&recipe.floor)?, surface(&recipe.ceiling)?);
        Ok(Damper { at, particle_mass, enclosure_mass, gap, floor, ceiling, stop, walls })
    }

    fn gap(&self, base: &Base<'_>, loaded: Option<f64>) -> Result<f64, RecipeError> {
        let unit = || {
            let natural = base.clean_or_loaded(loaded, base.kind.family.gap_frequency())?;
            if natural == 0.0 {
                return Err(RecipeError::OutOfRange(
                    "a mass without spring has no natural frequency: write `gap` instead of `gap_ratio`".into(),
                ));
            }
            Ok::<_, RecipeError>((base.gravity, natural * natural))
        };
        let by_ratio = |ratio: f64| {
            let (gravity, square) = unit()?;
            Ok::<_, RecipeError>(ratio * gravity / square)
        };
        let each = |list: &[f64]| {
            list.get(self.index).copied().ok_or_else(|| {
                RecipeError::OutOfRange(format!("{} gaps are too few: one for each damper of the array", list.len()))
            })
        };
        let gap = match &self.recipe.gap {
            GapRecipe::Ratio(ratio) => by_ratio(*ratio)?,
            GapRecipe::Gap(gap) => *gap,
            GapRecipe::Ratios(ratios) => by_ratio(each(ratios)?)?,
            GapRecipe::Gaps(gaps) => each(gaps)?,
            GapRecipe::Filled { uniform, filling: Filling::Uniform, .. } => *uniform,
            GapRecipe::Filled { optimised, filling: Filling::Optimised, .. } => each(optimised)?,
            GapRecipe::Infinite => f64::INFINITY,
        };
        if gap.is_nan() || gap < 0.0 {
            return Err(RecipeError::OutOfRange(format!("a gap clearance cannot be {gap} m")));
        }
        Ok(gap)
    }

    fn walls(&self, base: &Base<'_>) -> Result<Option<Walls>, RecipeError> {
        let Some(walls) = &self.recipe.walls else { return Ok(None) };
        let Structure::SingleMass(mass) = base.structure else {
            return Err(RecipeError::OutOfRange("soft walls are modelled on a single mass alone".into()));
        };
        above("wall_stiffness_ratio", walls.stiffness_ratio, 0.0)?;
        let ceiling_mass = base.assumptions.given(walls.ceiling_mass_ratio)? * mass.mass;
        if !(ceiling_mass > 0.0 && ceiling_mass < mass.mass) {
            return Err(RecipeError::OutOfRange("the ceiling body's mass must lie between 0 and the base mass".into()));
        }
        Ok(Some(Walls { stiffness: walls.stiffness_ratio * mass.stiffness, damping: walls.damping, ceiling_mass }))
    }
}

impl SurfaceRecipe {
    fn resolve(&self, base: &Base<'_>, particle_mass: f64, loaded: Option<f64>) -> Result<Surface, RecipeError> {
        let assumptions = base.assumptions;
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
                let stiffness = stiffness.resolve(base, particle_mass, loaded)?;
                above("the surface's stiffness", stiffness, 0.0)?;
                let equivalent = || {
                    let curve = assumptions.curve(Assumption::EquivalentDampingCurve)?;
                    Ok::<_, RecipeError>(ContactDamping::EquivalentViscous(curve.clone()))
                };
                let damping = match damping {
                    ContactDampingRecipe::Ratio(given) if assumptions.is_equivalent_viscous(given) => equivalent()?,
                    ContactDampingRecipe::Ratio(given) => {
                        let ratio = assumptions.given(given)?;
                        at_least("contact_damping_ratio", ratio, 0.0)?;
                        ContactDamping::Constant(2.0 * ratio * (stiffness * particle_mass).sqrt())
                    }
                    ContactDampingRecipe::Damping(value) => {
                        at_least("the surface's damping", value, 0.0)?;
                        ContactDamping::Constant(value)
                    }
                    ContactDampingRecipe::EquivalentViscous => equivalent()?,
                };
                let ends = if no_tension { ContactEnd::ZeroForce } else { ContactEnd::ZeroGap };
                Ok(Surface::Resilient { stiffness, damping, ends })
            }
        }
    }
}

impl StiffnessRecipe {
    fn resolve(self, base: &Base<'_>, particle_mass: f64, loaded: Option<f64>) -> Result<f64, RecipeError> {
        let tuned = |omega: f64| Ok(particle_mass * omega * omega);
        let untuned = || tuned(base.natural() * base.assumptions.number(Assumption::UntunedFrequencyRatio)?);
        match (self, base.structure) {
            (Self::Ratio(given), Structure::SingleMass(mass)) => Ok(base.assumptions.given(given)? * mass.stiffness),
            (Self::Ratio(_), _) => Err(RecipeError::OutOfRange(format!(
                "stiffness_ratio compares with the spring of a single mass, and {} has none: write `stiffness: tuned`",
                base.kind.what
            ))),
            (Self::Stiffness(value), _) => Ok(value),
            (Self::Tuned, _) => tuned(base.natural()),
            (Self::Untuned, _) => untuned(),
            (Self::Assumed | Self::By(_), _) => {
                let named = if let Self::By(by) = self { Some(by) } else { base.kind.family.floor_tuning() };
                let Some(by) = named else {
                    return Err(RecipeError::OutOfRange("on a single mass write `stiffness_ratio: assumed`".into()));
                };
                if let Ok(stiffness) = base.assumptions.number(by) {
                    return Ok(stiffness);
                }
                match base.assumptions.choice(by, &["clean", "loaded", "untuned"])? {
                    0 => tuned(base.natural()),
                    1 => tuned(loaded.unwrap_or_else(|| base.natural())),
                    _ => untuned(),
                }
            }
        }
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
                return Err(RecipeError::Part { part: Part::Observe, message });
            }
        };
        let points = recipes.iter().map(|place| places.point(place, Part::Observe)).collect::<Result<Vec<_>, _>>()?;
        let take = match self.take {
            Some(take) => take,
            None if points.len() == 1 => Take::Largest,
            None if base.assumptions.choice_or_first(Assumption::GridVelocity, &["largest", "mean"])? == 1 => {
                Take::Mean
            }
            None => Take::Largest,
        };
        Ok(Observation { points, take })
    }

    /// More than one point, and the assumption decides what is made of them.
    pub(super) fn leans_on_grid(&self, kind: &Kind) -> bool {
        let several = match &self.points {
            PointsRecipe::Points(points) => points.len() > 1,
            PointsRecipe::Usual => kind.performance_point.is_none(),
            PointsRecipe::NinePointGrid => true,
        };
        several && self.take.is_none()
    }
}

impl RecipeError {
    /// Names the part of the scene, where nobody has.
    fn within(self, part: Part) -> Self {
        match self {
            Self::OutOfRange(message) => Self::Part { part, message },
            other => other,
        }
    }
}

pub(super) fn above(what: &str, value: f64, bound: f64) -> Result<(), RecipeError> {
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
