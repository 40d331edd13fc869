//! By how many per cent a number of a periodic motion changes for one per cent of a parameter of its system: d ln A/d ln p.
//!
//! P(x, p) = x is smooth in x and p as long as the contacts and their order stay the same, so that the orbit x(p) and a number
//! A(x, p) of it have the derivative dA/dp = ∂A/∂p + ∂A/∂x (1 − M)⁻¹ ∂P/∂p. It is taken as the limit of orbits on both sides, each
//! closed by Newton's method with its own 1 − M: with p e^u for the parameter,
//!
//! D(u) = (ln A(u) − ln A(−u))/2u = d + c₁ u² + c₂ u⁴ + …
//!
//! is extrapolated from u, u/2, u/4, … to zero (Romberg), and (ln A(u) + ln A(−u))/2 in the same way to ln A(0): by that both sides are
//! known to be of the branch of the orbit, and not of another one that both have come to. A sequence of contacts that changes within ±u,
//! a fold or a fork make u smaller; where no u is small enough there is no derivative.
//!
//! ∂P/∂p in closed form would take the derivative of every mode, load and double root of every contact state; differences of closed
//! orbits take none of them, and are as exact as rounding lets a number of an orbit be known over u.

use super::newton::{closed, size};
use super::shot::{Sequence, Shot};
use super::{Orbit, OrbitError};
use crate::arithmetic::lagrange;
use crate::error::EngineError;
use crate::motion::End;
use crate::response::Response;
use crate::system::HybridSystem;

/// The largest u.
const WIDEST: f64 = 1.0 / 32.0;
/// Smaller by this where the motion is another one within ±u.
const NARROWER: f64 = 1.0 / 8.0;
/// The largest u is not smaller than this: rounding would leave four digits.
const NARROWEST: f64 = 1e-7;
/// Values of u that are extrapolated from, at most.
const LEVELS: i32 = 5;
/// An extrapolation that changes so little is the last.
const CONVERGED: f64 = 1e-10;
/// An error above this, relative to a derivative above 1, is that of a function that is not smooth within ±u.
const SMOOTH: f64 = 1e-4;
/// Numbers of one branch, both sides extrapolated to the orbit, differ by no more than this.
const SAME: f64 = 1e-8;
/// What rounding leaves of a number of an orbit: its start is known to 1e-15 of the motion times 1/(1 − μ).
const ROUNDING: f64 = 3e-13;
/// After a step of Newton's method below this, in units of the motion, the next one is rounding.
const LAST_STEP: f64 = 1e-7;
/// Such steps from a predicted start, before it is searched with more care.
const STEPS: usize = 6;

/// d ln A/d ln p.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Elasticity {
    /// The derivative.
    pub value: f64,
    /// Its error: what the last extrapolation changed, rounding at least.
    pub error: f64,
}

/// Why a number of an orbit has no such derivative.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum ElasticityError<E> {
    /// There is no system beside that of the orbit.
    #[error("{0}")]
    System(E),
    /// The orbit itself is not found again, or the engine refuses a run.
    #[error(transparent)]
    Orbit(#[from] OrbitError),
    /// Another sequence of contacts is next to that of the orbit.
    #[error("a contact begins, ends or changes its order within a share of {within:.0e} of the parameter")]
    Graze {
        /// How close it is at least, as a share of the parameter.
        within: f64,
    },
    /// No orbit on one side, or a derivative that grows without bound.
    #[error("the motion turns back, or a contact ends, within a share of {within:.0e} of the parameter")]
    Fold {
        /// How close it is at least, as a share of the parameter.
        within: f64,
    },
    /// Zero has no logarithm.
    #[error("the number is zero")]
    Zero,
}

/// Why ±u is too wide.
enum Wide {
    /// Other contacts on one side.
    Contacts,
    /// No orbit on one side, or no convergence.
    Orbit,
}

/// Either side of an orbit.
struct Sides<S, A> {
    system_at: S,
    value: A,
    cycles: u32,
    sequence: Sequence,
    /// ln A of the orbit.
    own: f64,
    /// Known starts by u, the orbit's own first.
    known: Vec<(f64, End)>,
}

impl Orbit {
    /// By how many per cent a positive number of the run over one period changes for one per cent of a parameter of the system,
    /// which `system_at` takes as a factor: d ln A/d ln p, the orbit followed.
    ///
    /// # Errors
    /// [`ElasticityError`] with the reason: where the sequence of contacts changes at this very value, say.
    pub fn elasticity<E>(
        &self,
        mut system_at: impl FnMut(f64) -> Result<HybridSystem, E>,
        value: impl Fn(&Response) -> f64,
    ) -> Result<Elasticity, ElasticityError<E>> {
        let system = system_at(1.0).map_err(ElasticityError::System)?;
        let shot = Shot::new(&system, self.begin(&system)?, self.cycles, None)?;
        let number = value(&shot.response);
        if !(number > 0.0) {
            return Err(ElasticityError::Zero);
        }
        let (own, sequence) = (libm::log(number), shot.sequence(&system));
        let known = vec![(0.0, shot.start)];
        let mut sides = Sides { system_at, value, cycles: self.cycles, sequence, own, known };
        let mut widest = WIDEST;
        loop {
            let wide = match sides.extrapolated(widest)? {
                Ok(elasticity) => return Ok(elasticity),
                Err(wide) => wide,
            };
            sides.known.truncate(1);
            if NARROWER * widest < NARROWEST {
                let within = widest;
                return Err(match wide {
                    Wide::Contacts => ElasticityError::Graze { within },
                    Wide::Orbit => ElasticityError::Fold { within },
                });
            }
            widest *= NARROWER;
        }
    }
}

impl<E, S: FnMut(f64) -> Result<HybridSystem, E>, A: Fn(&Response) -> f64> Sides<S, A> {
    /// The limit of D(u) from `widest` down; the error inside says that it is too wide.
    fn extrapolated(&mut self, widest: f64) -> Result<Result<Elasticity, Wide>, ElasticityError<E>> {
        let (mut slopes, mut means) = (Vec::new(), Vec::new());
        let mut best = Elasticity { value: f64::NAN, error: f64::INFINITY };
        let (mut before, mut apart) = (f64::INFINITY, f64::INFINITY);
        for level in 0..LEVELS {
            let u = libm::scalbn(widest, -level);
            let [above, below] = match (self.value_at(u)?, self.value_at(-u)?) {
                (Ok(above), Ok(below)) => [above, below].map(|value| libm::log(value) - self.own),
                (Err(wide), _) | (_, Err(wide)) => return Ok(Err(wide)),
            };
            slopes = refined((above - below) / (2.0 * u), &slopes);
            means = refined(0.5 * (above + below), &means);
            let [.., last, value] = slopes[..] else { continue };
            let moved = (value - last).abs();
            // From here on rounding grows.
            if !(moved < before) {
                break;
            }
            best = Elasticity { value, error: moved.max(ROUNDING / u) };
            (before, apart) = (moved, means.last().map_or(f64::INFINITY, |mean| mean.abs()));
            if moved <= CONVERGED {
                break;
            }
        }
        let is_smooth = before <= SMOOTH * best.value.abs().max(1.0) && apart <= SAME;
        Ok(if is_smooth { Ok(best) } else { Err(Wide::Orbit) })
    }

    /// A of the orbit at p e^u.
    fn value_at(&mut self, u: f64) -> Result<Result<f64, Wide>, ElasticityError<E>> {
        let system = (self.system_at)(libm::exp(u)).map_err(ElasticityError::System)?;
        let shot = match self.closed(&system, u) {
            Ok(shot) => shot,
            Err(error @ OrbitError::Engine(EngineError::Overrun(_))) => return Err(error.into()),
            Err(OrbitError::Grazes { .. }) => return Ok(Err(Wide::Contacts)),
            Err(_) => return Ok(Err(Wide::Orbit)),
        };
        if shot.start.contacts != self.known[0].1.contacts || shot.sequence(&system) != self.sequence {
            return Ok(Err(Wide::Contacts));
        }
        let value = (self.value)(&shot.response);
        self.known.push((u, shot.start));
        Ok(Ok(value))
    }

    /// The orbit at u.
    fn closed(&self, system: &HybridSystem, u: f64) -> Result<Shot, OrbitError> {
        let mut shot = Shot::new(system, self.predicted(u), self.cycles, None)?;
        for _ in 0..STEPS {
            let Some(step) = shot.step().filter(|_| shot.misses_by().is_finite()) else { break };
            let next = Shot::new(system, shot.moved(&step), self.cycles, None)?;
            if size(&step) <= LAST_STEP {
                return Ok(next);
            }
            if !(next.misses_by() < shot.misses_by()) {
                break;
            }
            shot = next;
        }
        Ok(closed(system, shot.start, self.cycles)?.0)
    }

    /// Where the orbit at u starts, by the polynomial through the starts that are known.
    fn predicted(&self, u: f64) -> End {
        let places: Vec<f64> = self.known.iter().map(|(u, _)| *u).collect();
        let weights = lagrange::weights(&places, u);
        let own = &self.known[0].1;
        let number = |i: usize| self.known.iter().zip(&weights).map(|((_, end), weight)| weight * end.state[i]).sum();
        End { state: (0..own.state.len()).map(number).collect(), contacts: own.contacts.clone() }
    }
}

/// The next row of Romberg's table: a coarse value, then with one more power of u² taken off each time.
fn refined(coarse: f64, before: &[f64]) -> Vec<f64> {
    let mut row = vec![coarse];
    let mut power = 1.0;
    for (k, coarser) in before.iter().enumerate() {
        power *= 4.0;
        row.push(row[k] + (row[k] - coarser) / (power - 1.0));
    }
    row
}
