//! The engine: exact motion of a piecewise linear system, from certified event to certified event.
//!
//! In the order of use: a [`HybridSystem`] (linear structure, particles, drive) is run by [`event_driven`] under
//! [`Options`]; the [`Response`] holds the integrals of the averaged window, the counts, and the [`Proof`].
//!
//! | room | holds |
//! |---|---|
//! | `budget` | what a simulation may take |
//! | `error` | why the engine gives up |
//! | `arithmetic` | vectors, matrices and elementary functions, several numbers at a time, the same bits on every processor |
//! | `system` | what is run: structure, particles, faces, drive |
//! | `contact` | where a particle is; which of the closed contacts push, and what an impact gives |
//! | `contact_state` | the equations of one contact state, split into 2 × 2 blocks, and what they answer to a load for ever |
//! | `flow` | the exact motion of one contact state, what is watched of it, its Taylor series and its integrals, the ways to the next one |
//! | `states` | contact states that were visited, kept for every run that comes to them again |
//! | `search` | the first event of a flow, certified by Bernstein enclosures |
//! | `motion` | which kind of motion a run ends in: multipliers, exponents |
//! | `options` | how it is run: which cycles, from where, and what is kept of them |
//! | `response` | what comes out, with the audit: momentum and energy, balanced by other means |
//! | `march` | from event to event, cycle by cycle, and what a bound on the energy keeps out of reach |
//! | `linear` | in closed form: runs in which no event can happen, and thresholds of those with one or two impacts a period |
//! | `fixed` | a fixed-step scheme, to show what the time step does to a published result |
//! | `orbit` | periodic motions, stable or not, and branches of them |
//! | `run` | the ways to run a system; runs that are asked for again |
//!
//! Imports go upwards in this table only, as in that of the rooms in `ARCHITECTURE.md`.
//!
//! The engine knows no beam and no file; what its errors advise is said in the words of the YAML. It works with dense matrices of a
//! hundred modes or so, not with large sparse systems.

#![deny(missing_docs)]
#![expect(clippy::neg_cmp_op_on_partial_ord, reason = "`!(x > bound)` sends NaN into the branch that refuses")]
#![expect(clippy::needless_range_loop, reason = "matrix loops run one index over several arrays")]

mod arithmetic;
mod budget;
mod contact;
mod contact_state;
mod error;
mod fixed;
mod flow;
mod linear;
mod march;
mod motion;
mod options;
mod orbit;
mod response;
mod run;
mod search;
mod states;
mod system;

pub use arithmetic::matrix::{Matrix, dot};
pub use budget::{Allowance, Exhausted, Limit, Overrun, aside, in_words, interrupt, is_interrupted};
pub use error::EngineError;
pub use fixed::fixed_step;
pub use flow::sums::Sums;
pub use linear::{SteadyMotion, SteadyState, ceiling_graze, lift_off, steady_state, two_impacts};
pub use march::reach::{FarSurface, OutOfReach, out_of_reach};
pub use motion::{Exponent, Fundamental, Motion, MotionKind, Multiplier, Recurring, Settling};
pub use options::trace::TraceRequest;
pub use options::{Averaged, Options, Placed, StartState, Until};
pub use orbit::{
    Along, Branch, BranchEnd, BranchError, BranchPoint, Elasticity, ElasticityError, Orbit, OrbitError, Special,
};
pub use response::extremes::Extremes;
pub use response::proof::Proof;
pub use response::sample::{Sample, SampledParticle};
pub use response::{Counts, CycleRates, Method, Observed, Response};
pub use run::repeated::keeping_runs;
pub use run::{event_driven, event_driven_within, fundamental_matrix, is_linear};
pub use system::spline::Spline;
pub use system::{
    Contact, Drive, Event, EventKind, Face, HalfCycles, Harmonic, HybridSystem, Law, Particle, Stop, Tick,
};

/// Changes whenever the same scene may give other bits. A test holds the bits of fixed scenes against it.
pub const SOLVER_VERSION: u32 = 43;
