//! Periodic motions as objects, stable or not: found by Newton's method on the certified flow, followed in a parameter.
//!
//! P(x) is the state p cycles of the drive after the state x at phase 0, by a certified run: the sequence of contacts is the run's own,
//! no event is missed, and M = ∂P/∂x comes from the same run ([`crate::motion`]). A periodic motion closes, P(x) = x, and
//!
//! x ← x + (1 − M)⁻¹ (P(x) − x)
//!
//! finds it whether it attracts or not. In a parameter λ the solutions of P(x, λ) = x are branches. They are followed along their arc
//! length, through folds: the tangent (ẋ, λ̇) predicts, Newton's method corrects in the plane across it. ∂P/∂λ is a difference of two runs;
//! it decides how fast the corrector converges, not what it converges to.
//!
//! | special point | test function, zero there |
//! |---|---|
//! | fold | λ̇ |
//! | period doubling | det(1 + M) |
//! | torus (Neimark-Sacker) | the modulus of a complex pair of multipliers less 1 |
//! | symmetry breaking, branch point | det [1 − M, −∂P/∂λ; tᵀ], t = (ẋ, λ̇) |
//! | sticking | the acceleration of a particle towards its rigid face as it lands on it without a bounce |
//! | graze | the speed of a contact of the sequence, not the map, whose derivative is infinite there |
//!
//! A contact of rigid faces ends the branch at its graze: λ is a smooth function of the impact speed there, so that the zero is
//! extrapolated from the last points. A branch on which a contact is about to begin is followed up to that instant.
//!
//! A particle that lands without a bounce stays where its face pushes it, and leaves at once where it does not. Between the two the
//! branch goes on smoothly: a flight that begins θ late begins where both accelerations are equal to first order, and differs by θ² only.
//! The side of a point is seen from its contacts, and the zero between the sides is halved down to rounding.
//!
//! Sources: Parker & Chua, Practical Numerical Algorithms for Chaotic Systems, 1989 (shooting); Seydel, Practical Bifurcation and
//! Stability Analysis, 3rd ed. 2010 (arc length, test functions); Leine & Nijmeijer, Dynamics and Bifurcations of Non-Smooth
//! Mechanical Systems, 2004 (M through impacts); Nordmark, J. Sound Vib. 145, 1991, and di Bernardo, Budd, Champneys & Kowalczyk,
//! Piecewise-smooth Dynamical Systems, 2008 (grazing).
//!
//! | files | hold |
//! |---|---|
//! | `shot` | one run over the period: miss, map, sequence of contacts |
//! | `newton` | one orbit |
//! | `corrector` | a point of a branch beside another |
//! | `special` | test functions, and where they vanish |
//! | `origin` | whether a branch has come back to its first point |
//! | `section` | where the period begins, away from contacts |
//! | `slowing` | where a contact that slows down has no speed left |
//! | `fork` | where a branch loses its symmetry |
//! | `point` | what a branch is followed along, its points, and how it ends |
//! | `branch` | from point to point |
//! | `elasticity` | the derivative of a number of an orbit in a parameter |

mod branch;
mod corrector;
mod elasticity;
mod fork;
mod newton;
mod origin;
mod point;
mod section;
mod shot;
mod slowing;
mod special;
mod stretch;

use crate::error::EngineError;
use crate::motion::{End, Exponent, MotionKind, Multiplier, NEUTRAL};
use crate::options::StartState;
use crate::response::Response;
use crate::system::HybridSystem;

pub use branch::Branch;
pub use elasticity::{Elasticity, ElasticityError};
pub use point::{Along, BranchEnd, BranchError, BranchPoint, Special};

/// A periodic motion.
#[derive(Debug, Clone, PartialEq)]
pub struct Orbit {
    /// The state at phase 0, before an impulse of the drive there.
    pub start: StartState,
    /// Cycles of the drive after which it comes again.
    pub cycles: u32,
    /// Contacts made in that time, stops hit among them.
    pub contacts: u64,
    /// Its name; chaotic and unsettled motions are no orbits.
    pub kind: MotionKind,
    /// Floquet multipliers, largest first.
    pub multipliers: Vec<Multiplier>,
    /// Their product against the contraction of dashpots and impacts, relative to what it could be at most.
    pub residual: f64,
    /// How far the orbit that closes is from the start, in units of the motion: Newton's last step.
    pub distance: f64,
    /// The run over one period: averages, counts, and every event.
    pub response: Response,
}

impl Orbit {
    /// Its start, seen by an observer at rest.
    fn begin(&self, system: &HybridSystem) -> Result<End, OrbitError> {
        let none = OrbitError::NoConvergence { cycles: self.cycles, miss: f64::INFINITY };
        shot::absolute(system, &self.start).ok_or(none)
    }

    /// No multiplier exceeds 1.
    #[must_use]
    pub fn is_stable(&self) -> bool {
        self.multipliers.first().is_none_or(|largest| largest.modulus <= 1.0 + NEUTRAL)
    }
}

/// Why there is no orbit.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum OrbitError {
    /// Nothing that could come again.
    #[error("the drive does not repeat, so no motion comes again with it")]
    NoPeriod,
    /// Of no cycle.
    #[error("an orbit has one cycle of the drive at least, as has the run that leads to it")]
    NoCycle,
    /// The run ends in chaos.
    #[error(
        "the run ends in chaos (exponent {:.2} ± {:.2} a cycle): start near a periodic motion, or at a value where one attracts",
        exponent.value,
        exponent.error
    )]
    Chaotic {
        /// Its exponent.
        exponent: Exponent,
    },
    /// No period was found.
    #[error(
        "the run's last state does not come again: the closest return, after {cycles} cycles, misses it by {miss:.1e} of the motion; run longer"
    )]
    NeverRepeats {
        /// The period of the closest return.
        cycles: usize,
        /// In units of the motion.
        miss: f64,
    },
    /// Newton's method does not converge.
    #[error(
        "no orbit of {cycles} cycles was found near the start: the closest state misses itself by {miss:.1e} of the motion"
    )]
    NoConvergence {
        /// Cycles of the orbit looked for.
        cycles: u32,
        /// In units of the motion.
        miss: f64,
    },
    /// It comes again to rounding, and so do others beside it.
    #[error(
        "a state comes again after {cycles} cycles to rounding, but so do others beside it: a multiplier is so close to 1 that no single orbit is found"
    )]
    NotAlone {
        /// Cycles of the orbit looked for.
        cycles: u32,
    },
    /// It comes again, and no orbit is found that it goes over into.
    #[error(
        "the motion of {cycles} cycles comes again, but no other is found close beside it: it does not change smoothly with the parameter here"
    )]
    NoNeighbour {
        /// Cycles of the orbit.
        cycles: u32,
    },
    /// A contact comes and goes between one step and the next.
    #[error(
        "the orbit of {cycles} cycles grazes: between steps that miss it by {miss:.1e} of the motion its sequence of contacts changes"
    )]
    Grazes {
        /// Cycles of the orbit looked for.
        cycles: u32,
        /// In units of the motion.
        miss: f64,
    },
    /// No single matrix says what becomes of a disturbance.
    #[error(
        "particles are struck at one instant, and a disturbance may put their impacts into one order or the other: no multipliers exist"
    )]
    StruckAtOnce,
    /// The engine refuses the run.
    #[error(transparent)]
    Engine(#[from] EngineError),
}
