//! What kind of motion a run ends in, with its proof: Floquet multipliers of what repeats, a Lyapunov exponent of what does not.
//!
//! A start moved by δx ends, k cycles later, moved by M δx. Between two events M is the exact flow of the contact state. At an
//! event that happens where a gap closes, n·x = 0, the moved motion is early or late by δt = −n·δx/(n·x′); it goes to the event,
//! through the jump x⁺ = G x⁻ of the velocities there, and back, which is the saltation matrix
//!
//! S = G + (G f⁻ − f⁺) δtᵀ,   δt = −n/(n·f⁻),   x′ = f⁻ before, f⁺ after
//!
//! (Aizerman & Gantmakher, J. Mech. Appl. Math. 11, 1958; Müller, Chaos, Solitons & Fractals 5, 1671, 1995; Leine & Nijmeijer,
//! Dynamics and Bifurcations of Non-Smooth Mechanical Systems, 2004). An impact has G ≠ 1; a resilient face with a dashpot has
//! G = 1 and forces that jump; where a force ends at zero nothing jumps and S = 1. An impulse of the drive has its own time: no
//! δt. A particle that a face holds has lost its gap and its relative speed for good, and with them two multipliers.
//!
//! A check for free: det M = e^(∫ tr) Π ε², the contraction of the dashpots times two restitutions an impact, 0 with a capture.
//!
//! | files | hold |
//! |---|---|
//! | `tape` | what a run leaves for it: flows, events and the jumps in them, states at the ends of cycles |
//! | `tangent` | a tangent vector along the tape |
//! | `multipliers` | M over a period, its eigenvalues and determinant |
//! | `recurrence` | which periods come again, and since when |
//! | `exponent` | the largest Lyapunov exponent |
//! | `name` | the decision |
//! | `settled` | while it runs: whether it has settled |
//! | `settling` | without a name: whether a neighbouring start stays beside a run |

mod exponent;
mod multipliers;
mod name;
mod recurrence;
mod settled;
mod settling;
mod tangent;
mod tape;

pub use exponent::Exponent;
pub use multipliers::{Fundamental, Multiplier};
pub use name::{Motion, MotionKind};
pub use recurrence::Recurring;
pub use settling::Settling;

pub(crate) use multipliers::Period;
pub(crate) use name::{NEUTRAL, kind, name};
pub(crate) use recurrence::{Scale, candidates, closest};
pub(crate) use settled::settled;
pub(crate) use tape::{End, Instant, Jump, Kick, NAMING, Tape};
