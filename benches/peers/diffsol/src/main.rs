//! diffsol with root finding: each contact state to its first event; a problem of its own beyond it.
//!
//! diffsol does not ask from which side a surface is crossed. A crossing from the wrong side is what rounding has left of the last
//! event; the integration goes on beyond it.

mod scene;

use std::time::Instant;

use diffsol::error::DiffsolError;
use diffsol::{NalgebraLU, NalgebraMat, OdeBuilder, OdeEquations, OdeSolverMethod, OdeSolverStopReason, Vector};
use scene::{Contact, Equations, Guard, Scene};
use serde_json::{Value, json};

type Matrix = NalgebraMat<f64>;
type Solver = NalgebraLU<f64>;

const METHODS: [Method; 3] = [Method::Tsit45, Method::Bdf, Method::TrBdf2];
const SETTINGS: [f64; 4] = [1e-4, 1e-6, 1e-9, 1e-12];
/// s.
const PATIENCE: f64 = 0.7;
const RUNS: usize = 200;

#[derive(Debug, Clone, Copy)]
enum Method {
    Tsit45,
    Bdf,
    TrBdf2,
}

/// Where a segment ends, and at which surfaces.
struct End<'a> {
    time: f64,
    state: Vec<f64>,
    met: Vec<&'a Guard>,
}

struct Found {
    rms: f64,
    events: Vec<Value>,
}

/// From impulse to impulse and event to event.
fn run(scene: &Scene, method: Method, rtol: f64) -> Result<Found, String> {
    let mut z = scene.start.clone();
    let mut contacts = vec![Contact::Floor; scene.particles];
    let mut events = Vec::new();
    for cycle in 0..scene.cycles {
        scene.strike(&mut z);
        let (mut t, mut still) = (0.0, 0);
        // What is left within rounding of the end is none of the solver's business.
        while scene.period - t > 4.0 * f64::EPSILON * scene.period {
            let equations = scene.equations(&contacts, cycle >= scene.skip);
            let end = segment(&equations, method, rtol, t, scene.period, &z)?;
            for guard in end.met {
                contacts[guard.particle] = guard.next;
                events.push(json!([f64::from(cycle) * scene.period + end.time, guard.particle, guard.word]));
            }
            still = if end.time == t { still + 1 } else { 0 };
            if still > 64 {
                return Err(format!("no progress in cycle {cycle} at {t} s"));
            }
            (t, z) = (end.time, end.state);
        }
    }
    Ok(Found { rms: scene.rms(&z), events })
}

fn segment<'e>(
    equations: &'e Equations,
    method: Method,
    rtol: f64,
    from: f64,
    until: f64,
    z: &[f64],
) -> Result<End<'e>, String> {
    let problem = OdeBuilder::<Matrix>::new()
        .t0(from)
        .rtol(rtol)
        .atol([1e-2 * rtol])
        .rhs_implicit(|z, _, _, out| equations.slope(z, out), |z, _, _, w, out| equations.jacobian(z, w, out))
        .init(|_, _, out| out.copy_from_slice(z), z.len())
        .root(|z, _, _, out| equations.surfaces(z, out), equations.guards.len())
        .build()
        .map_err(|error| error.to_string())?;
    match method {
        Method::Tsit45 => problem.tsit45().map(|solver| ahead(solver, equations, until)),
        Method::Bdf => problem.bdf::<Solver>().map(|solver| ahead(solver, equations, until)),
        Method::TrBdf2 => problem.tr_bdf2::<Solver>().map(|solver| ahead(solver, equations, until)),
    }
    .and_then(|end| end)
    .map_err(|error| error.to_string())
}

fn ahead<'a, 'e, E, S>(mut solver: S, equations: &'e Equations, until: f64) -> Result<End<'e>, DiffsolError>
where
    E: OdeEquations<T = f64> + 'a,
    S: OdeSolverMethod<'a, E>,
{
    solver.set_stop_time(until)?;
    loop {
        match solver.step()? {
            OdeSolverStopReason::InternalTimestep => {}
            OdeSolverStopReason::RootFound(time, found) => {
                solver.state_mut_back(time)?;
                let state = solver.state().y.clone_as_vec();
                let met = equations.met(found, &state);
                if !met.is_empty() {
                    return Ok(End { time, state, met });
                }
            }
            OdeSolverStopReason::TstopReached => {
                return Ok(End { time: until, state: solver.state().y.clone_as_vec(), met: Vec::new() });
            }
        }
    }
}

fn answer(scene: &Scene, method: Method, rtol: f64, is_timed: bool) -> Value {
    let mut times: Vec<f64> = Vec::new();
    let begun = Instant::now();
    loop {
        let begin = Instant::now();
        let found = run(scene, method, rtol);
        times.push(begin.elapsed().as_secs_f64());
        // A slow run is its own median.
        let more =
            is_timed && times[0] < PATIENCE && times.len() < RUNS && begun.elapsed().as_secs_f64() < 3.0 * PATIENCE;
        match found {
            Err(why) => return json!({"failure": why}),
            Ok(_) if more => {}
            Ok(Found { rms, events }) => return json!({"rms": rms, "events": events, "times": times}),
        }
    }
}

impl Method {
    fn describe(self) -> &'static str {
        match self {
            Self::Tsit45 => "Tsit45",
            Self::Bdf => "BDF",
            Self::TrBdf2 => "TR-BDF2",
        }
    }
}

/// A scene is run in all settings, repeatedly; after `--tightest` once, in the last of them.
fn main() -> Result<(), String> {
    let words: Vec<String> = std::env::args().skip(1).collect();
    let tightest = words.first().is_some_and(|word| word == "--tightest");
    let settings = if tightest { &SETTINGS[SETTINGS.len() - 1..] } else { &SETTINGS[..] };
    for file in &words[usize::from(tightest)..] {
        let scene = Scene::read(file)?;
        for method in METHODS {
            for rtol in settings {
                let description = method.describe();
                let mut line = answer(&scene, method, *rtol, !tightest);
                line["file"] = json!(file);
                line["solver"] = json!(told);
                line["setting"] = json!(format!("diffsol {description}, rtol {rtol:e}"));
                println!("{line}");
            }
        }
    }
    Ok(())
}
