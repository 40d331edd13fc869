//! The validated experiment: meaning only. Comments, order of keys and `5 mm` against `0.005 m` leave it unchanged, so
//! a hash of its canonical JSON says whether an experiment means something new.

use std::collections::BTreeSet;

use serde::{Deserialize, Serialize};

use super::recipe::{
    AssumptionName, AssumptionSheet, AssumptionValue, Assumptions, Dependencies, Given, Parameter, ParameterValue,
    Recipe, RecipeError,
};
use crate::dynamics::Limit;
use crate::measure::{CycleSpec, EnergySpec, Measure, Needs, Settings, ShapeSpec, SolverChoice, Tolerance, TraceSpec};

use super::case::Case;
use super::continuation::Continuation;
use super::continued::{ContinuedSweep, chains};
use super::figure_spec::FigureSpec;
use super::id::ExperimentId;
use super::maximise::Maximise;
use super::optimise::Optimise;
use super::refined::Refinement;
use super::starts::Starts;
use super::stated::Unsourced;
use crate::scene::Scene;
use crate::text::json;

/// An experiment: what is simulated, measured and drawn.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Experiment {
    /// Id, from the file's name.
    pub id: ExperimentId,
    /// Title, as a reader would call it.
    pub title: String,
    /// Where a publication shows it.
    pub source: Source,
    /// One or two sentences: what is shown and how. Markdown.
    pub about: String,
    /// The scene, before the sweep.
    pub recipe: Recipe,
    /// The points of the sweep in the order of the table's rows; one empty case when nothing is swept.
    pub cases: Vec<Case>,
    /// Parameters in the order of the table's columns.
    pub swept: Vec<Parameter>,
    /// All solvers that some case runs under; see [`Experiment::runs`].
    pub solvers: Vec<SolverChoice>,
    /// How a case is run and averaged.
    pub settings: Settings,
    /// The cycles that are left out where an assumption says how many; `settings` then has its value in force.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub transient: Option<Transient>,
    /// The most that a row may take; no number depends on it.
    #[serde(default, skip_serializing_if = "is_usual")]
    pub limit: Limit,
    /// An inner maximisation over one more parameter: the row then holds the maximum and where it lies.
    pub maximise: Option<Maximise>,
    /// Sweeps whose curves get more points where they bend; the cases hold the points that they start with.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub refined: Vec<Refinement>,
    /// Sweeps whose rows start where the row before ended.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub continued: Vec<ContinuedSweep>,
    /// What every number is a mean over: settings of parameters that no column tells apart, such as force points. Empty as a
    /// rule. [`super::MeanRatio`] says what a velocity ratio then is.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub mean_over: Vec<Case>,
    /// An optimisation of gaps in the place of a sweep.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub optimise: Option<Optimise>,
    /// Branches of periodic motions in the place of a sweep; the one case is the scene that the first motion is taken from.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub orbit: Option<Continuation>,
    /// Random starts of every case: its rows are then the motions that they end in.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub starts: Option<Starts>,
    /// The assumptions that are moved for the sensitivity; `None` for all that the experiment depends on.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub moved: Option<BTreeSet<AssumptionName>>,
    /// Measures in the order of the columns.
    pub measures: Vec<Measure>,
    /// Time history to keep with each row.
    pub trace: Option<TraceSpec>,
    /// Kinetic energies to keep with each row.
    pub energies: Option<EnergySpec>,
    /// Shape to keep with each row.
    pub shape: Option<ShapeSpec>,
    /// Value of each cycle to keep with each row. At most one of the four is kept: the lists of a row are of one length.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub each_cycle: Option<CycleSpec>,
    /// How uncertain design parameters are.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub tolerances: Vec<Tolerance>,
    /// The figures; never part of what makes a simulation stale.
    pub figures: Vec<FigureSpec>,
    /// Inputs that neither the text of the study nor an assumption gives; none where no text is stated.
    #[serde(skip)]
    pub without_source: Vec<Unsourced>,
}

impl Experiment {
    /// Every run in the order of the table's rows: cases, and each under its solvers.
    pub fn runs(&self) -> impl Iterator<Item = (&Case, SolverChoice)> {
        self.cases.iter().flat_map(|case| case.solvers.iter().map(move |solver| (case, *solver)))
    }

    /// The cases of continued sweeps, chain by chain in the order in which they follow each other, by their index.
    pub(crate) fn chains(&self) -> Vec<Vec<usize>> {
        chains(&self.cases, &self.continued)
    }

    /// The scene of one case, still in the parameters of the file.
    ///
    /// # Errors
    /// Only for a case that is not this experiment's: validation has tried all of them.
    pub fn recipe_of(&self, case: &Case) -> Result<Recipe, RecipeError> {
        set(&self.recipe, case)
    }

    /// The scenes of one case that its numbers are means over; one as a rule.
    ///
    /// # Errors
    /// As [`Experiment::recipe_of`].
    pub fn recipes_of(&self, case: &Case) -> Result<Vec<Recipe>, RecipeError> {
        self.recipes_in(&self.recipe_of(case)?)
    }

    /// The same of a scene in which a case has been set already.
    ///
    /// # Errors
    /// As [`Experiment::recipe_of`].
    pub fn recipes_in(&self, recipe: &Recipe) -> Result<Vec<Recipe>, RecipeError> {
        let at = |point: &Case| set(recipe, point);
        if self.mean_over.is_empty() { Ok(vec![recipe.clone()]) } else { self.mean_over.iter().map(at).collect() }
    }

    /// The scene of a case, the first of several that a mean is taken over; they hardly differ in what they take.
    pub(crate) fn first_scene(&self, case: &Case, assumptions: &Assumptions) -> Option<Scene> {
        self.recipes_of(case).ok()?.first()?.resolve(assumptions).ok()
    }

    /// How a case is run and averaged under these assumptions.
    #[must_use]
    pub fn settings_under(&self, assumptions: &Assumptions) -> Settings {
        let left_out = self.transient.as_ref().and_then(|it| Some((it.left_out_under(assumptions)?, it.to)));
        left_out.map_or(self.settings, |(skip, to)| Settings { skip, average: to - skip, ..self.settings })
    }

    /// The assumptions that a number of this experiment may depend on, under the values in force or with one of them moved.
    #[must_use]
    pub fn assumptions_used(&self, sheet: &AssumptionSheet) -> BTreeSet<AssumptionName> {
        let in_force = sheet.assumptions();
        let mut used = self.assumptions_under(&in_force);
        for moved in sheet.variants(&used) {
            // Which assumptions are read depends on readings and on what is zero, never on how large a number is.
            let values = [&in_force, &moved.assumptions].map(|assumptions| assumptions.values.get(&moved.name));
            let branches = !matches!(values, [Some(AssumptionValue::Number(a)), Some(AssumptionValue::Number(b))] if *a != 0.0 && *b != 0.0);
            if branches {
                used.extend(self.assumptions_under(&moved.assumptions));
            }
        }
        used
    }

    /// The assumptions that a number of this experiment depends on under these values.
    #[must_use]
    pub fn assumptions_under(&self, in_force: &Assumptions) -> BTreeSet<AssumptionName> {
        let needs = self.needs();
        let mut used = self.assumptions_beside();
        // Thousands of cases differ in how large their quantities are, and in nothing that decides what is read.
        let mut read: Vec<Vec<(Parameter, ParameterValue)>> = Vec::new();
        let points = if self.mean_over.is_empty() { &[Case::default()] } else { &self.mean_over[..] };
        for (case, point) in self.cases.iter().flat_map(|case| points.iter().map(move |point| (case, point))) {
            let values = case.values.iter().chain(&point.values);
            let kind = || values.clone().map(|&(parameter, value)| (parameter, parameter.stand_in(value)));
            if read.iter().any(|known| known.iter().copied().eq(kind())) {
                continue;
            }
            let Ok(recipe) = self.recipe_of(case).and_then(|recipe| set(&recipe, point)) else { continue };
            let Dependencies { names, is_resolved } = recipe.dependencies(in_force, needs);
            used.extend(names);
            if is_resolved {
                read.push(kind().collect());
            }
        }
        used
    }

    /// The assumptions that a number depends on, in scenes in which a case has been set already: those that are read while
    /// the scenes are resolved for what is measured.
    #[must_use]
    pub fn assumptions_of(
        &self,
        scenes: impl IntoIterator<Item = Recipe>,
        in_force: &Assumptions,
    ) -> BTreeSet<AssumptionName> {
        let each = scenes.into_iter().flat_map(|scene| self.recipes_in(&scene).unwrap_or_default());
        let read = each.flat_map(|recipe| recipe.dependencies(in_force, self.needs()).names);
        read.chain(self.assumptions_beside()).collect()
    }

    /// Those that no scene reads: of the transient, and of the ratio of means.
    fn assumptions_beside(&self) -> BTreeSet<AssumptionName> {
        let left_out = self.transient.iter().map(|transient| transient.left_out.clone());
        let has_mean_ratio = !self.mean_over.is_empty() && self.measures.contains(&Measure::VelocityRatio);
        let mean_ratio = match &self.recipe.mean_ratio {
            Given::Assumed(name) if has_mean_ratio => Some(name.clone()),
            _ => None,
        };
        left_out.chain(mean_ratio).collect()
    }

    fn needs(&self) -> Needs {
        Needs::of(&self.measures, self.energies.is_some())
    }

    /// The whole meaning as JSON; equal meanings give equal JSON. Keys are sorted.
    #[must_use]
    pub fn canonical_json(&self) -> serde_json::Value {
        json::value(self)
    }

    /// What a simulation depends on: a changed title, caption or figure is not part of it.
    #[must_use]
    pub fn simulation_json(&self) -> serde_json::Value {
        // Every field is named: a new one is part of it or is not.
        let Self {
            recipe,
            cases,
            swept,
            settings,
            transient,
            maximise,
            refined,
            continued,
            mean_over,
            optimise,
            orbit,
            starts,
            measures,
            trace,
            energies,
            shape,
            each_cycle,
            tolerances,
            // What it is called, what is drawn of it, and how it is carried out; solvers stand in the cases.
            id: _,
            title: _,
            source: _,
            about: _,
            solvers: _,
            limit: _,
            moved: _,
            figures: _,
            without_source: _,
        } = self;
        let mut meaning = serde_json::json!({
            "recipe": json::value(recipe),
            "cases": json::value(cases),
            "swept": json::value(swept),
            "settings": json::value(settings),
            "maximise": json::value(maximise),
            "refined": json::value(refined),
            "measures": json::value(measures),
            "trace": json::value(trace),
            "energies": json::value(energies),
            "shape": json::value(shape),
        });
        // Absent where it is not asked for.
        let others = [
            ("transient", (transient.is_some(), json::value(transient))),
            ("mean_over", (!mean_over.is_empty(), json::value(mean_over))),
            ("continued", (!continued.is_empty(), json::value(continued))),
            ("each_cycle", (each_cycle.is_some(), json::value(each_cycle))),
            ("tolerances", (!tolerances.is_empty(), json::value(tolerances))),
            ("optimise", (optimise.is_some(), json::value(optimise))),
            ("orbit", (orbit.is_some(), json::value(orbit))),
            ("starts", (starts.is_some(), json::value(starts))),
        ];
        for (key, (is_asked_for, value)) in others {
            if is_asked_for {
                meaning[key] = value;
            }
        }
        meaning
    }
}

/// How many forcing cycles are left out, by an assumption, of those up to a given one.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct Transient {
    /// The assumption.
    pub left_out: AssumptionName,
    /// The last cycle that is averaged.
    pub to: u32,
}

impl Transient {
    /// The cycles that these values leave out; none if they have no whole number of cycles before the last one.
    #[must_use]
    pub fn left_out_under(&self, assumptions: &Assumptions) -> Option<u32> {
        self.cycles(assumptions.values.get(&self.left_out)?)
    }

    /// This many cycles, if they leave one to average.
    pub(super) fn cycles(&self, value: &AssumptionValue) -> Option<u32> {
        let AssumptionValue::Number(cycles) = *value else { return None };
        ((0.0..f64::from(self.to)).contains(&cycles) && cycles.fract() == 0.0).then_some(cycles as u32)
    }
}

fn is_usual(limit: &Limit) -> bool {
    *limit == Limit::default()
}

/// A scene with the values of a case.
fn set(recipe: &Recipe, case: &Case) -> Result<Recipe, RecipeError> {
    let mut recipe = recipe.clone();
    case.values.iter().try_for_each(|(parameter, value)| recipe.set(*parameter, *value))?;
    Ok(recipe)
}

/// Where a publication shows it; each part may be absent.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct Source {
    /// Number of the chapter.
    pub chapter: Option<u32>,
    /// `3.6.3`.
    pub section: Option<String>,
    /// `Fig. 18`, `Figs 20, 21`, `Table 2`, or a citation; as a reader would cite it.
    pub shown_in: Vec<String>,
}
