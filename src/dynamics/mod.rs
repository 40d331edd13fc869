//! The engine: exact motion of a piecewise linear system, from certified event to certified event.
//!
//! In the order of use: a [`HybridSystem`] (linear structure, particles, drive) is run by [`event_driven`] under
//! [`Options`]; the [`Response`] holds the integrals of the averaged window, the counts, and the [`Proof`].
//!
//! - `flow`: the exact motion of one contact state, split into 2 × 2 `block`s by `modes` and `spectral`;
//! - `search`: the first event, certified by Bernstein enclosures;
//! - `contact`: what an event leads to; `march`: from event to event;
//! - `linear`: a run without any event, in closed form;
//! - `integral`: measures in closed form; `audit`: momentum and energy balanced by other means;
//! - `fixed`: the study's own scheme, with its step.
//!
//! The engine knows no beam, no YAML and no file. Structures of up to a hundred modes or so are its business; large sparse
//! systems are not.

#![expect(clippy::neg_cmp_op_on_partial_ord, reason = "`!(x > bound)` sends NaN into the branch that refuses")]
#![expect(clippy::needless_range_loop, reason = "matrix loops run one index over several arrays")]

mod audit;
mod bank;
mod block;
mod budget;
mod cholesky;
mod cluster;
mod collision;
mod contact;
mod contact_state;
mod dissipation;
mod elementary;
mod extremes;
mod fixed;
mod flow;
mod gains;
mod guards;
mod integral;
mod lanes;
mod linear;
mod lyapunov;
mod march;
mod mobility;
mod modes;
mod polynomial;
mod residual_bound;
mod schur;
mod search;
mod series;
mod signals;
mod spectral;
mod spline;
mod states;
mod system;
mod trace;
mod visits;
mod window;

pub use budget::{Allowance, Exhausted, Limit, Overrun, in_words, interrupt, is_interrupted};
pub use spline::Spline;
pub use system::{
    Contact, Drive, Event, EventKind, Face, HalfCycles, Harmonic, HybridSystem, Law, Matrix, Particle, Stop, Tick, dot,
};
pub use trace::{Sample, TraceRequest};

/// Changes whenever the same scene may give other bits. A test holds the bits of fixed scenes against it.
pub const SOLVER_VERSION: u32 = 5;

/// What proves a run: residuals of the balances, and how clearly its events were decided.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Proof {
    /// |Σ impulses − momentum gained − impulse of springs, dashpots and gravity| over the impulse that passed or was carried, dimensionless.
    pub momentum_residual: f64,
    /// |work of the excitation − energy gained − energy dissipated| over the energy that passed, dimensionless.
    pub energy_residual: f64,
    /// What both may be at most if nothing but rounding is in them; infinite where nobody audited, and for the fixed step, whose
    /// residuals are the error of its step.
    pub residual_bound: f64,
    /// Events of the whole run: contacts made and lost, stops hit; impulses not counted.
    pub events: u64,
    /// The smallest distance, in metres, by which a surface would have to be moved for the sequence of events to change; NaN
    /// from the fixed step, which certifies nothing.
    pub smallest_margin: f64,
    /// Decisions within rounding: simultaneous events that had to be put into an order, contacts that graze.
    pub ties: u64,
}

impl Default for Proof {
    /// Of a run that nobody audited.
    fn default() -> Self {
        Self {
            momentum_residual: 0.0,
            energy_residual: 0.0,
            residual_bound: f64::INFINITY,
            events: 0,
            smallest_margin: 0.0,
            ties: 0,
        }
    }
}

/// How a system is run.
#[derive(Debug, Clone, PartialEq)]
pub struct Options {
    /// Cycles left out as transient.
    pub skip: u32,
    /// Cycles averaged over.
    pub average: u32,
    /// Where it starts.
    pub start: StartState,
    /// An impulse added at the start, relative to the drive's own, to see whether neighbouring runs stay neighbours.
    pub kick: f64,
    /// Measure displacements too, not velocities alone.
    pub displacement: bool,
    /// Look for the largest and smallest values of the observed motions.
    pub extremes: bool,
    /// Keep the structure's velocities at both ends of every cycle.
    pub cycle_rates: bool,
    /// Balance momentum and energy.
    pub audit: bool,
    /// How many events to keep, from the first.
    pub record_events: usize,
    /// Time history to keep.
    pub trace: Option<TraceRequest>,
    /// Search windows are shorter by this factor; 1 as a rule, less for a second accuracy.
    pub window_factor: f64,
}

impl Options {
    /// Cycles to run: the averaged window, and as far as a time history asks for.
    pub(crate) fn cycles(&self) -> u64 {
        let window = u64::from(self.skip) + u64::from(self.average);
        window.max(self.trace.map_or(0, |trace| trace.to_cycle))
    }

    /// The cycle belongs to the averaged window.
    pub(crate) fn averages(&self, cycle: u64) -> bool {
        let first = u64::from(self.skip);
        (first..first + u64::from(self.average)).contains(&cycle)
    }
}

impl Default for Options {
    /// The study's averaging: 25 cycles skipped, 100 averaged, from static equilibrium.
    fn default() -> Self {
        Self {
            skip: 25,
            average: 100,
            start: StartState::StaticEquilibrium,
            kick: 0.0,
            displacement: true,
            extremes: false,
            cycle_rates: false,
            audit: false,
            record_events: 0,
            trace: None,
            window_factor: 1.0,
        }
    }
}

/// Where a run starts.
#[derive(Debug, Clone, PartialEq)]
pub enum StartState {
    /// At rest, every particle on its floor.
    StaticEquilibrium,
    /// Anywhere.
    Given {
        /// Coordinates of the structure.
        q: Vec<f64>,
        /// Their rates.
        rate: Vec<f64>,
        /// Contact, gap coordinate and relative rate of each particle; at a ceiling relative to that.
        particles: Vec<(Contact, f64, f64)>,
    },
}

/// Integrals over half of the averaged window.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Sums {
    /// s.
    pub duration: f64,
    /// ∫ x dt.
    pub displacement: f64,
    /// ∫ (x − x̄)² dt, x̄ the mean: about zero a motion far from it would lose its digits.
    pub deviation_square: f64,
    /// ∫ v² dt.
    pub velocity_square: f64,
}

/// Events in the averaged window.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Counts {
    /// Contacts made with a floor.
    pub floor_contacts: u64,
    /// Contacts lost with a floor.
    pub floor_releases: u64,
    /// Contacts made with a ceiling.
    pub ceiling_contacts: u64,
    /// Impacts on a limit stop.
    pub stops: u64,
}

impl Counts {
    fn add(&mut self, kind: EventKind) {
        match kind {
            EventKind::FloorContact => self.floor_contacts += 1,
            EventKind::FloorRelease => self.floor_releases += 1,
            EventKind::CeilingContact => self.ceiling_contacts += 1,
            EventKind::FloorStop | EventKind::CeilingStop => self.stops += 1,
            EventKind::CeilingRelease | EventKind::StopRelease | EventKind::ChatterEnd => {}
        }
    }
}

/// How a response came about.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Method {
    /// From event to event.
    #[default]
    Simulated,
    /// No event can happen: by powers of the map of one cycle.
    ClosedForm,
}

/// What a run leaves behind.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Response {
    /// How it came about.
    pub method: Method,
    /// What was observed, in the order of [`HybridSystem::observed_rows`].
    pub observed: Vec<Observed>,
    /// The structure's velocities at both ends of every cycle, if asked for.
    pub cycle_rates: Vec<CycleRates>,
    /// Events in the averaged window.
    pub counts: Counts,
    /// What proves the run.
    pub proof: Proof,
    /// Events kept.
    pub events: Vec<Event>,
    /// Time history.
    pub trace: Vec<Sample>,
    /// Observed displacement at the end, m.
    pub final_displacement: f64,
    /// Observed velocity at the end, m/s.
    pub final_velocity: f64,
    /// y and y′ of each particle at the end.
    pub final_particles: Vec<[f64; 2]>,
    /// Highest natural frequency among the contact states visited, rad/s.
    pub highest_frequency: f64,
}

/// One observed motion over the averaged window.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Observed {
    /// Integrals over the first and the second half.
    pub halves: [Sums; 2],
    /// Largest and smallest values, if asked for.
    pub extremes: Extremes,
}

/// The range of an observed motion; lowest and highest value, NaN where nobody looked.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Extremes {
    /// m.
    pub displacement: [f64; 2],
    /// m/s.
    pub velocity: [f64; 2],
}

impl Default for Extremes {
    fn default() -> Self {
        Self { displacement: [f64::NAN; 2], velocity: [f64::NAN; 2] }
    }
}

impl Extremes {
    /// Takes an instant into the range.
    pub(crate) fn take(&mut self, displacement: f64, velocity: f64) {
        // The smaller of NaN and a number is the number.
        for (range, value) in [(&mut self.displacement, displacement), (&mut self.velocity, velocity)] {
            *range = [range[0].min(value), range[1].max(value)];
        }
    }
}

/// The structure's velocities q′ at both ends of a cycle.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct CycleRates {
    /// Just after the impulse that opens it.
    pub after: Vec<f64>,
    /// Just before the impulse that opens the next one.
    pub before: Vec<f64>,
}

impl Response {
    /// The averaged window of the first observed motion.
    #[must_use]
    pub fn window(&self) -> Sums {
        self.observed.first().map(Observed::window).unwrap_or_default()
    }
}

impl Observed {
    /// Both halves of the averaged window.
    #[must_use]
    pub fn window(&self) -> Sums {
        let [mut whole, second] = self.halves;
        whole.add(second);
        whole
    }
}

impl Sums {
    /// The same over both stretches.
    pub(crate) fn add(&mut self, more: Self) {
        let duration = self.duration + more.duration;
        if self.duration > 0.0 && more.duration > 0.0 {
            let apart = more.displacement / more.duration - self.displacement / self.duration;
            self.deviation_square += apart * apart * (self.duration * (more.duration / duration));
        }
        self.duration = duration;
        self.displacement += more.displacement;
        self.deviation_square += more.deviation_square;
        self.velocity_square += more.velocity_square;
    }

    /// Of raw sums, about zero.
    pub(crate) fn of_raw(duration: f64, displacement: f64, square: f64, velocity_square: f64) -> Self {
        let deviation_square = (square - displacement * (displacement / duration)).max(0.0);
        Self { duration, displacement, deviation_square, velocity_square }
    }

    /// RMS velocity, m/s.
    #[must_use]
    pub fn rms_velocity(&self) -> f64 {
        (self.velocity_square / self.duration).sqrt()
    }

    /// Mean displacement, m.
    #[must_use]
    pub fn mean_displacement(&self) -> f64 {
        self.displacement / self.duration
    }

    /// Standard deviation of the displacement, m.
    #[must_use]
    pub fn std_displacement(&self) -> f64 {
        (self.deviation_square / self.duration).sqrt()
    }
}

/// The motion that comes again in every cycle.
#[derive(Debug, Clone, PartialEq)]
pub struct SteadyState {
    /// In the order of [`HybridSystem::observed_rows`].
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

/// Why the engine gave up.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum EngineError {
    /// The mass matrix has no Cholesky factor.
    #[error(
        "the mass matrix is not positive definite (row {row}); a basis with fewer or better conditioned shapes would be"
    )]
    MassNotPositive {
        /// Where it failed.
        row: usize,
    },
    /// The eigenvalue iteration did not converge.
    #[error("the real Schur form of a contact state of order {order} did not converge")]
    NoSchurForm {
        /// Order of the matrix.
        order: usize,
    },
    /// A steady state that does not exist.
    #[error(
        "a contact state with next to no damping is driven at its own frequency, {omega} rad/s: it has no steady answer"
    )]
    UndampedResonance {
        /// rad/s.
        omega: f64,
    },
    /// Floor and ceiling at once.
    #[error(
        "floor and ceiling meet at particle {particle} in cycle {cycle} at {time} s: there is no contact state for a particle between both; a wider gap or stiffer walls would keep them apart"
    )]
    Squeezed {
        /// Which.
        particle: usize,
        /// Cycle.
        cycle: u64,
        /// Time within it.
        time: f64,
    },
    /// Too many events at one instant.
    #[error("the contact does not settle in cycle {cycle} at {time} s: more than 64 events at one instant")]
    NoProgress {
        /// Cycle.
        cycle: u64,
        /// Time within it.
        time: f64,
    },
    /// A system that nobody looks at.
    #[error("the system has no observed row: there is nothing to measure")]
    NothingObserved,
    /// A step that is no step of this drive.
    #[error(
        "a time step of {time_step} s does not fit a forcing period of {period} s: it must be positive, no longer than the period and longer than a billionth of it"
    )]
    TimeStep {
        /// s.
        time_step: f64,
        /// s.
        period: f64,
    },
    /// Its allowance was used up first.
    #[error(transparent)]
    Overrun(#[from] Overrun),
    /// Overflow.
    #[error("the motion leaves the range of numbers in cycle {cycle}")]
    NotFinite {
        /// Cycle.
        cycle: u64,
    },
}

/// Runs a system from event to event; where it is proved that there is none, in closed form.
///
/// # Errors
/// [`EngineError`] with the reason.
pub fn event_driven(system: &HybridSystem, options: &Options) -> Result<Response, EngineError> {
    budget::within(|| {
        let states = states::States::of(system);
        let mut response = match linear::attempt(system, options, &states)? {
            linear::Attempt::Solved(response) => *response,
            linear::Attempt::Open => march::march(system, options, states)?,
        };
        residual_bound::enter(system, options, &mut response);
        Ok(response)
    })
}

/// True where it is proved, without a simulation, that no particle leaves its floor in the run: it is then in closed form, and
/// what only a particle in flight can meet is skipped.
///
/// # Errors
/// [`EngineError`] with the reason.
pub fn is_linear(system: &HybridSystem, options: &Options) -> Result<bool, EngineError> {
    let attempt = budget::within(|| linear::attempt(system, options, &states::States::of(system)))?;
    Ok(matches!(attempt, linear::Attempt::Solved(_)))
}

/// The steady state in closed form: what is left once all transients are gone. `None` unless it is proved that no particle
/// leaves its floor in it, and where undamped modes never settle.
///
/// # Errors
/// [`EngineError`] with the reason.
pub fn steady_state(system: &HybridSystem) -> Result<Option<SteadyState>, EngineError> {
    budget::within(|| linear::steady_state(system))
}

/// Runs a system with the study's scheme: exact propagators of one time step, s, the contact state checked once a step.
///
/// # Errors
/// [`EngineError`] with the reason.
pub fn fixed_step(system: &HybridSystem, options: &Options, time_step: f64) -> Result<Response, EngineError> {
    budget::within(|| fixed::run(system, options, time_step))
}
