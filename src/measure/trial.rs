//! A case that is run by hand: for those who hold solvers, settings or effects against each other.

use super::energy::Energies;
use super::evaluate::rounded;
use super::reading::Reading;
use super::{Comparison, EvaluateError, Measure, Request, Subject};
use crate::dynamics::{HybridSystem, Options, Response};
use crate::measure::Settings;
use crate::scene::{Scene, compile};

/// A case, compiled, with the run without dampers that its measures compare with.
#[derive(Debug)]
pub struct Trial<'a> {
    settings: &'a Settings,
    mode: u32,
    comparison: Option<Comparison>,
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

impl<'a> Trial<'a> {
    /// Gets a case ready, of which the scene without dampers is known.
    ///
    /// # Errors
    /// [`EvaluateError`] with the reason.
    pub fn new(subject: Subject, settings: &'a Settings, measures: &[Measure]) -> Result<Self, EvaluateError> {
        let Subject { scene, undamped, comparison, mode } = subject;
        let undamped = undamped.ok_or(EvaluateError::NoRun(Measure::UndampedRmsVelocity))?;
        let scene = rounded(scene, settings);
        let mut measures: Vec<Measure> = measures.iter().copied().filter(|measure| measure.converges()).collect();
        if measures.is_empty() {
            measures.push(Measure::RmsVelocity);
        }
        let request = Request { measures: &measures, ..Request::default() };
        let bare = rounded(undamped, settings);
        let options = request.options(&scene, settings);
        let undamped_options = request.options(&bare, settings);
        let (system, undamped) = (compile(&scene)?, compile(&bare)?);
        Ok(Self { settings, mode, comparison, measures, scene, system, undamped, options, undamped_options })
    }

    /// The measures, in their order, of a run and its companion without dampers.
    ///
    /// # Errors
    /// [`EvaluateError`] with the reason.
    pub fn read(&self, response: &Response, undamped: &Response) -> Result<Vec<f64>, EvaluateError> {
        let energies = if self.measures.iter().any(|measure| measure.needs_energies()) {
            let starts = [&self.options.start, &self.undamped_options.start];
            Some(Energies::of(&self.scene, [response, undamped], starts, self.comparison, self.settings))
        } else {
            None
        };
        let reading = Reading {
            mode: self.mode,
            undamped: Some(undamped),
            given: self.settings.averaged(),
            energies: energies.as_ref(),
            ..Reading::of_run(&self.scene, response)
        };
        self.measures.iter().map(|measure| reading.read(*measure)).collect()
    }
}
