//! What drives a structure.

use serde::{Deserialize, Serialize};

/// What drives the structure. `period` is the forcing cycle.
#[derive(Debug, Clone, PartialEq)]
pub enum Excitation {
    /// One impulse at t = 0; `cycle` is only the unit in which time is counted.
    SingleImpulse {
        /// J, N s.
        impulse: f64,
        /// s.
        cycle: f64,
    },
    /// J at t = 0, T, 2T, …
    ImpulseTrain {
        /// J, N s.
        impulse: f64,
        /// T, s.
        period: f64,
    },
    /// F sin(ω t), T = 2π/ω.
    Harmonic {
        /// F, N; negative turns the phase by π.
        force: f64,
        /// ω, rad/s.
        angular_frequency: f64,
    },
    /// Pulses of finite duration with impulse J, one a period.
    PulseTrain {
        /// J, N s.
        impulse: f64,
        /// T, s.
        period: f64,
        /// s.
        duration: f64,
        /// How the impulse is spread over the duration.
        shape: PulseShape,
    },
}

impl Excitation {
    /// It does not move anything.
    #[must_use]
    pub fn is_silent(&self) -> bool {
        match self {
            Self::Harmonic { force, .. } => *force == 0.0,
            Self::SingleImpulse { impulse, .. }
            | Self::ImpulseTrain { impulse, .. }
            | Self::PulseTrain { impulse, .. } => *impulse == 0.0,
        }
    }

    /// Time from one impulse to the next, s; `None` where there is no train of them.
    #[must_use]
    pub fn impulse_period(&self) -> Option<f64> {
        match self {
            Self::ImpulseTrain { period, .. } => Some(*period),
            Self::SingleImpulse { .. } | Self::Harmonic { .. } | Self::PulseTrain { .. } => None,
        }
    }

    /// The forcing cycle, s.
    #[must_use]
    pub fn period(&self) -> f64 {
        match self {
            Self::SingleImpulse { cycle, .. } => *cycle,
            Self::ImpulseTrain { period, .. } | Self::PulseTrain { period, .. } => *period,
            Self::Harmonic { angular_frequency, .. } => std::f64::consts::TAU / angular_frequency,
        }
    }
}

/// How a finite pulse spreads its impulse.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum PulseShape {
    /// Constant force over the duration.
    Rectangular,
    /// Impulses with binomial weights, one at the start of each millisecond of the duration.
    Binomial {
        /// n: impulses a pulse, spaced duration/n, the last of them that long before its end; weights C(n−1, i)/2^(n−1).
        impulses: u32,
    },
}

impl PulseShape {
    /// Binomial, over so many seconds.
    ///
    /// # Errors
    /// [`NoBinomialPulse`] unless these are whole milliseconds, from one to a million.
    pub fn binomial(duration: f64) -> Result<Self, NoBinomialPulse> {
        let steps = duration / 1e-3;
        let whole = steps.round();
        // As near as units and decimals leave it.
        let is_whole = (1.0..=1e6).contains(&whole) && (steps - whole).abs() <= 1e-9 * whole;
        if is_whole { Ok(Self::Binomial { impulses: whole as u32 }) } else { Err(NoBinomialPulse { duration }) }
    }
}

/// A duration that no binomial pulse has.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
#[error(
    "a binomial pulse has impulses at 0, 1 ms, 2 ms, …: its duration is a whole number of milliseconds, from 1 ms to 1000 s, not {duration} s"
)]
pub struct NoBinomialPulse {
    duration: f64,
}
