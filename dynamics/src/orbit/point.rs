//! Points of a branch: what it is followed along, what its points hold, and how it ends.

use super::{Orbit, OrbitError};

/// What a branch is followed along.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Along {
    /// The end of the range that it is followed away from.
    pub from: f64,
    /// The end that it is followed towards.
    pub to: f64,
    /// The longest step, as a share of `from` to `to` and of the motion.
    pub step: f64,
    /// Points beyond which it is not followed.
    pub points: usize,
}

/// An orbit of a branch.
#[derive(Debug, Clone, PartialEq)]
pub struct BranchPoint {
    /// The parameter.
    pub parameter: f64,
    /// The orbit there.
    pub orbit: Orbit,
    /// What happens there.
    pub special: Option<Special>,
}

/// Why a branch goes no further than its last point.
#[derive(Debug, Clone, PartialEq)]
pub enum BranchEnd<E> {
    /// It has come to an end of the range: to `to`, or by way of a fold to `from`.
    Range,
    /// It has come back to its first point, which is the last one, too.
    Closed,
    /// Next to the last point the motion has half the period: the branch of that motion doubles its period there.
    HalfPeriod,
    /// Next to the last point the motion comes again upside down after half a period: the branch of that motion loses its symmetry
    /// there.
    Symmetry,
    /// A contact begins or ends without speed here; the last point is as close to it as orbits are found.
    Graze {
        /// The parameter of the graze.
        parameter: f64,
    },
    /// A contact has come to the instant at which the cycles of the drive begin: with the impulse given there, the motion after it
    /// is another one.
    CycleStart,
    /// As many points as were asked for.
    Points,
    /// So small a disturbance leads away from the orbit that steps to the next one are too short to get on.
    Sensitive,
    /// No orbit is found beyond the last point.
    Orbit(OrbitError),
    /// There is no system beyond the last point.
    System(E),
}

/// Why there is no branch.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum BranchError<E> {
    /// There is no orbit.
    #[error(transparent)]
    Orbit(#[from] OrbitError),
    /// There is no system.
    #[error("{0}")]
    System(E),
}

/// A point at which a branch changes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Special {
    /// It turns back in the parameter.
    Fold,
    /// A multiplier passes −1: a motion of twice the period begins.
    PeriodDoubling,
    /// A complex pair of multipliers passes the unit circle (Neimark-Sacker): a quasi-periodic motion begins.
    Torus,
    /// A contact begins or ends without speed.
    Graze,
    /// A particle that stays on its rigid face for a while begins to leave it as soon as it lands, or the other way round.
    Sticking,
    /// A multiplier passes 1 where the branch of a motion that comes again upside down after half a period does not turn: two motions
    /// that are each other's mirror image begin.
    SymmetryBreaking,
    /// The same of a motion without that symmetry: another branch crosses.
    BranchPoint,
}

impl Special {
    /// All of them, in the order of this list.
    pub const ALL: [Self; 7] = [
        Self::Fold,
        Self::PeriodDoubling,
        Self::Torus,
        Self::Graze,
        Self::Sticking,
        Self::SymmetryBreaking,
        Self::BranchPoint,
    ];

    /// The word in a table.
    #[must_use]
    pub fn word(self) -> &'static str {
        match self {
            Self::Fold => "fold",
            Self::PeriodDoubling => "period doubling",
            Self::Torus => "torus",
            Self::Graze => "graze",
            Self::Sticking => "sticking",
            Self::SymmetryBreaking => "symmetry breaking",
            Self::BranchPoint => "branch point",
        }
    }
}
