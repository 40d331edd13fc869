//! A periodic motion, measured over one period of it.
//!
//! What the structure without dampers is compared with is its own periodic motion: it is linear, so that one step of Newton's method
//! finds it from rest.

use super::evaluate::rounded_subject;
use super::reading::Reading;
use super::undefined::in_range;
use super::{EvaluateError, Evaluated, Measure, Measured, Request, Rigour, Subject, elasticity};
use crate::dynamics::{Averaged, HybridSystem, Options, Orbit, Response, StartState, event_driven};
use crate::measure::Settings;
use crate::scene::{Scene, compile};

/// How far an orbit may be from closing, in units of the motion: so far its numbers are known.
const CLOSED: f64 = 1e-12;

/// The measures of one period, audited and, for their numerical uncertainty, with search windows half as long.
///
/// # Errors
/// [`EvaluateError`] with the reason.
pub fn measured_orbit(
    orbit: &Orbit,
    subject: Subject,
    settings: &Settings,
    measures: &[Measure],
) -> Result<Evaluated, EvaluateError> {
    let request = Request { measures, rigour: Rigour::Result, ..Request::default() };
    let subject = rounded_subject(subject, settings);
    let scene = &subject.scene;
    let system = compile(scene)?;
    let response = run(&request, scene, &system, settings, orbit, 1.0)?;
    let again = run(&request, scene, &system, settings, orbit, 0.5)?;
    let undamped = match subject.undamped.as_ref().filter(|_| request.needs().undamped) {
        Some(bare) => {
            let system = compile(bare)?;
            let orbit = Orbit::near(&system, &StartState::StaticEquilibrium, 1)?;
            Some(run(&request, bare, &system, settings, &orbit, 1.0)?)
        }
        None => None,
    };
    let read = |response| -> Result<Vec<f64>, EvaluateError> {
        let undamped = undamped.as_ref();
        let given = Averaged { first: 0, cycles: orbit.cycles.into() };
        let reading = Reading { mode: subject.mode, undamped, given, ..Reading::of_run(scene, response) };
        measures.iter().map(|measure| reading.read(*measure)).collect()
    };
    let (values, others) = (read(&response)?, read(&again)?);
    let measured = values.into_iter().zip(others).zip(measures).map(|((value, other), measure)| {
        if let Some(design) = measure.elasticity_in() {
            return elasticity::of(&subject, orbit, design);
        }
        let numerical = (value - other).abs().max(CLOSED * value.abs());
        Ok(Measured { value, numerical, spread: 0.0 })
    });
    let evaluated = Evaluated {
        measured: measured.collect::<Result<_, _>>()?,
        proof: response.proof,
        chaotic: false,
        unknown: None,
        members: 1,
        motion: Some(orbit.kind),
        trace: Vec::new(),
        end: None,
    };
    in_range(scene, orbit.cycles, measures, evaluated)
}

/// One period of an orbit, with what the measures need.
fn run(
    request: &Request<'_>,
    scene: &Scene,
    system: &HybridSystem,
    settings: &Settings,
    orbit: &Orbit,
    window_factor: f64,
) -> Result<Response, EvaluateError> {
    let options = Options {
        start: orbit.start.clone(),
        skip: 0,
        average: orbit.cycles,
        audit: window_factor == 1.0,
        window_factor,
        ..request.options(scene, settings)
    };
    Ok(event_driven(system, &options)?)
}
