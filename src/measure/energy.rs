//! Kinetic energies of the structure at the impulses, and the two measures made of them.
//!
//! T is the kinetic energy of the structure alone, without enclosures and particles. The damping measure of a cycle is what T has
//! lost from just after the impulse that opens it to just before the next, relative to the former. The mass measure
//! compares T at the impulse with that of the clean structure, in one of three ways ([`Comparison`]):
//!
//! - `jump`: the jumps of T at the impulse;
//! - `after`: T just after it;
//! - `level`: the jump of T with dampers, over T just before it without.
//!
//! A point impulse gives each mode the same share, so that T just after it grows with the number of modes without limit:
//! these measures mean something together with that number only.

use super::Comparison;
use crate::dynamics::{CycleRates, Matrix, Response, StartState};
use crate::measure::Settings;
use crate::scene::Scene;

/// Kinetic energies of every cycle, J.
pub(super) struct Energies {
    pub(super) with: Vec<Ends>,
    pub(super) without: Vec<Ends>,
    /// Kinetic energy where each of the two starts, J.
    started: [f64; 2],
    comparison: Option<Comparison>,
    averaged: std::ops::Range<usize>,
}

/// Kinetic energy at the ends of a cycle, J.
#[derive(Debug, Clone, Copy)]
pub(super) struct Ends {
    pub(super) after: f64,
    pub(super) before: f64,
}

impl Energies {
    pub(super) fn of(
        scene: &Scene,
        [response, undamped]: [&Response; 2],
        starts: [&StartState; 2],
        comparison: Option<Comparison>,
        settings: &Settings,
    ) -> Self {
        let mass = scene.structure.model().matrices().mass;
        let skip = settings.skip as usize;
        Self {
            with: ends(&mass, response),
            without: ends(&mass, undamped),
            started: starts.map(|start| match start {
                StartState::StaticEquilibrium => 0.0,
                StartState::Given { rate, .. } => energy(&mass, rate),
            }),
            comparison,
            averaged: skip..skip + settings.average as usize,
        }
    }

    /// Mean over the averaged cycles.
    pub(super) fn damping_measure(&self) -> f64 {
        self.mean(|cycle| self.damping_of(cycle))
    }

    /// Mean over the averaged cycles.
    pub(super) fn mass_measure(&self) -> f64 {
        self.mean(|cycle| self.mass_of(cycle))
    }

    fn mean(&self, of: impl Fn(usize) -> f64) -> f64 {
        let count = self.averaged.len() as f64;
        self.averaged.clone().map(of).sum::<f64>() / count
    }

    pub(super) fn damping_of(&self, cycle: usize) -> f64 {
        let Ends { after, before } = self.with[cycle];
        1.0 - before / after
    }

    pub(super) fn mass_of(&self, cycle: usize) -> f64 {
        let [of_start, of_clean_start] = self.started;
        let before = |cycles: &[Ends], started: f64| cycle.checked_sub(1).map_or(started, |last| cycles[last].before);
        let jump = |cycles: &[Ends], started: f64| cycles[cycle].after - before(cycles, started);
        match self.comparison {
            Some(Comparison::Jump) => jump(&self.with, of_start) / jump(&self.without, of_clean_start),
            Some(Comparison::After) => self.with[cycle].after / self.without[cycle].after,
            Some(Comparison::Level) => jump(&self.with, of_start) / before(&self.without, of_clean_start),
            None => f64::NAN,
        }
    }
}

fn ends(mass: &Matrix, response: &Response) -> Vec<Ends> {
    let energies = |cycle: &CycleRates| Ends { after: energy(mass, &cycle.after), before: energy(mass, &cycle.before) };
    response.cycle_rates.iter().map(energies).collect()
}

fn energy(mass: &Matrix, rate: &[f64]) -> f64 {
    // Soft walls have a coordinate of their own behind those of the structure.
    let rate = &rate[..mass.order];
    0.5 * mass.form(rate, rate)
}
