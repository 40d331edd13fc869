//! Why the engine gives up: each refusal with where it happened and what would avoid it.

use crate::budget::Overrun;

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
    /// Held by floor and ceiling at once.
    #[error(
        "floor and ceiling, both rigid or on their stops, meet at particle {particle} in cycle {cycle} at {time} s: a wider gap or stiffer walls would keep them apart, and a resilient face has an answer"
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
    /// A motion that the multipliers cannot follow.
    #[error(
        "the motion of a contact with equivalent viscous damping has no name: its damping depends on the half cycle before, which is no part of the state; leave `motion` and `until: settled` out"
    )]
    DampingWithMemory,
    /// Its allowance was used up first.
    #[error(transparent)]
    Overrun(#[from] Overrun),
    /// A block whose numbers overflow.
    #[error(
        "a natural frequency, a decay or the frequency of the drive leaves the range of numbers, or the forcing period does"
    )]
    RateNotFinite,
    /// Overflow.
    #[error("the motion leaves the range of numbers in cycle {cycle}")]
    NotFinite {
        /// Cycle.
        cycle: u64,
    },
}
