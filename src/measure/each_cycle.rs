//! One value a cycle, or one a contact: points of a bifurcation diagram. A motion of period p shows as p points a row, chaos as a
//! cloud.

use std::f64::consts::TAU;
use std::ops::Range;

use super::{CycleSpec, CycleValue, TraceColumn};
use crate::dynamics::{EventKind, Response, dot};
use crate::scene::Scene;
use crate::text::words;

impl CycleValue {
    /// Unit symbol.
    #[must_use]
    pub fn unit(self) -> &'static str {
        match self {
            Self::StroboscopicVelocity | Self::ImpactSpeed => "m/s",
            Self::ImpactPhase => "rad",
        }
    }

    /// Read off the velocities at the ends of cycles; else off single events.
    pub(super) fn is_of_ends(self) -> bool {
        self == Self::StroboscopicVelocity
    }
}

/// The list of a run of which these cycles are averaged.
pub(super) fn column(spec: CycleSpec, scene: &Scene, response: &Response, averaged: Range<u64>) -> TraceColumn {
    let kept = spec.last.map_or(averaged.end, u64::from).min(averaged.end - averaged.start);
    let cycles = averaged.end - kept..averaged.end;
    let values = match spec.of {
        CycleValue::StroboscopicVelocity => {
            let row = scene.structure.model().shape(scene.observed.points[0]);
            let ends = response.cycle_rates.iter().take(cycles.end as usize).skip(cycles.start as usize);
            // Soft walls have a coordinate of their own behind those of the structure.
            ends.map(|cycle| dot(&row, &cycle.before)).collect()
        }
        CycleValue::ImpactPhase => contacts(response, cycles, |_, time| TAU / scene.excitation.period() * time),
        CycleValue::ImpactSpeed => contacts(response, cycles, |approach, _| approach.abs()),
    };
    TraceColumn::new(words::of_key(&spec.of), spec.of.unit(), values)
}

/// A number of every contact that is made, by its relative velocity and its time within the cycle.
fn contacts(response: &Response, cycles: Range<u64>, of: impl Fn(f64, f64) -> f64) -> Vec<f64> {
    let made = response.events.iter().filter(|event| {
        let is_contact = matches!(event.kind, EventKind::FloorContact | EventKind::CeilingContact);
        is_contact && cycles.contains(&event.cycle)
    });
    made.map(|event| of(event.approach, event.time)).collect()
}
