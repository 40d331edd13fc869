//! What is measured: a scene, what it is compared with, and how it is read.

use serde::{Deserialize, Serialize};

use super::Measure;
use crate::scene::Scene;

/// A scene to be measured.
#[derive(Debug, Clone, PartialEq)]
pub struct Subject {
    /// The scene.
    pub scene: Scene,
    /// The same without dampers, where it is needed.
    pub undamped: Option<Scene>,
    /// How the mass measure compares energies, where it is needed.
    pub comparison: Option<Comparison>,
    /// Which mode natural frequencies and mode shapes are of, from 1.
    pub mode: u32,
}

/// How the mass measure compares kinetic energies with those of the clean structure.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Comparison {
    /// The jumps of T at the impulse.
    Jump,
    /// T just after it.
    After,
    /// The jump of T with dampers, over T just before it without.
    Level,
}

/// What measures need of a subject beside its scene.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Needs {
    /// The scene without dampers.
    pub undamped: bool,
    /// The comparison of energies.
    pub comparison: bool,
}

impl Needs {
    /// Of these measures, and of lists of kinetic energies if they are kept.
    #[must_use]
    pub fn of(measures: &[Measure], energies: bool) -> Self {
        Self {
            undamped: energies || measures.iter().any(|measure| measure.needs_undamped()),
            comparison: energies || measures.contains(&Measure::MassMeasure),
        }
    }
}
