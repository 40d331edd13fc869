//! diffsol with root finding: each contact state to its first event; a problem of its own beyond it.
//!
//! diffsol does not ask from which side a surface is crossed. A crossing from the wrong side is what rounding has left of the last
//! event; the integration goes on beyond it.

mod scene;

use std::time::Instant;

use diffsol::error::DiffsolError;
use diffsol::{NalgebraLU, NalgebraMat, OdeBuilder, OdeEquations, OdeSolverMethod, OdeSolverStopReason, Vector};
use nalgebra::{DMatrix, DVector};
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

/// What is asked of a scene.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Asked {
    /// A run in all settings, repeatedly.
    Run,
    /// A run in the tightest of them, once.
    Tightest,
    /// The motion that comes again, in all settings, from the state in which a run ends, which is not timed.
    Orbit,
}

/// A state between cycles.
#[derive(Clone)]
struct State {
    z: Vec<f64>,
    contacts: Vec<Contact>,
}

/// From impulse to impulse: where it ends, and the events.
fn run(scene: &Scene, method: Method, rtol: f64) -> Result<(State, Vec<Value>), String> {
    let mut state = State { z: scene.start.clone(), contacts: vec![Contact::Floor; scene.particles] };
    let mut events = Vec::new();
    for number in 0..scene.cycles {
        cycle(scene, method, rtol, &mut state, number >= scene.skip, |time, guard| {
            events.push(json!([f64::from(number) * scene.period + time, guard.particle, guard.word]));
        })?;
    }
    Ok((state, events))
}

/// From event to event.
fn cycle(
    scene: &Scene,
    method: Method,
    rtol: f64,
    State { z, contacts }: &mut State,
    averaged: bool,
    mut met: impl FnMut(f64, &Guard),
) -> Result<(), String> {
    scene.strike(z);
    let (mut t, mut still) = (0.0, 0);
    // What is left within rounding of the end is none of the solver's business.
    while scene.period - t > 4.0 * f64::EPSILON * scene.period {
        let equations = scene.equations(contacts, averaged);
        let end = segment(&equations, method, rtol, t, scene.period, z)?;
        for guard in end.met {
            contacts[guard.particle] = guard.next;
            met(end.time, guard);
        }
        still = if end.time == t { still + 1 } else { 0 };
        if still > 64 {
            return Err(format!("no progress at {t} s of a cycle"));
        }
        (t, *z) = (end.time, end.state);
    }
    Ok(())
}

/// The RMS velocity of the motion that comes again, by shooting: Newton on the map of a cycle, its matrix by differences.
fn orbit(scene: &Scene, method: Method, rtol: f64, near: &State) -> Result<f64, String> {
    let order = scene.start.len() - 1;
    let through = |place: &DVector<f64>| {
        let mut state = State { z: place.iter().copied().chain([0.0]).collect(), contacts: near.contacts.clone() };
        cycle(scene, method, rtol, &mut state, true, |_, _| {})?;
        Ok::<_, String>((DVector::from_column_slice(&state.z[..order]), state.z[order]))
    };
    let mut place = DVector::from_column_slice(&near.z[..order]);
    let size = place.norm();
    let kick = rtol.sqrt() * size;
    for _ in 0..20 {
        let (end, _) = through(&place)?;
        let mut matrix = DMatrix::identity(order, order);
        for i in 0..order {
            let mut kicked = place.clone();
            kicked[i] += kick;
            let moved = (through(&kicked)?.0 - &end) / kick;
            for row in 0..order {
                matrix[(row, i)] -= moved[row];
            }
        }
        let step = matrix.lu().solve(&(end - &place)).ok_or("a singular matrix")?;
        place += &step;
        if step.norm() <= 10.0 * rtol * size {
            return Ok((through(&place)?.1 / scene.period).sqrt());
        }
    }
    Err("shooting does not converge".into())
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

fn answer(scene: &Scene, method: Method, rtol: f64, asked: Asked) -> Value {
    if asked != Asked::Orbit {
        let once = || run(scene, method, rtol).map(|(end, events)| Found { rms: scene.rms(&end.z), events });
        return timed(once, asked == Asked::Run);
    }
    match run(scene, method, rtol) {
        Err(why) => json!({"failure": why}),
        Ok((near, _)) => timed(|| Ok(Found { rms: orbit(scene, method, rtol, &near)?, events: Vec::new() }), true),
    }
}

fn timed(once: impl Fn() -> Result<Found, String>, is_timed: bool) -> Value {
    let mut times: Vec<f64> = Vec::new();
    let begun = Instant::now();
    loop {
        let begin = Instant::now();
        let found = once();
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

fn main() -> Result<(), String> {
    let words: Vec<String> = std::env::args().skip(1).collect();
    let asked = match words.first().map(String::as_str) {
        Some("--tightest") => Asked::Tightest,
        Some("--orbit") => Asked::Orbit,
        _ => Asked::Run,
    };
    let settings = if asked == Asked::Tightest { &SETTINGS[SETTINGS.len() - 1..] } else { &SETTINGS[..] };
    for file in &words[usize::from(asked != Asked::Run)..] {
        let scene = Scene::read(file)?;
        for method in METHODS {
            for rtol in settings {
                let description = method.describe();
                let mut line = answer(&scene, method, *rtol, asked);
                line["file"] = json!(file);
                line["solver"] = json!(description);
                line["setting"] = json!(format!("diffsol {description}, rtol {rtol:e}"));
                println!("{line}");
            }
        }
    }
    Ok(())
}
