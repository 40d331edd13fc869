//! The name of a motion.
//!
//! | name | decided by |
//! |---|---|
//! | at rest on the floor, periodic, sticking, completed chatter | the last state is within a millionth of the motion of an orbit that closes (Newton's step with the multipliers of the last period) and no multiplier exceeds 1 |
//! | chaotic | no such period, and a Lyapunov exponent above zero by three standard errors |
//! | quasi-periodic | no such period, an exponent of zero within its standard error, which is small, and returns that come no closer with time and are not drawn to an orbit, in a run that is long enough to see the slowest transient die away and far from orbits that draw it in, or let it go, so slowly that it could not show |
//! | not settled | anything else |

use std::fmt;
use std::str::FromStr;

use super::exponent::Exponent;
use super::multipliers::{Multiplier, Period};
use super::recurrence::{Recurring, Scale, candidates, closing, settled_after};
use super::tape::{Step, Tape};
use crate::contact::Side;
use crate::contact_state::block::Block;
use crate::error::EngineError;
use crate::flow::Flow;
use crate::system::{Contact, HybridSystem};

/// Share of the motion within which a state may be on its way to come again.
const NEAR: f64 = 1e-3;
/// Distance from the orbit, in units of the motion, within which a run has settled.
const SETTLED: f64 = 1e-6;
/// The same where impacts at one instant leave no multipliers to prove it: the state itself comes again.
const REPEATED: f64 = 1e-9;
/// Multipliers below this draw a run in, to an orbit within so much of the motion. Those of a motion that never comes again are 1 along it, near
/// enough to a return.
const DRAWS_IN: f64 = 0.995;
const NEARBY: f64 = 1e-2;
/// Cycles of the orbits that may hold a run for longer than it lasts, and how near to them it is then, in units of the motion.
const HOLDS: usize = 4;
const HELD: f64 = 5e-2;
/// A multiplier of a motion without damping may round above 1 by this.
pub(crate) const NEUTRAL: f64 = 1e-9;
/// Standard errors that make an exponent positive.
const ERRORS: f64 = 3.0;
/// A standard error above this, a cycle, does not tell zero from weak chaos.
const SHARP: f64 = 0.01;
/// Returns of a motion that no longer settles come no closer than this from one half of the run to the other.
const STEADY: f64 = 0.8;

/// What kind of motion a run ends in.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum MotionKind {
    /// No contact is made or lost any more; every particle stays on its floor.
    AtRest,
    /// It comes again after so many periods of the drive.
    Periodic {
        /// Periods of the drive.
        periods: u32,
        /// Contacts made in that time, by all particles.
        contacts: u64,
    },
    /// The same, and every particle is held by a face once in that time: it remembers nothing, its multipliers are 0.
    Sticking {
        /// Periods of the drive.
        periods: u32,
        /// Contacts made in that time.
        contacts: u64,
    },
    /// It comes again, and some particle comes to rest on a face after infinitely many impacts, whatever the others do.
    CompletedChatter {
        /// Periods of the drive.
        periods: u32,
    },
    /// It never comes again, and neighbours stay neighbours.
    QuasiPeriodic,
    /// It never comes again, and neighbours part exponentially.
    Chaotic,
    /// The run is too short to say.
    NotSettled,
}

/// What is known of the motion that a run ends in.
#[derive(Debug, Clone, PartialEq)]
pub struct Motion {
    /// Its name.
    pub kind: MotionKind,
    /// Floquet multipliers of the last period, largest first; empty where nothing comes again, and where particles are struck
    /// at one instant, so that none exist.
    pub multipliers: Vec<Multiplier>,
    /// Their product against the contraction of dashpots and impacts, relative to what it could be at most; NaN without them.
    pub residual: f64,
    /// The largest Lyapunov exponent; of what comes again that of its largest multiplier, without an error. `None` where nothing
    /// is left of a disturbance, and where particles are struck at one instant.
    pub exponent: Option<Exponent>,
    /// Cycles after which the motion comes again to within a millionth.
    pub settled_after: Option<u64>,
    /// Its states at the ends of cycles, by which another run is found to end in the same motion; `None` where nothing comes again.
    pub recurring: Option<Recurring>,
}

impl MotionKind {
    /// The words in a table.
    const AT_REST: &str = "at rest";
    const PERIODIC: &str = "periodic";
    const STICKING: &str = "sticking";
    const CHATTER: &str = "completed chatter";
    const QUASI_PERIODIC: &str = "quasi-periodic";
    const CHAOTIC: &str = "chaotic";
    const NOT_SETTLED: &str = "not settled";

    /// All names without numbers, from rest to chaos.
    pub const WORDS: [&str; 7] = [
        Self::AT_REST,
        Self::PERIODIC,
        Self::STICKING,
        Self::CHATTER,
        Self::QUASI_PERIODIC,
        Self::CHAOTIC,
        Self::NOT_SETTLED,
    ];

    /// Its name without numbers.
    #[must_use]
    pub fn word(self) -> &'static str {
        match self {
            Self::AtRest => Self::AT_REST,
            Self::Periodic { .. } => Self::PERIODIC,
            Self::Sticking { .. } => Self::STICKING,
            Self::CompletedChatter { .. } => Self::CHATTER,
            Self::QuasiPeriodic => Self::QUASI_PERIODIC,
            Self::Chaotic => Self::CHAOTIC,
            Self::NotSettled => Self::NOT_SETTLED,
        }
    }

    /// It comes again after some periods of the drive.
    #[must_use]
    pub fn repeats(self) -> bool {
        match self {
            Self::AtRest | Self::Periodic { .. } | Self::Sticking { .. } | Self::CompletedChatter { .. } => true,
            Self::QuasiPeriodic | Self::Chaotic | Self::NotSettled => false,
        }
    }
}

impl fmt::Display for MotionKind {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Periodic { periods, contacts } | Self::Sticking { periods, contacts } => {
                write!(f, "{} {periods}:{contacts}", self.word())
            }
            Self::CompletedChatter { periods } => write!(f, "{} {periods}:∞", self.word()),
            Self::AtRest | Self::QuasiPeriodic | Self::Chaotic | Self::NotSettled => f.write_str(self.word()),
        }
    }
}

/// A text that names no motion.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("`{0}` names no motion")]
pub struct NoMotion(String);

impl FromStr for MotionKind {
    type Err = NoMotion;

    fn from_str(text: &str) -> Result<Self, NoMotion> {
        let none = || NoMotion(text.into());
        let plain = [
            (Self::AT_REST, Self::AtRest),
            (Self::QUASI_PERIODIC, Self::QuasiPeriodic),
            (Self::CHAOTIC, Self::Chaotic),
            (Self::NOT_SETTLED, Self::NotSettled),
        ];
        if let Some((_, kind)) = plain.into_iter().find(|(word, _)| *word == text) {
            return Ok(kind);
        }
        let (word, ratio) = text.rsplit_once(' ').ok_or_else(none)?;
        let (periods, contacts) = ratio.split_once(':').ok_or_else(none)?;
        let periods = periods.parse().map_err(|_| none())?;
        let count = || contacts.parse().map_err(|_| none());
        match word {
            Self::PERIODIC => Ok(Self::Periodic { periods, contacts: count()? }),
            Self::STICKING => Ok(Self::Sticking { periods, contacts: count()? }),
            Self::CHATTER if contacts == "∞" => Ok(Self::CompletedChatter { periods }),
            _ => Err(none()),
        }
    }
}

/// Names the motion that a tape ends in; exponents are of its last `window` cycles.
pub(crate) fn name(system: &HybridSystem, tape: &Tape, window: usize) -> Result<Motion, EngineError> {
    let scale = Scale::new(system, &tape.reach);
    let mut settles = false;
    for period in candidates(&scale, &tape.ends, NEAR) {
        match closes(system, &scale, tape, period)? {
            Closing::Closes(motion) => return Ok(motion),
            Closing::Settles => settles = true,
            Closing::Open => {}
        }
    }
    let ends = &tape.ends[tape.ends.len() - window.min(tape.ends.len())..];
    let blurred = tape.last(window).any(|cycle| cycle.blurred);
    let exponent = if blurred { None } else { Exponent::of(system, &scale, tape, window) };
    let kind = match exponent {
        // Without a drive that comes again there is no cycle to be left out of step with.
        Some(Exponent { value, error }) if system.drive.repeats => {
            let is_zero = value.abs() <= error && error <= SHARP;
            if value > ERRORS * error {
                MotionKind::Chaotic
            } else if is_zero
                && !settles
                && closing(&scale, ends) > STEADY
                && shows_decay(system, tape, window)
                && !is_held(system, &scale, tape, window)
            {
                MotionKind::QuasiPeriodic
            } else {
                MotionKind::NotSettled
            }
        }
        _ => MotionKind::NotSettled,
    };
    Ok(Motion { kind, multipliers: Vec::new(), residual: f64::NAN, exponent, settled_after: None, recurring: None })
}

/// True if the last `window` cycles could show that the motion is a transient: the slowest one that their contact states know gets as
/// much smaller, from one half of them to the other, as [`STEADY`] asks for. Without an event all of it is a transient, but for what the
/// drive repeats. Nothing dies away without any damping.
fn shows_decay(system: &HybridSystem, tape: &Tape, window: usize) -> bool {
    let rates =
        flows(tape, window).flat_map(|flow| &flow.blocks[..flow.own]).map(Block::slowest).filter(|rate| *rate > 0.0);
    let Some(slowest) = rates.reduce(f64::min) else { return true };
    let has_events = tape.last(window).flat_map(|cycle| &cycle.steps).any(|step| matches!(step, Step::Event(_)));
    has_events && libm::exp(-slowest * system.drive.period * (window / 2) as f64) < STEADY
}

/// True if the run ends next to an orbit that it could not have left, nor come much nearer to, in half of its last `window` cycles: on
/// its way it looks like a motion that never comes again, next to a period doubling above all. Without damping no motion is on its way.
fn is_held(system: &HybridSystem, scale: &Scale, tape: &Tape, window: usize) -> bool {
    let last = tape.ends.len() - 1;
    let holds = |period: usize| {
        if tape.last(period).any(|cycle| cycle.blurred) {
            return false;
        }
        let map = Period::new(system, scale, tape.last(period));
        let change = libm::pow(1.0 / STEADY, 2.0 * period as f64 / window as f64);
        map.orbit(scale.miss(&tape.ends[last - period], &tape.ends[last])).is_ok_and(|orbit| {
            // No torus goes round an orbit whose neighbours do not. Towards one twice as much is asked for: what comes nearer shows less and less.
            orbit.attracts(change, HELD) && !(orbit.turns() && orbit.attracts(1.0 / (change * change), HELD))
        })
    };
    !system.is_undamped() && (1..=HOLDS.min(last)).any(holds)
}

/// What the last cycles of a tape went through.
fn flows(tape: &Tape, cycles: usize) -> impl Iterator<Item = &Flow> {
    tape.last(cycles).flat_map(|cycle| &cycle.steps).filter_map(|step| match step {
        Step::Flow(flow, _) => Some(&**flow),
        Step::Timed(_) | Step::Event(_) => None,
    })
}

/// What a run comes to after so many cycles.
enum Closing {
    /// Its motion comes again.
    Closes(Motion),
    /// It is on its way to one that does.
    Settles,
    /// Neither.
    Open,
}

/// The motion, if it comes again after so many cycles.
fn closes(system: &HybridSystem, scale: &Scale, tape: &Tape, period: usize) -> Result<Closing, EngineError> {
    let last = tape.ends.len() - 1;
    let (begin, end) = (&tape.ends[last - period], &tape.ends[last]);
    let (multipliers, residual) = if tape.last(period).any(|cycle| cycle.blurred) {
        if scale.apart(begin, end) > REPEATED {
            return Ok(Closing::Open);
        }
        (Vec::new(), f64::NAN)
    } else {
        let map = Period::new(system, scale, tape.last(period));
        let orbit = map.orbit(scale.miss(begin, end))?;
        if !orbit.attracts(1.0 + NEUTRAL, SETTLED) {
            return Ok(if orbit.attracts(DRAWS_IN, NEARBY) { Closing::Settles } else { Closing::Open });
        }
        (orbit.multipliers, map.residual())
    };
    let settled_after = settled_after(scale, &tape.ends, period, SETTLED);
    let left = multipliers.first().map(|largest| largest.modulus).filter(|modulus| *modulus > 0.0);
    let exponent = left.map(|modulus| Exponent { value: libm::log(modulus) / period as f64, error: 0.0 });
    Ok(Closing::Closes(Motion {
        kind: kind(system, tape, period),
        multipliers,
        residual,
        exponent,
        settled_after: Some(settled_after as u64),
        recurring: Some(Recurring::new(scale, &tape.ends[last + 1 - period..], SETTLED)),
    }))
}

/// What comes again after so many cycles.
pub(crate) fn kind(system: &HybridSystem, tape: &Tape, period: usize) -> MotionKind {
    let periods = period as u32;
    let contacts = tape.last(period).map(|cycle| cycle.contacts).sum();
    let on_floor = |contact: &Contact| *contact != Contact::Flight && contact.side() == Side::Floor;
    let count = system.particles.len();
    // What is in flight, or at the ceiling, comes back to the floor by a contact.
    let mut ends = tape.ends.iter().rev().take(period);
    if count > 0 && contacts == 0 && ends.all(|end| end.contacts.iter().all(on_floor)) {
        return MotionKind::AtRest;
    }
    if tape.last(period).any(|cycle| cycle.chatter) {
        return MotionKind::CompletedChatter { periods };
    }
    let is_held = |j: usize| flows(tape, period).any(|flow| flow.modes.contacts[j].holds(&system.particles[j]));
    if count > 0 && (0..count).all(is_held) {
        MotionKind::Sticking { periods, contacts }
    } else {
        MotionKind::Periodic { periods, contacts }
    }
}
