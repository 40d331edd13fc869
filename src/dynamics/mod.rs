//! The engine: exact motion of a piecewise linear system, from certified event to certified event.
//!
//! In the order of use: a [`HybridSystem`] (linear structure, particles, drive) is run by [`event_driven`] under
//! [`Options`]; the [`Response`] holds the integrals of the averaged window, the counts, and the [`Proof`].
//!
//! | files | hold |
//! |---|---|
//! | `system`, `options`, `carried`, `trace`, `spline` | what is run, from where, and how |
//! | `run`, `repeated` | the ways to run it; runs that are asked for again |
//! | `response`, `sums`, `extremes`, `crest`, `proof`, `error` | what comes out |
//! | `march`, `states`, `visits` | from event to event; the contact states on the way and how long each was in force |
//! | `search`, `survey`, `guards`, `window`, `polynomial` | the first event, certified by Bernstein enclosures |
//! | `reach` | stops and ceilings that a bound on the energy keeps out of the search |
//! | `contact`, `collision`, `touch`, `mobility` | what an event leads to |
//! | `flow`, `load`, `signals`, `parabola`, `series`, `steps` | exact motion of one contact state, and what is watched of it |
//! | `contact_state`, `conservative`, `modes`, `undamped`, `damped`, `spectral`, `cluster`, `resonance`, `schur`, `block`, `bank` | its equations, split into 2 × 2 blocks |
//! | `gains`, `lyapunov`, `pair_integral`, `integral`, `quadrature` | its integrals in closed form, by quadrature where that would lose digits |
//! | `audit`, `dissipation`, `residual_bound` | momentum and energy, balanced by other means |
//! | `motion` | which kind of motion a run ends in: multipliers, exponents |
//! | `orbit` | periodic motions, stable or not, and branches of them |
//! | `linear` | a run in which no event can happen, in closed form |
//! | `fixed` | a fixed-step scheme, to show what the time step does to a published result |
//! | `budget` | what a run may take |
//! | `cholesky`, `complexes`, `elementary`, `exact`, `four`, `gauss`, `lanes`, `superposition`, `wide` | arithmetic, several numbers at a time |
//!
//! The engine knows no beam, no YAML and no file. It works with dense matrices of a hundred modes or so, not with large
//! sparse systems.

#![expect(clippy::neg_cmp_op_on_partial_ord, reason = "`!(x > bound)` sends NaN into the branch that refuses")]
#![expect(clippy::needless_range_loop, reason = "matrix loops run one index over several arrays")]

mod audit;
mod bank;
mod block;
mod budget;
mod carried;
mod cholesky;
mod cluster;
mod collision;
mod complexes;
mod conservative;
mod contact;
mod contact_state;
mod crest;
mod damped;
mod dissipation;
mod elementary;
mod error;
mod exact;
mod extremes;
mod fixed;
mod flow;
mod four;
mod gains;
mod gauss;
mod guards;
mod integral;
mod lanes;
mod linear;
mod load;
mod lyapunov;
mod march;
mod mobility;
mod modes;
mod motion;
mod options;
mod orbit;
mod pair_integral;
mod parabola;
mod polynomial;
mod proof;
mod quadrature;
mod reach;
mod repeated;
mod residual_bound;
mod resonance;
mod response;
mod run;
mod schur;
mod search;
mod series;
mod signals;
mod spectral;
mod spline;
mod states;
mod steps;
mod sums;
mod superposition;
mod survey;
mod system;
mod touch;
mod trace;
mod undamped;
mod visits;
mod wide;
mod window;

pub use budget::{Allowance, Exhausted, Limit, Overrun, in_words, interrupt, is_interrupted};
pub use error::EngineError;
pub use extremes::Extremes;
pub use fixed::fixed_step;
pub use linear::{SteadyMotion, SteadyState, ceiling_graze, lift_off, steady_state, two_impacts};
pub use motion::{Exponent, Fundamental, Motion, MotionKind, Multiplier, Recurring};
pub use options::{Averaged, Options, StartState, Until};
pub use orbit::{
    Along, Branch, BranchEnd, BranchError, BranchPoint, Elasticity, ElasticityError, Orbit, OrbitError, Special,
};
pub use proof::Proof;
pub use reach::{FarSurface, OutOfReach, out_of_reach};
pub use repeated::keeping_runs;
pub use response::{Counts, CycleRates, Method, Observed, Response};
pub use run::{event_driven, fundamental_matrix, is_linear};
pub use spline::Spline;
pub use sums::Sums;
pub use system::{
    Contact, Drive, Event, EventKind, Face, HalfCycles, Harmonic, HybridSystem, Law, Matrix, Particle, Stop, Tick, dot,
};
pub use trace::{Sample, SampledParticle, TraceRequest};

/// Changes whenever the same scene may give other bits. A test holds the bits of fixed scenes against it.
pub const SOLVER_VERSION: u32 = 28;
