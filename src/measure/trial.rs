//! A case that is run by hand: for those who hold solvers, settings or effects against each other.

use super::energy::Energies;
use super::evaluate::rounded;
use super::reading::Reading;
use super::{EvaluateError, Measure, Request, Rigour};
use crate::dynamics::{HybridSystem, Options, Response};
use crate::measure::Settings;
use crate::scene::{Assumptions, Recipe, Scene, compile};

/// A case, compiled, with the run without dampers that its measures compare with.
#[derive(Debug)]
pub struct Trial<'a> {
    recipe: &'a Recipe,
    assumptions: &'a Assumptions,
    settings: &'a Settings,
    /// What is measured: of the measures asked for those that are continuous and read off the window; the RMS velocity if
    /// there are none.
    pub measures: Vec<Measure>,
    /// The scene.
    pub scene: Scene,
    /// What it compiles to.
    pub system: HybridSystem,
    /// The same without dampers.
    pub undamped: HybridSystem,
    /// How it is run.
    pub options: Options,
    /// How the same without dampers is run.
    pub undamped_options: Options,
}

impl Measure {
    /// A number that tends to its limit as a run gets more exact: no count, no difference that should be zero, no sample.
    fn converges(self) -> bool {
        !self.is_modal()
            && !self.needs_trace()
            && !self.needs_events()
            && !self.is_final()
            && !matches!(
                self,
                Self::FloorImpacts
                    | Self::CeilingImpacts
                    | Self::StopImpacts
                    | Self::Separations
                    | Self::Drift
                    | Self::HighestFrequency
                    | Self::ShortestPeriod
            )
    }
}

impl<'a> Trial<'a> {
    /// Gets a case ready.
    ///
    /// # Errors
    /// [`EvaluateError`] with the reason.
    pub fn new(
        recipe: &'a Recipe,
        assumptions: &'a Assumptions,
        settings: &'a Settings,
        measures: &[Measure],
    ) -> Result<Self, EvaluateError> {
        let scene = rounded(recipe.resolve(assumptions)?, settings);
        let mut measures: Vec<Measure> = measures.iter().copied().filter(|measure| measure.converges()).collect();
        if measures.is_empty() {
            measures.push(Measure::RmsVelocity);
        }
        let request =
            Request { measures: &measures, trace: None, energies: None, shape: None, rigour: Rigour::default() };
        let bare = rounded(recipe.resolve_undamped(assumptions)?, settings);
        let options = Options { start: recipe.start_state(&scene), ..request.options(settings) };
        let undamped_options = Options { start: recipe.start_state(&bare), ..options.clone() };
        let system = compile(&scene)?;
        let undamped = compile(&bare)?;
        Ok(Self { recipe, assumptions, settings, measures, scene, system, undamped, options, undamped_options })
    }

    /// The measures, in their order, of a run and its companion without dampers.
    ///
    /// # Errors
    /// [`EvaluateError`] with the reason.
    pub fn read(&self, response: &Response, undamped: &Response) -> Result<Vec<f64>, EvaluateError> {
        let energies = if self.measures.iter().any(|measure| measure.needs_energies()) {
            Some(Energies::of(&self.scene, response, undamped, self.assumptions, self.settings)?)
        } else {
            None
        };
        let reading = Reading {
            recipe: self.recipe,
            scene: &self.scene,
            response: Some(response),
            undamped: Some(undamped),
            history: None,
            skip: self.settings.skip,
            energies: energies.as_ref(),
            mac: None,
        };
        self.measures.iter().map(|measure| reading.read(*measure)).collect()
    }
}
