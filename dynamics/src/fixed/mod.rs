//! The fixed-step scheme of a published study: exact propagators of one time step, the contact state checked once a step.
//!
//! s(k+1) = A_d s(k) + a_d + B_d F(k) with the propagators of the contact state in force ([`propagator`]), and at the end
//! of each step the question whether that state still holds ([`contact`]). Between two checks the motion is exact; a contact
//! is noticed up to a step late, so that all results are off by the first order in Δt. That error is what this solver is for.
//! [`ahead`] makes many such steps at once. [`schedule`] says which steps impulses and cycles fall on, [`record`] what is kept of a run.
//!
//! Its text leaves details open. Those chosen here are the simplest that give what it says of its Fig. 14 (Model 1 under
//! harmonic force, driven at √(ks/(m+mp)), against a run with the particle fixed to the base; 40 amplitudes a decade):
//!
//! | detail | choice | Fig. 14 at Δt = 10 ms otherwise |
//! |---|---|---|
//! | period of a harmonic force | not rounded: F is read off sin ω k Δt, cycles end at the nearest step | rounded to 20 steps, the frequency with it: 1.0018 at the high end; 1.0000 at 0.106 |
//! | input | F(k) at the start of the step, held over it | F at its middle or end: 1.0012; the dip is 0.9990, 0.9993 |
//! | release of a held particle | by the acceleration at the end of a step, with the force from then on | with the force until then: 1.0012; the dip is 0.9993 |
//! | contact made with a rigid face | the particle is put back to the face; momentum is exchanged there | |
//! | samples | at the ends of steps, after the check, before an impulse that falls there | before the check: 1.0020; the dip is 0.9991 |
//!
//! With them the ratio is 1.0012 at high amplitudes and 0.9988 at 0.106 for Δt = 10 ms, and at Δt = 10 µs 1.000 at both ends
//! and nowhere lower.
//!
//! A particle that a rigid face cannot hold is let go a step after it struck, and counts as released; exact events let it go
//! at once. Beyond that text, what would not vanish with Δt follows the rules of exact events: a held particle from which an
//! impulse or another impact pulls its face away is let go at once, impacts of one step are one exchange of momentum
//! ([`crate::contact::collision`]), a stop lets go at once what its spring throws back, and a particle between faces that move by
//! themselves is at both. So do damping, stop and release without tension, at the end of each step. What [`crate::response::proof::Proof`]
//! holds then: the residuals of momentum and energy by trapezoidal sums (they show the scheme's own error: a spring that is
//! noticed compressed has got that energy from nowhere), no ties, and NaN for the smallest margin, since nothing is
//! certified.

mod ahead;
mod contact;
mod propagator;
mod record;
mod schedule;
mod stretch;
mod vector;
mod watch;

use std::rc::Rc;

use crate::arithmetic::cholesky::Cholesky;
use crate::arithmetic::matrix::dot;
use crate::arithmetic::wide::widened;
use crate::budget;
use crate::contact::mobility::Mobilities;
use crate::contact::{Relative, Side};
use crate::contact_state::{dampings, face_damping};
use crate::error::EngineError;
use crate::flow::{Flow, Rest};
use crate::options::{Options, StartState};
use crate::response::audit::{Audit, Passed};
use crate::response::{Observed, Response};
use crate::system::{Contact, Drive, HybridSystem};
use ahead::{AHEAD, Ahead};
use propagator::{Layout, Propagator, lead};
use schedule::{Oscillator, Schedule, StepTick};
use stretch::{HalfCycle, Motion, Tally, Visited};
use vector::Vector;
use watch::Watch;

/// Propagators kept.
const MOST_PROPAGATORS: usize = 1024;
/// With equivalent viscous damping, which makes new ones at every half cycle.
const MOST_EQUIVALENT: usize = 64;
/// Steps between two questions for what is left of the allowance; whole numbers of steps at once, or a sample would shift them.
const STEPS_A_STRETCH: u64 = 128 * AHEAD;
/// What a stretch counts as, about.
const UNITS_A_STRETCH: u32 = 16;

/// Runs a system with a fixed time step, s: exact propagators of one step, the contact state checked once a step. It does not look
/// at the options `until`, `motion`, `settling`, `beside`, `final_state` and `window_factor`.
///
/// # Errors
/// [`EngineError`] with the reason.
pub fn fixed_step(system: &HybridSystem, options: &Options, time_step: f64) -> Result<Response, EngineError> {
    // One mass alone, with one particle, with soft walls and a particle or with two particles; anything else.
    budget::within(|| match Layout::of(system).size() {
        2 => Run::<[f64; 2]>::new(system, options, time_step)?.run(),
        4 => Run::<[f64; 4]>::new(system, options, time_step)?.run(),
        6 => Run::<[f64; 6]>::new(system, options, time_step)?.run(),
        _ => Run::<Vec<f64>>::new(system, options, time_step)?.run(),
    })
}

/// A run in progress.
struct Run<'a, V: Vector> {
    system: &'a HybridSystem,
    options: &'a Options,
    time_step: f64,
    layout: Layout,
    schedule: Schedule,
    watch: Watch<V>,
    /// Velocity of the structure after a unit impulse at the forcing point.
    jump: Vec<f64>,
    known: Vec<Visited<V>>,
    /// Index of the one in force.
    now: usize,
    // State beside what moves.
    motion: Motion<V>,
    contacts: Vec<Contact>,
    /// Particles at something rigid that may move against it.
    closing: Vec<Closing>,
    mobilities: Mobilities,
    /// What half cycles put in the place of the faces' own damping, N s/m.
    equivalent: Option<f64>,
    cycle: u64,
    /// Steps since the start.
    step: u64,
    samples: Samples,
    // Results.
    tally: Tally<V>,
    visited: Vec<Vec<Contact>>,
    response: Response,
    /// From the averaged window on.
    audit: Option<Audit>,
    passed: Passed,
}

/// A particle at a rigid face or on a stop, which it may move against.
struct Closing {
    particle: usize,
    side: Side,
    /// Held until now.
    held: bool,
}

/// The next sample of the time history.
#[derive(Debug, Clone, Copy)]
struct Samples {
    cycle: u64,
    index: u64,
    /// The step it falls on; never reached if there is none.
    step: u64,
}

impl<'a, V: Vector> Run<'a, V> {
    fn new(system: &'a HybridSystem, options: &'a Options, time_step: f64) -> Result<Self, EngineError> {
        let layout = Layout::of(system);
        let (positions, size) = (layout.positions(), layout.size());
        let schedule = Schedule::of(&system.drive, time_step)?;
        let row = |from: usize, row: &[f64]| {
            let mut padded = vec![0.0; size];
            padded[from..from + row.len()].copy_from_slice(row);
            V::of(&padded)
        };
        let [first, rest @ ..] = system.observed_rows.as_slice() else { return Err(EngineError::NothingObserved) };
        let watch = Watch {
            displacement: row(0, first),
            velocity: row(positions, first),
            more: rest.iter().map(|more| [row(0, more), row(positions, more)]).collect(),
            forced: row(0, &system.force_row),
            with_displacement: options.displacement,
        };
        let oscillator =
            system.drive.harmonic.map(|drive| Oscillator::new(drive, schedule.angle(drive, system.drive.period)));
        let half_cycles = system.drive.half_cycles.as_ref();
        let (contacts, state) = start(system, &options.start, layout)?;
        let initial_contacts = contacts.clone();
        let mut run = Self {
            system,
            options,
            time_step,
            layout,
            schedule,
            watch,
            jump: Cholesky::new(&system.mass)?.solve(&system.force_row),
            known: Vec::new(),
            now: 0,
            motion: Motion::new(&state, oscillator, half_cycles.map(|_| HalfCycle::default())),
            contacts,
            closing: Vec::new(),
            mobilities: Mobilities::default(),
            equivalent: half_cycles.map(|half| half.curve.upper_end()),
            cycle: 0,
            step: 0,
            samples: Samples { cycle: options.trace.map_or(0, |trace| trace.from_cycle), index: 0, step: 0 },
            tally: Tally::new(size, rest.len(), options.extremes),
            visited: Vec::new(),
            response: Response {
                observed: vec![Observed::default(); system.observed_rows.len()],
                initial_contacts,
                ..Response::default()
            },
            audit: None,
            passed: Passed { position: vec![0.0; layout.n], ..Passed::default() },
        };
        run.seek_sample(0);
        run.choose_propagator()?;
        Ok(run)
    }

    fn run(mut self) -> Result<Response, EngineError> {
        let skip = u64::from(self.options.skip);
        for cycle in 0..self.options.cycles() {
            self.cycle = cycle;
            budget::reach(cycle, self.options.cycles());
            if cycle == skip {
                self.begin_window();
            }
            if cycle == 0 && self.options.kick != 0.0 {
                self.impulse(self.options.kick * self.system.drive.scale())?;
            }
            let first = self.schedule.cycle(cycle);
            let driven = cycle == 0 || self.system.drive.repeats;
            let ticks = if driven { self.schedule.ticks.len() } else { 0 };
            if !driven {
                self.motion.level = 0.0;
            }
            if ticks == 0 {
                self.open_cycle();
            }
            for i in 0..ticks {
                let tick = self.schedule.ticks[i];
                self.advance_to(first + tick.step)?;
                self.tick(tick)?;
                if i == 0 {
                    self.open_cycle();
                }
            }
            self.advance_to(self.schedule.cycle(cycle + 1))?;
            self.end_cycle()?;
        }
        self.finish()
    }

    fn begin_window(&mut self) {
        if self.options.audit {
            self.audit = Some(Audit::from(self.audit_state()));
            self.seam(0.5);
        }
    }

    /// A jump of the force.
    fn tick(&mut self, tick: StepTick) -> Result<(), EngineError> {
        self.motion.level = tick.level;
        self.motion.half.iter_mut().for_each(HalfCycle::jumps);
        if tick.impulse == 0.0 { Ok(()) } else { self.impulse(tick.impulse) }
    }

    widened! {
        /// Steps up to a step, and decides the contacts wherever a guard says so.
        fn advance_to | advance_wide (&mut self, until: u64) -> Result<(), EngineError> = advance
    }

    #[inline(always)]
    fn advance(&mut self, until: u64) -> Result<(), EngineError> {
        let audited = self.audit.is_some();
        while self.step < until {
            if self.step == self.samples.step {
                self.sample();
            }
            let steps = self.uncut(until - self.step).min(STEPS_A_STRETCH);
            if budget::spend(UNITS_A_STRETCH) {
                return Err(budget::overrun().into());
            }
            let known = &self.known[self.now];
            let end = if audited {
                self.motion.stretch::<true>(known, &self.watch, steps, &mut self.tally)
            } else {
                self.motion.stretch::<false>(known, &self.watch, steps, &mut self.tally)
            };
            self.step += end.steps;
            if end.broken || end.turned {
                self.decide(end)?;
            }
        }
        Ok(())
    }

    /// How many of these steps can be made before a sample asks for the state; one that falls among steps that are made at once is
    /// taken ahead of them, so that it changes no bit of what follows.
    fn uncut(&mut self, steps: u64) -> u64 {
        let once = if self.known[self.now].ahead.is_some() { AHEAD } else { 1 };
        if self.samples.step - self.step < once.min(steps) {
            return self.foresee(once.min(steps));
        }
        let before = self.samples.step - self.step;
        steps.min((before - before % once).max(once))
    }

    /// Takes the samples among the next steps, and tells how many of these can be made until the contact state changes.
    fn foresee(&mut self, steps: u64) -> u64 {
        let (motion, begin) = (self.motion.clone(), self.step);
        let mut tally = Tally::new(self.layout.size(), self.watch.more.len(), false);
        let mut unbroken = steps;
        while self.samples.step - begin < steps {
            let next = self.samples.step - self.step;
            let end = self.motion.one_by_one::<false>(&self.known[self.now].propagator, &self.watch, next, &mut tally);
            self.step += end.steps;
            if end.broken {
                unbroken = self.step - begin;
                break;
            }
            self.sample();
        }
        (self.motion, self.step) = (motion, begin);
        unbroken
    }

    /// Makes the propagator of the contact state in force current, building it at the first visit.
    fn choose_propagator(&mut self) -> Result<(), EngineError> {
        let both = |j| [Side::Floor, Side::Ceiling].map(|side| self.damping(j, side));
        let damping: Vec<[f64; 2]> = (0..self.contacts.len()).map(both).collect();
        let fits = |Visited { propagator, .. }: &Visited<V>| {
            propagator.contacts == self.contacts && propagator.damping == damping
        };
        if let Some(index) = self.known.iter().position(fits) {
            self.now = index;
            return Ok(());
        }
        let most = if self.motion.half.is_some() { MOST_EQUIVALENT } else { MOST_PROPAGATORS };
        if self.known.len() >= most {
            self.known.clear();
        }
        if !self.visited.contains(&self.contacts) {
            self.visited.push(self.contacts.clone());
        }
        let propagator = Propagator::build(self.system, &self.contacts, &damping, self.time_step)?;
        let Motion { oscillator, half, .. } = &self.motion;
        let ahead = half.is_none().then(|| Ahead::new(&propagator, &self.watch, oscillator.as_ref()));
        self.known.push(Visited { propagator, ahead });
        self.now = self.known.len() - 1;
        Ok(())
    }

    /// Dashpot of a face, N s/m.
    fn damping(&self, j: usize, side: Side) -> f64 {
        face_damping(side.face(&self.system.particles[j]).law, self.equivalent)
    }

    /// Position relative to a face.
    fn relative(&self, j: usize, side: Side) -> Relative {
        let particle = &self.system.particles[j];
        let (state, positions, gap) = (self.motion.state.as_ref(), self.layout.positions(), self.layout.gap(j));
        let mut here = Relative { gap: state[gap] - side.height(particle), rate: state[gap + positions] };
        for (i, lead) in lead(particle, side).enumerate() {
            here.gap -= lead * state[i];
            here.rate -= lead * state[i + positions];
        }
        here
    }

    /// Puts a particle where `here` says it is, relative to a face.
    fn place(&mut self, j: usize, side: Side, here: Relative) {
        let now = self.relative(j, side);
        let (positions, gap) = (self.layout.positions(), self.layout.gap(j));
        let particle = &self.system.particles[j];
        let state = self.motion.state.as_mut();
        if side == Side::Floor {
            (state[gap], state[gap + positions]) = (here.gap, here.rate);
        } else if particle.ceiling.as_ref().is_some_and(|face| face.row == particle.floor.row) {
            (state[gap], state[gap + positions]) = (here.gap + particle.gap, here.rate);
        } else {
            state[gap] += here.gap - now.gap;
            state[gap + positions] += here.rate - now.rate;
        }
    }

    fn finish(mut self) -> Result<Response, EngineError> {
        self.seam(-0.5);
        if let Some(mut audit) = self.audit.take() {
            audit.add(&self.passed);
            self.response.proof.balance(self.system, &audit, &self.audit_state());
        }
        self.response.proof.smallest_margin = f64::NAN;
        self.response.final_particles = (0..self.contacts.len()).map(|j| self.absolute(j)).collect();
        let quiet = without_harmonic(self.system);
        for contacts in &self.visited {
            let flow = Flow::build(&quiet, contacts, &dampings(self.system, contacts, self.equivalent))?;
            let highest = &mut self.response.highest_frequency;
            *highest = highest.max(flow.highest_frequency);
        }
        let (_, rest) = start(self.system, &StartState::StaticEquilibrium, self.layout)?;
        let rounding = self.rounding_of(&rest);
        self.response.observed.iter_mut().for_each(|of| of.rest_below(rounding));
        self.response.at_end(self.system, self.layout.structure(self.motion.state.as_ref()), self.cycle)
    }

    /// y and y′ of a particle.
    fn absolute(&self, j: usize) -> [f64; 2] {
        let (n, positions, gap) = (self.layout.n, self.layout.positions(), self.layout.gap(j));
        let (state, floor) = (self.motion.state.as_ref(), &self.system.particles[j].floor.row);
        [dot(floor, &state[..n]) + state[gap], dot(floor, &state[positions..positions + n]) + state[gap + positions]]
    }
}

/// The same system at rest: for its static equilibrium and its natural frequencies.
fn without_harmonic(system: &HybridSystem) -> HybridSystem {
    HybridSystem { drive: Drive { harmonic: None, ..system.drive.clone() }, ..system.clone() }
}

/// Contacts and state at the start.
fn start(system: &HybridSystem, from: &StartState, layout: Layout) -> Result<(Vec<Contact>, Vec<f64>), EngineError> {
    let (n, positions) = (layout.n, layout.positions());
    let mut state = vec![0.0; layout.size()];
    match from {
        StartState::StaticEquilibrium => {
            let (quiet, damping) = (without_harmonic(system), vec![0.0; layout.particles]);
            let flow = |contacts: &[Contact]| Flow::build(&quiet, contacts, &damping).map(Rc::new);
            let Rest { contacts, q, gaps } = Rest::of(system, flow)?;
            state[..n].copy_from_slice(&q);
            state[n..positions].copy_from_slice(&gaps);
            Ok((contacts, state))
        }
        StartState::Given { q, rate, particles } => {
            state[..n].copy_from_slice(q);
            state[positions..positions + n].copy_from_slice(rate);
            for (j, (at, particle)) in particles.iter().zip(&system.particles).enumerate() {
                let side = at.contact.side();
                let ahead = |x: &[f64]| lead(particle, side).zip(x).fold(0.0, |sum, (lead, x)| sum + lead * x);
                state[layout.gap(j)] = at.gap + side.height(particle) + ahead(q);
                state[layout.gap(j) + positions] = at.rate + ahead(rate);
            }
            Ok((particles.iter().map(|at| at.contact).collect(), state))
        }
    }
}
