//! Linear runs: a run that never changes its contact state is an affine map per forcing cycle.
//!
//! Where there is no particle, or where it is proved ([`bound`]) that none ever leaves its floor, nothing has to be
//! simulated: the state of any cycle is a power of the map of one cycle ([`cycle`]), the integrals over any number of cycles
//! are linear in the moments of their states ([`moments`], [`signal`]), and the steady state is where the map stays.
//!
//! In closed form, too, by the steady response to a train of impulses ([`struck`]): how strong a drive ends such a run
//! ([`lift_off`]), below which one no motion with two impacts a period exists ([`two_impacts`]), and at which one a particle that
//! bounces once a period first touches the ceiling ([`ceiling_graze`]).
//!
//! Not linear: half cycles that renew the damping, rigid floors under impulses (every impulse throws the particle off), a
//! structure that drifts, a given start of the particles. Time histories are kept by the march alone.

mod balance;
mod bound;
mod ceiling_graze;
mod cycle;
mod lift_off;
mod moments;
mod range;
mod signal;
mod struck;
mod two_impacts;

use std::rc::Rc;

use self::bound::Watch;
use self::cycle::{Cycle, enter};
use self::moments::Moments;
use self::signal::integrals;
use self::struck::Struck;
use crate::budget;
use crate::error::EngineError;
use crate::flow::Flow;
use crate::flow::signals::Row;
use crate::flow::sums::Sums;
use crate::options::{Options, Placed, StartState};
use crate::response::audit::Audit;
use crate::response::extremes::Extremes;
use crate::response::proof::Proof;
use crate::response::{CycleRates, Method, Observed, Response};
use crate::states::States;
use crate::system::{Contact, DrivePhase, HybridSystem, Tick};

/// A run all of whose particles rest on their floors.
struct Run<'a> {
    system: &'a HybridSystem,
    flow: &'a Flow,
    /// M⁻¹b.
    answer: Vec<f64>,
    /// The cycle that may be kicked.
    first: Cycle,
    /// All others.
    regular: Cycle,
    /// Block coordinates before the first cycle and before the second.
    starts: [Vec<f64>; 2],
}

/// Cycles that are alike.
struct Stretch<'a> {
    cycle: &'a Cycle,
    /// State before the first of them.
    start: Vec<f64>,
    /// Moments of the states before each.
    at: Moments,
}

impl<'a> Stretch<'a> {
    fn new(cycle: &'a Cycle, start: Vec<f64>, cycles: u64) -> Self {
        let at = Moments::over(&cycle.map, &start, cycles);
        Self { cycle, start, at }
    }
}

/// Solves a run in closed form; `None` where it is not linear, or not proved to be.
pub(crate) fn attempt(
    system: &HybridSystem,
    options: &Options,
    states: &States,
) -> Result<Option<Response>, EngineError> {
    if options.trace.is_some() {
        return Ok(None);
    }
    let Some(flow) = closed_flow(system, options, states)? else { return Ok(None) };
    let run = Run::new(system, states, &flow, options)?;
    let Some(margin) = run.margin() else { return Ok(None) };
    run.respond(options, margin).map(Some)
}

/// The motion that comes again in every cycle once all transients are gone, with every particle held on its floor.
struct Steady {
    flow: Rc<Flow>,
    cycle: Cycle,
    /// At the start of a cycle.
    state: Vec<f64>,
}

impl Steady {
    /// `None` where there is no such motion, or where it is not linear.
    fn of(system: &HybridSystem) -> Result<Option<Self>, EngineError> {
        if !(system.drive.repeats || system.drive.ticks.is_empty()) {
            return Ok(None);
        }
        let states = States::of(system);
        let Some(flow) = closed_flow(system, &Options::default(), &states)? else { return Ok(None) };
        let answer = states.ground().answer(system)?;
        let before = system.drive.ticks.last().map_or(0.0, |tick| tick.level);
        let cycle = regular(system, &flow, before, answer);
        // An undamped transient never goes.
        if flow.blocks[..flow.own].iter().any(|block| !(block.decay > 0.0)) {
            return Ok(None);
        }
        Ok(cycle.map.fixed_point().map(|state| Self { flow, cycle, state }))
    }
}

/// The steady state: what every cycle repeats once all transients are gone.
#[derive(Debug, Clone, PartialEq)]
pub struct SteadyState {
    /// In the order of [`HybridSystem::observed_rows`](crate::system::HybridSystem::observed_rows).
    pub observed: Vec<SteadyMotion>,
    /// A lower bound on how far, in metres, every particle stays from leaving its floor; infinite where there is none.
    pub margin: f64,
}

/// One observed motion in the steady state.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SteadyMotion {
    /// Integrals over one cycle.
    pub cycle: Sums,
    /// Largest and smallest values.
    pub extremes: Extremes,
}

/// The steady state in closed form: what is left once all transients are gone. `None` unless it is proved that no particle
/// leaves its floor in it, and where undamped modes never settle.
///
/// # Errors
/// [`EngineError`] with the reason.
pub fn steady_state(system: &HybridSystem) -> Result<Option<SteadyState>, EngineError> {
    budget::within(|| {
        let Some(Steady { flow, cycle, state: steady }) = Steady::of(system)? else { return Ok(None) };
        let watch = Watch {
            system,
            flow: &flow,
            first: &cycle,
            regular: &cycle,
            start: &steady,
            steady: &steady,
            transient: &vec![0.0; steady.len()],
        };
        let Some(margin) = watch.margin() else { return Ok(None) };
        let rows: Vec<&Row> = flow.rows.observed.iter().map(|&row| flow.rows.row(row)).collect();
        let at = Moments::over(&cycle.map, &steady, 1);
        let parts = integrals(system, &flow, &rows, &cycle, &at, true);
        let motion = |(row, part): (&&Row, Sums)| {
            let mut extremes = Extremes::default();
            range::take(&flow, row, &cycle, &steady, 1, &mut extremes);
            SteadyMotion { cycle: part, extremes }
        };
        Ok(Some(SteadyState { observed: rows.iter().zip(parts).map(motion).collect(), margin }))
    })
}

/// The share of its present strength at which the drive takes the first particle off its floor, in closed form: below it every particle
/// rests, once all transients are gone. `None` where no strength does, and where particles never rest under this drive: on rigid floors
/// under impulses, say.
///
/// # Errors
/// [`EngineError`] with the reason.
pub fn lift_off(system: &HybridSystem) -> Result<Option<f64>, EngineError> {
    budget::within(|| Ok(Steady::of(system)?.and_then(|steady| lift_off::share(system, &steady))))
}

/// The share of its present strength below which the drive keeps up no motion with one impact on the floor and one on the ceiling a period,
/// in closed form: one particle between rigid faces, under a harmonic force on a damped structure. `None` elsewhere, and where no strength
/// does.
///
/// # Errors
/// [`EngineError`] with the reason.
pub fn two_impacts(system: &HybridSystem) -> Result<Option<f64>, EngineError> {
    budget::within(|| Ok(Struck::of(system)?.as_ref().and_then(two_impacts::share)))
}

/// The share of its present strength at which the motion with one impact on the floor a period first touches the ceiling, in closed form:
/// one particle on a rigid floor, under gravity and a harmonic force on a damped structure. `None` elsewhere, and where no motion of this
/// kind that attracts stays below the ceiling.
///
/// # Errors
/// [`EngineError`] with the reason.
pub fn ceiling_graze(system: &HybridSystem) -> Result<Option<f64>, EngineError> {
    budget::within(|| Ok(Struck::of(system)?.as_ref().and_then(ceiling_graze::share)))
}

/// The flow with every particle on its floor, if its cycles can be summed: each block has a place to rest, and holds for any number of
/// them. `None` as well where a look at the scene shows that the run is not linear.
fn closed_flow(system: &HybridSystem, options: &Options, states: &States) -> Result<Option<Rc<Flow>>, EngineError> {
    let placed = options.start == StartState::StaticEquilibrium;
    let struck = options.kick != 0.0 || system.drive.ticks.iter().any(|tick| tick.impulse != 0.0);
    let thrown = struck && system.particles.iter().any(|particle| particle.floor.law.is_rigid());
    // A force that stays on when the jumps of the first cycle do not come again makes a cycle like no other.
    let once = !system.drive.repeats && system.drive.ticks.last().is_some_and(|tick| tick.level != 0.0);
    if once || !(system.particles.is_empty() || (placed && !thrown && system.drive.half_cycles.is_none())) {
        return Ok(None);
    }
    let flow = states.flow(system, &vec![Contact::Floor; system.particles.len()], None)?;
    let rests = flow.modes.spectral.lasts == f64::INFINITY && flow.blocks.iter().all(|block| block.determinant > 0.0);
    Ok(rests.then_some(flow))
}

impl<'a> Run<'a> {
    fn new(system: &'a HybridSystem, states: &States, flow: &'a Flow, options: &Options) -> Result<Self, EngineError> {
        let answer = states.ground().answer(system)?.to_vec();
        let ticks = if system.drive.ticks.is_empty() { &[Tick::STILL][..] } else { &system.drive.ticks };
        let kick = options.kick * system.drive.scale();
        let first = Cycle::new(system, flow, ticks, 0.0, kick, &answer);
        let regular = regular(system, flow, first.segments.last().map_or(0.0, |segment| segment.level), &answer);
        let phase = DrivePhase::of(&system.drive, 0.0);
        let start = match &options.start {
            StartState::Given { q, rate, .. } if system.particles.is_empty() => enter(flow, q, rate, 0.0, phase),
            _ => {
                let [p, _] = flow.at_rest(0.0, DrivePhase::default());
                enter(flow, &p, &vec![0.0; flow.order], 0.0, phase)
            }
        };
        let second = first.map.apply(&start);
        Ok(Self { system, flow, answer, first, regular, starts: [start, second] })
    }

    /// How far every particle stays from leaving; `None` if it is not proved that none does.
    fn margin(&self) -> Option<f64> {
        if self.system.particles.is_empty() {
            return Some(f64::INFINITY);
        }
        let steady = self.regular.map.fixed_point()?;
        let transient: Vec<f64> = self.starts[1].iter().zip(&steady).map(|(now, steady)| now - steady).collect();
        let watch = Watch {
            system: self.system,
            flow: self.flow,
            first: &self.first,
            regular: &self.regular,
            start: &self.starts[0],
            steady: &steady,
            transient: &transient,
        };
        watch.margin()
    }

    /// Block coordinates before a cycle, and the force in force then.
    fn before(&self, cycle: u64) -> (Vec<f64>, f64) {
        match cycle.checked_sub(1) {
            None => (self.starts[0].clone(), self.first.before),
            Some(regular) => (self.regular.map.repeat(&self.starts[1], regular), self.regular.before),
        }
    }

    /// The cycles of a stretch, alike ones together.
    fn stretch(&self, from: u64, to: u64) -> Vec<Stretch<'_>> {
        let mut parts = Vec::new();
        if from == 0 && to > 0 {
            parts.push(Stretch::new(&self.first, self.starts[0].clone(), 1));
        }
        let from = from.max(1);
        if from < to {
            parts.push(Stretch::new(&self.regular, self.before(from).0, to - from));
        }
        parts
    }

    /// The structure's velocities at both ends of every cycle.
    fn cycle_rates(&self, cycles: u64) -> Vec<CycleRates> {
        let n = self.system.mass.order;
        let phase = DrivePhase::of(&self.system.drive, 0.0);
        let rates = |c: &[f64], level: f64| {
            let [_, mut rate] = self.flow.left(c, 0.0, level, phase);
            rate.truncate(n);
            rate
        };
        let mut state = self.starts[0].clone();
        let mut all = Vec::new();
        for number in 0..cycles {
            if budget::spend(1) {
                break;
            }
            let cycle = if number == 0 { &self.first } else { &self.regular };
            let after = cycle.segments.first().map_or_else(|| state.clone(), |segment| segment.jump.apply(&state));
            state = cycle.map.apply(&state);
            all.push(CycleRates { after: rates(&after, 0.0), before: rates(&state, 0.0) });
        }
        all
    }

    fn respond(&self, options: &Options, margin: f64) -> Result<Response, EngineError> {
        let (system, flow) = (self.system, self.flow);
        let rows: Vec<&Row> = flow.rows.observed.iter().map(|&row| flow.rows.row(row)).collect();
        let (skip, average) = (u64::from(options.skip), u64::from(options.average));
        let bounds = [skip, skip + average.div_ceil(2), skip + average];
        let mut response = Response {
            method: Method::ClosedForm,
            observed: vec![Observed::default(); rows.len()],
            proof: Proof { smallest_margin: margin, ..Proof::default() },
            highest_frequency: flow.highest_frequency,
            ..Response::default()
        };
        for half in 0..2 {
            for Stretch { cycle, at, .. } in self.stretch(bounds[half], bounds[half + 1]) {
                let parts = integrals(system, flow, &rows, cycle, &at, options.displacement);
                for (part, of) in parts.into_iter().zip(&mut response.observed) {
                    of.halves[half].add(part);
                }
            }
        }
        if options.extremes {
            for (row, of) in rows.iter().zip(&mut response.observed) {
                for Stretch { cycle, start, at } in self.stretch(skip, skip + average) {
                    range::take(flow, row, cycle, &start, at.count as u64, &mut of.extremes);
                }
            }
        }
        if options.cycle_rates {
            response.cycle_rates = self.cycle_rates(options.cycles());
        }
        let (end, level) = self.before(options.cycles());
        let [p, rate] = flow.left(&end, 0.0, level, DrivePhase::of(&system.drive, 0.0));
        let last = balance::state(system, flow, &p, &rate);
        response.final_state = options.final_state.then(|| on_floors(system, flow, &p, &rate));
        if options.audit {
            let (begin, level) = self.before(skip);
            let [p, rate] = flow.left(&begin, 0.0, level, DrivePhase::of(&system.drive, 0.0));
            let mut audit = Audit::from(balance::state(system, flow, &p, &rate));
            for Stretch { cycle, at, .. } in self.stretch(skip, options.cycles()) {
                balance::pass(system, flow, &self.answer, cycle, &at, &mut audit);
            }
            response.proof.balance(system, &audit, &last);
        }
        response.final_particles = last.particles;
        response.initial_contacts = vec![Contact::Floor; system.particles.len()];
        response.at_end(system, [&last.q, &last.rate], options.cycles())
    }
}

/// A state with every particle on its floor, as a run may start from it; a rigid floor has no place of its own in the flow.
fn on_floors(system: &HybridSystem, flow: &Flow, p: &[f64], rate: &[f64]) -> StartState {
    let n = system.mass.order;
    let mut particles = vec![Placed::ON_FLOOR; system.particles.len()];
    for (i, &j) in flow.modes.attached.iter().enumerate() {
        particles[j] = Placed::new(Contact::Floor, p[n + i], rate[n + i]);
    }
    StartState::Given { q: p[..n].to_vec(), rate: rate[..n].to_vec(), particles }
}

/// The cycle that repeats, after one that ended with the force `before`.
fn regular(system: &HybridSystem, flow: &Flow, before: f64, answer: &[f64]) -> Cycle {
    let repeats = system.drive.repeats && !system.drive.ticks.is_empty();
    let ticks = if repeats { &system.drive.ticks } else { &[Tick::STILL][..] };
    Cycle::new(system, flow, ticks, before, 0.0, answer)
}
