//! Where runs of one scene end that start in different places, and which of these ends are the same motion.
//!
//! A run ends where it has settled, and its state is then known to lie within the settling tolerance of an orbit; two runs end in one
//! motion if their states agree to that tolerance, be it some cycles later. What does not come again has no such state: it is one kind
//! for all starts, by its exponent.

use super::reading::Reading;
use super::{EvaluateError, Request, rounded};
use crate::dynamics::{Averaged, HybridSystem, Motion, Options, Until, event_driven};
use crate::measure::Settings;
use crate::scene::{Scene, Start, compile};

/// A scene that is run from many starts: compiled once.
pub struct FromStarts {
    scene: Scene,
    system: HybridSystem,
    options: Options,
}

/// What became of a start.
#[derive(Debug, Clone, PartialEq)]
pub struct Ending {
    /// The motion that it ends in.
    pub motion: Motion,
    /// RMS velocity of the structure: over the period in which the run has settled, else over the cycles given.
    pub rms_velocity: f64,
    /// That period, if it has; a motion may come again before a run is as near to it as that.
    pub settled: Option<Averaged>,
}

impl FromStarts {
    /// Gets a scene ready.
    ///
    /// # Errors
    /// [`EvaluateError`] if it has no model.
    pub fn new(scene: Scene, settings: &Settings) -> Result<Self, EvaluateError> {
        let scene = rounded(scene, settings);
        let system = compile(&scene)?;
        let plain = Request::default().options(&scene, settings);
        let options = Options { until: Until::Settled, motion: true, displacement: false, ..plain };
        Ok(Self { scene, system, options })
    }

    /// The scene, from which starts are drawn.
    #[must_use]
    pub fn scene(&self) -> &Scene {
        &self.scene
    }

    /// Runs it from a start until it has settled, or as long as the cycles given.
    ///
    /// # Errors
    /// [`EvaluateError`] with the reason.
    pub fn run(&self, start: Start) -> Result<Ending, EvaluateError> {
        let scene = Scene { start: Some(start), ..self.scene.clone() };
        let response = event_driven(&self.system, &Options { start: scene.start_state(), ..self.options.clone() })?;
        let rms_velocity = Reading::of_run(&scene, &response).rms_velocity(&response);
        let motion = response.motion.unwrap_or_else(|| unreachable!("it was asked for"));
        Ok(Ending { motion, rms_velocity, settled: response.settled })
    }
}

impl Ending {
    fn is(&self, other: &Self) -> bool {
        match (&self.motion.recurring, &other.motion.recurring) {
            (Some(own), Some(other)) => own.is(other),
            (None, None) => self.motion.kind == other.motion.kind,
            _ => false,
        }
    }

    /// Cycles after which the run has settled; what has not settled comes last.
    #[must_use]
    pub fn settled_after(&self) -> u64 {
        self.settled.map_or(u64::MAX, Averaged::end)
    }

    /// The starts that end in one motion each, by their number; the motions in the order in which they were first met.
    #[must_use]
    pub fn basins(endings: &[Self]) -> Vec<Vec<usize>> {
        let mut basins: Vec<Vec<usize>> = Vec::new();
        for (number, ending) in endings.iter().enumerate() {
            match basins.iter_mut().find(|basin| ending.is(&endings[basin[0]])) {
                Some(basin) => basin.push(number),
                None => basins.push(vec![number]),
            }
        }
        basins
    }
}
