//! The lists that a row may keep: `trace`, `energies`, `shape`, `each_cycle`.

use super::assumption_reader::MOST_CYCLES;
use super::refined::share;
use crate::measure::{CycleSpec, CycleValue, EnergySpec, Measure, ShapeOf, ShapeSpec, Tolerance, TraceSpec};
use crate::yaml::word::words;
use crate::yaml::{At, Keys, Value};

/// Most samples of a time history.
const MOST_SAMPLES: u32 = 1_000_000;
/// Most points of a shape.
const MOST_POINTS: u32 = 100_000;

/// The first and the last cycle.
fn span(keys: &Keys<'_>) -> (Option<u32>, Option<u32>) {
    let cycles = |at: At<'_>| at.count("cycles", MOST_CYCLES);
    (keys.required("from", "First cycle", cycles), keys.required("to", "Last cycle", cycles))
}

pub(super) fn read_trace(at: At<'_>) -> Option<TraceSpec> {
    let keys = at.keys("a trace")?;
    let (from, to) = span(&keys);
    let samples = keys.required("samples_per_cycle", "Samples a cycle", |at| at.count("samples", MOST_SAMPLES));
    keys.close()?;
    let (from_cycle, to_cycle, samples) = (from?, to?, samples?);
    if from_cycle >= to_cycle {
        return at.wrong("a trace ends after the cycle it begins with");
    }
    let all = u64::from(to_cycle - from_cycle) * u64::from(samples);
    if all == 0 || all > u64::from(MOST_SAMPLES) {
        return at.wrong(format!("a trace has 1 to {MOST_SAMPLES} samples, not {all}"));
    }
    Some(TraceSpec { from_cycle, to_cycle, samples })
}

pub(super) fn read_energies(at: At<'_>) -> Option<EnergySpec> {
    let keys = at.keys("a span of cycles")?;
    let (from, to) = span(&keys);
    keys.close()?;
    let (from_cycle, to_cycle) = (from?, to?);
    if from_cycle >= to_cycle {
        return at.wrong("a span ends after the cycle it begins with");
    }
    Some(EnergySpec { from_cycle, to_cycle })
}

/// `impact_phase`, or `{of: impact_phase, last: 20 cycles}`.
pub(super) fn read_each_cycle(at: At<'_>) -> Option<CycleSpec> {
    let value = |at: At<'_>| at.word::<CycleValue>("value of a cycle");
    let last_ones = |at: At<'_>| {
        let keys = at.keys("a value of each cycle")?;
        let of = keys.required("of", "A value of a cycle, or of each contact in it", value);
        let last = keys.optional("last", "Cycles; all that are averaged unless stated", |at| {
            at.count_from(1, "cycles", MOST_CYCLES, "one cycle at least is kept")
        });
        keys.close()?;
        Some(CycleSpec { of: of?, last: last? })
    };
    let all = |at: At<'_>| Some(CycleSpec { of: value(at)?, last: None });
    at.either(|value| matches!(value, Value::Mapping(_)), last_ones, all)
}

/// `{gap: 1 %, force: 5 %}`: the words are those of the elasticities.
pub(super) fn read_tolerances(at: At<'_>) -> Option<Vec<Tolerance>> {
    let keys = at.keys("tolerances")?;
    let mut tolerances = Vec::new();
    let mut is_fine = true;
    for measure in Measure::ALL {
        let Some(of) = measure.elasticity_in() else { continue };
        let Some(name) = words::<Measure>()[*measure as usize].strip_suffix("_elasticity") else { continue };
        let about = "Its standard uncertainty over its value";
        match keys.optional(name, about, share) {
            Some(known) => tolerances.extend(known.map(|share| Tolerance { of, share })),
            None => is_fine = false,
        }
    }
    keys.close()?;
    if is_fine && tolerances.is_empty() {
        return at.wrong("there is no tolerance here: write `gap: 1 %`, for one");
    }
    is_fine.then_some(tolerances)
}

pub(super) fn read_shape(at: At<'_>) -> Option<ShapeSpec> {
    let keys = at.keys("a shape")?;
    let of = keys.required("of", "What is drawn along the structure", |at| at.word::<ShapeOf>("shape"));
    let points = keys.required("points", "Points, or points a side", |at| {
        at.one_or_more(|at| at.count_from(2, "points", MOST_POINTS, "a shape has two points along a side at least"))
    });
    keys.close()?;
    let (of, points) = (of?, points?);
    let all: u64 = points.iter().map(|count| u64::from(*count)).product();
    if all > u64::from(MOST_POINTS) || points.len() > 2 {
        return at.wrong(format!("a shape has {MOST_POINTS} points at most, along two sides"));
    }
    Some(ShapeSpec { of, points })
}
